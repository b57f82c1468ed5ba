//! A hunt for an accident of the on-board device: a train on metres, a ground that keeps what it says for as long as the conditions ask of it, and
//! failures of everything between them. Nothing that decides here is taken from the device: what it permits is held against the places, limits and codes
//! that the ground really had.
//!
//! The accidents: the train may run so fast that it cannot stop before any point that the ground still keeps, or it has run over it; it may run faster than
//! the ground's speed, or than the limit under its front; with a code it may run faster than any code that was shown a moment ago.

mod world;

use atc_kernel::Machine;
use atc_kernel::aspect::{Acceptance, AspectId, AspectTable, Times};
use atc_kernel::code::{CodeFrequencies, CodeTable, MAX_CODES, Millihertz};
use atc_kernel::distance::Metres;
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{Basis, Permitted, Settings};
use atc_kernel::position::{Correction, Millibels, Position, Spacing, Table};
use atc_kernel::speed::KmhTenths;
use atc_kernel::supervision::Supervision;
use atc_kernel::telegram::{Gradient, Sequence};
use atc_kernel::time::Ticks;
use atc_kernel::train::{Cab, Parts, Train};
use world::{BROKEN, Broken, Promise, World};

/// The line's speeds, in tenths of km/h.
const SPEEDS: [u16; 5] = [0, 250, 450, 650, 900];
/// A cycle has 100 ms.
const CYCLE_S: f64 = 0.1;
/// Cycles that a frame takes on the main and on the sub carrier.
const FRAME: [i64; 2] = [4, 6];
const FRESH: i64 = 15;
const LIFE: i64 = 40;
const FIXED_LIFE: i64 = 150;
/// T2 + T3: for so long a code is displayed after it was last detected.
const EXPIRY: i64 = 8;
/// A train that brakes from the highest speed on the worst gradient stands after so many cycles: 25 m/s at 0.7 m/s².
const STOPS: i64 = 370;
const MARGIN_M: u16 = 25;
/// A telegram is heard so far beyond the exit of its section.
const BEYOND_MM: i64 = 5_000;
const BRAKE_MM_S2: u16 = 900;
const WORST: i8 = -20;
/// mB a metre, at least; and the width between the curves.
const SLOPE: i64 = 2;
const WIDTH: i64 = 24;

type Device = Train<5>;

fn device() -> Device {
    let nominal = |first: u32| {
        CodeFrequencies::new(&[0, 1, 2, 3, 4].map(|place| Millihertz(first + 6000 * place)), Millihertz(1000)).unwrap()
    };
    let mut named = [[None; MAX_CODES]; MAX_CODES];
    for (place, speed) in SPEEDS.into_iter().enumerate() {
        named[place][place] = Some(KmhTenths(speed));
    }
    let ticks = |cycles: i64| Ticks(u16::try_from(cycles).unwrap());
    let settings = Settings {
        speeds: AspectTable::new(&SPEEDS.map(KmhTenths)).unwrap(),
        lowest: AspectId::new(1).unwrap(),
        brake: Deceleration::brake(BRAKE_MM_S2).unwrap(),
        worst: Gradient(WORST),
        margin: Metres(MARGIN_M),
        fresh: ticks(FRESH),
        life: ticks(LIFE),
        fixed_life: ticks(FIXED_LIFE),
        sequence: Sequence::new(3, 1, Ticks(30)).unwrap(),
    };
    let knots = core::array::from_fn(|knot| i64::try_from(knot).unwrap() * 512 / 10 * SLOPE);
    let level = |mb: i64| Millibels(i16::try_from(mb).unwrap());
    // 51.2 m a span: 819 m in all.
    let table = Table::new(Spacing::new(9).unwrap(), knots.map(level), knots.map(|mb| level(mb + WIDTH))).unwrap();
    let times = Times::from_ticks(Ticks(3), Ticks(4), Ticks(4), Ticks(7), Ticks(1)).unwrap();
    assert_eq!(i64::from(times.expiry().0), EXPIRY);
    Train::new(Parts {
        codes: CodeTable::new(nominal(10_000), nominal(12_000), named).unwrap(),
        acceptance: Acceptance { times },
        permitted: Permitted::new(settings).unwrap(),
        supervision: Supervision::new(KmhTenths(1500), KmhTenths(0)).unwrap(),
        position: Position::new(table, Millibels(4), Millibels(-3000), Correction::NONE),
    })
    .unwrap()
}

