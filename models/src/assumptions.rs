//! What the models assume of ground, channel, receiver, trains and staff: each is a condition that somebody must keep.

/// An assumption: its id and its sentence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Assumption {
    /// The id, in kebab-case.
    pub id: &'static str,
    /// What is assumed.
    pub text: &'static str,
    /// What happens without it, as the model that lifts it shows; empty if no model lifts it.
    pub without: &'static str,
}

/// Every assumption that a model has in force or lifts.
pub const ASSUMPTIONS: &[Assumption] = &[
    Assumption {
        id: "detected-throughout",
        text: "The receiver reports an aspect in a logic cycle only if it was detected throughout that cycle.",
        without: "",
    },
    Assumption { id: "alone-on-the-line", text: "No other aspect is detected.", without: "" },
    Assumption { id: "one-signal", text: "The ground sends at most one aspect at a time.", without: "" },
    Assumption {
        id: "no-stale-bursts",
        text: "An aspect that the ground does not send is never heard on T5 consecutive cycles.",
        without: "Bursts of T5 with gaps of min(T4, T2+T3-T5) keep an aspect displayed for ever that is not sent.",
    },
    Assumption {
        id: "spaced-bursts",
        text: "An aspect that the ground does not send is never heard on T1 consecutive cycles, and more than T4 cycles \
               lie between two such bursts of it.",
        without: "Bursts of T5 with gaps of min(T4, T2+T3-T5) keep an aspect displayed for ever that is not sent.",
    },
    Assumption {
        id: "no-permissive-misread",
        text: "A more permissive aspect than the one sent is never heard on T1 consecutive cycles.",
        without: "It is displayed, if the aspect that is sent is interrupted for longer than T2-T5 at the same time.",
    },
    Assumption {
        id: "short-interruptions",
        text: "An aspect that is sent is never interrupted for longer than T2-T5, and is heard for T5 or more between two \
               interruptions.",
        without: "A more permissive aspect that is misread for T1 in that time is displayed.",
    },
    Assumption {
        id: "change-is-heard",
        text: "The ground sends an aspect for T1 or more, and none is interrupted.",
        without: "After a change to a lower aspect the old one stays displayed until T2+T3, instead of T1.",
    },
    Assumption {
        id: "live-transmitter",
        text: "The transmitter of every train works from before it enters a block until it has left.",
        without: "A train that enters with a dead transmitter is neither counted nor detected, and reported free: \
               one cause is enough.",
    },
    Assumption {
        id: "train-whole",
        text: "No train leaves a part of itself behind.",
        without: "A rear part that is left behind is reported free once the rest of its train is further on than \
               the hold.",
    },
    Assumption {
        id: "no-reversing-over-exit",
        text: "No train reverses into a block over its exit end.",
        without: "It is counted out twice; with one missed detection a train is reported free.",
    },
    Assumption {
        id: "entries-apart",
        text: "Two trains pass a check-in at least the pass time apart.",
        without: "Over a check-in that is stuck on not all of them are counted; with one missed detection a train \
               is reported free.",
    },
    Assumption {
        id: "hold-covers-train",
        text: "The held sections behind a head are at least as long as the longest train, also behind a head \
               that is past the check-out and not yet at the border.",
        without: "A tail is reported free with no fault at all.",
    },
    Assumption {
        id: "heard-by-one",
        text: "At every moment exactly one detector hears a head, also where it crosses from one section to \
               the next.",
        without: "A head that two detectors hear makes up for another that is missed, and a phantom makes up for \
               a head that none hears: one fault is enough.",
    },
    Assumption {
        id: "loops-overlap",
        text: "At the border of two blocks a head passes first the check-in ahead, then the place where the \
               detector ahead takes over from the one behind, then the check-out behind.",
        without: "A head that is heard in a block that does not count it makes up for another one there that is \
               missed: one fault is enough.",
    },
    Assumption {
        id: "independent-detectors",
        text: "A missed detection and a phantom detection do not come together in one block.",
        without: "A phantom makes up for a train that is missed, which is then reported free.",
    },
    Assumption {
        id: "line-end-asks",
        text: "What lies beyond the exit of a counted line has the sections held in which tails may still be.",
        without: "A tail is reported free as soon as its front has left the line: the next train runs into it.",
    },
    Assumption {
        id: "check-in-fail-safe",
        text: "A check-in never misses a train: it fails to the state on.",
        without: "With one missed detection a train that was not counted is reported free.",
    },
    Assumption {
        id: "check-out-not-spurious",
        text: "A check-out is never on without a train.",
        without: "With one missed detection a train that was counted out is reported free.",
    },
    Assumption {
        id: "verified-reset",
        text: "The number of a reset is that of the trains in the block, all clear of its ends.",
        without: "With one missed detection a train that was left out is reported free.",
    },
    Assumption {
        id: "limits-reach-over-the-border",
        text: "The limit of a section holds from where its main telegrams are used for the first time, and that of the section behind is enough until then.",
        without: "With the last telegram of the section behind the train is permitted more than the lower limit ahead.",
    },
    Assumption {
        id: "odometer-bound",
        text: "The train has moved no farther than the odometer says.",
        without: "The stopping point is taken to be farther away than it is.",
    },
    Assumption {
        id: "stop-point-life",
        text: "The ground keeps a stretch free that it has withdrawn, and does not rely on a restriction, for the life of the telegrams that said otherwise, and for as long as a telegram waits before it is sent and after it has arrived.",
        without: "A train that hears nothing still runs on the old point or the old limit.",
    },
    Assumption {
        id: "transmitter-does-not-loop",
        text: "A transmitter never repeats several telegrams in turn; it may repeat its last one.",
        without: "A loop of more telegrams than the run is used for ever; a shorter one once, and beyond the life.",
    },
    Assumption {
        id: "sub-data-worst",
        text: "No sub telegram of the line carries a steeper fall or a lower limit than the train assumes.",
        without: "Before a section's sub telegram is there the train is permitted more than its fall or its limit allows.",
    },
    Assumption {
        id: "fix-of-the-section-heard",
        text: "Where main telegrams of the section behind are still heard no distance to the exit of the section ahead is measured.",
        without: "It is added to what the telegram of the section behind allows.",
    },
    Assumption {
        id: "margin-covers-the-crossing",
        text: "The margin covers what the nose moves from the last bit of a main telegram in the rail to the cycle in which the telegram is used.",
        without: "A telegram of the section behind is taken as if the nose had passed the exit in the last cycle at the earliest.",
    },
    Assumption {
        id: "line-is-told",
        text: "The train is told of the kind of line in the cycle in which its nose passes the border.",
        without: "Missing telegrams are taken for normal, and the train runs on its code past the stopping point.",
    },
    Assumption {
        id: "loss-of-shunt-within-clear",
        text: "No occupied circuit is reported clear for as many cycles in a row as it must be to count as clear.",
        without: "The next train is let in to a train that has been lost.",
    },
    Assumption {
        id: "approach-covers-braking",
        text: "The approach of a route covers every circuit from which a train that has seen its proceed aspect, or has it in its telegram, cannot stop before \
               the signal any more, and what it runs in the age of a telegram and in the longest time without being reported.",
        without: "The route is released at once under such a train: a point moves under it, or it meets another.",
    },
    Assumption {
        id: "release-covers-residual-running",
        text: "A train that cannot stop any more has passed the signal before the release time is over.",
        without: "The route is released before the train has come, and a point moves under it.",
    },
    Assumption {
        id: "overlap-covers-sliding",
        text: "A train that does not stop in time comes to a stand within the overlap, and before the stay time is over.",
        without: "Two trains that slide meet beyond their signals, or a point in the overlap moves under one.",
    },
    Assumption {
        id: "flank-complete",
        text: "A route needs every point that keeps a sliding train off its path in the position that does so.",
        without: "A train that slides past a signal runs into the side of another.",
    },
    Assumption {
        id: "fouling-declared",
        text: "Routes that foul each other without a circuit or a point in common are declared to conflict.",
        without: "Both are held together, and their trains meet.",
    },
    Assumption {
        id: "path-complete",
        text: "The path of a route has every circuit that its train runs over, in order, as far as the next signal.",
        without: "A train is let in where another one stands.",
    },
    Assumption {
        id: "points-detect-truly",
        text: "A point is reported in a position only while it is at rest there.",
        without: "A train runs over a point that moves.",
    },
    Assumption {
        id: "points-leave-while-driven",
        text: "A point leaves its position only in a cycle after one in which it is driven: not later.",
        without: "A route finds the point in position and shows proceed, and the point moves under its train.",
    },
    Assumption {
        id: "trains-obey-signals",
        text: "Trains obey the signals; on plain line, where there are none, they keep to their telegrams.",
        without: "Trains meet in the station.",
    },
    Assumption {
        id: "neighbour-turns-alike",
        text: "The neighbouring station permits this one to send only while it does not send itself, and turns as this one does.",
        without: "Both stations send into the line.",
    },
    Assumption {
        id: "turn-outlasts-telegrams",
        text: "The turn time is longer than the telegrams between the stations live.",
        without: "An old permission is read after it was withdrawn, and both stations send.",
    },
    Assumption {
        id: "views-of-a-line-meet",
        text: "What two stations see of the line between them overlaps, or meets at one joint.",
        without: "A train stands on a stretch that neither sees, and the other station sends against it.",
    },
    Assumption {
        id: "start-outlasts-running",
        text: "When the time after a start has passed, every train that could count on a signal from before it has passed that signal, or stands.",
        without: "A train goes out onto the line after its station's device has started, and the line is turned against it.",
    },
];
