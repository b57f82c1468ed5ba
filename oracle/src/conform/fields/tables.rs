//! The fields of each machine, and the requirements that speak of them. A test holds the ids against `spec/`.

use serde_json::Value;

use super::{Absent, Danger, Field, Level, Shape, Table};

/// The fields of that machine; none for a machine without a table.
pub fn table(machine: &str) -> Option<&'static Table> {
    TABLES.iter().find(|table| table.machine == machine)
}

/// A field that leaves the device, compared as it stands.
const fn output(name: &'static str, danger: Danger, requirements: &'static [&'static str]) -> Field {
    let (level, shape, absent) = (Level::Output, Shape::Plain, Absent::Counts);
    Field { name, level, get: None, shape, absent, danger, requirements }
}

/// A field that leaves the device, compared as a set.
const fn set(name: &'static str, danger: Danger, requirements: &'static [&'static str]) -> Field {
    Field { shape: Shape::Set, ..output(name, danger, requirements) }
}

/// The name of what an output field says only to be there.
const fn reason(name: &'static str, get: fn(&Value) -> Option<Value>, requirements: &'static [&'static str]) -> Field {
    Field { level: Level::Reason, get: Some(get), ..output(name, Danger::No, requirements) }
}

/// The value below a name, or, if there is one, that there is one.
fn there(output: &Value, name: &str, word: &str) -> Option<Value> {
    output.get(name).map(|value| if value.is_null() { Value::Null } else { word.into() })
}

/// Every table, in the order of the machines.
pub const TABLES: &[Table] =
    &[ASPECT, SUPERVISION, BLOCK, TELEGRAM, PATTERN, PERMITTED, POSITION, INTERLOCKING, TRAIN, WAYSIDE];

const ASPECT: Table = Table {
    machine: "aspect-acceptance",
    start: &["TIME-2", "TIME-3", "TIME-4"],
    cycles: &["TIME-1", "TIME-3"],
    fields: &[output(
        "display_km_h",
        Danger::Higher,
        &["ACC-1", "ACC-2", "ACC-3", "ACC-4", "ACC-5", "ACC-6", "ACC-7", "ACC-8", "ACC-9", "TIME-1"],
    )],
};

const SUPERVISION: Table = Table {
    machine: "speed-supervision",
    start: &["SUP-3"],
    cycles: &[],
    fields: &[output("brake", Danger::WeakerBrake, &["SUP-1", "SUP-2"])],
};

const BLOCK: Table = Table {
    machine: "block-count",
    start: &["BLK-8"],
    cycles: &["BLK-8"],
    fields: &[
        set("occupied", Danger::Fewer, &["BLK-1", "BLK-2", "BLK-4", "BLK-5", "BLK-6"]),
        output("behind_hold_sections", Danger::Lower, &["BLK-5"]),
        output("agree", Danger::Appears, &["BLK-1", "BLK-2", "BLK-4"]),
        output("count", Danger::Lower, &["BLK-4", "BLK-6", "BLK-7"]),
        Field {
            get: Some(|output| there(output, "fault", "a fault")),
            ..output("fault", Danger::Vanishes, &["BLK-3", "BLK-4", "BLK-7"])
        },
        reason("fault name", |output| output.get("fault").cloned(), &["BLK-3"]),
        Field { absent: Absent::NotCompared, ..output("counting", Danger::Appears, &["BLK-2", "BLK-4"]) },
    ],
};

const TELEGRAM: Table = Table {
    machine: "telegram-codec",
    start: &[],
    cycles: &[],
    fields: &[
        output("frame", Danger::Always, &["TEL-1", "TEL-3"]),
        output("telegram", Danger::Always, &["TEL-1", "TEL-2", "TEL-3", "TEL-4"]),
        Field {
            get: Some(|output| there(output, "error", "an error")),
            ..output("error", Danger::Vanishes, &["TEL-2", "TEL-3", "TEL-4"])
        },
        reason("error name", |output| output.get("error").cloned(), &["TEL-1", "TEL-2", "TEL-3", "TEL-4"]),
        output("telegrams", Danger::Always, &["TEL-2", "TEL-5"]),
    ],
};

const PATTERN: Table = Table {
    machine: "braking-pattern",
    start: &["PAT-3"],
    cycles: &[],
    fields: &[output("speed_km_h", Danger::Higher, &["PAT-1", "PAT-2"])],
};

const PERMITTED: Table = Table {
    machine: "permitted-speed",
    start: &["PER-9", "TEL-7", "PAT-3", "TIME-4"],
    cycles: &["PER-8"],
    fields: &[
        output(
            "speed_km_h",
            Danger::Higher,
            &[
                "PER-1", "PER-2", "PER-3", "PER-4", "PER-5", "PER-6", "PER-7", "PER-8", "PER-10", "PER-11", "PER-12",
                "PER-13", "PER-14", "PER-15", "TEL-6", "TEL-8", "PAT-1", "PAT-2",
            ],
        ),
        Field {
            level: Level::Reason,
            ..output("basis", Danger::No, &["PER-1", "PER-3", "PER-6", "PER-8", "PER-13", "PER-14", "TEL-6", "TEL-8"])
        },
        Field {
            level: Level::State,
            absent: Absent::NotCompared,
            ..output("state", Danger::No, &["PER-4", "PER-8", "PER-10", "PER-11", "PER-12", "TEL-6", "TEL-8"])
        },
    ],
};

const POSITION: Table = Table {
    machine: "train-position",
    start: &["POS-5"],
    cycles: &[],
    fields: &[output("interval_m", Danger::Narrower, &["POS-1", "POS-2", "POS-3", "POS-4", "POS-6", "POS-7"])],
};

const INTERLOCKING: Table = Table {
    machine: "interlocking",
    start: &["LAY-1", "LAY-2"],
    cycles: &["TRK-1", "ILK-19"],
    fields: &[
        set("proceed", Danger::More, &["ILK-6", "ILK-7", "ILK-13", "ILK-15", "ILK-23", "ILK-26", "TRK-1"]),
        Field {
            shape: Shape::Entries(&[
                output("stop", Danger::Always, &["ATC-1", "ATC-2", "ATC-3", "ATC-13", "ILK-13", "TRK-1"]),
                output("speed_km_h", Danger::Higher, &["ATC-4", "ATC-8", "ATC-9", "ILK-15"]),
                output("open", Danger::Appears, &["ATC-1", "ATC-2", "ATC-7"]),
                output("heading", Danger::Always, &["ATC-10", "ATC-7"]),
            ]),
            ..output(
                "telegrams",
                Danger::More,
                &["ATC-1", "ATC-2", "ATC-3", "ATC-7", "ATC-12", "ATC-13", "ILK-13", "TRK-1"],
            )
        },
        Field { shape: Shape::Entries(&[]), ..output("drives", Danger::More, &["ILK-3", "ILK-8", "ILK-23"]) },
        set("permits", Danger::More, &["ILK-4", "ILK-15", "ILK-18", "ILK-19", "ILK-20", "ILK-25"]),
        set(
            "confirmed",
            Danger::More,
            &["ILK-15", "ILK-16", "ILK-19", "ILK-23", "ILK-24", "ILK-28", "ILK-31", "TRK-1"],
        ),
        Field { absent: Absent::Empty, ..set("silent", Danger::Fewer, &["ATC-12"]) },
        Field {
            get: Some(|output| {
                let answer = output.get("answer")?;
                Some(if answer.get("refused").is_some() { "refused".into() } else { answer.clone() })
            }),
            ..output(
                "answer",
                Danger::Appears,
                &[
                    "ILK-1", "ILK-2", "ILK-3", "ILK-4", "ILK-12", "ILK-15", "ILK-17", "ILK-18", "ILK-19", "ILK-20",
                    "ILK-24", "ILK-25", "ILK-26", "ILK-27", "ILK-28", "ILK-29", "ILK-30", "ILK-32", "TRK-1",
                ],
            )
        },
        Field {
            shape: Shape::Entries(&[]),
            ..output(
                "routes",
                Danger::No,
                &[
                    "ILK-5", "ILK-6", "ILK-9", "ILK-10", "ILK-11", "ILK-12", "ILK-13", "ILK-14", "ILK-21", "ILK-22",
                    "ILK-23", "TRK-1",
                ],
            )
        },
        reason(
            "answer reason",
            |output| output.get("answer")?.get("refused").cloned(),
            &["ILK-1", "ILK-2", "ILK-3", "ILK-4", "ILK-24", "ILK-28", "ILK-29", "ILK-30", "TRK-1"],
        ),
    ],
};

const TRAIN: Table = Table {
    machine: "train",
    start: &["TRN-8", "CODE-4", "PER-9", "POS-5", "SUP-3", "TIME-4"],
    cycles: &["TIME-1", "TIME-3", "PER-8", "TRN-10"],
    fields: &[
        output(
            "display_km_h",
            Danger::Higher,
            &[
                "TRN-1", "TRN-2", "CODE-1", "CODE-2", "CODE-3", "ACC-1", "ACC-2", "ACC-3", "ACC-4", "ACC-5", "ACC-7",
                "DUP-1",
            ],
        ),
        output(
            "permitted_km_h",
            Danger::Higher,
            &[
                "TRN-2", "TRN-3", "TRN-4", "TRN-5", "TRN-6", "TRN-9", "TRN-11", "TRN-12", "PER-1", "PER-3", "PER-4",
                "PER-5", "PER-6", "PER-7", "PER-8", "TEL-6", "TEL-8", "PAT-1", "DUP-1",
            ],
        ),
        Field { level: Level::Reason, ..output("basis", Danger::No, &["PER-1", "PER-3", "PER-6", "PER-8", "TRN-12"]) },
        output("position_m", Danger::Narrower, &["POS-1", "POS-2", "POS-4", "TRN-6", "TRN-12"]),
        output("brake", Danger::WeakerBrake, &["TRN-7", "TRN-13", "SUP-1", "SUP-2", "DUP-1"]),
    ],
};

const WAYSIDE: Table = Table {
    machine: "wayside",
    start: &["WAY-12", "WAY-13", "WAY-14", "WAY-15", "WAY-16", "WAY-17", "WAY-18", "WAY-19", "WAY-20", "LAY-1"],
    cycles: &["WAY-20", "TRK-1", "ILK-19"],
    fields: &[
        set("proceed", Danger::More, &["WAY-1", "WAY-2", "WAY-8", "WAY-9", "ILK-6", "ILK-26"]),
        Field {
            shape: Shape::Entries(&[
                output("left", Danger::Always, &["WAY-3", "WAY-4", "WAY-5", "WAY-6", "WAY-7"]),
                output("right", Danger::Always, &["WAY-3", "WAY-4", "WAY-5", "WAY-6", "WAY-7"]),
            ]),
            ..output("transmissions", Danger::More, &["WAY-3", "WAY-5", "WAY-8", "WAY-9", "ATC-1", "ATC-2"])
        },
        Field { shape: Shape::Entries(&[]), ..output("messages", Danger::Always, &["WAY-22", "ILK-25"]) },
        Field {
            get: Some(|output| {
                let mut line = output.get("line")?.clone();
                // Whether the count is in force may be left out.
                for block in line["blocks"].as_array_mut().into_iter().flatten() {
                    block.as_object_mut()?.remove("counting");
                }
                Some(line)
            }),
            ..output("line", Danger::Always, &["WAY-2", "BLK-1", "BLK-2", "BLK-5", "BLK-10", "BLK-11"])
        },
        Field { shape: Shape::Entries(&[]), ..output("drives", Danger::More, &["ILK-3", "ILK-8", "ILK-23"]) },
        set("confirmed", Danger::More, &["WAY-1", "ILK-16", "ILK-24"]),
        Field { absent: Absent::Empty, ..set("silent", Danger::Fewer, &["WAY-21"]) },
        Field {
            get: Some(|output| {
                let answer = output.get("answer")?;
                Some(if answer.get("refused").is_some() { "refused".into() } else { answer.clone() })
            }),
            ..output("answer", Danger::Appears, &["WAY-1", "WAY-8", "WAY-9", "WAY-10", "WAY-26", "ILK-1", "ILK-4"])
        },
        Field { shape: Shape::Entries(&[]), ..output("routes", Danger::No, &["WAY-1", "ILK-9", "ILK-10"]) },
        reason("answer reason", |output| output.get("answer")?.get("refused").cloned(), &["WAY-10", "WAY-26", "ILK-1"]),
    ],
};
