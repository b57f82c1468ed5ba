//! A ride: a line, a ground that changes its mind, a channel that loses telegrams, and a train with a device.
//!
//! In each cycle every digital section sends one main and one sub telegram, which say what the ground allowed in the cycle
//! before, the ground may change the stopping point and impose the restriction, and the train moves, and hears what is sent
//! in its section, or nothing. What the ground has withdrawn it keeps free for some cycles more, as it knows that telegrams
//! live; that, and nothing else, is the ground truth of the claims. A telegram is composed when the one before it is
//! completed, and takes one cycle to send.
//!
//! Only differences of counters count (`telegram::Sequence`), so they are written relative to the last telegram that was
//! sent, which is number 0. A loss as long as the wrap is therefore in the model as any other; a trace has true numbers.

use super::device::Device;
pub use super::environment::{
    Border, Delivery, Environment, Fix, Motion, Odometer, Route as Changes, Small, Told, Transmitter,
};
use super::environment::{codes, levels, measured, position};
use super::layout::{CELL_M, Layout, SPEEDS};
use super::purpose::Purpose;
pub use super::state::{Cycle, Ghosts, Ground, Kept, Shown, State, Train};
use atc_kernel::Machine;
use atc_kernel::aspect::AspectId;
use atc_kernel::code::{CodeTable, Millihertz};
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::permitted::{self, LineKind, Permitted};
use atc_kernel::position::{Interval, Measured, Moved, Position};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Counter, Gradient, Length, Main, Route, SectionId, Stream, Sub};

mod subject;

/// The model: the device `D` on a line, in an environment.
#[derive(Clone, Debug)]
pub struct Ride<D> {
    /// The train's device.
    pub device: D,
    /// The line.
    pub layout: Layout,
    /// The kernel's parameters.
    pub small: Small,
    /// What may happen.
    pub environment: Environment,
    /// What the model is there to show.
    pub purpose: Purpose,
    permitted: Permitted,
    codes: CodeTable,
    position: Position,
}

/// A distance to the exit, and the position device after it.
type Measurement = (Option<Millimetres>, Option<(u32, u32)>);

impl<D: Device> Ride<D> {
    /// A ride on `layout`.
    pub fn new(device: D, layout: Layout, small: Small, environment: Environment, purpose: Purpose) -> Self {
        let (permitted, codes, position) = (small.permitted(), codes(), position());
        Self { device, layout, small, environment, purpose, permitted, codes, position }
    }

    /// The kernel's parameters.
    pub fn permitted(&self) -> &Permitted {
        &self.permitted
    }

    /// The kind of line at a place.
    pub fn kind_at(&self, place: u8) -> LineKind {
        self.layout.sections[self.layout.section_at(place)].kind
    }

    /// By how many cells the train may move in the next cycle.
    fn movements(&self, state: &State) -> std::ops::RangeInclusive<u8> {
        if self.environment.motion == Motion::Standing {
            return 0..=0;
        }
        let permitted = state.shown.speed.map_or(0, |speed| speed / SPEEDS[0]);
        let slowest = state.train.moved.saturating_sub(1);
        let fastest = u8::try_from(permitted).unwrap_or(u8::MAX).min(state.train.moved + 1);
        slowest..=fastest.max(slowest)
    }

    /// The ground after a cycle, and whether its transmitter counted on.
    fn grounds(&self, state: &State) -> Vec<(Ground, bool)> {
        let before = &state.ground;
        let points = match self.environment.route {
            Changes::Fixed => vec![before.point],
            Changes::Any => (0..u8::try_from(self.layout.points.len()).unwrap_or(0)).collect(),
            Changes::Withdrawn => (0..=before.point).collect(),
        };
        let restrict: &[bool] =
            if self.environment.restriction && !before.restricted { &[false, true] } else { &[false] };
        let mut grounds = Vec::new();
        for point in points {
            for restrict in restrict {
                let restricted = before.restricted || *restrict;
                let age = |age: u16, now: bool, keeps: u16| if now { 0 } else { (age + 1).min(keeps + 1) };
                let mut ground = Ground { point, restricted, ..*before };
                for (place, known) in ground.point_age.iter_mut().enumerate() {
                    *known = age(*known, place == usize::from(point), self.environment.keeps);
                }
                ground.free_age = age(before.free_age, !restricted, self.environment.keeps_limit);
                grounds.extend(self.sendings(state, ground));
            }
        }
        grounds
    }

