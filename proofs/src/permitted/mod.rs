//! The permitted speed: theorems T-PER-1 to T-PER-9.
//!
//! Every harness is one cycle from any valid state, with any parameters and anything heard. Where the train, the exits and the
//! stopping points really are, and how long telegrams have been missing, are ghosts.

mod distance;
mod memory;
mod permission;

use crate::pattern::{any_brake, any_gradient};
use crate::telegram::{any_bits_of_stream, any_main, any_sequence, any_sub};
use crate::{Engine, Harness, any_flag, any_u32};
use atc_kernel::Machine;
use atc_kernel::aspect::{AspectId, AspectTable};
use atc_kernel::distance::{Metres, Millimetres};
use atc_kernel::permitted::{Fixed, Heard, LineKind, Permitted, Settings, State, Target};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Judgement, Main, SectionId, Stream, Sub};
use atc_kernel::time::Ticks;

pub use distance::{t_per_4, t_per_4_fix, t_per_4_metres};
pub use memory::{
    per_9, per_machine, per_total, t_per_2, t_per_5_evidence, t_per_6, t_per_6_announced, t_per_7, t_per_8,
};
pub use permission::{t_per_1, t_per_5, t_per_5_behind, t_per_5_border, t_per_5_permission, t_per_5_speed};

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] = &[
    t_per_1::HARNESS,
    t_per_2::HARNESS,
    t_per_4::HARNESS,
    t_per_4_fix::HARNESS,
    t_per_4_metres::HARNESS,
    t_per_5::HARNESS,
    t_per_5_behind::HARNESS,
    t_per_5_border::HARNESS,
    t_per_5_evidence::HARNESS,
    t_per_5_speed::HARNESS,
    t_per_5_permission::HARNESS,
    t_per_6::HARNESS,
    t_per_6_announced::HARNESS,
    t_per_7::HARNESS,
    t_per_8::HARNESS,
    per_9::HARNESS,
    per_machine::HARNESS,
    per_total::HARNESS,
];

/// The speeds of the table in these harnesses.
pub(crate) const SPEEDS: usize = 4;

/// Arbitrary parameters, and the speeds of their table.
#[derive(Clone, Copy)]
pub(crate) struct Line {
    pub(crate) permitted: Permitted,
    pub(crate) settings: Settings,
    pub(crate) speeds: [KmhTenths; SPEEDS],
}

impl Line {
    /// The speed of a rank, found in the array; `None` from 4 on.
    pub(crate) fn speed(&self, rank: AspectId) -> Option<KmhTenths> {
        let mut found = None;
        for (place, speed) in self.speeds.iter().enumerate() {
            if usize::from(rank.rank()) == place {
                found = Some(*speed);
            }
        }
        found
    }
}

/// Whether the telegram's rank is in the table of these harnesses.
pub(crate) fn knows_main(main: Main) -> bool {
    usize::from(main.speed.rank()) < SPEEDS
}

/// Whether the telegram's ranks are in the table of these harnesses.
pub(crate) fn knows_sub(sub: Sub) -> bool {
    usize::from(sub.curve.rank()) < SPEEDS && usize::from(sub.restriction.rank()) < SPEEDS
}

pub(crate) fn any_line<E: Engine + ?Sized>(e: &mut E) -> Option<Line> {
    let mut speeds = [KmhTenths(0); SPEEDS];
    for place in 0..SPEEDS {
        let least = if place == 0 { 0 } else { speeds[place - 1].0.saturating_add(1) };
        speeds[place] = KmhTenths(e.word("speeds (0.1 km/h)", least..=least.saturating_add(300)));
    }
    let table = AspectTable::new(&speeds);
    e.assume(table.is_ok());
    let lowest = AspectId::new(e.word("lowest limit (rank)", 0..=3).to_le_bytes()[0] & 15)?;
    let brake = any_brake(e)?;
    let worst = any_gradient(e, "worst gradient (‰, two's complement)");
    let margin = Metres(e.word("margin (m)", 0..=20));
    let [fresh, life, fixed_life] =
        [1..=3, 4..=8, 4..=8].map(|likely| Ticks(e.word("freshness, life, life of sub telegrams (cycles)", likely)));
    let sequence = any_sequence(e)?;
    let settings = Settings { speeds: table.ok()?, lowest, brake, worst, margin, fresh, life, fixed_life, sequence };
    let permitted = Permitted::new(settings);
    e.assume(permitted.is_ok());
    Some(Line { permitted: permitted.ok()?, settings, speeds })
}

pub(crate) fn any_distance<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> Millimetres {
    // The likely half is of 65 m, so that drawn distances are of every size.
    let high = e.word(what, 0..=6);
    Millimetres(u32::from(high) << 16 | u32::from(e.word(what, 0..=u16::MAX)))
}

