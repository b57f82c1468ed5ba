//! Consent (T-WAY-5): never older than its life, whatever comes late, twice or out of order.

use super::{LONGEST, device, plan, quiet};
use crate::Engine;
use crate::engine::{any_flag, any_u32};
use atc_kernel::Machine;
use atc_kernel::interlocking::{CircuitSet, Epoch, Layout, Segment, SegmentSet};
use atc_kernel::time::{MAX_TICKS, Ticks};
use atc_kernel::wayside::{Consent, Message, Permission, Session, Stamp, State, Wayside};

/// A station with one segment and no route.
type Line = Layout<1, 1, 0, 1>;
type Device<'a> = Wayside<'a, 0, 1, 1, 0, 1>;

/// The layout with any turn time.
fn any_line<E: Engine + ?Sized>(e: &mut E) -> Option<Line> {
    let mut plan = plan();
    plan.segments = [Segment { circuits: [CircuitSet::nth(0)], length: 1, ..Segment::NONE }];
    plan.turn = Ticks(e.word("turn time (cycles)", 3..=9));
    let layout = Layout::with_what_proofs_need(plan).ok();
    e.assume(layout.is_some());
    layout
}

fn any_permission<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> Permission {
    if any_flag(e, what) { Permission::Granted } else { Permission::Withheld }
}

fn any_stamp<E: Engine + ?Sized>(e: &mut E) -> Stamp {
    let session = Session(e.word("start of a stamp", 0..=1));
    Stamp { session, cycle: Epoch(any_u32(e, "cycle of a stamp", 0..=9)) }
}

fn any_message<E: Engine + ?Sized>(e: &mut E) -> Message {
    let permission = any_permission(e, "the message permits (odd: yes)");
    let echo = any_stamp(e);
    let echo = if any_flag(e, "it echoes a stamp (odd: yes)") { Some(echo) } else { None };
    Message { permission, sent: any_stamp(e), echo }
}

/// Any valid state as far as consent looks at it.
fn any_state<E: Engine + ?Sized>(e: &mut E, device: &Device, life: Ticks) -> Option<State<0, 1, 1>> {
    let mut state = device.initial();
    let cycle = Epoch(any_u32(e, "number of the last cycle", 0..=9));
    state.device.cycle = cycle;
    state.device.interlocking.epoch = cycle;
    let heard = any_stamp(e);
    let heard = if any_flag(e, "the neighbour has been heard (odd: yes)") { Some(heard) } else { None };
    let permission = any_permission(e, "permitted by the newest message (odd: yes)");
    let consent = Consent { permission, age: Ticks(e.word("age (cycles)", 0..=9)), heard };
    let valid = consent.is_valid(life);
    e.assume(valid);
    state.consents = [consent];
    if valid { Some(state) } else { None }
}