    /// The ground after it has sent, and whether the counter went on.
    fn sendings(&self, state: &State, ground: Ground) -> Vec<(Ground, bool)> {
        let (length, may_begin) = match self.environment.transmitter {
            Transmitter::Sound => return vec![(ground, true)],
            Transmitter::Loops(length) => (length, true),
            Transmitter::FreezesAndLate => (1, true),
            Transmitter::FreezesUnheard => {
                let lost = state.ghosts.silent * u16::from(self.environment.in_a_cycle);
                (1, lost > u16::from(self.small.window))
            }
        };
        let mut again = ground;
        again.repeats = ground.repeats % length + 1;
        if ground.repeats > 0 {
            return vec![(again, false)];
        }
        let [newest, second, _] = ground.sent;
        let mut on = ground;
        on.sent = [state.ground.point, newest, second];
        let mut ways = vec![(on, true)];
        if may_begin {
            ways.push((again, false));
        }
        ways
    }

    /// The telegrams of `section`, composed by the ground `before` this cycle: the stopping point and the relative number that
    /// they carry.
    fn telegrams(&self, section: usize, before: &Ground, ground: &Ground, counted: bool) -> (Main, Sub) {
        let (point, further) = match (counted, self.environment.transmitter) {
            (false, Transmitter::Loops(length)) => {
                let back = length - ground.repeats;
                (ground.sent[usize::from(back)], 0_u8.wrapping_sub(back))
            }
            (false, _) => (ground.sent[0], 0),
            (true, _) => (before.point, 1),
        };
        let here = &self.layout.sections[section];
        let metres = |cells: u8| Metres(u16::from(cells) * CELL_M);
        let rank = |rank| AspectId::new(rank).expect("a rank of the models");
        let id = SectionId(u16::try_from(section).unwrap_or(u16::MAX));
        let route = match self.layout.beyond_exit(section, point) {
            None => Route::Closed,
            Some(cells) => Route::OpenFor(metres(cells)),
        };
        let counter = Counter(further.wrapping_mul(self.environment.in_a_cycle));
        let sub = Sub {
            section: id,
            counter,
            length: Length::new(metres(here.cells)).expect("a section of the models has a length"),
            gradient: Gradient(self.layout.worst_gradient_from(section)),
            curve: rank(here.limit),
            restriction: rank(u8::from(!(here.restrictable && before.restricted))),
        };
        (Main { section: id, counter, route, speed: rank(self.layout.rank_with(point)) }, sub)
    }

    /// The main telegram of `section` that was sent before the one with which the transmitter has frozen, if it may arrive now.
    fn late(&self, section: usize, state: &State, ground: &Ground) -> Option<Main> {
        let known = state.ghosts.silent + 1 < self.small.memory;
        let may = self.environment.transmitter == Transmitter::FreezesAndLate && ground.repeats > 0;
        let before = Ground { point: ground.sent[1], ..*ground };
        let sent = || Main {
            counter: Counter(0_u8.wrapping_sub(self.environment.in_a_cycle)),
            ..self.telegrams(section, &before, &before, true).0
        };
        let here = section == self.layout.section_at(state.train.place);
        (may && known && here && state.ghosts.current).then(sent)
    }

    /// The sections whose telegrams may be used in a cycle in which the nose comes to `to`.
    fn audible(&self, train: &Train, to: u8) -> Vec<usize> {
        let [earlier, before, here] =
            [train.place - train.moved, train.place, to].map(|place| self.layout.section_at(place));
        let mut sections = vec![here];
        match self.environment.border {
            Border::Crossing | Border::Delayed if before != here => sections.push(before),
            Border::Delayed if earlier != here => sections.push(earlier),
            Border::Mixed { cells, .. } if here > 0 && to - self.layout.start(here) < cells => sections.push(here - 1),
            _ => {}
        }
        sections.retain(|section| self.layout.sections[*section].kind == LineKind::Digital);
        sections
    }

