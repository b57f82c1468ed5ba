//! The permitted speed from what the train hears (JP4845985B2).
//!
//! A train hears analog codes, which name a speed, and on digital lines telegrams, from which the braking pattern to the
//! point before which it must stop is computed. The lower of the two is permitted. What is not known is taken to be at its
//! worst; what is old is not used.
//!
//! Requirements: `spec/permitted.md`, PER-1 to PER-15. Read in this order: [`Permitted`] (parameters), [`Heard`] and
//! [`Permission`], [`State`] with its `is_valid`, [`step`].

mod parameters;
mod state;

pub use parameters::{Permitted, PermittedError, Settings};
pub use state::{Fixed, State, Target};

use crate::Machine;
use crate::aspect::AspectId;
use crate::distance::Millimetres;
use crate::pattern::{Deceleration, pattern};
use crate::speed::KmhTenths;
use crate::telegram::{Gradient, Judgement, Main, SectionId, Sub};
use crate::time::Ticks;

/// How a line is equipped. The train is told; it does not guess.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LineKind {
    /// Analog codes only: no telegrams are sent, and none are missed.
    Analog,
    /// Analog codes and telegrams: missing telegrams are a failure.
    Digital,
}

/// What is heard and measured in one cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Heard {
    /// The kind of line that begins here, if the train is told of one in this cycle.
    pub line: Option<LineKind>,
    /// The speed of the accepted analog code; `None`: no code.
    pub analog: Option<KmhTenths>,
    /// The main telegram that was completed in this cycle.
    pub main: Option<Main>,
    /// The sub telegram that was completed in this cycle.
    pub sub: Option<Sub>,
    /// A distance from which the exit of the section is no nearer: of the section whose signal is heard in this cycle.
    pub to_exit: Option<Millimetres>,
    /// The most that the train can have moved forward since the last cycle.
    pub moved: Millimetres,
}

/// The permitted speed; a lower one is safer, and none is the safest.
///
/// `None` means that nothing is heard, and that is the emergency brake; a speed of 0 is a stop by the service brake.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Permission {
    /// The permitted speed.
    pub speed: Option<KmhTenths>,
    /// What it rests on.
    pub basis: Basis,
}

/// What a permission rests on. The order is of no meaning for safety.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Basis {
    /// Nothing that permits: no code, or telegrams missing for too long.
    Nothing,
    /// The analog code alone.
    Analog,
    /// The pattern alone.
    Pattern,
    /// The lower of analog code and pattern.
    Both,
    /// Telegrams are missing: the lower of analog code and the last pattern, which is running down.
    RunningDown,
}

/// What there is of main telegrams: with what follows from them, limits or the speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Telegrams<T> {
    /// The last one is fresh.
    Fresh(T),
    /// They are missing, for no longer than the life: the pattern of the last one runs down.
    Missing(T),
    /// They are missing for longer, or none was ever used.
    Lost,
}

/// What limits the train by the telegrams.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// How it slows down on the gradient that counts.
    pub deceleration: Deceleration,
    /// The distance to the stopping point, less the margin.
    pub distance: Millimetres,
    /// The speed that the ground permits.
    pub ground: KmhTenths,
    /// The limit of the section.
    pub section: KmhTenths,
}

/// What limits the train by its target, and by that of the section behind where the section of the target is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Guidance {
    /// By the target.
    pub own: Limits,
    /// By the target of the section behind, as long as no sub telegram of the target's section is known.
    pub behind: Option<Limits>,
}

/// One cycle.
pub fn step(permitted: &Permitted, state: State, heard: Heard) -> (State, Permission) {
    let state = state.listen(permitted, heard);
    let permission = state.permission(permitted, heard.analog);
    (state, permission)
}

