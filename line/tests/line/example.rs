//! The example with two stations and counted blocks, as its file gives it.

use atc_kernel::interlocking::{Heading, SpeedCode};
use atc_line::{Outcome, read};
use std::path::Path;

#[test]
fn every_rule_is_met_and_every_rule_is_about_something() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/line.toml");
    let line = read(&path).unwrap_or_else(|problems| panic!("{problems}"));
    for check in line.checks() {
        assert_eq!(check.outcome, Outcome::Met, "{} ({})", check.rule, check.scope);
    }
    assert!(line.is_sound());
    // Every rule is looked at, but for those of what the example does not have, and of the form of single values.
    let looked: Vec<_> = line.checks().iter().map(|check| check.rule.clone()).collect();
    // Whether the devices start is asked where they are (`atc_protocol::devices`).
    let without = ["form", "range", "section-twice", "TEL-4", "PAT-3", "PER-7", "POS-5", "device-starts"];
    for rule in atc_line::Rule::ALL.iter().map(|rule| rule.id()) {
        assert_ne!(looked.iter().any(|one| one == rule), without.contains(&rule), "{rule}");
    }
}

#[test]
fn a_simulation_finds_what_it_needs() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/line.toml");
    let line = read(&path).expect("good");
    let names: Vec<_> = line.stations().iter().map(atc_line::seam::Station::name).collect();
    assert_eq!(names, ["Westham", "Eastham"]);
    let speeds = line.signal().expect("telegrams").permitted().settings().speeds;
    let rank = |code| line.stations()[0].rank(&speeds, SpeedCode(code)).map(atc_kernel::aspect::AspectId::rank);
    assert_eq!([rank(0), rank(1), rank(7), rank(8)], [Some(0), Some(1), Some(7), None]);
    let sent = |station: &str, circuit: &str, heading| {
        let found = line.telegrams().iter().find(|one| one.station == station && one.circuit == circuit);
        found.and_then(|one| one.section(heading))
    };
    assert_eq!(sent("Westham", "E2", Heading::Right), sent("Eastham", "E2", Heading::Right));
    assert!(sent("Westham", "E2", Heading::Right).is_some());
    assert_eq!(line.borders().between[0].line, "middle");
    assert_eq!(line.borders().counted[0].blocks, atc_line::End::Low);
    assert_eq!(line.detection().expect("blocks").kernel().len(), 2);
    assert!(line.codes().expect("codes").detects_one_wrong_code());
    assert_eq!(line.train().expect("a train").longest.0, 200);
}
