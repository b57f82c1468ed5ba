//! The conformance kit against implementations with a fault each: what it finds, how short it makes it, and what it says of a side that
//! does not speak.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::time::Duration;

use atc_commands::faulty::{FAULTS, Faulty};
use atc_oracle::conform::coverage::coverage;
use atc_oracle::conform::fields::{Level, TABLES};
use atc_oracle::conform::play::Finding;
use atc_oracle::conform::profile::{Known, Profile};
use atc_oracle::conform::report::{self, Word};
use atc_oracle::conform::run::{Options, Run, Verdict, run};
use atc_oracle::conform::side::Broken;
use atc_oracle::conform::vectors;

fn options(command: String, machine: &str) -> Options {
    Options {
        command,
        machines: vec![machine.to_owned()],
        seed: 1,
        time: Duration::from_mins(10),
        cases: Some(600),
        config: None,
        patience: Duration::from_secs(10),
        shrink: Duration::from_mins(10),
        level: Level::Reason,
        profile: Profile::default(),
        vectors: Vec::new(),
    }
}

fn faulty(name: &str) -> String {
    format!("{} {name}", env!("CARGO_BIN_EXE_faulty"))
}

fn compare(name: &str, machine: &str) -> Run {
    run(options(faulty(name), machine), |_| ())
}

/// Every fault is found, its trace is short, no step of it can be left out, and the requirement that it breaks is among those named.
#[test]
fn every_fault_is_found_and_its_trace_is_short() {
    let (mut table, mut lengths, mut problems) = (String::new(), Vec::new(), Vec::new());
    for fault in FAULTS {
        let run = compare(fault.name, fault.machine);
        let report = report::report(&run);
        let machine = &report.machines[0];
        let Some(first) = &machine.difference else {
            problems.push(format!("{} was not found in {} steps", fault.name, machine.steps));
            continue;
        };
        let field = first.fields.first().map(|field| field.field.clone()).unwrap_or_default();
        let named: Vec<_> = first.fields.iter().flat_map(|field| field.requirements.clone()).collect();
        let _ = writeln!(
            table,
            "{:34} {:18} {:3} steps, {:4} tries, {:4.1} s  {field}",
            fault.name, fault.machine, first.steps, first.tries, machine.seconds
        );
        lengths.push(first.steps);
        if !named.contains(&fault.requirement) {
            problems.push(format!("{}: {} is not among {named:?}", fault.name, fault.requirement));
        }
        if !(first.again && first.minimal) {
            problems.push(format!("{}: seen again {}, minimal {}", fault.name, first.again, first.minimal));
        }
    }
    lengths.sort_unstable();
    let median = lengths[lengths.len() / 2];
    println!(
        "{table}{} of {} faults found; median {median} steps, longest {:?}",
        lengths.len(),
        FAULTS.len(),
        lengths.last()
    );
    assert!(problems.is_empty(), "{problems:#?}");
    assert!(median <= 10, "a median of {median} steps");
}

fn verdict(run: &Run) -> &Finding {
    match &run.machines[0].verdict {
        Verdict::Differs(trace, _) => &trace.found.finding,
        other => panic!("{other:?}"),
    }
}

