//! The device under attack. This is the only file of the adversary that knows the kernel: a change of the kernel's interface ends here.

use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Heading, Input, Large, Layout, Orders, PointId, PointSet, Position, Positions, Request,
    RouteId, RouteSet, SegmentId, SegmentSet, Size, Small, SpeedCode, State, Travel, begins, silent, telegram,
};
pub use atc_kernel::interlocking::{Phase, Refusal};
use atc_layout::{Description, Errors, Extent};

use super::ground::{Ground, Mask, bit, members};

/// What may be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// Set a route.
    Set(usize),
    /// Withdraw a route.
    Withdraw(usize),
    /// Drive a point; `true` is reverse.
    Drive(usize, bool),
    /// Turn a line; `true` is outwards.
    Turn(usize, bool),
}

/// What staff command.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Commands {
    /// Block these.
    pub block: Mask,
    /// Unblock these.
    pub unblock: Mask,
    /// Restrict these to the code.
    pub restrict: (Mask, u8),
    /// Lift the restriction of these.
    pub lift: Mask,
}

/// What the device reads in a cycle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Read {
    /// The circuits that are reported occupied.
    pub occupied: Mask,
    /// The points that are detected normal, and reverse.
    pub detected: [u64; 2],
    /// One request or none.
    pub ask: Option<Ask>,
    /// What staff command.
    pub commands: Commands,
    /// The lines where the neighbour consents.
    pub consent: u8,
}

/// What it says in a cycle, besides the telegrams.
#[derive(Clone, Copy, Debug, Default)]
pub struct Said {
    /// The routes that show proceed.
    pub proceed: Mask,
    /// The points that are driven to normal, and to reverse.
    pub drives: [u64; 2],
    /// The lines where it permits the neighbour to send.
    pub permits: u8,
    /// The blocks that staff may rely on.
    pub confirmed: Mask,
    /// Whether the request was carried out.
    pub done: bool,
    /// Why it was not, if it was refused.
    pub refused: Option<Refusal>,
}

/// The telegram of one circuit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Telegram {
    /// The circuits that the train may enter; none if it must stop.
    pub hold: Mask,
    /// The highest code.
    pub code: u8,
    /// Whether it is for a train that faces right; `None` where it is for none.
    pub right: Option<bool>,
    /// The last circuit that the train may enter.
    pub stop: usize,
}

/// A device.
pub trait Device {
    /// One cycle.
    fn cycle(&mut self, read: &Read) -> Said;
    /// The telegram that the circuit sends in this cycle.
    fn telegram(&self, circuit: usize) -> Telegram;
    /// What a train hears there that faces right or left: where two devices speak, that of its direction.
    fn heard(&self, circuit: usize, _right: bool) -> Telegram {
        self.telegram(circuit)
    }
    /// The routes that are held, and their phases.
    fn phases(&self) -> Vec<(usize, Phase)>;
    /// A restart: what it remembered is lost.
    fn restart(&mut self);
}

/// The kernel.
struct Kernel<const R: usize, const P: usize, const N: usize, const S: usize, Z: Masked> {
    layout: Box<Layout<R, P, N, S, Z>>,
    state: State<R, S, Z>,
    table: Option<atc_kernel::interlocking::Contents<R, Z>>,
    begins: CircuitSet<Z>,
    silent: CircuitSet<Z>,
}

/// Sets as masks: of 128 circuits and routes, 64 points and 8 segments at most. What is beyond that is not attacked.
trait Masked: Size {
    fn circuits(mask: Mask) -> CircuitSet<Self>;
    fn of_circuits(set: CircuitSet<Self>) -> Mask;
    fn of_routes(set: RouteSet<Self>) -> Mask;
    fn points(mask: u64) -> PointSet<Self>;
    fn of_points(set: PointSet<Self>) -> u64;
    fn segments(mask: u8) -> SegmentSet<Self>;
    fn of_segments(set: SegmentSet<Self>) -> u8;
}

fn low(mask: Mask) -> u64 {
    u64::try_from(mask & Mask::from(u64::MAX)).unwrap_or(0)
}

fn half(points: u64) -> u32 {
    u32::try_from(points & u64::from(u32::MAX)).unwrap_or(0)
}

impl Masked for Small {
    fn circuits(mask: Mask) -> CircuitSet {
        CircuitSet::from_bits(low(mask))
    }
    fn of_circuits(set: CircuitSet) -> Mask {
        set.bits().into()
    }
    fn of_routes(set: RouteSet) -> Mask {
        set.bits().into()
    }
    fn points(mask: u64) -> PointSet {
        PointSet::from_bits(half(mask))
    }
    fn of_points(set: PointSet) -> u64 {
        set.bits().into()
    }
    fn segments(mask: u8) -> SegmentSet {
        SegmentSet::from_bits(mask)
    }
    fn of_segments(set: SegmentSet) -> u8 {
        set.bits()
    }
}

fn two([first, second, ..]: [u64; 4]) -> Mask {
    Mask::from(first) | Mask::from(second) << 64
}

impl Masked for Large {
    fn circuits(mask: Mask) -> CircuitSet<Self> {
        CircuitSet::from_words([low(mask), low(mask >> 64), 0, 0])
    }
    fn of_circuits(set: CircuitSet<Self>) -> Mask {
        two(set.words())
    }
    fn of_routes(set: RouteSet<Self>) -> Mask {
        two(set.words())
    }
    fn points(mask: u64) -> PointSet<Self> {
        PointSet::from_words([half(mask), half(mask >> 32), 0, 0])
    }
    fn of_points(set: PointSet<Self>) -> u64 {
        let [first, second, ..] = set.words();
        u64::from(first) | u64::from(second) << 32
    }
    fn segments(mask: u8) -> SegmentSet<Self> {
        SegmentSet::from_words([mask, 0, 0, 0])
    }
    fn of_segments(set: SegmentSet<Self>) -> u8 {
        set.words()[0]
    }
}

