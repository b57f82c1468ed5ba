//! The braking pattern against wide integers and floating point, over a grid and at the edges.

use atc_kernel::distance::Metres;
use atc_kernel::pattern::{Deceleration, MAX_SPEED, pattern};
use atc_kernel::telegram::Gradient;

/// The distances of the grid: near 0, near 2¹⁶, near powers of two, and every 211th.
fn distances() -> Vec<u16> {
    let powers = (0..16).flat_map(|k| [(1_u32 << k) - 1, 1 << k, (1 << k) + 1]);
    let all = (0..40).chain(powers).chain((0..65_536).step_by(211)).chain(65_500..65_536);
    let mut all: Vec<_> = all.filter_map(|metres| u16::try_from(metres).ok()).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// 2·b·d is 324·b·d/125 in squares of tenths of km/h.
fn is_exact(mm_s2: u16, metres: u16, tenths: u16) -> bool {
    let product = 324 * u128::from(mm_s2) * u128::from(metres);
    let square = |speed: u128| 125 * speed * speed;
    let speed = u128::from(tenths);
    square(speed) <= product && (speed == 4095 || product < square(speed + 1))
}

#[test]
fn exact_over_the_grid() {
    let mut saturated = 0_u32;
    for mm_s2 in (1..=4095).step_by(13).chain([1, 2, 3, 799, 800, 801, 4094, 4095]) {
        let brake = Deceleration::brake(mm_s2).expect("a brake");
        let mut before = 0;
        for metres in distances() {
            let speed = pattern(brake, Metres(metres)).0;
            assert!(is_exact(mm_s2, metres, speed), "{mm_s2} mm/s², {metres} m: {speed}");
            assert!(speed >= before, "{mm_s2} mm/s²: {metres} m allows less than a shorter way");
            saturated += u32::from(speed == MAX_SPEED.0);
            before = speed;
        }
    }
    assert!(saturated > 1000);
}

/// In metres and seconds: never above the real curve, and less than 0.1 km/h below it.
#[test]
fn beside_the_real_curve() {
    for mm_s2 in [1, 455, 800, 1300, 4095] {
        let brake = Deceleration::brake(mm_s2).expect("a brake");
        for metres in distances() {
            let real = 3.6 * (2.0 * f64::from(mm_s2) / 1000.0 * f64::from(metres)).sqrt();
            let speed = f64::from(pattern(brake, Metres(metres)).0) / 10.0;
            assert!(speed <= real + 1e-9, "{mm_s2} mm/s², {metres} m: {speed} above {real}");
            assert!(speed > real - 0.1 - 1e-9 || speed > 409.4, "{mm_s2} mm/s², {metres} m: {speed} far below {real}");
        }
    }
}

/// A train falling gains at least what gravity gives, 9.81 mm/s² a thousandth; one climbing is not credited with more.
#[test]
fn gradients_on_the_safe_side() {
    for mm_s2 in [1, 2, 100, 455, 800, 1229, 1260, 1261, 4095] {
        let brake = Deceleration::brake(mm_s2).expect("a brake");
        for permille in i8::MIN..=i8::MAX {
            let real = f64::from(mm_s2) + 9.81 * f64::from(permille);
            let on = f64::from(brake.on(Gradient(permille)).mm_s2());
            assert!(on <= real.max(0.0), "{mm_s2} mm/s² at {permille} ‰: {on} above {real}");
            // 9.84375 and 9.6875, rounded: at most 18 mm/s² less than 9.81 at 127 ‰.
            let slack = 1.0 + 0.13 * f64::from(permille).abs();
            assert!(on >= real - slack || on == 0.0, "{mm_s2} mm/s² at {permille} ‰: {on} far below {real}");
        }
        assert_eq!(brake.on(Gradient(0)), brake);
    }
}

#[test]
fn edges() {
    let brake = |mm_s2| Deceleration::brake(mm_s2);
    assert_eq!((brake(0), brake(4096), brake(u16::MAX)), (None, None, None));
    let weakest = brake(1).expect("a brake");
    let strongest = brake(4095).expect("a brake");
    assert_eq!(pattern(strongest, Metres(0)).0, 0);
    assert_eq!(pattern(strongest, Metres(u16::MAX)), MAX_SPEED);
    // 2.592 squares of a tenth: 0.1 km/h from one metre at 1 mm/s².
    assert_eq!(pattern(weakest, Metres(1)).0, 1);
    // A gradient that the brake cannot hold: no speed at any distance.
    assert_eq!(pattern(weakest.on(Gradient(-1)), Metres(u16::MAX)).0, 0);
    // 0.8 m/s² over 250 m is 20 m/s, and 72 km/h exactly.
    assert_eq!(pattern(brake(800).expect("a brake"), Metres(250)).0, 720);
    assert_eq!(pattern(brake(800).expect("a brake"), Metres(249)).0, 718);
}
