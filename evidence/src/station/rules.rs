//! Every rule of a layout: who asks for it, and what it is held against.

use crate::case::Asked;
use atc_kernel::interlocking::Rule as Kernel;
use atc_layout::Rule;

/// What a rule is held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// The file as a whole.
    File,
    /// Every circuit.
    Circuits,
    /// Every point.
    Points,
    /// Every segment.
    Segments,
    /// Every route.
    Routes,
    /// Every pair of routes.
    Pairs,
    /// Every place of every path.
    Places,
}

/// When a rule is checked: a later stage is not reached where an earlier one has found something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// While the file is read.
    Form,
    /// Names and joints.
    Tracks,
    /// Ways, geometry and times.
    Model,
    /// The room of the interlocking.
    Room,
    /// The kernel's own check of the plan.
    Plan,
}

/// The list of some rules with what stands beside them, and a match that no longer compiles when there is one more.
macro_rules! rules {
    ($list:ident, $complete:ident, $kind:ident, $beside:ty, [$($rest:pat)?]; $($rule:ident => $what:expr;)+) => {
        const $list: &[($kind, $beside)] = &[$(($kind::$rule, $what)),+];

        /// Never called: it is there for the compiler.
        #[allow(dead_code)]
        const fn $complete(rule: $kind) {
            match rule { $($kind::$rule => (),)+ $($rest => (),)? }
        }
    };
}

rules! { FILE, file_is_complete, Rule, (Asked, Stage, Scope), [Rule::Plan(_) | Rule::TelegramLives | Rule::ViewsApart];
    Form => (Asked::Form, Stage::Form, Scope::File);
    NameTwice => (Asked::Form, Stage::Tracks, Scope::File);
    NoSuchName => (Asked::Form, Stage::Tracks, Scope::File);
    Joint => (Asked::Form, Stage::Tracks, Scope::File);
    OpenJoint => (Asked::Form, Stage::Tracks, Scope::File);
    Range => (Asked::Form, Stage::Model, Scope::File);
    NoWay => (Asked::Engineering, Stage::Model, Scope::Routes);
    ManyWays => (Asked::Form, Stage::Model, Scope::Routes);
    TurningLoop => (Asked::Form, Stage::Model, Scope::File);
    SidesDiffer => (Asked::Form, Stage::Model, Scope::File);
    SharedWithin => (Asked::Form, Stage::Model, Scope::Segments);
    PositionContradicts => (Asked::Engineering, Stage::Model, Scope::Routes);
    DetectorsIncomplete => (Asked::Engineering, Stage::Model, Scope::Points);
    ApproachTooShort => (Asked::Engineering, Stage::Model, Scope::Routes);
    ApproachApart => (Asked::Engineering, Stage::Model, Scope::Routes);
    DriveUnderThrow => (Asked::Engineering, Stage::Model, Scope::Routes);
    ReleaseUnderThrow => (Asked::Engineering, Stage::Model, Scope::Routes);
    NoFlank => (Asked::Engineering, Stage::Model, Scope::Routes);
    OverlapNotAhead => (Asked::Engineering, Stage::Model, Scope::Routes);
    OverlapTooShort => (Asked::Engineering, Stage::Model, Scope::Routes);
    EntryNotPlain => (Asked::Engineering, Stage::Model, Scope::Routes);
    PointBeforeSignal => (Asked::Engineering, Stage::Model, Scope::Routes);
    SegmentElsewhere => (Asked::Engineering, Stage::Model, Scope::Routes);
    BeyondApart => (Asked::Engineering, Stage::Model, Scope::Routes);
    FoulingNotHeld => (Asked::Engineering, Stage::Model, Scope::Pairs);
    ProvedClearOwn => (Asked::Form, Stage::Model, Scope::Routes);
    ClearUnderShunt => (Asked::Engineering, Stage::Model, Scope::File);
    CircuitTooShort => (Asked::Engineering, Stage::Model, Scope::File);
    TurnUnderTelegram => (Asked::Engineering, Stage::Model, Scope::File);
    TurnUnderRun => (Asked::Engineering, Stage::Model, Scope::File);
    StandstillTooShort => (Asked::Engineering, Stage::Model, Scope::File);
    StartTooShort => (Asked::Engineering, Stage::Model, Scope::File);
    ResidualTooShort => (Asked::Engineering, Stage::Model, Scope::File);
    SegmentOrder => (Asked::Engineering, Stage::Model, Scope::Segments);
    RouteTwice => (Asked::Engineering, Stage::Model, Scope::Pairs);
    LineWithoutSegment => (Asked::Engineering, Stage::Plan, Scope::File);
    NoRoute => (Asked::Form, Stage::Room, Scope::File);
    TooMany => (Asked::Form, Stage::Room, Scope::File);
    PlanAgainstTracks => (Asked::Engineering, Stage::Plan, Scope::Routes);
}

