//! What the constructor asks of the signals: circuits' data, speeds of codes, and their words (T-WAY-8).

#![allow(clippy::needless_range_loop, reason = "a code is a number in several arrays")]

use super::plans::LONGEST;
use super::said::{SPEEDS, any_facing, any_lengths, any_word};
use atc_kernel::aspect::{AspectId, AspectTable};
use atc_kernel::code::{CodeFrequencies, CodeTable, MAX_CODES as PLACES, Millihertz};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{CircuitSet, MAX_CODES, PerCircuit, SpeedCode};
use atc_kernel::speed::KmhTenths;
use atc_kernel::wayside::{Codes, Fixed, WaysideError, check_codes, check_speeds, circuits, spell, words};

const BOUND_WORDS: &str = "2 speed codes of 8, 4 speeds and 3 pairs of codes";
const BOUND_TABLES: &str = "3 speeds, 2 code frequencies of each carrier";
const BOUND_SIGNALS: &str = "2 circuits described, 4 used or with a length, 3 speeds";

/// Tables of four speeds, 0, 15, 30 and 45 km/h, the last one without a pair of codes.
fn fixed_tables() -> Option<(AspectTable, CodeTable)> {
    let speeds = [KmhTenths(0), KmhTenths(150), KmhTenths(300), KmhTenths(450)];
    let aspects = AspectTable::new(&speeds).ok()?;
    let frequencies = CodeFrequencies::new(&[Millihertz(10_000), Millihertz(15_000)], Millihertz(1_000)).ok()?;
    let mut named = [[None; PLACES]; PLACES];
    (named[0][0], named[0][1], named[1][0]) = (Some(speeds[0]), Some(speeds[1]), Some(speeds[2]));
    let codes = CodeTable::new(frequencies, frequencies, named).ok()?;
    Some((aspects, codes))
}

harness! {
    /// Speeds of codes rise from 0 if and only if code 0 is of speed 0, and of any two codes with a speed the higher code has the higher speed.
    way_speeds(e)
    theorem "T-WAY-8";
    requirements ["WAY-16"];
    assumptions [];
    bound "";
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Exact: "accepted if and only if every rule is kept",
        Told: "the error names a rule that is broken, and a code at which it is",
    }
    covers {
        Accepted: "three speeds are accepted",
        Falls: "a speed under that of two codes below",
        Equal: "two codes of one speed are accepted",
        Moves: "code 0 is of another speed",
    }
    {
        let mut speeds = [None; MAX_CODES];
        for (number, speed) in (0_u16..).zip(speeds.iter_mut()) {
            let its = KmhTenths(e.word("speed of a code (tenths of km/h)", number..=number + number / 6));
            *speed = if e.word("there is such a code (odd: yes)", 0..=1) & 1 == 1 { Some(its) } else { None };
        }
        let made = check_speeds(&speeds);
        let stops = speeds[0] == Some(KmhTenths(0));
        let (mut rises, mut gap, mut named) = (true, false, false);
        let at = match made {
            Err(WaysideError::SpeedsFall(code)) => usize::from(code.0),
            _ => 0,
        };
        for higher in 1..MAX_CODES {
            for lower in 0..MAX_CODES {
                let falls = match (speeds[lower], speeds[higher]) {
                    (Some(low), Some(high)) => lower < higher && high.0 < low.0,
                    _ => false,
                };
                rises &= !falls;
                gap |= falls && lower + 2 == higher && speeds[lower + 1].is_none();
                named |= falls && higher == at;
            }
        }
        e.claim(Claim::Exact as u32, made.is_ok() == (stops && rises));
        let told = match made {
            Ok(()) => true,
            Err(WaysideError::SpeedsFall(_)) => named,
            Err(error) => error == WaysideError::StopMoves && !stops,
        };
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, made.is_ok() && speeds[1].is_some() && speeds[7].is_some());
        e.cover(Cover::Falls as u32, made.is_err() && gap);
        e.cover(Cover::Equal as u32, made.is_ok() && speeds[6].is_some() && speeds[6] == speeds[7]);
        e.cover(Cover::Moves as u32, made == Err(WaysideError::StopMoves) && speeds[0].is_some());
    }
}

