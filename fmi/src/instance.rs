//! An instance of the unit: mode, time, values, the device, and the states that were kept. No pointer is in it.

use std::collections::BTreeMap;

use atc_protocol::machine::Machine as _;
use atc_protocol::machine::train::OnBoard;

use crate::variables::{Causality, VARIABLES, Value, Values};
use crate::{config, cycle};

/// FMI's status of a call, as C has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// Not done; nothing has changed but that the outputs are the safe ones, and the call may be made again.
    Discard = 2,
    /// The call was wrong.
    Error = 3,
}

impl Status {
    /// The category of its messages.
    pub const fn category(self) -> &'static str {
        match self {
            Self::Ok => "logAll",
            Self::Discard => "logStatusDiscard",
            Self::Error => "logStatusError",
        }
    }
}

/// The categories of messages, and what they are.
pub const CATEGORIES: [(&str, &str); 3] = [
    ("logStatusDiscard", "A step that is refused: why, and what would be right."),
    ("logStatusError", "A call that is wrong: why, and what would be right."),
    ("logAll", "Every message."),
];

/// What an instance may be asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Just made, or reset.
    Instantiated,
    /// Between fmi3EnterInitializationMode and fmi3ExitInitializationMode.
    Initialization,
    /// It takes steps.
    Step,
    /// It takes no more steps.
    Terminated,
    /// An input could not be set. It takes no step before it is reset, or a kept state is put back.
    Failed,
}

/// What fmi3GetFMUState keeps.
#[derive(Clone, Debug)]
struct State {
    mode: Mode,
    device: OnBoard,
    values: Values,
    /// The end of the last step in s.
    time: f64,
}

/// An instance.
#[derive(Debug)]
pub struct Instance {
    name: String,
    first: State,
    now: State,
    /// One logic cycle in s.
    cycle: f64,
    kept: BTreeMap<usize, State>,
    next: usize,
    messages: Vec<(Status, String)>,
}

/// How far from a logic cycle a step may be, and from the end of the last step its beginning: in logic cycles.
pub const TOLERANCE: f64 = 1e-6;

