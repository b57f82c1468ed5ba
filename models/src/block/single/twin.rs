//! The twin of a model of one block in Promela.

use super::{Beyond, Single};
use crate::block::device::Counting;
use crate::block::fault::Faults;
use crate::twin::Twin;

const PROMELA: &str = include_str!("../../../promela/block.pml");

impl<D: Counting> Single<D> {
    /// The twin, if the model is one of those that it has parameters for: the kernel's machine, trains that run through, and every
    /// set of up to so many faults.
    pub(super) fn promela(&self) -> Option<Twin> {
        let budget = (0..=2).find(|budget| self.faults == Faults::up_to(*budget, self.sections, 1))?;
        let parameters = [
            ("SECTIONS", self.sections),
            ("TRAINS", self.trains),
            ("TAIL", self.tail),
            ("HOLD", self.hold),
            ("PASS", self.pass),
            ("APART", self.apart),
            ("BUDGET", budget),
        ];
        let plain = D::HAS_TWIN && self.share && self.beyond == Beyond::Nothing && self.sections <= 5;
        plain.then(|| Twin { promela: PROMELA.into(), parameters: parameters.into(), chooses: budget > 0 })
    }
}
