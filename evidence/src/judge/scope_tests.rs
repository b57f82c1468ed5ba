//! Every item in exactly one shard, balanced and stable; every item in some part.

use super::{Chosen, Scope, Shard, Tests, assign, parts, shards};
use crate::judge::plan::{Plan, plan};
use crate::sources::mutants;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::OnceLock;

fn here() -> &'static Plan {
    static PLAN: OnceLock<Plan> = OnceLock::new();
    PLAN.get_or_init(|| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("in the checkout");
        let line = crate::sources::line::example().expect("a line");
        plan(root, (line, None), mutants::catalogue(root).expect("mutants")).expect("a plan")
    })
}

#[test]
fn a_shard_is_read_and_a_wrong_one_refused() {
    assert_eq!("2/4".parse(), Ok(Shard { number: 2, of: 4 }));
    for wrong in ["", "2", "0/4", "5/4", "2/0", "a/b", "1/99999", "-1/4", "1/2/3"] {
        assert!(wrong.parse::<Shard>().expect_err(wrong).contains("such as 2/4"));
    }
}

#[test]
fn every_item_is_in_exactly_one_shard() {
    let all: BTreeSet<_> = here().ids().into_iter().collect();
    for of in (1..=17).chain([64, 500, 5_000]) {
        let mut seen = BTreeSet::new();
        let mut tests = 0;
        for number in 1..=of.min(20) {
            let chosen = Chosen::of(here(), &Scope::Shard(Shard { number, of })).expect("chosen");
            assert!(chosen.ids.iter().all(|id| seen.insert(id.clone())), "twice, of {of}");
            tests += usize::from(matches!(chosen.tests, Tests::Named(_)));
        }
        let numbers = shards(here(), of);
        assert_eq!(numbers.keys().cloned().collect::<BTreeSet<_>>(), all, "of {of}");
        assert!(numbers.values().all(|number| (1..=of).contains(number)));
        assert!(of > 20 || seen == all, "of {of}");
        assert_eq!((tests, &numbers), (1, &shards(here(), of)), "stable");
    }
}

#[test]
fn no_shard_has_more_than_one_item_above_another() {
    // Whatever the costs: the shard that has most had least before its last item.
    let mut number = 1_u64;
    for of in 1..12 {
        let items: Vec<_> = (0..200)
            .map(|place| {
                number = number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (format!("item{place}"), f64::from(u32::try_from(number >> 40).unwrap_or(0) % 1000))
            })
            .collect();
        let numbers = assign(&items, vec![0.0; of]);
        let mut loads = vec![0.0; of];
        for (name, cost) in &items {
            loads[numbers[name] - 1] += cost;
        }
        let longest = items.iter().map(|(_, cost)| *cost).fold(0.0, f64::max);
        let (most, least) = (loads.iter().copied().fold(0.0, f64::max), loads.iter().copied().fold(f64::MAX, f64::min));
        assert!(most - least <= longest, "{of}: {loads:?}");
        let mut other_way = items.clone();
        other_way.reverse();
        assert_eq!(assign(&other_way, vec![0.0; of]), numbers, "the order does not count");
    }
}

#[test]
fn mutants_stay_with_those_of_their_harness() {
    let numbers = shards(here(), 7);
    let mut of_harness: BTreeMap<&str, usize> = BTreeMap::new();
    for mutant in &here().mutants {
        let number = numbers[&format!("mutant:{}", mutant.name)];
        let first = mutant.killers.first().expect("one");
        assert_eq!(*of_harness.entry(first).or_insert(number), number, "{}", mutant.name);
    }
}

#[test]
fn the_parts_have_everything_and_what_they_need() {
    let known = parts(here());
    let names: BTreeSet<_> =
        ["aspect", "block", "code", "duplex", "interlocking", "pattern", "permitted", "position"].into();
    let more: BTreeSet<_> = ["supervision", "telegram", "time", "train", "wayside"].into();
    assert_eq!(known, names.union(&more).map(ToString::to_string).collect());
    let mut seen = BTreeSet::new();
    for part in &known {
        let chosen = Chosen::of(here(), &Scope::Part(part.clone())).expect("chosen");
        assert!(chosen.ids.iter().any(|id| id.starts_with("harness:")), "{part}");
        assert!(chosen.ids.iter().any(|id| id.starts_with("mutant:")), "{part}");
        for mutant in here().mutants.iter().filter(|one| chosen.has(&format!("mutant:{}", one.name))) {
            assert!(mutant.killers.iter().all(|killer| chosen.has(&format!("harness:{killer}"))), "{}", mutant.name);
        }
        let Tests::Some(targets) = &chosen.tests else { panic!("{part}: some tests") };
        for (package, target) in targets {
            let folder = match package.trim_start_matches("atc-") {
                "adversary" => "tests/adversary",
                "commands" => "tests/commands",
                folder => folder,
            };
            let folder = Path::new("..").join(folder).join("tests");
            assert!(
                folder.join(format!("{target}.rs")).exists() || folder.join(target).join("main.rs").exists(),
                "{target}"
            );
        }
        seen.extend(chosen.ids);
    }
    let missing: Vec<_> = here().ids().into_iter().filter(|id| !seen.contains(id)).collect();
    assert_eq!(missing, Vec::<String>::new());
    let fault = Chosen::of(here(), &Scope::Part("aspects".to_owned())).expect_err("no such part");
    assert!(fault.to_string().contains("--part aspects") && fault.text.contains("supervision"), "{fault}");
}

/// The programs whose tests are of tools that the case does not rest on: `ci/test` runs them. A new program is named in the
/// argument, or here.
const OF_TOOLS: [&str; 19] = [
    "c_abi",
    "command",
    "conform",
    "dialects",
    "drawing",
    "explore",
    "files",
    "fmi",
    "for_kani",
    "foreign",
    "importers",
    "imports",
    "killed",
    "planpro",
    "protocol",
    "second",
    "shards",
    "signal_wav",
    "wire",
];

#[test]
fn every_test_program_is_named_or_of_a_tool() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("in the checkout");
    let folders =
        ["arithmetic", "c-abi", "evidence", "layout", "line", "models", "proofs/runner", "simulation", "tests"];
    let more = [
        "film",
        "film/kernel",
        "fmi",
        "kernel",
        "oracle",
        "proofs",
        "protocol",
        "tests/adversary",
        "tests/commands",
        "waveform",
    ];
    let programs =
        folders.iter().chain(&more).filter_map(|folder| std::fs::read_dir(root.join(folder).join("tests")).ok());
    let paths = programs.flatten().map(|entry| entry.expect("readable").path());
    let is_program =
        |path: &std::path::PathBuf| path.extension().is_some_and(|it| it == "rs") || path.join("main.rs").is_file();
    let names = paths.filter(is_program).map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned());
    let named = here().test_programs();
    let others: BTreeSet<_> = names.filter(|name| !named.contains(name)).collect();
    assert_eq!(others, OF_TOOLS.map(ToOwned::to_owned).into());
}
