//! The train's position against exact rational arithmetic: where between the curves the measured difference can be, found span by
//! span as fractions; and against trains whose true position is known.

use atc_kernel::distance::Millimetres;
use atc_kernel::position::{
    Correction, Interval, KNOTS, Measured, Millibels, Moved, Position, SPANS, Spacing, Table, TableError, step,
};
use proptest::prelude::*;

/// A fraction; the denominator is above 0.
#[derive(Clone, Copy, Debug)]
struct Ratio(i128, i128);

impl Ratio {
    fn floor(self) -> i128 {
        self.0.div_euclid(self.1)
    }

    fn ceil(self) -> i128 {
        -(-self.0).div_euclid(self.1)
    }

    fn max(self, other: Self) -> Self {
        if self.0 * other.1 < other.0 * self.1 { other } else { self }
    }

    fn min(self, other: Self) -> Self {
        if other.0 * self.1 < self.0 * other.1 { other } else { self }
    }

    fn at_most(self, other: Self) -> bool {
        self.0 * other.1 <= other.0 * self.1
    }
}

/// A table and what is known of the measurement, in plain numbers: hundredths of a decibel and decimetres.
#[derive(Clone, Debug)]
struct Plain {
    exponent: u8,
    low: Vec<i16>,
    high: Vec<i16>,
    tolerance: i16,
    floor: i16,
    correction: (i16, i16),
}

impl Plain {
    fn position(&self) -> Option<Position> {
        let curve = |values: &[i16]| -> [Millibels; KNOTS] { std::array::from_fn(|knot| Millibels(values[knot])) };
        let table = Table::new(Spacing::new(self.exponent)?, curve(&self.low), curve(&self.high)).ok()?;
        let correction = Correction::new(Millibels(self.correction.0), Millibels(self.correction.1))?;
        Position::new(table, Millibels(self.tolerance), Millibels(self.floor), correction)
    }

    /// The part of a span, 0 to 1, in which a line from `start` to `end` is at most `level`.
    fn under(start: i128, end: i128, level: i128) -> Option<(Ratio, Ratio)> {
        let (whole, none) = (Ratio(1, 1), Ratio(0, 1));
        let crossing =
            || if end > start { Ratio(level - start, end - start) } else { Ratio(start - level, start - end) };
        match (start <= level, end <= level) {
            (true, true) => Some((none, whole)),
            (true, false) => Some((none, crossing())),
            (false, true) => Some((crossing(), whole)),
            (false, false) => None,
        }
    }

    /// By the levels alone, in decimetres: where the difference between `least` and `most` lies between the curves.
    fn levels(&self, least: i128, most: i128) -> Option<(i128, i128)> {
        let at = |curve: &[i16], knot: usize| i128::from(curve[knot]);
        let length = 1_i128 << self.exponent;
        let (mut nearest, mut farthest): (Option<i128>, Option<i128>) = (None, None);
        for span in 0..SPANS {
            let (low, high) =
                ((at(&self.low, span), at(&self.low, span + 1)), (at(&self.high, span), at(&self.high, span + 1)));
            let Some(one) = Self::under(low.0, low.1, most) else { continue };
            // At least `least` is at most −`least` of the negated curve.
            let Some(other) = Self::under(-high.0, -high.1, -least) else { continue };
            let (from, to) = (one.0.max(other.0), one.1.min(other.1));
            if !from.at_most(to) {
                continue;
            }
            if low.0 >= low.1 || high.0 >= high.1 {
                return None;
            }
            let start = i128::try_from(span).unwrap() * length;
            let place = |part: Ratio| Ratio(start * part.1 + part.0 * length, part.1);
            nearest = nearest.or(Some(place(from).floor()));
            farthest = Some(place(to).ceil());
        }
        // Beyond the table nothing is known: the difference must be above the lower curve at its end.
        if at(&self.low, SPANS) <= most { None } else { nearest.zip(farthest) }
    }

