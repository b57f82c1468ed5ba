//! Charts of the interlocking in ASCII: what a small station reads and what it does, cycle by cycle.
//!
//! ```text
//! occ b      ..####..      circuit b is reported occupied
//! point P    nnn..rrr      P is detected normal, in no position, reverse; x: in both
//! set 0      .#......      route 0 is asked for
//! answer     .+......      and accepted
//! phase 0    .ppsssss      its phase, at the end of each cycle
//! ```
//!
//! A column is one logic cycle. `#` is on, `.` is off or none. What is read, each row left out if nothing of it happens: `occ`,
//! `point` (normal without the row), `set`, `withdraw`, `drive` (`n`, `r`), `turn` (`t` toward, `a` away), `block`, `unblock`, and
//! `consent` (without it the neighbours always permit). What must be put out, as far as rows of it are drawn:
//!
//! * `answer`: `+` accepted; refused: `h` held already, `n` not held, `c` conflict, `p` path held, `v` overlap held, `l` point locked,
//!   `o` occupied, `b` blocked, `u` point under a train, `d` direction, `w` waiting.
//! * `phase` of a route: `p` provisional, `f` failed, `s` set, `u` in use, `r` releasing. `signal`: `#` proceed.
//! * `held` circuit: the routes that hold it, the overlap as well (`*` for several). `drives` point: `n`, `r`.
//! * `stop` circuit: the circuit up to which the train there may run; `speed` circuit: the code it is told.
//! * `permits` segment, `confirmed` circuit.

use atc_kernel::interlocking::{
    CircuitSet, Input, Layout, Orders, Output, Phase, PointId, Position, Positions, Refusal, Request, RouteId,
    SegmentId, SegmentSet, State, Travel,
};

use crate::sketch::{self, Sketch};

/// Room for a small station.
pub type Small = Layout<8, 3, 2, 2>;

/// Circuits are called a, b, …; points P and Q; routes 0, 1, …; segments W and E.
fn number(name: &str) -> usize {
    let letter = name.chars().next().unwrap_or('?');
    let first = match letter {
        'a'..='z' => 'a',
        'P' | 'Q' => 'P',
        '0'..='9' => '0',
        'W' => 'W',
        'E' => return 1,
        _ => panic!("{name:?} is the name of nothing"),
    };
    letter as usize - first as usize
}

fn letter(circuit: usize) -> char {
    char::from(b'a' + u8::try_from(circuit).expect("few circuits"))
}

struct Chart<'a> {
    rows: Vec<(&'a str, &'a str, &'a str)>,
    cycles: usize,
}

impl<'a> Chart<'a> {
    fn read(text: &'a str) -> Self {
        let mut rows = Vec::new();
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
            let words: Vec<_> = line.split_whitespace().collect();
            match *words.as_slice() {
                [kind, row] => rows.push((kind, "", row)),
                [kind, name, row] => rows.push((kind, name, row)),
                _ => panic!("{line:?} is not a row"),
            }
        }
        let cycles = rows.first().map_or(0, |row| row.2.len());
        assert!(cycles > 0 && rows.iter().all(|row| row.2.len() == cycles), "the rows are not of one length: {text}");
        Self { rows, cycles }
    }

    /// What the rows of a kind say in a cycle, with what they are about; nothing where they say `.`.
    fn at(&self, kind: &str, cycle: usize) -> Vec<(usize, char)> {
        let rows = self.rows.iter().filter(|row| row.0 == kind);
        let signs = rows.map(|row| (number(row.1), row.2.as_bytes()[cycle].into()));
        signs.filter(|sign| sign.1 != '.').collect()
    }

    fn circuits(&self, kind: &str, cycle: usize) -> CircuitSet {
        let numbers: Vec<_> = self.at(kind, cycle).iter().map(|sign| sign.0).collect();
        sketch::circuits(&numbers)
    }

    fn input(&self, cycle: usize) -> Input {
        let mut detected = Vec::new();
        for point in 0..2 {
            let row = self.rows.iter().find(|row| row.0 == "point" && number(row.1) == point);
            let sign = row.map_or('n', |row| row.2.as_bytes()[cycle].into());
            if matches!(sign, 'n' | 'x') {
                detected.push((point, Position::Normal));
            }
            if matches!(sign, 'r' | 'x') {
                detected.push((point, Position::Reverse));
            }
        }
        let orders = Orders {
            block: self.circuits("block", cycle),
            unblock: self.circuits("unblock", cycle),
            ..Orders::default()
        };
        let drawn: Vec<_> = self.at("consent", cycle).iter().map(|sign| sign.0).collect();
        let silent = self.rows.iter().all(|row| row.0 != "consent");
        Input {
            occupied: self.circuits("occ", cycle),
            detected: sketch::positions(&detected),
            request: self.request(cycle),
            orders,
            consent: if silent { SegmentSet::ALL } else { sketch::segments(&drawn) },
        }
    }

    fn request(&self, cycle: usize) -> Option<Request> {
        let small = |number: usize| u8::try_from(number).expect("small");
        let route = |number: usize| RouteId::new(small(number)).expect("a route");
        let mut all = Vec::new();
        all.extend(self.at("set", cycle).iter().map(|sign| Request::Set(route(sign.0))));
        all.extend(self.at("withdraw", cycle).iter().map(|sign| Request::Withdraw(route(sign.0))));
        all.extend(self.at("drive", cycle).iter().map(|(point, side)| {
            let position = if *side == 'n' { Position::Normal } else { Position::Reverse };
            Request::Drive(PointId::new(small(*point)).expect("a point"), position)
        }));
        all.extend(self.at("turn", cycle).iter().map(|(segment, way)| {
            let travel = if *way == 't' { Travel::Toward } else { Travel::Away };
            Request::Turn(SegmentId::new(small(*segment)).expect("a segment"), travel)
        }));
        assert!(all.len() < 2, "two requests in one cycle: {all:?}");
        all.pop()
    }
}

