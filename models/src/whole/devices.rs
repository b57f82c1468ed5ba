//! The devices of the model: two stations of two platforms each, and the trains' device. A cycle is 1 s, on the ground and on board.

use super::ground::{MIDDLE, PLATFORM, THROAT};
use atc_kernel::aspect::{self, Acceptance, AspectId, AspectTable};
use atc_kernel::code::{CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::distance::Metres;
use atc_kernel::heading::Heading;
use atc_kernel::interlocking::{
    CircuitSet, Element, Layout, PerCircuit, Plan, Point, PointId, Position as Lie, Positions, Route, Segment,
    SegmentSet, SpeedCode,
};
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{Permitted, Settings};
use atc_kernel::position::{Correction, Millibels, Position, Spacing, Table};
use atc_kernel::speed::KmhTenths;
use atc_kernel::supervision::Supervision;
use atc_kernel::telegram::{Gradient, SectionId, Sequence};
use atc_kernel::time::Ticks;
use atc_kernel::train::{Parts, Train};
use atc_kernel::wayside::{Codes, Equipment, Facing, Fixed, Session, SignalPlan, State, Wayside};

/// The layout of a station.
pub type Small = Layout<4, 2, 1, 1>;
/// The plan of one.
pub type SmallPlan = Plan<4, 2, 1, 1>;
/// The device of a station.
pub type Ground = Wayside<'static, 0, 4, 2, 1, 1>;
/// What it remembers.
pub type GroundState = State<0, 4, 1>;
/// The device of a train.
pub type OnBoard = Train<3>;

/// Circuits of a station: the line, the throat, both platforms, and the middle.
pub const CIRCUITS: [&str; 5] = ["line", "throat", "one", "two", "middle"];
/// The middle, among them.
const BETWEEN: u8 = 4;

/// The speeds of the line in tenths of km/h: 0, 4 and 8 m/s.
const SPEEDS: [KmhTenths; 3] = [KmhTenths(0), KmhTenths(144), KmhTenths(288)];
const MAIN: [Millihertz; 3] = [Millihertz(10_000), Millihertz(15_000), Millihertz(22_000)];
const SUB: [Millihertz; 3] = [Millihertz(9_000), Millihertz(16_500), Millihertz(24_000)];

/// The times that the model rests on, in cycles, and distances in m.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Times {
    /// For how long a main telegram permits anything, on board.
    pub life: u16,
    /// For how long a train may run on after its authority was taken away.
    pub residual: u16,
    /// For how long a train may not be reported.
    pub loss: u8,
    /// For how many cycles in a row a circuit must be reported clear.
    pub clear: u8,
    /// For how long a permission of the neighbour counts.
    pub consent: u16,
    /// For how long a permission must have been withdrawn before the line turns.
    pub turn: u16,
    /// For how long a withdrawn route stays locked.
    pub release: u16,
    /// For how long nothing moves after a start.
    pub start: u16,
    /// What a train takes off every distance, in m.
    pub margin: u16,
}

impl Times {
    /// Times that keep every rule.
    pub const SOUND: Self =
        Self { life: 6, residual: 14, loss: 1, clear: 2, consent: 4, turn: 20, release: 16, start: 16, margin: 20 };
}

/// The circuit of a place, to a station; none if it does not see it.
pub fn circuit(station: usize, place: u8, track: u8) -> Option<u8> {
    match place {
        place if place == PLATFORM[station] => Some(2 + track),
        place if place == THROAT[station] => Some(1),
        MIDDLE => Some(BETWEEN),
        place if (place == MIDDLE - 1) == (station == 0) && place.abs_diff(MIDDLE) == 1 => Some(0),
        _ => None,
    }
}

/// The direction of travel away from a station.
pub const fn outward(station: usize) -> Heading {
    if station == 0 { Heading::Right } else { Heading::Left }
}

fn set(circuit: u8) -> CircuitSet {
    CircuitSet::nth(usize::from(circuit))
}

/// The position in which a station's point leads to a platform.
pub fn leads_to(track: u8) -> Positions {
    Positions::of(PointId::ZERO, if track == 0 { Lie::Normal } else { Lie::Reverse })
}

/// Routes 0 and 1 lead into the platforms, 2 and 3 out of them.
fn plan(station: usize, times: Times) -> SmallPlan {
    let line = SegmentSet::nth(0);
    let element = |circuit, positions| Element { circuits: set(circuit), positions, ..Element::NONE };
    let nothing = Element::default();
    let usual = Route {
        drive: Ticks(5),
        release: Ticks(times.release),
        stay: Ticks(14),
        speed: SpeedCode(2),
        overlap_speed: SpeedCode(2),
        ..Route::NONE
    };
    let mut plan = SmallPlan::EMPTY;
    for track in 0..2_u8 {
        let (place, way) = (usize::from(track), leads_to(track));
        plan.routes[place] = Route {
            heading: outward(station).opposite(),
            entry: set(0),
            approach: set(0),
            path: [element(1, way), element(2 + track, Positions::NONE)],
            length: 2,
            beyond: set(1),
            from: line,
            ..usual
        };
        plan.routes[2 + place] = Route {
            heading: outward(station),
            entry: set(2 + track),
            approach: set(2 + track),
            path: [element(1, way), nothing],
            length: 1,
            beyond: set(0),
            to: line,
            ..usual
        };
    }
    plan.points[0] = Point { detectors: set(1) };
    plan.segments[0] =
        Segment { circuits: [set(0), set(BETWEEN)], length: 2, throat: set(1), outward: outward(station), shared: 1 };
    plan.lengths[..CIRCUITS.len()].fill(Metres(100));
    plan.braking[..3].copy_from_slice(&[Metres(0), Metres(55), Metres(98)]);
    (plan.clear, plan.loss, plan.settle) = (times.clear, times.loss, 1);
    (plan.turn, plan.start) = (Ticks(times.turn), Ticks(times.start));
    (plan.residual, plan.standstill) = (Ticks(times.residual), Ticks(8));
    plan
}

