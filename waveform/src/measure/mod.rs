//! Measurements: how well the receivers hear. Every result can be serialised, and the same seed gives the same result;
//! only [`throughput`] depends on the machine.

mod bench;
mod ber;
mod detection;
mod frames;
mod spectrum;
mod theory;
mod throughput;

pub use bench::{Bench, BitErrorCurve, Extent, bench};
pub use ber::{BitErrorPoint, BitErrorRun, bit_errors};
pub use detection::{DetectionPoint, DetectionRun, FalseCodes, Times, detection, false_codes};
pub use frames::{FramePoint, FrameRun, codes_heard, frames, latency};
pub use spectrum::{Picture, envelope, picture, spectrum};
pub use theory::{
    coherent, differentially_decoded, differentially_decoded_under_code, frames_lost, one_bit_differential, q_function,
    ratio_for,
};
pub use throughput::{Throughput, throughput};
