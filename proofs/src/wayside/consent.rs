//! Consent (T-WAY-5): never older than its life, whatever comes late, twice or out of order.

use crate::Engine;
use crate::engine::{any_byte, any_flag, any_u32};
use atc_kernel::interlocking::Epoch;
use atc_kernel::time::{MAX_TICKS, Ticks};
use atc_kernel::wayside::{Consent, Message, Permission, Session, Stamp, WaysideError, check_life};

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

/// Any valid memory of the neighbour, and a life.
fn any_consent<E: Engine + ?Sized>(e: &mut E) -> Option<(Ticks, Consent)> {
    let life = Ticks(e.word("life (cycles)", 1..=6));
    let heard = any_stamp(e);
    let heard = if any_flag(e, "the neighbour has been heard (odd: yes)") { Some(heard) } else { None };
    let permission = any_permission(e, "permitted by the newest message (odd: yes)");
    let consent = Consent { permission, age: Ticks(e.word("age (cycles)", 0..=7)), heard };
    let valid = consent.is_valid(life) && life.0 <= MAX_TICKS;
    e.assume(valid);
    if valid { Some((life, consent)) } else { None }
}

harness! {
    /// The neighbour's permission counts only while a message that grants it was sent no more cycles ago than its life: with a ghost that knows when
    /// each message was sent, however late, often, or in whatever order messages come. A message that withholds ends it at once, and after that
    /// only one that answers a later cycle grants again.
    t_way_5(e)
    theorem "T-WAY-5";
    requirements ["WAY-8", "WAY-9"];
    assumptions ["echo-answers"];
    bound "";
    cases 1;
    unwind 2 = 2;
    claims {
        Fresh: "a permission that is handed to the interlocking was sent no more cycles ago than its life",
        Kept: "what is remembered to be permitted was sent no more cycles ago than is remembered",
        Ended: "a message that withholds ends the permission in its cycle, whatever it answers",
        Ordered: "a message that answers no later cycle than the newest before it grants nothing that was not granted",
        Counts: "a message that grants and answers a later cycle, no longer ago than the life, counts in its cycle",
        Start: "at the start nothing is permitted, and nothing has been heard",
    }
    covers {
        Kept: "a permission counts that came in an earlier cycle",
        Lapses: "a permission lapses by its age",
        Repeated: "a message that was sent longer ago than its life comes again",
        Other: "a message answers a cycle of another start",
        Renewed: "a message makes the permission younger",
    }
    {
        let Some((life, before)) = any_consent(e) else { return };
        let granted = before.permission == Permission::Granted && before.age.0 <= life.0;
        // Ghost: cycles since the message was sent that says so.
        let sent = any_u32(e, "cycles since the newest message was sent", 0..=9);
        e.assume(!granted || sent <= u32::from(before.age.0));
        let message = any_message(e);
        let comes = any_flag(e, "a message comes (odd: yes)");
        let its = any_u32(e, "cycles since this message was sent", 0..=9);
        let now = any_stamp(e);
        let (answers, since) = match message.echo {
            Some(echo) => (echo.session.0 == now.session.0, now.cycle.0.wrapping_sub(echo.cycle.0)),
            None => (false, 0),
        };
        e.suppose("echo-answers", !answers || its <= since);
        let consent = before.hear(life, now, if comes { Some(message) } else { None });
        let counts = consent.counts(life);
        let grants = comes && message.permission == Permission::Granted;
        let withholds = comes && message.permission == Permission::Withheld;
        let older = granted && sent < u32::from(life.0);
        e.claim(Claim::Fresh as u32, !counts || older || grants && its <= u32::from(life.0));
        let kept = granted && sent < u32::from(consent.age.0) || grants && its <= u32::from(consent.age.0);
        let remembered = consent.permission == Permission::Granted && consent.age.0 <= life.0;
        e.claim(Claim::Kept as u32, (!remembered || kept) && consent.is_valid(life));
        e.claim(Claim::Ended as u32, !withholds || !counts);
        let newer = answers && since <= u32::from(before.age.0) && since <= u32::from(life.0);
        e.claim(Claim::Ordered as u32, !comes || newer || !counts || granted && before.age.0 < life.0);
        e.claim(Claim::Counts as u32, !grants || !newer || counts);
        let start = Consent::none(life);
        e.claim(Claim::Start as u32, start.is_valid(life) && !start.counts(life) && start.heard.is_none());
        e.cover(Cover::Kept as u32, counts && !comes);
        e.cover(Cover::Lapses as u32, granted && !comes && !counts);
        e.cover(Cover::Repeated as u32, grants && answers && its > u32::from(life.0));
        e.cover(Cover::Other as u32, grants && !answers && message.echo.is_some());
        e.cover(Cover::Renewed as u32, counts && grants && granted && consent.age.0 <= before.age.0);
    }
}

