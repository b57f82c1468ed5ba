//! Trains that act on codes alone, on metres: do they stop within what they are granted?
//!
//! The ground is the kernel's interlocking and ATC, with the distances of the codes as `layout` derives them. The train has a front and a tail. A lower
//! code is obeyed only when the one before is as old as a telegram may be, a higher one at once; a train that is faster than its code brakes, with
//! the brake that every train has or a stronger one, as it likes. Lines are drawn, and those on which a train comes farthest are changed a little.
//! Without what a code's distance holds for steps the search finds an accident at once (eighth attack).

mod line;

use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{MAX_CODES, code_stops_within};
use atc_kernel::pattern::Deceleration;
use line::{Line, Place, SPEEDS, derived, derived_up_to, steps};

/// xorshift: the same numbers on every machine.
struct Dice(u64);

impl Dice {
    fn below(&mut self, number: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % number
    }

    fn between(&mut self, least: u16, most: u16) -> u16 {
        least + u16::try_from(self.below(u64::from(most - least) + 1)).expect("below a u16")
    }
}

/// The age of a telegram (ms) and the brake (mm/s²).
const TRAINS: [(u32, u16); 4] = [(1_000, 800), (5_000, 800), (5_000, 1_200), (8_000, 500)];

/// How far beyond its place, in mm, a train comes on so many lines, at the worst; with `less` metres taken from the distance of each code.
fn farthest(place: Place, train: (u32, u16), less: u16, runs: usize) -> (i64, Vec<u16>) {
    let braking = derived(train.0, train.1, 0).map(|distance| distance.map(|metres| metres.saturating_sub(less)));
    search(place, Line { braking: &braking, ..of(train) }, runs)
}

/// What is true of such trains, on no line yet.
const fn of((age_ms, brake): (u32, u16)) -> Line<'static> {
    Line {
        lengths: &[],
        braking: &[None; MAX_CODES],
        age_ms,
        brakes: [brake; 2],
        builds_up: (0, 0),
        heard_beyond: 0,
        lost: 0,
    }
}

/// The same of what is true of trains and distances.
fn search(place: Place, trains: Line<'_>, runs: usize) -> (i64, Vec<u16>) {
    let brake = trains.brakes[0];
    let mut dice = Dice(0x0139_408d_cbbf_7a44);
    let mut worst = (i64::MIN, Vec::new(), 0);
    for _ in 0..runs {
        let known: &(i64, Vec<u16>, i64) = &worst;
        let (lengths, moment) = if known.1.is_empty() || dice.below(2) == 0 {
            let count = 4 + dice.below(5);
            ((0..count).map(|_| dice.between(50, 500)).collect(), -i64::from(dice.between(1, 1_000)) * 1_000)
        } else {
            let mut lengths: Vec<u16> = known.1.clone();
            let changed = usize::try_from(dice.below(lengths.len() as u64)).expect("a place");
            lengths[changed] = (lengths[changed] + dice.between(0, 60)).saturating_sub(30).clamp(50, 600);
            (lengths, known.2 + i64::from(dice.between(0, 20_000)) - 10_000)
        };
        let stronger = if dice.below(2) == 0 { brake } else { dice.between(brake, 2 * brake) };
        let line = Line { lengths: &lengths, brakes: [brake, stronger], ..trains };
        if let Some(beyond) = line.run(place, moment).filter(|beyond| *beyond > worst.0) {
            worst = (beyond, lengths, moment);
        }
    }
    (worst.0, worst.1)
}

/// Behind a train that stands.
#[test]
fn a_train_by_codes_stops_behind_the_one_ahead() {
    for train in TRAINS {
        let (beyond, lengths) = farthest(Place::Train, train, 0, 600);
        assert!(beyond <= 0, "{train:?}: {beyond} mm too far over circuits of {lengths:?} m");
        assert!(beyond > -60_000, "{train:?}: none came nearer than {beyond} mm, so this shows nothing");
    }
}