/// The codes that `way_words` takes besides code 0, one after the other.
const OTHERS: [usize; 2] = [1, MAX_CODES - 1];

harness! {
    /// Each code with a speed has the word of that speed (`way_word`), no other code has one, and without a word the speeds are refused.
    way_words(e)
    theorem "T-WAY-8";
    requirements ["WAY-16"];
    assumptions [];
    bound BOUND_WORDS;
    cases OTHERS.len();
    unwind 65 = 1 + LONGEST;
    claims {
        Exact: "accepted if and only if code 0 is of speed 0, and both have a word",
        Words: "each code with a speed has the rank and the pair of codes of that speed, and no other code has a word",
    }
    covers {
        Accepted: "two speeds are accepted",
        NoRank: "a speed that is not in the table of speeds",
        NoPair: "a speed without a pair of codes",
    }
    {
        let Some((aspects, codes)) = fixed_tables() else { return };
        let mut speeds = [None; MAX_CODES];
        let case = e.choose("the code besides 0", OTHERS.len());
        let mut other = OTHERS[0];
        for (place, each) in OTHERS.iter().enumerate() {
            other = if place == case { *each } else { other };
        }
        let zero = KmhTenths(e.word("speed of code 0 (tenths of km/h)", 0..=0));
        let high = KmhTenths(e.word("speed of the other code (150, 300 or 450: it has a rank)", 300..=300));
        speeds[0] = if e.word("there is code 0 (odd: yes)", 1..=1) & 1 == 1 { Some(zero) } else { None };
        let there = e.word("there is the other code (odd: yes)", 1..=1) & 1 == 1;
        for number in 1..MAX_CODES {
            speeds[number] = if number == other && there { Some(high) } else { None };
        }
        let made = words(&speeds, &aspects, &codes);
        let stops = speeds[0] == Some(KmhTenths(0));
        // 0, 150 and 300 have a rank and a pair, 450 a rank alone.
        let spelt = matches!(high.0, 0 | 150 | 300);
        e.claim(Claim::Exact as u32, made.is_ok() == (stops && (!there || spelt)));
        let mut named = true;
        if let Ok(words) = &made {
            for code in 0..MAX_CODES {
                let speed = if code == 0 { Some(0) } else if code == other && there { Some(high.0) } else { None };
                named &= match (words[code], speed) {
                    (Some(word), Some(speed)) => {
                        let (main, sub) = (word.codes.main.place(), word.codes.sub.place());
                        matches!((speed, word.rank.rank(), main, sub), (0, 0, 0, 0) | (150, 1, 0, 1) | (300, 2, 1, 0))
                    }
                    (None, None) => true,
                    _ => false,
                };
            }
        }
        e.claim(Claim::Words as u32, named);
        e.cover(Cover::Accepted as u32, made.is_ok() && there);
        e.cover(Cover::NoRank as u32, matches!(made, Err(WaysideError::NoRank(_))));
        e.cover(Cover::NoPair as u32, matches!(made, Err(WaysideError::NoPair(_))));
    }
}

