//! Stations of the repository, and rules broken on purpose.

use super::{Checked, check, conclusion, read};
use crate::case::{Asked, Condition, Evidence, Kind, Origin, Outcome, Station};
use crate::judge::verdict::Verdict;
use atc_layout::Description;
use atc_layout::import::Imported;
use atc_layout::lives::TrainLives;
use std::path::{Path, PathBuf};

const LOOP: &str = include_str!("../../../layouts/passing-loop.toml");

fn layouts(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../layouts").join(name)
}

fn checked(text: &str) -> Checked {
    let description = Description::from_toml("s.toml", text).expect("a layout");
    check("s.toml", "00", &Imported { description, ..Imported::default() })
}

fn station(text: &str) -> Station {
    checked(text).case(&[theorem("t_ilk_1", Verdict::Proved)], &[])
}

fn theorem(name: &str, verdict: Verdict) -> Evidence {
    let at = Some("proofs/src/interlocking/pair.rs:1".to_owned());
    Evidence { at, ..Evidence::bare(Kind::Harness, name, verdict) }
}

fn changed(from: &str, to: &str) -> Station {
    assert!(LOOP.contains(from), "{from}");
    station(&LOOP.replacen(from, to, 1))
}

fn verdict(station: &Station, rule: &str) -> Outcome {
    station.checks.iter().find(|one| one.rule == rule).unwrap_or_else(|| panic!("{rule} is not there")).outcome.clone()
}

#[test]
fn the_station_with_30_routes_keeps_every_rule_and_says_against_what() {
    let station = read(&layouts("station-30.toml")).expect("readable").case(&[], &[]);
    assert!(station.is_sound() && station.checks.len() == 69, "{:?}", station.checks);
    let rule = |name: &str| station.checks.iter().find(|one| one.rule == name).expect("a rule");
    assert_eq!(rule("plan-point-both-ways").asked, Asked::Theorems);
    assert_eq!(rule("plan-conflict-one-way").scope, "435 pairs");
    assert_eq!(rule("approach-too-short").scope, "30 routes");
    assert_eq!((station.table.len(), station.columns[0].as_str()), (30, "route"));
    assert!(station.drawing.contains("<svg") && station.table_page.contains("Routes and routes"));
    let value = |name: &str| station.parameters.iter().find(|one| one.name == name).expect("a parameter");
    assert_eq!(value("A circuit counts as clear after").value, "2000 ms (20 cycles)");
    assert!(value("Logic cycle").source.contains("station-30.toml:7:"));
}

#[test]
fn large_stations_are_held_against_every_rule() {
    for (file, pairs, routes) in [("station-100.toml", "4950 pairs", 100), ("central.toml", "5151 pairs", 102)] {
        let station = read(&layouts(file)).expect("readable").case(&[], &[]);
        assert!(station.is_sound() && station.checks.len() == 69, "{file}: {:?}", station.checks);
        let rule = |name: &str| station.checks.iter().find(|one| one.rule == name).expect("a rule");
        assert_eq!(rule("plan-conflict-one-way").scope, pairs);
        assert_eq!((station.table.len(), station.drawing.contains("<svg")), (routes, true));
    }
}

#[test]
fn a_broken_rule_is_named_with_its_place_and_what_follows_it_is_not_called_kept() {
    let broken = changed("[[segment]]", "[times]\nturn_ms = 1000\n\n[[segment]]");
    let found = &broken.broken().next().expect("broken").findings()[0];
    assert_eq!(broken.broken().count(), 1);
    assert!(found.at.starts_with("s.toml:") && found.right == "turn_ms must be more than 1000", "{found:?}");
    assert!(matches!(verdict(&broken, "turn-under-telegram"), Outcome::Broken { .. }));
    assert_eq!(verdict(&broken, "joint"), Outcome::Met);
    assert_eq!(verdict(&broken, "plan-no-time"), Outcome::NotChecked);
    assert_eq!(verdict(&broken, "no-flank"), Outcome::NotChecked);
    assert!(broken.theorems.is_empty() && !broken.drawing.is_empty() && broken.table.is_empty());
    let conclusion = conclusion(&broken);
    assert_eq!(conclusion.verdict, Verdict::Failed);
    assert!(conclusion.sentence.contains("No theorem holds for it"), "{}", conclusion.sentence);
    // A rule of the kernel's plan: everything before it was checked.
    let broken = changed("name = \"W-1\"\n", "name = \"W-1\"\nconflicts = [\"E-2\"]\n");
    assert!(matches!(verdict(&broken, "plan-conflict-one-way"), Outcome::Broken { .. }));
    assert_eq!(verdict(&broken, "no-flank"), Outcome::Met);
    assert!(!broken.table.is_empty() && !broken.is_sound());
    // The tracks: nothing can be drawn, tabulated or said of routes.
    let broken = changed("name = \"W-2\"", "name = \"W-1\"");
    assert!(matches!(verdict(&broken, "name-twice"), Outcome::Broken { .. }));
    assert_eq!(verdict(&broken, "range"), Outcome::NotChecked);
    assert!(broken.drawing.is_empty() && broken.parameters.is_empty());
}

