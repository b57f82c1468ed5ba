//! The table of variables.

/// The names of an enumeration. A name's number is its place, from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Words {
    /// The name of the type in the XML.
    pub name: &'static str,
    /// The names, the least permissive one first.
    pub words: &'static [&'static str],
}

/// The kind of line that begins.
pub const LINE: Words = Words { name: "LineBegins", words: &["nothing", "analog", "digital"] };
/// The direction of travel in which the train faces.
pub const FACING: Words = Words { name: "Facing", words: &["unknown", "left", "right"] };
/// What the permission rests on: the protocol's words.
pub const BASIS: Words = Words { name: "Basis", words: &["nothing", "analog", "pattern", "both", "running-down"] };
/// The brake command: the protocol's words. Zero is the emergency brake, so that memory which nobody wrote does not release it.
pub const BRAKE: Words = Words { name: "Brake", words: &["emergency", "service", "release"] };

/// Every enumeration.
pub const ENUMERATIONS: [Words; 4] = [LINE, FACING, BASIS, BRAKE];

/// The length of a frame in bytes. Its 106 bits fill the first ones, the first bit is the highest of the first byte.
pub const FRAME_BYTES: usize = 14;

/// The type of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number with its unit, and the least and the greatest that is taken.
    Float64(&'static str, Option<[f64; 2]>),
    /// The least and the greatest.
    UInt8(u8, u8),
    /// The least and the greatest.
    UInt16(u16, u16),
    /// Any number.
    Int8,
    /// Yes or no.
    Boolean,
    /// A frame: [`FRAME_BYTES`] bytes, or none.
    Binary,
    /// One of some names.
    Enumeration(Words),
}

/// Who sets a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// The time.
    Independent,
    /// The simulation.
    Input,
    /// The device.
    Output,
}

/// A variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: &'static str,
    /// Who sets it.
    pub causality: Causality,
    /// Its type.
    pub kind: Kind,
    /// What it says.
    pub what: &'static str,
}

/// The value of a variable.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Any number, and what is none.
    Float64(f64),
    /// 0 to 255.
    UInt8(u8),
    /// 0 to 65535.
    UInt16(u16),
    /// -128 to 127.
    Int8(i8),
    /// Yes or no.
    Boolean(bool),
    /// Any bytes.
    Binary(Vec<u8>),
    /// The number of a name, or none.
    Enumeration(i64),
}

impl Kind {
    /// The name of the type in FMI.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Float64(..) => "Float64",
            Self::UInt8(..) => "UInt8",
            Self::UInt16(..) => "UInt16",
            Self::Int8 => "Int8",
            Self::Boolean => "Boolean",
            Self::Binary => "Binary",
            Self::Enumeration(_) => "Enumeration",
        }
    }

    /// The value before anybody has set one: nothing is there. It is within the range.
    pub const fn start(self) -> Value {
        match self {
            Self::Float64(..) => Value::Float64(0.0),
            Self::UInt8(least, _) => Value::UInt8(least),
            Self::UInt16(least, _) => Value::UInt16(least),
            Self::Int8 => Value::Int8(0),
            Self::Boolean => Value::Boolean(false),
            Self::Binary => Value::Binary(Vec::new()),
            Self::Enumeration(_) => Value::Enumeration(0),
        }
    }
}

const CODE: Kind = Kind::Float64("Hz", Some([0.0, 4_294_967.295]));
const LEVEL: Kind = Kind::Float64("dB", Some([-327.68, 327.67]));
const MOVED: Kind = Kind::Float64("m", Some([-32.768, 32.767]));
const SPEED: Kind = Kind::Float64("km/h", Some([-214_748_364.7, 214_748_364.7]));
const METRES: Kind = Kind::Float64("m", None);
const KM_H: Kind = Kind::Float64("km/h", None);
const NUMBER: Kind = Kind::UInt16(0, u16::MAX);
const COUNTER: Kind = Kind::UInt8(0, u8::MAX);
const RANK: Kind = Kind::UInt8(0, 15);

macro_rules! table {
    ($($place:ident $name:literal $causality:ident $kind:expr, $what:literal;)*) => {
        /// The place of a variable in the table, which is its value reference.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Place {
            $(#[doc = $what] $place,)*
        }

        /// Every variable, in the order of the value references from 0.
        pub const VARIABLES: &[Variable] = &[
            $(Variable { name: $name, causality: Causality::$causality, kind: $kind, what: $what },)*
        ];
    };
}

