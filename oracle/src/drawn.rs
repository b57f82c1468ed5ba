//! Machines that are drawn: what a recorded case of each looks like as a chart and as a film. One line in [`DRAWINGS`] for each.

use atc_film::Film;
use atc_protocol::machine::{aspect, block, interlocking, pattern, permitted, position, supervision};
use atc_protocol::machine::{telegram, train, wayside};

use crate::chart::scene::Scene;
use crate::film::made::made;
use crate::film::take::{Setting, Take};
use crate::trace::error::{Replies, TraceError};
use crate::trace::run::{Recorded, Run, run};

pub(crate) mod machine;

pub use machine::Drawn;

/// How recorded cases of a machine are drawn.
#[derive(Clone, Copy, Debug)]
pub struct Drawing {
    /// The machine's name.
    pub name: &'static str,
    /// Checks a recorded case against the kernel and draws it.
    pub chart: fn(&Recorded, Replies) -> Result<Scene, TraceError>,
    /// Checks a recorded case against the kernel and makes its film.
    pub film: fn(&Recorded, &Setting) -> Result<Film, TraceError>,
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
    drawing::<interlocking::Sizes>(),
    drawing::<train::OnBoard>(),
    drawing::<wayside::Sizes>(),
];

/// The machine of that name.
pub fn find(name: &str) -> Option<&'static Drawing> {
    DRAWINGS.iter().find(|drawing| drawing.name == name)
}

const fn drawing<M: Drawn>() -> Drawing {
    Drawing { name: M::NAME, chart: chart::<M>, film: film::<M> }
}

/// Runs a record through the kernel, compares, and lays out the chart.
fn chart<M: Drawn>(record: &Recorded, replies: Replies) -> Result<Scene, TraceError> {
    let Run { config, cycles, .. } = run::<M>(record, replies)?;
    Ok(M::chart(&config, &cycles))
}

/// Runs a record through the kernel, compares, and lays out the film.
fn film<M: Drawn>(record: &Recorded, setting: &Setting) -> Result<Film, TraceError> {
    let Run { config, cycles, steps } = run::<M>(record, setting.replies)?;
    let take = Take { config: &config, cycles: &cycles, steps: &steps, setting };
    made(&take).map_err(|what| record.error(what))
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
