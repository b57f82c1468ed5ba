//! The devices of a line: what its file says to each machine, as the configuration that a session gives it.
//!
//! The form of a line has one place for each value. A device takes its values from several of them, and from a station's layout. Here they
//! come together, and the kernel is asked whether it takes them.

use std::collections::BTreeMap;

use atc_kernel::code::Code;
use atc_kernel::heading::Heading;
use atc_kernel::time::Millis;
use atc_line::aspect::Config as AspectConfig;
use atc_line::check::{DataCheck, Finding, Outcome};
use atc_line::code::speed;
use atc_line::figures::LineSection;
use atc_line::seam::Station;
use atc_line::signal::Signal;
use atc_line::{Line, Rule, permitted, position, supervision};
use serde::Serialize;
use serde_json::Value;

use crate::decimal::Hertz;
use crate::form;
use crate::kmh::Kmh;
use crate::machine::{interlocking, pattern, train, wayside};
use crate::session::Session;

/// A device of a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Device {
    /// Its machine.
    pub machine: &'static str,
    /// What tells it from others of its machine, and its number among them, from 1: `1-Westham`. Empty where there is one.
    pub which: String,
    /// The place of the file that it is made of, with its line.
    pub at: String,
    /// The body of its `config`; or what the file says too little of, in a sentence.
    pub config: Result<Value, String>,
}

/// Machines that the file says nothing of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Without {
    /// The machine.
    pub machine: &'static str,
    /// What is not there.
    pub why: &'static str,
}

/// The devices of a line.
#[derive(Clone, Debug, Default)]
pub struct Devices {
    /// Each device, in the order of the machines.
    pub all: Vec<Device>,
    /// The machines of which it has none.
    pub without: Vec<Without>,
}

const NO_STATION: &str = "the line names no station";
const NO_SIGNAL: &str = "the file has no [signal]";
const NO_CODES: &str = "the file has no [codes]";

impl Device {
    fn new(machine: &'static str, at: String, config: &impl Serialize) -> Self {
        Self {
            machine,
            which: String::new(),
            at,
            config: serde_json::to_value(config).map_err(|error| error.to_string()),
        }
    }

    /// Its name among the devices of its line: `wayside-1-Westham`.
    pub fn name(&self) -> String {
        if self.which.is_empty() { self.machine.to_owned() } else { format!("{}-{}", self.machine, self.which) }
    }

    /// Starts it once.
    ///
    /// # Errors
    /// Why its configuration cannot be made, or the kernel does not take it.
    pub fn start(&self) -> Result<(), String> {
        let config = self.config.as_ref().map_err(Clone::clone)?;
        let mut reply = Vec::new();
        let line = form::Line::start(self.machine, config).text();
        Session::new().request(&line, &mut reply).map_err(|fault| fault.what)?;
        let reply: Value = serde_json::from_slice(&reply).map_err(|error| error.to_string())?;
        reply["rejected"]["reason"].as_str().map_or(Ok(()), |reason| Err(reason.to_owned()))
    }
}

impl Devices {
    /// The devices of a line.
    pub fn of(line: &Line) -> Self {
        let at = |path: &str| line.places().at(path);
        let mut devices = Self::default();
        devices.add(Device::new("aspect-acceptance", at("times"), line.aspect()));
        let supervision = supervision::Config::of(line.supervision());
        devices.add(Device::new("speed-supervision", at("supervision"), &supervision));
        match line.detection() {
            Some(detection) => {
                for (place, config) in detection.configs().iter().enumerate() {
                    let device = Device::new("block-count", at(&format!("block[{place}]")), config);
                    devices.add(Device { which: (place + 1).to_string(), ..device });
                }
            }
            None => devices.lack("block-count", "the file has no [[block]]"),
        }
        if let Some(signal) = line.signal() {
            let brake_mm_s2 = signal.permitted().settings().brake.mm_s2().into();
            devices.add(Device::new("braking-pattern", at("signal.brake_mm_s2"), &pattern::Config { brake_mm_s2 }));
            devices.add(Device::new("permitted-speed", at("signal"), &permitted_of(line, signal)));
        } else {
            devices.lack("braking-pattern", NO_SIGNAL);
            devices.lack("permitted-speed", NO_SIGNAL);
        }
        match line.position() {
            Some(calibration) => {
                let config = position::Config::of(calibration.position());
                devices.add(Device::new("train-position", at("position"), &config));
            }
            None => devices.lack("train-position", "the file has no [position]"),
        }
        devices.trains(line);
        devices.stations(line);
        devices
    }

    fn add(&mut self, device: Device) {
        self.all.push(device);
    }

    fn lack(&mut self, machine: &'static str, why: &'static str) {
        self.without.push(Without { machine, why });
    }

    fn trains(&mut self, line: &Line) {
        let Some(signal) = line.signal() else { return self.lack("train", NO_SIGNAL) };
        let Some(codes) = codes_of(line) else { return self.lack("train", NO_CODES) };
        let AspectConfig { operate_ms, recovery_ms, mask_ms, interruption_ms, shortened_operate_ms, .. } =
            *line.aspect();
        let acceptance =
            train::AcceptanceTimes { operate_ms, recovery_ms, mask_ms, interruption_ms, shortened_operate_ms };
        let config = train::Config {
            permitted: permitted_of(line, signal),
            acceptance,
            codes,
            supervision: supervision::Config::of(line.supervision()),
            channels: None,
            position: line.position().map(|calibration| position::Config::of(calibration.position())),
        };
        self.add(Device::new("train", line.places().at("signal"), &config));
    }

