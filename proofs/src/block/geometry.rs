//! Lines: what their constructor accepts, and the geometry of the holds (T-BLK-4).

use super::{any_byte, any_hold};
use atc_kernel::block::{Block, Direction, Hold, Line, LineError, Metres, hold_for};
use atc_kernel::time::Ticks;

/// The most sections in the proofs of the geometry.
const LENGTHS: usize = 4;

/// How many choices of 1 to `LENGTHS` lengths and holds of 0 to `LENGTHS` there are.
const GIVEN: usize = LENGTHS * (LENGTHS + 1);

/// How many lines of 2 to `LENGTHS` sections, with holds of 0 to `LENGTHS`, there are.
const GEOMETRIES: usize = (LENGTHS - 1) * (LENGTHS + 1);

/// Arbitrary lengths of `count` sections, and the total of each `hold` consecutive ones, found the slow way.
fn total(lengths: [u16; LENGTHS], first: usize, hold: usize) -> u32 {
    let mut total = 0;
    for (section, length) in lengths.into_iter().enumerate() {
        total += if section >= first && section - first < hold { u32::from(length) } else { 0 };
    }
    total
}

harness! {
    /// Tail cover, the geometry's half: on a line that the constructor accepts, a train whose nose is anywhere in a section
    /// ends at most k sections behind it, whichever way it travels and across the border of two blocks.
    t_blk_4_geometry(e)
    theorem "T-BLK-4";
    requirements ["BLK-9"];
    assumptions ["hold-covers-train", "nose-antenna", "train-whole", "line-end-asks"];
    built_in &[
        ("hold-covers-train", "the longest train of the line's data is the longest that there is"),
        ("nose-antenna", "the section of the head is that of the nose"),
        ("train-whole", "a train ends its length behind its nose"),
        ("line-end-asks", "of a train that reaches over the entry of the line nothing is claimed"),
    ];
    bound "2 to 4 sections in two blocks";
    cases GEOMETRIES;
    unwind 18 = 1 + crate::block::LONGEST;
    apart [0 1 2 3 4 5 6 7 8 9 10 11 12 13 14];
    claims {
        Behind: "the tail of the longest train is in the section of its nose or in one of the k behind it",
        Told: "a hold that is refused is too short for the sections that the error names",
        Fewest: "the hold that is computed for a line is the shortest that is long enough",
    }
    covers {
        Accepted: "a line is accepted whose train is longer than a section",
        Refused: "a line is refused because its hold is too short",
        Zero: "a train of no length needs no hold",
    }
    {
        let case = e.choose("sections and hold", GEOMETRIES);
        let (count, hold) = (case / (LENGTHS + 1) + 2, case % (LENGTHS + 1));
        let Some(kept) = Hold::new(hold.to_le_bytes()[0]) else { return e.assume(false) };
        let mut lengths = [0; LENGTHS];
        for (section, length) in lengths.iter_mut().enumerate() {
            *length = if section < count { e.word("length (m)", 1..=4) } else { 0 };
        }
        let train = e.word("longest train (m)", 0..=12);
        let behind = [1, count - 1].map(|sections| {
            let sections = sections.to_le_bytes()[0];
            Block::new(sections, 1, kept, Ticks(1))
        });
        let [Ok(first), Ok(second)] = behind else { return e.assume(false) };
        let metres = lengths.map(Metres);
        let line = Line::new([first, second], &metres[..count], Metres(train), Direction::Up);
        // The window behind a nose that has just entered section `nose`: below it when travelling up, above it when down.
        let nose = usize::from(e.word("section of the nose", 0..=5));
        e.assume(nose < count);
        let up = nose < hold || total(lengths, nose - hold, hold) >= u32::from(train);
        let down = nose + hold >= count || total(lengths, nose + 1, hold) >= u32::from(train);
        e.claim(Claim::Behind as u32, line.is_err() || up && down);
        let (told, refused) = match line {
            Err(LineError::HoldTooShort(first)) => (first + hold <= count && total(lengths, first, hold) < u32::from(train), true),
            _ => (true, false),
        };
        e.claim(Claim::Told as u32, told);
        let mut enough = true;
        for first in 0..=LENGTHS {
            enough &= first + hold > count || total(lengths, first, hold) >= u32::from(train);
        }
        // Of this hold, whichever it is: so of all.
        let fewest = hold_for(&metres[..count], Metres(train)).map_or(usize::MAX, |hold| usize::from(hold.sections()));
        e.claim(Claim::Fewest as u32, (!enough || fewest <= hold) && (fewest != hold || enough));
        e.cover(Cover::Accepted as u32, line.is_ok() && train > lengths[0] && hold < count);
        e.cover(Cover::Refused as u32, refused);
        e.cover(Cover::Zero as u32, line.is_ok() && train == 0 && hold == 0);
    }
}

