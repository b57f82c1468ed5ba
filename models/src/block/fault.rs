//! What may fail: the kinds of fault, and which of them a run has.

use atc_kernel::block::SectionSet;

/// A kind of fault. A component that has it is free to work or to fail in every single cycle, so one fault here stands for
/// every pattern of it: once, now and then, for ever.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A section's detector does not hear a head.
    Missed,
    /// A section's detector hears a head where there is none.
    Phantom,
    /// A check-in is on without a train.
    CheckInStuckOn,
    /// A check-in is off although a train passes.
    CheckInLost,
    /// A check-out is off although a train passes.
    CheckOutLost,
    /// A check-out is on without a train.
    SpuriousCheckOut,
    /// Staff reset with another number than that of the trains in the block.
    WrongReset,
}

impl Kind {
    /// All kinds, in the order of their names.
    pub const ALL: [Self; 7] = [
        Self::CheckInLost,
        Self::CheckInStuckOn,
        Self::CheckOutLost,
        Self::Missed,
        Self::Phantom,
        Self::SpuriousCheckOut,
        Self::WrongReset,
    ];

    /// Its name in kebab-case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Missed => "missed-detection",
            Self::Phantom => "phantom-detection",
            Self::CheckInStuckOn => "check-in-stuck-on",
            Self::CheckInLost => "check-in-lost",
            Self::CheckOutLost => "check-out-lost",
            Self::SpuriousCheckOut => "spurious-check-out",
            Self::WrongReset => "wrong-reset",
        }
    }

    /// What happens, as a clause.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Missed => "a section's detector does not hear the head in it",
            Self::Phantom => "a section's detector hears a head that is not there",
            Self::CheckInStuckOn => "a check-in is on without a train",
            Self::CheckInLost => "a check-in misses a train",
            Self::CheckOutLost => "a check-out misses a train",
            Self::SpuriousCheckOut => "a check-out is on without a train",
            Self::WrongReset => "staff reset with a wrong number",
        }
    }

    /// The assumption of which the kind is a breach, whatever comes with it; none for those that no cut set but that of two
    /// detectors needs.
    pub const fn assumption(self) -> Option<&'static str> {
        match self {
            Self::CheckInLost => Some("check-in-fail-safe"),
            Self::SpuriousCheckOut => Some("check-out-not-spurious"),
            Self::WrongReset => Some("verified-reset"),
            Self::Missed | Self::Phantom | Self::CheckInStuckOn | Self::CheckOutLost => None,
        }
    }

    const fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// The faulty components of one run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Faults {
    /// Sections, from the entry of the first block, whose detectors may miss a head.
    pub missed: u8,
    /// Sections whose detectors may hear one that is not there.
    pub phantom: u8,
    /// The other kinds, a bit each, in the first block.
    checks: u8,
    /// The other kinds in the second block.
    checks_ahead: u8,
}

impl Faults {
    /// Nothing fails.
    pub const NONE: Self = Self { missed: 0, phantom: 0, checks: 0, checks_ahead: 0 };

    /// One fault of `kind`, in every place in turn: in `blocks` (1 or 2) blocks of `sections` sections each.
    pub fn single(kind: Kind, sections: u8, blocks: u8) -> Vec<Self> {
        let all = 0..sections * blocks;
        match kind {
            Kind::Missed => all.map(|section| Self { missed: 1 << section, ..Self::NONE }).collect(),
            Kind::Phantom => all.map(|section| Self { phantom: 1 << section, ..Self::NONE }).collect(),
            _ if blocks == 1 => vec![Self { checks: kind.bit(), ..Self::NONE }],
            _ => vec![Self { checks: kind.bit(), ..Self::NONE }, Self { checks_ahead: kind.bit(), ..Self::NONE }],
        }
    }

