//! The rules of a layout file: those of the kernel, and those that need names, geometry and times.

use atc_kernel::interlocking::Rule as Kernel;

/// A rule of a layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// The file has the form of a layout.
    Form,
    /// A name stands for one thing of its kind.
    NameTwice,
    /// What is named exists.
    NoSuchName,
    /// A value is within its range.
    Range,
    /// A joint connects two ends.
    Joint,
    /// A joint that only one end reaches is declared as an end of the tracks.
    OpenJoint,
    /// Circuits that follow each other in a path adjoin, and a train can run through them in that order.
    NoWay,
    /// The way through a path is the only one.
    ManyWays,
    /// No track can be run in one direction of travel and come back to in the other.
    TurningLoop,
    /// What is left in one circuit is left in all.
    SidesDiffer,
    /// What the neighbour's device sees too of a segment are its outermost circuits.
    SharedWithin,
    /// Two stations see a line so that no stretch of it is seen by neither. Held where both layouts are at hand.
    ViewsApart,
    /// The overlap goes on from the end of the path.
    OverlapNotAhead,
    /// A position that the file gives is the one that the path runs over.
    PositionContradicts,
    /// A point's detectors cover the circuit it lies in and those in which it is fouled.
    DetectorsIncomplete,
    /// The approach covers the braking distance, what the train runs while its telegram ages and while it is not reported, and the track before the
    /// signal, where a driver may change ends and go by it.
    ApproachTooShort,
    /// Circuits of an approach lead to the signal.
    ApproachApart,
    /// The drive time of a route is not shorter than the stroke of a point that it needs.
    DriveUnderThrow,
    /// The release time is longer than the stroke that a point finishes after its drive was withdrawn.
    ReleaseUnderThrow,
    /// A track from which a vehicle can run into the path is kept off by a point, or the file says why not.
    NoFlank,
    /// The overlap is as long as the least one, or the file says why not.
    OverlapTooShort,
    /// Two circuits that foul each other are of routes, and not of plain line.
    FoulingNotHeld,
    /// What a route proves clear beside its path is not its own.
    ProvedClearOwn,
    /// T_clear is longer than the longest tolerated loss of shunt.
    ClearUnderShunt,
    /// No train runs through a whole circuit while it is lost, or between two cycles.
    CircuitTooShort,
    /// Plain line turns only after the neighbour's telegrams are too old to be acted on.
    TurnUnderTelegram,
    /// Plain line turns, and a block on it is confirmed, only when a train that was sent before has come in and is seen, or stands.
    TurnUnderRun,
    /// After a start nothing moves until every release time and the turn time have passed, or the file says why not.
    StartTooShort,
    /// A train counts as standing no earlier than it can stand at the end of its route.
    StandstillTooShort,
    /// The residual running covers the age of a telegram and the braking from the highest speed.
    ResidualTooShort,
    /// The ground counts on telegrams for as long as trains act on them. Held where the trains' times are known.
    TelegramLives,
    /// The circuits of a segment follow each other outward from the station.
    SegmentOrder,
    /// Where the line goes on unseen, a segment of plain line ends: trains come from there.
    LineWithoutSegment,
    /// The entry of a route is plain track: no point lies in it, and no other track crosses it.
    EntryNotPlain,
    /// No point and no crossing lies between the end of a route and the first signal on the way back, or the file says why no train changes ends there.
    PointBeforeSignal,
    /// A route comes from the segment whose first circuit is its entry, and goes out to the one whose first circuit follows its end.
    SegmentElsewhere,
    /// Circuits beyond the end of a route adjoin it.
    BeyondApart,
    /// No two routes lead from one signal over one path.
    RouteTwice,
    /// There is a route: without one nothing can be set.
    NoRoute,
    /// The layout fits the interlocking.
    TooMany,
    /// The plan is what vehicles meet on the tracks of the file: read a second time, by other code.
    PlanAgainstTracks,
    /// A rule of the kernel's plan.
    Plan(Kernel),
}

impl Rule {
    /// A short name, the same in every release: it stands at the end of a message.
    pub fn name(self) -> String {
        let Self::Plan(kernel) = self else { return kebab(&format!("{self:?}")) };
        format!("plan-{}", kebab(&format!("{kernel:?}")))
    }

