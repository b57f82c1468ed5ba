//! Two kinds of drivers: those who act on telegrams and those who act on signals.

use super::device::{Device, length};
use super::ground::{Ground, Mask, bit};
use super::point::Points;
use super::train::{Driver, Heard, Train, next_speed};

/// How far a driver looks ahead.
const SIGHT_MM: i64 = 2_000_000;

/// What a driver always leaves to the limit: more than rounding may take.
const MARGIN_MM: i64 = 200;

/// What a driver who acts on signals may do.
#[derive(Clone, Copy, Debug)]
struct Sight {
    /// How far he may run.
    distance: i64,
    /// How fast he may run now, so that he keeps the limits ahead.
    speed: i64,
    /// The circuits ahead up to there.
    ahead: Mask,
}

/// The train hears the telegram of the circuit with its front.
pub fn hear(train: &mut Train, ground: &Ground, (device, faces): (&dyn Device, bool), neighbour: Option<Heard>) {
    if train.deaf > 0 {
        train.deaf -= 1;
        train.heard.age += 1;
        if train.heard.age > ground.life {
            train.heard = Heard::STOP;
        }
        return;
    }
    if let Some(heard) = neighbour {
        train.heard = heard;
        return;
    }
    let circuit = train.front_circuit(ground);
    let right = ground.faces_right(&train.front());
    let telegram =
        if circuit < ground.seen { device.heard(circuit, right) } else { super::device::Telegram::default() };
    let meant = !faces || telegram.right == Some(right);
    train.heard = if telegram.hold != 0 && meant {
        Heard {
            limit: train.run + train.to_joint() + length(ground, telegram.hold),
            speed: ground.codes[usize::from(telegram.code)],
            hold: telegram.hold,
            age: 0,
            neighbour: false,
        }
    } else {
        Heard::STOP
    };
}

/// The circuits ahead of the front within `distance`, the first of them at least.
pub fn ahead(train: &Train, ground: &Ground, points: &Points, distance: i64) -> Mask {
    run_over(train, ground, points, |covered, first| covered < distance || first)
}

/// The circuits that the front runs over within `distance`; none if it stays in its own.
pub fn within(train: &Train, ground: &Ground, points: &Points, distance: i64) -> Mask {
    run_over(train, ground, points, |covered, _| covered < distance)
}

/// The circuits ahead of the front, piece by piece while `goes_on` says so of the distance covered, and of whether no other circuit was found yet.
fn run_over(train: &Train, ground: &Ground, points: &Points, goes_on: impl Fn(i64, bool) -> bool) -> Mask {
    let (mut found, mut covered) = (0, train.to_joint());
    let (mut piece, mut joint) = (train.front().piece, train.front().exit);
    let here = bit(train.front_circuit(ground));
    while goes_on(covered, found & !here == 0) {
        let Some(next) = ground.across(joint, piece) else { break };
        let reverse = ground.pieces[next].point.is_some_and(|point| points.lies(point));
        found |= bit(ground.pieces[next].circuit);
        covered += ground.pieces[next].length;
        (joint, piece) = (ground.leave(next, joint, reverse).0, next);
    }
    found & !here
}

/// What the driver decides for the next cycle, with `others` under the other trains: how far the train may run. The authority is noted.
pub fn decide(train: &mut Train, ground: &Ground, points: &Points, (proceed, others): (Mask, Mask)) -> i64 {
    let told = train.heard;
    let by_telegram = (told.limit - train.run).max(0);
    let (distance, speed) = match train.driver {
        Driver::Telegrams => {
            train.authority = if told.speed > 0 { within(train, ground, points, by_telegram) } else { 0 };
            (by_telegram, told.speed)
        }
        Driver::Signals if told.neighbour => {
            train.authority = within(train, ground, points, by_telegram);
            (by_telegram, told.speed)
        }
        Driver::Signals => {
            let sight = look(train, ground, points, (proceed, others));
            train.authority = sight.ahead;
            (sight.distance, sight.speed)
        }
    };
    train.target = train.run + distance;
    let wanted = if train.slid { 0 } else { speed.min(train.pace).min(ground.fastest) };
    // A driver stops a little before the limit, if he can.
    let brakes = train.speed * train.speed / (2 * ground.brake);
    let gap = train.gap.min((distance - brakes).max(0));
    next_speed(train.speed, wanted, distance - gap - MARGIN_MM, ground.brake, ground.cycle_ms)
}

