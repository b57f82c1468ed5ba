//! What the train remembers of what it heard.

use super::{LineKind, Permitted};
use crate::distance::{Metres, Millimetres};
use crate::speed::KmhTenths;
use crate::telegram::{Gradient, SectionId, Stream};
use crate::time::Ticks;

/// The state, all of it. Proofs and replays may write any; [`State::is_valid`] says which ones occur.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// The kind of line that the train is on.
    pub line: LineKind,
    /// The distance to the exit that was measured first after the last main telegram, less what the train moved since.
    pub fix: Option<Millimetres>,
    /// The last main telegram that was used. Telegrams are missing for as long as it is old, and lost when it is forgotten.
    pub target: Option<Target>,
    /// The last one of the section before the target's.
    pub behind: Option<Target>,
    /// The last sub telegrams that were used, of two sections, the newest first.
    pub fixed: [Option<Fixed>; 2],
    /// The counters of the main telegrams.
    pub main_stream: Stream,
    /// The counters of the sub telegrams.
    pub sub_stream: Stream,
}

/// What a main telegram asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Target {
    /// The section that the telegram is for.
    pub section: SectionId,
    /// How far beyond the exit of that section the stopping point is.
    pub beyond: Metres,
    /// The speed that the ground permits.
    pub limit: KmhTenths,
    /// The stopping point is no nearer than this.
    pub to_stop: Millimetres,
    /// The telegram was sent this many cycles ago, or later.
    pub age: Ticks,
}

/// What a sub telegram says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Fixed {
    /// The section that the telegram is for.
    pub section: SectionId,
    /// The gradient.
    pub gradient: Gradient,
    /// The lower one of the two limits.
    pub limit: KmhTenths,
    /// The telegram was sent this many cycles ago, or later.
    pub age: Ticks,
}

impl State {
    /// Nothing is known.
    pub const INITIAL: Self = Self {
        line: LineKind::Digital,
        fix: None,
        target: None,
        behind: None,
        fixed: [None; 2],
        main_stream: Stream::EMPTY,
        sub_stream: Stream::EMPTY,
    };

    /// Whether `permitted` can be in this state: nothing is older than its life, the streams are valid, and the two sub
    /// telegrams are of two sections.
    pub fn is_valid(&self, permitted: &Permitted) -> bool {
        let [newest, other] = &self.fixed;
        let alive = |target: &Option<Target>| target.is_none_or(|target| target.age.0 <= permitted.life().0);
        let young = |fixed: &Option<Fixed>| fixed.is_none_or(|fixed| fixed.age.0 <= permitted.fixed_life().0);
        let two = match (newest, other) {
            (Some(newest), Some(other)) => newest.section.0 != other.section.0,
            _ => true,
        };
        alive(&self.target)
            && alive(&self.behind)
            && young(newest)
            && young(other)
            && two
            && self.main_stream.is_valid(permitted.sequence())
            && self.sub_stream.is_valid(permitted.sequence())
    }
}
