//! The throat: out to the line goes who has a route there, and nobody else.

use atc_kernel::interlocking::{Phase, PointId, Position, Positions, SegmentSet, Travel};

use crate::session::Session;

/// The points with the eastern one in reverse, or detected nowhere.
fn eastern(position: Option<Position>) -> Positions {
    let point = |number: u8, position| Positions::of(PointId::new(number).expect("a point"), position);
    let western = point(0, Position::Normal);
    position.map_or(western, |position| western.or(point(1, position)))
}

/// A station whose eastern line is travelled outwards, and the route out to it has a train with its front in the throat.
fn on_its_way_out() -> Session {
    let mut session = Session::new("");
    session.consent = SegmentSet::ALL;
    let away = session.turn("East", Travel::Away);
    assert_eq!(session.ask(away, &[]), Ok(()));
    let set = session.set("1-E");
    assert_eq!(session.ask(set, &["1T"]), Ok(()));
    assert!(session.telegram("1T").is_open());
    session.wait(2, &["1T", "P2T"]);
    session
}

/// A train that came by no route out is told to stop in the throat, however free the line is.
#[test]
fn a_train_that_has_slid_into_the_throat_is_not_sent_out() {
    let mut session = Session::new("");
    session.consent = SegmentSet::ALL;
    let away = session.turn("East", Travel::Away);
    assert_eq!(session.ask(away, &[]), Ok(()));
    let toward = session.turn("West", Travel::Toward);
    assert_eq!(session.ask(toward, &[]), Ok(()));
    session.wait(100, &["W1"]);
    let set = session.set("W-1");
    assert_eq!(session.ask(set, &["W1"]), Ok(()));
    session.wait(5, &["W1", "P1T"]);
    session.wait(5, &["P1T", "1T"]);
    session.wait(5, &["1T"]);
    for _ in 0..200 {
        session.wait(1, &["1T", "P2T"]);
        assert!(!session.telegram("P2T").is_open(), "slid past its signal");
    }
}

/// A route out is withdrawn with its train in the throat: the line is granted again only when the route is asked for anew.
#[test]
fn a_withdrawn_route_out_sends_nobody_out() {
    let mut session = on_its_way_out();
    assert_eq!(session.telegram("P2T").hold, session.circuits(&["E1", "E2"]));
    let withdraw = session.withdraw("1-E");
    assert_eq!(session.ask(withdraw, &["1T", "P2T"]), Ok(()));
    for position in [Some(Position::Normal), None, Some(Position::Reverse), Some(Position::Normal)] {
        session.detected = eastern(position);
        for _ in 0..20 {
            session.wait(1, &["1T", "P2T"]);
            assert!(!session.telegram("P2T").is_open(), "withdrawn, point {position:?}");
        }
    }
    let set = session.set("1-E");
    assert_eq!(session.ask(set, &["1T", "P2T"]), Ok(()));
    session.wait(1, &["P2T"]);
    assert_eq!((session.phase("1-E"), session.telegram("P2T").is_open()), (Phase::InUse, true));
}

/// The point under the train in the throat is lost, or lies the other way: it goes nowhere until the point is right again.
#[test]
fn a_point_that_is_lost_in_the_throat_stops_the_train() {
    let mut session = on_its_way_out();
    for position in [None, Some(Position::Reverse)] {
        session.detected = eastern(position);
        session.wait(1, &["P2T"]);
        assert!(!session.telegram("P2T").is_open(), "point {position:?}");
        session.wait(30, &["P2T"]);
    }
    session.detected = eastern(Some(Position::Normal));
    session.wait(200, &["P2T"]);
    assert!(session.telegram("P2T").is_open());
}