    /// What the rule demands.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Form => "the file has the form of a layout",
            Self::NameTwice => "a name stands for one thing of its kind",
            Self::NoSuchName => "what is named exists",
            Self::Range => "a value is within its range",
            Self::Joint => "a joint connects two ends",
            Self::OpenJoint => "a joint that only one end reaches is declared as an end of the tracks",
            Self::NoWay => {
                "circuits that follow each other in a path adjoin, and a train can run through them in that order"
            }
            Self::ManyWays => "the way through a path is the only one",
            Self::TurningLoop => "no train comes back to a track facing the other way without having turned back",
            Self::SidesDiffer => "what is left in one circuit is left in all that hang together with it",
            Self::SharedWithin => "what the neighbour's device sees too are the outermost circuits of a segment",
            Self::ViewsApart => {
                "two stations see a line so that no stretch of it is seen by neither, and with the same left"
            }
            Self::OverlapNotAhead => "the overlap goes on from the end of the path",
            Self::PositionContradicts => "a position that the file gives is the one that the path runs over",
            Self::DetectorsIncomplete => {
                "a point's detectors cover the circuit it lies in and those in which it is fouled"
            }
            Self::ApproachTooShort => {
                "the approach covers the braking distance, the age of a telegram, the longest loss of shunt, and the track before the signal"
            }
            Self::ApproachApart => "the circuits of an approach lead to the signal",
            Self::DriveUnderThrow => "the drive time is not shorter than the stroke of the points",
            Self::ReleaseUnderThrow => {
                "the release time is longer than the stroke of a point whose drive was withdrawn"
            }
            Self::NoFlank => "a track from which a vehicle can run into the path is kept off, or the file says why not",
            Self::OverlapTooShort => "the overlap is as long as the least one, or the file says why not",
            Self::FoulingNotHeld => "two circuits that foul each other are of routes, and not of plain line",
            Self::ProvedClearOwn => "what a route proves clear beside its path is not its own path, overlap or entry",
            Self::ClearUnderShunt => "T_clear is at least twice the longest tolerated loss of shunt",
            Self::CircuitTooShort => "no train runs through a whole circuit while it is lost, or between two cycles",
            Self::TurnUnderTelegram => "plain line turns only after telegrams are too old to be acted on",
            Self::TurnUnderRun => "plain line turns only after a train that was sent before has run out",
            Self::StartTooShort => {
                "after a start nothing moves until release and turn times have passed, or the file says why not"
            }
            Self::StandstillTooShort => {
                "a train counts as standing no earlier than it can have come to a stand at the end of its route"
            }
            Self::ResidualTooShort => {
                "the residual running covers the age of a telegram and the braking from the highest speed"
            }
            Self::TelegramLives => "the ground counts on telegrams for as long as trains act on them",
            Self::SegmentOrder => "the circuits of a segment follow each other outward from the station",
            Self::LineWithoutSegment => "where the line goes on unseen, the outermost circuit of a segment ends",
            Self::EntryNotPlain => "no point and no crossing lies in the entry of a route",
            Self::PointBeforeSignal => {
                "no point and no crossing lies between the end of a route and the first signal on the way back, or the file says why no train changes ends there"
            }
            Self::SegmentElsewhere => {
                "a route comes from the segment that it enters from, and goes out to the one that follows its end"
            }
            Self::BeyondApart => "circuits beyond the end of a route adjoin it",
            Self::RouteTwice => "no two routes lead from one signal over one path",
            Self::NoRoute => "there is a route",
            Self::TooMany => "the layout fits the interlocking",
            Self::PlanAgainstTracks => "the plan is what vehicles meet on the tracks of the file",
            Self::Plan(kernel) => of_plan(kernel),
        }
    }
}

