//! `[signal]` and `[[section]]` as the file gives them, and their single values.

use super::{At, Tenths, kmh};
use crate::case::LineSection;
use crate::error::Fault;
use atc_kernel::aspect::{AspectId, AspectTable, TableError};
use atc_kernel::permitted::Settings;
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Sequence, SequenceError};
use atc_kernel::time::{MAX_TICKS, Millis, Ticks};
use serde::Deserialize;
use toml::Spanned;

/// `[signal]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileSignal {
    /// The speeds that ranks in telegrams mean; without it the aspects.
    #[serde(default)]
    pub(super) speeds_km_h: Option<Spanned<Vec<Spanned<f64>>>>,
    pub(super) frame_ms: Spanned<u32>,
    pub(super) window: Spanned<u8>,
    pub(super) run: Spanned<u8>,
    pub(super) memory_ms: Spanned<u32>,
    pub(super) fresh_ms: Spanned<u32>,
    pub(super) life_ms: Spanned<u32>,
    pub(super) fixed_life_ms: Spanned<u32>,
    pub(super) brake_mm_s2: Spanned<u16>,
    pub(super) margin_m: Spanned<u16>,
    pub(super) heard_beyond_exit_m: Spanned<u16>,
    pub(super) delay_ms: Spanned<u32>,
    pub(super) worst_gradient_permille: Spanned<i8>,
    pub(super) lowest_limit_km_h: Spanned<f64>,
    pub(super) reaction_ms: Spanned<u32>,
    pub(super) release_ms: Spanned<u32>,
    pub(super) restriction_lead_ms: Spanned<u32>,
}

/// `[[section]]`: what its sub telegrams say.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileSection {
    pub(super) number: Spanned<u16>,
    pub(super) length_m: Spanned<u16>,
    pub(super) gradient_permille: Spanned<i8>,
    pub(super) limit_km_h: Spanned<f64>,
}

pub(super) fn speeds(
    at: At<'_>,
    tenths: Tenths<'_>,
    aspects: &AspectTable,
    file: &FileSignal,
) -> Result<AspectTable, Fault> {
    let Some(list) = &file.speeds_km_h else { return Ok(*aspects) };
    let values = list.get_ref().iter().map(tenths).collect::<Result<Vec<_>, _>>()?;
    AspectTable::new(&values).map_err(|error| {
        let (span, rule) = match error {
            TableError::Empty => (list.span(), "there must be at least one speed".to_owned()),
            TableError::TooMany => (list.span(), format!("at most 16 speeds; there are {}", values.len())),
            TableError::NotRising(place) => (
                list.get_ref().get(place).map_or_else(|| list.span(), Spanned::span),
                format!("the speeds must rise strictly; number {} does not exceed the one before it", place + 1),
            ),
        };
        Fault::new(&at(span), format!("rule TIME-4 is broken: {rule}"))
    })
}

/// The rank of a speed in the table.
pub(super) fn rank(
    at: At<'_>,
    tenths: Tenths<'_>,
    speeds: &AspectTable,
    speed: &Spanned<f64>,
    rule: &str,
    what: &str,
) -> Result<AspectId, Fault> {
    speeds.aspect(tenths(speed)?).ok_or_else(|| {
        let known = speeds.speeds().iter().map(|one| kmh(*one)).collect::<Vec<_>>().join(", ");
        let text =
            format!("rule {rule} is broken: {what} must be a speed of the table ({known}); it is {}", speed.get_ref());
        Fault::new(&at(speed.span()), text)
    })
}

/// A time as cycles, rounded down: while it lasts something is permitted.
pub(super) fn ticks(at: At<'_>, cycle: Millis, time: &Spanned<u32>, rule: &str, what: &str) -> Result<Ticks, Fault> {
    let cycles = *time.get_ref() / cycle.0.max(1);
    match u16::try_from(cycles) {
        Ok(ticks) if ticks <= MAX_TICKS => Ok(Ticks(ticks)),
        _ => {
            let text = format!("rule {rule} is broken: {what} must not exceed 60 000 logic cycles; it is {cycles}");
            Err(Fault::new(&at(time.span()), text))
        }
    }
}

pub(super) fn sequence(at: At<'_>, file: &FileSignal, memory: Ticks) -> Result<Sequence, Fault> {
    Sequence::new(*file.window.get_ref(), *file.run.get_ref(), memory).map_err(|error| {
        let (span, rule) = match error {
            SequenceError::NoWindow => (file.window.span(), "the window must be 1 or more"),
            SequenceError::WindowTooWide => (file.window.span(), "the window must not exceed 127"),
            SequenceError::NoRun => (file.run.span(), "the run must be 1 or more"),
            SequenceError::RunTooLong => (file.run.span(), "the run must not exceed 15"),
            SequenceError::NoMemory => (file.memory_ms.span(), "the memory must be one cycle or more (it rounds down)"),
            SequenceError::MemoryTooLong => (file.memory_ms.span(), "the memory must not exceed 60 000 logic cycles"),
        };
        Fault::new(&at(span), format!("rule TEL-7 is broken: {rule}"))
    })
}

pub(super) fn sections(
    at: At<'_>,
    tenths: Tenths<'_>,
    settings: &Settings,
    files: &[FileSection],
) -> Result<(Vec<LineSection>, Vec<KmhTenths>), Fault> {
    let (mut sections, mut limits): (Vec<LineSection>, Vec<KmhTenths>) = (Vec::new(), Vec::new());
    for file in files {
        let (number, length) = (*file.number.get_ref(), *file.length_m.get_ref());
        let fault = |span, text: String| Err(Fault::new(&at(span), text));
        if sections.iter().any(|one| one.number == number) {
            return fault(
                file.number.span(),
                format!("section {number} is there twice: a number must name one section"),
            );
        }
        if length == 0 {
            return fault(file.length_m.span(), format!("rule TEL-4 is broken, section {number}: it has no length"));
        }
        let gradient = *file.gradient_permille.get_ref();
        if gradient < settings.worst.0 {
            let text = format!(
                "rule PER-5 is broken, section {number}: it falls more than the worst gradient that is assumed ({} ‰); it is {gradient} ‰",
                settings.worst.0
            );
            return fault(file.gradient_permille.span(), text);
        }
        let limit =
            rank(at, tenths, &settings.speeds, &file.limit_km_h, "PER-7", &format!("the limit of section {number}"))?;
        if limit < settings.lowest {
            let lowest = settings.speeds.speed(settings.lowest).map(kmh).unwrap_or_default();
            let text = format!(
                "rule PER-5 is broken, section {number}: its limit is under the lowest one that is assumed ({lowest} km/h); it is {} km/h",
                file.limit_km_h.get_ref()
            );
            return fault(file.limit_km_h.span(), text);
        }
        limits.extend(settings.speeds.speed(limit));
        let limit_km_h = *file.limit_km_h.get_ref();
        sections.push(LineSection { number, length_m: length, gradient_permille: gradient, limit_km_h });
    }
    Ok((sections, limits))
}