impl State {
    /// The state after what was heard in a cycle: distances and ages, then the line, then telegrams.
    #[inline]
    #[must_use]
    pub fn listen(self, permitted: &Permitted, heard: Heard) -> Self {
        let known = |rank| permitted.speeds().speed(rank).is_some();
        //= spec/permitted.md#per-7-unknown-ranks
        //# A telegram with a rank that is not in the table of the line's speeds MUST be treated as not heard.
        let main = heard.main.filter(|main| known(main.speed));
        let sub = heard.sub.filter(|sub| known(sub.curve) && known(sub.restriction));
        let mut next = self.later(permitted, heard.moved);
        //= spec/permitted.md#per-2-the-line
        //# The kind of line MUST change only when the train is told, and a train that was told nothing yet MUST take the line for digital.
        //= spec/permitted.md#per-11-an-announcement
        //# What the train is told of the line MUST change the kind of line and nothing else.
        next.line = heard.line.unwrap_or(next.line);

        //= spec/permitted.md#per-12-the-age
        //# The age of a telegram that is used MUST be counted from the telegram before it in its stream.
        let ages = (self.main_stream.silence(), self.sub_stream.silence());
        let (main_stream, judgement) = permitted.sequence().step(next.main_stream, main.map(|main| main.header()));
        next.main_stream = main_stream;
        if let (Some(main), Judgement::Accepted) = (main, judgement) {
            let target = next.target(permitted, main, (self.fix.unwrap_or_default(), heard.moved), ages.0);
            if next.target.is_some_and(|before| before.section.0 != target.section.0) {
                next.behind = next.target;
            }
            next.target = Some(target);
        }
        //= spec/permitted.md#per-10-the-fix
        //# A measured distance to the exit MUST be used only if it was measured after one main telegram and before the next one, both of the same section.
        next.fix = if main.is_some() { None } else { next.fix.or(heard.to_exit) };

        let (sub_stream, judgement) = permitted.sequence().step(next.sub_stream, sub.map(|sub| sub.header()));
        next.sub_stream = sub_stream;
        if let (Some(sub), Judgement::Accepted) = (sub, judgement) {
            next.learn(permitted, sub, ages.1);
        }
        next
    }

    /// The state one cycle on, in which the train moved by `moved` at most.
    fn later(self, permitted: &Permitted, moved: Millimetres) -> Self {
        let age = |age: Ticks| Ticks(age.0.saturating_add(1));
        let mut next = self;
        next.fix = next.fix.map(|fix| fix.less(moved));
        //= spec/permitted.md#per-8-age
        //# A main telegram older than its life and a sub telegram older than its life MUST be forgotten.
        for slot in [&mut next.target, &mut next.behind] {
            *slot = slot
                .map(|target| Target { age: age(target.age), to_stop: target.to_stop.less(moved), ..target })
                .filter(|target| target.age.0 <= permitted.life().0);
        }
        for slot in &mut next.fixed {
            *slot = slot
                .map(|fixed| Fixed { age: age(fixed.age), ..fixed })
                .filter(|fixed| fixed.age.0 <= permitted.fixed_life().0);
        }
        next
    }

    /// Where the train must stop and how fast it may be, by a main telegram that is used, and that was sent `age` cycles ago or
    /// later. `fix` is the distance to the exit in the cycle before, `moved` what the train moved since.
    fn target(
        &self,
        permitted: &Permitted,
        main: Main,
        (fix, moved): (Millimetres, Millimetres),
        age: Ticks,
    ) -> Target {
        let beyond = main.route.beyond_exit();
        // In the cycle of the telegram the nose may have gone over the exit.
        let measured = fix.and(beyond.millimetres()).less(moved);
        //= spec/permitted.md#per-4-the-distance
        //# The distance to the stopping point MUST be what the telegram allows beyond the exit and the measured distance to the exit, 0 if there is none, less the movement of the cycle; a longer distance that was known to the same point before is kept.
        let to_stop = match self.target {
            Some(before) if before.section.0 == main.section.0 && before.beyond.0 == beyond.0 => {
                if before.to_stop.0 > measured.0 { before.to_stop } else { measured }
            }
            _ => measured,
        };
        Target { section: main.section, beyond, limit: permitted.limit(main.speed), to_stop, age }
    }

    /// Keeps the data of a sub telegram that is used: the last two sections are known.
    fn learn(&mut self, permitted: &Permitted, sub: Sub, age: Ticks) {
        let limit = permitted.limit(sub.curve).min(permitted.limit(sub.restriction));
        let learned = Fixed { section: sub.section, gradient: sub.gradient, limit, age };
        let [newest, _] = self.fixed;
        if newest.is_none_or(|newest| newest.section.0 != sub.section.0) {
            self.fixed[1] = newest;
        }
        self.fixed[0] = Some(learned);
    }

    /// The gradient and the limit that sub telegrams say of a section; `None` if none of it is known.
    pub fn of_section(&self, section: SectionId) -> Option<(Gradient, KmhTenths)> {
        let its = |fixed: &&Fixed| fixed.section.0 == section.0;
        let [newest, other] = &self.fixed;
        let known = newest.as_ref().filter(its).or(other.as_ref().filter(its));
        known.map(|fixed| (fixed.gradient, fixed.limit))
    }

    /// What limits the train by the telegrams, on the way to `target`.
    pub fn limits(&self, permitted: &Permitted, target: &Target) -> Limits {
        //= spec/permitted.md#per-5-the-worst
        //# As long as no sub telegram of the main telegram's section is known, the worst gradient MUST be assumed, and the lowest limit where PER-15 has no other.
        let worst = (permitted.worst(), permitted.limit(permitted.lowest()));
        let (gradient, section) = self.of_section(target.section).unwrap_or(worst);
        Limits {
            deceleration: permitted.brake().on(gradient),
            distance: target.to_stop.less(permitted.margin().millimetres()),
            ground: target.limit,
            section,
        }
    }