/// The sign for one row of what is put out.
fn sign(layout: &Small, state: &State<8, 2>, output: &Output<8>, kind: &str, name: &str) -> char {
    let it = if name.is_empty() { 0 } else { number(name) };
    let on = |is: bool| if is { '#' } else { '.' };
    let movement = || layout.telegrams(&output.table, state.epoch)[it].expect("a circuit that no neighbour sees");
    match kind {
        "answer" => match output.answer {
            None => '.',
            Some(Ok(())) => '+',
            Some(Err(refusal)) => refused(refusal),
        },
        "phase" => match state.routes[it].phase {
            Phase::Idle => '.',
            Phase::Provisional => 'p',
            Phase::Failed => 'f',
            Phase::Set => 's',
            Phase::InUse => 'u',
            Phase::Releasing => 'r',
        },
        "signal" => on(output.proceed.bits() >> it & 1 == 1),
        "held" => {
            let routes = layout.plan().routes.iter().zip(&state.routes).zip('0'..);
            let holding: Vec<_> = routes
                .filter(|((route, state), _)| state.circuits(route).meets(CircuitSet::nth(it)))
                .map(|(_, number)| number)
                .collect();
            match holding.as_slice() {
                [] => '.',
                [one] => *one,
                _ => '*',
            }
        }
        "drives" => {
            let meets = |positions: Positions| positions.points().bits() >> it & 1 == 1;
            let reverse = Positions { normal: atc_kernel::interlocking::PointSet::EMPTY, ..output.drives };
            match (meets(output.drives), meets(reverse)) {
                (false, _) => '.',
                (true, reverse) => {
                    if reverse {
                        'r'
                    } else {
                        'n'
                    }
                }
            }
        }
        "stop" => {
            let movement = movement();
            if movement.is_open() { letter(movement.stop.number().into()) } else { '.' }
        }
        "speed" => char::from(b'0' + movement().speed.0),
        "permits" => on(output.permits.meets(SegmentSet::nth(it))),
        "confirmed" => on(output.confirmed.meets(CircuitSet::nth(it))),
        other => panic!("there is no row called {other:?}"),
    }
}

const fn refused(refusal: Refusal) -> char {
    match refusal {
        Refusal::Unknown => '?',
        Refusal::AlreadyHeld => 'h',
        Refusal::Starting => '*',
        Refusal::NotHeld => 'n',
        Refusal::Conflict => 'c',
        Refusal::PathHeld => 'p',
        Refusal::OverlapHeld => 'v',
        Refusal::PointLocked => 'l',
        Refusal::Occupied => 'o',
        Refusal::NotCalledFor => 'x',
        Refusal::Unswept => 's',
        Refusal::Blocked => 'b',
        Refusal::PointUnderTrain => 'u',
        Refusal::Direction => 'd',
        Refusal::Waiting => 'w',
    }
}

/// Which direction the segments have before a chart begins.
#[derive(Clone, Copy, Debug)]
pub struct Lines {
    /// The direction of W.
    pub west: Travel,
    /// The direction of E.
    pub east: Travel,
}

/// Checks a chart on a station that has been put in service: everything clear, unblocked and unrestricted, the lines with their
/// directions.
///
/// # Panics
/// If a row is not as it is drawn; the message has the drawing as it should be.
pub fn check(station: &Sketch, lines: Lines, chart: &str) {
    let layout = Small::new(station.plan()).expect("a station");
    let quiet = Chart { rows: Vec::new(), cycles: 1 }.input(0);
    let orders = Orders { unblock: CircuitSet::ALL, lift: CircuitSet::ALL, ..Orders::default() };
    let mut state = State::INITIAL;
    for _ in 0..station.turn.max(station.clear.into()) {
        state = layout.cycle(state, Input { orders, ..quiet }).0;
    }
    for (segment, travel) in [(0, lines.west), (1, lines.east)] {
        let request = SegmentId::new(segment).map(|segment| Request::Turn(segment, travel));
        let (next, output) = layout.cycle(state, Input { request, consent: SegmentSet::ALL, ..quiet });
        assert_eq!(output.answer, Some(Ok(())));
        state = next;
    }
    let chart = Chart::read(chart);
    let read = ["occ", "point", "set", "withdraw", "drive", "turn", "block", "unblock", "consent"];
    let mut drawn: Vec<String> = chart.rows.iter().map(|_| String::new()).collect();
    for cycle in 0..chart.cycles {
        let (next, output) = layout.cycle(state, chart.input(cycle));
        assert!(next.is_valid(&layout), "cycle {cycle}: {next:?}");
        for ((kind, name, row), drawn) in chart.rows.iter().zip(&mut drawn) {
            let given = char::from(row.as_bytes()[cycle]);
            drawn.push(if read.contains(kind) { given } else { sign(&layout, &next, &output, kind, name) });
        }
        state = next;
    }
    let is: Vec<_> = chart
        .rows
        .iter()
        .zip(&drawn)
        .map(|(row, drawn)| format!("{:<12} {drawn}", format!("{} {}", row.0, row.1)))
        .collect();
    let right = chart.rows.iter().zip(&drawn).all(|(row, drawn)| row.2 == drawn);
    assert!(right, "the station does:\n{}", is.join("\n"));
}
