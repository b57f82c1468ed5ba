//! The models of ground, channel and train.

use crate::check::{About, Entry};
use crate::line::{COARSE, EARLY, FINE, LATE, Line, credited_gap};
use crate::reception::claims::{Bound, Purpose};
use crate::reception::{Environment, Ground, Longest, Reception};
use atc_kernel::aspect::Acceptance;

/// The bounds, the changes and bursts that outlive them, and the misread aspects.
pub(super) fn entries() -> Vec<Entry> {
    let mut entries = exposures();
    entries.extend(changes());
    entries.extend(stale_bursts());
    entries.extend(misreads());
    entries
}

const ANY: Ground = Ground::Any { dwell: 1, silence: true };

/// Ticks of a small line as the environment counts them.
fn small(ticks: u16) -> u8 {
    u8::try_from(ticks).unwrap_or(u8::MAX)
}

fn one(line: Line, environment: Environment, purpose: Purpose) -> Reception<Acceptance<1>, 1> {
    Reception::new(line, environment, purpose)
}

fn two(line: Line, environment: Environment, purpose: Purpose) -> Reception<Acceptance<2>, 2> {
    Reception::new(line, environment, purpose)
}

fn about(
    name: &'static str,
    statement: &str,
    environment: &str,
    in_force: &'static [&'static str],
    lifted: &'static [&'static str],
) -> About {
    About {
        name,
        statement: statement.to_owned(),
        requirements: &["ACC-3", "ACC-6", "ACC-8", "ACC-9", "T-ACC-3", "T-ACC-5"],
        environment: environment.to_owned(),
        in_force,
        lifted,
    }
}

/// Any change, any interruption; bursts shorter than T5.
fn short(line: Line) -> Environment {
    let burst = small(line.ticks().shortened_operate().0 - 1);
    Environment { ground: ANY, interruption: Longest::Unlimited, between: 0, burst, spacing: 1 }
}

/// Any change, any interruption; bursts shorter than T1, more than T4 apart.
fn spaced(line: Line) -> Environment {
    let times = line.ticks();
    Environment { burst: small(times.operate().0 - 1), spacing: small(times.interruption().0 + 1), ..short(line) }
}

fn exposures() -> Vec<Entry> {
    let short_bursts = |name| {
        about(
            name,
            "The ground changes at any time, the signal is interrupted at any time and for any length, and no false code \
             lasts T5: an aspect is displayed for at most (T2+T3 - 1) + (T5 - 1) whole cycles after the ground last sent \
             it or a higher one, and the bound is reached.",
            "any change, any interruption; bursts shorter than T5",
            &["detected-throughout", "one-signal", "no-stale-bursts"],
            &["change-is-heard", "short-interruptions"],
        )
    };
    let spaced_bursts = |name| {
        about(
            name,
            "The ground changes at any time, the signal is interrupted at any time and for any length; false codes last \
             less than T1 and come more than T4 apart: an aspect is displayed for at most T4 + (T1 - 1) + (T2+T3 - 1) \
             whole cycles after the ground last sent it or a higher one, and the bound is reached.",
            "any change, any interruption; bursts shorter than T1, more than T4 apart",
            &["detected-throughout", "one-signal", "spaced-bursts"],
            &["change-is-heard", "short-interruptions", "no-stale-bursts"],
        )
    };
    let kept = |about, line| Entry::new(about, two(line, short(line), Purpose::Exposure(Bound::ShortBursts)));
    let apart = |about, line| Entry::new(about, two(line, spaced(line), Purpose::Exposure(Bound::SpacedBursts)));
    let kept_one = |about, line| Entry::new(about, one(line, short(line), Purpose::Exposure(Bound::ShortBursts)));
    let apart_one = |about, line| Entry::new(about, one(line, spaced(line), Purpose::Exposure(Bound::SpacedBursts)));
    let three = |about, line| {
        let model = Reception::<Acceptance<3>, 3>::new(line, short(line), Purpose::Exposure(Bound::ShortBursts));
        Entry::new(about, model)
    };
    vec![
        kept(short_bursts("exposure"), COARSE),
        kept_one(short_bursts("exposure-fine"), FINE),
        kept(short_bursts("exposure-late"), LATE),
        three(short_bursts("exposure-three"), COARSE),
        apart_one(spaced_bursts("exposure-spaced-bursts"), COARSE),
        apart_one(spaced_bursts("exposure-spaced-bursts-fine"), FINE),
        apart(spaced_bursts("exposure-spaced-bursts-late"), LATE),
        apart(spaced_bursts("exposure-spaced-bursts-early"), EARLY),
    ]
}

