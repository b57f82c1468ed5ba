//! From measured level differences of a railway's own line to the table that the kernel reads.
//!
//! A *pass* is one run over the section in one weather. Through each pass goes a broken line with its corners at the
//! table's knots: least squares, rising. The table's curves are the lowest and the highest of these lines at each knot,
//! and as much wider as the lines themselves are uncertain there.
//!
//! *The spread of a line.* With hat functions as columns of A, the normal matrix AᵀA has its inverse C, and a knot of
//! the line is known to s·√C_kk (one standard deviation), s² being the residuals' sum of squares over their degrees of
//! freedom. The curves are [`DEVIATIONS`] of them wider. This supposes that the errors of two measurements have nothing
//! to do with each other.
//!
//! *Rising.* Where the line of a pass falls from one knot to a later one by more than [`DEVIATIONS`] of that fall, the
//! measurements contradict the principle and are refused. A fall within the spread is levelled: the knots become one
//! (pooling of adjacent violators), and the line is fitted again. The curves rise by 0.01 dB a knot at least, and are
//! wider for it where they must.
//!
//! *The tolerance.* A difference is two levels, and the kernel takes each to be off by the tolerance. So twice the
//! tolerance is the largest residual, or [`DEVIATIONS`] times their root mean square if that is more.
//!
//! *The ends.* A knot is a part of the table if the measurements reach it in every pass. What is nearer and what is
//! farther is made flat, and there the position is unknown (POS-6, POS-7). With [`Wanted::section`] no train that hears
//! the transmitter is beyond the section's far end: there the curves rise out of the way, so that in wet weather, too,
//! an interval ends with the section.

mod error;
mod fit;
mod grid;
mod pass;
mod picture;
mod sides;
mod solve;
#[cfg(test)]
mod tests;

pub use error::FitError;
pub use fit::{Fit, Residuals, Wanted};
pub use pass::{DEVIATIONS, Measurement, PassFit};
pub use picture::picture;
pub use sides::{CHANGES, Side, Without, sides};
