//! What a circuit has to say, whatever it is: lengths, the data for each direction of travel, and the words of codes.

use crate::Engine;
use crate::engine::{any_byte, any_flag};
use crate::interlocking::any_heading;
use atc_kernel::aspect::AspectId;
use atc_kernel::code::Code;
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Heading, MAX_CODES, Movement, PerCircuit, SpeedCode, SpeedLimits,
};
use atc_kernel::telegram::{Counter, Gradient, Length, SectionId};
use atc_kernel::wayside::{Codes, Counters, Facing, Fixed, Saying, Signals, Speech, Word};

/// The circuits with a length: the own one, number 0, and three ahead.
pub(super) const CIRCUITS: usize = 4;
/// The speeds of the trains' table.
pub(super) const SPEEDS: usize = 3;

/// Any lengths of the circuits.
pub(super) fn any_lengths<E: Engine + ?Sized>(e: &mut E) -> PerCircuit<Metres> {
    let mut lengths = PerCircuit::all(Metres(0));
    for length in lengths.iter_mut().take(CIRCUITS) {
        *length = Metres(e.word("length of a circuit (m)", 1..=300));
    }
    lengths
}

fn any_rank<E: Engine + ?Sized>(e: &mut E) -> Option<AspectId> {
    let rank = AspectId::new(any_byte(e, "curve limit (rank)", 0..=3));
    e.assume(rank.is_some());
    rank
}

pub(super) fn any_facing<E: Engine + ?Sized>(e: &mut E, likely: u16) -> Option<Facing> {
    Some(Facing {
        section: SectionId(e.word("section number", likely..=likely + 2)),
        gradient: Gradient(i8::from_le_bytes([any_byte(e, "gradient (‰, two's complement)", 0..=255)])),
        curve: any_rank(e)?,
    })
}

/// What a speed code is heard as, whatever the tables have.
pub(super) fn any_word<E: Engine + ?Sized>(e: &mut E, likely: u16) -> Option<Word> {
    let rank = AspectId::new(any_byte(e, "rank of a code", likely..=likely));
    let main = Code::new(any_byte(e, "main code", likely..=likely));
    let sub = Code::new(any_byte(e, "sub code", 0..=0));
    e.assume(rank.is_some() && main.is_some() && sub.is_some());
    Some(Word { rank: rank?, codes: Codes { main: main?, sub: sub? } })
}

/// Signals of circuit 0, and what they are made of.
pub(super) struct Said {
    pub(super) signals: Signals,
    fixed: Fixed,
    pub(super) words: [Option<Word>; MAX_CODES],
    pub(super) stop: Word,
}

impl Said {
    /// How the highest known code up to `code` is heard.
    pub(super) fn word(&self, code: SpeedCode) -> Word {
        let mut said = self.stop;
        for number in 1..SPEEDS {
            if let (Some(word), true) = (self.words[number], number <= usize::from(code.0)) {
                said = word;
            }
        }
        said
    }

    /// What trains of a direction of travel know of circuit 0.
    pub(super) fn its(&self, heading: Heading) -> Facing {
        if heading == Heading::Left { self.fixed.left } else { self.fixed.right }
    }
}

/// Any signals as the constructor makes them (`way_signals`, `way_words`): code 0 is there and stops, and a circuit has two numbers.
pub(super) fn any_said<E: Engine + ?Sized>(e: &mut E, lengths: &PerCircuit<Metres>) -> Option<Said> {
    let stop = any_word(e, 0)?;
    let mut words = [None; MAX_CODES];
    words[0] = Some(stop);
    for (number, word) in (0_u16..).zip(words.iter_mut()).take(SPEEDS).skip(1) {
        let its = any_word(e, number)?;
        *word = if e.word("there is such a code (odd: yes)", 1..=1 + number / 2) & 1 == 1 { Some(its) } else { None };
    }
    let fixed = Fixed { left: any_facing(e, 0)?, right: any_facing(e, 2)? };
    let length = Length::new(lengths[0]);
    e.assume(length.is_some() && fixed.left.section != fixed.right.section);
    let length = length?;
    let mut circuits = PerCircuit::all(None);
    circuits[0] = Some((fixed, length));
    Some(Said { signals: Signals::from_parts(circuits, words, stop), fixed, words, stop })
}

/// Any movement of a train in circuit 0, whatever the ATC may say.
pub(super) fn any_movement<E: Engine + ?Sized>(e: &mut E) -> Movement {
    let heading = any_heading(e, "heading of the movement (odd: right)");
    Movement {
        stop: CircuitId::ZERO,
        heading: if any_flag(e, "the train may leave its circuit (odd: yes)") { Some(heading) } else { None },
        speed: SpeedCode(any_byte(e, "speed code", 0..=3)),
        hold: CircuitSet::from_bits(u64::from(e.word("granted (bits)", 0..=15) & 15)),
    }
}

/// What trains of a direction of travel are told in circuit 0.
pub(super) fn heard<E: Engine + ?Sized>(
    e: &mut E,
    lengths: &PerCircuit<Metres>,
    said: &Said,
    movement: Movement,
    heading: Heading,
) -> Option<(Speech, Counters, SpeedLimits)> {
    let mut any = |what| Counter(any_byte(e, what, 0..=255));
    let counters = Counters { main: any("number of the main telegram"), sub: any("number of the sub telegram") };
    let limit = SpeedCode(any_byte(e, "temporary restriction (code)", 0..=3));
    let here = CircuitSet::from_bits(u64::from(e.word("restricted circuits (bits)", 0..=15) & 15));
    let restrictions = SpeedLimits::NONE.and_at_most(limit, here);
    let saying = Saying { circuit: CircuitId::ZERO, movement, restrictions, counters };
    Some((said.signals.speech(lengths, saying, heading)?, counters, restrictions))
}