/// What a side does that does not speak is a verdict, with the trace that leads to it, and never a panic or a wait without end.
#[test]
fn a_side_that_does_not_speak_is_a_verdict() {
    let crash = compare("crash", "speed-supervision");
    assert_eq!(verdict(&crash), &Finding::Broken(Broken::Ended("with exit code 3".to_owned())));
    assert_eq!(crash.said, "out of order");
    assert!(!crash.agrees());
    for (name, word) in [("abort", "by signal 6"), ("leave", "with exit code 0")] {
        match verdict(&compare(name, "speed-supervision")) {
            Finding::Broken(Broken::Ended(how)) => assert!(how.contains(word), "{name}: {how}"),
            other => panic!("{name}: {other:?}"),
        }
    }
    match verdict(&compare("garbage", "speed-supervision")) {
        Finding::Broken(Broken::Garbage(line)) => assert_eq!(line, "Segmentation fault (not)"),
        other => panic!("{other:?}"),
    }
    for name in ["wrong-start", "malformed"] {
        match verdict(&compare(name, "speed-supervision")) {
            Finding::Broken(Broken::WrongReply(_, line)) => {
                assert!(line.contains("protocol") || line.contains("what?"));
            }
            other => panic!("{name}: {other:?}"),
        }
    }
    // A field that is not there is a difference like any other.
    let missing = compare("missing-field", "aspect-acceptance");
    let first = report::report(&missing).machines[0].difference.clone().expect("a difference");
    assert_eq!((first.fields[0].field.as_str(), first.fields[0].got.clone(), first.steps), ("display_km_h", None, 1));
    let gone = run(options("no-such-program-here".to_owned(), "block-count"), |_| ());
    match verdict(&gone) {
        Finding::Broken(Broken::NotStarted(why)) => assert!(why.contains("no-such-program-here"), "{why}"),
        other => panic!("{other:?}"),
    }
    // An output that is closed, by a process that goes on.
    let closed = run(options("exec 1>&-; sleep 20".to_owned(), "block-count"), |_| ());
    assert_eq!(verdict(&closed), &Finding::Broken(Broken::Closed));
}

#[test]
fn a_side_that_hangs_is_a_verdict_in_time() {
    for name in ["hang", "silent"] {
        let asked = Options {
            patience: Duration::from_millis(400),
            shrink: Duration::from_secs(6),
            ..options(faulty(name), "speed-supervision")
        };
        let begun = std::time::Instant::now();
        let run = run(asked, |_| ());
        assert!(matches!(verdict(&run), Finding::Broken(Broken::Hung(_))), "{name}");
        assert!(begun.elapsed() < Duration::from_mins(1), "{name} took {:?}", begun.elapsed());
    }
}

/// A difference that needs the case before it keeps that case, and one that shows once in a while is told as it was.
#[test]
fn what_hangs_on_the_past_or_on_chance_is_told_so() {
    let keeps = compare("keeps-state", "speed-supervision");
    match &keeps.machines[0].verdict {
        Verdict::Differs(trace, _) => {
            assert!(trace.again && trace.minimal);
            assert_eq!(trace.cases.len(), 2, "{:#?}", trace.lines());
            assert!(trace.steps() <= 3, "{:#?}", trace.lines());
        }
        other => panic!("{other:?}"),
    }
    let flaky = compare("flaky", "speed-supervision");
    match &flaky.machines[0].verdict {
        Verdict::Differs(trace, _) => assert!(!trace.again, "{:#?}", trace.lines()),
        other => panic!("{other:?}"),
    }
    let text = report::text(&report::report(&flaky));
    assert!(text.contains("it did not show a second time"), "{text}");
}

/// The kernel against itself agrees, on walks and on the minimal vectors; the same seed gives the same cases.
#[test]
fn the_kernel_agrees_with_itself() {
    let asked = Options { machines: Vec::new(), cases: Some(24), level: Level::State, ..options(faulty("none"), "") };
    let first = run(asked.clone(), |_| ());
    assert!(first.agrees(), "{}", report::text(&report::report(&first)));
    assert!(first.machines.iter().all(|machine| matches!(machine.verdict, Verdict::Agrees) && machine.steps > 0));
    let counts = |run: &Run| run.machines.iter().map(|machine| (machine.cases, machine.steps)).collect::<Vec<_>>();
    assert_eq!(counts(&first), counts(&run(asked.clone(), |_| ())));
    assert_ne!(counts(&first), counts(&run(Options { seed: 2, ..asked }, |_| ())));
}