rules! { PLAN, plan_is_complete, Kernel, (Asked, Scope), [];
    PathTooLong => (Asked::Theorems, Scope::Routes);
    NoTime => (Asked::Theorems, Scope::Routes);
    ClearShort => (Asked::Engineering, Scope::File);
    ReleaseShort => (Asked::Theorems, Scope::Routes);
    StayShort => (Asked::Theorems, Scope::Routes);
    PointBothWays => (Asked::Theorems, Scope::Routes);
    PointNotPositioned => (Asked::Theorems, Scope::Places);
    ConflictOneWay => (Asked::Theorems, Scope::Pairs);
    OpposingStarts => (Asked::Theorems, Scope::Pairs);
    ContinuesElsewhere => (Asked::Theorems, Scope::Pairs);
    CallingOnEnds => (Asked::Theorems, Scope::Routes);
    CallingOnAgainst => (Asked::Theorems, Scope::Pairs);
    CallingOnBerth => (Asked::Engineering, Scope::Routes);
    TurnsBack => (Asked::Engineering, Scope::Routes);
    ThroatsDiffer => (Asked::Engineering, Scope::Routes);
    SegmentShared => (Asked::Theorems, Scope::Segments);
    PointInSegment => (Asked::Engineering, Scope::Points);
    NotOneCircuit => (Asked::Theorems, Scope::Places);
    CircuitTwice => (Asked::Theorems, Scope::Places);
    OverlapUnderOwnPath => (Asked::Engineering, Scope::Routes);
    EntryNotInApproach => (Asked::Engineering, Scope::Routes);
    ApproachInPath => (Asked::Engineering, Scope::Routes);
    NothingBeyond => (Asked::Engineering, Scope::Routes);
    ConflictsWithItself => (Asked::Engineering, Scope::Routes);
    NotThere => (Asked::Engineering, Scope::Routes);
    NoDetector => (Asked::Engineering, Scope::Points);
    NoLength => (Asked::Engineering, Scope::Circuits);
    BrakingFalls => (Asked::Theorems, Scope::Routes);
    CodeOutOfTable => (Asked::Engineering, Scope::Routes);
    ManySegments => (Asked::Engineering, Scope::Routes);
}

/// All rules of a layout alone, in the order in which they are checked.
pub fn all() -> impl Iterator<Item = (Rule, Asked, Stage, Scope)> {
    let file = FILE.iter().map(|(rule, (asked, stage, scope))| (*rule, *asked, *stage, *scope));
    file.chain(PLAN.iter().map(|(rule, (asked, scope))| (Rule::Plan(*rule), *asked, Stage::Plan, *scope)))
}

/// The rules that theorems rest on: the name in the kernel, and the rule.
pub fn needed() -> impl Iterator<Item = (String, Rule)> {
    let needed = PLAN.iter().filter(|(_, (asked, _))| *asked == Asked::Theorems);
    needed.map(|(rule, _)| (format!("{rule:?}"), Rule::Plan(*rule)))
}

#[cfg(test)]
mod tests {
    use super::{Asked, PLAN};

    /// The kernel's own words say which rules the theorems need.
    #[test]
    fn who_asks_for_a_rule_is_what_the_kernel_says() {
        let kernel = include_str!("../../../kernel/src/interlocking/check.rs");
        let lines: Vec<_> = kernel.lines().map(str::trim).collect();
        for (rule, (asked, _)) in PLAN {
            let name = format!("{rule:?},");
            let place = lines.iter().position(|line| *line == name).unwrap_or_else(|| panic!("{name} is not there"));
            let says = lines[place - 1].trim_start_matches("/// ");
            let expected = if *asked == Asked::Theorems { "Needed: " } else { "Engineering: " };
            assert!(says.starts_with(expected), "{name} {says}");
        }
        let said = lines.iter().filter(|line| line.starts_with("/// Needed: ")).count();
        assert_eq!(said, super::needed().count());
    }
}