fn changes() -> Vec<Entry> {
    let steady = Environment {
        ground: Ground::Any { dwell: small(COARSE.ticks().operate().0), silence: false },
        interruption: Longest::Cycles(0),
        burst: 0,
        ..short(COARSE)
    };
    let interrupted = Purpose::Outlives {
        bound: Bound::Heard,
        excluded_by: &["change-is-heard"],
        text: "after a change to a lower aspect the old one is displayed for longer than if the change were heard",
        still: Some(Bound::ShortBursts),
    };
    vec![
        Entry::new(
            about(
                "change-heard",
                "The ground sends each aspect for T1 or more and every change is heard: the old aspect is displayed for at \
                 most min(T1, T2+T3) - 1 whole cycles after a change to a lower one.",
                "each aspect for T1 or more, no interruption, no bursts",
                &["detected-throughout", "one-signal", "no-stale-bursts", "change-is-heard"],
                &[],
            ),
            two(COARSE, steady, Purpose::Exposure(Bound::Heard)),
        ),
        Entry::new(
            about(
                "change-interrupted",
                "A change to a lower aspect falls into an interruption: the old, higher aspect stays displayed for longer \
                 than T1, and for at most T2+T3 - 1 whole cycles.",
                "each aspect for T1 or more, any interruption, no bursts",
                &["detected-throughout", "one-signal", "no-stale-bursts"],
                &["change-is-heard"],
            ),
            two(COARSE, Environment { interruption: Longest::Unlimited, ..steady }, interrupted),
        ),
    ]
}

fn stale_bursts() -> Vec<Entry> {
    let repeated = |line: Line| Environment {
        burst: small(line.ticks().shortened_operate().0),
        spacing: small(credited_gap(line.ticks())),
        ..short(line)
    };
    let outlives = Purpose::Outlives {
        bound: Bound::SpacedBursts,
        excluded_by: &["no-stale-bursts", "spaced-bursts"],
        text: "an aspect is displayed for longer after the ground last sent it than with bursts that are spaced",
        still: None,
    };
    let about = |name| {
        about(
            name,
            "Bursts of T5 with gaps of min(T4, T2+T3-T5) let a stale aspect outlive every bound.",
            "any change, any interruption; bursts of T5 at most, min(T4, T2+T3-T5) or more apart",
            &["detected-throughout", "one-signal", "no-permissive-misread"],
            &["no-stale-bursts", "spaced-bursts"],
        )
    };
    vec![
        Entry::new(about("stale-bursts"), one(FINE, repeated(FINE), outlives)),
        Entry::new(about("stale-bursts-late"), two(LATE, repeated(LATE), outlives)),
    ]
}

fn misreads() -> Vec<Entry> {
    let times = COARSE.ticks();
    let (t1, t2, t5) = (small(times.operate().0), small(times.recovery().0), small(times.shortened_operate().0));
    let restrictive = Environment {
        ground: Ground::Lowest,
        interruption: Longest::Cycles(t2 - t5),
        between: t5,
        burst: t1,
        spacing: 1,
    };
    let about = |name, statement: &str, environment: &str, in_force, lifted| About {
        name,
        statement: statement.to_owned(),
        requirements: &["ACC-1", "ACC-2", "ACC-4", "ACC-7", "ACC-9", "T-ACC-1"],
        environment: format!("the lowest aspect is sent all the time; {environment}"),
        in_force,
        lifted,
    };
    let entry = |about, environment, purpose| {
        Entry::new(about, Reception::<Acceptance<2>, 2>::new(COARSE, environment, purpose))
    };
    vec![
        entry(
            about(
                "misread-short",
                "A more permissive aspect that is misread for less than T1 is never displayed, however long the one that is \
                 sent is interrupted.",
                "any interruption; bursts of a higher aspect shorter than T1",
                &["detected-throughout", "one-signal", "no-permissive-misread"],
                &["short-interruptions", "spaced-bursts"],
            ),
            Environment { interruption: Longest::Unlimited, between: 0, burst: t1 - 1, ..restrictive },
            Purpose::Restrictive,
        ),
        entry(
            about(
                "misread-in-recovery",
                "A more permissive aspect that is misread for T1 is not displayed while the one that is sent is interrupted \
                 for no longer than T2 - T5.",
                "interruptions of T2 - T5 at most, T5 between them; bursts of a higher aspect of T1 at most",
                &["detected-throughout", "one-signal", "short-interruptions"],
                &["no-permissive-misread", "spaced-bursts"],
            ),
            restrictive,
            Purpose::Restrictive,
        ),
        entry(
            about(
                "misread",
                "A more permissive aspect that is misread for T1 while the one that is sent is interrupted for longer than \
                 T2 - T5 is displayed: one cycle of interruption more than in misread-in-recovery is enough.",
                "interruptions of T2 - T5 + 1 at most, T5 between them; bursts of a higher aspect of T1 at most",
                &["detected-throughout", "one-signal"],
                &["no-permissive-misread", "short-interruptions", "spaced-bursts"],
            ),
            Environment { interruption: Longest::Cycles(t2 - t5 + 1), ..restrictive },
            Purpose::Misread,
        ),
    ]
}
