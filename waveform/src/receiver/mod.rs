//! Receivers: from samples to codes, bits, telegrams and speeds. All of them stream and allocate nothing in the loop; what
//! they say does not depend on how the samples are cut into blocks.
//!
//! | receiver | hears |
//! |---|---|
//! | [`Conventional`] | the analog codes: what a train without digital equipment needs (SIG-4) |
//! | [`OnBoard`] | codes and telegrams of both carriers |
//! | [`TrackCircuit`] | whether its own transmitter's signal arrives (SIG-3) |

mod branch;
mod carrier;
mod code;
mod conventional;
mod front;
mod keeper;
mod level;
mod msk;
mod on_board;
mod table;
mod track_circuit;

pub use carrier::{CarrierEvent, CarrierReceiver, Keying, Squelch};
pub use code::{CodeConfidence, CodeDetector, CodeReading};
pub use conventional::{CodeEvent, Conventional};
pub use front::Front;
pub use level::LevelMeter;
pub use msk::{DecidedBit, MskDemodulator};
pub use on_board::{Event, Heard, OnBoard};
pub use table::{CODE_TOLERANCE, MAIN_CODES, SUB_CODES, example_code_table};
pub use track_circuit::{TrackCircuit, TrackCircuitError, TrackCircuitParams, TrackState};

/// The samples of a complex envelope.
pub use realfft::num_complex::Complex32;
