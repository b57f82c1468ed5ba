//! Every model, with its line, its environment and what it is there to show.

use crate::bursts::{Bursts, Schedule};
use crate::check::{About, Entry};
use crate::comparison::{Comparison, Extra};
use crate::interruption::Interruption;
use crate::line::{COARSE, DEFAULT, EARLY, FINE, LATE, Line, SHORTEST};
use atc_kernel::aspect::Acceptance;

mod about;
mod block;
mod interlocking;
mod permitted;
mod reception;
mod whole;

/// Every model over the kernel's machine.
pub fn catalogue() -> Vec<Entry> {
    let mut entries = comparisons();
    entries.extend(interruptions());
    entries.extend(reception::entries());
    entries.extend(bursts());
    entries.extend(block::entries());
    entries.extend(permitted::entries());
    entries.extend(interlocking::entries());
    entries.extend(whole::entries());
    entries
}

fn comparisons() -> Vec<Entry> {
    let statement = "Whatever is detected: where the conventional device or the machine as claimed shows something, the device \
                     shows nothing higher; its display rises only on T1 of evidence and falls only to an aspect heard for T5; \
                     an aspect heard for T1 bounds it.";
    let claimed = " The machine as claimed rises in silence, and on T5 of evidence.";
    let compare = |name, line, more: &str, extras: &[Extra]| {
        let hazards = if extras.contains(&Extra::Mask) { claimed } else { "" };
        let about = About {
            name,
            statement: format!("{statement}{hazards}{more}"),
            requirements: &[
                "ACC-1", "ACC-2", "ACC-5", "ACC-7", "ACC-8", "ACC-9", "T-ACC-1", "T-ACC-2", "T-ACC-5", "T-ACC-7",
            ],
            environment: "any set of aspects detected in any cycle".to_owned(),
            in_force: &["detected-throughout"],
            lifted: &["one-signal", "no-stale-bursts", "spaced-bursts", "no-permissive-misread", "change-is-heard"],
        };
        (about, line)
    };
    let usual = [Extra::Credit, Extra::Mask, Extra::Rise];
    let late = [Extra::Credit, Extra::Mask, Extra::Rise, Extra::CreditPastExpiry];
    let pair = |(about, line): (About, Line), extras: &[Extra]| {
        Entry::new(about, Comparison::<Acceptance<2>, 2>::new(line, extras))
    };
    let three = |(about, line): (About, Line), extras: &[Extra]| {
        Entry::new(about, Comparison::<Acceptance<3>, 3>::new(line, extras))
    };
    vec![
        pair(compare("any-detections", COARSE, "", &usual), &usual),
        pair(compare("any-detections-late", LATE, " A credit outlives expiry.", &late), &late),
        pair(compare("any-detections-early", EARLY, "", &usual), &usual),
        pair(compare("any-detections-shortest", SHORTEST, "", &[]), &[]),
        pair(compare("any-detections-fine", FINE, "", &late), &late),
        three(compare("any-detections-three", EARLY, "", &usual), &usual),
        three(compare("any-detections-three-late", LATE, " A credit outlives expiry.", &late), &late),
    ]
}

fn interruptions() -> Vec<Entry> {
    let lines = [
        ("interruption", DEFAULT),
        ("interruption-coarse", COARSE),
        ("interruption-late", LATE),
        ("interruption-early", EARLY),
    ];
    let entry = |(name, line)| {
        let about = About {
            name,
            statement:
                "One aspect alone: an interruption of g, glitches included, is bridged without a gap in the display \
                        exactly if g + T5 <= T2 + T3 and g <= T4 (or g + T1 <= T2 + T3); the conventional device needs \
                        g + T1 <= T2 + T3."
                    .to_owned(),
            requirements: &["ACC-1", "ACC-3", "ACC-4", "ACC-6", "ACC-8", "T-ACC-3", "T-ACC-4"],
            environment: "detected or not in any cycle, so interruptions of every length".to_owned(),
            in_force: &["detected-throughout", "alone-on-the-line"],
            lifted: &[],
        };
        Entry::new(about, Interruption::<Acceptance<1>>::new(line))
    };
    lines.map(entry).into()
}

fn bursts() -> Vec<Entry> {
    let about = |name, statement: &str, environment: &str| About {
        name,
        statement: statement.to_owned(),
        requirements: &["ACC-6", "ACC-8", "T-ACC-4"],
        environment: environment.to_owned(),
        in_force: &["detected-throughout", "alone-on-the-line"],
        lifted: &["no-stale-bursts", "spaced-bursts"],
    };
    let pattern = |name, line: Line, conventional: bool| {
        let statement = if conventional {
            "The conventional device: bursts of T1 in T2+T3 keep an aspect displayed for ever that the ground no longer \
             sends; no pattern with a smaller share does."
        } else {
            "Bursts of T5 with gaps of min(T4, T2+T3-T5) keep an aspect displayed for ever that the ground no longer sends; no \
             pattern of bursts with a smaller share does."
        };
        let times = if conventional { line.ticks().conventional() } else { line.ticks() };
        let environment = "T1 of genuine signal, then any pattern of bursts";
        Entry::new(about(name, statement, environment), Bursts::<Acceptance<1>>::new(line, times))
    };
    vec![
        pattern("burst-loops", COARSE, false),
        pattern("burst-loops-conventional", COARSE, true),
        pattern("burst-loops-late", LATE, false),
        pattern("burst-loops-early", EARLY, false),
        Entry::new(
            about(
                "burst-schedule",
                "Which regular bursts keep a stale aspect displayed for ever at the default times, and which bring it back \
                 again and again; the conventional device beside it.",
                "T1 of genuine signal, then bursts of 1 to T1 cycles with gaps of 1 to T2+T3+1 cycles, for ever",
            ),
            Schedule::new(DEFAULT),
        ),
    ]
}
