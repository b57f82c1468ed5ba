//! Hunts for accidents: see `atc_tests::adversary`.
//!
//! `adversary [--layout FILE | --random NUMBER] [--cycles N] [--seed N] [--family NAME,…] [--fault NAME] [--episode N]`
//!
//! With `--fault` it takes the weapons of that fault of `known.rs`; without, all of them. Exit code 1 if an accident was found.

use std::process::ExitCode;
use std::time::Instant;

use atc_tests::adversary::arsenal::Arsenal;
use atc_tests::adversary::hunt::{Hunt, hunt, minimise};
use atc_tests::adversary::judge::Family;
use atc_tests::adversary::{device, known, stations, words};

struct Wanted {
    layout: Option<String>,
    random: Option<u64>,
    fault: Option<String>,
    hunt: Hunt,
}

fn wanted() -> Result<Wanted, String> {
    let hunt = Hunt { seed: 1, cycles: 1_000_000, episode: 3000, arsenal: Arsenal::ALL, sought: Family::ALL.to_vec() };
    let mut wanted = Wanted { layout: None, random: None, fault: None, hunt };
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
            "--fault" => wanted.fault = Some(value),
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
    if let Some(name) = &wanted.fault {
        let fault = known::KNOWN.iter().find(|fault| fault.name == name);
        let fault = fault.ok_or_else(|| {
            let names: Vec<&str> = known::KNOWN.iter().map(|fault| fault.name).collect();
            format!("--fault: {name} is none of {}", names.join(", "))
        })?;
        (wanted.hunt.arsenal, wanted.hunt.sought) = (fault.arsenal, fault.ends_in.to_vec());
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

fn run() -> Result<ExitCode, String> {
    let wanted = wanted()?;
    let description = match (wanted.random, &wanted.layout) {
        (Some(number), _) => stations::random(number),
        (None, file) => {
            let file = file.as_deref().unwrap_or("layouts/passing-loop.toml");
            atc_layout::read(file).map_err(|error| error.to_string())?
        }
    };
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
    println!("an accident after {} cycles; the scenario made small:", find.after);
    let small = minimise(&mut *device, &ground, &find);
    print!("{}", words::tell(&mut *device, &ground, &small));
    Ok(ExitCode::FAILURE)
}
