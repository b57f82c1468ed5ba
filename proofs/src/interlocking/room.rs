//! A train by codes alone has the room to stop (T-ATC-8): a ghost train on a line, by one step.
//!
//! `proofs/reals/t_atc_8.smt2` says the same of all real numbers, and of steps of any length.

use crate::Engine;
use atc_kernel::interlocking::needed_room;

/// The numbers of a speed: few, since products of arbitrary numbers are hard for a prover.
const SPEEDS: u16 = 8;

/// Times are in the unit of speed, too: what the brake takes off in them. So the brake is 1.
fn any_speed<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> u32 {
    let speed = e.word(what, 0..=8);
    e.assume(speed < SPEEDS);
    u32::from(speed % SPEEDS)
}

/// A train, and what a code does for it that it was told. `room` is the square of the speed from which it stops where it must.
#[derive(Clone, Copy)]
struct Ghost {
    speed: u32,
    room: u32,
    /// The speed of a code that it was told.
    code: u32,
    /// How long ago.
    since: u32,
    /// The latest time, after it was told, at which a train that brakes is back at the code: of all the times at which it may have begun.
    back: u32,
}

impl Ghost {
    /// It stops where it must, if it brakes.
    fn stops(&self) -> bool {
        self.speed * self.speed <= self.room
    }

    /// How much faster it is than the code.
    fn over(&self) -> u32 {
        self.speed.saturating_sub(self.code)
    }

    /// What is known of a train that was told the code.
    fn is_known(&self, age: u32) -> bool {
        let Some(left) = self.back.checked_sub(self.since) else { return false };
        let Some(needed) = needed_room(self.code, age) else { return false };
        let Ok(needed) = u32::try_from(needed) else { return false };
        // What it has run since: the code's speed all the time, and what it was faster on top, less and less.
        let run = 2 * self.code * self.since + (self.back * self.back - left * left);
        left >= self.over() && self.room >= (self.code + left) * (self.code + left) && self.room + run >= needed
    }

    /// It has heard the code just now.
    fn told(speed: u32, room: u32, code: u32) -> Self {
        let told = Self { speed, room, code, since: 0, back: 0 };
        Self { back: told.over(), ..told }
    }

    /// Some time later, with another speed.
    fn after(self, time: u32, speed: u32, room: u32) -> Self {
        let later = Self { speed, room, since: self.since + time, ..self };
        let back = later.since + later.over();
        Self { back: if back > self.back { back } else { self.back }, ..later }
    }
}

harness! {
    /// A train by codes alone that has the room to stop where it must keeps it: with its speed v and its brake b, v²/2b is never more than what is left. Codes
    /// fall and rise in any order, and it brakes or speeds up as it likes, as long as it brakes where it is faster than every code that it was told
    /// within the age. Each code was told where its distance was left.
    t_atc_8(e)
    theorem "T-ATC-8";
    requirements ["ATC-16"];
    assumptions ["codes-kept-from-below", "change-is-heard", "codes-heard-beyond"];
    bound "speeds and times of 0 to 7, steps of 1";
    cases 28;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Within: "it runs no farther than what is left",
        Stops: "behind the step it stops within what is left, if it brakes",
        Known: "what is known of a code that it was told is still known",
        Told: "a code that it is told is known of from then on",
    }
    covers {
        Brakes: "it brakes, and is still faster than the code",
        Stands: "it comes to a stand",
        Rises: "it speeds up to a code that it was told",
        Over: "it is faster than the code that it was told, and obeys a higher one",
        Lower: "it is told a code that is lower than its speed",
    }
    {
        let case = e.choose("since it was told, and: brakes, comes to a stand, obeys this code, obeys another code", 28);
        let (step, since) = (case & 3, u32::from(case.to_le_bytes()[0] >> 2));
        let age = any_speed(e, "age");
        let train = Ghost {
            speed: any_speed(e, "speed"),
            room: u32::from(e.word("room", 0..=256)),
            code: any_speed(e, "speed of the code"),
            since,
            back: u32::from(e.word("when a train that brakes is back at the code", 0..=64) & 0xFF),
        };
        e.assume(train.stops() && train.is_known(age));
        let time = 1;
        e.suppose("change-is-heard", train.since + time <= age);
        let speed = any_speed(e, "speed behind the step");
        // The speed changes evenly within a step, so this is twice the brake times what it runs. A train that comes to a stand runs no more than from
        // its speed with this brake.
        let run = if step == 1 { train.speed * train.speed } else { (train.speed + speed) * time };
        match step {
            0 => e.suppose("codes-kept-from-below", speed + time <= train.speed),
            1 => e.suppose("codes-kept-from-below", speed == 0 && train.speed <= time),
            2 => e.suppose("codes-kept-from-below", speed <= train.code),
            _ => {}
        }
        // What another code does for it is what this one does.
        e.claim(Claim::Within as u32, step == 3 || run <= train.room);
        e.assume(run <= train.room);
        let later = train.after(time, speed, train.room.saturating_sub(run));
        e.claim(Claim::Stops as u32, step == 3 || later.stops());
        e.assume(later.stops());
        e.claim(Claim::Known as u32, later.is_known(age));
        let code = any_speed(e, "speed of another code");
        e.suppose("codes-heard-beyond", needed_room(code, age).is_some_and(|needed| needed <= u64::from(later.room)));
        let told = Ghost::told(later.speed, later.room, code);
        e.claim(Claim::Told as u32, told.is_known(age));
        e.cover(Cover::Brakes as u32, step == 0 && later.over() > 0);
        e.cover(Cover::Stands as u32, step == 1 && train.speed > 0);
        e.cover(Cover::Rises as u32, step == 2 && speed > train.speed);
        e.cover(Cover::Over as u32, step == 3 && speed > train.code && speed > train.speed);
        e.cover(Cover::Lower as u32, code < later.speed);
    }
}

harness! {
    /// A distance that is long enough for two brakes is long enough for every brake between them. So a layout asks for the weakest brake, and for the
    /// strongest of a train that comes from telegrams.
    t_atc_8_brakes(e)
    theorem "T-ATC-8";
    requirements ["ATC-16"];
    assumptions [];
    bound "brakes, ages and speeds of 0 to 7";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Between: "the distance is long enough for the brake between",
    }
    covers {
        Weaker: "the weaker brake needs more than the one between",
        Stronger: "the stronger brake needs more than the one between",
        Enough: "the distance is hardly enough for the one between, and for the others",
    }
    {
        let (code, age) = (any_speed(e, "speed of the code"), any_speed(e, "age"));
        let (weaker, between) = (any_speed(e, "the weaker brake"), any_speed(e, "a brake between"));
        let stronger = any_speed(e, "the stronger brake");
        e.assume(0 < weaker && weaker <= between && between <= stronger);
        let twice = u64::from(e.word("twice the distance", 0..=256));
        // What a train loses of its speed with its brake in the age.
        let needed = |brake: u32| needed_room(code, brake * age).unwrap_or(u64::MAX);
        let holds = |brake: u32| needed(brake) <= u64::from(brake) * twice;
        e.assume(holds(weaker) && holds(stronger));
        e.claim(Claim::Between as u32, holds(between));
        let more = |brake: u32| needed(brake) * u64::from(between) > needed(between) * u64::from(brake);
        e.cover(Cover::Weaker as u32, more(weaker) && weaker < between);
        e.cover(Cover::Stronger as u32, more(stronger) && between < stronger);
        e.cover(Cover::Enough as u32, weaker < between && between < stronger && twice > 0 && needed(between) > u64::from(between) * (twice - 1));
    }
}
