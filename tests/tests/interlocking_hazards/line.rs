//! Plain line: the neighbour's consent ends, and a train on the line goes nobody knows where.

use atc_kernel::interlocking::{Epoch, Refusal, SegmentSet, Travel};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{self, Consent, Message, Permission, Stamp, check_life};

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

/// The cycles of the neighbour's last train, from the last one in which it was permitted to be sent: on the circuit, and reported there. The
/// neighbour counts on the permission for its life, as its own kernel does; the train runs on for the whole residual running, and is lost
/// for as long as a train may be.
fn last_train(life: Ticks, residual: Ticks, loss: u8) -> (u16, u16) {
    let stamp = |cycle| Stamp { session: wayside::Session(1), cycle: Epoch(cycle) };
    let permitted = Message { permission: Permission::Granted, sent: stamp(0), echo: Some(stamp(0)) };
    let mut closed = 1;
    let mut consent = Consent::none(life).hear(life, stamp(1), Some(permitted));
    while consent.counts(life) {
        closed += 1;
        consent = consent.hear(life, stamp(closed.into()), None);
    }
    (closed + residual.0, closed + residual.0 + u16::from(loss))
}

/// Staff are not sent onto the line in the cycle before the neighbour's last train is reported there: the longest life that a device accepts.
#[test]
fn no_block_is_confirmed_under_the_neighbour_s_last_train() {
    for comes in [true, false] {
        let mut session = Session::new(SECOND);
        session.wait(9, &[]);
        let (turn, residual, loss) = session.line_times();
        let life = Ticks(turn.0 - residual.0 - u16::from(loss));
        assert!(check_life(life, turn, residual, loss).is_ok());
        assert!(check_life(Ticks(life.0 + 1), turn, residual, loss).is_err());
        let (there, reported) = last_train(life, residual, loss);
        let (toward, away) = (session.turn("West", Travel::Toward), session.turn("West", Travel::Away));
        assert_eq!(session.ask(toward, &[]), Ok(()));
        assert_eq!(session.ask(away, &[]), Err(Refusal::Waiting));
        session.block(&["W2"], &[]);
        let mut confirmed = None;
        for cycle in 3..reported + 100 {
            session.wait(1, if comes && cycle >= reported { &["W2"] } else { &[] });
            assert!(!comes || cycle < there || !session.is_confirmed("W2"), "cycle {cycle}: there since {there}");
            confirmed = confirmed.or_else(|| session.is_confirmed("W2").then_some(cycle));
        }
        // Not a cycle too late: a line on which nobody comes is confirmed in the very cycle in which it could be turned.
        assert_eq!(confirmed, (!comes).then_some(turn.0 + 1));
    }
}
