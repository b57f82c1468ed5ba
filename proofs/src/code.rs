//! Analog codes: theorems T-CODE-1 to T-CODE-3, over any code frequencies and any table of speeds.

use crate::{Engine, Harness, any_u32};
use atc_kernel::code::{Code, CodeError, CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::speed::KmhTenths;

/// The harnesses of this module.
#[cfg(not(chosen))]
pub const ALL: &[Harness] =
    &[t_code_1::HARNESS, t_code_2::HARNESS, t_code_2_wrong::HARNESS, t_code_3::HARNESS, t_code_3_table::HARNESS];

/// Arbitrary frequencies; likely to be those of codes with bands that do not touch.
fn any_frequencies<E: Engine + ?Sized>(e: &mut E) -> [u32; MAX_CODES] {
    let mut frequencies = [0; MAX_CODES];
    let mut likely = 10;
    for frequency in &mut frequencies {
        *frequency = any_u32(e, "code frequency (mHz)", likely..=likely + 3);
        likely += 10;
    }
    frequencies
}

/// A code, or none; any of the eight.
fn any_code<E: Engine + ?Sized>(e: &mut E, what: &'static str) -> Option<u8> {
    let place = e.word(what, 0..=8);
    e.assume(place <= 8);
    if place < 8 { Some(place.to_le_bytes()[0]) } else { None }
}

/// The entry of a table, found the slow way; `None` where a code is missing.
fn entry<T: Copy>(table: &[[Option<T>; MAX_CODES]; MAX_CODES], main: Option<u8>, sub: Option<u8>) -> Option<T> {
    let mut found = None;
    for (row, of_main) in (0..).zip(table) {
        for (column, speed) in (0..).zip(of_main) {
            found = if main == Some(row) && sub == Some(column) { *speed } else { found };
        }
    }
    found
}

/// By how much the codes of the sub carrier are above those of the main carrier: more than a band is wide.
const SUB: u32 = 5;

/// The codes of a carrier where no other number says.
const CODES: usize = if cfg!(kani) { 4 } else { MAX_CODES };

/// Some frequencies of a carrier with `count` codes; `above` those of the main carrier.
fn carrier<E: Engine + ?Sized>(e: &mut E, count: usize, above: u32) -> Option<CodeFrequencies> {
    let eight = [10, 20, 30, 40, 50, 60, 70, 80].map(|frequency| Millihertz(frequency + above));
    let carrier = eight.get(..count).and_then(|codes| CodeFrequencies::new(codes, Millihertz(2)).ok());
    e.assume(carrier.is_some());
    carrier
}

/// Any set of pairs, each with a speed: its own place is enough to tell it from the others.
fn any_speeds<E: Engine + ?Sized>(e: &mut E) -> [[Option<KmhTenths>; MAX_CODES]; MAX_CODES] {
    let mut speeds = [[None; MAX_CODES]; MAX_CODES];
    let first = e.word("speed of the first pair (tenths of km/h)", 0..=100);
    let none = e.word("no pair at all (1 mod 8: yes)", 0..=7) & 7 == 1;
    let mut place = 0;
    for (row, of_main) in (0_u16..).zip(&mut speeds) {
        let pairs = e.word("pairs of a main code (bits by sub code)", 1 << row..=1 << row);
        let pairs = if none { 0 } else { pairs };
        for (column, speed) in of_main.iter_mut().enumerate() {
            *speed = if pairs >> column & 1 == 1 { Some(KmhTenths(first ^ place)) } else { None };
            place += 1;
        }
    }
    speeds
}

harness! {
    /// A measured frequency is taken for a code if and only if it is within the tolerance of that code's frequency, and so for
    /// one code at most.
    t_code_1(e)
    theorem "T-CODE-1";
    requirements ["CODE-1"];
    assumptions ["printed-sizes"];
    bound "1 to 3 code frequencies";
    cases 3;
    unwind 33 = 1 + 4 * MAX_CODES;
    claims {
        Exact: "the code is named if and only if the frequency is within the tolerance of that code's, ends included",
        Alone: "a frequency is within the tolerance of one code at most",
        Kept: "what is asked of the codes is what they were made of",
    }
    covers {
        Edge: "a frequency at the end of a band",
        Beside: "a frequency that is off by one more",
        Last: "the last code is named",
    }
    {
        let count = e.choose("codes, less 1", 3) + 1;
        let nominal = any_frequencies(e);
        let tolerance = any_u32(e, "tolerance (mHz)", 1..=3);
        let codes = CodeFrequencies::new(&nominal.map(Millihertz)[..count], Millihertz(tolerance));
        let Ok(codes) = codes else { return e.assume(false) };
        let measured = any_u32(e, "measured frequency (mHz)", 6..=18);
        let (mut within, mut edge, mut beside, mut number) = (None, false, false, 0);
        for (place, frequency) in (0_u8..).zip(nominal) {
            let off = measured.abs_diff(frequency);
            let used = usize::from(place) < count;
            number += u32::from(used && off <= tolerance);
            within = if used && off <= tolerance { Some(place) } else { within };
            edge |= used && off == tolerance;
            beside |= used && off > tolerance && off - tolerance == 1;
        }
        let code = codes.identify(Millihertz(measured)).map(Code::place);
        e.claim(Claim::Exact as u32, code == within);
        e.claim(Claim::Alone as u32, number <= 1);
        let mut kept = codes.tolerance() == Millihertz(tolerance) && codes.nominal().len() == count;
        for (place, frequency) in nominal.into_iter().enumerate().take(count) {
            kept &= codes.nominal().get(place) == Some(&Millihertz(frequency));
        }
        e.claim(Claim::Kept as u32, kept);
        e.cover(Cover::Edge as u32, edge && code.is_some());
        e.cover(Cover::Beside as u32, beside && code.is_none());
        e.cover(Cover::Last as u32, within.is_some_and(|place| usize::from(place) + 1 == count));
    }
}

harness! {
    /// Two codes name the speed of their pair in the table, and none if one is missing or the pair is not in it.
    t_code_2(e)
    theorem "T-CODE-2";
    requirements ["CODE-2"];
    assumptions [];
    bound "";
    cases 1;
    unwind 33 = 1 + 4 * MAX_CODES;
    under_kani "4 codes of each carrier";
    claims {
        Exact: "the speed is that of the pair in the table",
        Missing: "a missing code names no speed",
        Heard: "two measured frequencies name the speed of the codes in whose bands they are, and none if one is in no band or missing",
    }
    covers {
        Named: "a pair names a speed",
        Unlisted: "two codes whose pair is not in the table",
        Beside: "one measured frequency in no band",
    }
    {
        let (Some(main), Some(sub)) = (carrier(e, CODES, 0), carrier(e, CODES, SUB)) else { return };
        let speeds = any_speeds(e);
        let Ok(table) = CodeTable::new(main, sub, speeds) else { return e.assume(false) };
        let (main, sub) = (any_code(e, "main code (8: none)"), any_code(e, "sub code (8: none)"));
        let named = table.speed(main.and_then(Code::new), sub.and_then(Code::new));
        let listed = entry(&speeds, main, sub);
        e.claim(Claim::Exact as u32, named == listed);
        e.claim(Claim::Missing as u32, named.is_none() || main.is_some() && sub.is_some());
        // The band of code n is 10 (n + 1) ± 2 on the main carrier, and 5 more on the sub carrier.
        let [off, sub_off] = ["main carrier off by (mHz)", "sub carrier off by (mHz)"].map(|what| u32::from(e.word(what, 0..=3)));
        let frequency = |code: Option<u8>, above: u32| code.map(|code| Millihertz(10 * (u32::from(code) + 1) + above));
        e.assume(off <= 5 && sub_off <= 5);
        let heard = table.heard(frequency(main, off & 7), frequency(sub, SUB + (sub_off & 7)));
        e.claim(Claim::Heard as u32, heard == if off <= 2 && sub_off <= 2 { listed } else { None });
        e.cover(Cover::Named as u32, named.is_some() && heard.is_some());
        e.cover(Cover::Unlisted as u32, named.is_none() && main.is_some() && sub.is_some());
        e.cover(Cover::Beside as u32, named.is_some() && heard.is_none() && (off <= 2 || sub_off <= 2));
    }
}

harness! {
    /// The table says that it detects one wrong code if and only if no pair that names a speed becomes another such pair when
    /// one of its codes is taken for another one.
    t_code_2_wrong(e)
    theorem "T-CODE-2";
    requirements ["CODE-2"];
    assumptions [];
    bound "";
    cases 1;
    unwind 33 = 1 + 4 * MAX_CODES;
    under_kani "4 codes of each carrier";
    claims {
        Detected: "if it does, a listed pair of which one code is taken for another names no speed",
        Undetected: "if it does not, there is a listed pair of which one code can be taken for another so that it names a speed",
    }
    covers {
        Yes: "a table that detects one wrong code, with two pairs",
        Row: "a table in which two pairs share a main code",
        Column: "a table in which two pairs share a sub code, and none a main code",
    }
    {
        let (Some(main), Some(sub)) = (carrier(e, CODES, 0), carrier(e, CODES, SUB)) else { return };
        let speeds = any_speeds(e);
        let Ok(table) = CodeTable::new(main, sub, speeds) else { return e.assume(false) };
        let says = table.detects_one_wrong_code();
        let [main, sub, wrong] = ["main code", "sub code", "wrong code"].map(|what| e.word(what, 0..=7).to_le_bytes()[0] & 7);
        let listed = entry(&speeds, Some(main), Some(sub)).is_some();
        let by_main = main != wrong && table.speed(Code::new(wrong), Code::new(sub)).is_some();
        let by_sub = sub != wrong && table.speed(Code::new(main), Code::new(wrong)).is_some();
        e.claim(Claim::Detected as u32, !says || !listed || !by_main && !by_sub);
        // All pairs of pairs that share one code.
        let (mut row, mut column, mut pairs) = (false, false, 0);
        let named = |main: usize, sub: usize| u32::from(speeds[main][sub].is_some());
        for line in 0..MAX_CODES {
            let (mut in_row, mut in_column) = (0, 0);
            for place in 0..MAX_CODES {
                in_row += named(line, place);
                in_column += named(place, line);
            }
            row |= in_row > 1;
            column |= in_column > 1;
            pairs += in_row;
        }
        e.claim(Claim::Undetected as u32, says || row || column);
        e.cover(Cover::Yes as u32, says && pairs > 1);
        e.cover(Cover::Row as u32, !says && row);
        e.cover(Cover::Column as u32, !says && column && !row);
    }
}

harness! {
    /// The constructor of code frequencies accepts exactly what CODE-3 allows, and its error names the first rule that is broken
    /// and the first place.
    t_code_3(e)
    theorem "T-CODE-3";
    requirements ["CODE-3"];
    assumptions ["printed-sizes"];
    bound "0 to 3 code frequencies, and 9";
    cases 5;
    unwind 33 = 1 + 4 * MAX_CODES;
    claims {
        Exact: "accepted if and only if there are 1 to 8, no band reaches 0 or beyond the highest number, and each band is above the one before it",
        Told: "the error names the first rule that is broken, and the first place where bands touch",
    }
    covers {
        Accepted: "frequencies are accepted, or there are none or 9",
        Range: "a band is out of range, or there are none or 9 frequencies",
        Touch: "two bands touch, or there are fewer than 2 or more than 8 frequencies",
    }
    {
        let count = match e.choose("frequencies (4: 9 of them)", 5) {
            4 => 9,
            few => few,
        };
        let eight = any_frequencies(e);
        let mut given = [Millihertz(100); 9];
        for (place, frequency) in eight.into_iter().enumerate() {
            given[place] = Millihertz(frequency);
        }
        let tolerance = any_u32(e, "tolerance (mHz)", 1..=10);
        let made = CodeFrequencies::new(&given[..count], Millihertz(tolerance));
        let last = given[count.saturating_sub(1)].0;
        let range = given[0].0 <= tolerance || last > u32::MAX - tolerance;
        let mut touch = 9;
        for place in (1..count).rev() {
            let (below, above) = (given[place - 1].0, given[place].0);
            // Twice the tolerance, in two steps that cannot overflow.
            let apart = above > below && above - below > tolerance && above - below - tolerance > tolerance;
            touch = if apart { touch } else { place };
        }
        let size = count == 0 || count > 8;
        e.claim(Claim::Exact as u32, made.is_ok() == (!size && !range && touch == 9));
        let told = match made {
            Ok(_) => true,
            Err(CodeError::NoFrequency) => count == 0,
            Err(CodeError::TooManyFrequencies) => count > 8,
            Err(CodeError::OutOfRange) => !size && range,
            Err(CodeError::BandsTouch(place)) => !size && !range && place == touch,
            Err(CodeError::NoSpeed | CodeError::UnusedCode(..)) => false,
        };
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, size || made.is_ok());
        e.cover(Cover::Range as u32, size || matches!(made, Err(CodeError::OutOfRange)));
        e.cover(Cover::Touch as u32, size || count == 1 || matches!(made, Err(CodeError::BandsTouch(_))));
    }
}

