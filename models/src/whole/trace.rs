//! The run of a model, as it is drawn.

use super::devices::CIRCUITS;
use super::faults::{Event, Fault};
use super::ground::Harm;
use super::{State, Whole};
use crate::interlocking::trace::{Run, names};
use crate::outcome::Trace;
use atc_kernel::supervision::Brake;
use serde_json::json;
use std::collections::BTreeMap;

impl<const T: usize> Whole<T> {
    /// The run of the western station's interlocking since its last start. The further words of a step: where the trains are, and what failed.
    pub(super) fn run(&self, path: &[(State<T>, Option<Event>)]) -> Trace {
        let starts = |event: &Event| event.starts(0).is_some();
        let started = path.iter().rposition(|(_, event)| event.as_ref().is_some_and(starts)).unwrap_or(0);
        let mut run = Run::begin("west", &CIRCUITS, self.ground(0).layout());
        for (before, event) in &path[started..] {
            let Some(event) = event else { break };
            let made = self.cycle(before, *event);
            let west = self.stations[0].cycle(&made.begun[0], &made.read[0]);
            let train = |train: &super::Train| {
                let device = &train.device;
                json!({
                    "front_m": train.body.front,
                    "speed_m_s": train.body.speed,
                    "heading": if train.body.heading == atc_kernel::heading::Heading::Right { "right" } else { "left" },
                    "brake": device.brake != Brake::Release,
                })
            };
            let fault = |fault: &Fault| json!({"kind": fault.kind.name(), "at": fault.at});
            let words = BTreeMap::from([
                ("trains".to_owned(), made.after.trains.iter().map(train).collect()),
                ("faults".to_owned(), event.faults.iter().flatten().map(fault).collect()),
                ("proceed_by_the_model".to_owned(), json!(names(west.proceed))),
                ("staff_ask".to_owned(), json!(event.asked)),
                ("hazard".to_owned(), json!(made.after.harm != Harm::None)),
            ]);
            let (_, reading) = self.ground(0).read(made.begun[0], made.read[0].input());
            run.step(&reading.input, words);
        }
        run.trace()
    }
}