    /// Every set of at most `budget` (0, 1 or 2) faults, each once.
    pub fn up_to(budget: u8, sections: u8, blocks: u8) -> Vec<Self> {
        let singles: Vec<_> = Kind::ALL.iter().flat_map(|kind| Self::single(*kind, sections, blocks)).collect();
        let mut all = vec![Self::NONE];
        if budget > 0 {
            all.extend(&singles);
        }
        if budget > 1 {
            all.extend(singles.iter().flat_map(|one| singles.iter().map(|other| one.and(*other))));
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Both.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self {
            missed: self.missed | other.missed,
            phantom: self.phantom | other.phantom,
            checks: self.checks | other.checks,
            checks_ahead: self.checks_ahead | other.checks_ahead,
        }
    }

    /// Faults of detectors alone.
    pub const fn of_detectors(missed: u8, phantom: u8) -> Self {
        Self { missed, phantom, ..Self::NONE }
    }

    /// All of it in one number.
    pub const fn bits(self) -> u32 {
        u32::from_le_bytes([self.missed, self.phantom, self.checks, self.checks_ahead])
    }

    /// These without the other ones.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self {
            missed: self.missed & !other.missed,
            phantom: self.phantom & !other.phantom,
            checks: self.checks & !other.checks,
            checks_ahead: self.checks_ahead & !other.checks_ahead,
        }
    }

    /// A fault of `kind`, which is none of a detector, in block `block` (0 or 1).
    pub const fn of_block(kind: Kind, block: usize) -> Self {
        if block == 0 {
            Self { checks: kind.bit(), ..Self::NONE }
        } else {
            Self { checks_ahead: kind.bit(), ..Self::NONE }
        }
    }

    /// Whether block `block` (0 or 1) has a fault of `kind`, which is none of a detector.
    pub const fn has(self, kind: Kind, block: usize) -> bool {
        (if block == 0 { self.checks } else { self.checks_ahead }) & kind.bit() != 0
    }

    /// What the check-in of block `block` may say when it should say `level`.
    pub fn check_in(self, level: bool, block: usize) -> impl Iterator<Item = bool> {
        let wrong = self.has(if level { Kind::CheckInLost } else { Kind::CheckInStuckOn }, block);
        std::iter::once(level).chain(wrong.then_some(!level))
    }

    /// What the check-out of block `block` may say when it should say `level`.
    pub fn check_out(self, level: bool, block: usize) -> impl Iterator<Item = bool> {
        let wrong = self.has(if level { Kind::CheckOutLost } else { Kind::SpuriousCheckOut }, block);
        std::iter::once(level).chain(wrong.then_some(!level))
    }

    /// What the detectors may say where heads are in the sections `heard`, numbered over all blocks.
    pub fn present(self, heard: SectionSet) -> Vec<SectionSet> {
        let wrong = u16::from(self.missed) & heard.bits() | u16::from(self.phantom) & !heard.bits();
        (0..=wrong).filter(|some| some & !wrong == 0).map(|some| SectionSet::from_bits(heard.bits() ^ some)).collect()
    }

    /// The resets that may be tried on block `block` with `trains` in it, of at most `max`.
    pub fn resets(self, trains: u8, max: u8, block: usize) -> Vec<Option<u8>> {
        let wrong = self.has(Kind::WrongReset, block);
        let numbers = (0..=max).filter(|number| *number == trains || wrong);
        std::iter::once(None).chain(numbers.map(Some)).collect()
    }

    /// The names of the faults, for a trace.
    pub fn words(self) -> Vec<String> {
        let mut words = Vec::new();
        for section in 0..8 {
            for (set, kind) in [(self.missed, Kind::Missed), (self.phantom, Kind::Phantom)] {
                if set >> section & 1 == 1 {
                    words.push(format!("{} in section {section}", kind.name()));
                }
            }
        }
        for (block, name) in ["", " ahead"].into_iter().enumerate() {
            let faults = Kind::ALL.iter().filter(|kind| self.has(**kind, block));
            words.extend(faults.map(|kind| format!("{}{name}", kind.name())));
        }
        words
    }
}
