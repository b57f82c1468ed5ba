//! What a false occupancy costs: `spec/interlocking.md`, "What a false occupancy costs", row by row.
//!
//! One train runs through the passing loop from W to E, and goes by its telegrams. In each session one circuit is falsely occupied, for some
//! cycles from some cycle on; every circuit, every beginning and three durations are tried. A dispatcher asks for the two routes until they are set, and for
//! what was withdrawn anew; where the train stands before a route that is held and does not move for [`PATIENCE`] cycles, or a route is still held as long
//! behind the train, the dispatcher withdraws it. Compared with the session without false occupancy: how much later the train arrives, how much later
//! the circuits are given up, and what the dispatcher has to do.

use std::collections::BTreeMap;

use atc_kernel::interlocking::{
    CircuitSet, Input, Orders, Position, Positions, Request, RouteId, RouteState, SegmentId, SegmentSet, State, Travel,
};
use atc_tests::passing_loop::loop_station;
use atc_tests::sketch;
use atc_tests::station_chart::Small;

/// The circuits from a to h, in the order in which the train runs over them.
const WAY: [usize; 7] = [0, 1, 2, 3, 5, 6, 7];
/// Cycles for which the train is in one circuit, and in two, before it goes on.
const STEP: u16 = 2;
/// Cycles after which the dispatcher withdraws what does not go on.
const PATIENCE: u16 = 12;
/// No session is longer.
const END: u16 = 400;
/// How long a circuit is falsely occupied.
const DURATIONS: [u16; 3] = [1, 4, 16];

/// The worst, by where the circuit is as seen from the train when it begins, and by its duration in cycles: how many cycles later the train arrives, how
/// many cycles later the last circuit is given up, requests and withdrawals more; and the number of sessions.
const WORST: [(&str, u16, [u16; 5]); 18] = [
    ("beside the way", 1, [0, 0, 0, 0, 28]),
    ("beside the way", 4, [0, 0, 0, 0, 28]),
    ("beside the way", 16, [0, 0, 0, 0, 28]),
    ("farther ahead", 1, [32, 32, 1, 2, 50]),
    ("farther ahead", 4, [35, 35, 1, 2, 50]),
    ("farther ahead", 16, [49, 49, 2, 3, 50]),
    ("farther behind", 1, [0, 0, 0, 0, 60]),
    ("farther behind", 4, [0, 0, 0, 0, 60]),
    ("farther behind", 16, [0, 0, 0, 0, 60]),
    ("just behind", 1, [0, 1, 0, 0, 24]),
    ("just behind", 4, [0, 26, 0, 1, 24]),
    ("just behind", 16, [0, 26, 0, 1, 24]),
    ("next ahead", 1, [31, 31, 1, 2, 22]),
    ("next ahead", 4, [31, 31, 1, 2, 22]),
    ("next ahead", 16, [31, 31, 1, 2, 22]),
    ("under the train", 1, [0, 0, 0, 0, 40]),
    ("under the train", 4, [0, 3, 0, 0, 40]),
    ("under the train", 16, [0, 26, 0, 1, 40]),
];

/// A circuit that is falsely occupied.
#[derive(Clone, Copy, Debug)]
struct False {
    circuit: usize,
    from: u16,
    cycles: u16,
}

/// How a session went.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Session {
    /// The cycle in which the train was gone.
    gone: u16,
    /// The cycle from which nothing was held any more.
    free: u16,
    /// Requests that were accepted.
    set: u16,
    /// Routes that the dispatcher had to withdraw.
    withdrawn: u16,
    /// Where the train was when it began: the place of its front and of its rear in its way.
    front: usize,
    rear: usize,
}

/// The train: wholly in the circuit of an even place's half, in two of an odd one.
#[derive(Clone, Copy, Debug)]
struct Train {
    half: usize,
    since: u16,
}

impl Train {
    fn front(self) -> usize {
        self.half.div_ceil(2)
    }

    fn rear(self) -> usize {
        self.half / 2
    }

    fn is_gone(self) -> bool {
        self.rear() >= WAY.len()
    }

    fn circuits(self) -> CircuitSet {
        let all: Vec<_> = [self.rear(), self.front()].iter().filter_map(|place| WAY.get(*place).copied()).collect();
        sketch::circuits(&all)
    }
}

fn route(number: u8) -> RouteId {
    RouteId::new(number).expect("a route")
}

/// The station in service, with trains from W to E.
fn in_service(layout: &Small, quiet: Input) -> State<8, 2> {
    let orders = Orders { unblock: CircuitSet::ALL, lift: CircuitSet::ALL, ..Orders::default() };
    let mut state = State::INITIAL;
    for _ in 0..3 {
        state = layout.cycle(state, Input { orders, ..quiet }).0;
    }
    for (segment, travel) in [(0, Travel::Toward), (1, Travel::Away)] {
        let request = SegmentId::new(segment).map(|segment| Request::Turn(segment, travel));
        state = layout.cycle(state, Input { request, ..quiet }).0;
    }
    state
}

