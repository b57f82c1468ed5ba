//! Sets of large stations (T-LAY-3): the code of the kernel is the same for both sizes, but for the bits of a set. Here is what that
//! code counts on, of every operation, for one number that stands for all.

use super::any::{any_circuits, any_route, any_route_state};
use crate::engine::{any_byte, any_flag};
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Contents, Element, Epoch, Grant, Large, Phase, PointId, PointSet, SegmentId, SegmentSet,
    Size, Small, SpeedLimits, Standing, Table,
};

/// What a set says of a number, without the kernel's own reading of it.
macro_rules! has {
    ($set:expr, $number:expr, $width:literal) => {{
        let mut has = false;
        for (place, word) in $set.words().iter().enumerate() {
            has |= place == usize::from($number / $width) && word >> ($number % $width) & 1 == 1;
        }
        has
    }};
}

/// What every set of a large station does: two sets, and a number that stands for all. Answers the claims in their order.
macro_rules! laws {
    ($e:ident, $set:ident, $id:ident, $word:ident, $width:literal) => {{
        let mut words = [[0; 4]; 2];
        for set in &mut words {
            for word in set.iter_mut() {
                *word = $word($e);
            }
        }
        let (one, other) = ($set::<Large>::from_words(words[0]), $set::<Large>::from_words(words[1]));
        let number = $e.word("a number that stands for all", 0..=($width * 4)) & 1023;
        let there = number < $width * 4;
        let in_one = there && has!(one, number, $width);
        let in_other = there && has!(other, number, $width);
        let both = has!(one.and(other), number, $width) == (in_one && in_other);
        let either = has!(one.or(other), number, $width) == (in_one || in_other);
        let left = has!(one.without(other), number, $width) == (in_one && !in_other);
        let second = $e.word("another number", 0..=($width * 4)) & 1023;
        let wanted = second & 1 == 1;
        let kept = has!(one.only_if(wanted), number, $width) == (in_one && wanted);
        $e.claim(Claim::Parts as u32, !there || both && either && left && kept);
        let alone = $set::<Large>::nth(usize::from(second));
        let same = there && second == number;
        $e.claim(Claim::Alone as u32, !there || has!(alone, number, $width) == same);
        let its = $id::new((number & 255).to_le_bytes()[0]).is_some_and(|id| one.has(id));
        $e.claim(Claim::Has as u32, (!there || its == in_one) && one.has_number(usize::from(number)) == in_one);
        let meets = one.meets(other);
        let first = one.first().map(|id| u16::from(id.number()));
        let in_first = first.is_some_and(|first| has!(one, first, $width));
        let lowest = !in_one || first.is_some_and(|first| first <= number);
        $e.claim(Claim::First as u32, (first.is_none() || in_first) && lowest && one.is_empty() == first.is_none());
        let common = one.and(other).first().is_some();
        $e.claim(Claim::Meets as u32, meets == common && (meets || !in_one || !in_other));
        let all = one.contains(other);
        let missing = other.without(one).first().is_some();
        $e.claim(Claim::Contains as u32, all != missing && (!all || !in_other || in_one));
        let rest = first.map(|first| one.without($set::nth(usize::from(first))));
        $e.claim(Claim::One as u32, one.is_one() == rest.is_some_and(|rest| rest.is_empty()));
        $e.cover(Cover::Far as u32, meets && first.is_some_and(|first| first >= $width * 3));
        $e.cover(Cover::Beyond as u32, second >= $width * 4);
        $e.cover(Cover::Several as u32, in_one && first.is_some_and(|first| first / $width < number / $width));
    }};
}

fn long<E: crate::Engine + ?Sized>(e: &mut E) -> u64 {
    let mut word = 0;
    for _ in 0..4 {
        word = word << 16 | u64::from(e.word("bits of a set", 0..=1));
    }
    word
}

fn middle<E: crate::Engine + ?Sized>(e: &mut E) -> u32 {
    u32::from(e.word("bits of a set", 0..=1)) << 16 | u32::from(e.word("bits of a set", 0..=1))
}

fn short<E: crate::Engine + ?Sized>(e: &mut E) -> u8 {
    e.word("bits of a set", 0..=1).to_le_bytes()[0]
}

harness! {
    /// Sets of circuits, points and segments of a large station do of every number what their names say. Sets of routes are those of circuits.
    t_lay_3(e)
    theorem "T-LAY-3";
    requirements ["LAY-3"];
    assumptions [];
    bound "";
    cases 3;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Parts: "a number is in both, in either, in the one and not the other, or in one that is wanted, exactly if it is",
        Alone: "the set of one number has that number and no other; of a number that there is no room for, none",
        Has: "a thing is in a set exactly if its number is, and none of a number that there is no room for",
        First: "the first number is in the set, none that is in it is lower, and there is one unless the set is empty",
        Meets: "two sets meet exactly if a number is in both",
        Contains: "one contains the other exactly if no number of the other is missing",
        One: "a set has exactly one number if without its first it is empty",
    }
    covers {
        Far: "two sets meet, and the first number is in the last word",
        Beyond: "a number that there is no room for",
        Several: "numbers in two words",
    }
    {
        match e.choose("circuits, points or segments", 3) {
            0 => laws!(e, CircuitSet, CircuitId, long, 64),
            1 => laws!(e, PointSet, PointId, middle, 32),
            _ => laws!(e, SegmentSet, SegmentId, short, 8),
        }
    }
}