harness! {
    /// With any tables of the trains: a speed has a word if and only if it has a rank and a pair of codes, and by those tables rank and pair name that very speed.
    way_word(e)
    theorem "T-WAY-8";
    requirements ["WAY-4", "WAY-16"];
    assumptions [];
    bound BOUND_TABLES;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Exact: "there is a word if and only if the speed is in both tables",
        Told: "the error names the table in which it is not",
        Rank: "the rank is that of the speed",
        Pair: "the pair of codes names the speed",
    }
    covers {
        Spelt: "a speed of rank 2 is spelt by the last pair",
        Twice: "two pairs name the speed",
        NoRank: "a speed without a rank that has a pair",
        NoPair: "a speed without a pair",
    }
    {
        let mut ranks = [KmhTenths(0); SPEEDS];
        for (likely, rank) in (0_u16..).zip(&mut ranks) {
            *rank = KmhTenths(e.word("a speed (tenths of km/h)", likely..=likely));
        }
        let mut named = [[None; PLACES]; PLACES];
        for row in 0..2 {
            for column in 0..2 {
                let its = KmhTenths(e.word("speed of a pair of codes (tenths of km/h)", 0..=3));
                named[row][column] = if e.word("the pair names a speed (odd: yes)", 0..=1) & 1 == 1 { Some(its) } else { None };
            }
        }
        let aspects = AspectTable::new(&ranks).ok();
        let frequencies = CodeFrequencies::new(&[Millihertz(10_000), Millihertz(15_000)], Millihertz(1_000)).ok();
        let codes = frequencies.and_then(|its| CodeTable::new(its, its, named).ok());
        e.assume(aspects.is_some() && codes.is_some());
        let (Some(aspects), Some(codes)) = (aspects, codes) else { return };
        let speed = KmhTenths(e.word("the speed (tenths of km/h)", 0..=3));
        let made = spell(&aspects, &codes, SpeedCode(1), speed);
        let (mut ranked, mut paired, mut twice) = (false, false, false);
        let (mut rank_is, mut pair_is) = (false, false);
        for rank in 0..SPEEDS {
            let its = ranks[rank] == speed;
            ranked |= its;
            rank_is |= its && made.is_ok_and(|word| usize::from(word.rank.rank()) == rank);
        }
        for row in 0..2 {
            for column in 0..2 {
                let its = named[row][column] == Some(speed);
                twice |= its && paired;
                paired |= its;
                let at = |codes: Codes| (usize::from(codes.main.place()), usize::from(codes.sub.place())) == (row, column);
                pair_is |= its && made.is_ok_and(|word| at(word.codes));
            }
        }
        e.claim(Claim::Exact as u32, made.is_ok() == (ranked && paired));
        let told = match made {
            Ok(_) => true,
            Err(WaysideError::NoRank(code)) => !ranked && code == SpeedCode(1),
            Err(error) => error == WaysideError::NoPair(SpeedCode(1)) && !paired,
        };
        e.claim(Claim::Told as u32, told);
        e.claim(Claim::Rank as u32, made.is_err() || rank_is);
        e.claim(Claim::Pair as u32, made.is_err() || pair_is);
        e.cover(Cover::Spelt as u32, made.is_ok_and(|word| word.rank.rank() == 2 && word.codes.main.place() == 1));
        e.cover(Cover::Twice as u32, made.is_ok() && twice);
        e.cover(Cover::NoRank as u32, made.is_err() && paired);
        e.cover(Cover::NoPair as u32, made == Err(WaysideError::NoPair(SpeedCode(1))));
    }
}