harness! {
    /// What a station tells its neighbour is what it permits, under the stamp of the cycle, and it echoes what it has heard of last.
    t_way_5_told(e)
    theorem "T-WAY-5";
    requirements ["WAY-22"];
    assumptions [];
    bound "";
    cases 1;
    unwind 2 = 2;
    claims {
        Told: "a message has the permission and the stamp of its cycle",
        Echo: "it echoes the stamp of the last message that has come, of this cycle or before",
    }
    covers {
        Echoes: "a message echoes what came in this cycle",
        Silent: "the neighbour was never heard",
    }
    {
        let Some((life, before)) = any_consent(e) else { return };
        let message = any_message(e);
        let comes = any_flag(e, "a message comes (odd: yes)");
        let now = any_stamp(e);
        let permission = any_permission(e, "permitted (odd: yes)");
        let told = before.hear(life, now, if comes { Some(message) } else { None }).tell(now, permission);
        e.claim(Claim::Told as u32, told.permission == permission && told.sent == now);
        e.claim(Claim::Echo as u32, told.echo == if comes { Some(message.sent) } else { before.heard });
        e.cover(Cover::Echoes as u32, comes);
        e.cover(Cover::Silent as u32, told.echo.is_none());
    }
}

harness! {
    /// A life is accepted if and only if it is one cycle at least, 60 000 at most, and under the turn time, which covers the residual running and the loss
    /// of shunt besides: a permission that was withdrawn for the turn time is older than the life, and who was sent by it is seen, or stands.
    way_life(e)
    theorem "T-WAY-8";
    requirements ["WAY-20"];
    assumptions [];
    bound "";
    cases 1;
    unwind 2 = 2;
    claims {
        Exact: "accepted if and only if it is 1 to 60 000 cycles, and the turn time is longer and covers what a train runs after it, unseen at the last",
        Told: "the error says which",
    }
    covers {
        Accepted: "a life is accepted",
        Long: "a life as long as the turn time",
        RunsOn: "a life under the turn time, and a train would run on for longer",
    }
    {
        let (life, turn) = (e.word("life (cycles)", 0..=3), e.word("turn time (cycles)", 0..=4));
        let (residual, loss) = (e.word("residual running (cycles)", 0..=1), any_byte(e, "longest loss (cycles)", 0..=1));
        let made = check_life(Ticks(life), Ticks(turn), Ticks(residual), loss);
        let left = u32::from(turn).checked_sub(u32::from(life));
        let covered = left.is_some_and(|left| left > 0 && left >= u32::from(residual) + u32::from(loss));
        e.claim(Claim::Exact as u32, made.is_ok() == (life >= 1 && covered && life <= 60_000));
        let told = match made {
            Err(WaysideError::NoLife) => life == 0,
            Err(error) => error == WaysideError::LifeOutlastsTurn && (!covered || life > 60_000),
            Ok(()) => true,
        };
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, made.is_ok());
        e.cover(Cover::Long as u32, life > 0 && life == turn);
        e.cover(Cover::RunsOn as u32, life > 0 && life < turn && !covered);
    }
}
