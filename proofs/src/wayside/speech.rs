//! From movements to frames and codes (T-WAY-3, T-WAY-4), and what the constructor asks of the signals.

#![allow(clippy::needless_range_loop, reason = "a code is a number in several arrays")]

use super::{LONGEST, plan};
use crate::Engine;
use crate::engine::{any_byte, any_flag};
use crate::interlocking::any_heading;
use atc_kernel::Machine;
use atc_kernel::aspect::{AspectId, AspectTable};
use atc_kernel::code::{Code, CodeFrequencies, CodeTable, MAX_CODES as PLACES, Millihertz};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Contents, Grant, Heading, Layout, MAX_CIRCUITS, MAX_CODES, Movement, SegmentSet, SpeedCode,
    SpeedLimits, Standing, begins, telegram,
};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Counter, Gradient, Length, Route, SectionId};
use atc_kernel::wayside::{
    Codes, Counters, Facing, Fixed, Saying, SignalPlan, Signals, Speech, Wayside, WaysideError, Word, check_codes,
    check_speeds, circuits, spell, words,
};

/// The circuits with a length: the own one, number 0, and three ahead.
const CIRCUITS: usize = 4;
/// The speeds of the trains' table.
const SPEEDS: usize = 3;

const BOUND: &str = "4 circuits, 3 speed codes";
const BOUND_WORDS: &str = "2 speed codes of 8, 4 speeds and 3 pairs of codes";
const BOUND_TABLES: &str = "3 speeds, 2 code frequencies of each carrier";
const BOUND_SAFE: &str = "2 blocks, 2 routes, 2 segments";
const BOUND_SIGNALS: &str = "2 circuits described, 4 used or with a length, 3 speeds";

