//! The form of the data: what stands in the page as JSON.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::event::Event;
use crate::lane::{Lane, Legend};
use crate::series::{Channel, Curve};

/// The number of this form.
pub const FORM: u32 = 1;

/// A film. Frame `k` shows step `k`, from 0: what was read in it, and what was answered to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Film {
    /// [`FORM`].
    pub form: u32,
    /// What it is of.
    pub title: String,
    /// What a reader must know, in short sentences.
    pub notes: Vec<String>,
    /// How time is told.
    pub clock: Clock,
    /// How many frames there are: 1 or more, or there is nothing to play.
    pub frames: u32,
    /// Every text that channels and events have, once. The first one is empty.
    pub words: Vec<String>,
    /// What changes, in words.
    pub channels: Vec<Channel>,
    /// What changes, in numbers.
    pub curves: Vec<Curve>,
    /// The drawings on which it is shown.
    pub plans: Vec<Plan>,
    /// The names of the trains.
    pub trains: Vec<String>,
    /// What is shown as tables.
    pub tables: Vec<Table>,
    /// Rows over time.
    pub lanes: Vec<Lane>,
    /// What the tones of the rows mean.
    pub legend: Vec<Legend>,
    /// Trains over time and distance.
    pub distance: Option<Distance>,
    /// What happens, in the order of the frames.
    pub events: Vec<Event>,
    /// The kernel, to go on from a frame with other inputs.
    pub kernel: Option<Kernel>,
    #[serde(skip)]
    pub(crate) numbers: BTreeMap<String, u32>,
}

/// How time is told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// The unit: "ms", "cycles", "bits" or another.
    pub unit: String,
    /// How many of them lie between two frames: 1 or more.
    pub per_frame: u32,
    /// When the last frame is, if it comes before its turn.
    pub last: Option<u64>,
}

/// A drawing (SVG). Its elements say what they show: `data-circuit`, `data-piece`, `data-point` with `data-leg`,
/// `data-signal`, `data-segment`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// What it shows.
    pub name: String,
    /// The drawing.
    pub svg: String,
    /// The number that trains know each of its pieces by, if it is another.
    pub pieces: Vec<u32>,
    /// The names that channels have, where those of the drawing are others: of `kind name`.
    pub names: BTreeMap<String, String>,
}

/// A table: one row for each name of a kind.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Table {
    /// What stands above it.
    pub title: String,
    /// The kind of the channels and curves.
    pub kind: String,
    /// What of each: the channels and curves, and what stands above the column.
    pub columns: Vec<(String, String)>,
    /// Whether rows without any value are left out.
    pub sparse: bool,
}

/// Trains over time and distance: the curves `front_m` and `tail_m` of each train, in m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Distance {
    /// How long the line is, in m.
    pub length_m: u32,
    /// The stations, and where they are.
    pub places: Vec<Place>,
    /// The circuits, and where they lie.
    pub circuits: Vec<Stretch>,
}

/// A place on the line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Place {
    /// Its name.
    pub name: String,
    /// Where it is, in m.
    pub at_m: u32,
}

/// A stretch of the line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stretch {
    /// The circuit.
    pub circuit: String,
    /// From, in m.
    pub from_m: u32,
    /// To, in m.
    pub to_m: u32,
}

/// The kernel's interlocking as a WebAssembly module (`atc-film-kernel`), with what it needs to run the session again.
/// Binary data are in base64; words of 64 bits are little-endian.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Kernel {
    /// The module.
    pub module: String,
    /// The words of its plan.
    pub plan: String,
    /// The words of the inputs, each once.
    pub inputs: Vec<String>,
    /// The number of the input of each step.
    pub steps: Vec<u32>,
    /// The names of its numbers: `circuit`, `point`, `route`, `signal` (of each route), `segment`; and the words of its
    /// answers: `phase`, `refusal`.
    pub names: BTreeMap<String, Vec<String>>,
    /// The speed of each code, in km/h.
    pub speeds_kmh: Vec<u16>,
    /// Where in the words of a cycle what stands.
    pub places: BTreeMap<String, usize>,
}

impl Film {
    /// A film of so many frames, with nothing in it.
    pub fn new(title: &str, clock: Clock, frames: u32) -> Self {
        Self {
            form: FORM,
            title: title.to_owned(),
            notes: Vec::new(),
            clock,
            frames,
            words: vec![String::new()],
            channels: Vec::new(),
            curves: Vec::new(),
            plans: Vec::new(),
            trains: Vec::new(),
            tables: Vec::new(),
            lanes: Vec::new(),
            legend: Vec::new(),
            distance: None,
            events: Vec::new(),
            kernel: None,
            numbers: BTreeMap::from([(String::new(), 0)]),
        }
    }

    /// When a frame is, in the unit of the clock.
    pub fn time(&self, frame: u32) -> u64 {
        let regular = u64::from(frame) * u64::from(self.clock.per_frame);
        self.clock.last.filter(|_| frame + 1 >= self.frames).unwrap_or(regular)
    }

    /// Adds a table. `columns`: what of each, and what stands above.
    pub fn table(&mut self, title: &str, kind: &str, columns: &[(&str, &str)], sparse: bool) {
        let columns = columns.iter().map(|(what, above)| ((*what).to_owned(), (*above).to_owned())).collect();
        self.tables.push(Table { title: title.to_owned(), kind: kind.to_owned(), columns, sparse });
    }
}
