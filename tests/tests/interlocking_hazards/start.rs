//! After a start the device has forgotten what trains still count on.

use atc_kernel::interlocking::{Position, Refusal, SegmentSet, Travel};

use crate::session::Session;

/// A train near a signal that was at proceed before the device started: nothing is moved, set or turned until it must have stopped, whatever is
/// unblocked at once.
#[test]
fn nothing_moves_after_a_start_while_a_train_may_be_coming() {
    let mut session = Session::started("[times]\ncycle_ms = 1000");
    let (drive, set) = (session.drive("P1", Position::Reverse), session.set("1-W"));
    let turn = session.turn("West", Travel::Toward);
    // One cycle has passed with the order to unblock.
    for cycle in 1..60 {
        let request = [drive, set, turn][cycle % 3];
        assert_eq!(session.ask(request, &["W1"]), Err(Refusal::Starting), "cycle {cycle}");
        assert!(session.drives().is_empty() && !session.telegram("W1").is_open());
    }
    assert_eq!(session.ask(drive, &["W1"]), Ok(()));
}

/// A driver who goes by signals has passed signal W at proceed, and his train is in P1T and the tail at W1 when the device starts. He stands there
/// for longer than the start time, and goes on into 1T by the signal that he has passed: what he runs into must be as it was.
#[test]
fn nothing_is_done_ahead_of_a_driver_who_is_in_his_route_when_the_device_starts() {
    let mut session = Session::started("[times]\ncycle_ms = 1000");
    let standing = ["W1", "P1T"];
    session.wait(300, &standing);
    let ahead = session.drive("P2", Position::Reverse);
    assert_eq!(session.ask(ahead, &standing), Err(Refusal::Unswept), "the point in his overlap");
    assert!(session.drives().is_empty());
    session.consent = SegmentSet::ALL;
    let toward = session.turn("East", Travel::Toward);
    assert_eq!(session.ask(toward, &standing), Ok(()), "no route out to the east is on his way");
    let against = session.set("E-2");
    assert_eq!(session.ask(against, &standing), Err(Refusal::Occupied), "P1T is its overlap");
    session.block(&["1T"], &standing);
    session.wait(300, &standing);
    assert!(!session.is_confirmed("1T"), "staff do not step onto the track ahead of him");
    // He goes on, and 2T was no way of his: the train is wholly in 1T, and stands after a while.
    session.wait(5, &["P1T", "1T"]);
    assert_eq!(session.ask(ahead, &["1T"]), Err(Refusal::Unswept), "he may slide");
    session.block(&["2T"], &["1T"]);
    assert!(session.is_confirmed("2T"), "staff may go where he cannot come any more");
    session.wait(60, &["1T"]);
    assert!(!session.is_confirmed("1T"), "he is there");
    assert_eq!(session.ask(ahead, &["1T"]), Ok(()));
}

/// A line out: a driver who goes by signals has left platform 1 by signal 1E when the device starts. He stands in the throat while the line counts as
/// clear, and goes out to it.
#[test]
fn the_line_is_not_given_while_a_driver_is_on_his_way_out_to_it() {
    let mut session = Session::started("[times]\ncycle_ms = 1000");
    let toward = session.turn("East", Travel::Toward);
    session.wait(300, &["P2T"]);
    assert_eq!(session.ask(toward, &["P2T"]), Err(Refusal::Direction));
    assert_eq!(session.ask(toward, &["P2T", "E1"]), Err(Refusal::Direction));
    assert_eq!(session.ask(toward, &["E1"]), Err(Refusal::Direction));
}

/// Trains that stand in both platforms when the device starts hold up nobody for longer than their overlaps take.
#[test]
fn trains_in_platforms_go_on_after_a_start() {
    let mut session = Session::started("[times]\ncycle_ms = 1000");
    let standing = ["1T", "2T"];
    session.wait(60, &standing);
    session.consent = SegmentSet::ALL;
    // The turn time is over, too.
    session.wait(60, &standing);
    let away = session.turn("East", Travel::Away);
    assert_eq!(session.ask(away, &standing), Ok(()));
    let out = session.set("1-E");
    assert_eq!(session.ask(out, &standing), Ok(()));
    session.wait(2, &standing);
    assert!(session.proceed("1-E"));
}
