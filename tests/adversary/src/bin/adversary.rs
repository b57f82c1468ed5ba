//! Hunts for accidents: see `atc_adversary`.
//!
//! `adversary [--layout FILE | --random NUMBER] [--cycles N] [--seed N] [--family NAME,…] [--fault NAME] [--episode N]
//! [--small yes|no] [--trace FILE] [--altered TIMES]` `adversary --known`
//!
//! With `--fault` it hunts as the table in `known.rs` has it for that fault, but for what the options behind it say; without, with all weapons.
//! The scenario is told as small as it gets, with `--small no` as it was found. `--trace` also writes it for `oracle
//! explore --as-recorded`. `--altered` alters the file so often at random, and hunts for `--cycles` on each that breaks no
//! rule. `--known` lists the table. Exit code 1 if an accident was found.

use std::process::ExitCode;
use std::time::Instant;

use atc_adversary::arsenal::Arsenal;
use atc_adversary::hunt::{Hunt, hunt, minimise};
use atc_adversary::judge::Family;
use atc_adversary::{altered, device, known, stations, trace, words};

struct Wanted {
    layout: Option<String>,
    random: Option<u64>,
    hunt: Hunt,
    small: bool,
    trace: Option<String>,
    altered: usize,
}

fn wanted() -> Result<Wanted, String> {
    let hunt = Hunt {
        seed: 1,
        cycles: 1_000_000,
        episode: known::EPISODE,
        arsenal: Arsenal::ALL,
        sought: Family::ALL.to_vec(),
    };
    let mut wanted = Wanted { layout: None, random: None, hunt, small: true, trace: None, altered: 0 };
    let mut arguments = std::env::args().skip(1);
    while let Some(option) = arguments.next() {
        let value = arguments.next().ok_or(format!("{option} needs a value"))?;
        let number = || value.parse::<u64>().map_err(|_| format!("{option}: {value} is no number"));
        match option.as_str() {
            "--layout" => wanted.layout = Some(value),
            "--random" => wanted.random = Some(number()?),
            "--cycles" => wanted.hunt.cycles = number()?,
            "--seed" => wanted.hunt.seed = number()?,
            "--episode" => wanted.hunt.episode = i64::try_from(number()?).unwrap_or(i64::MAX),
            "--fault" => {
                let fault = known::KNOWN.iter().find(|fault| fault.name == value).ok_or_else(|| {
                    let names: Vec<&str> = known::KNOWN.iter().map(|fault| fault.name).collect();
                    format!("--fault: {value} is none of {}", names.join(", "))
                })?;
                wanted.hunt = fault.hunt();
                wanted.layout = Some(format!("layouts/{}.toml", fault.layout));
            }
            "--altered" => wanted.altered = usize::try_from(number()?).unwrap_or(usize::MAX),
            "--small" => wanted.small = value != "no",
            "--trace" => wanted.trace = Some(value),
            "--family" => {
                let named = |name: &str| Family::ALL.into_iter().find(|family| family.name() == name);
                let all: Option<Vec<Family>> = value.split(',').map(named).collect();
                wanted.hunt.sought = all.ok_or_else(|| {
                    let names: Vec<&str> = Family::ALL.iter().map(|family| family.name()).collect();
                    format!("--family: {value} is none of {}", names.join(", "))
                })?;
            }
            _ => return Err(format!("there is no option {option}")),
        }
    }
    Ok(wanted)
}

fn main() -> ExitCode {
    match run() {
        Ok(code) => code,
        Err(error) => {
            eprintln!("adversary: {error}");
            ExitCode::from(2)
        }
    }
}

/// The table of the known faults, for programs: what is in a line stands between tabulators.
fn list() {
    for fault in known::KNOWN {
        println!("{}\t{}\t{}\t{}", fault.name, fault.old_rule.join(","), known::CYCLES, fault.model);
    }
}

/// Hunts on altered files.
fn attacked(description: &atc_layout::Description, wanted: &Wanted) -> ExitCode {
    let attack = altered::attack(description, wanted.hunt.seed, wanted.altered, wanted.hunt.cycles);
    for (said, description, told) in &attack.finds {
        println!("--- {said}\n{told}\n{}", description.to_toml());
    }
    println!(
        "{}: {} altered files break no rule, {} do; {} cycles, {} routes set, {} trains; {} accidents",
        description.station.name,
        attack.accepted,
        attack.rejected,
        attack.tally.cycles,
        attack.tally.routes_set,
        attack.tally.trains,
        attack.finds.len()
    );
    if attack.finds.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn run() -> Result<ExitCode, String> {
    if std::env::args().skip(1).eq(["--known"]) {
        list();
        return Ok(ExitCode::SUCCESS);
    }
    let wanted = wanted()?;
    let description = match (wanted.random, &wanted.layout) {
        (Some(number), _) => stations::random(number),
        (None, file) => {
            let file = file.as_deref().unwrap_or("layouts/passing-loop.toml");
            // Of any form: an imported station is hunted on as well.
            atc_layout::import::read_any(file).map_err(|error| error.to_string())?.description
        }
    };
    if wanted.altered > 0 {
        return Ok(attacked(&description, &wanted));
    }
    let (mut device, ground) = device::kernel(&description).map_err(|error| error.to_string())?;
    let start = Instant::now();
    let (find, tally) = hunt(&mut *device, &ground, &wanted.hunt);
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{}: {} cycles in {} episodes, {:.1} s; {} routes set, {} trains, {} km; {} accidents under a broken condition",
        ground.name,
        tally.cycles,
        tally.episodes,
        seconds,
        tally.routes_set,
        tally.trains,
        tally.metres / 1000,
        tally.discarded
    );
    let Some(find) = find else {
        println!("no accident");
        return Ok(ExitCode::SUCCESS);
    };
    let (small, what) = if wanted.small {
        (minimise(&mut *device, &ground, &find), "the scenario made small")
    } else {
        (find.clone(), "the scenario")
    };
    println!("an accident after {} cycles; {what}:", find.after);
    print!("{}", words::tell(&mut *device, &ground, &small));
    if let Some(file) = &wanted.trace {
        let trace = trace::of(&mut *device, &ground, &description, &small)?;
        std::fs::write(file, trace.to_string()).map_err(|error| format!("{file} cannot be written: {error}"))?;
    }
    Ok(ExitCode::FAILURE)
}
