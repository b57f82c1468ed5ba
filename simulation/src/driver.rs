//! A driver: obeys the cab signal (or motors whatever it says), stops where the train is to stop, and otherwise runs as fast as may be.

use crate::motion::Dynamics;

/// What drivers do with the cab signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drivers {
    /// They obey it.
    Careful,
    /// They motor whatever it says, and brake for the stop at a station alone, at the mark or where nothing is permitted at the platform: the
    /// device on board is what holds the train.
    Heedless,
}

/// What a driver looks at.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    /// The train's speed, in m/s.
    pub speed: f64,
    /// The permitted speed in the cab, in m/s; 0 if nothing is permitted.
    pub permitted: f64,
    /// From the front to where the train is to stop for passengers, if that is in sight.
    pub to_stop_m: Option<f64>,
    /// Whether the train may leave.
    pub may_leave: bool,
}

/// How far under the permitted speed a driver stays, in m/s.
const BELOW: f64 = 0.5;
/// How a driver brakes, in m/s².
const COMFORTABLE: f64 = 0.6;

/// The acceleration that the driver asks for, in m/s²: negative to brake.
pub fn drive(drivers: Drivers, dynamics: &Dynamics, sight: Sight) -> f64 {
    let aim = match drivers {
        _ if !sight.may_leave => 0.0,
        Drivers::Careful => (sight.permitted - BELOW).max(0.0),
        // At a platform a train has arrived where it may not go on.
        Drivers::Heedless if sight.to_stop_m.is_some() && sight.permitted <= 0.0 => 0.0,
        Drivers::Heedless => f64::INFINITY,
    };
    let to_stop = sight.to_stop_m.map_or(f64::INFINITY, |metres| (2.0 * COMFORTABLE * metres.max(0.0)).sqrt());
    let aim = if drivers == Drivers::Careful { aim.min(to_stop) } else { aim };
    if sight.speed < aim - 0.3 {
        dynamics.acceleration
    } else if sight.speed > aim + 1.0 {
        -dynamics.service.max(COMFORTABLE)
    } else if sight.speed > aim {
        -COMFORTABLE
    } else {
        0.0
    }
}
