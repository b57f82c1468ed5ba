//! After a start the device has forgotten what trains still count on.

use atc_kernel::interlocking::{
    CircuitSet, Input, Layout, Orders, Position, Positions, Refusal, Request, RouteId, State,
};
use atc_kernel::interlocking::{SegmentSet, Travel};
use atc_tests::sketch::{Sketch, Way, circuits};

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

/// ```text
///   ──0──▷──1──|──2──┬──3──▷──4──|──5──       route 0 from 0 to 3, overlap 4; route 1 from 3 over 4; route 2 the other way from 2 over 1;
///                                             route 3, where there is one, from 0 through the platform to 4
/// ```
/// The platform has two circuits, 2 and 3, and a train stands in both when the device starts.
fn platform_of_two(through: bool) -> Sketch {
    let way = Way { drive: 2, release: 2, stay: 4, speed: 1, ..Way::default() };
    let places = |path: &[usize]| path.iter().map(|circuit| (*circuit, Vec::new())).collect();
    let route = |entry: usize, path: &[usize], beyond: usize| Way {
        entry,
        approach: vec![entry],
        path: places(path),
        beyond: vec![beyond],
        ..way.clone()
    };
    let mut routes = vec![
        Way { overlap: (vec![4], Vec::new()), continuing: vec![1], ..route(0, &[1, 2, 3], 4) },
        route(3, &[4], 5),
        Way { leftward: true, ..route(2, &[1], 0) },
    ];
    if through {
        routes.push(route(0, &[1, 2, 3, 4], 5));
    }
    Sketch { lengths: vec![100; 6], routes, braking: vec![0, 100], clear: 1, start: 3, turn: 1, ..Sketch::default() }
}

/// What becomes of a request of each route, long after the start, with these circuits occupied all the time.
fn asked(sketch: &Sketch, occupied: &[usize]) -> Vec<Result<(), Refusal>> {
    let layout = Layout::<4, 4, 0, 0>::new(sketch.plan()).expect("a station");
    let orders = Orders { unblock: CircuitSet::ALL, ..Orders::default() };
    let quiet = Input {
        occupied: circuits(occupied),
        detected: Positions::NONE,
        request: None,
        orders,
        consent: SegmentSet::EMPTY,
    };
    let mut state = State::INITIAL;
    for _ in 0..100 {
        state = layout.cycle(state, quiet).0;
    }
    let ask = |route: usize| {
        let route = RouteId::new(u8::try_from(route).expect("small")).expect("a route");
        let asks = Input { request: Some(Request::Set(route)), ..quiet };
        layout.cycle(state, asks).1.answer.expect("an answer")
    };
    (0..sketch.routes.len()).map(ask).collect()
}

/// A train that stands in two circuits of a platform, or in a platform that a route runs through, may still be on its way; but the route out that begins
/// where it stands is its own, and what is behind it is free.
#[test]
fn a_train_that_is_not_wholly_in_the_last_circuit_leaves_by_its_own_route() {
    for through in [false, true] {
        let said = asked(&platform_of_two(through), &[2, 3]);
        assert_eq!(said[..3], [Err(Refusal::Occupied), Ok(()), Ok(())], "through: {through}");
        // Its front may still come to 3: a route that begins there is for it, and one that begins behind it is for nobody.
        let said = asked(&platform_of_two(through), &[2]);
        assert_eq!(said[1], Ok(()));
        // Somebody is in the throat, and may come into the platform: nobody is let out against him.
        let said = asked(&platform_of_two(through), &[1]);
        assert_eq!(said[1..3], [Ok(()), Err(Refusal::Occupied)]);
    }
}

/// A circuit that was falsely occupied through the start closes what lies ahead of it, for as long as it is; and nothing any more once it is clear.
#[test]
fn a_false_occupancy_through_the_start_closes_what_lies_ahead_of_it() {
    let mut sketch = platform_of_two(false);
    // Another one comes in from the right, and would end in the throat's platform circuit 2.
    let path = vec![(4, Vec::new()), (3, Vec::new()), (2, Vec::new())];
    sketch.routes.push(Way {
        leftward: true,
        entry: 5,
        approach: vec![5],
        path,
        beyond: vec![1],
        ..sketch.routes[1].clone()
    });
    assert_eq!(asked(&sketch, &[1])[3], Err(Refusal::Unswept));
    assert_eq!(asked(&sketch, &[])[3], Ok(()));
}
