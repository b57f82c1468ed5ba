//! The run of a model, as it is drawn.

use super::devices::CIRCUITS;
use super::faults::{Event, Fault};
use super::ground::Harm;
use super::{State, Train, Whole};
use crate::interlocking::trace::Run;
use crate::outcome::Trace;
use atc_kernel::supervision::Brake;
use atc_protocol::machine::interlocking::Heading;
use serde_json::json;

/// The eastern station.
const EAST: usize = 1;

impl<const T: usize> Whole<T> {
    /// The run of the eastern station's interlocking, which staff ask, since its last start. The further words of a step: where the trains are,
    /// and what failed.
    pub(super) fn run(&self, path: &[(State<T>, Option<Event>)]) -> Trace {
        let starts = |event: &Event| event.starts(EAST).is_some();
        let started = path.iter().rposition(|(_, event)| event.as_ref().is_some_and(starts)).unwrap_or(0);
        let mut run = Run::begin("east", &CIRCUITS, self.ground(EAST).layout());
        for (before, event) in &path[started..] {
            let Some(event) = event else { break };
            let made = self.cycle(before, *event);
            let put = self.stations[EAST].cycle(&made.begun[EAST], &made.read[EAST]);
            let train = |train: &Train| {
                let device = &train.device;
                json!({
                    "front_m": train.body.front,
                    "speed_m_s": train.body.speed,
                    "heading": Heading(train.body.heading),
                    "brake": device.brake != Brake::Release,
                })
            };
            let fault = |fault: &Fault| json!({"kind": fault.kind.name(), "at": fault.at});
            let words = json!({
                "trains": made.after.trains.iter().map(train).collect::<Vec<_>>(),
                "faults": event.faults.iter().flatten().map(fault).collect::<Vec<_>>(),
                "proceed_by_the_model": run.routes(put.proceed),
                "staff_ask": event.asked,
                "hazard": made.after.harm != Harm::None,
            });
            let (_, reading) = self.ground(EAST).read(made.begun[EAST], made.read[EAST].input());
            run.step(&reading.input, words);
        }
        run.trace()
    }
}