table! {
    Time "time" Independent Kind::Float64("s", None), "The end of the last step.";
    MainCode "main_code_hz" Input CODE, "The code frequency on the main carrier; 0: there is none.";
    MainReceived "main_received" Input Kind::Boolean, "The frame of a main telegram was completed in this cycle.";
    MainSection "main_section" Input NUMBER, "The section that the main telegram is for.";
    MainCounter "main_counter" Input COUNTER, "The running number of the main telegram.";
    MainClosed "main_closed" Input Kind::Boolean, "The route is closed; main_beyond_exit_m is not looked at.";
    MainBeyondExit "main_beyond_exit_m" Input NUMBER, "How far beyond the exit of the section the train may go, in m.";
    MainSpeedRank "main_speed_rank" Input RANK, "The permitted speed as a rank among the speeds of the line.";
    MainFrame "main_frame" Input Kind::Binary, "In place of the main telegram: the bits of a frame; empty: none.";
    SubCode "sub_code_hz" Input CODE, "The code frequency on the sub carrier; 0: there is none.";
    SubReceived "sub_received" Input Kind::Boolean, "The frame of a sub telegram was completed in this cycle.";
    SubSection "sub_section" Input NUMBER, "The section that the sub telegram is for.";
    SubCounter "sub_counter" Input COUNTER, "The running number of the sub telegram.";
    SubLength "sub_length_m" Input Kind::UInt16(1, u16::MAX), "The length of the section in m.";
    SubGradient "sub_gradient_permille" Input Kind::Int8, "The gradient in thousandths, positive where the train climbs.";
    SubCurveRank "sub_curve_rank" Input RANK, "The limit by curves and points as a rank.";
    SubRestrictionRank "sub_restriction_rank" Input RANK, "The limit by a temporary restriction as a rank.";
    SubFrame "sub_frame" Input Kind::Binary, "In place of the sub telegram: the bits of a frame; empty: none.";
    FirstMeasured "first_measured" Input Kind::Boolean, "The level of the first signal was measured.";
    First "first_db" Input LEVEL, "The level of the signal that the rail attenuates less.";
    SecondMeasured "second_measured" Input Kind::Boolean, "The level of the second signal was measured.";
    Second "second_db" Input LEVEL, "The level of the signal that the rail attenuates more.";
    MovedMeasured "moved_measured" Input Kind::Boolean, "The odometer says how far the train moved in this cycle.";
    MovedLeast "moved_least_m" Input MOVED, "The least that the train moved towards the exit in this cycle.";
    MovedMost "moved_most_m" Input MOVED, "The most that the train moved towards the exit in this cycle.";
    SpeedMeasured "speed_measured" Input Kind::Boolean, "The speed was measured; without it the emergency brake is on.";
    Speed "speed_km_h" Input SPEED, "The measured speed.";
    LineBegins "line_begins" Input Kind::Enumeration(LINE), "The kind of line that begins here.";
    Facing "facing" Input Kind::Enumeration(FACING), "The direction of travel in which the train faces.";
    LostA "lost_a" Input Kind::Boolean, "With two channels: channel A has lost its memory before this step.";
    LostB "lost_b" Input Kind::Boolean, "With two channels: channel B has lost its memory before this step.";
    DisplayShown "display_shown" Output Kind::Boolean, "An aspect is displayed.";
    Display "display_km_h" Output KM_H, "The speed of the displayed aspect; 0 without one.";
    IsPermitted "permitted" Output Kind::Boolean, "A speed is permitted; it may be 0.";
    Permitted "permitted_km_h" Output KM_H, "The permitted speed; 0 without one.";
    Basis "basis" Output Kind::Enumeration(BASIS), "What the permitted speed rests on.";
    PositionKnown "position_known" Output Kind::Boolean, "The position is known.";
    PositionLeast "position_least_m" Output METRES, "The least distance of the front to the exit of the section; 0 if it is unknown.";
    PositionMost "position_most_m" Output METRES, "The greatest distance of the front to the exit of the section; 0 if it is unknown.";
    Brake "brake" Output Kind::Enumeration(BRAKE), "The brake command.";
}

/// The values of all variables. A value never changes its type.
#[derive(Clone, Debug, PartialEq)]
pub struct Values(Vec<Value>);

impl Default for Values {
    fn default() -> Self {
        Self(VARIABLES.iter().map(|variable| variable.kind.start()).collect())
    }
}

impl Values {
    /// A value, by its value reference; none: there is no such variable.
    pub fn get(&self, reference: u32) -> Option<&Value> {
        self.0.get(usize::try_from(reference).ok()?)
    }

    fn at(&self, place: Place) -> Option<&Value> {
        self.0.get(place as usize)
    }

    /// Sets a value. A value of another type than the variable's is passed over.
    pub fn set(&mut self, place: Place, value: Value) {
        self.put(place as usize, value);
    }

    pub(crate) fn put(&mut self, place: usize, value: Value) {
        if let Some(old) = self.0.get_mut(place)
            && std::mem::discriminant(old) == std::mem::discriminant(&value)
        {
            *old = value;
        }
    }

    /// A number; what is not one there is not a number, and so refused by whoever reads it.
    pub fn number(&self, place: Place) -> f64 {
        if let Some(Value::Float64(number)) = self.at(place) { *number } else { f64::NAN }
    }

    /// A whole number; what is not one there is beyond every range.
    pub fn whole(&self, place: Place) -> u32 {
        match self.at(place) {
            Some(Value::UInt8(number)) => (*number).into(),
            Some(Value::UInt16(number)) => (*number).into(),
            _ => u32::MAX,
        }
    }

    /// A whole number with a sign; what is not one there is beyond every range.
    pub fn signed(&self, place: Place) -> i32 {
        if let Some(Value::Int8(number)) = self.at(place) { (*number).into() } else { i32::MAX }
    }

    /// Whether it is so.
    pub fn flag(&self, place: Place) -> bool {
        matches!(self.at(place), Some(Value::Boolean(true)))
    }

    /// The number of a name.
    pub fn word(&self, place: Place) -> i64 {
        if let Some(Value::Enumeration(number)) = self.at(place) { *number } else { -1 }
    }

    /// Bytes.
    pub fn bytes(&self, place: Place) -> &[u8] {
        if let Some(Value::Binary(bytes)) = self.at(place) { bytes } else { &[] }
    }
}
