//! What became of a call.

use core::ffi::CStr;

/// What became of a call. Every function of this library returns one, and 0 is the only success.
///
/// A call that does not return `ATC_STATUS_OK` has changed no state, and has written the safe output wherever an
/// output can
/// be written. `atc_status_text` says in a sentence what is wrong and what would be right.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum atc_status {
    /// The call was carried out.
    Ok = 0,

    /// A pointer is null.
    Null = 1,
    /// A pointer is not aligned for what it points to.
    Misaligned = 2,
    /// The memory for a state is smaller than the state.
    TooSmall = 3,
    /// Two of the places that the call was given overlap.
    Overlap = 4,
    /// The memory holds no state of this machine and this version: it was never started, or is of another machine.
    NotStarted = 5,
    /// The state was started, and its bytes have changed since in another way than by a step.
    Damaged = 6,
    /// An array has more entries than there is room for.
    TooManyEntries = 7,
    /// A place of a plan lies beyond the end of its array.
    BeyondArray = 8,

    /// A flag is neither 0 nor 1.
    BadFlag = 10,
    /// A choice is none of its constants.
    UnknownChoice = 11,
    /// An aspect is named that the line does not have.
    UnknownAspect = 12,
    /// A section is named that the block does not have.
    UnknownSection = 13,
    /// A rank of a speed is over 15.
    UnknownRank = 14,
    /// More than 16 sections are to be held.
    HoldTooLong = 15,
    /// The section of a sub telegram has no length.
    NoSectionLength = 16,
    /// A main telegram has a closed route and a distance beyond the exit.
    ClosedRouteWithDistance = 17,
    /// A bit of a frame is neither 0 nor 1.
    BadBit = 18,
    /// A circuit is named that the plan does not have.
    UnknownCircuit = 19,
    /// A point is named that the plan does not have.
    UnknownPoint = 20,
    /// A route is named that the plan does not have.
    UnknownRoute = 21,
    /// A segment is named that the plan does not have.
    UnknownSegment = 22,
    /// A speed code is over 7.
    UnknownCode = 23,

    /// The logic cycle has no length.
    NoCycle = 30,
    /// A time is over 60 000 logic cycles.
    TimeTooLong = 31,
    /// The operate time (T1) is 0.
    NoOperateTime = 32,
    /// The recovery time (T2) is shorter than one logic cycle.
    NoRecoveryTime = 33,
    /// The shortened operate time (T5) is 0.
    NoShortenedOperateTime = 34,
    /// The shortened operate time (T5) is not shorter than the operate time (T1), in whole cycles.
    ShortenedNotShorter = 35,
    /// The table of speeds is empty.
    NoSpeeds = 36,
    /// The table of speeds has more than 16 entries.
    TooManySpeeds = 37,
    /// The table of speeds does not rise strictly.
    SpeedsNotRising = 38,

    /// The highest plausible speed is 0.
    NoMaximum = 40,
    /// The release margin is above the highest plausible speed.
    MarginAboveMaximum = 41,

    /// The block has no section.
    NoSections = 50,
    /// The block has more than 16 sections.
    TooManySections = 51,
    /// No train may be in the block.
    NoTrains = 52,
    /// More trains may be in the block than it has sections.
    MoreTrainsThanSections = 53,
    /// The pass time is shorter than one logic cycle.
    PassTooShort = 54,

    /// The brake is 0 or over 4095 mm/s².
    BadBrake = 60,
    /// The rank of the lowest limit is not in the table of speeds.
    UnknownLimit = 61,
    /// The time for which a main telegram is fresh is shorter than one logic cycle.
    NoFreshness = 62,
    /// The life of a main telegram is shorter than the time for which it is fresh.
    LifeShorterThanFreshness = 63,
    /// The life of a sub telegram is shorter than one logic cycle.
    NoFixedLife = 64,
    /// The memory is longer than the life of a main or of a sub telegram.
    MemoryLongerThanLife = 65,
    /// The window of the counter is 0 or over 127.
    BadWindow = 66,
    /// The run of the counter is 0 or over 15.
    BadRun = 67,
    /// The memory is shorter than one logic cycle.
    NoMemory = 68,

    /// The bits are no frame: the synchronisation word is not there.
    FrameSynchronisation = 70,
    /// The bits are no frame: a guard bit is 1.
    FrameGuard = 71,
    /// The bits are no frame: the check does not fit the information.
    FrameCheck = 72,
    /// The bits are no frame: the check fits, and the information is of no telegram.
    FrameContent = 73,

    /// An on-board device has no pair of codes.
    NoCodes = 80,
    /// A carrier has more than 8 different codes, or there are more than 64 pairs.
    TooManyCodes = 81,
    /// The band of a code reaches down to 0, or beyond the highest number.
    CodeOutOfRange = 82,
    /// The bands of two codes of a carrier touch.
    CodeBandsTouch = 83,
    /// A pair of codes comes twice.
    CodePairTwice = 84,
    /// A pair of codes names a speed that is not in the table of speeds.
    UnknownCodeSpeed = 85,
    /// A speed of the line is above the highest plausible one.
    ImplausibleSpeed = 86,
    /// The spacing of an attenuation table is out of its range.
    BadSpacing = 87,
    /// The lowest difference of an attenuation table is above the highest.
    TableCrossed = 88,
    /// In no span of an attenuation table both curves rise.
    TableNowhereRising = 89,
    /// The tolerance of a level is negative.
    BadTolerance = 90,
    /// The least correction is above the most.
    BadCorrection = 91,
    /// The least movement is above the most.
    BadMovement = 92,

    /// A path or a segment has more places than there is room for: 16, in a large station 32.
    PlanPathTooLong = 100,
    /// A time of the plan is 0.
    PlanNoTime = 101,
    /// A circuit counts as clear sooner than a train may be lost for.
    PlanClearShort = 102,
    /// A release time does not cover the residual running and the longest loss.
    PlanReleaseShort = 103,
    /// A stay time does not cover the standstill time, the longest loss and one cycle more.
    PlanStayShort = 104,
    /// A route needs a point both ways.
    PlanPointBothWays = 105,
    /// A point with a detector on a place of a path, or on an overlap, is not positioned there.
    PlanPointNotPositioned = 106,
    /// A declared conflict goes one way only.
    PlanConflictOneWay = 107,
    /// Two routes start from one circuit in opposite directions and do not conflict.
    PlanOpposingStarts = 108,
    /// A route that continues another one does not enter at that one's last circuit.
    PlanContinuesElsewhere = 109,
    /// A route turns back on the route that it continues, or on its segment.
    PlanTurnsBack = 110,
    /// A route out to a segment does not end at the segment's throat.
    PlanThroatsDiffer = 111,
    /// A segment shares a circuit with a path, an overlap, a throat or another segment.
    PlanSegmentShared = 112,
    /// A circuit of a segment is a detector of a point.
    PlanPointInSegment = 113,
    /// A place of a path or of a segment is not exactly one circuit.
    PlanNotOneCircuit = 114,
    /// A circuit comes twice in a path or in a segment.
    PlanCircuitTwice = 115,
    /// The braking distances do not rise with the code.
    PlanBrakingFalls = 116,
    /// An overlap has a circuit of its own path.
    PlanOverlapUnderOwnPath = 117,
    /// The entry is not exactly one circuit of the approach.
    PlanEntryNotInApproach = 118,
    /// The approach has a circuit of the path or of the overlap.
    PlanApproachInPath = 119,
    /// There is no circuit beyond the end of a route, or it is the last one of its path.
    PlanNothingBeyond = 120,
    /// A route conflicts with itself.
    PlanConflictsWithItself = 121,
    /// A route names a route, a point or a segment that is not there.
    PlanNotThere = 122,
    /// A point that a route needs has no detector.
    PlanNoDetector = 123,
    /// A circuit of a path or of a segment has no length.
    PlanNoLength = 124,
    /// The speed code of a route has no braking distance.
    PlanCodeOutOfTable = 125,
    /// A route comes from more than one segment, or goes to more than one.
    PlanManySegments = 126,
    /// A calling-on route has no berth, is continued by another route, or leads to a segment.
    PlanCallingOnEnds = 127,
    /// A route that starts in a berth runs over a circuit of it, or against the called train elsewhere than over its last circuit.
    PlanCallingOnAgainst = 128,
    /// The berth of a calling-on route is not the track up to the next signal, or its trains act on telegrams alone.
    PlanCallingOnBerth = 129,
}

