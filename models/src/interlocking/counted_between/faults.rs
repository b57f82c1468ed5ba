//! What may fail on a counted line between two stations, and which of it a run has.

use crate::block::fault::{self, Kind};

/// A fault outside of the counting. Like a faulty component of a block ([`Kind`]) it may come in every cycle, or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Around {
    /// A permission is lost, or an old one that still lives is read.
    Consent,
    /// A circuit does not report a train, for one cycle in a row.
    Lost,
    /// The receiver starts again.
    ReceiverStarts,
    /// The receiver's throat is reported without a train: to either device.
    ReceiverThroat,
    /// The sender starts again.
    SenderStarts,
    /// The sender's throat is reported without a train.
    SenderThroat,
}

impl Around {
    /// All, in the order of their names.
    pub const ALL: [Self; 6] =
        [Self::Consent, Self::Lost, Self::ReceiverStarts, Self::ReceiverThroat, Self::SenderStarts, Self::SenderThroat];

    const fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// One kind of fault, of the counting or around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Failure {
    /// Of the counting.
    Counting(Kind),
    /// Around it.
    Around(Around),
}

impl Failure {
    /// All kinds, those of the counting first.
    pub fn all() -> Vec<Self> {
        Kind::ALL.map(Self::Counting).into_iter().chain(Around::ALL.map(Self::Around)).collect()
    }

    /// Its name in kebab-case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Counting(kind) => kind.name(),
            Self::Around(Around::Consent) => "consent-lost-or-old",
            Self::Around(Around::Lost) => "lost-shunt",
            Self::Around(Around::ReceiverStarts) => "receiver-starts-again",
            Self::Around(Around::ReceiverThroat) => "receiver-throat-falsely-occupied",
            Self::Around(Around::SenderStarts) => "sender-starts-again",
            Self::Around(Around::SenderThroat) => "sender-throat-falsely-occupied",
        }
    }

    /// What happens, as a clause.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Counting(kind) => kind.text(),
            Self::Around(Around::Consent) => "a permission is lost, or an old one is read",
            Self::Around(Around::Lost) => "a circuit does not report a train for a cycle",
            Self::Around(Around::ReceiverStarts) => "the receiver's device starts again",
            Self::Around(Around::ReceiverThroat) => "the receiver's throat is reported without a train",
            Self::Around(Around::SenderStarts) => "the sender's device starts again",
            Self::Around(Around::SenderThroat) => "the sender's throat is reported without a train",
        }
    }

    /// One fault of this kind, in every place in turn: in `blocks` blocks of `sections` sections each.
    pub fn single(self, sections: u8, blocks: u8) -> Vec<Faults> {
        match self {
            Self::Counting(kind) => fault::Faults::single(kind, sections, blocks)
                .into_iter()
                .map(|counting| Faults { counting, ..Faults::NONE })
                .collect(),
            Self::Around(around) => vec![Faults { around: around.bit(), ..Faults::NONE }],
        }
    }

    /// A fault of this kind in every place at once.
    pub fn everywhere(self, sections: u8, blocks: u8) -> Faults {
        self.single(sections, blocks).into_iter().fold(Faults::NONE, Faults::and)
    }
}

/// How often what may fail in a run does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Often {
    /// In every cycle, or not, as it likes.
    AtWill,
    /// Once: in one cycle, or, where it is a level, in all cycles in a row in which it can be told from what is right.
    Once,
}

/// What may fail in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Faults {
    /// The faulty components of the counting, which both devices read.
    pub counting: fault::Faults,
    /// The others, a bit each.
    around: u8,
}

impl Faults {
    /// Nothing fails.
    pub const NONE: Self = Self { counting: fault::Faults::NONE, around: 0 };

    /// Both.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self { counting: self.counting.and(other.counting), around: self.around | other.around }
    }

    /// All of these, each in every place.
    pub fn of(kinds: &[Failure], sections: u8, blocks: u8) -> Self {
        kinds.iter().fold(Self::NONE, |all, kind| all.and(kind.everywhere(sections, blocks)))
    }

    /// Those that are levels: they last, in every place.
    pub fn levels(sections: u8, blocks: u8) -> Self {
        let counting = [Kind::Missed, Kind::Phantom, Kind::CheckInStuckOn].map(Failure::Counting);
        let around = [Around::Consent, Around::SenderThroat, Around::ReceiverThroat].map(Failure::Around);
        Self::of(&counting, sections, blocks).and(Self::of(&around, sections, blocks))
    }

    /// These without the other ones.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self { counting: self.counting.without(other.counting), around: self.around & !other.around }
    }

    /// All of it in one number.
    pub const fn bits(self) -> u64 {
        (self.counting.bits() as u64) << 8 | self.around as u64
    }

    /// Those of these that are among the others.
    #[must_use]
    pub const fn among(self, other: Self) -> Self {
        self.without(self.without(other))
    }

    /// A fault of the counting.
    pub const fn counting(counting: fault::Faults) -> Self {
        Self { counting, around: 0 }
    }

    /// A fault around it, if it is there.
    pub const fn around(around: Around, there: bool) -> Self {
        Self { counting: fault::Faults::NONE, around: if there { around.bit() } else { 0 } }
    }

    /// Whether this may happen.
    pub const fn has(self, around: Around) -> bool {
        self.around & around.bit() != 0
    }

    /// The names of the faults, for a trace.
    pub fn words(self) -> Vec<String> {
        let around = Around::ALL.into_iter().filter(|around| self.has(*around));
        let around = around.map(|around| Failure::Around(around).name().to_owned());
        self.counting.words().into_iter().chain(around).collect()
    }
}