impl Instance {
    /// The device in its initial state, with the configuration that stands in this text.
    ///
    /// # Errors
    /// The rule that the configuration breaks, in a sentence.
    pub fn new(name: &str, text: &[u8]) -> Result<Self, String> {
        let (device, cycle_ms) = config::device(text)?;
        let mut values = Values::default();
        cycle::show(&mut values, &cycle::SAFE);
        let first = State { mode: Mode::Instantiated, device, values, time: 0.0 };
        let (kept, messages) = (BTreeMap::new(), Vec::new());
        let (name, now, cycle) = (name.to_owned(), first.clone(), f64::from(cycle_ms) / 1000.0);
        Ok(Self { name, first, now, cycle, kept, next: 1, messages })
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its mode.
    pub fn mode(&self) -> Mode {
        self.now.mode
    }

    /// The end of the last step in s.
    pub fn time(&self) -> f64 {
        self.now.time
    }

    /// The messages since they were taken last.
    pub fn messages(&mut self) -> Vec<(Status, String)> {
        std::mem::take(&mut self.messages)
    }

    fn say(&mut self, status: Status, what: impl Into<String>) -> Status {
        self.messages.push((status, what.into()));
        status
    }

    /// A call that is wrong, and changes nothing.
    pub fn wrong(&mut self, what: impl Into<String>) -> Status {
        self.say(Status::Error, what)
    }

    /// A change of the mode.
    fn change(&mut self, call: &str, from: &[Mode], to: Mode) -> Status {
        if from.contains(&self.now.mode) {
            self.now.mode = to;
            return Status::Ok;
        }
        let (now, right) =
            (self.now.mode, from.iter().map(|mode| format!("{mode:?}")).collect::<Vec<_>>().join(" or "));
        self.wrong(format!("{call} was called in mode {now:?}; it is for mode {right}"))
    }

    /// fmi3EnterInitializationMode. A tolerance and a stop time change nothing here.
    pub fn enter_initialization(&mut self, start: f64) -> Status {
        if !start.is_finite() {
            return self.wrong(format!("startTime is {start} s; it must be a finite number"));
        }
        let status = self.change("fmi3EnterInitializationMode", &[Mode::Instantiated], Mode::Initialization);
        if status == Status::Ok {
            self.now.time = start;
            self.now.values.set(crate::variables::Place::Time, Value::Float64(start));
        }
        status
    }

    /// fmi3ExitInitializationMode.
    pub fn exit_initialization(&mut self) -> Status {
        self.change("fmi3ExitInitializationMode", &[Mode::Initialization], Mode::Step)
    }

    /// fmi3Terminate.
    pub fn terminate(&mut self) -> Status {
        self.change("fmi3Terminate", &[Mode::Step, Mode::Failed], Mode::Terminated)
    }

    /// fmi3Reset: as it was made. States that were kept stay.
    pub fn reset(&mut self) -> Status {
        self.now = self.first.clone();
        Status::Ok
    }

    /// A value by its reference.
    ///
    /// # Errors
    /// There is no such variable.
    pub fn get(&self, reference: u32) -> Result<&Value, String> {
        let last = VARIABLES.len().saturating_sub(1);
        self.now
            .values
            .get(reference)
            .ok_or_else(|| format!("there is no value reference {reference}; they are 0 to {last}"))
    }

    /// Sets all of these, or none if one of them is wrong: no such input, or a value of another type. Values are judged in the step.
    ///
    /// # Errors
    /// The first that is wrong, in a sentence.
    fn try_set(&mut self, values: Vec<(u32, Value)>) -> Result<(), String> {
        let modes = [Mode::Instantiated, Mode::Initialization, Mode::Step];
        if !modes.contains(&self.now.mode) {
            return Err(format!("an input was set in mode {:?}; fmi3Reset begins anew", self.now.mode));
        }
        let mut found = Vec::with_capacity(values.len());
        for (reference, value) in values {
            let old = self.get(reference)?;
            let place = usize::try_from(reference).map_err(|error| error.to_string())?;
            let variable = VARIABLES.get(place).ok_or("no such variable")?;
            if variable.causality != Causality::Input {
                return Err(format!("{} is no input; only inputs are set", variable.name));
            }
            if std::mem::discriminant(old) != std::mem::discriminant(&value) {
                return Err(format!(
                    "{} is set as another type; it is of type {}",
                    variable.name,
                    variable.kind.name()
                ));
            }
            found.push((place, value));
        }
        for (place, value) in found {
            self.now.values.put(place, value);
        }
        Ok(())
    }

    /// Sets inputs. A call that is wrong sets none of them; then the outputs are the safe ones, and no step is taken before fmi3Reset or
    /// fmi3SetFMUState: the step would be with other values than the simulation means.
    pub fn set(&mut self, values: Result<Vec<(u32, Value)>, String>) -> Status {
        match values.and_then(|values| self.try_set(values)) {
            Ok(()) => Status::Ok,
            Err(what) => self.not_set(what),
        }
    }

    /// An input that could not be set.
    pub fn not_set(&mut self, what: impl Into<String>) -> Status {
        cycle::show(&mut self.now.values, &cycle::SAFE);
        if self.now.mode != Mode::Terminated {
            self.now.mode = Mode::Failed;
        }
        self.wrong(what)
    }

    /// fmi3DoStep: one logic cycle from `at`, which is `long`, both in s. If it is refused, the device has not stepped, the time is as before,
    /// and the outputs are the safe ones.
    pub fn step(&mut self, at: f64, long: f64) -> Status {
        let (status, what) = match self.try_step(at, long) {
            Ok(()) => return Status::Ok,
            Err(refused) => refused,
        };
        self.refuse(status, what)
    }

    /// A step that is refused.
    pub fn refuse(&mut self, status: Status, what: String) -> Status {
        cycle::show(&mut self.now.values, &cycle::SAFE);
        self.say(status, what)
    }

    fn try_step(&mut self, at: f64, long: f64) -> Result<(), (Status, String)> {
        let discard = |what: String| (Status::Discard, what);
        match self.now.mode {
            Mode::Step => {}
            Mode::Failed => {
                let what = "fmi3DoStep was called after an input could not be set; fmi3Reset begins anew";
                return Err((Status::Error, what.to_owned()));
            }
            mode => {
                return Err((Status::Error, format!("fmi3DoStep was called in mode {mode:?}; it is for mode Step")));
            }
        }
        let (time, cycle, near) = (self.now.time, self.cycle, TOLERANCE * self.cycle);
        // What is no number is not within it.
        let within = |given: f64, right: f64| (right - near..=right + near).contains(&given);
        if !within(at, time) {
            let what = format!("currentCommunicationPoint is {at} s; it must be {time} s, the end of the last step");
            return Err(discard(what));
        }
        if !within(long, cycle) {
            let what = format!("communicationStepSize is {long} s; it must be {cycle} s, one logic cycle");
            return Err(discard(what));
        }
        let step = cycle::step(&self.now.values).map_err(discard)?;
        let output = self.now.device.step(&step).map_err(discard)?;
        cycle::show(&mut self.now.values, &output);
        self.now.time = at + long;
        self.now.values.set(crate::variables::Place::Time, Value::Float64(self.now.time));
        Ok(())
    }

    /// fmi3GetFMUState: keeps the state, and gives its number. A state that was kept before under `old` is replaced; 0 is none.
    ///
    /// # Errors
    /// There is no state of that number.
    pub fn keep(&mut self, old: usize) -> Result<usize, Status> {
        let number = match old {
            0 => {
                self.next = self.next.saturating_add(1);
                self.next.saturating_sub(1)
            }
            old if self.kept.contains_key(&old) => old,
            old => return Err(self.unknown(old)),
        };
        self.kept.insert(number, self.now.clone());
        Ok(number)
    }

    /// fmi3SetFMUState: puts a state back.
    pub fn put_back(&mut self, number: usize) -> Status {
        let Some(state) = self.kept.get(&number) else { return self.unknown(number) };
        self.now = state.clone();
        Status::Ok
    }

    /// fmi3FreeFMUState: forgets a state; 0 is none.
    pub fn forget(&mut self, number: usize) -> Status {
        if number == 0 || self.kept.remove(&number).is_some() { Status::Ok } else { self.unknown(number) }
    }

    fn unknown(&mut self, number: usize) -> Status {
        self.wrong(format!("{number:#x} is no state that fmi3GetFMUState of this instance has kept, or it was freed"))
    }
}
