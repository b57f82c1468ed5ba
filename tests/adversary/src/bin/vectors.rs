//! Looks which mutants of the kernel the test vectors catch, and searches for a short trace for each that they do not.
//!
//! `vectors --directed yes`: whether each directed vector catches the mutants that it names. `vectors --mutants FILE [--set thorough]
//! [--seconds N] [--seed N]`: of each mutant, a name and a folder in a line of the file, whether a vector catches it; if none does, it searches
//! for so long on each machine that may show it. `vectors --caught FILE`: whether each mutant of the file is caught by the one vector that
//! stands beside it: lines of mutant, machine and note, as the run before prints them.
//!
//! In the checkout there are no mutants: it is compiled from the copy of the sources that has them (`atc-prover old-rules --program vectors`).

use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use atc_oracle::conform::case::{Case, Expected};
use atc_oracle::conform::fields::Level;
use atc_oracle::conform::play::{Agreed, Judge, Opened, play};
use atc_oracle::conform::profile::Profile;
use atc_oracle::conform::random::Random;
use atc_oracle::conform::shrink::shrink;
use atc_oracle::conform::side::{Answers, Broken};
use atc_oracle::conform::vectors::{Set, noted, vectors};
use atc_oracle::conform::walk::{self, Sizes};
use atc_protocol::Session;
use serde_json::{Value, json};

/// Selects that mutant of the kernel alone; none by an empty name. False: there is no such mutant.
fn choose(_name: &str) -> bool {
    false
}

/// The kernel with a mutant, in this process.
struct Wrong<'a> {
    mutant: &'a str,
    session: Option<Session>,
}

impl<'a> Wrong<'a> {
    const fn new(mutant: &'a str) -> Self {
        Self { mutant, session: None }
    }
}

impl Answers for Wrong<'_> {
    fn ask(&mut self, line: &str) -> Result<String, Broken> {
        let mut session = self.session.take().unwrap_or_default();
        let mut reply = Vec::new();
        choose(self.mutant);
        let answered = catch_unwind(AssertUnwindSafe(|| {
            session.answer(line.as_bytes(), &mut reply);
        }));
        choose("");
        answered.map_err(|_| Broken::Ended("by a panic".to_owned()))?;
        self.session = Some(session);
        Ok(String::from_utf8_lossy(&reply).trim_end().to_owned())
    }

    fn end(&mut self) {
        self.session = None;
    }
}

/// A case as lines, each with the kernel's reply.
struct Lines {
    machine: String,
    start: (String, String),
    steps: Vec<(String, String)>,
}

impl Lines {
    fn of(expected: &Expected) -> Self {
        let steps = expected.case.steps.iter().map(|step| json!({"step": step}).to_string());
        Self {
            machine: expected.case.machine.clone(),
            start: (expected.case.start_line(), expected.start.clone()),
            steps: steps.zip(expected.outputs.clone()).collect(),
        }
    }

    /// Whether the mutant answers otherwise.
    fn catch(&self, mutant: &str, judge: Judge) -> bool {
        let mut wrong = Wrong::new(mutant);
        let mut agreed = Agreed::default();
        let Ok(reply) = wrong.ask(&self.start.0) else { return true };
        match judge.start(&self.machine, &self.start.1, &reply, &mut agreed) {
            Ok(Opened::Both) => {}
            Ok(_) => return false,
            Err(_) => return true,
        }
        self.steps.iter().any(|(step, output)| {
            let reply = wrong.ask(step);
            reply.map_or(true, |reply| judge.output(&self.machine, output, &reply, &mut agreed).is_err())
        })
    }
}

/// The machines that may show a mutant, by the folder of its file, the likeliest first.
fn machines(folder: &str) -> &'static [&'static str] {
    match folder {
        "aspect" => &["aspect-acceptance", "train"],
        "block" => &["block-count", "wayside"],
        "supervision" => &["speed-supervision", "train"],
        "telegram" => &["telegram-codec", "permitted-speed", "train"],
        "pattern" | "arithmetic" => &["braking-pattern", "permitted-speed", "train"],
        "position" => &["train-position", "train"],
        "permitted" | "distance" => &["permitted-speed", "train"],
        "interlocking" => &["interlocking", "wayside"],
        "wayside" => &["wayside"],
        "train" | "duplex" => &["train"],
        "code" => &["train", "wayside"],
        _ => &[
            "aspect-acceptance",
            "block-count",
            "interlocking",
            "wayside",
            "telegram-codec",
            "permitted-speed",
            "train-position",
            "speed-supervision",
            "train",
        ],
    }
}

