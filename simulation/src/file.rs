//! A line from its file, or made by [`crate::generate`]: its stations, joined.

use std::path::Path;

use atc_kernel::block::MAX_SECTIONS;
use atc_layout::{Description, Sound, border, with_room};
use serde::{Deserialize, Serialize};

use crate::bound::Bound;
use crate::counted::{Counted, CountedFile, MAX_BLOCKS};
use crate::generate::Shape;
use crate::line::{Line, Place, Platform};
use crate::motion::Dynamics;
use crate::track::{Link, Pair, join};
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

/// The longest time from a brake command to its effect: no station's file says one, and with a minute trains run over the end of the track.
const MOST_DELAY_MS: u32 = 2_000;

impl Line {
    /// The line of a file.
    ///
    /// # Errors
    /// What is wrong, and in which file.
    pub fn read(path: &Path) -> Result<Self, String> {
        let at = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let text = atc_layout::text::read(path).map_err(|error| at(&error))?;
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
        let sound: Vec<Sound> = layouts
            .iter()
            .map(|layout| with_room(|| layout.check())?.map_err(|errors| errors.to_string()))
            .collect::<Result<_, _>>()?;
        let pairs = pairs(&layouts, &sound)?;
        let models: Vec<_> = sound.iter().map(|one| (one.names.station.as_str(), &one.model)).collect();
        let (track, links) = join(&models, &pairs)?;
        let first = &sound[0].model.values;
        for one in &sound {
            let values = &one.model.values;
            if values.cycle_ms != first.cycle_ms || values.speeds_kmh != first.speeds_kmh {
                let names = (&sound[0].names.station, &one.names.station);
                return Err(format!(
                    "{} and {} differ in cycle_ms or in speeds_kmh: give both the same",
                    names.0, names.1
                ));
            }
        }
        let values = |of: fn(&atc_layout::model::Values) -> u32| sound.iter().map(move |one| of(&one.model.values));
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
            ways: links.iter().map(|link| ways(link, &sound)).collect(),
            counted: Vec::new(),
            links,
            track,
        };
        let mut line = line.checked()?.with_stations(layouts, sound)?;
        line.counted = file.counted.iter().map(|one| counted(&line, one)).collect::<Result<_, _>>()?;
        check(&line)?;
        Ok(line)
    }

    fn checked(self) -> Result<Self, String> {
        let moves = &self.dynamics;
        let ranges = [
            ("length_m", moves.length_m, 1_000.0),
            ("acceleration", moves.acceleration, 3.0),
            ("service", moves.service, 5.0),
            ("emergency", moves.emergency, 5.0),
        ];
        if let Some((name, value, most)) = ranges.iter().find(|(_, value, most)| !(*value > 0.0 && value <= most)) {
            return Err(format!("[trains]: {name} is {value}; it must be above 0 and at most {most}"));
        }
        if moves.emergency < moves.service {
            let (emergency, service) = (moves.emergency, moves.service);
            return Err(format!("[trains]: emergency is {emergency}, below service, {service}; it must not be"));
        }
        if moves.brake_delay_ms > MOST_DELAY_MS {
            let delay = moves.brake_delay_ms;
            return Err(format!("[trains]: brake_delay_ms is {delay}; it must be at most {MOST_DELAY_MS}"));
        }
        if self.train_cycle_ms == 0 || !self.cycle_ms.is_multiple_of(self.train_cycle_ms) {
            let (train, ground) = (self.train_cycle_ms, self.cycle_ms);
            return Err(format!("train_cycle_ms = {train}: it must divide the {ground} ms of the stations' cycle"));
        }
        Ok(self)
    }

    fn with_stations(mut self, layouts: Vec<Description>, sound: Vec<Sound>) -> Result<Self, String> {
        for (number, (description, sound)) in layouts.into_iter().zip(sound).enumerate() {
            let model = &sound.model;
            let needs = model.values.longest_train.map_or(f64::INFINITY, |longest| f64::from(longest.0));
            let brake = f64::from(description.station.braking.deceleration_mm_s2.value) / 1000.0;
            if self.dynamics.length_m > needs || self.dynamics.service < brake {
                return Err(format!(
                    "{} counts on trains of at most {needs} m that brake with {brake} m/s²; [trains] has {} m and {} m/s²",
                    sound.names.station, self.dynamics.length_m, self.dynamics.service
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
            let shared =
                |one: &Platform, other: &Platform| one.circuits.iter().find(|it| other.circuits.contains(*it)).copied();
            for (place, one) in platforms.iter().enumerate() {
                if let Some(circuit) = platforms[..place].iter().find_map(|other| shared(one, other)) {
                    return Err(format!(
                        "{}: {} is of two tracks; here the plain circuits at the end of each route to a track must be the same",
                        sound.names.station, self.track.circuits[circuit].name
                    ));
                }
            }
            for side in [Bound::West, Bound::East] {
                let through = |platform: &Platform| {
                    let from = if lines[side.other().side()].is_empty() { side } else { side.other() };
                    platform.arrive[from.side()].is_some() && platform.depart[side.side()].is_some()
                };
                if !lines[side.side()].is_empty() && !platforms.iter().any(through) {
                    return Err(format!(
                        "{}: no track is reached by one route from the line and left by one to the {side:?}",
                        sound.names.station
                    ));
                }
            }
            self.stations.push(Place { name: sound.names.station.clone(), description, sound, platforms, paths });
        }
        self.limits = self.limits();
        Ok(self)
    }
}

/// The counted line that a file names.
///
/// # Errors
/// What is wrong with it.
fn counted(line: &Line, file: &CountedFile) -> Result<Counted, String> {
    let wrong = |what: String| format!("[[counted]] {}: {what}", file.line);
    let called = |link: usize| {
        let joined = &line.links[link];
        line.stations[joined.west].sound.model.segments[joined.segments[0]].line.as_deref() == Some(&file.line)
    };
    let link =
        (0..line.links.len()).find(|link| called(*link)).ok_or_else(|| wrong("no line has this name".to_owned()))?;
    let bound = match line.ways[link] {
        [true, false] => Bound::West,
        [false, true] => Bound::East,
        _ => return Err(wrong("trains run on it in both directions; a counted line has one".to_owned())),
    };
    if !(1..=MAX_BLOCKS).contains(&file.blocks.len()) {
        return Err(wrong(format!("{} blocks: 1 or {MAX_BLOCKS} are possible", file.blocks.len())));
    }
    let circuit = |name: &String| {
        let named = |circuit: &&usize| line.track.circuits[**circuit].name == *name;
        let found = line.links[link].circuits.iter().find(named).copied();
        found.ok_or_else(|| wrong(format!("{name} is none of its circuits")))
    };
    let block = |names: &Vec<String>| {
        if !(1..=usize::from(MAX_SECTIONS)).contains(&names.len()) {
            return Err(wrong(format!("a block of {} sections: 1 to {MAX_SECTIONS} are possible", names.len())));
        }
        names.iter().map(circuit).collect::<Result<Vec<_>, _>>()
    };
    let blocks = file.blocks.iter().map(block).collect::<Result<Vec<_>, _>>()?;
    Ok(Counted { link, bound, blocks })
}

/// Checks that no station has two counted lines, and that the kernel takes each.
///
/// # Errors
/// What is wrong.
fn check(line: &Line) -> Result<(), String> {
    for station in 0..line.stations.len() {
        if line.counted_lines(station).count() > 1 {
            return Err(format!("{}: two [[counted]] lines; a device counts one", line.stations[station].name));
        }
        if line.counted_at(station).is_some() {
            line.device(station, true, &[])?;
        }
    }
    Ok(())
}

/// The segments by which each station and the next are joined: one pair for each line that both name.
fn pairs(layouts: &[Description], sound: &[Sound]) -> Result<Vec<Pair>, String> {
    let mut pairs = Vec::new();
    for west in 0..layouts.len().saturating_sub(1) {
        let (one, other) = (&sound[west].model, &sound[west + 1].model);
        border::compare((&layouts[west], one), (&layouts[west + 1], other)).map_err(|errors| errors.to_string())?;
        let before = pairs.len();
        for (number, segment) in one.segments.iter().enumerate() {
            let there = other.segments.iter().position(|its| its.line.is_some() && its.line == segment.line);
            pairs.extend(there.map(|there| Pair { west, segments: [number, there] }));
        }
        if !(1..=2).contains(&(pairs.len() - before)) {
            let names = (&sound[west].names.station, &sound[west + 1].names.station);
            let common = pairs.len() - before;
            return Err(format!("{} and {} name {common} lines in common; 1 or 2 are possible here", names.0, names.1));
        }
    }
    Ok(pairs)
}

/// Whether trains run to the west on a line, and to the east: there is a route out to it at one end, and one in from it at the other.
fn ways(link: &Link, sound: &[Sound]) -> [bool; 2] {
    let routes = |side: usize| &sound[link.west + side].model.routes;
    let run = |from: usize| {
        let out = routes(from).iter().any(|route| route.to == Some(link.segments[from]));
        out && routes(1 - from).iter().any(|route| route.from == Some(link.segments[1 - from]))
    };
    [run(1), run(0)]
}