harness! {
    /// The constructor of a line accepts exactly what BLK-9 allows; the error names a broken rule and the first place where it is.
    blk_9(e)
    theorem "T-BLK-4";
    requirements ["BLK-9"];
    assumptions [];
    bound "two blocks of any size, with 1 to 4 lengths and holds of 0 to 4 sections";
    cases GIVEN;
    unwind 18 = 1 + crate::block::LONGEST;
    apart [0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19];
    claims {
        Exact: "accepted if and only if there is a length above 0 for every section, the holds are equal, and no k consecutive sections are shorter than the train",
        Told: "the error names a rule that is broken, and the first place where it is",
    }
    covers {
        Accepted: "a line is accepted",
        Unequal: "a line of different holds is refused",
        NoLength: "a line with a section without length is refused",
        Short: "a line whose hold is too short is refused",
    }
    {
        let case = e.choose("lengths given and hold", GIVEN);
        let (given, hold) = (case / (LENGTHS + 1) + 1, case % (LENGTHS + 1));
        let Some(first_hold) = Hold::new(hold.to_le_bytes()[0]) else { return e.assume(false) };
        let Some(second_hold) = any_hold(e, "tail hold of the second block (sections)", 4) else { return };
        let (first, second) = (any_byte(e, "sections of the first block", 1..=2), any_byte(e, "sections of the second block", 1..=2));
        let blocks = [(first, first_hold), (second, second_hold)].map(|(sections, hold)| Block::new(sections, 1, hold, Ticks(1)));
        let [Ok(low), Ok(high)] = blocks else { return e.assume(false) };
        let mut lengths = [0; LENGTHS];
        for length in &mut lengths {
            *length = e.word("length (m)", 0..=4);
        }
        let train = e.word("longest train (m)", 0..=6);
        let line = Line::new([low, high], &lengths.map(Metres)[..given], Metres(train), Direction::Down);
        let (mut no_length, mut short) = (LENGTHS, LENGTHS);
        for place in (0..given).rev() {
            no_length = if lengths[place] == 0 { place } else { no_length };
            let long_enough = place + hold > given || total(lengths, place, hold) >= u32::from(train);
            short = if long_enough { short } else { place };
        }
        let (equal, sections) = (first_hold == second_hold, usize::from(first) + usize::from(second));
        let legal = equal && sections == given && no_length == LENGTHS && short == LENGTHS;
        e.claim(Claim::Exact as u32, line.is_ok() == legal);
        let told = match line {
            Ok(_) => true,
            Err(LineError::HoldsDiffer(place)) => !equal && place == 1,
            Err(LineError::LengthsDoNotMatch) => sections != given,
            Err(LineError::NoLength(place)) => place == no_length,
            Err(LineError::HoldTooShort(place)) => place == short,
            Err(LineError::NoBlocks | LineError::TooManySections | LineError::TrainTooLong) => false,
        };
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, legal);
        e.cover(Cover::Unequal as u32, matches!(line, Err(LineError::HoldsDiffer(_))));
        e.cover(Cover::NoLength as u32, matches!(line, Err(LineError::NoLength(_))));
        e.cover(Cover::Short as u32, matches!(line, Err(LineError::HoldTooShort(_))));
    }
}

harness! {
    /// A line of more than 64 sections is refused, one of 64 is not refused for that, and so is a line without blocks.
    blk_9_size(e)
    theorem "T-BLK-4";
    requirements ["BLK-9"];
    assumptions [];
    bound "five blocks of any size";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        TooMany: "with equal holds a line is refused for its size if and only if it has more than 64 sections",
        Differs: "the first block with another hold is named",
        Empty: "a line without blocks is refused",
    }
    covers {
        Most: "a line of 64 sections",
        TooLong: "a line of 65 sections",
        Unequal: "a line whose last block has another hold",
    }
    {
        let Ok(smallest) = Block::new(1, 1, Hold::NONE, Ticks(1)) else { return e.assume(false) };
        let (mut blocks, mut sections, mut differs) = ([smallest; 5], 0, 5);
        let Some(hold) = any_hold(e, "tail hold (sections)", 1) else { return };
        for (place, block) in blocks.iter_mut().enumerate() {
            let count = any_byte(e, "sections", 12..=14);
            let other = place > 0 && e.word("another hold (1 mod 8: yes)", 0..=7) & 7 == 1;
            let own = if other { Hold::new(hold.sections() ^ 1) } else { Some(hold) };
            let Some(Ok(made)) = own.map(|own| Block::new(count, 1, own, Ticks(1))) else { return e.assume(false) };
            *block = made;
            sections += u32::from(count);
            differs = if other && differs == 5 { place } else { differs };
        }
        // Fewer lengths than there are sections in any case.
        let line = Line::new(blocks, &[Metres(1); 4], Metres(0), Direction::Up);
        e.claim(Claim::TooMany as u32, differs < 5 || matches!(line, Err(LineError::TooManySections)) == (sections > 64));
        e.claim(Claim::Differs as u32, (differs < 5) == matches!(line, Err(LineError::HoldsDiffer(place)) if place == differs));
        e.claim(Claim::Empty as u32, Line::<0>::new([], &[], Metres(0), Direction::Up) == Err(LineError::NoBlocks));
        e.cover(Cover::Most as u32, differs == 5 && sections == 64);
        e.cover(Cover::TooLong as u32, differs == 5 && sections == 65);
        e.cover(Cover::Unequal as u32, differs == 4);
    }
}
