//! Machines that are drawn: what a recorded case of each looks like as a chart and as a film. One line in [`DRAWINGS`] for each.

use atc_film::Film;
use atc_protocol::machine::{Machine, aspect, block, interlocking, pattern, permitted, position, supervision};
use atc_protocol::machine::{telegram, train, wayside};

use crate::chart::Scene;
use crate::film::{Setting, Take};
use crate::trace::{Record, Replies, TraceError};

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

/// One logic cycle of a recorded case.
pub struct Cycle<M: Machine> {
    /// What was read.
    pub step: M::Step,
    /// What the kernel puts out.
    pub output: M::Output,
    /// What the record says was put out, if it says anything.
    pub recorded: Option<M::Output>,
}

/// How recorded cases of a machine are drawn.
#[derive(Clone, Copy, Debug)]
pub struct Drawing {
    /// The machine's name.
    pub name: &'static str,
    /// Checks a recorded case against the kernel and draws it.
    pub chart: fn(&Record, Replies) -> Result<Scene, TraceError>,
    /// Checks a recorded case against the kernel and makes its film.
    pub film: fn(&Record, &Setting) -> Result<Film, TraceError>,
}

/// Every machine's.
pub const DRAWINGS: &[Drawing] = &[
    drawing::<aspect::Aspect>(),
    drawing::<supervision::Supervised>(),
    drawing::<block::Counted>(),
    drawing::<telegram::Codec>(),
    drawing::<pattern::Braking>(),
    drawing::<permitted::Permitting>(),
    drawing::<position::Positioned>(),
    drawing::<interlocking::Interlocked>(),
    drawing::<train::OnBoard>(),
    drawing::<wayside::Ground>(),
];

/// The machine of that name.
pub fn find(name: &str) -> Option<&'static Drawing> {
    DRAWINGS.iter().find(|drawing| drawing.name == name)
}

const fn drawing<M: Drawn>() -> Drawing {
    Drawing { name: M::NAME, chart: crate::trace::chart::<M>, film: crate::trace::film::<M> }
}

#[cfg(test)]
mod tests {
    use super::DRAWINGS;
    use atc_protocol::machine::KINDS;

    #[test]
    fn every_machine_of_the_protocol_is_drawn() {
        let drawn: Vec<_> = DRAWINGS.iter().map(|drawing| drawing.name).collect();
        assert_eq!(drawn, KINDS.iter().map(|kind| kind.name).collect::<Vec<_>>());
    }
}