harness! {
    /// The circuits' data are accepted if and only if every circuit in which trains may be is described and has a length, curves are in the trains' table, no section
    /// number stands twice, and odd numbers are for trains to the left, even ones for those to the right. The error names a rule that is broken. What is kept is what was given, with the layout's lengths.
    way_signals(e)
    theorem "T-WAY-8";
    requirements ["WAY-18", "WAY-19"];
    assumptions [];
    bound BOUND_SIGNALS;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Exact: "accepted if and only if every rule is kept",
        Told: "the error names a rule that is broken",
        Kept: "the circuits' data are those of the plan with the layout's lengths, and there are no others",
    }
    covers {
        Accepted: "signals of two circuits are accepted",
        Curve: "a curve limit that trains do not know",
        Twice: "a section number stands twice",
        Other: "a number of the other direction of travel",
        Missing: "a circuit in which trains may be is not described",
    }
    {
        let lengths = any_lengths(e);
        let Some((aspects, _)) = fixed_tables() else { return };
        let mut any = |likely| any_facing(e, likely);
        let (Some(left), Some(right), Some(next_left), Some(next_right)) = (any(0), any(2), any(1), any(4)) else { return };
        let (one, other) = (Fixed { left, right }, Fixed { left: next_left, right: next_right });
        let mut described = PerCircuit::all(None);
        described[0] = Some(one);
        described[1] = Some(other);
        let used = CircuitSet::from_bits(u64::from(e.word("circuits in which trains may be (bits)", 0..=7) & 15));
        let made = circuits(used, &lengths, &described, &aspects);
        let ids = [one.left.section.0, one.right.section.0, other.left.section.0, other.right.section.0];
        let mut twice = false;
        for place in 1..4 {
            for earlier in 0..3 {
                twice |= earlier < place && ids[place] == ids[earlier];
            }
        }
        let facing = ids[0] % 2 == 1 && ids[1] % 2 == 0 && ids[2] % 2 == 1 && ids[3] % 2 == 0;
        let all = used.bits() < 4;
        let long = lengths[0].0 > 0 && lengths[1].0 > 0;
        let known = |rank: AspectId| usize::from(rank.rank()) <= SPEEDS;
        let curves = known(one.left.curve) && known(one.right.curve) && known(other.left.curve) && known(other.right.curve);
        e.claim(Claim::Exact as u32, made.is_ok() == (all && long && curves && !twice && facing));
        let told = match made.as_ref().err() {
            None => true,
            Some(WaysideError::CircuitWithoutSignals(_)) => !all,
            Some(WaysideError::NoLength(_)) => !long,
            Some(WaysideError::UnknownCurve(_)) => !curves,
            Some(WaysideError::SectionNumberTwice(_)) => twice,
            Some(WaysideError::SectionNumberOfOther(_)) => !facing,
            Some(_) => false,
        };
        e.claim(Claim::Told as u32, told);
        let mut kept = true;
        if let Ok(made) = &made {
            for (circuit, fixed) in [one, other].into_iter().enumerate() {
                kept &= made[circuit].is_some_and(|(its, length)| its == fixed && length.metres() == lengths[circuit]);
            }
            for none in made.iter().skip(2) {
                kept &= none.is_none();
            }
        }
        e.claim(Claim::Kept as u32, kept);
        e.cover(Cover::Accepted as u32, made.is_ok());
        e.cover(Cover::Curve as u32, matches!(made, Err(WaysideError::UnknownCurve(_))));
        e.cover(Cover::Twice as u32, matches!(made, Err(WaysideError::SectionNumberTwice(_))));
        e.cover(Cover::Other as u32, matches!(made, Err(WaysideError::SectionNumberOfOther(_))));
        e.cover(Cover::Missing as u32, matches!(made, Err(WaysideError::CircuitWithoutSignals(_))));
    }
}

harness! {
    /// Every code for which the layout has a braking distance must have a word, and nothing else is asked; the error names a code without one.
    way_codes(e)
    theorem "T-WAY-8";
    requirements ["WAY-17"];
    assumptions [];
    bound "";
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Exact: "accepted if and only if every code with a braking distance has a word",
        Told: "the error names a code with a braking distance and no word",
    }
    covers {
        Accepted: "accepted, with a code that has no braking distance",
        Unsaid: "a code with a braking distance has no word",
    }
    {
        let Some(word) = any_word(e, 0) else { return };
        let (mut words, mut braking) = ([None; MAX_CODES], [Metres(u16::MAX); MAX_CODES]);
        let (mut every, mut none) = (true, false);
        for code in 0..MAX_CODES {
            words[code] = if e.word("there is such a code (odd: yes)", 1..=1) & 1 == 1 { Some(word) } else { None };
            let there = e.word("there is a braking distance for a code (odd: yes)", 0..=1) & 1 == 1;
            let distance = e.word("braking distance (m)", 0..=100);
            braking[code] = Metres(if there { distance } else { u16::MAX });
            every &= words[code].is_some() || braking[code].0 == u16::MAX;
            none |= braking[code].0 == u16::MAX;
        }
        let made = check_codes(&words, &braking);
        e.claim(Claim::Exact as u32, made.is_ok() == every);
        let told = match made {
            Ok(()) => true,
            Err(WaysideError::CodeWithoutSpeed(code)) => {
                let mut named = false;
                for number in 0..MAX_CODES {
                    let its = number == usize::from(code.0);
                    named |= its && words[number].is_none() && braking[number].0 < u16::MAX;
                }
                named
            }
            Err(_) => false,
        };
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, made.is_ok() && none);
        e.cover(Cover::Unsaid as u32, made.is_err());
    }
}
