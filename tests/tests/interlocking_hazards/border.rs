//! The border: the last circuit of a line, and the stretch beyond it.

use atc_kernel::interlocking::{Heading, SegmentSet, Travel};

use crate::session::Session;

/// A train goes out and stands on the last circuit of the line. Where the neighbour's device sees it too, this device says nothing there, so that
/// the neighbour's telegram counts; and it tells the next train how far it may follow.
#[test]
fn the_neighbour_speaks_in_the_last_circuit() {
    let mut session = Session::sharing(&["W2"]);
    session.wait(9, &[]);
    assert_eq!(session.sent("W2"), None, "nobody is let in");
    session.consent = SegmentSet::ALL;
    let away = session.turn("West", Travel::Away);
    assert_eq!(session.ask(away, &[]), Ok(()));
    session.wait(5, &["W2"]);
    assert_eq!(session.sent("W2"), None);
    // Behind it the next one is told to keep before it.
    session.wait(5, &["W2", "W1"]);
    assert!(!session.telegram("W1").is_open());
    session.wait(30, &["W1"]);
    let told = session.telegram("W1");
    assert!(told.is_open() && told.heading == Some(Heading::Left));
    assert_eq!(told.hold, session.circuits(&["W2"]));
}

/// The line is turned: now this device speaks to those who come, and to nobody who goes.
#[test]
fn this_device_speaks_to_those_who_come() {
    let mut session = Session::sharing(&["W2"]);
    session.wait(9, &[]);
    let toward = session.turn("West", Travel::Toward);
    assert_eq!(session.ask(toward, &[]), Ok(()));
    session.wait(5, &["W2"]);
    let told = session.telegram("W2");
    assert!(told.is_open() && told.heading == Some(Heading::Right));
    assert_eq!(told.hold, session.circuits(&["W1"]));
}

/// Where the views only meet, nobody else is there to speak: the train is told to stop at the border.
#[test]
fn where_nothing_is_shared_the_train_stops_at_the_border() {
    let mut session = Session::new("");
    session.consent = SegmentSet::ALL;
    session.wait(9, &[]);
    let away = session.turn("West", Travel::Away);
    assert_eq!(session.ask(away, &[]), Ok(()));
    session.wait(5, &["W2"]);
    assert!(!session.telegram("W2").is_open());
}
