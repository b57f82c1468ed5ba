//! The rules of a line's data: those of the kernel's constructors, and those between the parts of a line.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Who asks for a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Asked {
    /// The file must say one thing, and say it clearly.
    Form,
    /// Engineering: no theorem rests on it, but safe running does.
    Engineering,
    /// A theorem rests on it.
    Theorems,
}

/// Declares the rules: name in the code, name in messages, who asks for it, what it demands.
macro_rules! rules {
    ($($rule:ident, $id:literal, $asked:ident, $text:literal;)+) => {
        /// A rule of a line's data.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Rule {
            $(#[doc = $text] $rule,)+
        }

        impl Rule {
            /// Every rule.
            pub const ALL: &'static [Self] = &[$(Self::$rule),+];

            /// Its name, the same in every release: the requirement that demands it, or a short name.
            pub const fn id(self) -> &'static str {
                match self { $(Self::$rule => $id,)+ }
            }

            /// What it demands.
            pub const fn text(self) -> &'static str {
                match self { $(Self::$rule => $text,)+ }
            }

            /// Who asks for it.
            pub const fn asked(self) -> Asked {
                match self { $(Self::$rule => Asked::$asked,)+ }
            }
        }
    };
}

rules! {
    Form, "form", Form, "The file has the form of a line.";
    Range, "range", Form, "A value is within its range.";
    SectionTwice, "section-twice", Form, "A section's number stands for one section.";
    Time1, "TIME-1", Theorems, "T1 and T5 are rounded up, T2, T3 and T4 down, each by less than one cycle.";
    Time2, "TIME-2", Theorems, "The times are accepted by the kernel's constructor.";
    Time4, "TIME-4", Theorems, "There are 1 to 16 speeds, strictly rising.";
    Sup3, "SUP-3", Theorems, "The supervision parameters are accepted by the kernel's constructor.";
    Blk3, "BLK-3", Theorems, "The pass time is rounded down, as its lapse restricts.";
    Blk8, "BLK-8", Theorems, "Every block is accepted by the kernel's constructor.";
    Blk9, "BLK-9", Theorems, "The line of blocks is accepted by the kernel's constructor, in both directions.";
    Tel4, "TEL-4", Theorems, "Every section has a length.";
    Tel7, "TEL-7", Theorems, "Window and run are in range; the memory is longer than a telegram.";
    Pat3, "PAT-3", Theorems, "A brake is 1 to 4095 mm/s².";
    Per4, "PER-4", Theorems, "The margin covers where the section behind is still heard, and the delay of a telegram.";
    Per5, "PER-5", Theorems, "No gradient and no limit of a section is worse than what is assumed.";
    Per7, "PER-7", Theorems, "The limit of a section is a speed of the table.";
    Per8, "PER-8", Theorems, "What was withdrawn stays free, and a restriction is sent ahead, for as long as trains act on what was before.";
    Per9, "PER-9", Theorems, "The parameters of the permitted speed are accepted by the kernel's constructor.";
    Pos5, "POS-5", Theorems, "The attenuation table is accepted by the kernel's constructor.";
    Code3, "CODE-3", Theorems, "Each carrier has 1 to 8 code frequencies, whose bands do not touch.";
    Code4, "CODE-4", Theorems, "The code table names a speed, and each pair of codes names one.";
    CodeSpeed, "code-speed", Engineering, "A pair of codes names the speed of an aspect, and each aspect has a pair.";
    OneWrongCode, "one-wrong-code", Engineering, "A single code that is taken for another one names no speed.";
    TrainBrake, "train-brake", Engineering, "The pattern brakes no harder than every train can.";
    Station, "station", Engineering, "The layout of a station keeps every rule of layouts.";
    StationTwice, "station-twice", Form, "A name stands for one station.";
    TrainLength, "train-length", Engineering, "No train is longer than what the ground counts on.";
    TelegramLives, "telegram-lives", Engineering, "The ground counts on telegrams for as long as trains act on them.";
    ReleasePromised, "release-promised", Engineering, "A withdrawn route stays locked for as long as the line promises its trains.";
    TurnPromised, "turn-promised", Engineering, "Plain line turns after no less than the line promises its trains.";
    Brake, "brake", Engineering, "The ground counts on no harder braking than trains do.";
    FromTelegrams, "from-telegrams", Engineering, "A train that comes from telegrams to codes has the room that the distances of the codes hold.";
    HeardBeyond, "heard-beyond", Engineering, "The distances of codes hold for how far beyond its circuit a code is heard.";
    ShuntLoss, "shunt-loss", Engineering, "A train's shunt is lost for no longer than the ground counts on.";
    LossWithinClear, "loss-within-clear", Engineering, "T_clear is at least twice the longest loss of a train's shunt, and exceeds it by two cycles.";
    Gradient, "gradient", Engineering, "No circuit is steeper than what trains assume.";
    RankMissing, "rank-missing", Engineering, "Every speed code of a station has a speed in the line's table.";
    RankFaster, "rank-faster", Engineering, "A telegram names no higher speed than the station's code.";
    RankStop, "rank-stop", Engineering, "The lowest rank in telegrams means 0 km/h, as the station's code 0 does.";
    RankRises, "rank-rises", Theorems, "Telegrams name no lower speed for a higher code of a station.";
    CodeMissing, "code-missing", Theorems, "Every speed that a station's telegrams name, and 0 km/h, has a pair of codes.";
    SpeedPlausible, "speed-plausible", Engineering, "No speed of a station is implausible to a train.";
    TelegramCircuit, "telegram-circuit", Form, "A telegram section belongs to a circuit of a station.";
    TelegramTwice, "telegram-twice", Engineering, "A section number is sent in one circuit, for one direction of travel.";
    TelegramDirection, "telegram-direction", Engineering, "A section number is odd for trains that travel to the left, and even for those to the right: so trains know whom it is for.";
    TelegramDiffers, "telegram-differs", Engineering, "A circuit that two stations see has the same section numbers in both.";
    TelegramMissing, "telegram-missing", Engineering, "A circuit in which trains run has a section number for their direction of travel.";
    TelegramSection, "telegram-section", Engineering, "A section number is that of a described section.";
    SectionLength, "section-length", Engineering, "Sub telegrams give each circuit the length that its layout gives it.";
    SectionGradient, "section-gradient", Engineering, "Sub telegrams call no circuit, and none ahead that it may be granted, less steep than it is.";
    SectionLimit, "section-limit", Engineering, "The layout lets no train run faster than the sub telegrams of a circuit: codes do not have their limit.";
    BorderNames, "border-names", Form, "A border names stations, a line and a segment that there are.";
    BorderMissing, "border-missing", Engineering, "A line that two stations name is a border of the line, and counted blocks border a station.";
    BorderViews, "border-views", Engineering, "Two stations see the line between them so that no stretch of it is seen by neither.";
    BorderJoint, "border-joint", Engineering, "A segment ends at the joint where the counted blocks begin.";
    BorderTail, "border-tail", Engineering, "The circuits that counted blocks ask a station to hold are as long as the longest train.";
    DeviceStarts, "device-starts", Theorems, "The kernel accepts every device of the line, with what its file says.";
}
