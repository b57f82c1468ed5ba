//! Whether the numbered conditions of `spec/assumptions.toml` held in a run: an accident counts only if they did.

use super::ground::Ground;

/// What was measured in a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Measured {
    /// The longest time for which an occupied circuit was reported clear.
    pub loss: i64,
    /// The longest time from a drive to the departure of a point.
    pub departure: i64,
    /// The highest age of a telegram that a train acted on.
    pub age: i64,
    /// Cycles in which a point was detected in a position in which it did not rest.
    pub misdetected: i64,
    /// Signals that a train passed at stop although it could have stopped.
    pub disobeyed: i64,
    /// The greatest loss of speed of a braking train in a cycle was less than the brake's, so often.
    pub weak: i64,
    /// Cycles in which a neighbour sent and consented at once, or sent on a permission that was too old.
    pub neighbour: i64,
    /// The highest speed of a train.
    pub speed: i64,
}

/// The conditions, each with whether it held.
pub fn conditions(ground: &Ground, measured: &Measured) -> Vec<(&'static str, bool)> {
    let stops = ground.fastest * 1000 / (ground.brake * ground.cycle_ms) + ground.life + ground.loss + 2;
    let release = ground.routes.iter().map(|route| route.release).min().unwrap_or(i64::MAX);
    vec![
        ("loss-of-shunt-within-clear", measured.loss + 2 <= ground.clear),
        ("approach-covers-braking", measured.speed <= ground.fastest),
        ("release-covers-residual-running", stops <= release),
        ("points-detect-truly", measured.misdetected == 0),
        ("points-leave-while-driven", measured.departure <= 1),
        ("trains-obey-signals", measured.disobeyed == 0),
        ("gravity", measured.weak == 0),
        ("stop-point-life", measured.age <= ground.life),
        ("turn-outlasts-telegrams", ground.turn > ground.life),
        ("neighbour-turns-alike", measured.neighbour == 0),
    ]
}

/// Those that did not hold.
pub fn broken(ground: &Ground, measured: &Measured) -> Vec<&'static str> {
    conditions(ground, measured).into_iter().filter(|(_, held)| !held).map(|(name, _)| name).collect()
}