/// Before a signal whose route was withdrawn, and which nothing holds any more.
#[test]
fn a_train_by_codes_stops_before_a_signal_that_was_given_up() {
    for train in TRAINS {
        let (beyond, lengths) = farthest(Place::Signal, train, 0, 500);
        assert!(beyond <= 0, "{train:?}: {beyond} mm too far over circuits of {lengths:?} m");
        assert!(beyond > -60_000, "{train:?}: none came nearer than {beyond} mm, so this shows nothing");
    }
}

/// The old rule: the distance of a code held one age, and a train that brakes in steps takes two.
#[test]
fn without_the_steps_it_does_not() {
    for (train, metres) in [(TRAINS[1], 10), (TRAINS[2], 15), (TRAINS[3], 16)] {
        assert_eq!(steps(train), metres);
        for place in [Place::Train, Place::Signal] {
            let (beyond, _) = farthest(place, train, metres, 500);
            assert!(beyond > 500, "{train:?}, {place:?}: {beyond} mm");
        }
    }
}

/// Why `codes-kept-from-below` is a condition: while its brake builds up a train gains speed on a fall, and was as fast as its code before (ninth attack).
#[test]
fn a_train_that_is_faster_than_its_code_before_it_brakes_comes_too_far() {
    let braking = derived(2_000, 800, 0);
    let gains = |mm_s2| Line { braking: &braking, builds_up: (1_000, mm_s2), ..of((2_000, 800)) };
    let (beyond, _) = search(Place::Train, gains(200), 300);
    assert!(beyond > 500, "{beyond} mm");
    let (beyond, lengths) = search(Place::Train, gains(0), 300);
    assert!(beyond <= 0, "{beyond} mm too far over circuits of {lengths:?} m without a gain");
}

/// Why two stations count on one age: a train of the neighbour acts on what it heard for 8 s, and the distances hold 1 s (tenth attack).
#[test]
fn a_train_that_acts_for_longer_than_the_station_counts_on_comes_too_far() {
    for (counted_ms, too_far) in [(1_000, true), (8_000, false)] {
        let braking = derived(counted_ms, 800, 0);
        let line = Line { lengths: &[210; 8], braking: &braking, ..of((8_000, 800)) };
        // With 1 s the approach has 420 m: the route that is withdrawn is released at once.
        for place in [Place::Train, Place::Signal] {
            let beyond = line.run(place, -425_000);
            assert_eq!(beyond.is_some_and(|mm| mm > 50_000), too_far, "{counted_ms} ms, {place:?}: {beyond:?} mm");
            assert!(too_far || beyond.is_none_or(|mm| mm <= 0), "{place:?}: {beyond:?} mm");
        }
    }
}

/// A code that is heard beyond its circuit, leakage and the metres from antenna to nose together, while the front is not reported there: its shunt is lost
/// for 1.5 s. The distances hold these metres, or a train comes too far (tenth attack).
#[test]
fn a_code_that_is_heard_beyond_its_circuit() {
    const METRES: u16 = 30;
    for (held, heard_beyond, too_far) in [(0, 0, false), (0, METRES, true), (METRES, METRES, false)] {
        let braking = derived(1_000, 800, held);
        let trains = Line { braking: &braking, heard_beyond, lost: 15, ..of((1_000, 800)) };
        for place in [Place::Train, Place::Signal] {
            let (beyond, lengths) = search(place, trains, 200);
            let what = format!("{heard_beyond} m, {held} held, {place:?}: {beyond} mm over circuits of {lengths:?} m");
            assert_eq!(beyond > 0, too_far, "{what}");
            assert!(!too_far || beyond > 10_000, "{what}");
        }
    }
}

