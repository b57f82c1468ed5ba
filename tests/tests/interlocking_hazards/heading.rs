//! The direction of travel: a train at a platform hears of a route that leads the other way.

use atc_kernel::interlocking::{CircuitId, Heading, Movement, Refusal, SegmentSet, Travel};

use crate::session::Session;

/// A train stands in a platform from which a route is set to the west. The telegram is for a train that faces left; one that faces right, or does
/// not know, has none.
#[test]
fn a_train_that_faces_the_other_way_has_no_telegram() {
    for (platform, route, other) in [("1T", "1-W", "1-E"), ("2T", "2-W", "2-E")] {
        for (segment, exit, faces) in [("West", route, Heading::Left), ("East", other, Heading::Right)] {
            let mut session = Session::new("");
            session.wait(20, &[platform]);
            if platform == "2T" {
                session.reverse();
            }
            session.consent = SegmentSet::ALL;
            let away = session.turn(segment, Travel::Away);
            assert_eq!(session.ask(away, &[platform]), Ok(()));
            let set = session.set(exit);
            assert_eq!(session.ask(set, &[platform]), Ok(()));
            session.wait(20, &[platform]);
            let (here, telegram) = (circuit(&session, platform), session.telegram(platform));
            assert!(session.proceed(exit) && telegram.is_open());
            assert_eq!(telegram.facing(here, Some(faces)), telegram);
            assert_eq!(telegram.facing(here, Some(faces.opposite())), Movement::stop_in(here));
            assert_eq!(telegram.facing(here, None), Movement::stop_in(here));
        }
    }
}

/// Two routes that start from one platform in opposite directions are not held at once: of whom would the telegram be?
#[test]
fn opposing_starts_exclude_each_other() {
    let mut session = Session::new("");
    session.wait(20, &["1T"]);
    session.consent = SegmentSet::ALL;
    for segment in ["West", "East"] {
        let away = session.turn(segment, Travel::Away);
        assert_eq!(session.ask(away, &["1T"]), Ok(()));
    }
    let (west, east) = (session.set("1-W"), session.set("1-E"));
    assert_eq!(session.ask(west, &["1T"]), Ok(()));
    assert_eq!(session.ask(east, &["1T"]), Err(Refusal::Conflict));
}

fn circuit(session: &Session, name: &str) -> CircuitId {
    session.circuits(&[name]).first().expect("a circuit")
}