/// An arbitrary limit; of what a telegram said once.
fn any_speed<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> KmhTenths {
    KmhTenths(e.word(what, 0..=900))
}

fn any_target<E: Engine + ?Sized>(e: &mut E) -> Target {
    Target {
        section: SectionId(e.word("target: section", 1..=2)),
        beyond: Metres(e.word("target: beyond the exit (m)", 0..=2)),
        limit: any_speed(e, "target: speed (0.1 km/h)"),
        to_stop: any_distance(e, "target: distance (65 536 mm, mm)"),
        age: Ticks(e.word("target: age (cycles)", 0..=6)),
    }
}

fn any_fixed<E: Engine + ?Sized>(e: &mut E) -> Fixed {
    Fixed {
        section: SectionId(e.word("fixed data: section", 1..=2)),
        gradient: any_gradient(e, "fixed data: gradient (‰, two's complement)"),
        limit: any_speed(e, "fixed data: limit (0.1 km/h)"),
        age: Ticks(e.word("fixed data: age (cycles)", 0..=6)),
    }
}

pub(crate) fn any_kind<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> LineKind {
    if any_flag(e, what) { LineKind::Digital } else { LineKind::Analog }
}

/// An arbitrary state, valid or not.
pub(crate) fn any_parts<E: Engine + ?Sized>(e: &mut E) -> State {
    let fix = any_distance(e, "fix (65 536 mm, mm)");
    let (target, behind, newest, other) = (any_target(e), any_target(e), any_fixed(e), any_fixed(e));
    State {
        line: any_kind(e, "line (odd: digital)"),
        fix: any_flag(e, "a fix (odd: yes)").then_some(fix),
        target: any_flag(e, "a target (odd: yes)").then_some(target),
        behind: any_flag(e, "a target of the section behind (odd: yes)").then_some(behind),
        fixed: [newest, other].map(|fixed| any_flag(e, "fixed data (odd: yes)").then_some(fixed)),
        main_stream: any_bits_of_stream(e),
        sub_stream: any_bits_of_stream(e),
    }
}

/// An arbitrary valid state.
pub(crate) fn any_state<E: Engine + ?Sized>(e: &mut E, line: &Line) -> State {
    let state = any_parts(e);
    e.assume(state.is_valid(&line.permitted));
    state
}

fn any_code<E: Engine + ?Sized>(e: &mut E) -> Option<KmhTenths> {
    let code = any_speed(e, "code (0.1 km/h)");
    any_flag(e, "a code (odd: yes)").then_some(code)
}

/// Anything that can be heard in a cycle.
pub(crate) fn any_heard<E: Engine + ?Sized>(e: &mut E) -> Option<Heard> {
    let told = any_kind(e, "line that begins (odd: digital)");
    let (main, sub) = (any_main(e)?, any_sub(e)?);
    let to_exit = any_distance(e, "distance to the exit (65 536 mm, mm)");
    Some(Heard {
        line: any_flag(e, "a line begins (odd: yes)").then_some(told),
        analog: any_code(e),
        main: any_flag(e, "a main telegram (odd: yes)").then_some(main),
        sub: any_flag(e, "a sub telegram (odd: yes)").then_some(sub),
        to_exit: any_flag(e, "a distance to the exit (odd: yes)").then_some(to_exit),
        moved: Millimetres(any_u32(e, "moved (mm)", 0..=3000)),
    })
}

/// One cycle from an arbitrary valid state, and whether its telegrams were used.
struct Cycle {
    line: Line,
    before: State,
    heard: Heard,
    after: State,
    /// The main telegram, if its ranks are known and its counter is in order.
    used_main: Option<Main>,
    /// The sub telegram, likewise.
    used_sub: Option<Sub>,
    /// What becomes of the counters of the main and of the sub telegrams.
    streams: [Stream; 2],
}

fn any_cycle<E: Engine + ?Sized>(e: &mut E) -> Option<Cycle> {
    let line = any_line(e)?;
    let before = any_state(e, &line);
    let heard = any_heard(e)?;
    let after = before.listen(&line.permitted, heard);
    // T-TEL-6 says what the counters do.
    let main = heard.main.filter(|main| knows_main(*main));
    let sub = heard.sub.filter(|sub| knows_sub(*sub));
    let sequence = &line.settings.sequence;
    let (main_stream, of_main) = sequence.step(before.main_stream, main.map(|main| main.header()));
    let (sub_stream, of_sub) = sequence.step(before.sub_stream, sub.map(|sub| sub.header()));
    let used_main = main.filter(|_| of_main == Judgement::Accepted);
    let used_sub = sub.filter(|_| of_sub == Judgement::Accepted);
    Some(Cycle { line, before, heard, after, used_main, used_sub, streams: [main_stream, sub_stream] })
}
