//! The direction of travel, and changing ends: T-TRN-8.

use super::{BOUND, RANKS, any_device_state, any_received};
use crate::Engine;
use crate::permitted::any_line;
use atc_kernel::aspect::AspectSet;
use atc_kernel::heading::Heading;
use atc_kernel::permitted::{self, Fixed, Target};
use atc_kernel::supervision::Brake;
use atc_kernel::telegram::{Header, Main, SectionId, Stream, Sub};
use atc_kernel::train::{Received, State};

/// How a train faces, or that nobody knows.
pub(super) fn any_way<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> Option<Heading> {
    match e.word(what, 0..=2) {
        0 => None,
        1 => Some(Heading::Left),
        _ => Some(Heading::Right),
    }
}

/// Whether a section's number is for a train that faces so, said without the kernel's words: odd numbers are for the left.
pub(super) fn ahead(section: SectionId, facing: Option<Heading>) -> bool {
    match facing {
        None => false,
        Some(Heading::Left) => section.0 % 2 == 1,
        Some(Heading::Right) => section.0 % 2 == 0,
    }
}

/// A number for a train that faces so, whatever `section` is.
fn of(section: SectionId, facing: Option<Heading>) -> SectionId {
    SectionId(section.0 << 1 | u16::from(facing == Some(Heading::Left)))
}

/// Whether all that is kept of telegrams was said to trains that face so.
fn own(state: &State<RANKS>) -> bool {
    let is = |section: SectionId| ahead(section, state.facing);
    let permitted = &state.permitted;
    let [newest, other] = &permitted.fixed;
    permitted.target.is_none_or(|it| is(it.section))
        && permitted.behind.is_none_or(|it| is(it.section))
        && newest.is_none_or(|it| is(it.section))
        && other.is_none_or(|it| is(it.section))
        && permitted.main_stream.last.is_none_or(|it| is(it.section))
        && permitted.sub_stream.last.is_none_or(|it| is(it.section))
}

/// Whether nothing is known by which a train may move: no main telegram, no code, not even one that was lost.
fn knows_nothing(state: &State<RANKS>) -> bool {
    let acceptance = state.acceptance.parts();
    let codes = acceptance.accepted == 0 && acceptance.last == 0 && acceptance.run == [0; RANKS];
    let permitted = &state.permitted;
    codes && permitted.target.is_none() && permitted.behind.is_none() && permitted.main_stream.last.is_none()
}

harness! {
    /// A train faces one way, or nobody knows which. One that changes ends, or loses its direction, knows what a device just started knows: nothing by which
    /// it may move, under the emergency brake. One that goes on facing as it did keeps what it knew, which was said to trains that face so.
    t_trn_8(e)
    theorem "T-TRN-8";
    requirements ["TRN-12"];
    assumptions ["four-for-sixteen", "four-speeds", "trains-know-facing"];
    built_in &[("trains-know-facing", "what the device is told is how the train faces")];
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Own: "all that is known of telegrams was said to trains that face as this one does now",
        Anew: "if its direction changes, or is lost, it knows what a device just started knows, and nothing else",
        Nothing: "which is no main telegram and no code, and the emergency brake",
        Same: "otherwise it knows what it knew",
        Start: "the initial state knows no direction, and nothing that was said to anybody",
    }
    covers {
        Turned: "a train that had a stopping point changes ends",
        Lost: "the direction is lost",
        Found: "the direction becomes known",
        Goes: "a train goes on with a stopping point",
    }
    {
        let Some(line) = any_line(e) else { return };
        let Some((_, mut before)) = any_device_state(e, line, None) else { return };
        before.facing = any_way(e, "facing before (0: not known, 1: left, else right)");
        let faces = any_way(e, "facing now (0: not known, 1: left, else right)");
        keep_own(&mut before);
        e.assume(own(&before));
        let known = before.facing(faces);
        e.claim(Claim::Own as u32, known.facing == faces && own(&known));
        let changed = before.facing != faces;
        e.claim(Claim::Anew as u32, !changed || known == State { facing: faces, ..State::INITIAL });
        e.claim(Claim::Nothing as u32, !changed || knows_nothing(&known) && known.brake == Brake::Emergency);
        e.claim(Claim::Same as u32, changed || known == before);
        let start = State::<RANKS>::INITIAL;
        e.claim(Claim::Start as u32, own(&start) && knows_nothing(&start) && start.facing.is_none());
        let stops = before.permitted.target.is_some();
        e.cover(Cover::Turned as u32, changed && stops && faces.is_some());
        e.cover(Cover::Lost as u32, changed && faces.is_none());
        e.cover(Cover::Found as u32, changed && before.facing.is_none());
        e.cover(Cover::Goes as u32, !changed && stops);
    }
}

