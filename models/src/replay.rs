//! What the models of aspect acceptance have in common: a line, what is detected and sent, and the trace of it.

use crate::line::{ASPECTS_KM_H, Line};
use crate::outcome::{Cycle, Trace};
use crate::subject::Subject;
use crate::train::{Displays, Train};
use atc_kernel::aspect::{Acceptance, AspectSet};
use atc_protocol::Kmh;
use atc_protocol::machine::aspect::{self, Aspect, Config, Output};
use serde_json::json;

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

/// Runs the real devices over a path of `model`. The further words of a step: `sent_km_h` (where there is a ground),
/// `conventional_km_h` and `as_claimed_km_h`, the displays of the other two devices; `null` where nothing is displayed.
pub(crate) fn trace<M: Receiving>(model: &M, path: &[(M::State, Option<M::Action>)]) -> Trace {
    let line = model.line();
    let speeds = ASPECTS_KM_H.iter().take(model.aspects()).map(|speed| Kmh(i32::from(*speed) * 10)).collect();
    let config = Config::new(line.cycle, speeds, line.times);
    let table = config.table().expect("the aspects of a line are a table");
    let heard = |set| aspect::Step::of(&table, set);
    let shown = |display| Output::of(&table, display);
    let device = Acceptance::<{ ASPECTS_KM_H.len() }> { times: line.ticks() };
    let mut train = Train::<_, { ASPECTS_KM_H.len() }>::initial(&device);
    let mut cycles: Vec<Cycle<Aspect, _>> = Vec::new();
    for (state, action) in path {
        let Some(action) = action else { continue };
        let detected = model.detected(state, action);
        train = train.step(&device, detected);
        let Displays { normative, conventional, as_claimed } = train.shown;
        let mut words = json!({
            "conventional_km_h": shown(conventional).display_km_h,
            "as_claimed_km_h": shown(as_claimed).display_km_h,
        });
        if let Some(sent) = model.sent(state, action) {
            words["sent_km_h"] = json!(heard(sent).detected_km_h);
        }
        cycles.push((heard(detected), shown(normative), words));
    }
    let loop_length = path.last().and_then(|(last, _)| model.loop_length(last));
    let loop_start = loop_length.and_then(|length| cycles.len().checked_sub(length));
    Trace { loop_start, ..Trace::of::<Aspect, _>(&config, &cycles) }
}