/// A known difference is counted and passes; one that does not show fails the run.
#[test]
fn a_known_difference_passes_until_it_is_gone() {
    let known = Known { machine: "block-count".to_owned(), field: "fault".to_owned(), reason: "own words".to_owned() };
    let profile = Profile { known: vec![known], ..Profile::default() };
    let asked =
        |name: &str| Options { profile: profile.clone(), cases: Some(150), ..options(faulty(name), "block-count") };
    let known = run(asked("fault-words"), |_| ());
    assert!(known.agrees(), "{}", report::text(&report::report(&known)));
    assert_eq!(report::report(&known).machines[0].known, ["fault: own words"]);
    let gone = run(asked("none"), |_| ());
    assert!(!gone.agrees());
    assert_eq!(report::report(&gone).machines[0].verdict, Word::KnownDifferenceGone);
    // At the level of outputs the words do not count, and another fault still shows.
    let words = run(Options { level: Level::Output, ..options(faulty("fault-words"), "block-count") }, |_| ());
    assert!(words.agrees());
    assert!(!run(asked("edges-cancel"), |_| ()).agrees());
}

/// Every requirement that a field names stands in the specification.
#[test]
fn the_requirements_of_the_fields_are_in_the_specification() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../spec");
    let mut headings = String::new();
    for entry in std::fs::read_dir(folder).expect("the specification") {
        let path = entry.expect("an entry").path();
        let is_theorems = path.file_name().is_some_and(|name| name == "theorems.md");
        if path.extension().is_some_and(|extension| extension == "md") && !is_theorems {
            headings.push_str(&std::fs::read_to_string(path).expect("a page"));
        }
    }
    for table in TABLES {
        let of_fields = table.fields.iter().flat_map(|field| {
            let inner: &[_] = match &field.shape {
                atc_oracle::conform::fields::Shape::Entries(fields) => fields,
                _ => &[],
            };
            field.requirements.iter().chain(inner.iter().flat_map(|field| field.requirements))
        });
        for id in table.start.iter().chain(table.cycles).chain(of_fields) {
            assert!(headings.contains(&format!("\n## {id} ")), "{}: there is no requirement {id}", table.machine);
        }
        assert!(table.fields.iter().all(|field| !field.requirements.is_empty()), "{}", table.machine);
    }
}

/// Each limit of these machines, a cycle or one less and more, is decided by a vector of the minimal set.
#[test]
fn the_minimal_vectors_decide_every_limit() {
    for (machine, limits, transitions) in
        [("aspect-acceptance", 10, 4), ("block-count", 6, 25), ("permitted-speed", 12, 25)]
    {
        let all = vectors::vectors(machine, vectors::Set::Minimal);
        let covered = coverage(machine, &all);
        assert_eq!((covered.limits.len(), covered.open()), (limits, Vec::new()), "{machine}");
        assert!(covered.count() >= transitions, "{machine}: {} transitions", covered.count());
        // A set of one vector decides less.
        assert!(!coverage(machine, &all[..1]).open().is_empty(), "{machine}");
    }
}

/// Without a table a machine's differences would name no requirement, and its vectors would be refused.
#[test]
fn every_machine_has_a_table_of_its_fields() {
    let mut tables: Vec<&str> = TABLES.iter().map(|table| table.machine).collect();
    let mut machines: Vec<&str> = atc_protocol::machine::KINDS.iter().map(|kind| kind.name).collect();
    tables.sort_unstable();
    machines.sort_unstable();
    assert_eq!(tables, machines);
}