harness! {
    /// Of telegrams a train keeps nothing, in any cycle, but what was said to trains that face as it does. One that knows of no main telegram and no code, and
    /// is told none, is held by the emergency brake, whatever is said to trains of the other direction, and still knows of none. With `t_trn_8`: so it is from
    /// the cycle on in which it changes ends, or its direction is lost, until it is told something in its new direction.
    t_trn_8_held(e)
    theorem "T-TRN-8";
    requirements ["TRN-11", "TRN-12"];
    assumptions ["four-for-sixteen", "four-speeds", "trains-know-facing"];
    built_in &[("trains-know-facing", "what the device is told is how the train faces")];
    bound BOUND;
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    claims {
        Own: "all that is kept of telegrams was said to trains that face as this one does",
        Held: "a train that knows of no main telegram and no code, and is told none, is held by the emergency brake, and knows of none",
    }
    covers {
        Kept: "a target and the fixed data of two sections are kept",
        Told: "a train that knows nothing is told something in its own direction",
        Waits: "a train waits for its first telegram",
    }
    {
        let Some(line) = any_line(e) else { return };
        let Some((device, mut before)) = any_device_state(e, line, None) else { return };
        let Some(mut received) = any_received(e) else { return };
        before.facing = any_way(e, "facing (0: not known, 1: left, else right)");
        keep_own(&mut before);
        e.assume(own(&before) && before.is_valid(&device.train));
        // What is received of any frame is for the train's own direction (T-TRN-4).
        take_own(&mut received, before.facing);
        let (after, cab) = device.train.act(before, received);
        e.claim(Claim::Own as u32, after.facing == before.facing && own(&after));
        let nothing = knows_nothing(&before);
        let waits = nothing && received.main.is_none() && received.detected == AspectSet::EMPTY;
        let held = cab.brake == Brake::Emergency && cab.permission.speed.is_none() && knows_nothing(&after);
        e.claim(Claim::Held as u32, !waits || held);
        let fixed = after.permitted.fixed[0].is_some() && after.permitted.fixed[1].is_some();
        e.cover(Cover::Kept as u32, after.permitted.target.is_some() && fixed);
        e.cover(Cover::Told as u32, nothing && received.main.is_some());
        e.cover(Cover::Waits as u32, waits && before.facing.is_some());
    }
}

/// Numbers what is kept for the direction that the train faces; a train that knows none keeps nothing.
fn keep_own(state: &mut State<RANKS>) {
    let facing = state.facing;
    let permitted = state.permitted;
    let target = |target: Option<Target>| target.map(|it| Target { section: of(it.section, facing), ..it });
    let fixed = |fixed: Option<Fixed>| fixed.map(|it| Fixed { section: of(it.section, facing), ..it });
    let stream = |stream: Stream| Stream {
        last: stream.last.map(|it| Header { section: of(it.section, facing), ..it }),
        ..stream
    };
    let [newest, other] = permitted.fixed;
    let said = facing.is_some();
    state.permitted = permitted::State {
        target: target(permitted.target.filter(|_| said)),
        behind: target(permitted.behind.filter(|_| said)),
        fixed: [fixed(newest.filter(|_| said)), fixed(other.filter(|_| said))],
        main_stream: if said { stream(permitted.main_stream) } else { Stream::EMPTY },
        sub_stream: if said { stream(permitted.sub_stream) } else { Stream::EMPTY },
        ..permitted
    };
}

/// Numbers the telegrams of a cycle so; a train that knows no direction receives none.
fn take_own(received: &mut Received, facing: Option<Heading>) {
    let said = facing.is_some();
    let (main, sub) = (received.main.filter(|_| said), received.sub.filter(|_| said));
    received.main = main.map(|it| Main { section: of(it.section, facing), ..it });
    received.sub = sub.map(|it| Sub { section: of(it.section, facing), ..it });
}