    /// One cycle, in millimetres.
    fn expected(
        &self,
        before: Option<(i128, i128)>,
        measured: (Option<i16>, Option<i16>),
        moved: (i16, i16),
    ) -> Option<(i128, i128)> {
        let (first, second) = (measured.0?, measured.1?);
        if first < self.floor || second < self.floor {
            return None;
        }
        let difference = i128::from(first) - i128::from(second);
        let off = 2 * i128::from(self.tolerance);
        let least = difference - off + i128::from(self.correction.0);
        let most = difference + off + i128::from(self.correction.1);
        let now = self.levels(least, most).map(|(nearest, farthest)| (nearest * 100, farthest * 100))?;
        let Some(before) = before else { return Some(now) };
        let moved = (before.0 - i128::from(moved.1), before.1 - i128::from(moved.0));
        if moved.0 <= 0 {
            return Some(now);
        }
        let both = (now.0.max(moved.0), now.1.min(moved.1));
        (both.0 <= both.1).then_some(both)
    }
}

fn ends(interval: Interval) -> (i128, i128) {
    (interval.nearest().0.into(), interval.farthest().0.into())
}

fn measured(levels: (Option<i16>, Option<i16>), moved: (i16, i16)) -> Measured {
    let moved = Moved::new(moved.0, moved.1).expect("in order");
    Measured { first: levels.0.map(Millibels), second: levels.1.map(Millibels), moved }
}