fn small(number: usize) -> u8 {
    u8::try_from(number).unwrap_or(u8::MAX)
}

fn request(ask: Ask) -> Option<Request> {
    Some(match ask {
        Ask::Set(route) => Request::Set(RouteId::new(small(route))?),
        Ask::Withdraw(route) => Request::Withdraw(RouteId::new(small(route))?),
        Ask::Drive(point, reverse) => {
            let position = if reverse { Position::Reverse } else { Position::Normal };
            Request::Drive(PointId::new(small(point))?, position)
        }
        Ask::Turn(line, away) => {
            let travel = if away { Travel::Away } else { Travel::Toward };
            Request::Turn(SegmentId::new(small(line))?, travel)
        }
    })
}

impl<const R: usize, const P: usize, const N: usize, const S: usize, Z: Masked> Device for Kernel<R, P, N, S, Z> {
    fn cycle(&mut self, read: &Read) -> Said {
        let input = Input {
            occupied: Z::circuits(read.occupied),
            detected: Positions { normal: Z::points(read.detected[0]), reverse: Z::points(read.detected[1]) },
            request: read.ask.and_then(request),
            orders: Orders {
                block: Z::circuits(read.commands.block),
                unblock: Z::circuits(read.commands.unblock),
                restrict: Z::circuits(read.commands.restrict.0),
                speed: SpeedCode(read.commands.restrict.1),
                lift: Z::circuits(read.commands.lift),
            },
            consent: Z::segments(read.consent),
        };
        let (state, output) = self.layout.cycle(self.state, input);
        self.state = state;
        self.table = output.table.read(state.epoch);
        self.begins = self.table.as_ref().map_or(CircuitSet::EMPTY, |contents| begins(&self.layout, contents));
        self.silent = silent(&self.layout, self.table.as_ref());
        Said {
            proceed: Z::of_routes(output.proceed),
            drives: [Z::of_points(output.drives.normal), Z::of_points(output.drives.reverse)],
            permits: Z::of_segments(output.permits),
            confirmed: Z::of_circuits(output.confirmed),
            done: output.answer == Some(Ok(())),
            refused: output.answer.and_then(Result::err),
        }
    }

    fn telegram(&self, circuit: usize) -> Telegram {
        let heard = CircuitId::new(small(circuit)).filter(|circuit| !self.silent.has(*circuit));
        let Some(circuit) = heard else { return Telegram::default() };
        let movement = telegram(&self.layout, self.table.as_ref(), self.begins, circuit);
        if movement.is_open() {
            let right = movement.heading.map(|heading| heading == Heading::Right);
            let stop = usize::from(movement.stop.number());
            Telegram { hold: Z::of_circuits(movement.hold), code: movement.speed.0, right, stop }
        } else {
            Telegram::default()
        }
    }

    fn phases(&self) -> Vec<(usize, Phase)> {
        let held = self.state.routes.iter().enumerate().filter(|(_, route)| route.is_held());
        held.map(|(number, route)| (number, route.phase)).collect()
    }

    fn restart(&mut self) {
        self.state = State::INITIAL;
        (self.table, self.begins, self.silent) = (None, CircuitSet::EMPTY, CircuitSet::EMPTY);
    }
}

/// The kernel with a layout, of the smallest size that has room for it, and the ground of that layout.
///
/// # Errors
/// What is wrong with the layout.
pub fn kernel(description: &Description) -> Result<(Box<dyn Device>, Ground), Errors> {
    if let Ok(compiled) = description.compile_to::<8, 4, 4, 2, Small>() {
        let ground = Ground::of_compiled(description, &compiled);
        return Ok((started(compiled.layout()), ground));
    }
    if let Ok(compiled) = description.compile_to::<8, 4, 8, 5, Small>() {
        let ground = Ground::of_compiled(description, &compiled);
        return Ok((started(compiled.layout()), ground));
    }
    if Extent::of(&description.station).is_large() {
        let compiled = description.compile_to::<128, 32, 64, 8, Large>()?;
        let ground = Ground::of_compiled(description, &compiled);
        return Ok((started(compiled.layout()), ground));
    }
    let compiled = description.compile_to::<64, 16, 32, 8, Small>()?;
    let ground = Ground::of_compiled(description, &compiled);
    Ok((started(compiled.layout()), ground))
}

/// A device that has just started on this layout, of a small station.
#[must_use]
pub fn of<const R: usize, const P: usize, const N: usize, const S: usize>(
    layout: Layout<R, P, N, S>,
) -> Box<dyn Device> {
    started(Box::new(layout))
}

fn started<const R: usize, const P: usize, const N: usize, const S: usize, Z: Masked>(
    layout: Box<Layout<R, P, N, S, Z>>,
) -> Box<dyn Device> {
    Box::new(Kernel {
        layout,
        state: State::INITIAL,
        table: None,
        begins: CircuitSet::EMPTY,
        silent: CircuitSet::EMPTY,
    })
}

/// The circuits that a station of `ground` sees.
pub fn all(ground: &Ground) -> Mask {
    bit(ground.seen) - 1
}

/// How often `mask` counts in a list of lengths: the sum over its circuits.
pub fn length(ground: &Ground, mask: Mask) -> i64 {
    members(mask).map(|circuit| ground.lengths[circuit]).sum()
}
