//! What a run looked like, second by second: for pictures.

use atc_kernel::supervision::Brake;

use crate::sizes::Routes;
use crate::world::World;

/// A train at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glimpse {
    /// Where its front is along the line, in m.
    pub front_m: f64,
    /// Where its tail is.
    pub tail_m: f64,
    /// Its speed, in km/h.
    pub speed_kmh: f64,
    /// The permitted speed, in km/h; none if nothing is permitted.
    pub permitted_kmh: Option<f64>,
    /// What its device commands.
    pub brake: Brake,
}

/// A time for which something was so, in s, and what: a circuit, or a route of a station.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span<T> {
    /// What.
    pub of: T,
    /// From.
    pub from_s: f64,
    /// To.
    pub to_s: f64,
}

/// A route of a station.
pub type RouteOf = (usize, usize);

/// A run, looked at every second.
#[derive(Clone, Debug, Default)]
pub struct Record {
    /// The times, in s.
    pub at_s: Vec<f64>,
    /// For each time the trains.
    pub trains: Vec<Vec<Glimpse>>,
    /// When circuits were reported occupied.
    pub occupied: Vec<Span<usize>>,
    /// When signals were at proceed.
    pub proceed: Vec<Span<RouteOf>>,
}

impl Record {
    /// Runs a world until `end_ms`, or until something unsafe happens, and looks at it every `every_ms`.
    pub fn of(world: &mut World<'_>, end_ms: u64, every_ms: u64) -> Self {
        let mut record = Self::default();
        let mut open = (Vec::new(), Vec::new());
        while world.now_ms < end_ms && !world.is_unsafe {
            record.look(world, &mut open);
            world.run((world.now_ms + every_ms.max(1)).min(end_ms));
        }
        record.look(world, &mut open);
        record
    }

    #[allow(clippy::cast_precision_loss, reason = "a run is shorter than 2^53 ms")]
    fn look(&mut self, world: &World<'_>, open: &mut (Vec<Option<usize>>, Vec<Option<usize>>)) {
        let now_s = world.now_ms as f64 / 1000.0;
        let track = &world.line.track;
        let glimpse = |train: &crate::train::Train| Glimpse {
            front_m: train.body.along_m(track),
            tail_m: train.body.tail_along_m(track),
            speed_kmh: train.body.speed * 3.6,
            permitted_kmh: train.cab.permission.speed.map(|speed| f64::from(speed.0) / 10.0),
            brake: train.cab.brake,
        };
        self.at_s.push(now_s);
        self.trains.push(world.trains.iter().map(glimpse).collect());
        for (circuit, reported) in world.reported.iter().enumerate() {
            span(&mut self.occupied, &mut open.0, (circuit, circuit), *reported, now_s);
        }
        let mut place = 0;
        for (station, at) in world.stations.iter().enumerate() {
            for route in 0..world.line.stations[station].paths.len() {
                let shows = at.reply.proceed.meets(Routes::nth(route));
                span(&mut self.proceed, &mut open.1, (place, (station, route)), shows, now_s);
                place += 1;
            }
        }
    }
}

/// Begins, goes on with or ends the span at `place`.
fn span<T>(spans: &mut Vec<Span<T>>, open: &mut Vec<Option<usize>>, (place, of): (usize, T), is_so: bool, now_s: f64) {
    if open.len() <= place {
        open.resize(place + 1, None);
    }
    match (open[place], is_so) {
        (Some(at), _) => {
            spans[at].to_s = now_s;
            open[place] = is_so.then_some(at);
        }
        (None, true) => {
            open[place] = Some(spans.len());
            spans.push(Span { of, from_s: now_s, to_s: now_s });
        }
        (None, false) => {}
    }
}