/// What the dispatcher does in a cycle.
fn request(state: &State<8, 2>, train: Train, waited: u16, withdrawn: &[u8]) -> Option<Request> {
    // The first route is over when the train is wholly behind it, the second one when it is out.
    [(0, 3), (2, 5)].into_iter().find_map(|(number, last)| {
        let it = &state.routes[usize::from(number)];
        if withdrawn.contains(&number) {
            return None;
        }
        let over = train.rear() >= last;
        if over {
            return (it.is_held() && waited > PATIENCE).then(|| Request::Withdraw(route(number)));
        }
        if !it.is_held() || it.may_resume() {
            return Some(Request::Set(route(number)));
        }
        // The train stands in front of it.
        let in_front = train.front() == last - 2 && number == 0 || train.front() == 3 && number == 2;
        (in_front && waited > PATIENCE).then(|| Request::Withdraw(route(number)))
    })
}

fn session(layout: &Small, wrong: Option<False>) -> Session {
    let quiet = Input {
        occupied: CircuitSet::EMPTY,
        detected: Positions::of(atc_kernel::interlocking::PointId::ZERO, Position::Normal)
            .or(sketch::positions(&[(1, Position::Normal)])),
        request: None,
        orders: Orders::default(),
        consent: SegmentSet::ALL,
    };
    let mut state = in_service(layout, quiet);
    let mut train = Train { half: 0, since: 0 };
    let mut how = Session::default();
    let mut waited = 0;
    // Withdrawn by the dispatcher, and not released yet.
    let mut withdrawn = Vec::new();
    for now in 1..END {
        let is_false = wrong.filter(|wrong| (wrong.from..wrong.from + wrong.cycles).contains(&now));
        if wrong.is_some_and(|wrong| wrong.from == now) {
            (how.front, how.rear) = (train.front(), train.rear());
        }
        let falsely = is_false.map_or(CircuitSet::EMPTY, |wrong| CircuitSet::nth(wrong.circuit));
        withdrawn.retain(|route| state.routes[usize::from(*route)].is_held());
        let request = request(&state, train, waited, &withdrawn);
        let (next, output) = layout.cycle(state, Input { occupied: train.circuits().or(falsely), request, ..quiet });
        if output.answer == Some(Ok(())) {
            match request {
                Some(Request::Withdraw(route)) => {
                    (how.withdrawn, waited) = (how.withdrawn + 1, 0);
                    withdrawn.push(route.number());
                }
                _ => how.set += 1,
            }
        }
        let held = next.routes.iter().any(RouteState::is_held);
        if held {
            how.free = now + 1;
        }
        state = next;
        // The train goes on if its telegram lets it, and what is in two circuits always does.
        let told = |circuit: usize| layout.telegrams(&output.table, state.epoch)[circuit];
        let may = match (train.half % 2, WAY.get(train.front()), WAY.get(train.front() + 1)) {
            (1, ..) | (_, Some(_), None) => true,
            (_, Some(here), Some(next)) => told(*here).is_some_and(|it| it.hold.meets(CircuitSet::nth(*next))),
            (_, None, _) => false,
        };
        train.since += 1;
        if !train.is_gone() && may && train.since >= STEP {
            train = Train { half: train.half + 1, since: 0 };
            waited = 0;
        } else {
            waited += 1;
        }
        if train.is_gone() && how.gone == 0 {
            how.gone = now;
        }
        if train.is_gone() && !held && wrong.is_none_or(|wrong| now > wrong.from + wrong.cycles) {
            return how;
        }
    }
    panic!("the train does not arrive, or a route stays: {wrong:?}, {train:?}, {state:?}");
}

/// Where a circuit is, seen from the train.
fn place(wrong: False, how: &Session) -> &'static str {
    match WAY.iter().position(|circuit| *circuit == wrong.circuit) {
        None => "beside the way",
        Some(place) if place > how.front + 1 => "farther ahead",
        Some(place) if place == how.front + 1 => "next ahead",
        Some(place) if place >= how.rear => "under the train",
        Some(place) if place + 1 == how.rear => "just behind",
        Some(_) => "farther behind",
    }
}

#[test]
fn what_a_false_occupancy_costs() {
    let layout = Small::new(loop_station().plan()).expect("a station");
    let usual = session(&layout, None);
    let mut worst: BTreeMap<(&str, u16), [u16; 5]> = BTreeMap::new();
    for circuit in 0..8 {
        for from in 1..=usual.gone {
            for cycles in DURATIONS {
                let wrong = False { circuit, from, cycles };
                let how = session(&layout, Some(wrong));
                let cost = [
                    how.gone.saturating_sub(usual.gone),
                    how.free.saturating_sub(usual.free),
                    how.set.saturating_sub(usual.set),
                    how.withdrawn,
                    1,
                ];
                let all = worst.entry((place(wrong, &how), cycles)).or_default();
                for (place, (most, its)) in all.iter_mut().zip(cost).enumerate() {
                    *most = if place == 4 { *most + 1 } else { its.max(*most) };
                }
            }
        }
    }
    let found: Vec<_> = worst.into_iter().map(|((place, cycles), cost)| (place, cycles, cost)).collect();
    assert_eq!((usual.gone, usual.free, usual.set, usual.withdrawn), (28, 21, 2, 0));
    assert_eq!(found, WORST, "the table of the specification is another one");
}