/// The page of a report is whole by itself, and the JSON is of its schema.
#[test]
fn the_reports_of_a_difference() {
    let run = compare("heading-turned", "interlocking");
    let report = report::report(&run);
    let schema: serde_json::Value = serde_json::from_str(&report::schema()).expect("a schema");
    let json = serde_json::to_value(&report).expect("JSON");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    assert!(validator.is_valid(&json), "{json:#}");
    let page = report::page(&run, &report, &[]);
    assert_eq!(page.matches("<svg").count(), 3, "a badge and two charts");
    for fragment in
        ["dangerous", "ATC-10", "The other side; what differs is red.", "record says", "THE RECORD DIFFERS", "heading"]
    {
        assert!(page.contains(fragment), "no {fragment}");
    }
    for reference in ["<script", "src=", "href=\"http", "url("] {
        assert!(!page.contains(reference), "the page loads something: {reference}");
    }
    let junit = report::junit(&report).expect("JUnit");
    assert!(junit.contains("<failure") && junit.contains("interlocking"), "{junit}");
    assert!(report::badge(&report).contains("differs"));
}

/// Vectors: more than a thousand in the minimal set, ids that are the content's, and a fault shows in them.
#[test]
fn the_minimal_vectors_find_faults() {
    let files = vectors::files(&["aspect-acceptance", "block-count"], vectors::Set::Minimal);
    let named: BTreeMap<_, _> = files.iter().cloned().collect();
    let file = |name: &str| named.get(name).cloned().ok_or_else(|| "it is not there".to_owned());
    let read = vectors::read(file).expect("vectors");
    assert!(read.len() > 300, "{} vectors", read.len());
    let schema: serde_json::Value = serde_json::from_str(&named["vector.schema.json"]).expect("a schema");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    for vector in &read {
        assert!(validator.is_valid(&serde_json::to_value(vector).expect("JSON")), "{vector:?}");
    }
    // Changed by hand: refused.
    let changed = |name: &str| {
        file(name).map(|text| if name.ends_with("count.jsonl") { text.replacen("true", "false", 1) } else { text })
    };
    assert!(vectors::read(changed).expect_err("a changed file").contains("SHA-256"));
    let on_vectors = |name: &str, machine: &str| {
        let mut asked = Options { vectors: read.clone(), cases: None, ..options(faulty(name), machine) };
        asked.vectors.retain(|vector| vector.machine == machine);
        run(asked, |_| ())
    };
    assert!(on_vectors("none", "block-count").agrees());
    assert!(!on_vectors("edges-cancel", "block-count").agrees());
    assert!(!on_vectors("interruption-strict", "aspect-acceptance").agrees());
}