impl World {
    /// What is wrong with what is permitted now, if anything is.
    #[allow(clippy::cast_precision_loss)] // Millimetres of a line.
    fn judge(&mut self, cab: &Cab) -> Option<String> {
        (self.brake, self.permitted) = (cab.brake, cab.permission.speed);
        let life = if self.is(Broken::EarlyGround) { LIFE / 2 } else { LIFE };
        // What it says was taken ahead of its sending by a frame at most, and arrives a cycle later.
        let since = self.cycle - life - FRAME[0] - 1;
        // A train that was let run when something was withdrawn has stopped since, or has a point of its own again.
        self.promises.retain(|promise| promise.at >= since - STOPS);
        if let Some(most) = self.promises.iter().map(|promise| promise.stop).max() {
            let way = (most - self.front).max(0) as f64;
            self.came_too_fast &= self.speed * self.speed > f64::from(BRAKE_MM_S2) * way;
            if self.front > most && !self.came_too_fast {
                return Some("it is beyond every point that it was let run to".to_owned());
            }
        }
        let speed = f64::from(self.permitted.filter(|speed| speed.0 > 0)?.0) / 0.036;
        let at = |promise: &&Promise| {
            let way = self.line.iter().filter(|section| section.exit > self.front && section.begin < promise.stop);
            let gradient = way.map(|section| section.gradient).min().unwrap_or(0);
            let brake = (f64::from(BRAKE_MM_S2) + 9.78 * f64::from(gradient)).max(1.0);
            speed * speed <= 2.0 * brake * (promise.stop - self.front).max(0) as f64
        };
        let kept = || self.promises.iter().filter(|promise| promise.at >= since);
        let here = self.section();
        let shown = self.codes.iter().copied().max().unwrap_or(0);
        let top = |rank: u8| f64::from(SPEEDS[usize::from(rank)]) / 0.036;
        match cab.permission.basis {
            Basis::Nothing => return Some("a speed on nothing".to_owned()),
            Basis::Analog if self.line[here].digital => return Some("a code alone on a digital line".to_owned()),
            Basis::Analog => {}
            Basis::Pattern | Basis::Both | Basis::RunningDown => {
                if !kept().any(|promise| at(&promise)) {
                    return Some("it cannot stop before any point that the ground keeps".to_owned());
                }
                if !kept().any(|promise| speed <= top(promise.rank)) {
                    return Some("the ground's speed".to_owned());
                }
                // The lowest limit of a place is not above that of the line; before a section is known, what is behind it counts (PER-15).
                let limit = self.limits.iter().filter(|(_, of, _)| *of == here).map(|(.., rank)| *rank).max();
                if limit.is_some_and(|limit| speed > top(limit.max(1))) {
                    return Some(format!("the limit under its front, {limit:?}"));
                }
            }
        }
        let coded = !matches!(cab.permission.basis, Basis::Pattern);
        (coded && speed > top(shown)).then(|| format!("the codes, at most {shown}"))
    }
}

/// A run to the end of the line, or for so many cycles. Its accident, or how often each basis let it run.
fn ride(device: &Device, seed: u64, broken: Option<Broken>, counts: &mut [u64; 4]) -> Option<String> {
    let mut world = World::new(seed, broken);
    let mut state = device.initial();
    for cycle in 0..6000 {
        let antennas = world.next();
        let (next, cab) = device.step(state, antennas);
        state = next;
        if let Some(accident) = world.judge(&cab) {
            return Some(format!(
                "ride {seed}, cycle {cycle}, front {} of {:?}: {accident}: {cab:?}\n{antennas:?}\n{:?}\n{state:?}",
                world.front,
                world.line[world.section()],
                world.promises
            ));
        }
        let basis = match cab.permission.basis {
            Basis::Analog => 0,
            Basis::Pattern => 1,
            Basis::Both => 2,
            Basis::RunningDown => 3,
            Basis::Nothing => continue,
        };
        counts[basis] += u64::from(cab.permission.speed.is_some_and(|speed| speed.0 > 0) && world.speed > 0.0);
        if world.section() + 3 >= world.line.len() {
            break;
        }
    }
    None
}

/// Of up to 14 km each; more of them with `ATC_RIDES=3000`.
const RIDES: u64 = 300;

#[test]
fn no_ride_ends_in_an_accident() {
    let (device, mut counts) = (device(), [0; 4]);
    let rides = std::env::var("ATC_RIDES").ok().and_then(|rides| rides.parse().ok()).unwrap_or(RIDES);
    for seed in 1..=rides {
        let accident = ride(&device, seed, None, &mut counts);
        assert_eq!(accident, None, "{}", accident.as_deref().unwrap_or_default());
    }
    // Trains do run, on everything that lets them.
    assert!(
        counts.iter().all(|cycles| *cycles > rides * 20),
        "cycles on code, pattern, both, running down: {counts:?}"
    );
}

#[test]
fn each_broken_condition_ends_in_one() {
    let device = device();
    for broken in BROKEN {
        let found = (1..=RIDES).find_map(|seed| ride(&device, seed, Some(broken), &mut [0; 4]));
        assert!(found.is_some(), "{broken:?}: no accident in {RIDES} rides");
    }
}