/// How far a train comes beyond its end, in mm, that has just the room to stop with the brake of its pattern, and is told a code just where the
/// distance of that is left. It brakes to the code, goes on at it until it is as old as may be, and brakes again. In steps of 1 ms.
fn beyond_from_telegrams(kmh: u32, metres: u16, (age_ms, pattern): (u32, u16), speed_mm_s: i64) -> i64 {
    let (brake, code) = (i64::from(pattern), i64::from(kmh) * 1_000_000_000 / 3_600);
    let room = (i64::from(metres) * 1_000).max(speed_mm_s * speed_mm_s / (2 * brake) + 1);
    // µm/s and nm.
    let (mut speed, mut run, mut time) = (speed_mm_s * 1_000, 0_i64, 0);
    while speed > 0 {
        if time < age_ms {
            speed = if speed > code { code.max(speed - brake) } else { code };
        } else {
            speed -= brake;
        }
        run += speed.max(0);
        time += 1;
    }
    run / 1_000_000 - room
}

/// A train that comes from telegrams to codes, by a stronger pattern than the brake which the distances hold: it may be so fast that it goes on at a low
/// code for too long. With the pattern in the layout it does not (a reader of T-ATC-8).
#[test]
fn a_train_that_comes_from_telegrams() {
    let worst = |strongest: Option<u16>, (age_ms, weakest): (u32, u16), pattern: u16| {
        let distances = derived_up_to(age_ms, weakest, 0, strongest);
        let codes = SPEEDS.into_iter().zip(distances.into_iter().skip(1));
        let of = |(kmh, metres): (u32, Option<u16>)| {
            let metres = metres.expect("a distance");
            (0..30_000).step_by(100).map(move |speed| beyond_from_telegrams(kmh, metres, (age_ms, pattern), speed))
        };
        codes.flat_map(of).max().expect("some speeds")
    };
    for (train, pattern) in [((8_000, 500), 1_200), ((5_000, 800), 1_600), ((8_000, 500), 1_000)] {
        assert!(worst(None, train, pattern) > 500, "{train:?} {pattern}: nothing to hold against");
        // Every brake between the two as well.
        for between in (train.1..=pattern).step_by(100) {
            let beyond = worst(Some(pattern), train, between);
            assert!(beyond <= 0, "{train:?}, up to {pattern}, with {between}: {beyond} mm");
        }
    }
    // One brake needs no more than its own.
    assert!(worst(None, (8_000, 500), 500) <= 0);
}

/// What the kernel takes for enough, and what `layout` derives, against exact numbers: (c + b·a)² ≤ 2·b·d, all in 1/9000 mm/s.
#[test]
fn a_distance_is_enough_and_hardly_more() {
    for (age_ms, brake) in TRAINS.into_iter().chain([(0, 1_000), (20_000, 1_300), (1, 4_095)]) {
        let of = Deceleration::brake(brake).expect("a brake");
        let exact = |kmh: u32, metres: u16| {
            let speed = 2_500_000 * u128::from(kmh) + 9 * u128::from(brake) * u128::from(age_ms);
            speed * speed <= 162_000_000_000 * u128::from(brake) * u128::from(metres)
        };
        for (kmh, derived) in SPEEDS.into_iter().zip(derived(age_ms, brake, 0).into_iter().skip(1)) {
            let enough =
                |metres: u16| code_stops_within(of, u16::try_from(kmh).expect("a speed"), age_ms, Metres(metres));
            let least = (0..u16::MAX).find(|metres| enough(*metres)).expect("a distance");
            assert!(exact(kmh, least), "{kmh} km/h, {brake} mm/s², {age_ms} ms: {least} m is not enough");
            assert!(
                least == 0 || !exact(kmh, least - 1),
                "{kmh} km/h, {brake} mm/s², {age_ms} ms: {least} m is too much"
            );
            let derived = derived.expect("a distance");
            assert!((least..=least + 3).contains(&derived), "{kmh} km/h: {derived} m for {least} m");
        }
        assert!(!code_stops_within(of, u16::MAX, u32::MAX, Metres(u16::MAX)), "what is too much for the numbers");
    }
}
