//! What the models of aspect acceptance have in common: a line, what is detected and sent, and the trace of it.

use crate::line::{self, ASPECTS_KM_H, Line};
use crate::outcome::{Step, Trace};
use crate::subject::Subject;
use crate::train::{Displays, Train};
use atc_kernel::aspect::{Acceptance, AspectSet};
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::collections::BTreeMap;

/// A model of aspect acceptance.
pub trait Receiving: Subject {
    /// The line that it models.
    fn line(&self) -> Line;
    /// How many aspects the line has.
    fn aspects(&self) -> usize;
    /// What the receiver detected in the cycle `action` from `state`.
    fn detected(&self, state: &Self::State, action: &Self::Action) -> AspectSet;
    /// What the ground sent in it; `None` if the model has no ground.
    fn sent(&self, _state: &Self::State, _action: &Self::Action) -> Option<AspectSet> {
        None
    }
    /// If the last state closes a loop: of how many cycles.
    fn loop_length(&self, _last: &Self::State) -> Option<usize> {
        None
    }
}

/// The configuration of the oracle, protocol 1, that a trace of the machine `aspect-acceptance` belongs to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Config {
    /// The length of a logic cycle.
    pub cycle_ms: u32,
    /// The permitted speeds, the lowest first.
    pub aspects_km_h: Vec<u16>,
    /// T1.
    pub operate_ms: u32,
    /// T2.
    pub recovery_ms: u32,
    /// T3.
    pub mask_ms: u32,
    /// T4.
    pub interruption_ms: u32,
    /// T5.
    pub shortened_operate_ms: u32,
}

/// Runs the real devices over a path of `model`. The further words of a step: `sent_km_h` (where there is a ground),
/// `conventional_km_h` and `as_claimed_km_h`, the displays of the other two devices; `null` where nothing is displayed.
pub(crate) fn trace<M: Receiving>(model: &M, path: &[(M::State, Option<M::Action>)]) -> Trace {
    let line = model.line();
    let device = Acceptance::<{ ASPECTS_KM_H.len() }> { times: line.ticks() };
    let mut train = Train::<_, { ASPECTS_KM_H.len() }>::initial(&device);
    let steps: Vec<_> = path
        .iter()
        .filter_map(|(state, action)| {
            let action = action.as_ref()?;
            let detected = model.detected(state, action);
            train = train.step(&device, detected);
            let Displays { normative, conventional, as_claimed } = train.shown;
            let mut words = BTreeMap::from([
                ("conventional_km_h".to_owned(), json!(line::speed(conventional))),
                ("as_claimed_km_h".to_owned(), json!(line::speed(as_claimed))),
            ]);
            if let Some(sent) = model.sent(state, action) {
                words.insert("sent_km_h".to_owned(), json!(line::speeds(sent)));
            }
            Some(Step {
                input: json!({"detected_km_h": line::speeds(detected)}),
                output: json!({"display_km_h": line::speed(normative)}),
                words,
            })
        })
        .collect();
    let loop_length = path.last().and_then(|(last, _)| model.loop_length(last));
    let loop_start = loop_length.and_then(|length| steps.len().checked_sub(length));
    let config = json!(Config::of(line, model.aspects()));
    Trace { machine: "aspect-acceptance".to_owned(), config, steps, loop_start }
}

impl Config {
    fn of(line: Line, aspects: usize) -> Self {
        Self {
            cycle_ms: line.cycle.0,
            aspects_km_h: ASPECTS_KM_H.iter().take(aspects).copied().collect(),
            operate_ms: line.times.operate.0,
            recovery_ms: line.times.recovery.0,
            mask_ms: line.times.mask.0,
            interruption_ms: line.times.interruption.0,
            shortened_operate_ms: line.times.shortened_operate.0,
        }
    }
}
