//! A circuit that is falsely occupied is taken for no train.

use atc_kernel::interlocking::{Phase, Position, Refusal, SegmentSet, SpeedCode, Travel};

use crate::session::{ALL, Session};

const SECOND: &str = "[times]\ncycle_ms = 1000";

/// A train at the western signal with route W-1 set for it.
fn let_in(lines: &str) -> Session {
    let mut session = Session::new(lines);
    session.wait(9, &[]);
    let toward = session.turn("West", Travel::Toward);
    assert_eq!(session.ask(toward, &[]), Ok(()));
    let set = session.set("W-1");
    assert_eq!(session.ask(set, &["W1"]), Ok(()));
    assert!(session.proceed("W-1"));
    session
}

/// For each set of circuits that is falsely occupied for each time: the point in front of the train stays locked until the train must have
/// stopped, one release time after its signal fell.
#[test]
fn a_flash_releases_nothing_in_front_of_a_train() {
    for flash in [&ALL[..], &["W1", "P1T", "1T"], &["W1", "P1T", "1T", "P2T"], &["W1", "P1T"], &["W1", "1T", "P2T"]] {
        for long in [1, 2, 3, 7, 40] {
            let mut session = let_in(SECOND);
            session.wait(long, flash);
            assert_eq!(session.phase("W-1"), Phase::InUse);
            for _ in long..60 {
                let drive = session.drive("P1", Position::Reverse);
                assert!(session.ask(drive, &["W1"]).is_err(), "{flash:?} for {long}");
                assert!(session.drives().is_empty() && session.holds("P1T"), "{flash:?} for {long}");
            }
        }
    }
}

/// What flashes one after the other looks like a train that runs through, and is none.
#[test]
fn flashes_in_the_order_of_a_train_release_nothing_in_front_of_one() {
    for overlap in 0..3 {
        let mut session = let_in(SECOND);
        let train: [&[&str]; 4] = [&["W1", "P1T"], &["W1", "P1T", "1T"], &["W1", "1T"], &["W1", "1T", "P2T"]];
        for seen in train {
            session.wait(1 + overlap, seen);
        }
        session.wait(40, &["W1"]);
        assert!(session.holds("P1T"), "before the release time nothing is released");
        let drive = session.drive("P1", Position::Reverse);
        assert_eq!(session.ask(drive, &["W1"]), Err(Refusal::PointLocked));
    }
}

/// The circuit in front of a train that is 116 m before its signal bobs: another route over the same point is not set.
#[test]
fn a_bobbing_circuit_gives_the_point_to_nobody() {
    for bob in 1..6 {
        let mut session = Session::new("[times]\ncycle_ms = 500\nclear_ms = 2000");
        session.wait(11, &[]);
        session.consent = atc_kernel::interlocking::SegmentSet::ALL;
        let away = session.turn("West", Travel::Away);
        assert_eq!(session.ask(away, &[]), Ok(()));
        let there = ["1T", "2T"];
        session.wait(1, &there);
        let set = session.set("1-W");
        assert_eq!(session.ask(set, &there), Ok(()));
        session.wait(20, &there);
        assert!(session.proceed("1-W"));
        session.wait(bob, &["1T", "2T", "P1T", "W1"]);
        for _ in bob..120 {
            let other = session.set("2-W");
            assert!(session.ask(other, &there).is_err(), "bobbed for {bob}");
            assert!(session.drives().is_empty() && session.holds("P1T"));
        }
    }
}

/// Block counting makes the sections of a disagreement occupied: one machine's safe reaction is no train to the other.
#[test]
fn sections_in_disagreement_release_nothing() {
    for long in [2, 3, 30] {
        let mut session = let_in(SECOND);
        session.wait(1, &["W1"]);
        session.wait(long, &["W1", "P1T", "1T"]);
        session.wait(20, &["W1"]);
        let drive = session.drive("P1", Position::Reverse);
        assert!(session.ask(drive, &["W1"]).is_err() && session.holds("P1T"));
        // It costs a withdrawal, and the release time.
        let withdraw = session.withdraw("W-1");
        assert_eq!(session.ask(withdraw, &["W1"]), Ok(()));
        session.wait(59, &["W1"]);
        assert!(session.holds("P1T"));
        session.wait(1, &["W1"]);
        assert_eq!(session.phase("W-1"), Phase::Idle);
    }
}