harness! {
    /// The neighbour's permission counts only while a message that grants it was sent no more cycles ago than its life: with a ghost that knows when
    /// each message was sent, however late, often, or in whatever order messages come. A message that withholds ends it at once, and after that
    /// only one that answers a later cycle grants again.
    t_way_5(e)
    theorem "T-WAY-5";
    requirements ["WAY-8", "WAY-9", "WAY-20"];
    assumptions ["echo-answers"];
    bound "1 route, 1 segment";
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Fresh: "a permission that is handed to the interlocking was sent no more cycles ago than its life",
        Kept: "what is remembered to be permitted was sent no more cycles ago than is remembered",
        Ended: "a message that withholds ends the permission in its cycle, whatever it answers",
        Ordered: "a message that answers no later cycle than the newest before it grants nothing that was not granted",
        Counts: "a message that grants and answers a later cycle, no longer ago than the life, counts in its cycle",
        Oldest: "the age that the device prints is the life, and that is less than the turn time",
    }
    covers {
        Kept: "a permission counts that came in an earlier cycle",
        Lapses: "a permission lapses by its age",
        Repeated: "a message that was sent longer ago than its life comes again",
        Other: "a message answers a cycle of another start",
        Renewed: "a message makes the permission younger",
    }
    {
        let Some(line) = any_line(e) else { return };
        let life = Ticks(e.word("life (cycles)", 1..=6));
        let Some(device) = device(e, &line, None, (life, 1)) else { return };
        let Some(state) = any_state(e, &device, life) else { return };
        let before = state.consents[0];
        let granted = before.permission == Permission::Granted && before.age.0 <= life.0;
        // Ghost: cycles since the message was sent that says so.
        let sent = any_u32(e, "cycles since the newest message was sent", 0..=9);
        e.assume(!granted || sent <= u32::from(before.age.0));
        let message = any_message(e);
        let comes = any_flag(e, "a message comes (odd: yes)");
        let its = any_u32(e, "cycles since this message was sent", 0..=9);
        let now = Stamp { session: Session(device_session(&device, &state)), cycle: Epoch(state.device.cycle.0.wrapping_add(1)) };
        let (answers, since) = match message.echo {
            Some(echo) => (echo.session.0 == now.session.0, now.cycle.0.wrapping_sub(echo.cycle.0)),
            None => (false, 0),
        };
        e.suppose("echo-answers", !answers || its <= since);
        let mut input = quiet();
        input.messages = [if comes { Some(message) } else { None }];
        let (after, reading) = device.read(state, input);
        let counts = reading.input.consent.bits() & 1 == 1;
        let grants = comes && message.permission == Permission::Granted;
        let withholds = comes && message.permission == Permission::Withheld;
        let older = granted && sent < u32::from(life.0);
        e.claim(Claim::Fresh as u32, !counts || older || grants && its <= u32::from(life.0));
        let consent = after.consents[0];
        let kept = granted && sent < u32::from(consent.age.0) || grants && its <= u32::from(consent.age.0);
        let remembered = consent.permission == Permission::Granted && consent.age.0 <= life.0;
        e.claim(Claim::Kept as u32, (!remembered || kept) && consent.is_valid(life));
        e.claim(Claim::Ended as u32, !withholds || !counts);
        let newer = answers && since <= u32::from(before.age.0) && since <= u32::from(life.0);
        e.claim(Claim::Ordered as u32, !comes || newer || !counts || granted && before.age.0 < life.0);
        e.claim(Claim::Counts as u32, !grants || !newer || counts);
        e.claim(Claim::Oldest as u32, device.oldest() == life && life < line.plan().turn && life.0 <= MAX_TICKS);
        e.cover(Cover::Kept as u32, counts && !comes);
        e.cover(Cover::Lapses as u32, granted && !comes && !counts);
        e.cover(Cover::Repeated as u32, grants && answers && its > u32::from(life.0));
        e.cover(Cover::Other as u32, grants && !answers && message.echo.is_some());
        e.cover(Cover::Renewed as u32, counts && grants && granted && consent.age.0 <= before.age.0);
    }
}

/// The number of this start, as its messages have it.
fn device_session(device: &Device, state: &State<0, 1, 1>) -> u16 {
    device.messages(state, SegmentSet::EMPTY)[0].map_or(0, |message| message.sent.session.0)
}

harness! {
    /// What a station tells its neighbour in a cycle is what it permits in that cycle, under the number of that cycle, and it echoes what it has heard
    /// of last; so that the neighbour, if it is this device, uses no permission that was withdrawn the turn time ago.
    t_way_5_told(e)
    theorem "T-WAY-5";
    requirements ["WAY-20", "WAY-22"];
    assumptions [];
    bound "1 route, 1 segment";
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Permits: "a message grants exactly what is permitted in its cycle",
        Stamp: "it has the number of its cycle and the start of its device",
        Echo: "it echoes the cycle of the last message that has come, of this cycle or before",
        Known: "the life is at least one cycle, and a permission that was withdrawn for the turn time is older than it",
    }
    covers {
        Grants: "a message grants",
        Echoes: "a message echoes what came in this cycle",
        Silent: "the neighbour was never heard",
    }
    {
        let Some(line) = any_line(e) else { return };
        let life = Ticks(e.word("life (cycles)", 1..=6));
        let Some(device) = device(e, &line, None, (life, 1)) else { return };
        let Some(state) = any_state(e, &device, life) else { return };
        let message = any_message(e);
        let comes = any_flag(e, "a message comes (odd: yes)");
        let mut input = quiet();
        input.messages = [if comes { Some(message) } else { None }];
        let permits = SegmentSet::from_bits(e.word("permits (bits)", 0..=1).to_le_bytes()[0]);
        let (mut after, _) = device.read(state, input);
        let cycle = Epoch(state.device.cycle.0.wrapping_add(1));
        after.device.cycle = cycle;
        let [told] = device.messages(&after, permits);
        let Some(told) = told else { return e.claim(Claim::Permits as u32, false) };
        let granted = told.permission == Permission::Granted;
        e.claim(Claim::Permits as u32, granted == (permits.bits() & 1 == 1));
        e.claim(Claim::Stamp as u32, told.sent.cycle == cycle && told.sent.session.0 == device_session(&device, &state));
        let heard = if comes { Some(message.sent) } else { state.consents[0].heard };
        e.claim(Claim::Echo as u32, told.echo == heard);
        e.claim(Claim::Known as u32, life.0 >= 1 && line.plan().turn.0 > life.0);
        e.cover(Cover::Grants as u32, granted);
        e.cover(Cover::Echoes as u32, comes && told.echo == Some(message.sent));
        e.cover(Cover::Silent as u32, told.echo.is_none());
    }
}
