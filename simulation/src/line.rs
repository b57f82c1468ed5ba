//! A line: the stations in their order, read from a file or made by [`crate::generate`], and joined.

use std::path::Path;
use std::sync::Arc;

use atc_kernel::aspect::AspectId;
use atc_kernel::interlocking::{Heading, Layout, MAX_CODES, PerCircuit};
use atc_kernel::telegram::{Gradient, SectionId};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{Equipment, Facing, Fixed, Join, Session, SignalPlan};
use atc_layout::{At, Compiled, Description, border};
use serde::{Deserialize, Serialize};

use crate::counting::{self, Counted, CountedFile};
use crate::defect::Defect;
use crate::fault::consent_life_ms;
use crate::generate::Shape;
use crate::ground::{Device, Held, Speaking};
use crate::motion::{Dynamics, Leg};
use crate::onboard::words;
use crate::track::{Link, Pair, Track, join};

/// The form of a line file, in TOML.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct File {
    /// The name of the line.
    pub name: String,
    /// The stations from west to east: the layout file of each, beside the line file.
    #[serde(default, rename = "station")]
    pub stations: Vec<StationFile>,
    /// Or stations that are made: how many tracks each has, and how many blocks lie between them.
    #[serde(default)]
    pub generated: Option<Generated>,
    /// The lines on which trains are counted, each of one direction.
    #[serde(default)]
    pub counted: Vec<CountedFile>,
    /// How trains move.
    #[serde(default)]
    pub trains: Dynamics,
    /// How many trains there are [default: as many as there is room for, less one].
    #[serde(default)]
    pub number_of_trains: Option<usize>,
    /// The length of the logic cycle on board, in ms [default: 10].
    #[serde(default)]
    pub train_cycle_ms: Option<u32>,
}

/// A station of a line file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StationFile {
    /// The layout file.
    pub layout: String,
}

/// Stations that are made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Generated {
    /// How many tracks each station has.
    pub tracks: Vec<usize>,
    /// How many blocks lie between one and the next.
    pub blocks: Vec<usize>,
    /// Whether there are two lines between two stations, one for each direction.
    #[serde(default)]
    pub double: bool,
}

/// West or east: the direction of a train along the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bound {
    /// Towards the first station.
    West,
    /// Towards the last station.
    East,
}