/// A step of a walk is always one that the kernel takes, and walks reach what they are for.
#[test]
fn walks_are_taken_and_reach_the_limits() {
    use atc_oracle::conform::walk::{SOURCES, Sizes, case};
    for source in SOURCES {
        let mut words = std::collections::BTreeSet::new();
        for number in 0..80 {
            let expected = case(source.machine, 3, number, Sizes::Small, None).expect("a case");
            assert!(!expected.start.starts_with(r#"{"malformed""#), "{}: {}", source.machine, expected.start);
            assert_eq!(expected.left_out, 0, "{}, walk {number}", source.machine);
            let again = expected.case.clone().expected().expect("a case that the kernel takes");
            assert_eq!(again.outputs, expected.outputs);
            let text = expected.outputs.concat();
            for word in [
                "check-in-stays-on",
                "check-out-at-zero",
                "check-in-at-maximum",
                "emergency",
                "service",
                "release",
                "\"error\"",
                "\"telegrams\":[{",
                "running-down",
                "pattern",
                "both",
                "set",
                "in-use",
                "releasing",
                "failed",
                "provisional",
                "refused",
                "accepted",
            ] {
                if text.contains(word) {
                    words.insert(word);
                }
            }
        }
        let due: &[&str] = match source.machine {
            "block-count" => &["check-in-stays-on", "check-out-at-zero", "check-in-at-maximum"],
            "speed-supervision" => &["emergency", "service", "release"],
            "telegram-codec" => &["\"error\"", "\"telegrams\":[{"],
            "permitted-speed" => &["running-down", "pattern", "both"],
            "interlocking" => &["set", "in-use", "releasing", "failed", "provisional", "refused", "accepted"],
            _ => &[],
        };
        for word in due {
            assert!(words.contains(word), "{}: no walk reaches {word}", source.machine);
        }
    }
}

/// On the layout of somebody's own station, of either size, trains run and routes are used. A walk without them would agree with anything.
#[test]
fn walks_on_a_station_of_ones_own_are_lively() {
    use atc_oracle::conform::walk::{Sizes, case};
    for (name, most, due) in [
        ("coupling", 60, ["accepted", "in-use", r#""permits":["#, r#"c":"in-use""#].as_slice()),
        ("central", 3, ["accepted", "in-use", r#""permits":["#].as_slice()),
    ] {
        let path = format!("{}/../../layouts/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("a layout");
        let config: serde_json::Value = toml::from_str(&text).expect("TOML");
        let mut missing = due.to_vec();
        for number in 0..most {
            let expected = case("interlocking", 1, number, Sizes::Mixed, Some(&config)).expect("a case");
            assert_eq!(expected.left_out, 0, "{name}, walk {number}");
            let text = expected.outputs.concat();
            missing.retain(|word| !text.contains(word));
            if missing.is_empty() {
                break;
            }
        }
        assert!(missing.is_empty(), "{name}: no walk reaches {missing:?}");
    }
}

/// On the ground's device of somebody's own line, too, with and without a counted line.
#[test]
fn walks_on_a_device_of_ones_own_are_lively() {
    use atc_oracle::conform::walk::{Sizes, case};
    let line = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../line/examples/line.toml"));
    let line = atc_line::read(line).expect("a line");
    let devices = atc_protocol::devices::Devices::of(&line).all;
    let western = devices.iter().find(|device| device.name() == "wayside-1-Westham").expect("a device");
    let plain = western.config.clone().expect("a configuration");
    let mut counted = plain.clone();
    counted["counted"] = serde_json::json!({
        "segment": "West", "travel": "toward", "direction": "up", "train_m": 200, "blocks": [
            {"circuits": ["W2"], "max_trains": 1, "tail_hold_sections": 1, "pass_ms": 20000},
            {"circuits": ["W1"], "max_trains": 1, "tail_hold_sections": 1, "pass_ms": 20000},
        ],
    });
    // A counted line has one direction of travel.
    let routes = counted["layout"]["route"].as_array_mut().expect("routes");
    routes.retain(|route| !route["name"].as_str().is_some_and(|name| name.ends_with("-W")));
    let used = ["accepted", "in-use", r#""permission":"granted""#, r#""beyond_exit_m":3"#];
    for (config, due) in [(plain, used.to_vec()), (counted, [&used[..], &[r#""agree":true,"count":1"#]].concat())] {
        let mut missing = due;
        for number in 0..80 {
            let expected = case("wayside", 1, number, Sizes::Mixed, Some(&config)).expect("a case");
            assert!(!expected.is_rejected() && expected.left_out == 0, "{}, walk {number}", expected.start);
            let text = expected.outputs.concat();
            missing.retain(|word| !text.contains(word));
            if missing.is_empty() {
                break;
            }
        }
        assert!(missing.is_empty(), "no walk reaches {missing:?}");
    }
}

/// The page for newcomers: its implementation differs, and agrees once the fault is mended. Without a Python here it is not run.
#[test]
fn the_example_in_python() {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracle/examples/conform/aspect_acceptance.py");
    if std::process::Command::new("python3").arg("--version").output().is_err() {
        eprintln!("not run: no python3 here");
        return;
    }
    let faulty = run(Options { cases: Some(200), ..options(format!("python3 {source}"), "aspect-acceptance") }, |_| ());
    let first = report::report(&faulty).machines[0].difference.clone().expect("a difference");
    assert!(first.steps <= 8 && first.requirements[0] == "ACC-8", "{first:?}");
    assert!(first.as_if.contains(&"interruption_ms one cycle shorter (ACC-8)".to_owned()), "{first:?}");
    let text = std::fs::read_to_string(source).expect("the example");
    assert_eq!(text.matches("silence < self.t4").count(), 1);
    let folder = tempfile::tempdir().expect("a folder");
    let mended = folder.path().join("mended.py");
    std::fs::write(&mended, text.replace("silence < self.t4", "silence <= self.t4")).expect("a file");
    let command = format!("python3 {}", mended.display());
    let mended = run(Options { cases: Some(200), ..options(command, "aspect-acceptance") }, |_| ());
    assert!(mended.agrees(), "{}", report::text(&report::report(&mended)));
}

/// In this process: the double without a fault is the kernel.
#[test]
fn the_double_without_a_fault_is_the_kernel() {
    let mut double = Faulty::new(None);
    let reply = double.answer(r#"{"start":{"protocol":1,"machine":"speed-supervision","config":{}}}"#);
    assert!(reply.starts_with(r#"{"started""#));
    assert_eq!(double.answer(r#"{"step":{"speed_km_h":1,"permitted_km_h":0}}"#), r#"{"output":{"brake":"service"}}"#);
}

/// Whether a vector catches a fault: some reply differs from what the vector holds.
fn catches(vector: &vectors::Vector, double: &mut Faulty) -> bool {
    let expected = vector.expected();
    let body = |line: &str| serde_json::from_str::<serde_json::Value>(line).unwrap_or_default();
    let start = double.answer(&expected.case.start_line());
    if start.starts_with(r#"{"rejected""#) || vector.rejected {
        return start.starts_with(r#"{"rejected""#) != vector.rejected;
    }
    let differs = vector.steps.iter().zip(&vector.outputs).any(|(step, output)| {
        let reply = body(&double.answer(&serde_json::json!({"step": step}).to_string()));
        !atc_oracle::conform::fields::compare(&vector.machine, Level::Reason, output, &reply["output"]).is_empty()
    });
    double.answer(r#"{"stop":{}}"#);
    differs
}

/// The minimal set alone catches every fault of this file's doubles.
#[test]
fn every_fault_is_found_by_the_vectors() {
    let (mut table, mut missed) = (String::new(), Vec::new());
    let mut made: BTreeMap<&str, Vec<vectors::Vector>> = BTreeMap::new();
    for fault in FAULTS {
        let vectors =
            made.entry(fault.machine).or_insert_with(|| vectors::vectors(fault.machine, vectors::Set::Minimal));
        let mut double = Faulty::new(Some(fault));
        let place = vectors.iter().position(|vector| catches(vector, &mut double));
        match place {
            Some(place) => drop(writeln!(table, "{:34} {:18} vector {place}", fault.name, fault.machine)),
            None => missed.push(fault.name),
        }
    }
    let count: usize = made.values().map(Vec::len).sum();
    println!("{table}{} of {} faults caught by {count} vectors", FAULTS.len() - missed.len(), FAULTS.len());
    assert!(count > 1000, "{count} vectors");
    assert!(missed.is_empty(), "{missed:?}");
}

/// Where both sides agree on a configuration of one's own, the report says what that rests on.
#[test]
fn what_no_walk_decides_is_told() {
    let config =
        serde_json::json!({"sections": 2, "max_trains": 1, "tail_hold_sections": 1, "cycle_ms": 10, "pass_ms": 200});
    let command = format!("'{}' serve", atc_tests::device::oracle().display());
    let with = |cases| {
        let options =
            Options { cases: Some(cases), config: Some(config.clone()), ..options(command.clone(), "block-count") };
        let report = report::report(&run(options, |_| ()));
        assert!(report.agrees);
        report.machines[0].undecided.clone()
    };
    let (few, many) = (with(1), with(60));
    assert!(few.iter().any(|limit| limit.starts_with("pass_ms one cycle longer (BLK-3)")), "{few:?}");
    assert!(many.len() < few.len() && !many.iter().any(|limit| limit.starts_with("pass_ms")), "{many:?}");
}
