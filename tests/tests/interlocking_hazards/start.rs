//! After a start the device has forgotten what trains still count on.

use atc_kernel::interlocking::{Position, Refusal, Travel};

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