impl Bound {
    /// The other one.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::West => Self::East,
            Self::East => Self::West,
        }
    }

    /// 0 for west, 1 for east.
    pub const fn side(self) -> usize {
        match self {
            Self::West => 0,
            Self::East => 1,
        }
    }
}

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
    /// The same, compiled.
    pub compiled: Compiled,
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
    /// The line of a file.
    ///
    /// # Errors
    /// What is wrong, and in which file.
    pub fn read(path: &Path) -> Result<Self, String> {
        let at = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let text = std::fs::read_to_string(path).map_err(|error| at(&format!("cannot be read: {error}")))?;
        let file: File = toml::from_str(&text).map_err(|error| at(&error.to_string().trim_end()))?;
        let mut layouts = Vec::new();
        for station in &file.stations {
            let path = path.parent().unwrap_or(Path::new("")).join(&station.layout);
            layouts.push(atc_layout::read(&path).map_err(|errors| errors.to_string())?);
        }
        Self::of(&file, layouts).map_err(|error| at(&error))
    }

    /// A line of stations that are made.
    ///
    /// # Errors
    /// What is wrong with the shape.
    pub fn generate(name: &str, shape: &Shape) -> Result<Self, String> {
        Self::generate_counted(name, shape, Vec::new())
    }

    /// Three stations with a double track between them, and trains that are counted on four blocks of the first line to the east.
    ///
    /// # Errors
    /// None; a test makes it.
    pub fn double_track() -> Result<Self, String> {
        Self::counted_double(&[&["L1E-2", "L1E-3"], &["L1E-4", "L1E-5"]])
    }

    /// The same with one counted block of four sections in place of two blocks of two.
    ///
    /// # Errors
    /// None; it is tested.
    pub fn long_block() -> Result<Self, String> {
        Self::counted_double(&[&["L1E-2", "L1E-3", "L1E-4", "L1E-5"]])
    }

    fn counted_double(blocks: &[&[&str]]) -> Result<Self, String> {
        let blocks = blocks.iter().map(|block| block.iter().map(ToString::to_string).collect()).collect();
        let counted = vec![CountedFile { line: "Line 1 E".to_owned(), blocks }];
        Self::generate_counted("Double track", &Shape::double(vec![4; 3], vec![7, 4]), counted)
    }

    fn generate_counted(name: &str, shape: &Shape, counted: Vec<CountedFile>) -> Result<Self, String> {
        let Shape { tracks, blocks, double } = shape.clone();
        let generated = Some(Generated { tracks, blocks, double });
        Self::of(&File { name: name.to_owned(), generated, counted, ..File::default() }, Vec::new())
    }

    fn of(file: &File, mut layouts: Vec<Description>) -> Result<Self, String> {
        match (&file.generated, layouts.len()) {
            (Some(_), 1..) => return Err("give [[station]] or [generated], not both".to_owned()),
            (Some(generated), 0) => {
                let Generated { tracks, blocks, double } = generated.clone();
                let shape = Shape { tracks, blocks, double };
                if let Some(wrong) = shape.wrong() {
                    return Err(wrong);
                }
                for (name, text) in shape.stations() {
                    layouts.push(Description::from_toml(&name, &text).map_err(|errors| errors.to_string())?);
                }
            }
            (None, 0 | 1) => return Err("a line has two stations or more: name each in [[station]]".to_owned()),
            (None, _) => {}
        }
        let compiled: Vec<Compiled> = layouts
            .iter()
            .map(|layout| layout.compile().map_err(|errors| errors.to_string()))
            .collect::<Result<_, _>>()?;
        let pairs = pairs(&layouts, &compiled)?;
        let models: Vec<_> = compiled.iter().map(|one| (one.names.station.as_str(), &one.model)).collect();
        let (track, links) = join(&models, &pairs)?;
        let first = &compiled[0].model.values;
        for one in &compiled {
            let values = &one.model.values;
            if values.cycle_ms != first.cycle_ms || values.speeds_kmh != first.speeds_kmh {
                let names = (&compiled[0].names.station, &one.names.station);
                return Err(format!(
                    "{} and {} differ in cycle_ms or in speeds_kmh: give both the same",
                    names.0, names.1
                ));
            }
        }
        let values = |of: fn(&atc_layout::model::Values) -> u32| compiled.iter().map(move |one| of(&one.model.values));
        let line = Self {
            name: file.name.clone(),
            dynamics: file.trains,
            number_of_trains: file.number_of_trains,
            cycle_ms: first.cycle_ms,
            train_cycle_ms: file.train_cycle_ms.unwrap_or(10),
            speeds_kmh: first.speeds_kmh.to_vec(),
            telegram_age_ms: values(|values| values.telegram_age_ms).min().unwrap_or(0),
            shunt_loss_ms: values(|values| u32::from(values.loss) * values.cycle_ms).min().unwrap_or(0),
            clear_ms: values(|values| u32::from(values.clear) * values.cycle_ms).min().unwrap_or(0),
            residual_ms: values(|values| values.residual_ms.value).max().unwrap_or(0),
            limits: Vec::new(),
            stations: Vec::new(),
            ways: links.iter().map(|link| ways(link, &compiled)).collect(),
            counted: Vec::new(),
            links,
            track,
        };
        let mut line = line.checked()?.with_stations(layouts, compiled)?;
        line.counted = file.counted.iter().map(|one| counting::of(&line, one)).collect::<Result<_, _>>()?;
        counting::check(&line)?;
        Ok(line)
    }

    fn checked(self) -> Result<Self, String> {
        let moves = &self.dynamics;
        let positive = [moves.length_m, moves.acceleration, moves.service, moves.emergency];
        if positive.iter().any(|value| !(value.is_finite() && *value > 0.0)) {
            return Err("[trains]: length_m, acceleration, service and emergency must be above 0".to_owned());
        }
        if self.train_cycle_ms == 0 || !self.cycle_ms.is_multiple_of(self.train_cycle_ms) {
            let (train, ground) = (self.train_cycle_ms, self.cycle_ms);
            return Err(format!("train_cycle_ms = {train}: it must divide the {ground} ms of the stations' cycle"));
        }
        Ok(self)
    }

    fn with_stations(mut self, layouts: Vec<Description>, compiled: Vec<Compiled>) -> Result<Self, String> {
        for (number, (description, compiled)) in layouts.into_iter().zip(compiled).enumerate() {
            let model = &compiled.model;
            let needs = model.values.longest_train.map_or(f64::INFINITY, |longest| f64::from(longest.0));
            let brake = f64::from(description.station.braking.deceleration_mm_s2.value) / 1000.0;
            if self.dynamics.length_m > needs || self.dynamics.service < brake {
                return Err(format!(
                    "{} counts on trains of at most {needs} m that brake with {brake} m/s²; [trains] has {} m and {} m/s²",
                    compiled.names.station, self.dynamics.length_m, self.dynamics.service
                ));
            }
            let global = |circuits: Vec<usize>| -> Vec<usize> {
                circuits.into_iter().map(|circuit| self.track.sites[number].circuits[circuit]).collect()
            };
            let paths: Vec<Vec<usize>> = model.routes.iter().map(|route| global(route.circuits().collect())).collect();
            let its = |side: usize| {
                let here = move |link: &&Link| link.west + 1 == number + side;
                self.links.iter().filter(here).map(move |link| link.segments[1 - side]).collect::<Vec<_>>()
            };
            let lines = [its(0), its(1)];
            let platforms = self.platforms(number, model, &lines, &paths);
            for side in [Bound::West, Bound::East] {
                let through = |platform: &Platform| {
                    let from = if lines[side.other().side()].is_empty() { side } else { side.other() };
                    platform.arrive[from.side()].is_some() && platform.depart[side.side()].is_some()
                };
                if !lines[side.side()].is_empty() && !platforms.iter().any(through) {
                    return Err(format!(
                        "{}: no track is reached by one route from the line and left by one to the {side:?}",
                        compiled.names.station
                    ));
                }
            }
            self.stations.push(Place { name: compiled.names.station.clone(), description, compiled, platforms, paths });
        }
        self.limits = self.limits();
        Ok(self)
    }

    fn platforms(
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

    /// The device of a station, of the smallest size that holds its layout, with what is wrong in it.
    ///
    /// # Errors
    /// What the kernel says of the layout; it was checked when it was compiled.
    pub fn device(&self, station: usize, telegrams: bool, defects: &[Defect]) -> Result<Box<dyn Device>, String> {
        let counted = counting::at(self, station);
        // Devices with messages understand each other only.
        let equipment = if telegrams || !self.counted.is_empty() { Some(self.equipment(station)?) } else { None };
        let made = (&self.stations[station].description, defects, equipment.as_ref());
        if let Some(counted) = counted {
            return if counted.blocks.len() == 1 {
                sized::<24, 12, 12, 4, 1>(made, Some(counted.join(self, station)?))
            } else {
                sized::<24, 12, 12, 4, 2>(made, Some(counted.join(self, station)?))
            };
        }
        let few = sized::<8, 4, 2, 2, 0>(made, None).or_else(|_| sized::<24, 4, 10, 2, 0>(made, None));
        few.or_else(|_| sized::<64, 16, 32, 8, 0>(made, None))
    }

    /// What a station's device has besides its layout, where trains run on telegrams. A circuit has one number in all stations.
    fn equipment(&self, station: usize) -> Result<Equipment<0>, String> {
        let words = words(&self.speeds_kmh)?;
        let highest = u8::try_from(words.aspects.speeds().len() - 1).ok().and_then(AspectId::new);
        let curve = highest.ok_or("more speeds than ranks")?;
        let facing = |section: usize| {
            let section = u16::try_from(section).map_err(|_| "more circuits than section numbers".to_owned())?;
            Ok::<_, String>(Facing { section: SectionId(section), gradient: Gradient(0), curve })
        };
        let mut circuits = PerCircuit::NONE;
        for (place, circuit) in circuits.iter_mut().zip(&self.track.sites[station].circuits) {
            *place = Some(Fixed { left: facing(2 * circuit + 1)?, right: facing(2 * circuit)? });
        }
        let mut speeds = [None; MAX_CODES];
        for (place, speed) in speeds.iter_mut().zip(words.aspects.speeds()) {
            *place = Some(*speed);
        }
        let signals = SignalPlan { circuits, speeds, aspects: words.aspects, codes: words.codes };
        let life = u16::try_from(consent_life_ms(self) / self.cycle_ms).map_or(Ticks(1), Ticks);
        Ok(Equipment { counted: None, signals, life, session: Session(0) })
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
    fn limits(&self) -> Vec<[f64; 2]> {
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

fn sized<const R: usize, const P: usize, const N: usize, const S: usize, const B: usize>(
    (description, defects, equipment): (&Description, &[Defect], Option<&Equipment<0>>),
    counted: Option<Join<B>>,
) -> Result<Box<dyn Device>, String> {
    let compiled: Compiled<R, P, N, S> = description.compile_to().map_err(|errors| errors.to_string())?;
    let mut plan = compiled.plan;
    let layout = if defects.iter().filter(|defect| defect.spoil(&mut plan)).count() > 0 {
        Layout::with_what_proofs_need(*plan)
    } else {
        Layout::new(*plan)
    };
    let layout = layout.map_err(|broken| compiled.names.broken(broken, &plan))?;
    let layout = Arc::new(layout);
    let Some(equipment) = equipment else { return Ok(Box::new(Held::new(layout))) };
    let Equipment { signals, life, session, .. } = *equipment;
    let speaking = Speaking::new(layout, Equipment { counted, signals, life, session });
    Ok(Box::new(speaking.map_err(|broken| format!("{}: {broken:?}", compiled.names.station))?))
}

/// The segments by which each station and the next are joined: one pair for each line that both name.
fn pairs(layouts: &[Description], compiled: &[Compiled]) -> Result<Vec<Pair>, String> {
    let mut pairs = Vec::new();
    for west in 0..layouts.len().saturating_sub(1) {
        let (one, other) = (&compiled[west].model, &compiled[west + 1].model);
        border::compare((&layouts[west], one), (&layouts[west + 1], other)).map_err(|errors| errors.to_string())?;
        let before = pairs.len();
        for (number, segment) in one.segments.iter().enumerate() {
            let there = other.segments.iter().position(|its| its.line.is_some() && its.line == segment.line);
            pairs.extend(there.map(|there| Pair { west, segments: [number, there] }));
        }
        if !(1..=2).contains(&(pairs.len() - before)) {
            let names = (&compiled[west].names.station, &compiled[west + 1].names.station);
            let common = pairs.len() - before;
            return Err(format!("{} and {} name {common} lines in common; 1 or 2 are possible here", names.0, names.1));
        }
    }
    Ok(pairs)
}

/// Whether trains run to the west on a line, and to the east: there is a route out to it at one end, and one in from it at the other.
fn ways(link: &Link, compiled: &[Compiled]) -> [bool; 2] {
    let routes = |side: usize| &compiled[link.west + side].model.routes;
    let run = |from: usize| {
        let out = routes(from).iter().any(|route| route.to == Some(link.segments[from]));
        out && routes(1 - from).iter().any(|route| route.from == Some(link.segments[1 - from]))
    };
    [run(1), run(0)]
}
