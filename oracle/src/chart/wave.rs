//! Scenes as a Value Change Dump, for waveform viewers such as GTKWave and Surfer.

use std::io;

use vcd::{IdCode, SimulationCommand, TimescaleUnit, VarType, Writer};

use super::scene::{Scene, Values};
use crate::trace::error::TraceError;
use atc_protocol::form::Fault;

/// One change of one signal.
enum Change<'a> {
    Wire(bool),
    State(&'a str),
    Real(f64),
}

pub(super) fn vcd(scenes: &[Scene]) -> Result<String, TraceError> {
    let fault = |what: String| TraceError { line: 0, fault: Fault::whole(what) };
    let mut out = Vec::new();
    write(scenes, &mut out).map_err(|error| fault(format!("the VCD cannot be written: {error}")))?;
    String::from_utf8(out).map_err(|error| fault(format!("the VCD is not text: {error}")))
}

/// Every case begins at time 0, in a scope of its own. A real value that is missing is not a number there.
fn write(scenes: &[Scene], out: &mut Vec<u8>) -> io::Result<()> {
    let mut writer = Writer::new(out);
    writer.comment("one scope for each case; an output changes at the end of its logic cycle")?;
    writer.timescale(
        1,
        if scenes.iter().all(|scene| scene.unit.name == "ms") { TimescaleUnit::MS } else { TimescaleUnit::S },
    )?;
    let mut changes: Vec<(u64, IdCode, Change<'_>)> = Vec::new();
    for (number, scene) in (1..).zip(scenes) {
        writer.add_module(&format!("case_{number}_{}", scene.machine.replace('-', "_")))?;
        for signal in &scene.signals {
            let (kind, width) = match signal.values {
                Values::Wire(_) => (VarType::Wire, 1),
                Values::State(_) => (VarType::String, 1),
                Values::Real(_) => (VarType::Real, 64),
            };
            let id = writer.add_var(kind, width, &signal.name, None)?;
            let at = |cycle: &u64| scene.unit.value(*cycle);
            match &signal.values {
                Values::Wire(values) => {
                    changes.extend(values.iter().map(|(cycle, on)| (at(cycle), id, Change::Wire(*on))));
                }
                Values::State(values) => {
                    changes.extend(values.iter().map(|(cycle, name)| (at(cycle), id, Change::State(name))));
                }
                Values::Real(values) => changes.extend(
                    values.iter().map(|(cycle, value)| (at(cycle), id, Change::Real(value.unwrap_or(f64::NAN)))),
                ),
            }
        }
        writer.upscope()?;
    }
    writer.enddefinitions()?;
    changes.sort_by_key(|change| change.0);
    let end = scenes.iter().map(|scene| scene.unit.value(scene.cycles)).max().unwrap_or(0);
    writer.timestamp(0)?;
    writer.begin(SimulationCommand::Dumpvars)?;
    let mut now = 0;
    for (at, id, change) in changes {
        if at > now {
            if now == 0 {
                writer.end()?;
            }
            writer.timestamp(at)?;
            now = at;
        }
        match change {
            Change::Wire(on) => writer.change_scalar(id, on)?,
            Change::State(name) => writer.change_string(id, name)?,
            Change::Real(value) => writer.change_real(id, value)?,
        }
    }
    if now == 0 {
        writer.end()?;
    }
    if now < end {
        writer.timestamp(end)?;
    }
    writer.flush()
}