/// Looks ahead from signal to signal. Who waits for the signal ahead may not move.
fn look(train: &Train, ground: &Ground, points: &Points, aspects: (Mask, Mask)) -> Sight {
    let (sight, waits) = seen(train, ground, points, aspects);
    if waits { Sight { distance: 0, ahead: 0, ..sight } } else { sight }
}

/// What the driver sees ahead, and whether he has changed ends and waits for a signal.
fn seen(train: &Train, ground: &Ground, points: &Points, (proceed, others): (Mask, Mask)) -> (Sight, bool) {
    let front = train.front();
    let here = train.front_circuit(ground);
    let on_line = ground.lines.iter().any(|line| line.mask & bit(here) != 0);
    let limits = train.legs.iter().map(|leg| leg.limit).min().unwrap_or(i64::MAX);
    let mut sight = Sight { distance: train.to_joint(), speed: limits.min(ground.fastest), ahead: 0 };
    // Who has changed ends waits for the first signal ahead, and goes if it shows proceed: not while another train stands before it, and over a point only
    // from where a route ends.
    let mut waits = train.about && !on_line && train.route.is_none();
    let reverses = |route: &super::ground::Route| route.reverses && route.path.last() == Some(&here);
    let from_an_end = ground.routes.iter().any(reverses);
    let (mut piece, mut joint, mut route) = (front.piece, front.exit, train.route);
    let at_signal =
        |joint: usize, circuit: usize| ground.routes.iter().any(|route| route.start == joint && route.entry == circuit);
    if on_line && !at_signal(joint, here) {
        sight.speed = sight.speed.min(train.heard.speed);
    }
    while sight.distance < SIGHT_MM {
        let circuit = ground.pieces[piece].circuit;
        if at_signal(joint, circuit) {
            let shown = |number: &usize| {
                let it = &ground.routes[*number];
                let from_afar = waits && circuit != here;
                let counts = if from_afar { others & bit(circuit) == 0 } else { it.approach & bit(here) != 0 };
                it.start == joint && it.entry == circuit && proceed >> number & 1 == 1 && counts
            };
            match (0..ground.routes.len()).find(shown) {
                Some(number) => (route, waits) = (Some(number), false),
                None => return (sight, waits && circuit != here),
            }
        }
        // Where no route goes on, a board stands (`signal-at-the-end`).
        let ends = |route: &super::ground::Route| {
            route.exit == joint && route.path.last() == Some(&circuit) && route.lines[1].is_none()
        };
        if !at_signal(joint, circuit) && ground.routes.iter().any(ends) {
            return (sight, waits && circuit != here);
        }
        let Some(next) = ground.across(joint, piece) else { return (sight, waits) };
        let to = ground.pieces[next].circuit;
        if waits && (others & bit(to) != 0 || ground.pieces[next].point.is_some() && !from_an_end) {
            return (sight, true);
        }
        // Onto plain line, and off it where no signal stands, he keeps to the telegram.
        let is_line = |circuit: usize| ground.lines.iter().any(|line| line.mask & bit(circuit) != 0);
        let by_telegram = to >= ground.seen || is_line(to) || is_line(circuit) && !at_signal(joint, circuit);
        if by_telegram && train.heard.hold & bit(to) == 0 {
            return (sight, waits);
        }
        if route.is_some_and(|route| ground.routes[route].mask & bit(to) == 0) {
            route = None;
        }
        let under = super::train::leg(ground, points, next, joint, route);
        // v² ≤ limit² + 2·b·d: the limit ahead is kept.
        let slow = under.limit.min(ground.fastest);
        let reach = slow * slow + 2 * ground.brake * (sight.distance - 500).max(0);
        sight.speed = sight.speed.min(root(reach));
        sight.ahead |= bit(to);
        sight.distance += under.length;
        (piece, joint) = (next, under.exit);
    }
    (sight, waits)
}

/// The square root, rounded down.
fn root(square: i64) -> i64 {
    square.max(0).isqrt()
}