/// The two sets of parameters of the sessions `telegram-lives-wayside` and `telegram-lives-on-board`: the passing loop with its
/// default times, and the on-board device with its own.
#[test]
fn a_layout_that_counts_on_shorter_lives_than_its_trains_have_is_refused() {
    const NOTHING: TrainLives =
        TrainLives { ahead_ms: 0, way_ms: 0, life_ms: 0, code_way_ms: 0, code_ms: 0, reaction_ms: 0 };
    let on_board = atc_protocol::machine::permitted::Config::default();
    let train = |life_ms: u32| TrainLives { ahead_ms: 530, life_ms: u64::from(life_ms + on_board.cycle_ms), ..NOTHING };
    let with =
        |text: &str, train| checked(text).with_trains("L", train).case(&[theorem("t_ilk_1", Verdict::Proved)], &[]);
    assert_eq!((on_board.fresh_ms, on_board.life_ms), (2200, 5000));
    for life_ms in [on_board.fresh_ms, on_board.life_ms] {
        let refused = with(LOOP, train(life_ms));
        let found = &refused.broken().next().expect("broken").findings()[0];
        let acts = 530 + life_ms + on_board.cycle_ms;
        let what =
            format!("the ground counts on telegrams that live for 1000 ms, and trains act on them for {acts} ms");
        assert!(found.what.starts_with(&what), "{found:?}");
        let right = format!("telegram_age_ms must be {acts} or more, or the train's life end within 470 ms");
        assert_eq!(found.right, right);
        assert!(matches!(verdict(&refused, "telegram-lives"), Outcome::Broken { .. }));
        assert_eq!(conclusion(&refused).verdict, Verdict::Failed);
    }
    // Lives that agree, to the millisecond.
    let longest =
        TrainLives { ahead_ms: 430, way_ms: 100, life_ms: 300, code_way_ms: 230, code_ms: 600, reaction_ms: 170 };
    let kept = with(LOOP, longest);
    assert_eq!(verdict(&kept, "telegram-lives"), Outcome::Met);
    assert!(kept.is_sound());
    assert!(!with(LOOP, TrainLives { reaction_ms: 171, ..longest }).is_sound());
    assert!(!with(LOOP, TrainLives { way_ms: 101, ..longest }).is_sound());
    for (code_way_ms, code_ms) in [(230, 601), (231, 600)] {
        let code = with(LOOP, TrainLives { code_way_ms, code_ms, ..longest });
        let found = &code.broken().next().expect("broken").findings()[0];
        let what = format!("act on a code for 1001 ms (way {code_way_ms} ms, displayed for {code_ms} ms");
        assert!(found.what.contains(&what), "{found:?}");
    }
    // The release times of routes, each at its place.
    let release = with(&format!("{LOOP}\n[times]\ntelegram_age_ms = 900000\n"), train(70_000));
    assert_ne!(verdict(&release, "approach-too-short"), Outcome::Met);
    let slow = with(LOOP, train(70_000));
    let findings = &slow.broken().next().expect("broken").findings();
    assert_eq!(findings.len(), 9, "{findings:?}");
    assert!(
        findings[0].what.contains("is released after 60000 ms")
            && findings[0].right.contains("release_ms must be 70540")
    );
    // Without a line nothing is claimed.
    assert!(station(LOOP).checks.iter().all(|one| one.rule != "telegram-lives"));
}

