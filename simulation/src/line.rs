//! A line: the stations in their order, joined by the lines between them.

use atc_kernel::interlocking::Heading;
use atc_layout::{At, Description, Sound};

use crate::counted::Counted;
use crate::motion::{Dynamics, Leg};
use crate::track::{Link, Track};

/// A track of a station where trains stop.
#[derive(Clone, Debug)]
pub struct Platform {
    /// Its name, after the circuits.
    pub name: String,
    /// Its circuits on the ground, from west to east.
    pub circuits: Vec<usize>,
    /// Its pieces for a train to the east, from west to east.
    pub legs: Vec<Leg>,
    /// The route by which a train comes in from the west, and from the east.
    pub arrive: [Option<usize>; 2],
    /// The route by which a train leaves to the west, and to the east.
    pub depart: [Option<usize>; 2],
}

/// A station.
#[derive(Clone, Debug)]
pub struct Place {
    /// Its name.
    pub name: String,
    /// Its layout.
    pub description: Description,
    /// The same, held against every rule.
    pub sound: Sound,
    /// Its tracks.
    pub platforms: Vec<Platform>,
    /// For each route the circuits of its path on the ground.
    pub paths: Vec<Vec<usize>>,
}

/// A line.
#[derive(Clone, Debug)]
pub struct Line {
    /// Its name.
    pub name: String,
    /// The stations from west to east.
    pub stations: Vec<Place>,
    /// The lines between them.
    pub links: Vec<Link>,
    /// The directions in which trains run on each: whether to the west, and to the east.
    pub ways: Vec<[bool; 2]>,
    /// The lines on which trains are counted.
    pub counted: Vec<Counted>,
    /// The ground.
    pub track: Track,
    /// How trains move.
    pub dynamics: Dynamics,
    /// How many trains the file asks for.
    pub number_of_trains: Option<usize>,
    /// The logic cycle of the stations.
    pub cycle_ms: u32,
    /// The logic cycle on board.
    pub train_cycle_ms: u32,
    /// The speed of each code in km/h; 0 where there is none.
    pub speeds_kmh: Vec<u16>,
    /// For how long the ground counts on telegrams.
    pub telegram_age_ms: u32,
    /// The longest loss of shunt that is tolerated.
    pub shunt_loss_ms: u32,
    /// For how long a circuit must be reported clear before it counts as clear: the least of all stations.
    pub clear_ms: u32,
    /// For how long a train may run on after its authority was taken away.
    pub residual_ms: u32,
    /// For each piece the highest speed along it, and over its reverse leg, in m/s.
    pub limits: Vec<[f64; 2]>,
}

impl Line {
    pub(crate) fn platforms(
        &self,
        number: usize,
        model: &atc_layout::model::Model,
        lines: &[Vec<usize>; 2],
        paths: &[Vec<usize>],
    ) -> Vec<Platform> {
        let track = &self.track;
        let plain = |circuit: &usize| {
            let mut pieces = (0..track.pieces.len()).filter(|piece| track.pieces[*piece].circuit == *circuit);
            pieces.next().filter(|piece| track.pieces[*piece].plain)
        };
        let mut platforms: Vec<Platform> = Vec::new();
        for (route, path) in model.routes.iter().zip(paths).enumerate().map(|(number, (_, path))| (number, path)) {
            let from = model.routes[route].from;
            let Some(side) = (0..2).find(|side| from.is_some_and(|from| lines[*side].contains(&from))) else {
                continue;
            };
            let mut circuits: Vec<usize> =
                path.iter().rev().copied().take_while(|circuit| plain(circuit).is_some()).collect();
            let pieces: Vec<usize> = circuits.iter().filter_map(plain).collect();
            // From the end of the route back; the legs are for a train to the east.
            let mut exit = track.pieces[pieces[0]].joints.iter().copied().find(|joint| {
                let heading = track.heading(number, pieces[0], *joint);
                heading == Some(if side == 0 { Heading::Right } else { Heading::Left })
            });
            let mut legs = Vec::new();
            for piece in pieces {
                let Some(out) = exit else { break };
                let (enter, _) = track.leave(piece, out, false);
                legs.push(if side == 0 {
                    Leg { piece, enter, exit: out }
                } else {
                    Leg { piece, enter: out, exit: enter }
                });
                exit = Some(enter);
            }
            if side == 0 {
                circuits.reverse();
                legs.reverse();
            }
            let there = platforms.iter().position(|platform| platform.circuits == circuits);
            let at = there.unwrap_or_else(|| {
                let name =
                    circuits.iter().map(|circuit| track.circuits[*circuit].name.as_str()).collect::<Vec<_>>().join("+");
                platforms.push(Platform { name, circuits, legs, arrive: [None; 2], depart: [None; 2] });
                platforms.len() - 1
            });
            platforms[at].arrive[side] = Some(route);
        }
        for (number_of_route, route) in model.routes.iter().enumerate() {
            let Some(side) = (0..2).find(|side| route.to.is_some_and(|to| lines[*side].contains(&to))) else {
                continue;
            };
            let entry = track.sites[number].circuits[route.entry];
            if let Some(platform) = platforms.iter_mut().find(|platform| platform.circuits.contains(&entry)) {
                platform.depart[side] = Some(number_of_route);
            }
        }
        platforms
    }