harness! {
    /// The constructor of a code table accepts exactly what CODE-4 allows, keeps it, and its error names the broken rule and the
    /// first pair with a code that is not in use.
    t_code_3_table(e)
    theorem "T-CODE-3";
    requirements ["CODE-4"];
    assumptions [];
    bound "";
    cases MAX_CODES;
    unwind 33 = 1 + 4 * MAX_CODES;
    apart [0 1 2 3 4 5 6 7];
    claims {
        Exact: "accepted if and only if it names a speed, and none for a code that is not in use",
        Told: "the error names the rule that is broken, and the first pair, by main code and then by sub code",
        Kept: "the codes of main and sub carrier are kept as given",
    }
    covers {
        Accepted: "a table is accepted",
        Empty: "a table names no speed",
    }
    {
        let mains = e.choose("codes of the main carrier, less 1", MAX_CODES) + 1;
        let subs = usize::from(e.word("codes of the sub carrier, less 1", 0..=7) & 7) + 1;
        let (Some(main), Some(sub)) = (carrier(e, mains, 0), carrier(e, subs, SUB)) else { return };
        let speeds = any_speeds(e);
        let made = CodeTable::new(main, sub, speeds);
        let (mut any, mut unused) = (false, None);
        for row in (0..MAX_CODES).rev() {
            for column in (0..MAX_CODES).rev() {
                let listed = speeds[row][column].is_some();
                any |= listed;
                unused = if listed && (row >= mains || column >= subs) { Some((row, column)) } else { unused };
            }
        }
        e.claim(Claim::Exact as u32, made.is_ok() == (any && unused.is_none()));
        let told = match made {
            Ok(_) => true,
            Err(CodeError::NoSpeed) => !any,
            Err(CodeError::UnusedCode(row, column)) => unused == Some((row, column)),
            Err(_) => false,
        };
        e.claim(Claim::Told as u32, told);
        e.claim(Claim::Kept as u32, made.is_err() || made.is_ok_and(|table| *table.main() == main && *table.sub() == sub));
        e.cover(Cover::Accepted as u32, made.is_ok());
        e.cover(Cover::Empty as u32, matches!(made, Err(CodeError::NoSpeed)));
    }
}