    /// What may be measured of the distance to the exit, and the position device after that.
    fn fixes(&self, train: &Train, place: u8) -> Vec<Measurement> {
        let section = self.layout.section_at(place);
        let cells = self.layout.exit(section) - place;
        let near_border = match self.environment.border {
            Border::Mixed { cells, fix_ahead: false } => section > 0 && place - self.layout.start(section) < cells,
            Border::Delayed => self.layout.section_at(train.place) != section,
            _ => false,
        };
        let millimetres = |cells: u8| Millimetres(u32::from(cells) * u32::from(CELL_M) * 1000);
        match self.environment.fix {
            _ if near_border => vec![(None, None)],
            Fix::Never => vec![(None, None)],
            Fix::Any => {
                let mut fixes = vec![(None, None), (Some(millimetres(cells)), None)];
                fixes.extend(cells.checked_sub(1).map(|less| (Some(millimetres(less)), None)));
                fixes
            }
            Fix::Levels => {
                // The transmitter is at the exit; the device starts afresh with each section.
                let same = self.layout.section_at(train.place) == section;
                let before = train
                    .interval
                    .filter(|_| same)
                    .and_then(|(nearest, farthest)| Interval::new(Millimetres(nearest), Millimetres(farthest)));
                let moved =
                    i16::try_from(u32::from(place - train.place) * u32::from(CELL_M) * 1000).unwrap_or(i16::MAX);
                let moved = Moved::new(moved, moved).unwrap_or(Moved::STANDING);
                let pairs = levels(cells).into_iter().map(|[first, second]| (Some(first), Some(second)));
                let fix = |(first, second)| {
                    let (_, now) = self.position.step(before, Measured { first, second, moved });
                    (now.map(Interval::nearest), now.map(|now| (now.nearest().0, now.farthest().0)))
                };
                pairs.chain([(None, None)]).map(fix).collect()
            }
        }
    }

    /// What the train may be told on a line of this kind.
    fn told(&self, train: &Train, kind: LineKind) -> Vec<Option<LineKind>> {
        let news = Some(kind).filter(|_| train.told != Some(kind));
        match self.environment.told {
            Told::PerhapsNotOfDigital if news == Some(LineKind::Digital) => vec![news, None],
            _ => vec![news],
        }
    }

    fn analog(&self, place: u8) -> Vec<Option<KmhTenths>> {
        let rank = self.layout.sections[self.layout.section_at(place)].code;
        let heard = |[main, sub]: [Option<Millihertz>; 2]| self.codes.heard(main, sub);
        measured(self.environment.code, rank).into_iter().map(heard).collect()
    }

    /// What the odometer may say of a movement, in cells.
    fn odometer(&self, moved: u8) -> Vec<u8> {
        match self.environment.odometer {
            Odometer::Exact => vec![moved],
            Odometer::Bounded => vec![moved, moved + 1],
            Odometer::Short => vec![moved, moved.saturating_sub(1)],
        }
    }

    /// By how much the counter has gone on in a cycle.
    pub(super) fn further(&self, counted: bool) -> u8 {
        if counted { self.environment.in_a_cycle } else { 0 }
    }

    /// The state of the device with counters relative to a telegram further on.
    fn rebased(&self, kernel: permitted::State, counted: bool) -> Kept {
        let on = |stream: Stream| {
            let last = stream.last.map(|mut last| {
                last.counter.0 = last.counter.0.wrapping_sub(self.further(counted));
                last
            });
            Stream { last, ..stream }
        };
        Kept(permitted::State { main_stream: on(kernel.main_stream), sub_stream: on(kernel.sub_stream), ..kernel })
    }
}

fn lossy<T: Copy>(delivery: Delivery, sent: impl Iterator<Item = T>) -> Vec<Option<T>> {
    match delivery {
        Delivery::Never => vec![None],
        Delivery::Always => {
            let all: Vec<_> = sent.map(Some).collect();
            if all.is_empty() { vec![None] } else { all }
        }
        Delivery::Any => std::iter::once(None).chain(sent.map(Some)).collect(),
    }
}