/// A train slides into a route that was withdrawn: nobody lets it on, however long it waits.
#[test]
fn a_withdrawn_route_never_grants_again() {
    let mut session = let_in(SECOND);
    let withdraw = session.withdraw("W-1");
    assert_eq!(session.ask(withdraw, &["W1"]), Ok(()));
    for cycle in 0..400 {
        session.wait(1, &["W1", "P1T"]);
        assert!(!session.telegram("P1T").is_open() && !session.telegram("W1").is_open(), "cycle {cycle}");
        assert!(session.holds("P1T") && session.phase("W-1") == Phase::Releasing);
    }
    let again = session.withdraw("W-1");
    assert_eq!(session.ask(again, &["W1", "P1T"]), Ok(()));
    session.wait(200, &["W1", "P1T"]);
    assert!(!session.telegram("P1T").is_open());
    // Once it has gone the route is free.
    session.wait(2, &[]);
    assert_eq!(session.phase("W-1"), Phase::Idle);
}

/// A place that flashes beyond a train that stands in the path, and an overlap under a train that has slid into it.
#[test]
fn an_overlap_is_kept_under_a_train_that_has_slid() {
    for flash in 0..40 {
        let mut session = let_in(SECOND);
        session.wait(flash, &["W1", "P1T", "1T"]);
        session.wait(3, &["W1", "P1T"]);
        session.wait(3, &["P1T", "1T"]);
        session.wait(3, &["1T"]);
        session.wait(40, &["1T", "P2T"]);
        assert!(session.holds("P2T"), "after {flash}");
        let drive = session.drive("P2", Position::Reverse);
        assert!(session.ask(drive, &["1T", "P2T"]).is_err());
    }
}

/// An ordinary train with nobody behind it releases each place as soon as it is clear.
#[test]
fn an_ordinary_train_is_not_delayed() {
    let mut session = let_in(SECOND);
    session.wait(3, &["W1", "P1T"]);
    session.wait(3, &["P1T", "1T"]);
    session.wait(1, &["1T"]);
    assert!(session.holds("P1T"), "T_clear");
    session.wait(1, &["1T"]);
    assert!(!session.holds("P1T"));
    session.wait(40, &["1T"]);
    assert!(session.holds("P2T"));
    session.wait(1, &["1T"]);
    assert!(!session.holds("P2T"), "the stay time has passed since the train is wholly in 1T");
}

/// A train slides into the overlap, stands, changes ends and goes back by another route, with its tail in the overlap. Found by the fifteenth
/// attack: a restriction there did not hold for it.
#[test]
fn a_train_that_goes_back_from_an_overlap_keeps_the_limit_under_its_tail() {
    let slow = SpeedCode(1);
    for slides in [true, false] {
        let mut session = let_in(SECOND);
        session.restrict(&["P2T"], slow, &["W1", "P1T"]);
        session.wait(3, &["W1", "P1T"]);
        session.wait(3, &["P1T", "1T"]);
        session.wait(3, &["1T"]);
        let stands: &[&str] = if slides { &["1T", "P2T"] } else { &["1T"] };
        session.wait(90, stands);
        session.consent = SegmentSet::ALL;
        let away = session.turn("West", Travel::Away);
        // The line's turn time begins.
        assert!(session.ask(away, stands).is_err());
        session.wait(600, stands);
        assert_eq!(session.ask(away, stands), Ok(()));
        let set = session.set("1-W");
        assert_eq!(session.ask(set, stands), Ok(()));
        session.wait(20, stands);
        let telegram = session.telegram("1T");
        assert!(telegram.is_open(), "it may go");
        // Where its tail is not, the restriction is none of its business.
        assert_eq!(telegram.speed == slow, slides, "{telegram:?}");
    }
}