struct Options {
    mutants: Vec<(String, String)>,
    set: Set,
    seed: u64,
    seconds: u64,
    directed: bool,
    caught: Option<String>,
}

fn options() -> Result<Options, String> {
    let mut options =
        Options { mutants: Vec::new(), set: Set::Minimal, seed: 1, seconds: 0, directed: false, caught: None };
    let mut words = std::env::args().skip(1);
    while let Some(option) = words.next() {
        let value = words.next().ok_or_else(|| format!("{option} needs a value"))?;
        let number = || value.parse::<u64>().map_err(|_| format!("{option}: {value} is no number"));
        match option.as_str() {
            "--mutants" => {
                let text = std::fs::read_to_string(&value).map_err(|error| format!("{value}: {error}"))?;
                let pairs = text.lines().filter_map(|line| line.split_once('\t'));
                options.mutants = pairs.map(|(name, folder)| (name.to_owned(), folder.to_owned())).collect();
            }
            "--set" => options.set = if value == "thorough" { Set::Thorough } else { Set::Minimal },
            "--caught" => options.caught = Some(value),
            "--directed" => options.directed = value == "yes",
            "--seed" => options.seed = number()?,
            "--seconds" => options.seconds = number()?,
            _ => return Err(format!("there is no option {option}")),
        }
    }
    Ok(options)
}

/// Holds each directed vector against the mutants that it names: how many pairs there are, and which do not differ.
fn directed() -> bool {
    let profile = Profile::default();
    let judge = Judge { level: Level::Output, profile: &profile };
    let (mut pairs, mut missed) = (0, 0);
    for directed in atc_oracle::conform::directed::all() {
        let Ok(expected) = directed.case().expected() else { return false };
        let lines = Lines::of(&expected);
        let agrees = !lines.catch("", judge);
        for mutant in &directed.catches {
            pairs += 1;
            let catches = choose(mutant) && agrees && lines.catch(mutant, judge);
            choose("");
            if !catches {
                missed += 1;
                println!("{mutant}: not caught by its directed vector of {}", directed.machine);
            }
        }
    }
    println!("{} of {pairs} mutants are caught by the directed vectors that name them", pairs - missed);
    missed == 0
}

/// Holds each mutant of the file against the vector that stands beside it: how many there are, and which do not differ.
///
/// # Errors
/// A file that cannot be read, or a line that is not of its form.
fn caught(path: &str) -> Result<bool, String> {
    let profile = Profile::default();
    let judge = Judge { level: Level::Output, profile: &profile };
    let text = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    let (mut all, mut missed) = (0, 0);
    let mut kept: BTreeMap<(&str, &str), Vec<Lines>> = BTreeMap::new();
    for (number, line) in (1..).zip(text.lines()) {
        let [mutant, machine, note] = line.split('\t').collect::<Vec<_>>()[..] else {
            return Err(format!(
                "{path}: line {number} is not a mutant, a machine and a note, with tabulators between"
            ));
        };
        let lines = kept.entry((machine, note)).or_insert_with(|| {
            let lines = noted(machine, note).into_iter().map(|vector| Lines::of(&vector.expected()));
            // What the kernel itself does not answer so catches nothing.
            lines.filter(|lines| !lines.catch("", judge)).collect()
        });
        all += 1;
        let catches = choose(mutant) && lines.iter().any(|lines| lines.catch(mutant, judge));
        choose("");
        if !catches {
            missed += 1;
            println!("{mutant}: not caught by the vector of {machine} {note:?}");
        }
    }
    println!("{} of {all} mutants are caught by the vectors beside them", all - missed);
    Ok(missed == 0)
}

