//! Many cycles at once: arrays of numbers in, arrays of numbers out, all in little-endian bytes.
//!
//! A row is a logic cycle. Either all rows are taken, or none: after an error the machine is as it was before.

use atc_kernel::aspect::{self, AspectId, AspectSet, AspectTable, MAX_ASPECTS, State, Times};
use atc_kernel::block::{self, Block, Fault, Hold, Input, SectionSet, Status, TrainCount};
use atc_kernel::distance::Metres;
use atc_kernel::pattern::{Deceleration, pattern};
use atc_kernel::telegram::Gradient;
use atc_line::refusal::brake;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::de::DeserializeOwned;

fn refused(reason: impl Into<String>) -> PyErr {
    PyValueError::new_err(reason.into())
}

fn config<C: DeserializeOwned>(text: &str) -> PyResult<C> {
    serde_json::from_str(text).map_err(|error| refused(error.to_string()))
}

/// The rows of a column of `N` bytes each.
fn rows<const N: usize>(bytes: &[u8]) -> PyResult<impl Iterator<Item = [u8; N]>> {
    if bytes.len() % N != 0 {
        return Err(refused(format!("{} bytes are no whole rows; a row has {N}", bytes.len())));
    }
    Ok(bytes.chunks_exact(N).map(|row| {
        let mut whole = [0; N];
        whole.copy_from_slice(row);
        whole
    }))
}

/// A flag: 0 or 1.
fn flag(number: u8, row: usize, name: &str) -> PyResult<bool> {
    match number {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(refused(format!("row {row}: {name} is {number}; it must be 0 or 1"))),
    }
}

/// Aspect acceptance.
#[pyclass(module = "atc._atc")]
pub struct AspectColumns {
    table: AspectTable,
    times: Times,
    state: State<MAX_ASPECTS>,
}

#[pymethods]
impl AspectColumns {
    /// From a configuration in JSON, as the protocol has it.
    #[new]
    fn new(text: &str) -> PyResult<Self> {
        let config: atc_line::aspect::Config = config(text)?;
        let (table, times) = (config.table().map_err(refused)?, config.times().map_err(refused)?);
        Ok(Self { table, times, state: State::INITIAL })
    }

    /// Sets of aspects heard (u16, bit i for the aspect of rank i) into ranks displayed (i8, -1 for none).
    fn run<'py>(&mut self, py: Python<'py>, detected: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
        let (known, mut state) = (self.table.speeds().len(), self.state);
        let mut shown = Vec::with_capacity(detected.len() / 2);
        for (row, bits) in rows::<2>(detected)?.map(u16::from_le_bytes).enumerate() {
            if u32::from(bits) >> known != 0 {
                return Err(refused(format!("row {row}: detected is {bits:#b}, and the line has {known} aspects")));
            }
            let (next, display) = aspect::step(self.times, state, AspectSet::from_bits(bits));
            state = next;
            shown.push(display.aspect().map_or(u8::MAX, AspectId::rank));
        }
        self.state = state;
        Ok(PyBytes::new(py, &shown))
    }
}

/// Block counting, one block.
#[pyclass(module = "atc._atc")]
pub struct BlockColumns {
    block: Block,
    state: block::State,
}

#[pymethods]
impl BlockColumns {
    /// From a configuration in JSON, as the protocol has it.
    #[new]
    fn new(text: &str) -> PyResult<Self> {
        let config: atc_line::block::Config = config(text)?;
        Ok(Self { block: config.block().map_err(refused)?, state: block::State::INITIAL })
    }

    /// Rows of 8 bytes (present u16, check_in u8, check_out u8, reset i16, ahead_hold_sections u8, ahead_entered u8) into rows
    /// of 6 (occupied u16, behind_hold_sections u8, agree u8, count u8, status u8).
    fn run<'py>(&mut self, py: Python<'py>, inputs: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
        let mut state = self.state;
        let mut outputs = Vec::with_capacity(inputs.len() / 8 * 6);
        for (row, bytes) in rows::<8>(inputs)?.enumerate() {
            let (next, output) = block::step(self.block, state, self.input(row, bytes)?);
            state = next;
            outputs.extend(output.occupied.bits().to_le_bytes());
            outputs.push(output.behind_hold.sections());
            outputs.push(output.agree.into());
            outputs.push(output.count.0);
            outputs.push(match output.status {
                Status::Unverified => 0,
                Status::Counting => 1,
                Status::Fault(Fault::CheckOutAtZero) => 2,
                Status::Fault(Fault::CheckInAtMaximum) => 3,
                Status::Fault(Fault::CheckInStaysOn) => 4,
            });
        }
        self.state = state;
        Ok(PyBytes::new(py, &outputs))
    }
}

impl BlockColumns {
    fn input(&self, row: usize, bytes: [u8; 8]) -> PyResult<Input> {
        let [p0, p1, check_in, check_out, r0, r1, hold, entered] = bytes;
        let present = SectionSet::from_bits(u16::from_le_bytes([p0, p1]));
        if !present.without(self.block.all()).is_empty() {
            let sections = self.block.sections();
            let bits = present.bits();
            return Err(refused(format!("row {row}: present is {bits:#b}, and the block has {sections} sections")));
        }
        let reset = match i16::from_le_bytes([r0, r1]) {
            -1 => None,
            verified => Some(TrainCount(u8::try_from(verified).map_err(|_| {
                refused(format!("row {row}: reset is {verified}; it must be 0 to 255, or -1 for none"))
            })?)),
        };
        let ahead_hold = Hold::new(hold)
            .ok_or_else(|| refused(format!("row {row}: ahead_hold_sections is {hold}; it must be 0 to 16")))?;
        Ok(Input {
            check_in: flag(check_in, row, "check_in")?,
            check_out: flag(check_out, row, "check_out")?,
            present,
            reset,
            ahead_hold,
            ahead_entered: flag(entered, row, "ahead_entered")?,
        })
    }
}

/// The braking pattern.
#[pyclass(module = "atc._atc")]
pub struct PatternColumns {
    brake: Deceleration,
}

#[pymethods]
impl PatternColumns {
    /// The train's service brake on the level, in mm/s².
    #[new]
    fn new(brake_mm_s2: u32) -> PyResult<Self> {
        Ok(Self { brake: brake("brake_mm_s2", brake_mm_s2).map_err(refused)? })
    }

    /// Distances (u16, metres) and gradients (i8, thousandths) into speeds (u16, tenths of km/h).
    fn run<'py>(&self, py: Python<'py>, distances: &[u8], gradients: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
        let distances: Vec<u16> = rows::<2>(distances)?.map(u16::from_le_bytes).collect();
        if distances.len() != gradients.len() {
            let (one, other) = (distances.len(), gradients.len());
            return Err(refused(format!("{one} distances and {other} gradients; there must be as many of each")));
        }
        let speeds = distances.iter().zip(gradients).flat_map(|(distance, gradient)| {
            let gradient = Gradient(i8::from_le_bytes([*gradient]));
            pattern(self.brake.on(gradient), Metres(*distance)).0.to_le_bytes()
        });
        Ok(PyBytes::new(py, &speeds.collect::<Vec<u8>>()))
    }
}
