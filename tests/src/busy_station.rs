//! Stations of the greatest size with trains under way, for the benchmarks. A track has 14 circuits between two stretches of plain
//! line, 16 routes of up to 4 circuits with overlaps and 8 points; a small station has four tracks, a large one 16.

use atc_kernel::interlocking::{
    CircuitSet, Input, LargeStation, Layout, Movement, Orders, Position, Request, RouteId, SegmentId, SegmentSet, Size,
    State, Station, Travel,
};

use crate::sketch::{self, Line, Sketch, Way};

/// The tracks of a small station.
pub const SMALL: usize = 4;
/// The tracks of a large one.
pub const LARGE: usize = 16;
const INNER: usize = 14;
/// How many cycles a train takes for a circuit.
const STRIDE: usize = 4;
/// How many cycles the input has before it begins again.
pub const PERIOD: usize = 4 * (INNER + 2) * STRIDE;

/// The circuit at a place of a row: 0 and 15 are plain line, 1 to 14 the station.
const fn circuit(row: usize, place: usize) -> usize {
    row * (INNER + 2) + place
}

/// The points of a row lie in places 1, 3, …, 13 and 14.
fn point_in(row: usize, place: usize) -> Option<usize> {
    let number = if place == INNER { 7 } else { place / 2 };
    (place <= INNER && (place % 2 == 1 || place == INNER)).then_some(row * 8 + number)
}

fn element(row: usize, place: usize) -> (usize, Vec<sketch::Need>) {
    let needs = point_in(row, place).map(|point| (point, Position::Normal));
    (circuit(row, place), needs.into_iter().collect())
}

/// The route from `entry` over at most four circuits.
fn way(row: usize, entry: usize, rightward: bool) -> Way {
    let far = if rightward { INNER } else { 1 };
    let mut places = Vec::new();
    let mut place = entry;
    while place != far && places.len() < 4 {
        place = if rightward { place + 1 } else { place - 1 };
        places.push(place);
    }
    let beyond = if rightward { place + 1 } else { place - 1 };
    let overlap =
        if place == far { (Vec::new(), Vec::new()) } else { (vec![circuit(row, beyond)], element(row, beyond).1) };
    let (near_line, far_line) = if rightward { (2 * row, 2 * row + 1) } else { (2 * row + 1, 2 * row) };
    Way {
        leftward: !rightward,
        entry: circuit(row, entry),
        approach: vec![circuit(row, entry)],
        path: places.iter().map(|place| element(row, *place)).collect(),
        overlap,
        beyond: vec![circuit(row, beyond)],
        from: (entry == 0 || entry == INNER + 1).then_some(near_line),
        to: (place == far).then_some(far_line),
        drive: 100,
        release: 600,
        stay: 300,
        speed: 5,
        overlap_speed: 5,
        ..Way::default()
    }
}

/// The small station.
///
/// # Panics
/// If the plan breaks a rule.
pub fn station() -> Box<Station> {
    Box::new(Station::new(sketch(SMALL).plan()).expect("the plan keeps the rules"))
}

/// The large station.
///
/// # Panics
/// If the plan breaks a rule.
pub fn large() -> Box<LargeStation> {
    Box::new(LargeStation::new(sketch(LARGE).plan()).expect("the plan keeps the rules"))
}

/// The station with so many tracks.
pub fn sketch(rows: usize) -> Sketch {
    let mut sketch = Sketch {
        lengths: vec![200; 16 * rows],
        braking: vec![0, 20, 60, 150, 250, 400, 600, 900],
        clear: 2,
        turn: 50,
        ..Sketch::default()
    };
    for row in 0..rows {
        for place in (1..=INNER).filter(|place| point_in(row, *place).is_some()) {
            sketch.points.push(vec![circuit(row, place)]);
        }
        sketch.routes.extend((0..INNER - 1).map(|entry| way(row, entry, true)));
        sketch.routes.extend([INNER + 1, INNER - 3, INNER - 7].map(|entry| way(row, entry, false)));
        for (outer, throat) in [(0, 1), (INNER + 1, INNER)] {
            let circuits = vec![circuit(row, outer)];
            sketch.segments.push(Line { circuits, throat: Some(circuit(row, throat)), leftward: outer == 0 });
        }
    }
    for one in 0..sketch.routes.len() {
        let (last, leftward) = (sketch.routes[one].last(), sketch.routes[one].leftward);
        let follows = |other: &usize| sketch.routes[*other].entry == last && sketch.routes[*other].leftward == leftward;
        sketch.routes[one].continuing = (0..sketch.routes.len()).filter(follows).collect();
    }
    sketch.apart()
}