/// What a rule of the kernel's plan demands, in the words of a layout file.
const fn of_plan(rule: Kernel) -> &'static str {
    match rule {
        Kernel::PathTooLong => "a path or a segment has no more circuits than there is room for",
        Kernel::NoTime => "every time is one cycle or more",
        Kernel::ClearShort => "T_clear is at least twice the longest tolerated loss of shunt",
        Kernel::ReleaseShort => "the release time covers the residual running and the longest loss of shunt",
        Kernel::StayShort => "the stay time covers the standstill time, the longest loss of shunt and a cycle",
        Kernel::PointBothWays => "a route needs no point both ways, over path, flank and overlap together",
        Kernel::PointNotPositioned => "a point whose detector is among the circuits of a place is positioned there",
        Kernel::ConflictOneWay => "declared conflicts go both ways",
        Kernel::OpposingStarts => "routes that start from one circuit in opposite directions exclude each other",
        Kernel::TurnsBack => {
            "a route goes on in the direction of travel of the route that it continues, and of its segments"
        }
        Kernel::ContinuesElsewhere => "a route that continues another one enters at its last circuit",
        Kernel::CallingOnEnds => "a calling-on route has a berth, ends there, and leads to no line",
        Kernel::CallingOnAgainst => {
            "a route that starts in a berth leaves it at once, and against the called train over the last circuit of its path"
        }
        Kernel::CallingOnBerth => {
            "a berth is the track from the end of its calling-on route to the next signal, and no throat of a line; drivers see the aspect"
        }
        Kernel::ThroatsDiffer => "all routes out to a segment end at the segment's throat",
        Kernel::SegmentShared => {
            "a segment shares no circuit with a path, an overlap, what is beside them or another segment"
        }
        Kernel::PointInSegment => "no circuit of a segment is a detector of a point",
        Kernel::NotOneCircuit => "each place of a path or a segment is one circuit",
        Kernel::CircuitTwice => "no circuit comes twice in a path or a segment",
        Kernel::OverlapUnderOwnPath => "an overlap has no circuit of its own path",
        Kernel::EntryNotInApproach => "the entry is one circuit, and among the approach",
        Kernel::ApproachInPath => "the approach has no circuit of the path or the overlap",
        Kernel::NothingBeyond => "there is a circuit beyond the end, and it is not the last one",
        Kernel::ConflictsWithItself => "a route does not conflict with itself",
        Kernel::NotThere => "what is named exists",
        Kernel::NoDetector => "a point that a route needs has a detector",
        Kernel::NoLength => "a circuit of a path or a segment has a length",
        Kernel::BrakingFalls => "braking distances rise with the code",
        Kernel::CodeOutOfTable => "the code of a route is in the table of braking distances",
        Kernel::ManySegments => "a route comes from at most one segment and goes out to at most one",
    }
}

fn kebab(name: &str) -> String {
    let mut text = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !text.is_empty() {
            text.push('-');
        }
        text.extend(letter.to_lowercase());
    }
    text
}

/// What to do where a rule of the kernel's plan is broken.
pub const fn remedy(rule: Kernel) -> &'static str {
    match rule {
        Kernel::PathTooLong => "divide it",
        Kernel::NoTime => "give a longer time or a shorter cycle",
        Kernel::ClearShort => "give a longer clear_ms: in whole cycles at least twice shunt_loss_ms",
        Kernel::ReleaseShort => "give a release time of at least residual_ms and shunt_loss_ms",
        Kernel::StayShort => "give a stay time of more than standstill_ms and shunt_loss_ms",
        Kernel::PointBothWays => {
            "run the overlap over the leg that the flank or the path leaves, or give a reason instead of the flank"
        }
        Kernel::PointNotPositioned => "give the position of the point at that circuit",
        Kernel::ConflictOneWay | Kernel::OpposingStarts => "name each route among the conflicts of the other",
        Kernel::TurnsBack => {
            "let a route come in from its segment, go out to it, and be continued by routes ahead of it"
        }
        Kernel::ContinuesElsewhere => "name only routes whose entry is the last circuit",
        Kernel::CallingOnEnds => "end the path before the occupied track, name that as berth, and no continuing route",
        Kernel::CallingOnAgainst => "end the berth at the next signal, and let the path end where the berth begins",
        Kernel::CallingOnBerth => {
            "name as berth all circuits from the end of the path to the next signal, beyond only there, and leave out cab_signalled"
        }
        Kernel::ThroatsDiffer => "let all routes out to the segment end at one circuit next to it",
        Kernel::SegmentShared => "end routes and overlaps where the segment begins",
        Kernel::PointInSegment => "end the segment before the point, and let routes run over it",
        Kernel::NotOneCircuit | Kernel::CircuitTwice => "name every circuit once, in order",
        Kernel::OverlapUnderOwnPath => "let the overlap begin behind the path",
        Kernel::EntryNotInApproach => "add the entry to the approach",
        Kernel::ApproachInPath => "leave the circuits of path and overlap out of the approach",
        Kernel::NothingBeyond => "name the circuits that a train reaches from the last one",
        Kernel::ConflictsWithItself => "leave the route out of its own conflicts",
        Kernel::NotThere => "name only what the file describes",
        Kernel::NoDetector => "name the circuits that detect a train on the point",
        Kernel::NoLength => "give its length",
        Kernel::BrakingFalls => "give rising speeds whose braking distances differ by a metre or more",
        Kernel::CodeOutOfTable => "give the route one of the speeds of the table",
        Kernel::ManySegments => "name one segment",
    }
}
