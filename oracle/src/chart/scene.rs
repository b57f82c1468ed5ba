//! A chart as data: what a machine lays its case out as, before it is drawn.

use super::figure::Figure;

/// The chart of one case.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The machine's name.
    pub machine: &'static str,
    /// The parameters and the result, in a few short sentences.
    pub notes: Vec<String>,
    /// What time is shown in.
    pub unit: Unit,
    /// How many logic cycles the case has.
    pub cycles: u64,
    /// The rows, from top to bottom.
    pub lanes: Vec<Lane>,
    /// Cycles at which a line goes through all rows.
    pub guides: Vec<u64>,
    /// Which tones the chart uses, and what each means there.
    pub legend: Vec<(Tone, &'static str)>,
    /// The signals, for waveform viewers.
    pub signals: Vec<Signal>,
    /// Where the record differs from the kernel, as spans of cycles.
    pub differences: Vec<(u64, u64)>,
    /// A figure over something else than time; it stands above the rows.
    pub figure: Option<Figure>,
}

impl Scene {
    /// A chart of so many cycles with nothing in it.
    pub(super) const fn of(machine: &'static str, unit: Unit, cycles: u64) -> Self {
        Self {
            machine,
            notes: Vec::new(),
            unit,
            cycles,
            lanes: Vec::new(),
            guides: Vec::new(),
            legend: Vec::new(),
            signals: Vec::new(),
            differences: Vec::new(),
            figure: None,
        }
    }
}

/// The unit of the axis below the rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// What the axis shows: "time" or "place".
    pub axis: &'static str,
    /// Its name: "ms", "cycles" or "bits".
    pub name: &'static str,
    /// How many there are in one logic cycle.
    pub per_cycle: u32,
}

impl Unit {
    /// A number of cycles in this unit, with the unit's name.
    pub fn text(self, cycles: u64) -> String {
        format!("{} {}", self.value(cycles), self.name)
    }

    /// A number of cycles in this unit.
    pub fn value(self, cycles: u64) -> u64 {
        cycles.saturating_mul(self.per_cycle.into())
    }
}

/// One row.
#[derive(Clone, Debug)]
pub struct Lane {
    /// What the row shows.
    pub label: String,
    /// The first row of a group has a line above it.
    pub first: bool,
    /// Its height in pixels.
    pub height: u32,
    /// What is drawn in it.
    pub marks: Vec<Mark>,
}

/// Something in a row. Spans are in cycles, the end not included.
#[derive(Clone, Debug)]
pub enum Mark {
    /// A two-valued signal: high in these spans, low elsewhere.
    Wave(Vec<(u64, u64)>),
    /// A span with a text in it. `texts` go from full to short; the longest that fits is written.
    Bar {
        /// The first cycle.
        from: u64,
        /// The cycle after the last.
        to: u64,
        /// How it is filled.
        tone: Tone,
        /// What is written in it.
        texts: Vec<String>,
    },
    /// A measured span, with arrows at its ends.
    Dimension {
        /// The first cycle.
        from: u64,
        /// The cycle after the last.
        to: u64,
        /// What was measured.
        text: String,
    },
    /// A sign at an instant.
    Sign {
        /// When.
        at: u64,
        /// Which.
        sign: Sign,
    },
    /// A value over time: steps of `(cycle, value)`, None where there is none. All curves of a row share the scale.
    Curve {
        /// The values, each from its cycle on.
        points: Vec<(u64, Option<f64>)>,
        /// How it is drawn.
        tone: Tone,
        /// The row's scale.
        scale: Scale,
    },
    /// Everything between two values over time: steps of `(cycle, (lower, upper))`, None where there is nothing.
    Band {
        /// The pairs, each from its cycle on.
        points: Vec<(u64, Option<(f64, f64)>)>,
        /// How it is filled.
        tone: Tone,
        /// The row's scale.
        scale: Scale,
    },
    /// A short coloured span without a text.
    Tick {
        /// The first cycle.
        from: u64,
        /// The cycle after the last.
        to: u64,
        /// Its colour.
        tone: Tone,
        /// What it stands for.
        hint: String,
    },
    /// A letter for each cycle.
    Letters {
        /// The cycle of the first.
        from: u64,
        /// The letters.
        text: String,
    },
    /// A whole number over time: steps of `(cycle, number)`, with each number written at its step. None: there is none.
    Steps {
        /// The numbers, each from its cycle on.
        points: Vec<(u64, Option<u8>)>,
        /// The highest number of the row's scale, 1 or more.
        top: u8,
    },
}

/// The range of a row's values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The lowest value.
    pub bottom: f64,
    /// The highest value, above the lowest.
    pub top: f64,
}

/// What a colour stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// A signal that is heard; a value that is on display.
    Signal,
    /// The operate time T1 running.
    Operate,
    /// The shortened operate time T5 running.
    Shortened,
    /// The recovery time T2 running.
    Recovery,
    /// The no-signal mask T3 running.
    Mask,
    /// Dropped from the mask.
    Dropped,
    /// The service brake.
    Service,
    /// The emergency brake.
    Emergency,
    /// A limit.
    Limit,
    /// What an analog code says.
    Code,
    /// A section reported occupied because a train is heard in it.
    Detected,
    /// A section reported occupied for the tail of a train ahead.
    Held,
    /// A section reported occupied because every one is.
    All,
    /// Check-outs that the block ahead has not taken over.
    Pending,
    /// Nothing.
    Blank,
    /// Not what the kernel says.
    Difference,
}

/// A sign at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Accepted.
    Accepted,
    /// Gone: no longer accepted.
    Gone,
}

/// A signal for a waveform viewer.
#[derive(Clone, Debug)]
pub struct Signal {
    /// Its name, without spaces.
    pub name: String,
    /// Its values, each from its cycle on; the first at cycle 0.
    pub values: Values,
}

/// The values of a signal, each from its cycle on.
#[derive(Clone, Debug)]
pub enum Values {
    /// On or off.
    Wire(Vec<(u64, bool)>),
    /// The name of a state, without spaces.
    State(Vec<(u64, String)>),
    /// A number; there may be none.
    Real(Vec<(u64, Option<f64>)>),
}
