//! Plain line: the neighbour's consent ends, and a train on the line goes nobody knows where.

use atc_kernel::interlocking::{Refusal, SegmentSet, Travel};

use crate::session::Session;

const SECOND: &str = "[times]\ncycle_ms = 1000";

/// The line was turned away with the neighbour's consent, and the consent has ended: nothing is set, shown or granted out any more.
#[test]
fn nobody_is_sent_out_once_the_consent_has_ended() {
    let mut session = Session::new(SECOND);
    session.wait(9, &[]);
    session.consent = SegmentSet::ALL;
    let away = session.turn("West", Travel::Away);
    assert_eq!(session.ask(away, &[]), Ok(()));
    let set = session.set("1-W");
    session.consent = SegmentSet::EMPTY;
    session.wait(1, &["1T"]);
    assert_eq!(session.ask(set, &["1T"]), Err(Refusal::Direction));
    session.consent = SegmentSet::ALL;
    assert_eq!(session.ask(set, &["1T"]), Ok(()));
    assert!(session.proceed("1-W") && session.telegram("1T").is_open());
    session.consent = SegmentSet::EMPTY;
    for _ in 0..100 {
        session.wait(1, &["1T"]);
        assert!(!session.proceed("1-W") && !session.telegram("1T").is_open());
    }
    // In the throat and on the line too.
    session.consent = SegmentSet::ALL;
    session.wait(2, &["1T", "P1T"]);
    session.wait(2, &["P1T"]);
    assert!(session.telegram("P1T").is_open());
    session.consent = SegmentSet::EMPTY;
    session.wait(1, &["P1T"]);
    assert!(!session.telegram("P1T").is_open());
    session.wait(1, &["W1"]);
    assert!(!session.telegram("W1").is_open());
}

/// After a restart with a train on the line, the line is given to nobody until it has been clear.
#[test]
fn an_occupied_line_is_not_turned_after_a_start() {
    for there in ["W1", "W2"] {
        let mut session = Session::started(SECOND);
        session.wait(100, &[there]);
        session.consent = SegmentSet::ALL;
        for travel in [Travel::Toward, Travel::Away] {
            let turn = session.turn("West", travel);
            assert_eq!(session.ask(turn, &[there]), Err(Refusal::Direction));
        }
        session.wait(2, &[]);
        let turn = session.turn("West", Travel::Toward);
        assert_eq!(session.ask(turn, &[]), Ok(()));
    }
}

/// A train that the neighbour has sent is let in, though the direction was taken back meanwhile.
#[test]
fn a_train_that_was_sent_is_let_in() {
    let mut session = Session::new(SECOND);
    session.wait(9, &[]);
    let (toward, away) = (session.turn("West", Travel::Toward), session.turn("West", Travel::Away));
    assert_eq!(session.ask(toward, &[]), Ok(()));
    assert_eq!(session.ask(away, &[]), Err(Refusal::Waiting));
    session.wait(1, &["W2"]);
    assert_eq!(session.ask(toward, &["W2"]), Ok(()));
}

/// No route leads in from the line: it is never turned towards the station, from where it could not be turned back.
#[test]
fn a_line_without_a_way_in_is_not_turned_in() {
    let mut session = Session::without(&["W-1", "W-2"], SECOND);
    session.wait(9, &[]);
    let toward = session.turn("West", Travel::Toward);
    assert_eq!(session.ask(toward, &[]), Err(Refusal::Direction));
    session.consent = SegmentSet::ALL;
    let away = session.turn("West", Travel::Away);
    assert_eq!(session.ask(away, &[]), Ok(()));
}
