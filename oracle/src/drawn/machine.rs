//! What a machine has to say for itself to be drawn.

use atc_film::Film;
use atc_protocol::machine::Machine;

use crate::chart::scene::Scene;
use crate::film::take::Take;
use crate::trace::run::Cycle;

/// A machine that is drawn.
pub trait Drawn: Machine {
    /// The timing chart of a case.
    fn chart(config: &Self::Config, cycles: &[Cycle<Self>]) -> Scene;

    /// Puts into a film what the machine shows besides the rows of its chart; false: nothing, and the film tells the
    /// values of each step as they stand on the wire.
    ///
    /// # Errors
    /// Why what the film is to be made with does not fit.
    fn film(_: &Take<'_, Self>, _: &mut Film) -> Result<bool, String> {
        Ok(false)
    }
}