    /// The counted lines that end at a station.
    pub fn counted_lines(&self, station: usize) -> impl Iterator<Item = &Counted> {
        let ends = move |counted: &Counted| [0, 1].contains(&station.wrapping_sub(self.links[counted.link].west));
        self.counted.iter().filter(move |counted| ends(counted))
    }

    /// The counted line of a station's device: it can have one.
    pub fn counted_at(&self, station: usize) -> Option<&Counted> {
        self.counted_lines(station).next()
    }

    /// For how long a neighbour's telegram is used: half of what the ground counts on, and the other half for its way.
    pub const fn consent_life_ms(&self) -> u32 {
        self.telegram_age_ms / 2
    }

    /// How long telegrams between stations may take: with their life they are no older than the ground counts on.
    pub const fn longest_delay_ms(&self) -> u32 {
        self.consent_life_ms().saturating_sub(2 * self.cycle_ms)
    }

    /// The least brake that the stations count on, in m/s².
    pub fn counted_brake(&self) -> f64 {
        let of = |place: &Place| f64::from(place.description.station.braking.deceleration_mm_s2.value) / 1000.0;
        self.stations.iter().map(of).fold(f64::INFINITY, f64::min)
    }

    /// The highest speed on a leg of a train's way, in m/s, as the files of the stations have it: that of the line or of routes, and over the reverse
    /// leg of a point that of reverse points. Where two stations see the same track, the lower one.
    pub fn limit(&self, leg: &Leg) -> f64 {
        let joints = &self.track.pieces[leg.piece].joints;
        let reverse = joints.get(2).is_some_and(|joint| [leg.enter, leg.exit].contains(joint));
        self.limits[leg.piece][usize::from(reverse)]
    }

    /// The limits of every piece: along it, and over its reverse leg.
    pub(crate) fn limits(&self) -> Vec<[f64; 2]> {
        let mut limits = vec![[f64::INFINITY; 2]; self.track.pieces.len()];
        for (place, site) in self.stations.iter().zip(&self.track.sites) {
            let station = &place.description.station;
            let speed = &station.speed;
            let kmh = |limit: Option<&At<u16>>| limit.map_or(f64::INFINITY, |limit| f64::from(limit.value));
            for piece in &site.pieces {
                let circuit = self.track.pieces[*piece].circuit;
                let local = site.circuits.iter().position(|at| *at == circuit);
                let name = local.map(|local| station.circuits[local].name.value.as_str());
                let mut segments = station.segments.iter();
                let line = segments.find(|segment| segment.circuits.iter().any(|at| Some(at.value.as_str()) == name));
                let own = line.map_or(speed.route_kmh.as_ref(), |segment| segment.speed_kmh.as_ref());
                let straight = kmh(own.or(speed.line_kmh.as_ref()));
                for (limit, its) in
                    limits[*piece].iter_mut().zip([straight, straight.min(kmh(speed.reverse_kmh.as_ref()))])
                {
                    *limit = limit.min(its / 3.6);
                }
            }
        }
        limits
    }

    /// How many trains there is room for.
    pub fn room(&self) -> usize {
        self.stations.iter().map(|station| station.platforms.len()).sum()
    }
}