impl atc_status {
    /// Every status with its sentence. A test holds that none is left out.
    pub const ALL: &[(Self, &CStr)] = &[
        (Self::Ok, c"the call was carried out"),
        (Self::Null, c"a pointer is null; only the arrays of a plan that have no entry may be"),
        (Self::Misaligned, c"a pointer is not aligned for what it points to; see the ..._ALIGN constants"),
        (Self::TooSmall, c"the memory for the state is too small; see the ..._SIZE constants"),
        (Self::Overlap, c"state, input, output or configuration overlap; each needs a place of its own"),
        (Self::NotStarted, c"no state of this machine and version is here; start it first"),
        (Self::Damaged, c"the state was changed by something else than a step; start the machine anew"),
        (Self::TooManyEntries, c"an array has more entries than there is room for; see the ATC_MAX_... constants"),
        (Self::BeyondArray, c"the places of a route or of a segment reach beyond the end of their array"),
        (Self::BadFlag, c"a flag is neither 0 nor 1"),
        (Self::UnknownChoice, c"a choice is none of the constants for it"),
        (Self::UnknownAspect, c"an aspect is named that the line does not have; bits from aspect_count on must be 0"),
        (Self::UnknownSection, c"a section is named that the block does not have; bits from sections on must be 0"),
        (Self::UnknownRank, c"a rank of a speed is over 15"),
        (Self::HoldTooLong, c"more than 16 sections are to be held; it must be 0 to 16"),
        (Self::NoSectionLength, c"the section of a sub telegram has no length; it must be 1 to 65535 m"),
        (Self::ClosedRouteWithDistance, c"a closed route has a distance beyond the exit; it must be 0"),
        (Self::BadBit, c"a bit of a frame is neither 0 nor 1"),
        (Self::UnknownCircuit, c"a circuit is named that the plan does not have; bits from circuit_count on must be 0"),
        (Self::UnknownPoint, c"a point is named that the plan does not have; bits from point_count on must be 0"),
        (Self::UnknownRoute, c"a route is named that the plan does not have; bits from route_count on must be 0"),
        (Self::UnknownSegment, c"a segment is named that the plan does not have; bits from segment_count on must be 0"),
        (Self::UnknownCode, c"a speed code is over 7"),
        (Self::NoCycle, c"cycle_ms is 0; a logic cycle lasts 1 ms or more"),
        (Self::TimeTooLong, c"a time is over 60000 logic cycles"),
        (Self::NoOperateTime, c"operate_ms (T1) is 0; it must be 1 ms or more"),
        (Self::NoRecoveryTime, c"recovery_ms (T2) is shorter than one logic cycle"),
        (Self::NoShortenedOperateTime, c"shortened_operate_ms (T5) is 0; it must be 1 ms or more"),
        (Self::ShortenedNotShorter, c"shortened_operate_ms (T5), in whole cycles, is not below operate_ms (T1)"),
        (Self::NoSpeeds, c"the table of speeds is empty; it must have 1 to 16 entries"),
        (Self::TooManySpeeds, c"the table of speeds has more than 16 entries; it must have 1 to 16"),
        (Self::SpeedsNotRising, c"the table of speeds does not rise strictly"),
        (Self::NoMaximum, c"the highest plausible speed is 0; it must be above 0"),
        (Self::MarginAboveMaximum, c"the release margin is above the highest plausible speed; it must not be"),
        (Self::NoSections, c"the block has no section; it must have 1 to 16"),
        (Self::TooManySections, c"the block has more than 16 sections; it must have 1 to 16"),
        (Self::NoTrains, c"no train may be in the block; max_trains must be 1 to the number of sections"),
        (Self::MoreTrainsThanSections, c"max_trains is above the number of sections; it must be 1 to that number"),
        (Self::PassTooShort, c"pass_ms is shorter than one logic cycle"),
        (Self::BadBrake, c"the brake is 0 or over 4095 mm/s2; it must be 1 to 4095"),
        (Self::UnknownLimit, c"lowest_rank is not in the table of speeds; it must be below speed_count"),
        (Self::NoFreshness, c"fresh_ms is shorter than one logic cycle"),
        (Self::LifeShorterThanFreshness, c"life_ms is shorter than fresh_ms; it must not be"),
        (Self::NoFixedLife, c"fixed_life_ms is shorter than one logic cycle"),
        (Self::MemoryLongerThanLife, c"memory_ms is longer than life_ms or fixed_life_ms; it must not be"),
        (Self::BadWindow, c"the window is 0 or over 127; the counter may advance by 1 to 127"),
        (Self::BadRun, c"the run is 0 or over 15; it must be 1 to 15 telegrams"),
        (Self::NoMemory, c"memory_ms is shorter than one logic cycle"),
        (Self::FrameSynchronisation, c"no frame: the synchronisation word is not there"),
        (Self::FrameGuard, c"no frame: a guard bit is 1"),
        (Self::FrameCheck, c"no frame: the check does not fit the information"),
        (Self::FrameContent, c"no frame: the check fits, and the information is of no telegram"),
        (Self::NoCodes, c"there is no pair of codes; code_count must be 1 to 64"),
        (Self::TooManyCodes, c"a carrier has more than 8 different codes, or there are more than 64 pairs"),
        (Self::CodeOutOfRange, c"a code, with the tolerance, must be above 0 and at most 4294967295 thousandths of Hz"),
        (Self::CodeBandsTouch, c"two codes of a carrier must be more than twice the tolerance apart"),
        (Self::CodePairTwice, c"a pair of codes comes twice; it may name one speed"),
        (Self::UnknownCodeSpeed, c"a pair of codes names a speed that is not in permitted.speeds"),
        (
            Self::ImplausibleSpeed,
            c"a speed of the line is above supervision.maximum; a train at that speed would be stopped",
        ),
        (Self::BadSpacing, c"spacing_exponent must be 4 to 11"),
        (Self::TableCrossed, c"the lowest difference of the attenuation table is above the highest at a distance"),
        (Self::TableNowhereRising, c"in no span of the attenuation table both curves rise: no distance could be found"),
        (Self::BadTolerance, c"the tolerance of a level is negative; it must be 0 or more"),
        (Self::BadCorrection, c"correction_least is above correction_most; it must not be"),
        (Self::BadMovement, c"moved_least_mm is above moved_most_mm; it must not be"),
        (Self::PlanPathTooLong, c"a path or a segment has more than 16 places, or more than 32 in a large station"),
        (Self::PlanNoTime, c"clear, turn, drive, release and stay must be one cycle or more"),
        (Self::PlanClearShort, c"clear_cycles must be above loss_cycles, and twice that at least"),
        (Self::PlanReleaseShort, c"a release time must cover residual_cycles and loss_cycles"),
        (Self::PlanStayShort, c"a stay time must cover standstill_cycles, loss_cycles and one cycle more"),
        (Self::PlanPointBothWays, c"a route needs a point both ways"),
        (Self::PlanPointNotPositioned, c"a point with a detector on a path or an overlap must be positioned there"),
        (Self::PlanConflictOneWay, c"a declared conflict goes one way only; both routes must name it"),
        (Self::PlanOpposingStarts, c"routes from one circuit in opposite directions must be declared to conflict"),
        (Self::PlanContinuesElsewhere, c"a route that continues another must enter at that one's last circuit"),
        (Self::PlanTurnsBack, c"a route must go on in the direction of the route or the segment that it continues"),
        (Self::PlanThroatsDiffer, c"a route out to a segment must end at the segment's throat"),
        (
            Self::PlanSegmentShared,
            c"a segment shares a circuit with a path, an overlap, what is beside them, a throat or another segment",
        ),
        (Self::PlanPointInSegment, c"a circuit of a segment is a detector of a point; it must not be"),
        (Self::PlanNotOneCircuit, c"each place of a path, and of a segment, must be exactly one circuit"),
        (Self::PlanCircuitTwice, c"a circuit comes twice in a path or in a segment"),
        (Self::PlanBrakingFalls, c"braking distances must rise with the code"),
        (Self::PlanOverlapUnderOwnPath, c"an overlap has a circuit of its own path; it must not"),
        (Self::PlanEntryNotInApproach, c"the entry must be exactly one circuit, and one of the approach"),
        (Self::PlanApproachInPath, c"the approach has a circuit of the path or of the overlap; it must not"),
        (Self::PlanNothingBeyond, c"a circuit must lie beyond the end of a route, and not be its last one"),
        (Self::PlanConflictsWithItself, c"a route is declared to conflict with itself"),
        (
            Self::PlanNotThere,
            c"a route names a route, a point or a segment that is not there, or a path or a segment has no place",
        ),
        (Self::PlanNoDetector, c"a point that a route needs must have a detector"),
        (Self::PlanNoLength, c"a circuit of a path or of a segment must have a length"),
        (Self::PlanCodeOutOfTable, c"the speed code of a route must be above 0 and have a braking distance"),
        (Self::PlanManySegments, c"a route must come from one segment at most, and go to one at most"),
        (Self::PlanCallingOnEnds, c"a calling-on route must have a berth, no continuing route and no segment out"),
        (
            Self::PlanCallingOnAgainst,
            c"a route from a berth must leave it at once, against the called train over its last circuit",
        ),
        (
            Self::PlanCallingOnBerth,
            c"a berth must be all of the track up to the next signal, and its route not be cab-signalled",
        ),
    ];

    /// The sentence of the status with this number.
    pub fn text(number: i32) -> &'static CStr {
        let known = Self::ALL.iter().find(|(status, _)| *status as i32 == number);
        known.map_or(c"there is no status of this number", |(_, text)| *text)
    }
}
