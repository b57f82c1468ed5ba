//! `oracle replay` on the command line: faults seeded into logs, shards, samples, profiles, reports.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::sync::Arc;

use atc_tests::device;
use parquet::data_type::{ByteArray, ByteArrayType};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use serde_json::Value;

fn oracle(folder: &Path, arguments: &[&str]) -> Output {
    let output = Command::new(device::oracle()).args(arguments).current_dir(folder).stdin(Stdio::null()).output();
    output.expect("the oracle runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// A log of walks with the kernel's replies.
fn log(machine: &str, steps: u64, seed: u64) -> String {
    let (steps, seed) = (steps.to_string(), seed.to_string());
    let arguments = ["replay", "generate", "--machine", machine, "--steps", &steps, "--seed", &seed];
    text(&oracle(Path::new("."), &arguments).stdout)
}

fn replay(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = oracle(folder, &[&["replay"], arguments].concat());
    (output.status.code(), text(&output.stdout) + &text(&output.stderr))
}

fn report(path: &Path) -> Value {
    let mut report: Value = serde_json::from_slice(&fs::read(path).expect("a report")).expect("JSON");
    for time in ["began", "seconds"] {
        report[time] = Value::Null;
    }
    report
}

const START: &str = r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":[25,45],"operate_ms":20,"recovery_ms":10,"mask_ms":10,"interruption_ms":10,"shortened_operate_ms":10}}}"#;

/// Two sessions, the kernel's replies; line 12 is the output of step 5 of the first one, of 20 lines.
fn lines() -> Vec<String> {
    let step = |detected: &str| format!(r#"{{"step":{{"detected_km_h":[{detected}]}}}}"#);
    let requests = [START.to_owned()];
    let steps = ["", "25", "25", "25", "25", "45", "45", "45"].map(step);
    let requests: Vec<_> = requests.into_iter().chain(steps).chain([r#"{"stop":{}}"#.to_owned()]).collect();
    let twice = [requests.clone(), requests].concat();
    let replies = device::converse(device::oracle(), twice.join("\n").into_bytes()).expect("a session");
    assert!(replies[4].contains(r#""display_km_h":25"#), "{replies:?}");
    twice.into_iter().zip(replies).flat_map(|(request, reply)| [request, reply]).collect()
}

/// An output that says 25 km/h, as line 12 does.
const OUTPUT: usize = 11;

struct Fault {
    name: &'static str,
    /// What becomes of the lines.
    seed: fn(&mut Vec<String>) -> Option<Vec<u8>>,
    code: i32,
    /// What is said of it.
    says: &'static [&'static str],
}

fn change(lines: &mut [String], line: usize, from: &str, to: &str) -> Option<Vec<u8>> {
    assert!(lines[line].contains(from), "{}", lines[line]);
    lines[line] = lines[line].replace(from, to);
    None
}

const FAULTS: &[Fault] = &[
    Fault { name: "none", seed: |_| None, code: 0, says: &["AGREES: 4 of 4 sessions agree, 32 steps in 2 files"] },
    Fault {
        name: "higher speed",
        seed: |lines| change(lines, OUTPUT, "25", "45"),
        code: 1,
        says: &[
            "t.jsonl: line 12: aspect-acceptance, step 5 of the session of line 1\n    display_km_h: expected 25, got 45  DANGEROUS",
            "requirements: ACC-1",
            "DIFFERS: 3 of 4",
        ],
    },
    Fault {
        name: "lower speed in the second session",
        seed: |lines| change(lines, 20 + OUTPUT, "25", "null"),
        code: 1,
        says: &[
            "t.jsonl: line 32: aspect-acceptance, step 5 of the session of line 21\n    display_km_h: expected 25, got null\n",
        ],
    },
    Fault {
        name: "wrong type of an output",
        seed: |lines| change(lines, OUTPUT, "25", "\"25\""),
        code: 1,
        says: &["line 12: ", "expected 25, got \"25\""],
    },
    Fault {
        name: "missing field",
        seed: |lines| change(lines, OUTPUT, r#""display_km_h":25"#, ""),
        code: 1,
        says: &["line 12: ", "expected 25, got nothing"],
    },
    Fault {
        name: "extra field of an output, which may be",
        seed: |lines| change(lines, OUTPUT, "25", r#"25,"lamp":true"#),
        code: 0,
        says: &["AGREES"],
    },
    Fault {
        name: "extra field of a step",
        seed: |lines| change(lines, OUTPUT - 1, "]", r#"],"lamp":1"#),
        code: 1,
        says: &["line 12: ", "a reply \"malformed\" was due", "unknown field `lamp`"],
    },
    Fault {
        name: "wrong type of a step",
        seed: |lines| change(lines, OUTPUT - 1, "[25]", "25"),
        code: 1,
        says: &["line 12: ", "a reply \"malformed\" was due"],
    },
    Fault {
        name: "output that is no object",
        seed: |lines| change(lines, OUTPUT, r#"{"display_km_h":25}"#, "25"),
        code: 1,
        says: &["line 12: ", "a reply \"output\" was due"],
    },
    Fault {
        name: "a good step that was refused",
        seed: |lines| {
            r#"{"malformed":{"reason":"what?"}}"#.clone_into(&mut lines[OUTPUT]);
            None
        },
        code: 1,
        says: &["line 12: ", "a reply \"output\" was due, and it says {\"malformed\""],
    },
    Fault {
        name: "start of a good configuration that was rejected",
        seed: |lines| {
            r#"{"rejected":{"reason":"no"}}"#.clone_into(&mut lines[1]);
            None
        },
        code: 1,
        says: &["line 2: aspect-acceptance, the start of the session", "expected \"started\", got \"rejected\""],
    },
    Fault {
        name: "a parameter of other length",
        seed: |lines| change(lines, 1, r#""operate":2"#, r#""operate":3"#),
        code: 1,
        says: &["line 2: ", "cycles/operate: expected 2, got 3"],
    },
    Fault {
        name: "lost reply",
        seed: |lines| {
            lines.remove(OUTPUT);
            None
        },
        code: 2,
        says: &["a reply is lost", "(see line 11)", "NOT READ"],
    },
    Fault {
        name: "lost request",
        seed: |lines| {
            lines.remove(OUTPUT - 1);
            None
        },
        code: 2,
        says: &[
            "t.jsonl: line 11: a reply \"output\" to no request; a request is lost",
            "8 lines behind it were passed over",
        ],
    },
    Fault {
        name: "swapped lines",
        seed: |lines| {
            lines.swap(OUTPUT - 1, OUTPUT);
            None
        },
        code: 2,
        says: &["t.jsonl: line 11: a reply \"output\" to no request", "in the wrong order"],
    },
    Fault {
        name: "two steps swapped with their replies",
        seed: |lines| {
            lines[2..6].rotate_left(2);
            None
        },
        code: 1,
        says: &["DIFFERS"],
    },
    Fault {
        name: "file cut in a reply",
        seed: |lines| {
            lines.truncate(OUTPUT + 1);
            let whole = lines.join("\n");
            Some(whole.as_bytes()[..whole.len() - 4].to_vec())
        },
        code: 2,
        says: &["line 12: neither a request nor a reply of protocol 1", "the file ends in this line"],
    },
    Fault {
        name: "file cut in a request",
        seed: |lines| {
            lines.truncate(OUTPUT);
            let whole = lines.join("\n");
            Some(whole.as_bytes()[..whole.len() - 4].to_vec())
        },
        code: 2,
        says: &["line 11: neither a request nor a reply of protocol 1", "the file ends in this line"],
    },
    Fault {
        name: "file cut behind a request",
        seed: |lines| {
            lines.truncate(OUTPUT);
            None
        },
        code: 2,
        says: &["a step has no reply before the end of the file", "(see line 11)"],
    },
    Fault {
        name: "file cut between two lines, which may be",
        seed: |lines| {
            lines.truncate(OUTPUT + 1);
            None
        },
        code: 0,
        says: &["; 1 without a stop"],
    },
    Fault {
        name: "garbage",
        seed: |lines| {
            lines.insert(OUTPUT, "\u{1}%&".to_owned());
            None
        },
        code: 2,
        says: &["line 12: neither a request nor a reply of protocol 1"],
    },
    Fault {
        name: "not UTF-8",
        seed: |lines| {
            let mut bytes = (lines.join("\n") + "\n").into_bytes();
            let place = bytes.windows(8).position(|part| part == b"{\"output").expect("an output");
            bytes[place + 3] = 0xff;
            Some(bytes)
        },
        code: 2,
        says: &["this is not UTF-8"],
    },
    Fault {
        name: "too long a line",
        seed: |lines| {
            lines.insert(OUTPUT, "x".repeat((1 << 20) + 1));
            None
        },
        code: 2,
        says: &["line 12: the line is longer than 1048576 bytes"],
    },
    Fault {
        name: "byte order mark",
        seed: |lines| {
            lines[0].insert(0, '\u{feff}');
            None
        },
        code: 2,
        says: &["t.jsonl: line 1: a byte order mark", "19 lines behind it were passed over", "3 of 3 sessions agree"],
    },
    Fault {
        name: "CRLF and empty lines, which may be",
        seed: |lines| Some(lines.join("\r\n\r\n").into_bytes()),
        code: 0,
        says: &["AGREES: 4 of 4"],
    },
    Fault { name: "empty file", seed: |_| Some(Vec::new()), code: 2, says: &["t.jsonl: the file is empty"] },
    Fault {
        name: "nothing but empty lines",
        seed: |_| Some(b"\n\n \n".to_vec()),
        code: 2,
        says: &["t.jsonl: there is no session in the file"],
    },
    Fault {
        name: "wrong protocol",
        seed: |lines| change(lines, 0, r#""protocol":1"#, r#""protocol":2"#),
        code: 2,
        says: &["t.jsonl: line 1: protocol 2 is not spoken here; protocol 1 is"],
    },
    Fault {
        name: "unknown machine",
        seed: |lines| change(lines, 0, "aspect-", "a-"),
        code: 2,
        says: &["t.jsonl: line 1: there is no machine \"a-acceptance\" here; there are aspect-acceptance"],
    },
    Fault {
        name: "configuration of another form",
        seed: |lines| change(lines, 0, "[25,45]", "25"),
        code: 2,
        says: &["t.jsonl: line 1: column"],
    },
    Fault {
        name: "lost start",
        seed: |lines| {
            lines.remove(0);
            None
        },
        code: 2,
        says: &["t.jsonl: line 1: the file begins in the middle of a session"],
    },
    Fault {
        name: "lost stop",
        seed: |lines| {
            lines.drain(18..20);
            None
        },
        code: 2,
        says: &["t.jsonl: line 19: a start inside a session, which has no stop"],
    },
    Fault {
        name: "lost start of the second session",
        seed: |lines| {
            lines.drain(20..22);
            None
        },
        code: 2,
        says: &["t.jsonl: line 21: a step outside a session"],
    },
];

/// Each fault is found and named, or refused by name; the other file is compared all the same; and it makes no difference in how many pieces
/// the files are read.
#[test]
fn every_seeded_fault_is_named() {
    let whole = lines();
    let mut problems = Vec::new();
    for fault in FAULTS {
        let folder = tempfile::tempdir().expect("a folder");
        let mut seeded = whole.clone();
        let bytes = (fault.seed)(&mut seeded);
        fs::create_dir(folder.path().join("logs")).expect("a folder");
        fs::write(folder.path().join("logs/t.jsonl"), bytes.unwrap_or_else(|| (seeded.join("\n") + "\n").into_bytes()))
            .expect("a log");
        fs::write(folder.path().join("logs/z.jsonl"), whole.join("\n")).expect("a log");
        let (code, said) = replay(folder.path(), &["logs", "--json", "one.json", "--jobs", "1"]);
        if code != Some(fault.code) || fault.says.iter().any(|says| !said.contains(says)) {
            problems.push(format!("{}: {code:?}\n{said}", fault.name));
        }
        replay(folder.path(), &["logs", "--json", "many.json", "--jobs", "3", "--unit", "701"]);
        let (one, many) = (report(&folder.path().join("one.json")), report(&folder.path().join("many.json")));
        if one != many {
            problems.push(format!("{}: other pieces\n{one:#}\n{many:#}", fault.name));
        }
        let agree = one["machines"][0]["agree"].as_u64().unwrap_or_default();
        if agree < 2 {
            problems.push(format!("{}: {agree} sessions agree, two of them are in the other file", fault.name));
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// A folder of logs of several machines, with faults.
fn logs(folder: &Path) {
    fs::create_dir_all(folder.join("deep")).expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).expect("a log");
    // null is a value, and not the same as nothing.
    let wrong = log("aspect-acceptance", 900, 3).replacen(r#""display_km_h":null}"#, r#""display_km_h":25}"#, 3);
    let wrong = wrong.replace(r#""display_km_h":45}"#, r#""display_km_h":25}"#);
    write("a.jsonl", &wrong);
    write("b.jsonl", &log("block-count", 300, 1));
    write("deep/c.jsonl", &log("speed-supervision", 400, 1).replacen("{\"output\"", "{\"outpur\"", 7));
    write("deep/empty.jsonl", "");
    write("deep/notes.txt", "not a log");
    write("d.jsonl.gz", "packed");
    write("e.parquet", "PAR1");
    let rows = wrong.lines().map(|line| Some(line.as_bytes())).collect();
    fs::write(folder.join("deep/f.parquet"), parquet(&[("line", rows)], 500)).expect("a log");
}

/// A Parquet file with these columns of text, packed by SNAPPY, in row groups of so many rows.
fn parquet(columns: &[(&str, Vec<Option<&[u8]>>)], rows: usize) -> Vec<u8> {
    let schema: Vec<_> = columns.iter().map(|(name, _)| format!("optional binary {name} (STRING);")).collect();
    let schema = parse_message_type(&format!("message log {{ {} }}", schema.concat()));
    let schema = Arc::new(schema.expect("a schema"));
    let packed = WriterProperties::builder().set_compression(parquet::basic::Compression::SNAPPY).build();
    let mut bytes = Vec::new();
    let mut out = SerializedFileWriter::new(&mut bytes, schema, Arc::new(packed)).expect("a writer");
    for from in (0..columns[0].1.len()).step_by(rows) {
        let mut group = out.next_row_group().expect("a group");
        for (_, values) in columns {
            let values = &values[from..(from + rows).min(values.len())];
            let there: Vec<i16> = values.iter().map(|value| value.is_some().into()).collect();
            let values: Vec<ByteArray> = values.iter().flatten().map(|value| ByteArray::from(value.to_vec())).collect();
            let mut column = group.next_column().expect("it writes").expect("a column");
            column.typed::<ByteArrayType>().write_batch(&values, Some(&there), None).expect("it writes");
            column.close().expect("it writes");
        }
        group.close().expect("it writes");
    }
    out.close().expect("it writes");
    bytes
}

/// What a report says but for the names and sizes of files.
fn but_for_names(mut report: Value) -> Value {
    for name in ["bytes", "input"] {
        report[name] = Value::Null;
    }
    for list in ["differences", "unread"] {
        for one in report[list].as_array_mut().into_iter().flatten() {
            one["file"] = Value::Null;
        }
    }
    report
}

/// A log as Parquet has the report of the same log as JSON lines, with every fault, whatever stands in its rows.
#[test]
fn parquet_says_the_same_as_json_lines() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    for fault in FAULTS {
        let mut lines = lines();
        let bytes = (fault.seed)(&mut lines).unwrap_or_else(|| (lines.join("\n") + "\n").into_bytes());
        // Every row has its end.
        let bytes = bytes.strip_suffix(b"\n").unwrap_or(&bytes);
        fs::write(at.join("t.jsonl"), [bytes, b"\n"].concat()).expect("a log");
        let rows = bytes.split(|byte| *byte == b'\n').map(Some).collect();
        fs::write(at.join("t.parquet"), parquet(&[("line", rows)], 7)).expect("a log");
        let (code, text) = replay(at, &["t.jsonl", "--json", "lines.json"]);
        let (other, rows) = replay(at, &["t.parquet", "--json", "rows.json"]);
        assert_eq!(code, other, "{}: {text}\n{rows}", fault.name);
        let [one, other] = ["lines.json", "rows.json"].map(|name| but_for_names(report(&at.join(name))));
        assert!(one == other, "{}: {one:#}\n{other:#}", fault.name);
    }
}

/// A row with a request and its reply: places are rows.
#[test]
fn a_request_and_its_reply_are_one_row() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let mut lines = lines();
    change(&mut lines, 20 + OUTPUT, "25", "45");
    let pairs = || lines.chunks_exact(2).map(|pair| [&pair[0], &pair[1]].map(|line| Some(line.as_bytes())));
    let mut columns =
        [("reply", pairs().map(|[_, reply]| reply).collect()), ("time", pairs().map(|_| None).collect())].to_vec();
    columns.push(("request", pairs().map(|[request, _]| request).collect::<Vec<_>>()));
    let whole = parquet(&columns, 6);
    fs::write(at.join("t.parquet"), &whole).expect("a log");
    fs::write(at.join("t.jsonl"), lines.join("\n")).expect("a log");
    let (code, said) = replay(at, &["t.parquet", "--json", "rows.json"]);
    let says = "t.parquet: line 16: aspect-acceptance, step 5 of the session of line 11\n";
    assert!(code == Some(1) && said.contains(says), "{said}");
    replay(at, &["t.jsonl", "--json", "lines.json"]);
    let [rows, lines] = ["rows.json", "lines.json"].map(|name| report(&at.join(name))["differences"][0].clone());
    for same in ["session", "as_if", "requirements", "offset", "at"] {
        assert_eq!(rows[same], lines[same], "{same}");
    }
    assert_eq!(rows["session"].as_array().map(Vec::len), Some(12));
    // A page that is damaged: what stands before it is compared, and the rest is named.
    let mut damaged = whole;
    let end = damaged.len() - 8;
    let footer = u32::from_le_bytes(damaged[end..end + 4].try_into().expect("four bytes"));
    let end = end - usize::try_from(footer).expect("small");
    // Behind the pages stand their indexes, which nobody reads.
    damaged[end / 3..end].fill(0xff);
    fs::write(at.join("t.parquet"), &damaged).expect("a log");
    let (code, said) = replay(at, &["t.parquet"]);
    assert!(code == Some(2) && said.contains("reading breaks off: it is no Parquet, or damaged"), "{said}");
    assert!(said.contains("of 1 sessions agree") || said.contains("of 2 sessions agree"), "{said}");
    assert!(!said.contains("panicked"), "{said}");
}

/// Shards, joined, are the report of one run but for the times; a shard that is missing is named, and others are refused.
#[test]
fn shards_join_to_the_report_of_one_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    logs(&at.join("logs"));
    let (code, said) = replay(at, &["logs", "--json", "whole.json", "--differences", "12"]);
    assert_eq!(code, Some(2), "{said}");
    for says in [
        "logs/d.jsonl.gz: packed files are not read",
        "logs/e.parquet: it is no Parquet, or damaged",
        "empty.jsonl: the file is empty",
    ] {
        assert!(said.contains(says), "{said}");
    }
    let whole = report(&at.join("whole.json"));
    assert_eq!(whole["differences"].as_array().map(Vec::len), Some(12), "{said}");
    let names: Vec<_> = (1..=5).map(|index| format!("shard-{index}.json")).collect();
    for (index, name) in (1..).zip(&names) {
        let shard = format!("{index}/5");
        let (_, said) =
            replay(at, &["logs", "--json", name, "--differences", "12", "--shard", &shard, "--unit", "9000"]);
        assert!(said.contains(&format!("shard {shard} alone")), "{said}");
    }
    let merge =
        |names: &[&str]| replay(at, &[&["merge"], names, &["--json", "merged.json", "--html", "m.html"]].concat());
    let mut all: Vec<_> = names.iter().map(String::as_str).collect();
    all.reverse();
    let (code, said) = merge(&all);
    assert_eq!(code, Some(2), "{said}");
    let merged = report(&at.join("merged.json"));
    assert!(whole == merged, "{whole:#}\n{merged:#}");
    // The second one is missing.
    let (code, said) = merge(&[all[0], all[1], all[2], all[4]]);
    assert_eq!(code, Some(2));
    assert!(said.contains("not read: shard 2/5: it is missing"), "{said}");
    let (_, said) = merge(&[all[0], all[0]]);
    assert!(said.contains("both are shard 5/5"), "{said}");
    let (_, said) = merge(&["whole.json"]);
    assert!(said.contains("not of a shard"), "{said}");
    replay(at, &["logs", "--json", "other.json", "--shard", "1/5", "--sample", "1/2", "--differences", "12"]);
    let (code, said) = merge(&[all[0], "other.json"]);
    assert_eq!(code, Some(2));
    assert!(said.contains("do not belong together: they differ in --sample"), "{said}");
    fs::write(at.join("no.json"), "{}").expect("a file");
    let (code, said) = merge(&["no.json"]);
    assert_eq!((code, said.contains("no.json: this is no JSON report of `oracle replay`")), (Some(2), true), "{said}");
}

/// A sample is the same wherever the folder lies, and another seed draws another one.
#[test]
fn a_sample_hangs_on_names_and_places_only() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    logs(&at.join("one"));
    logs(&at.join("two/elsewhere"));
    let drawn = |logs: &str, seed: &str, jobs: &str| {
        replay(at, &[logs, "--json", "s.json", "--sample", "1/4", "--seed", seed, "--jobs", jobs]);
        let report = report(&at.join("s.json"));
        (report["machines"].clone(), report["left_out"].clone(), report["differences"][0]["offset"].clone())
    };
    let one = drawn("one", "1", "1");
    assert_eq!(one, drawn("two/elsewhere", "1", "4"));
    assert_ne!(one, drawn("one", "2", "1"));
    let sessions: u64 =
        one.0.as_array().expect("machines").iter().filter_map(|machine| machine["sessions"].as_u64()).sum();
    let left = one.1.as_u64().expect("a number");
    assert!(sessions > 3 && left > sessions && left < 10 * sessions, "{sessions} of {}", sessions + left);
}

/// The profile is that of `oracle conform`: levels, what is known, ignored and left out.
#[test]
fn a_profile_says_what_is_known() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    let right = lines().join("\n");
    write("right.jsonl", &right);
    write("wrong.jsonl", &right.replace(r#""display_km_h":25"#, r#""display_km_h":45"#));
    let entry = "machine = \"aspect-acceptance\"\nreason = \"a lamp of its own\"\n";
    write("known.toml", &format!("[[known]]\nfield = \"display_km_h\"\n{entry}"));
    write("ignore.toml", &format!("[[ignore]]\nfield = \"display_km_h\"\n{entry}"));
    write("skip.toml", &format!("implementation = \"Cab 7\"\n[[skip]]\n{entry}"));
    write("bad.toml", "[[skip]]\n");
    let cases = [
        ("wrong.jsonl", "known.toml", 0, "known difference, seen again: display_km_h: a lamp of its own"),
        ("right.jsonl", "known.toml", 1, "known difference is gone"),
        ("wrong.jsonl", "ignore.toml", 0, "AGREES"),
        ("wrong.jsonl", "skip.toml", 1, "NOTHING WAS COMPARED"),
        ("wrong.jsonl", "bad.toml", 2, "bad.toml: "),
        ("wrong.jsonl", "none.toml", 2, "none.toml cannot be read"),
    ];
    for (log, profile, code, says) in cases {
        let (ended, said) = replay(folder.path(), &[log, "--profile", profile]);
        assert_eq!(ended, Some(code), "{log} with {profile}: {said}");
        assert!(said.contains(says), "{log} with {profile}: {said}");
    }
}

/// JSON by its schema, JUnit, a page with a chart, progress without a terminal, standard input, the guesses; and what cannot be written is told
/// before the work.
#[test]
fn reports_are_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let wrong = lines().join("\n").replacen(r#"{"display_km_h":25}"#, r#"{"display_km_h":null}"#, 1);
    fs::write(at.join("t.jsonl"), format!("{wrong}\n{}", log("aspect-acceptance", 8000, 1))).expect("a log");
    let arguments = ["t.jsonl", "--json", "r.json", "--junit", "r.xml", "--html", "r.html"];
    let (code, said) = replay(at, &arguments);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("the kernel would say the same with operate_ms one cycle longer (ACC-1)"), "{said}");
    let schema: Value = serde_json::from_slice(&oracle(at, &["schema", "replay"]).stdout).expect("a schema");
    let json: Value = serde_json::from_slice(&fs::read(at.join("r.json")).expect("a report")).expect("JSON");
    jsonschema::validate(&schema, &json).unwrap_or_else(|error| panic!("{error}: {json:#}"));
    let read = |name: &str| fs::read_to_string(at.join(name)).expect("a file");
    let junit = read("r.xml");
    assert!(
        junit.contains("failures=\"1\"") && junit.contains("t.jsonl: line 8: aspect-acceptance, step 3"),
        "{junit}"
    );
    let page = read("r.html");
    assert!(page.contains("<svg") && page.contains("display as recorded") && page.contains("ACC-1"), "{page}");
    // The same by standard input, which ends only once its progress was told.
    let mut child = Command::new(device::oracle())
        .args(["replay", "-", "--json", "s.json", "--progress", "5ms"])
        .current_dir(at)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the oracle runs");
    let mut input = child.stdin.take().expect("a pipe");
    input.write_all(read("t.jsonl").as_bytes()).expect("a pipe");
    let mut told = BufReader::new(child.stderr.take().expect("a pipe")).lines();
    let first = told.find(|line| line.as_ref().is_ok_and(|line| line.starts_with("replay: file 1 of 1, ")));
    let first = first.expect("progress").expect("a line");
    assert!(first.ends_with(" s, time left unknown"), "{first}");
    drop(input);
    assert_eq!(told.filter(Result::is_err).count(), 0);
    assert_eq!(child.wait().expect("an end").code(), Some(1));
    let stream = report(&at.join("s.json"));
    assert_eq!((&stream["machines"], &stream["differences"][0]["line"]), (&json["machines"], &8.into()));
    for (arguments, message) in [
        (&["-", "--shard", "1/2"][..], "- is no plain file, and a shard has to know its length"),
        (&["t.jsonl", "--shard", "3/2"], "a part is two whole numbers from 1"),
        (&["t.jsonl", "--sample", "0/2"], "a part is two whole numbers from 1"),
        (&["t.jsonl", "--json", "no/r.json"], "no/r.json cannot be written"),
        (&["nowhere.jsonl"], "nowhere.jsonl: it cannot be read"),
        (&["generate", "--machine", "block"], "there is no machine \"block\""),
        (&[], "LOGS"),
    ] {
        let (code, said) = replay(at, arguments);
        assert_eq!(code, Some(2), "{arguments:?}: {said}");
        assert!(said.contains(message), "{arguments:?}: {said}");
    }
}