    /// What limits the train on the way to `target`, at a border also by the target of the section behind.
    pub fn guidance(&self, permitted: &Permitted, target: &Target) -> Guidance {
        let behind = if self.of_section(target.section).is_some() { None } else { self.behind };
        Guidance { own: self.limits(permitted, target), behind: behind.map(|behind| self.limits(permitted, &behind)) }
    }

    /// What there is of telegrams in this state.
    pub fn telegrams(&self, permitted: &Permitted) -> Telegrams<Guidance> {
        match self.target {
            Some(target) if target.age.0 <= permitted.fresh().0 => Telegrams::Fresh(self.guidance(permitted, &target)),
            Some(target) => Telegrams::Missing(self.guidance(permitted, &target)),
            None => Telegrams::Lost,
        }
    }

    /// The permission in this state with this analog code; `None`: no code.
    pub fn permission(&self, permitted: &Permitted, code: Option<KmhTenths>) -> Permission {
        Permission::new(self.line, self.telegrams(permitted).map(Guidance::speed), code)
    }
}

impl Limits {
    /// The least of the pattern, the ground's speed and the section's limit.
    #[inline]
    pub fn speed(self) -> KmhTenths {
        pattern(self.deceleration, self.distance.whole_metres()).min(self.ground).min(self.section)
    }
}

impl Guidance {
    /// The speed by the target, with what is known of its section.
    #[inline]
    pub fn speed(self) -> KmhTenths {
        //= spec/permitted.md#per-15-the-border
        //# In place of a lowest limit that is assumed, the speed by the target of the section behind MUST be the limit if it is higher, for as long as that target lives.
        let section = self.behind.map_or(self.own.section, |behind| self.own.section.max(behind.speed()));
        Limits { section, ..self.own }.speed()
    }
}

impl<T> Telegrams<T> {
    /// The same with each `T` made a `U`.
    #[inline]
    fn map<U>(self, make: impl Fn(T) -> U) -> Telegrams<U> {
        match self {
            Self::Fresh(fresh) => Telegrams::Fresh(make(fresh)),
            Self::Missing(last) => Telegrams::Missing(make(last)),
            Self::Lost => Telegrams::Lost,
        }
    }
}

impl Permission {
    /// No code, or no sound evidence at all.
    const NOTHING: Self = Self { speed: None, basis: Basis::Nothing };

    /// What is permitted on a line with these telegrams and this analog code; `None`: no code.
    pub fn new(line: LineKind, telegrams: Telegrams<KmhTenths>, code: Option<KmhTenths>) -> Self {
        match (line, telegrams, code) {
            //= spec/permitted.md#per-1-the-lower
            //# Where an analog code and a fresh main telegram are both there, the lower of their speeds MUST be permitted.
            (_, Telegrams::Fresh(speed), Some(code)) => Self { speed: Some(code.min(speed)), basis: Basis::Both },
            //= spec/permitted.md#per-13-no-code-on-a-digital-line
            //# On a digital line without a code the speed by a fresh main telegram MUST be permitted.
            (LineKind::Digital, Telegrams::Fresh(speed), None) => Self { speed: Some(speed), basis: Basis::Pattern },
            //= spec/permitted.md#per-3-an-analog-line
            //# On an analog line without a fresh main telegram the speed of the code MUST be permitted.
            (LineKind::Analog, _, Some(code)) => Self { speed: Some(code), basis: Basis::Analog },
            //= spec/permitted.md#per-6-missing-telegrams
            //# On a digital line without a fresh main telegram the lower of the code and the last pattern MUST be permitted while it runs down, then a speed of 0, and nothing without a code.
            (LineKind::Digital, Telegrams::Missing(last), Some(code)) => {
                Self { speed: Some(code.min(last)), basis: Basis::RunningDown }
            }
            (LineKind::Digital, Telegrams::Lost, Some(_)) => Self { speed: Some(KmhTenths(0)), basis: Basis::Nothing },
            //= spec/permitted.md#per-14-no-code-on-an-analog-line
            //# On an analog line without a code there MUST be no permission, whether a main telegram is fresh or not.
            (_, _, None) => Self::NOTHING,
        }
    }
}

impl Permitted {
    /// The speed of a rank; 0 if the line has no such rank.
    fn limit(&self, rank: AspectId) -> KmhTenths {
        self.speeds().speed(rank).unwrap_or(KmhTenths(0))
    }
}

impl Machine for Permitted {
    type State = State;
    type Input = Heard;
    type Output = Permission;

    const SAFE: Permission = Permission::NOTHING;

    fn initial(&self) -> State {
        State::INITIAL
    }

    fn step(&self, state: State, heard: Heard) -> (State, Permission) {
        step(self, state, heard)
    }
}
