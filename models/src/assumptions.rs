//! What the models assume of ground, channel and receiver: each is a condition that somebody must keep.

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
];
