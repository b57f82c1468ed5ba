//! A point that was told to move may leave later than it is looked at.

use atc_kernel::interlocking::{Phase, PointId, Position, Positions, Refusal, SegmentSet, Travel};

use crate::session::Session;

/// Enough cycles for a point of the terminus that stands to count as detected: its settling time is 1 s, its cycle 100 ms.
const SETTLED: usize = 12;

/// P1 is driven by hand, and W-1 set over it as it was detected. However late the point leaves within the settling time, W-1 shows nothing.
#[test]
fn a_point_that_leaves_after_an_individual_command_had_no_route_over_it() {
    for settle in 1..4_usize {
        // The command of a cycle goes out after its detections came in: what leaves within the time is seen one cycle later.
        for leaves in 0..=settle + 1 {
            let mut session =
                Session::new(&format!("[times]\ncycle_ms = 1000\nthrow_ms = 5000\nsettle_ms = {settle}000"));
            session.wait(9, &[]);
            let toward = session.turn("West", Travel::Toward);
            assert_eq!(session.ask(toward, &[]), Ok(()));
            let drive = session.drive("P1", Position::Reverse);
            assert_eq!(session.ask(drive, &["W1"]), Ok(()));
            assert!(!session.drives().is_empty());
            let set = session.set("W-1");
            let there = session.detected;
            for cycle in 1..20 {
                // The machine obeys the old command, whatever is commanded since.
                if cycle >= leaves.max(1) {
                    session.detected = there.without(PointId::ZERO.alone());
                }
                if cycle == 1 {
                    assert_eq!(session.ask(set, &["W1"]), Ok(()));
                } else {
                    session.wait(1, &["W1"]);
                }
                assert!(!session.proceed("W-1"), "settles for {settle}, leaves after {leaves}");
                assert!(!session.telegram("W1").is_open());
            }
        }
    }
}

/// A point that has stood is there at once: nothing is delayed where nothing was driven.
#[test]
fn a_point_that_was_not_driven_delays_nothing() {
    let mut session = Session::new("[times]\ncycle_ms = 1000");
    session.wait(9, &[]);
    let toward = session.turn("West", Travel::Toward);
    assert_eq!(session.ask(toward, &[]), Ok(()));
    let set = session.set("W-1");
    assert_eq!(session.ask(set, &["W1"]), Ok(()));
    assert!(session.proceed("W-1"));
    assert_ne!(session.detected, Positions::NONE);
}

/// A terminus whose line out is turned away, with a train in platform 3. The route 3-D needs P4 in normal position as flank protection, beside its path.
fn before_departure(p4: Option<Position>) -> Session {
    let mut session = Session::terminus();
    let others = ["P1", "P2", "P3", "P5"].map(|name| (name, Position::Normal));
    session.lie(&others.into_iter().chain(p4.map(|position| ("P4", position))).collect::<Vec<_>>());
    session.consent = SegmentSet::ALL;
    let away = session.turn("Departures", Travel::Away);
    let turned = (0..2_000).any(|_| session.ask(away, &["3T"]).is_ok());
    assert!(turned);
    session
}

/// Staff are at P4, in a confirmed block. A route that needs it elsewhere as flank protection is refused, like a command by hand.
#[test]
fn a_point_among_staff_is_not_driven_for_a_route_beside_it() {
    let mut session = before_departure(Some(Position::Reverse));
    session.block(&["P4T"], &["3T"]);
    session.wait(SETTLED, &["3T"]);
    assert!(session.is_confirmed("P4T"));
    for request in [session.drive("P4", Position::Normal), session.set("3-D")] {
        assert_eq!(session.ask(request, &["3T"]), Err(Refusal::Blocked));
        assert!(session.drives().is_empty());
    }
    // Where it lies right nothing moves, and it is not driven when staff move it by hand.
    let mut session = before_departure(Some(Position::Normal));
    session.block(&["P4T"], &["3T"]);
    session.wait(SETTLED, &["3T"]);
    assert!(session.is_confirmed("P4T"));
    let set = session.set("3-D");
    assert_eq!(session.ask(set, &["3T"]), Ok(()));
    session.lie(&["P1", "P2", "P3", "P5"].map(|name| (name, Position::Normal)));
    for _ in 0..50 {
        session.wait(1, &["3T"]);
        assert!(session.drives().is_empty());
    }
    assert!(session.is_confirmed("P4T"));
}

/// The block comes while the route drives the point: the drive ends at once, and staff may rely on the block when no route needs the point any more.
#[test]
fn a_block_ends_a_drive_and_is_confirmed_when_no_route_needs_the_point() {
    let mut session = before_departure(None);
    let set = session.set("3-D");
    assert_eq!(session.ask(set, &["3T"]), Ok(()));
    assert!(!session.drives().is_empty());
    session.block(&["P4T"], &["3T"]);
    assert!(session.drives().is_empty());
    while session.phase("3-D") != Phase::Failed {
        assert!(!session.is_confirmed("P4T"));
        session.wait(1, &["3T"]);
    }
    assert!(!session.is_confirmed("P4T"));
    let withdraw = session.withdraw("3-D");
    assert_eq!(session.ask(withdraw, &["3T"]), Ok(()));
    // Nobody drives it any more, and where it is nobody knows: its stroke goes on.
    session.wait(300, &["3T"]);
    assert!(!session.is_confirmed("P4T") && session.drives().is_empty());
    arrives(&mut session, Position::Normal);
}

/// P4 comes to a stand, and settles: then staff may rely on the block.
fn arrives(session: &mut Session, at: Position) {
    let all = ["P1", "P2", "P3", "P5"].map(|name| (name, Position::Normal));
    session.lie(&all.into_iter().chain([("P4", at)]).collect::<Vec<_>>());
    let mut waited = 0;
    while !session.is_confirmed("P4T") {
        session.wait(1, &["3T"]);
        waited += 1;
        assert!(waited <= SETTLED, "it has stood for {waited} cycles");
    }
    assert!(waited > 1, "it was confirmed at once");
}

/// The fourteenth attack: the block comes in the cycle after a drive, by hand or of a route that is withdrawn, before the point leaves. It leaves among
/// staff, if they rely on the block.
#[test]
fn a_block_is_not_confirmed_while_a_point_that_was_driven_may_leave() {
    for by_hand in [true, false] {
        let mut session = before_departure(Some(Position::Reverse));
        session.wait(SETTLED, &["3T"]);
        let drive = if by_hand { session.drive("P4", Position::Normal) } else { session.set("3-D") };
        assert_eq!(session.ask(drive, &["3T"]), Ok(()));
        assert!(!session.drives().is_empty());
        if !by_hand {
            let withdraw = session.withdraw("3-D");
            assert_eq!(session.ask(withdraw, &["3T"]), Ok(()));
        }
        // It is still detected where it was.
        session.block(&["P4T"], &["3T"]);
        assert!(!session.is_confirmed("P4T") && session.drives().is_empty());
        session.lie(&["P1", "P2", "P3", "P5"].map(|name| (name, Position::Normal)));
        for _ in 0..100 {
            session.wait(1, &["3T"]);
            assert!(!session.is_confirmed("P4T"));
        }
        arrives(&mut session, Position::Normal);
    }
}