/// The section of a circuit: odd for trains to the left, even for those to the right. The middle has the same at both stations.
fn fixed(station: usize, circuit: u8) -> Option<Fixed> {
    let number = if circuit == BETWEEN { 9 } else { 1 + 2 * u16::from(circuit) + if station == 0 { 0 } else { 20 } };
    let curve = AspectId::new(2)?;
    let facing = |section| Facing { section: SectionId(section), gradient: Gradient(0), curve };
    Some(Fixed { left: facing(number), right: facing(number + 1) })
}

/// The station and the circuit that a section is of.
pub fn circuit_of(section: SectionId) -> Option<(usize, u8)> {
    let stations = (0..2).flat_map(|station| (0..5).map(move |circuit| (station, circuit)));
    let mut all = stations.filter_map(|(station, circuit)| Some((station, circuit, fixed(station, circuit)?)));
    all.find(|(.., fixed)| fixed.left.section == section || fixed.right.section == section)
        .map(|(station, circuit, _)| (station, circuit))
}

fn words() -> (AspectTable, CodeTable) {
    let aspects = AspectTable::new(&SPEEDS).expect("speeds that rise");
    let frequencies = |nominal: &[Millihertz]| CodeFrequencies::new(nominal, Millihertz(400)).expect("bands apart");
    let mut named = [[None; MAX_CODES]; MAX_CODES];
    for (rank, speed) in SPEEDS.iter().enumerate() {
        named[rank][rank] = Some(*speed);
    }
    (aspects, CodeTable::new(frequencies(&MAIN), frequencies(&SUB), named).expect("pairs of codes in use"))
}

/// The frequencies of a pair of codes.
pub fn frequencies(codes: Codes) -> [Option<Millihertz>; 2] {
    [MAIN.get(usize::from(codes.main.place())).copied(), SUB.get(usize::from(codes.sub.place())).copied()]
}

/// The frequencies of the highest code.
pub const HIGHEST: [Option<Millihertz>; 2] = [Some(MAIN[2]), Some(SUB[2])];

/// The device of a station.
///
/// # Panics
/// If it breaks a rule; a test builds every model.
pub fn ground(station: usize, times: Times) -> Ground {
    let layout = if times == Times::SOUND { Layout::new } else { Layout::with_what_proofs_need };
    let layout = layout(plan(station, times)).expect("a layout that keeps every rule");
    let (aspects, codes) = words();
    let mut speeds = [None; MAX_CODES];
    for (speed, known) in speeds.iter_mut().zip(SPEEDS) {
        *speed = Some(known);
    }
    let fixed =
        |number: usize| u8::try_from(number).ok().filter(|number| *number < 5).and_then(|it| fixed(station, it));
    let signals = SignalPlan { circuits: PerCircuit::from_fn(fixed), speeds, aspects, codes };
    let equipment = Equipment { counted: None, signals, life: Ticks(times.consent), session: Session(0) };
    // A device borrows its layout, and a model lives as long as the program.
    Wayside::new(Box::leak(Box::new(layout)), &equipment).expect("equipment that keeps every rule")
}

/// The device of every train.
///
/// # Panics
/// If it breaks a rule; a test builds every model.
pub fn on_board(times: Times) -> OnBoard {
    let (aspects, codes) = words();
    let life = Ticks(times.life);
    let settings = Settings {
        speeds: aspects,
        lowest: AspectId::new(2).expect("a rank"),
        brake: Deceleration::brake(2000).expect("a brake"),
        worst: Gradient(0),
        margin: Metres(times.margin),
        fresh: Ticks(3),
        life,
        fixed_life: Ticks(50),
        sequence: Sequence::new(4, 1, Ticks(6)).expect("a window"),
    };
    let times = aspect::Times::from_ticks(Ticks(2), Ticks(2), Ticks(2), Ticks(3), Ticks(1));
    let parts = Parts {
        codes,
        acceptance: Acceptance { times: times.expect("times that keep every rule") },
        permitted: Permitted::new(settings).expect("settings that keep every rule"),
        supervision: Supervision::default(),
        position: position(),
    };
    Train::new(parts).expect("parts that fit together")
}

/// Rails that attenuate one signal by 0.1 dB a metre more than the other.
fn position() -> Option<Position> {
    let level = |knot: usize| Millibels(i16::try_from(knot * 256).unwrap_or(i16::MAX));
    let lowest = std::array::from_fn(level);
    let table =
        Table::new(Spacing::new(8)?, lowest, lowest.map(|level: Millibels| Millibels(level.0.saturating_add(20))))
            .ok()?;
    Position::new(table, Millibels(5), Millibels(-6000), Correction::NONE)
}

/// The levels of a train so far from the exit of its place.
pub fn levels(to_exit: i16) -> [Option<Millibels>; 2] {
    [Some(Millibels(10 + 10 * to_exit)), Some(Millibels(0))]
}
