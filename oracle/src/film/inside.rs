//! The kernel in the page: the module, and the session in the module's words, so that a reader can go on from any step.

use std::collections::BTreeMap;

use atc_film::{Film, Kernel};
use atc_film_kernel::{input_words, place, plan_words};
use atc_kernel::interlocking::{MAX_CODES, SpeedCode};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::take::Take;
use atc_protocol::machine::interlocking::{Interlocked, Phase, Reason, Sizes};
use atc_protocol::names::Named;

/// Puts the kernel into a film, if there is one to put in; else the film says that it only plays.
pub(super) fn put(take: &Take<'_, Sizes>, machine: &Interlocked, film: &mut Film) -> Result<(), String> {
    let Some(module) = &take.setting.kernel else {
        film.notes.push("The kernel is not in this page, which only plays; --kernel puts it in.".to_owned());
        return Ok(());
    };
    let mut numbers: BTreeMap<String, u32> = BTreeMap::new();
    let mut inputs = Vec::new();
    let mut steps = Vec::new();
    for cycle in take.cycles {
        let words = encoded(&input_words(&machine.input(&cycle.step)?));
        let next = u32::try_from(inputs.len()).unwrap_or(u32::MAX);
        let number = *numbers.entry(words.clone()).or_insert(next);
        if number == next {
            inputs.push(words);
        }
        steps.push(number);
    }
    let names = machine.names();
    let every = |list: &[&str]| list.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    let kinds = [
        ("circuit", names.circuits.clone()),
        ("point", names.points.clone()),
        ("route", names.routes.clone()),
        ("signal", names.signals.clone()),
        ("segment", names.segments.clone()),
        ("phase", every(&Phase::EVERY.iter().map(|phase| phase.name()).collect::<Vec<_>>())),
        ("refusal", every(&Reason::EVERY.iter().map(|reason| reason.name()).collect::<Vec<_>>())),
    ];
    let places = [
        ("occupied", place::OCCUPIED),
        ("proceed", place::PROCEED),
        ("drives", place::DRIVES),
        ("confirmed", place::CONFIRMED),
        ("blocked", place::BLOCKED),
        ("segments", place::SEGMENTS),
        ("answer", place::ANSWER),
        ("phases", place::PHASES),
        ("paths", place::PATHS),
        ("overlaps", place::OVERLAPS),
        ("locks", place::LOCKS),
        ("telegrams", place::TELEGRAMS),
    ];
    let codes = (0..).take(MAX_CODES).map(|code| machine.speed(SpeedCode(code)));
    film.kernel = Some(Kernel {
        module: STANDARD.encode(module),
        plan: encoded(&plan_words(machine.layout().plan())),
        inputs,
        steps,
        names: kinds.into_iter().map(|(kind, names)| (kind.to_owned(), names)).collect(),
        speeds_kmh: codes.collect(),
        places: places.into_iter().map(|(what, at)| (what.to_owned(), at)).collect(),
    });
    Ok(())
}

fn encoded(words: &[u64]) -> String {
    STANDARD.encode(words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>())
}
