//! Both trains on the ground of `atc_tests::ground`, and the example that is drawn from it.

use atc_tests::ground::{self, LENGTH_MM, Moment, SECTIONS, STOP_MM, Train, drive};

const EXAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../oracle/examples/speed-pattern.jsonl");

#[test]
fn the_example_is_this_drive() {
    let now = format!("{}{}", ground::lines(Train::New), ground::lines(Train::Conventional));
    let committed = std::fs::read_to_string(EXAMPLE).unwrap_or_default();
    if committed != now {
        let fresh = concat!(env!("CARGO_TARGET_TMPDIR"), "/speed-pattern.jsonl");
        std::fs::write(fresh, now).expect("a file");
        panic!("renew it: cp {fresh} {EXAMPLE}");
    }
}

fn last(moments: &[Moment]) -> &Moment {
    moments.last().expect("a drive")
}

/// The new train stops before the point and uses the way to it; the conventional one needs the overlap, and stays in it.
#[test]
fn where_the_trains_stop() {
    let new = drive(Train::New);
    let margin = i64::from(ground::config().margin_m) * 1000;
    let front = last(&new).at_mm;
    assert!(front <= STOP_MM, "{front} mm is beyond the stopping point");
    assert!(front >= STOP_MM - margin - 6000, "{front} mm is far before the stopping point");
    let conventional = last(&drive(Train::Conventional)).at_mm;
    assert!(STOP_MM < conventional && conventional < STOP_MM + LENGTH_MM, "{conventional} mm");
}

/// Nothing flaps: where the permission falls, it does not rise again within the time of three frames.
#[test]
fn the_permission_does_not_flap_at_a_border() {
    let speeds: Vec<_> = drive(Train::New).iter().map(|moment| moment.output.speed_km_h).collect();
    let first = speeds.iter().position(|speed| speed.is_some_and(|speed| speed.0 > 250)).expect("it goes");
    for (cycle, window) in speeds.windows(8).enumerate().skip(first) {
        let (before, after) = (window[0], window[7]);
        let least = window.iter().min().copied().flatten();
        assert!(least >= before.min(after), "cycle {cycle}: {window:?}");
    }
}

/// At no place is more permitted than the ground allows there: the code, the restriction of the sub telegram, and a speed from
/// which the service brake on the real gradient stops the train before the point. In floating point, and from the ground alone.
#[test]
#[allow(clippy::cast_precision_loss)] // Millimetres of a short line.
fn never_more_than_the_ground_allows() {
    let (mut bound_by_pattern, mut bound_by_limit) = (0, 0);
    for moment in drive(Train::New) {
        let place = usize::try_from(moment.at_mm / LENGTH_MM).expect("on the line");
        let section = SECTIONS[place.min(5)];
        let permitted = moment.output.speed_km_h.map_or(0.0, |speed| f64::from(speed.0) / 10.0);
        assert!(permitted <= f64::from(section.code.0) / 10.0, "the code at {}: {permitted}", moment.at_mm);
        let brake = 0.8 + 9.81 * f64::from(section.gradient_permille) / 1000.0;
        let left = ((STOP_MM - moment.at_mm) as f64 / 1000.0).max(0.0);
        let curve = 3.6 * (2.0 * brake * left).sqrt();
        // A train that has not heard the new section yet runs on what the last one said of the way to the same point.
        let heard = moment.output.state.as_ref().and_then(|state| state.section) == u16::try_from(section.number).ok();
        if heard {
            assert!(permitted <= curve, "the curve at {}: {permitted} above {curve:.1}", moment.at_mm);
            let speeds = ground::config().speeds_km_h;
            let limit = f64::from(speeds[section.limit_rank as usize].0) / 10.0;
            assert!(permitted <= limit, "the limit at {}: {permitted}", moment.at_mm);
            bound_by_limit += u32::from(limit < 75.0 && (permitted - limit).abs() < 0.05);
            bound_by_pattern += u32::from(permitted < limit && permitted * 10.0 < f64::from(section.code.0));
        }
    }
    assert!(bound_by_pattern > 20 && bound_by_limit > 20, "{bound_by_pattern} {bound_by_limit}");
}

/// What the sub telegram tells is not assumed before it is there: until then the lowest limit holds, or that of the section behind.
#[test]
fn the_worst_until_the_sub_telegram() {
    let config = ground::config();
    let (mut waits, mut carried) = (0, 0);
    for moment in drive(Train::New) {
        let state = moment.output.state.expect("the oracle says it");
        let Some(section) = state.section else { continue };
        if state.sub.iter().all(|sub| sub.section != section) {
            let permitted = moment.output.speed_km_h.expect("a code is there");
            let place = SECTIONS.iter().position(|one| one.number == u32::from(section)).expect("of the line");
            let behind = place.checked_sub(1).map(|behind| config.speeds_km_h[SECTIONS[behind].limit_rank as usize]);
            let limit = behind.map_or(config.lowest_limit_km_h, |limit| limit.max(config.lowest_limit_km_h));
            assert!(permitted <= limit, "{permitted} at {} mm", moment.at_mm);
            waits += 1;
            carried += u32::from(permitted > config.lowest_limit_km_h);
        }
    }
    assert!(waits > 0 && carried > 0, "{waits} {carried}");
}