fn run(options: &Options) {
    let profile = Profile::default();
    let judge = Judge { level: Level::Output, profile: &profile };
    let named: BTreeSet<&str> = options.mutants.iter().flat_map(|(_, folder)| machines(folder)).copied().collect();
    let mut lines: Vec<(&str, Vec<(String, Lines)>)> = Vec::new();
    for machine in named {
        let all = vectors(machine, options.set);
        lines.push((machine, all.iter().map(|vector| (vector.note.clone(), Lines::of(&vector.expected()))).collect()));
        eprintln!("{machine}: {} vectors", all.len());
    }
    let seeds: BTreeMap<&str, Seeds> = if options.seconds > 0 {
        lines.iter().map(|(machine, _)| (*machine, Seeds::of(machine, options.set))).collect()
    } else {
        BTreeMap::new()
    };
    for (mutant, folder) in &options.mutants {
        if !choose(mutant) {
            println!("{mutant}\tnot-there");
            continue;
        }
        choose("");
        let started = Instant::now();
        let caught = machines(folder).iter().find_map(|machine| {
            let (_, all) = lines.iter().find(|(name, _)| name == machine)?;
            all.iter().find(|(_, case)| case.catch(mutant, judge)).map(|(note, _)| (machine, note))
        });
        if let Some((machine, note)) = caught {
            println!("{mutant}\tcaught\t{machine}\t{note}");
            continue;
        }
        println!("{mutant}\tsurvives\t{folder}\t{:.1}", started.elapsed().as_secs_f64());
        search(mutant, folder, options, judge, &seeds);
    }
}

/// Cases that are there, and what stands in them: what other cases are made of.
struct Seeds {
    cases: Vec<Case>,
    /// What stands below a name, anywhere.
    below: BTreeMap<String, Vec<Value>>,
}

impl Seeds {
    fn of(machine: &str, set: Set) -> Self {
        let cases: Vec<Case> = vectors(machine, set).into_iter().map(|vector| vector.expected().case).collect();
        let mut seeds = Self { cases: Vec::new(), below: BTreeMap::new() };
        for case in &cases {
            seeds.keep("config", &case.config);
            case.steps.iter().for_each(|step| seeds.keep("step", step));
        }
        seeds.cases = cases;
        seeds
    }

    fn keep(&mut self, name: &str, value: &Value) {
        let kept = self.below.entry(name.to_owned()).or_default();
        if kept.len() < 60 && !kept.contains(value) {
            kept.push(value.clone());
        }
        match value {
            Value::Array(items) => items.iter().for_each(|item| self.keep(&format!("{name}/"), item)),
            Value::Object(entries) => entries.iter().for_each(|(name, entry)| self.keep(name, entry)),
            _ => {}
        }
    }

    /// One of the cases, changed in some places.
    fn changed(&self, random: &mut Random) -> Option<Case> {
        let mut case = random.pick(&self.cases)?.clone();
        let other = random.pick(&self.cases)?;
        for _ in 0..=random.below(3) {
            let length = case.steps.len();
            match random.below(8) {
                0 | 1 => self.change("config", &mut case.config, random),
                2 if length > 0 => {
                    let step = case.steps[random.below(length)].clone();
                    let times = [1, 2, 3, 5, 12][random.below(5)];
                    let at = random.below(length);
                    case.steps.splice(at..at, std::iter::repeat_n(step, times));
                }
                3 if length > 1 => {
                    let at = random.below(length);
                    case.steps.drain(at..(at + 1 + random.below(3)).min(length));
                }
                4 if !other.steps.is_empty() => {
                    let from = random.below(other.steps.len());
                    let at = random.below(length + 1);
                    case.steps.splice(at..at, other.steps[from..].iter().take(6).cloned());
                }
                _ if length > 0 => {
                    let at = random.below(length);
                    self.change("step", &mut case.steps[at], random);
                }
                _ => self.change("config", &mut case.config, random),
            }
        }
        Some(case)
    }