prop_compose! {
    /// A table that mostly rises, with flat and falling spans now and then.
    fn plain()(
        exponent in 4..=11_u8,
        steps in prop::collection::vec((prop_oneof![12 => 1..200_i16, 1 => -60..=0_i16], 0..60_i16), KNOTS),
        start in -300..300_i16,
        wild in prop::bool::weighted(0.1),
        (tolerance, floor) in (0..60_i16, -6000..-1000_i16),
        (least, more) in (-200..200_i16, 0..200_i16),
    ) -> Plain {
        let (mut low, mut high) = (Vec::new(), Vec::new());
        let mut level = start;
        let mut apart = 0;
        for (rise, wider) in steps {
            low.push(level);
            high.push(level + apart);
            // The greatest slopes there are, so that nothing overflows.
            level = if wild { if rise % 2 == 0 { i16::MIN } else { i16::MAX - 700 } } else { level + rise };
            apart = if wild { wider } else { (apart + wider).min(600) };
        }
        Plain { exponent, low, high, tolerance, floor, correction: (least, least + more) }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    /// Any measurements, one after the other: exactly the interval of the fractions, rounded outwards to decimetres.
    #[test]
    fn exact(
        plain in plain(),
        cycles in prop::collection::vec(
            (prop::option::weighted(0.95, -3000..0_i16), prop::option::weighted(0.95, -400..3000_i16), -3000..3000_i16, 0..2000_i16),
            1..20,
        ),
    ) {
        let Some(position) = plain.position() else { return Ok(()) };
        let mut state = None;
        for (first, difference, least, more) in cycles {
            let second = difference.map(|difference| first.unwrap_or(-1000) - difference);
            let moved = (least, least + more);
            let expected = plain.expected(state.map(ends), (first, second), moved);
            state = step(&position, state, measured((first, second), moved));
            prop_assert_eq!(state.map(ends), expected, "{:?} {:?}", first, second);
        }
    }

    /// A train somewhere, on ground between the curves, measured within the tolerance and moving within what the odometer says:
    /// it is in every interval.
    #[test]
    fn the_train_is_in_the_interval(
        plain in plain(), start in 0..10_000_u32, weather in 0..=1000_i64,
        errors in prop::collection::vec((-1000..=1000_i64, -1000..=1000_i64, 0..=1000_i64, 0..3000_i16, 0..500_i16, 0..500_i16), 1..30),
    ) {
        let Some(position) = plain.position() else { return Ok(()) };
        let length = 100_i64 << plain.exponent;
        let mut truth = i64::from(start) * 16 * length / 10_000;
        let mut state = None;
        for (one, other, added, moved, less, more) in errors {
            let travelled = i64::from(moved).min(truth);
            truth -= travelled;
            let span = usize::try_from(truth / length).unwrap().min(SPANS - 1);
            let part = truth - i64::try_from(span).unwrap() * length;
            let at = |curve: &[i16]| {
                let (from, to) = (i64::from(curve[span]), i64::from(curve[span + 1]));
                (from * (length - part) + to * part) * 1000
            };
            // In hundredths, times 1000 and the length of a span: exactly between the curves.
            let exact = (at(&plain.low) * (1000 - weather) + at(&plain.high) * weather) / 1000;
            let between = i64::from(plain.correction.0) * (1000 - added) + i64::from(plain.correction.1) * added;
            let difference = exact - between * length;
            let first = -1500 + i64::from(plain.tolerance) * one / 1000;
            // The level is a whole number of hundredths: the error takes up the rest, or there is no such measurement.
            let real = -1500 * 1000 * length - difference;
            let off = i64::from(plain.tolerance) * other * length;
            let second = (real + off).div_euclid(1000 * length);
            let error = (second * 1000 * length - real).abs();
            let within = error <= i64::from(plain.tolerance) * 1000 * length;
            let (Ok(first), Ok(second), true) = (i16::try_from(first), i16::try_from(second), within) else {
                // The train moved on unseen.
                state = None;
                continue;
            };
            let travelled = i16::try_from(travelled).unwrap();
            state = step(&position, state, measured((Some(first), Some(second)), (travelled - less, travelled + more)));
            if let Some((nearest, farthest)) = state.map(ends) {
                let truth = i128::from(truth);
                prop_assert!(nearest <= truth && truth <= farthest, "{} mm is not in {} to {} mm", truth, nearest, farthest);
            }
        }
    }

    /// A wider tolerance, correction or odometer never gives a narrower answer.
    #[test]
    fn wider_input_wider_output(
        plain in plain(), difference in -300..3000_i16, more in 0..50_i16,
        before in prop::option::of((1..3_000_000_u32, 0..500_000_u32)), moved in (-2000..2000_i16, 0..2000_i16), slack in 0..500_i16,
    ) {
        let wide = Plain { tolerance: plain.tolerance + more, correction: (plain.correction.0 - more, plain.correction.1 + more), ..plain.clone() };
        let (Some(narrow), Some(wide)) = (plain.position(), wide.position()) else { return Ok(()) };
        let levels = (Some(-800), Some(-800 - difference));
        let before = before.map(|(nearest, more)| Interval::new(Millimetres(nearest), Millimetres(nearest + more)).unwrap());
        let one = step(&narrow, before, measured(levels, (moved.0, moved.0 + moved.1)));
        let other = step(&wide, before, measured(levels, (moved.0 - slack, moved.0 + moved.1 + slack)));
        if let Some(other) = other.map(ends) {
            // No interval at all is the widest; a narrow one that is empty is none.
            if let Some(one) = one.map(ends) {
                prop_assert!(other.0 <= one.0 && one.1 <= other.1, "{:?} is not in {:?}", one, other);
            }
        }
    }
}

/// The exact comparison meets intervals, odometers that help, and every kind of unknown.
#[test]
fn the_ends_of_what_is_known() {
    let plain = Plain {
        exponent: 8,
        low: (0..17).map(|knot| knot * 50).collect(),
        high: (0..17).map(|knot| knot * 100).collect(),
        tolerance: 10,
        floor: -4000,
        correction: (0, 0),
    };
    let position = plain.position().expect("a sound table");
    let at =
        |first: Option<i16>, second: Option<i16>| step(&position, None, measured((first, second), (0, 0))).map(ends);
    // 2.75 dB less and more 0.2: 255/100 spans of 25.6 m on the upper curve, 295/50 on the lower.
    assert_eq!(at(Some(-2150), Some(-2425)), Some((65_200, 151_100)));
    assert_eq!((at(None, Some(-2425)), at(Some(-2150), None)), (None, None));
    assert!(at(Some(-3725), Some(-4000)).is_some());
    assert_eq!(at(Some(-3726), Some(-4001)), None);
    assert_eq!(at(Some(-4001), Some(-4000)), None);
    // At the far end the lower curve has 8 dB.
    assert!(at(Some(0), Some(-779)).is_some());
    assert_eq!(at(Some(0), Some(-780)), None);
    // And at the near end both have 0.
    assert_eq!(at(Some(0), Some(20)), Some((0, 0)));
    assert_eq!(at(Some(0), Some(21)), None);
    let far = at(Some(0), Some(-400)).expect("an interval");
    let before = Interval::new(Millimetres(100_000), Millimetres(120_000)).expect("in order");
    let after = |moved| step(&position, Some(before), measured((Some(0), Some(-400)), moved)).map(ends);
    assert_eq!(far, (97_200, 215_100));
    assert_eq!(after((0, 0)), Some((100_000, 120_000)));
    assert_eq!(after((1000, 2000)), Some((98_000, 119_000)));
    assert_eq!(after((-30_000, -30_000)), Some((130_000, 150_000)));
    assert_eq!(after((22_801, 22_801)), None, "what is left of the interval is nearer than the levels allow");
    let close = Interval::new(Millimetres(20_000), Millimetres(30_000)).expect("in order");
    let nearly = step(&position, Some(close), measured((Some(0), Some(-400)), (19_999, 19_999)));
    assert_eq!(nearly, None, "it is a millimetre before the transmitter, where the levels say it is not");
    let passed = step(&position, Some(close), measured((Some(0), Some(-400)), (20_000, 20_000)));
    assert_eq!(passed.map(ends), Some(far), "the transmitter may have been passed: the levels alone count");
}

#[test]
fn every_rule_of_the_constructors() {
    let curve = |rise: i16| -> [Millibels; KNOTS] {
        std::array::from_fn(|knot| Millibels(i16::try_from(knot).unwrap() * rise))
    };
    for exponent in 0..=u8::MAX {
        let spacing = Spacing::new(exponent);
        assert_eq!(spacing.is_some(), (4..=11).contains(&exponent));
        assert_eq!(spacing.map(Spacing::decimetres), spacing.map(|_| 1 << u32::from(exponent)));
    }
    let spacing = Spacing::new(4).unwrap();
    let table = |low, high| Table::new(spacing, low, high).map(|_| ());
    assert_eq!(table(curve(1), curve(1)), Ok(()));
    for knot in 0..KNOTS {
        let mut low = curve(1);
        low[knot] = Millibels(low[knot].0 + 1);
        assert_eq!(table(low, curve(1)), Err(TableError::Crossed(knot)));
    }
    assert_eq!(table(curve(0), curve(5)), Err(TableError::NowhereRising));
    assert_eq!(table(curve(-5), curve(-5)), Err(TableError::NowhereRising));
    // One span in which both rise is enough, and the first is as good as the last.
    for span in [0, 7, 15] {
        let mut both = curve(0);
        both[span + 1..].fill(Millibels(1));
        assert_eq!(table(both, both), Ok(()));
    }
    assert!(
        Correction::new(Millibels(1), Millibels(0)).is_none() && Correction::new(Millibels(1), Millibels(1)).is_some()
    );
    assert!(Moved::new(1, 0).is_none() && Moved::new(1, 1).is_some());
    assert!(Interval::new(Millimetres(1), Millimetres(0)).is_none());
    let table = Table::new(spacing, curve(1), curve(1)).unwrap();
    let position = |tolerance| Position::new(table, Millibels(tolerance), Millibels(0), Correction::NONE);
    assert!(position(-1).is_none() && position(0).is_some());
}