/// Any lengths of the circuits.
fn any_lengths<E: Engine + ?Sized>(e: &mut E) -> [Metres; MAX_CIRCUITS] {
    let mut lengths = [Metres(0); MAX_CIRCUITS];
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

fn any_facing<E: Engine + ?Sized>(e: &mut E, likely: u16) -> Option<Facing> {
    Some(Facing {
        section: SectionId(e.word("section number", likely..=likely + 2)),
        gradient: Gradient(i8::from_le_bytes([any_byte(e, "gradient (‰, two's complement)", 0..=255)])),
        curve: any_rank(e)?,
    })
}

/// What a speed code is heard as, whatever the tables have.
fn any_word<E: Engine + ?Sized>(e: &mut E, likely: u16) -> Option<Word> {
    let rank = AspectId::new(any_byte(e, "rank of a code", likely..=likely));
    let main = Code::new(any_byte(e, "main code", likely..=likely));
    let sub = Code::new(any_byte(e, "sub code", 0..=0));
    e.assume(rank.is_some() && main.is_some() && sub.is_some());
    Some(Word { rank: rank?, codes: Codes { main: main?, sub: sub? } })
}

/// Signals of circuit 0, and what they are made of.
struct Said {
    signals: Signals,
    fixed: Fixed,
    words: [Option<Word>; MAX_CODES],
    stop: Word,
}

impl Said {
    /// How the highest known code up to `code` is heard.
    fn word(&self, code: SpeedCode) -> Word {
        let mut said = self.stop;
        for number in 1..SPEEDS {
            if let (Some(word), true) = (self.words[number], number <= usize::from(code.0)) {
                said = word;
            }
        }
        said
    }

    /// What trains of a direction of travel know of circuit 0.
    fn its(&self, heading: Heading) -> Facing {
        if heading == Heading::Left { self.fixed.left } else { self.fixed.right }
    }
}

/// Any signals as the constructor makes them (`way_signals`, `way_words`): code 0 is there and stops, and a circuit has two numbers.
fn any_said<E: Engine + ?Sized>(e: &mut E, lengths: &[Metres; MAX_CIRCUITS]) -> Option<Said> {
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
    let mut circuits = [None; MAX_CIRCUITS];
    circuits[0] = Some((fixed, length));
    Some(Said { signals: Signals::from_parts(circuits, words, stop), fixed, words, stop })
}

/// Tables of four speeds, 0, 15, 30 and 45 km/h, the last one without a pair of codes, and signals with nothing else.
fn fixed_tables() -> Option<SignalPlan> {
    let speeds = [KmhTenths(0), KmhTenths(150), KmhTenths(300), KmhTenths(450)];
    let aspects = AspectTable::new(&speeds).ok()?;
    let frequencies = CodeFrequencies::new(&[Millihertz(10_000), Millihertz(15_000)], Millihertz(1_000)).ok()?;
    let mut named = [[None; PLACES]; PLACES];
    (named[0][0], named[0][1], named[1][0]) = (Some(speeds[0]), Some(speeds[1]), Some(speeds[2]));
    let codes = CodeTable::new(frequencies, frequencies, named).ok()?;
    Some(SignalPlan { circuits: [None; MAX_CIRCUITS], speeds: [None; MAX_CODES], aspects, codes })
}

/// Any movement of a train in circuit 0, whatever the ATC may say.
fn any_movement<E: Engine + ?Sized>(e: &mut E) -> Movement {
    let heading = any_heading(e, "heading of the movement (odd: right)");
    Movement {
        stop: CircuitId::ZERO,
        heading: if any_flag(e, "the train may leave its circuit (odd: yes)") { Some(heading) } else { None },
        speed: SpeedCode(any_byte(e, "speed code", 0..=3)),
        hold: CircuitSet::from_bits(u64::from(e.word("granted (bits)", 0..=15) & 15)),
    }
}

/// What trains of a direction of travel are told in circuit 0.
fn heard<E: Engine + ?Sized>(
    e: &mut E,
    lengths: &[Metres; MAX_CIRCUITS],
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

harness! {
    /// What trains are told by a main telegram never permits more than the movement: it is open only under the number of the movement's direction of travel, no
    /// farther than the granted circuits are long together, and rank and codes are those of the movement's code, or of the
    /// highest known one below it.
    t_way_3(e)
    theorem "T-WAY-3";
    requirements ["WAY-3", "WAY-4", "WAY-5"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Read: "the main telegram has this number and the section number of the direction of travel, which trains of the other do not have",
        Open: "it is open only for the movement's direction of travel, and then the distance is that of the granted circuits, or the longest there is",
        Rank: "its rank is that of the movement's code, or of the highest known code below it",
        Codes: "the codes are those of the same code",
        Stop: "for the other direction of travel it is closed, and rank and codes are those of code 0",
    }
    covers {
        Open: "an open telegram",
        Two: "two circuits are granted",
        Saturated: "the granted circuits are longer than a telegram can tell",
        Other: "trains of the other direction of travel hear of an open movement",
        Lower: "the movement's code is not known",
    }
    {
        let lengths = any_lengths(e);
        let Some(said) = any_said(e, &lengths) else { return };
        let movement = any_movement(e);
        let heading = any_heading(e, "heading of the train (odd: right)");
        let Some((told, counters, _)) = heard(e, &lengths, &said, movement, heading) else { return e.claim(Claim::Read as u32, false) };
        let main = told.main;
        let own = main.section == said.its(heading).section && main.section != said.its(heading.opposite()).section;
        e.claim(Claim::Read as u32, own && main.counter == counters.main);
        let mut together = 0_u32;
        for (number, length) in lengths.iter().enumerate().take(CIRCUITS) {
            let granted = movement.hold.bits() >> number & 1 == 1;
            together += if granted { u32::from(length.0) } else { 0 };
        }
        let most = if together < 0xFFFF { together } else { 0xFFFF };
        let meant = movement.heading == Some(heading);
        let distance = match main.route {
            Route::OpenFor(distance) => meant && u32::from(distance.0) == most,
            Route::Closed => !meant,
        };
        e.claim(Claim::Open as u32, distance);
        let word = said.word(movement.speed);
        e.claim(Claim::Rank as u32, !meant || main.speed == word.rank);
        e.claim(Claim::Codes as u32, !meant || told.codes == word.codes);
        e.claim(Claim::Stop as u32, meant || main.speed == said.stop.rank && told.codes == said.stop.codes);
        e.cover(Cover::Open as u32, meant && main.speed != said.stop.rank);
        e.cover(Cover::Two as u32, meant && movement.hold.bits() == 6);
        e.cover(Cover::Saturated as u32, meant && together > 0xFFFF);
        e.cover(Cover::Other as u32, movement.heading.is_some() && !meant);
        e.cover(Cover::Lower as u32, meant && movement.speed.0 == 2 && said.words[2].is_none());
    }
}

harness! {
    /// A ghost train on metres that stops before the end of what it is told, whatever it knows besides, has its front within its own circuit or in one that was
    /// granted: the circuits ahead of it are as long as the layout says, and those that are granted follow its own without a gap.
    t_way_3_train(e)
    theorem "T-WAY-3";
    requirements ["WAY-3"];
    assumptions ["path-complete", "trains-know-facing", "held-routes-compatible"];
    built_in &[
        ("path-complete", "the circuits ahead of the ghost are 1, 2 and 3, with the layout's lengths"),
        ("trains-know-facing", "the ghost uses the telegram of the direction of travel that it faces"),
        ("held-routes-compatible", "what is granted are the first circuits ahead, for the direction in which they lie"),
    ];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Within: "a front beyond the exit is in a granted circuit",
        Faces: "a train that faces the other way does not leave its circuit",
    }
    covers {
        First: "the front is in the first circuit ahead",
        Third: "the front is in the third circuit ahead",
        Faces: "a train faces the other way",
    }
    {
        let lengths = any_lengths(e);
        let Some(said) = any_said(e, &lengths) else { return };
        let ahead = any_heading(e, "direction in which the circuits lie (odd: right)");
        let granted = e.word("circuits granted", 0..=3);
        e.assume(granted <= 3);
        let hold = CircuitSet::from_bits(match granted { 0 => 0, 1 => 2, 2 => 6, _ => 14 });
        let heading = if granted > 0 { Some(ahead) } else { None };
        let speed = SpeedCode(any_byte(e, "speed code", 0..=3));
        let movement = Movement { stop: CircuitId::ZERO, heading, speed, hold };
        let faces = any_heading(e, "heading of the train (odd: right)");
        let Some((told, _, _)) = heard(e, &lengths, &said, movement, faces) else { return e.claim(Claim::Within as u32, false) };
        // Metres of the ghost's front beyond the exit; 0: in its own circuit. It is before the stopping point, or at it.
        let front = u32::from(e.word("front beyond the exit (m)", 0..=900));
        let may = match told.main.route {
            Route::OpenFor(distance) => front <= u32::from(distance.0),
            Route::Closed => front == 0,
        };
        e.assume(may);
        let (mut begins, mut within) = (0_u32, front == 0);
        let mut circuit = 0;
        for (number, length) in lengths.iter().enumerate().take(CIRCUITS).skip(1) {
            let ends = begins + u32::from(length.0);
            let there = front > begins && front <= ends;
            within |= there && hold.bits() >> number & 1 == 1;
            circuit = if there { number } else { circuit };
            begins = ends;
        }
        e.claim(Claim::Within as u32, within);
        e.claim(Claim::Faces as u32, faces == ahead || front == 0);
        e.cover(Cover::First as u32, circuit == 1);
        e.cover(Cover::Third as u32, circuit == 3);
        e.cover(Cover::Faces as u32, faces != ahead && granted > 0);
    }
}

harness! {
    /// What trains are told by a sub telegram is the fixed data of the circuit for their direction of travel, with the layout's length, and a restriction that is not
    /// of a higher code than the temporary restriction of the circuit.
    t_way_3_sub(e)
    theorem "T-WAY-3";
    requirements ["WAY-6"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Read: "the sub telegram has this number and the section number of the direction of travel",
        Fixed: "it has the layout's length, and gradient and curve of the direction of travel",
        Limit: "its restriction is the rank of the temporary restriction, or of the highest known code below it",
    }
    covers {
        Restricted: "the circuit is restricted to code 0",
        Free: "the circuit is not restricted",
    }
    {
        let lengths = any_lengths(e);
        let Some(said) = any_said(e, &lengths) else { return };
        let heading = any_heading(e, "heading of the train (odd: right)");
        let movement = Movement::stop_in(CircuitId::ZERO);
        let Some((told, counters, restrictions)) = heard(e, &lengths, &said, movement, heading) else { return e.claim(Claim::Read as u32, false) };
        let (sub, its) = (told.sub, said.its(heading));
        e.claim(Claim::Read as u32, sub.section == its.section && sub.counter == counters.sub);
        let fixed = sub.length.metres() == lengths[0] && sub.gradient == its.gradient && sub.curve == its.curve;
        e.claim(Claim::Fixed as u32, fixed);
        let mut limit = SpeedCode::MOST;
        for (code, circuits) in (0_u8..).zip(restrictions.parts()) {
            if circuits.bits() & 1 == 1 && code < limit.0 {
                limit = SpeedCode(code);
            }
        }
        e.claim(Claim::Limit as u32, sub.restriction == said.word(limit).rank);
        e.cover(Cover::Restricted as u32, limit.0 == 0 && sub.restriction == said.stop.rank);
        e.cover(Cover::Free as u32, limit == SpeedCode::MOST);
    }
}

harness! {
    /// Where the table cannot be read, the circuit is not occupied, or nothing is granted to the train there, trains of both directions of travel are told a closed
    /// telegram with the rank of code 0, and its codes. That a table of another cycle or a damaged one cannot be read is T-ATC-3.
    t_way_4(e)
    theorem "T-WAY-4";
    requirements ["WAY-5"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Closed: "the telegram is closed",
        Speed: "its rank and the codes are those of code 0",
    }
    covers {
        Stale: "the table cannot be read, and granted",
        Empty: "the table grants, and the circuit is not occupied",
        Nothing: "the circuit is occupied, and nothing is granted",
    }
    {
        let lengths = any_lengths(e);
        let Some(said) = any_said(e, &lengths) else { return };
        let Some(station) = Layout::with_what_proofs_need(plan::<1, 1, 1>()).ok() else { return e.claim(Claim::Closed as u32, false) };
        let here = CircuitSet::nth(0);
        let ahead = CircuitSet::nth(1);
        let (stale, occupied) = (any_flag(e, "the table cannot be read (odd: yes)"), any_flag(e, "the circuit is occupied (odd: yes)"));
        let grants = any_flag(e, "a circuit is granted (odd: yes)");
        let heading = any_heading(e, "heading of the grant (odd: right)");
        let grant = Grant { train: here, circuits: ahead, last: ahead, complete: true, heading, speed: SpeedCode::MOST };
        let contents = Contents {
            occupied: here.only_if(occupied),
            blocked: CircuitSet::EMPTY,
            grants: [if grants { grant } else { Grant::NONE }],
            toward: SegmentSet::EMPTY,
            away: SegmentSet::EMPTY,
            standing: Standing { bodies: [CircuitSet::EMPTY], loose: CircuitSet::EMPTY, limits: SpeedLimits::NONE },
        };
        e.assume(stale || !occupied || !grants);
        let read = if stale { None } else { Some(contents) };
        let begins = read.as_ref().map_or(CircuitSet::EMPTY, |contents| begins(&station, contents));
        let movement = telegram(&station, read.as_ref(), begins, CircuitId::ZERO);
        let faces = any_heading(e, "heading of the train (odd: right)");
        let Some((told, _, _)) = heard(e, &lengths, &said, movement, faces) else { return e.claim(Claim::Closed as u32, false) };
        e.claim(Claim::Closed as u32, told.main.route == Route::Closed);
        e.claim(Claim::Speed as u32, told.main.speed == said.stop.rank && told.codes == said.stop.codes);
        e.cover(Cover::Stale as u32, stale && occupied && grants);
        e.cover(Cover::Empty as u32, !stale && !occupied && grants);
        e.cover(Cover::Nothing as u32, !stale && occupied && !grants);
    }
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
        Falls: "a speed that does not rise over one that is two codes below",
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
                    (Some(low), Some(high)) => lower < higher && high.0 <= low.0,
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
        Exact: "accepted if and only if code 0 is of speed 0, the other is higher, and both have a word",
        Words: "each code with a speed has the rank and the pair of codes of that speed, and no other code has a word",
    }
    covers {
        Accepted: "two speeds are accepted",
        NoRank: "a speed that is not in the table of speeds",
        NoPair: "a speed without a pair of codes",
    }
    {
        let Some(mut signals) = fixed_tables() else { return };
        let case = e.choose("the code besides 0", OTHERS.len());
        let mut other = OTHERS[0];
        for (place, each) in OTHERS.iter().enumerate() {
            other = if place == case { *each } else { other };
        }
        let zero = KmhTenths(e.word("speed of code 0 (tenths of km/h)", 0..=0));
        let high = KmhTenths(e.word("speed of the other code (150, 300 or 450: it has a rank)", 300..=300));
        signals.speeds[0] = if e.word("there is code 0 (odd: yes)", 1..=1) & 1 == 1 { Some(zero) } else { None };
        let there = e.word("there is the other code (odd: yes)", 1..=1) & 1 == 1;
        for number in 1..MAX_CODES {
            signals.speeds[number] = if number == other && there { Some(high) } else { None };
        }
        let made = words(&signals);
        let stops = signals.speeds[0] == Some(KmhTenths(0));
        // 150 and 300 have a rank and a pair, 450 a rank alone.
        let spelt = matches!(high.0, 150 | 300);
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
    /// A circuit in which the ATC is silent gets nothing, whatever is remembered of it; any other that is described gets frames and codes for both directions of travel.
    t_way_8_sent(e)
    theorem "T-WAY-8";
    requirements ["WAY-21"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Silent: "where the ATC is silent nothing is sent",
        Sent: "where it is not, something is sent if and only if the circuit is described",
        Codes: "the codes that are sent are those of what is said to each direction of travel",
    }
    covers {
        Silent: "the ATC is silent in a circuit that is described",
        Sent: "the ATC speaks there",
        Elsewhere: "it speaks in a circuit that is not described",
    }
    {
        let lengths = any_lengths(e);
        let Some(said) = any_said(e, &lengths) else { return };
        let movement = any_movement(e);
        let movement = if any_flag(e, "the ATC is silent (odd: yes)") { None } else { Some(movement) };
        let circuit = CircuitId::new(any_byte(e, "the circuit (number)", 0..=1));
        e.assume(circuit.is_some());
        let Some(circuit) = circuit else { return };
        let counters = Counters { main: Counter(any_byte(e, "number", 0..=255)), sub: Counter(0) };
        let restrictions = SpeedLimits::NONE;
        let sent = said.signals.sent(&lengths, circuit, movement, restrictions, counters);
        e.claim(Claim::Silent as u32, movement.is_some() || sent.is_none());
        let described = circuit.number() == 0;
        e.claim(Claim::Sent as u32, movement.is_none() || sent.is_some() == described);
        let mut codes = true;
        if let (Some(sent), Some(movement)) = (sent, movement) {
            for heading in [Heading::Left, Heading::Right] {
                let goes = movement.heading == Some(heading);
                let word = if goes { said.word(movement.speed) } else { said.stop };
                let its = if heading == Heading::Left { sent.left } else { sent.right };
                codes &= its.codes == word.codes;
            }
        }
        e.claim(Claim::Codes as u32, codes);
        e.cover(Cover::Silent as u32, movement.is_none() && described);
        e.cover(Cover::Sent as u32, sent.is_some());
        e.cover(Cover::Elsewhere as u32, movement.is_some() && !described);
    }
}

harness! {
    /// The safe output is stop at every signal, no drive, no permission, no confirmed block and silence in every circuit.
    way_safe(e)
    theorem "T-WAY-8";
    requirements ["WAY-23"];
    assumptions [];
    bound BOUND_SAFE;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Signals: "no signal shows proceed, no point is driven, no block is confirmed, and no request is answered",
        Neighbours: "no neighbour is told anything",
        Silence: "nothing is sent in any circuit",
    }
    covers {
        Any: "there is one",
    }
    {
        let safe = <Wayside<'_, 2, 2, 1, 1, 2> as Machine>::SAFE;
        let still = safe.proceed.is_empty() && safe.drives.is_empty() && safe.confirmed.is_empty();
        e.claim(Claim::Signals as u32, still && safe.answer.is_none() && safe.line.is_none());
        e.claim(Claim::Neighbours as u32, safe.messages[0].is_none() && safe.messages[1].is_none());
        // Any one of them stands for all.
        let number = usize::from(e.word("a circuit (number)", 0..=63) & 63);
        let mut silent = true;
        for (its, sent) in safe.transmissions.iter().enumerate() {
            silent &= its != number || sent.is_none();
        }
        e.claim(Claim::Silence as u32, silent);
        e.cover(Cover::Any as u32, number == 63);
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
        let Some(mut signals) = fixed_tables() else { return };
        let mut any = |likely| any_facing(e, likely);
        let (Some(left), Some(right), Some(next_left), Some(next_right)) = (any(0), any(2), any(1), any(4)) else { return };
        let (one, other) = (Fixed { left, right }, Fixed { left: next_left, right: next_right });
        signals.circuits[0] = Some(one);
        signals.circuits[1] = Some(other);
        let used = CircuitSet::from_bits(u64::from(e.word("circuits in which trains may be (bits)", 0..=7) & 15));
        let made = circuits(used, &lengths, &signals);
        let ids = [one.left.section.0, one.right.section.0, other.left.section.0, other.right.section.0];
        let mut twice = false;
        for place in 1..4 {
            for earlier in 0..3 {
                twice |= earlier < place && ids[place] == ids[earlier];
            }
        }
        let facing = ids[0] % 2 == 1 && ids[1] % 2 == 0 && ids[2] % 2 == 1 && ids[3] % 2 == 0;
        let described = used.bits() < 4;
        let long = lengths[0].0 > 0 && lengths[1].0 > 0;
        let known = |rank: AspectId| usize::from(rank.rank()) <= SPEEDS;
        let curves = known(one.left.curve) && known(one.right.curve) && known(other.left.curve) && known(other.right.curve);
        e.claim(Claim::Exact as u32, made.is_ok() == (described && long && curves && !twice && facing));
        let told = match made.as_ref().err() {
            None => true,
            Some(WaysideError::CircuitWithoutSignals(_)) => !described,
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