    /// Changes one place in the value.
    fn change(&self, name: &str, value: &mut Value, random: &mut Random) {
        let deeper = match value {
            Value::Array(items) => !items.is_empty(),
            Value::Object(entries) => !entries.is_empty(),
            _ => false,
        };
        if deeper && !random.one_in(6) {
            match value {
                Value::Array(items) => {
                    let at = random.below(items.len());
                    self.change(&format!("{name}/"), &mut items[at], random);
                }
                Value::Object(entries) => {
                    let at = random.below(entries.len());
                    if let Some((name, entry)) = entries.iter_mut().nth(at) {
                        let name = name.clone();
                        self.change(&name, entry, random);
                    }
                }
                _ => {}
            }
            return;
        }
        let known = self.below.get(name).and_then(|known| random.pick(known)).cloned();
        match value {
            Value::Bool(set) => *set = !*set,
            Value::Number(number) if number.is_f64() => {
                let number = number.as_f64().unwrap_or(0.0);
                *value =
                    [json!(number + 0.1), json!(number - 0.1), json!(number * 2.0), json!(0)][random.below(4)].clone();
            }
            Value::Number(number) => {
                let number = number.as_i64().unwrap_or(0);
                let all =
                    [number + 1, number - 1, number + 1, number - 1, number * 2, 0, 255, 65_535, 65_536, number / 2];
                *value = match known {
                    Some(known) if random.one_in(3) => known,
                    _ => json!(all[random.below(all.len())].max(0)),
                };
            }
            Value::Array(items) if !items.is_empty() && random.one_in(2) => {
                let (one, two) = (random.below(items.len()), random.below(items.len()));
                match random.below(4) {
                    0 => drop(items.remove(one)),
                    1 => items.insert(two, items[one].clone()),
                    2 => items.swap(one, two),
                    _ => items.extend(self.below.get(&format!("{name}/")).and_then(|all| random.pick(all)).cloned()),
                }
            }
            Value::Object(entries) if !entries.is_empty() && random.one_in(2) => {
                let names: Vec<String> = entries.keys().cloned().collect();
                let (one, two) = (&names[random.below(names.len())], &names[random.below(names.len())]);
                if random.one_in(2) {
                    entries.remove(one);
                } else {
                    let copied = entries[one].clone();
                    entries.insert(two.clone(), copied);
                }
            }
            _ => {
                if let Some(known) = known {
                    *value = known;
                }
            }
        }
    }
}

/// Walks, and cases that are there with changes, until the mutant shows; and makes the trace short.
fn search(mutant: &str, folder: &str, options: &Options, judge: Judge, seeds: &BTreeMap<&str, Seeds>) {
    for machine in machines(folder) {
        let until = Instant::now() + Duration::from_secs(options.seconds);
        let mut number = 0;
        let mut random = Random::of(options.seed, mutant, 0);
        while Instant::now() < until {
            number += 1;
            let expected = if number % 3 == 0 {
                walk::case(machine, options.seed, number / 3, Sizes::Small, None)
            } else {
                seeds.get(machine).and_then(|seeds| seeds.changed(&mut random)).and_then(without_faults)
            };
            let Some(expected) = expected else { continue };
            let mut wrong = Wrong::new(mutant);
            let Err(found) = play(&expected, &mut wrong, judge) else { continue };
            let case: Case = expected.case.clone();
            let Some(trace) = shrink(&[], case, *found, &mut wrong, judge, Duration::from_secs(15)) else { continue };
            let Some(last) = trace.cases.last() else { continue };
            let (steps, config) = (&last.case.steps, &last.case.config);
            println!(
                "{mutant}\tfound\t{machine}\t{number}\t{}\t{}",
                steps.len(),
                json!({"machine": machine, "config": config, "steps": steps})
            );
            return;
        }
        println!("{mutant}\tnot-found\t{machine}\t{number}");
    }
}

/// The case with the kernel's replies, without the steps that it does not take.
fn without_faults(mut case: Case) -> Option<Expected> {
    let mut session = Session::new();
    let mut ask = |line: &str| {
        let mut reply = Vec::new();
        session.answer(line.as_bytes(), &mut reply);
        String::from_utf8_lossy(&reply).trim_end().to_owned()
    };
    let start = ask(&case.start_line());
    if start.starts_with(r#"{"rejected""#) {
        case.steps.clear();
        return Some(Expected { case, start, outputs: Vec::new(), left_out: 0 });
    }
    if !start.starts_with(r#"{"started""#) {
        return None;
    }
    let mut outputs = Vec::new();
    case.steps.retain(|step| {
        let reply = ask(&json!({"step": step}).to_string());
        let taken = reply.starts_with(r#"{"output""#);
        if taken {
            outputs.push(reply);
        }
        taken
    });
    Some(Expected { case, start, outputs, left_out: 0 })
}

fn main() -> ExitCode {
    match options() {
        Ok(options) => {
            std::panic::set_hook(Box::new(|_| {}));
            if options.directed {
                return if directed() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
            }
            if let Some(path) = &options.caught {
                return match caught(path) {
                    Ok(true) => ExitCode::SUCCESS,
                    Ok(false) => ExitCode::FAILURE,
                    Err(error) => {
                        eprintln!("vectors: {error}");
                        ExitCode::from(2)
                    }
                };
            }
            run(&options);
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("vectors: {error}");
            ExitCode::from(2)
        }
    }
}