harness! {
    /// Of the places of a list a large station looks at those in use, each in its own place; whatever the number in use is said to be.
    t_lay_3_used(e)
    theorem "T-LAY-3";
    requirements ["LAY-4"];
    assumptions [];
    bound "";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        All: "each place in use is looked at, in its place, and has what it has there",
        None: "no place that is not in use is looked at, where so many places are there at all",
    }
    covers {
        Full: "all places are in use",
        More: "more places are said to be in use than there are",
        Empty: "none is",
    }
    {
        let places: [u8; 32] = core::array::from_fn(|place| place.to_le_bytes()[0]);
        let length = any_byte(e, "the number of places in use", 0..=33);
        let used = Large::used(&places, length);
        let it = any_byte(e, "a place that stands for all", 0..=32);
        let found = used.get(usize::from(it));
        let there = it < 32 && it < length;
        e.claim(Claim::All as u32, !there || found == Some(&it));
        e.claim(Claim::None as u32, length > 32 || it < length || found.is_none());
        e.cover(Cover::Full as u32, length == 32 && found.is_some());
        e.cover(Cover::More as u32, length > 32 && found.is_some());
        e.cover(Cover::Empty as u32, used.is_empty());
    }
}

harness! {
    /// A large station does not look at what an idle route holds and grants: that is nothing, and it stays idle.
    t_lay_3_idle(e)
    theorem "T-LAY-3";
    requirements ["LAY-5"];
    assumptions [];
    bound "1 route of up to 4 circuits, 32 circuits, 16 points";
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Nothing: "an idle route in a valid state holds no place of its path, no overlap and nothing on the way to its signal, and wants and locks no point",
        Stays: "it stays as it is, whether what it needs is ready or not",
        Held: "and a route that holds anything is looked at, in a station of either size",
    }
    covers {
        There: "an idle route over a circuit that is occupied",
        Held: "a route that is held",
    }
    {
        let route = any_route::<E, 4>(e, 0);
        let state = any_route_state(e);
        let occupied = any_circuits(e, "occupied (bits)", 0..=15);
        let ready = any_flag(e, "what it needs is ready (odd: yes)");
        let idle = state.is_valid(&route) && !state.is_asked::<Large>();
        let holds = state.path(&route).or(state.overlap(&route));
        let wants = state.locks() || state.phase == Phase::Provisional;
        let nothing = holds == Element::NONE && state.before_signal(&route, occupied).is_empty() && !wants;
        e.claim(Claim::Nothing as u32, !idle || nothing);
        let stays = !idle || state.follow(&route, occupied).reserve(&route, occupied, ready) == state;
        e.claim(Claim::Stays as u32, stays);
        let asked = state.is_asked::<Large>() && state.is_asked::<Small>();
        e.claim(Claim::Held as u32, state.phase == Phase::Idle || asked);
        e.cover(Cover::There as u32, idle && route.exists() && route.circuit_at(0).meets(occupied));
        e.cover(Cover::Held as u32, state.is_valid(&route) && asked);
    }
}

harness! {
    /// Whatever number of a set of the shared table of a large station is wrong, the table cannot be read.
    t_lay_3_check(e)
    theorem "T-LAY-3";
    requirements ["LAY-3", "ATC-5"];
    assumptions [];
    bound "1 route, one wrong bit, contents in the first and the last word";
    cases 3;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    claims {
        Unreadable: "a table with one wrong bit in a set is not read",
        Read: "the right one is, in its own cycle alone",
    }
    covers {
        Last: "the wrong bit is in the last word",
    }
    {
        let sets = [CircuitSet::<Large>::from_words([long(e), 0, 0, long(e)]), CircuitSet::EMPTY];
        let case = e.choose("the set that is wrong: occupied, granted, towards the station", 3);
        let number = usize::from(e.word("the number that is wrong", 0..=255) & 255);
        let bit = CircuitSet::nth(number);
        let flipped = |set: CircuitSet<Large>, wrong: bool| {
            set.without(bit).or(bit.without(set)).only_if(wrong).or(set.only_if(!wrong))
        };
        let segment = SegmentSet::nth(number % 32);
        let contents = |at: usize| {
            let set = |place: usize| flipped(sets[place], at == place);
            Contents::<1, Large> {
                occupied: set(0),
                blocked: CircuitSet::EMPTY,
                grants: [Grant { circuits: set(1), ..Grant::NONE }],
                toward: segment.only_if(at == 2),
                away: SegmentSet::EMPTY,
                standing: Standing { bodies: [CircuitSet::EMPTY], loose: CircuitSet::EMPTY, limits: SpeedLimits::NONE },
            }
        };
        let right = Table::write(Epoch(1), contents(3));
        let (epoch, check, _) = right.parts();
        let wrong = Table::from_parts(epoch, check, contents(case));
        e.claim(Claim::Unreadable as u32, wrong.read(Epoch(1)).is_none());
        e.claim(Claim::Read as u32, right.read(Epoch(1)).is_some() && right.read(Epoch(2)).is_none());
        e.cover(Cover::Last as u32, number >= 192);
    }
}