#[test]
fn the_conclusion_is_never_better_than_the_theorems() {
    let loop_ = checked(LOOP);
    let says = |evidence: &[Evidence]| conclusion(&loop_.case(evidence, &[]));
    assert_eq!(says(&[]).verdict, Verdict::NotRun);
    let both = [theorem("t_ilk_1", Verdict::ProvedBounded), theorem("t_ilk_2", Verdict::NotRun)];
    assert_eq!(says(&both).verdict, Verdict::NotRun);
    assert!(says(&both).sentence.contains("harness:t_ilk_2 has not been run"), "{}", says(&both).sentence);
    assert_eq!(says(&both[..1]).verdict, Verdict::ProvedBounded);
    let carries =
        "Beyond them it is not proved. That it carries to the 8 routes of this station is an argument on paper.";
    assert!(says(&both[..1]).sentence.contains(carries), "{}", says(&both[..1]).sentence);
    // Theorems of other parts say nothing of a station.
    let other = Evidence { at: Some("proofs/src/aspect/gap.rs:1".to_owned()), ..theorem("t_acc_1", Verdict::Proved) };
    assert_eq!(says(&[other]).verdict, Verdict::NotRun);
}

#[test]
fn reasons_defaults_and_what_follows_are_to_be_confirmed() {
    let count = |station: &Station, origin| station.confirm.iter().filter(|one| one.origin == origin).count();
    let loop_ = station(LOOP);
    assert!(count(&loop_, Origin::Reason) > 0 && count(&loop_, Origin::Derived) > 0);
    let reason = loop_.confirm.iter().find(|one| one.origin == Origin::Reason).expect("a reason");
    assert!(reason.about.ends_with(" leg") && reason.at.starts_with("s.toml:"), "{reason:?}");
    let fewer = station(&format!("{LOOP}\n[times]\nclear_ms = 3000\n"));
    assert_eq!(count(&fewer, Origin::Default), count(&loop_, Origin::Default) - 1);
    let imported = read(&layouts("station-30.railml.xml")).expect("readable").case(&[], &[]);
    assert!(imported.is_sound() && count(&imported, Origin::Import) > 0);
    assert_eq!(count(&imported, Origin::Default), 0, "the report of the import says it");
    assert!(imported.layout.contains("[[route]]"));
}

#[test]
fn conditions_on_the_ground_come_with_the_figures_of_the_station() {
    let condition = |number: &str, id: &str, hazard: &str| Condition {
        number: number.to_owned(),
        id: id.to_owned(),
        statement: String::new(),
        why: String::new(),
        hazards: vec![hazard.to_owned()],
        addressee: String::new(),
        check: String::new(),
        owner: String::new(),
        used_by: vec![],
    };
    let all = [
        condition("SRAC-1", "detected-throughout", "H-1"),
        condition("SRAC-2", "loss-of-shunt-within-clear", "H-12"),
        condition("SRAC-3", "trains-obey-signals", "H-14"),
    ];
    let found = checked(LOOP).case(&[], &all).conditions;
    assert_eq!(found.iter().map(|one| one.number.as_str()).collect::<Vec<_>>(), ["SRAC-2", "SRAC-3"]);
    assert!(
        found[0].here.contains("No loss may last 2000 ms; to lose no train, none over 1800 ms"),
        "{}",
        found[0].here
    );
    assert_eq!(found[1].here, "");
}

/// A figure for a condition that is not there would never be shown.
#[test]
fn every_figure_belongs_to_a_condition() {
    let listed = include_str!("../../../spec/assumptions.toml");
    let figures = checked(LOOP).figures;
    assert!(figures.len() >= 10);
    for (id, text) in figures {
        assert!(listed.contains(&format!("id = \"{id}\"")) && !text.is_empty(), "{id}");
    }
}

#[test]
fn a_file_that_cannot_be_read_is_no_station() {
    let fault = |name: &str| read(&layouts(name)).expect_err("refused")[0].to_string();
    assert!(fault("nowhere.toml").contains("nowhere.toml: cannot be read"), "{}", fault("nowhere.toml"));
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("bad.toml");
    std::fs::write(&path, LOOP.replacen("entry =", "enter =", 1)).expect("written");
    let text = read(&path).expect_err("refused")[0].to_string();
    assert!(text.contains("bad.toml:") && text.contains("unknown field `enter`") && text.ends_with("[form]"), "{text}");
}