/// The inputs that put the station in service: everything clear and unblocked, trains come from the left.
///
/// # Panics
/// Never: there are at most 32 segments.
pub fn service<Z: Size>(rows: usize) -> Vec<Input<Z>> {
    let quiet = quiet(rows);
    let orders = Orders { unblock: CircuitSet::ALL, lift: CircuitSet::ALL, ..Orders::default() };
    let mut inputs = vec![Input { orders, ..quiet }; 60];
    for (segment, travel) in (0..2 * rows).zip([Travel::Toward, Travel::Away].into_iter().cycle()) {
        let segment = u8::try_from(segment).ok().and_then(SegmentId::new).expect("a segment");
        inputs.push(Input { request: Some(Request::Turn(segment, travel)), ..quiet });
    }
    inputs
}

fn quiet<Z: Size>(rows: usize) -> Input<Z> {
    let normal = (0..8 * rows).map(|point| (point, Position::Normal)).collect::<Vec<_>>();
    Input {
        occupied: CircuitSet::EMPTY,
        detected: sketch::positions(&normal),
        request: None,
        orders: Orders::default(),
        consent: SegmentSet::ALL,
    }
}

/// A period of traffic: a train in each row from left to right, with the routes that it needs asked for as it comes to them.
///
/// # Panics
/// Never: there are at most 256 routes.
pub fn traffic<Z: Size>(rows: usize) -> Vec<Input<Z>> {
    let cycle = |now: usize| {
        let mut input = quiet(rows);
        for row in 0..rows {
            let along = (now + PERIOD - row * 7) % PERIOD;
            let place = along / STRIDE;
            if place < INNER + 2 {
                input.occupied = input.occupied.or(CircuitSet::nth(circuit(row, place)));
                // Its tail is still in the circuit behind for half of the time.
                if place > 0 && along % STRIDE < STRIDE / 2 {
                    input.occupied = input.occupied.or(CircuitSet::nth(circuit(row, place - 1)));
                }
                if place.is_multiple_of(4) && place < INNER && along % STRIDE == 2 * row % STRIDE {
                    let route = u8::try_from(row * 16 + place).expect("a route");
                    input.request = RouteId::new(route).map(Request::Set);
                }
            }
        }
        input
    };
    (0..PERIOD).map(cycle).collect()
}

/// A cycle with a train in every circuit.
pub fn full<Z: Size>(rows: usize) -> Vec<Input<Z>> {
    vec![Input { occupied: CircuitSet::ALL, ..quiet(rows) }]
}

/// Steps the station in service with these inputs over and over, `count` cycles with their telegrams; the last telegram of circuit 0,
/// and how many routes were set.
pub fn run<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    station: &Layout<R, P, N, S, Z>,
    inputs: &[Input<Z>],
    count: u64,
) -> (Movement<Z>, u64) {
    let mut state = State::INITIAL;
    let (mut last, mut set) = (Movement::stop_in(atc_kernel::interlocking::CircuitId::ZERO), 0);
    let steps = inputs.iter().cycle().take(usize::try_from(count).unwrap_or(usize::MAX));
    for input in service(R / 16).iter().chain(steps) {
        let (next, output) = station.cycle(state, *input);
        state = next;
        last = station.telegrams(&output.table, state.epoch)[0].unwrap_or(last);
        set += u64::from(matches!((input.request, output.answer), (Some(Request::Set(_)), Some(Ok(())))));
    }
    (last, set)
}

#[cfg(test)]
mod tests {
    use super::{LARGE, PERIOD, SMALL, full, large, run, station, traffic};

    /// Every route that is asked for is set, in every period: the trains run.
    #[test]
    fn the_trains_run() {
        // A layout of this size is moved some times.
        let thread = std::thread::Builder::new().stack_size(64 << 20).spawn(run_them).expect("a thread");
        if let Err(panic) = thread.join() {
            std::panic::resume_unwind(panic);
        }
    }

    fn run_them() {
        let period = PERIOD as u64;
        let station = station();
        assert_eq!(run(&station, &traffic(SMALL), period).1, 16);
        assert_eq!(run(&station, &traffic(SMALL), 3 * period).1, 48);
        assert_eq!(run(&station, &full(SMALL), 10).1, 0);
        assert_eq!(run(&large(), &traffic(LARGE), period).1, 64);
    }
}
