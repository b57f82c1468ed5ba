//! The configuration of the device: that of the machine `train` of protocol 1.

use atc_protocol::machine::train::{Config, OnBoard};
use atc_protocol::machine::{Machine as _, config_of};
use serde_json::value::RawValue;

/// The longest configuration that is read, in bytes.
pub const LONGEST: u64 = 1 << 20;

/// The device in its initial state, with its logic cycle in ms.
///
/// # Errors
/// The text is no configuration of the machine, or breaks one of its rules: the machine's own sentence.
pub fn device(text: &[u8]) -> Result<(OnBoard, u32), String> {
    let text = std::str::from_utf8(text).map_err(|error| format!("the config is no UTF-8 text: {error}"))?.trim();
    let body: &RawValue = serde_json::from_str(text).map_err(|error| format!("the config is no JSON: {error}"))?;
    let config: Config = config_of::<OnBoard>(text, body).map_err(|fault| match fault.column {
        // Columns are of the machine's reading of one line.
        Some(column) if !text.contains('\n') => format!("column {column}: {}", fault.what),
        _ => fault.what,
    })?;
    OnBoard::open(&config).map(|device| (device, config.permitted.cycle_ms))
}