    fn stations(&mut self, line: &Line) {
        if line.stations().is_empty() {
            self.lack("interlocking", NO_STATION);
            return self.lack("wayside", NO_STATION);
        }
        for (place, station) in line.stations().iter().enumerate() {
            let which = format!("{}-{}", place + 1, station.name());
            let at = line.places().at(&format!("station[{place}].file"));
            let layout = interlocking::Config::from(station.description().clone());
            self.add(Device { which, ..Device::new("interlocking", at, &layout) });
        }
        let codes = match wayside_codes(line) {
            Ok(codes) => codes,
            Err(why) => return self.lack("wayside", why),
        };
        for (place, station) in line.stations().iter().enumerate() {
            let config = wayside_of(line, station, codes.clone());
            let config = config.and_then(|config| serde_json::to_value(config).map_err(|error| error.to_string()));
            let (at, which) = (line.places().at("telegram"), format!("{}-{}", place + 1, station.name()));
            self.add(Device { machine: "wayside", which, at, config });
        }
    }
}

/// Every rule of a line, and that its devices start.
pub fn checks(line: &Line) -> Vec<DataCheck> {
    let mut checks = line.checks();
    let devices = Devices::of(line).all;
    let scope = format!("{} devices", devices.len());
    // The kernel would refuse what another rule tells with both places.
    let outcome = if checks.iter().all(|check| check.outcome.holds()) {
        Outcome::of(devices.iter().filter_map(refused).collect())
    } else {
        Outcome::NotChecked
    };
    checks.push(DataCheck::new(Rule::DeviceStarts, scope, outcome));
    checks
}

fn refused(device: &Device) -> Option<Finding> {
    let what = format!("the device {} does not start: {}", device.name(), device.start().err()?);
    Some(Finding { at: device.at.clone(), against: None, what, right: String::new() })
}

fn permitted_of(line: &Line, signal: &Signal) -> permitted::Config {
    permitted::Config::of(signal.permitted(), Millis(line.aspect().cycle_ms))
}

/// The pairs of codes; none if the file has no table.
fn codes_of(line: &Line) -> Option<train::Codes> {
    let table = line.codes()?;
    let hertz = |millihertz: u32| Hertz(millihertz.into());
    let (mains, subs) = (table.main(), table.sub());
    let mut pairs = Vec::new();
    for (main, main_hz) in (0..).map_while(Code::new).zip(mains.nominal()) {
        for (sub, sub_hz) in (0..).map_while(Code::new).zip(subs.nominal()) {
            if let Some(speed) = table.speed(Some(main), Some(sub)) {
                let (main_hz, sub_hz) = (hertz(main_hz.0), hertz(sub_hz.0));
                pairs.push(train::Pair { main_hz, sub_hz, speed_km_h: Kmh::from(speed) });
            }
        }
    }
    Some(train::Codes { tolerance_hz: hertz(mains.tolerance().0), pairs })
}

/// The pairs of codes of a line whose stations have transmitters; or what the file says nothing of.
fn wayside_codes(line: &Line) -> Result<train::Codes, &'static str> {
    line.signal().ok_or(NO_SIGNAL)?;
    if line.telegrams().is_empty() {
        return Err("the file has no [[telegram]]");
    }
    if line.sections().is_empty() {
        return Err("the file has no [[section]]");
    }
    codes_of(line).ok_or(NO_CODES)
}

/// The ground's device of a station. Counted blocks begin where a layout ends, so it has no counted line.
fn wayside_of(line: &Line, station: &Station, codes: train::Codes) -> Result<wayside::Config, String> {
    let model = station.model().ok_or("its layout breaks a rule")?;
    let sections: BTreeMap<u16, LineSection> = line.sections().into_iter().map(|one| (one.number, one)).collect();
    let mut circuits = BTreeMap::new();
    for telegram in line.telegrams().iter().filter(|telegram| telegram.station == station.name()) {
        let facing = |heading: Heading, side: &str| -> Result<wayside::FacingSignals, String> {
            let number = telegram.section(heading).ok_or_else(|| {
                let (circuit, station) = (&telegram.circuit, station.name());
                format!(
                    "circuit {circuit} of {station} has no number to the {side}; a transmitter sends to both directions"
                )
            })?;
            let section = sections.get(&number).ok_or_else(|| format!("there is no [[section]] of number {number}"))?;
            Ok(wayside::FacingSignals {
                section: number.into(),
                gradient_permille: section.gradient_permille.into(),
                curve_km_h: speed("limit_km_h", section.limit_km_h).map_err(|refusal| refusal.what)?.into(),
            })
        };
        let (left, right) = (facing(Heading::Left, "left")?, facing(Heading::Right, "right")?);
        circuits.insert(telegram.circuit.clone(), wayside::CircuitSignals { left, right });
    }
    let permitted = line.signal().map(|signal| permitted_of(line, signal)).ok_or(NO_SIGNAL)?;
    let signals = wayside::Signals {
        speeds_km_h: permitted.speeds_km_h,
        code_speeds_km_h: station.code_speeds().map(<[Kmh]>::to_vec),
        codes,
        circuits,
    };
    Ok(wayside::Config {
        layout: station.description().clone().into(),
        counted: None,
        signals,
        // The longest that the layout counts on; its turn time covers it.
        life_ms: model.values.telegram_age_ms,
        session: 0,
    })
}
