//! A point that was told to move may leave later than it is looked at.

use atc_kernel::interlocking::{PointId, Position, Positions, Travel};

use crate::session::Session;

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
