//! The oracle on the command line: the real process, its exit codes, messages and files.
// The snapshots are written by their tool, hashes and all.
#![allow(clippy::needless_raw_string_hashes)]

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::sync::mpsc;
use std::time::Duration;

use atc_tests::device;
use snapbox::{assert_data_eq, str};

fn oracle(folder: &Path, arguments: &[&str]) -> Output {
    let output = Command::new(device::oracle()).args(arguments).current_dir(folder).stdin(Stdio::null()).output();
    output.expect("the oracle runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

fn examples() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracle/examples"))
}

#[test]
fn help_says_what_there_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = oracle(folder.path(), &["--help"]);
    assert!(output.status.success());
    assert_data_eq!(
        text(&output.stdout),
        str![[r#"
The verified kernel as a reference oracle

Usage: oracle <COMMAND>

Commands:
  serve        Answers JSON lines (protocol 1) from standard input on standard output
  chart        Draws the timing chart of a recorded session (SVG) and writes its signals (VCD)
  conform      Holds another implementation against the kernel, down to the first difference
  vectors      Writes test vectors: cases with the kernel's replies and the requirements that they are about
  replay       Holds the logs of recorders against the kernel, in bulk
  signal       Makes the train control signal as a WAV file, or reads one; the link budget of a line
  layout       Checks, imports, tabulates or draws the layout of a station
  line         Checks the data of a whole line, and what its stations and trains count on of each other
  position     Makes the attenuation table of train positions from measured levels
  schema       Prints a JSON Schema: of protocol 1, or of what `conform`, `replay` and `vectors` write
  simulate     Runs a line with trains under the kernel's devices, judged by the truth and not by the devices; exit code 1 if it is unsafe
  explore      Makes a page that plays a session, a trace of a model or a simulated line: track plan, trains, signals, rows over time
  completions  Prints what a shell needs to complete the commands
  help         Print this message or the help of the given subcommand(s)

Options:
  -h, --help     Print help
  -V, --version  Print version

"#]]
    );
    let output = oracle(folder.path(), &["chart", "--help"]);
    assert_data_eq!(
        text(&output.stdout),
        str![[r#"
Draws the timing chart of a recorded session (SVG) and writes its signals (VCD)

Usage: oracle chart [OPTIONS] <TRACE>

Arguments:
  <TRACE>  Request lines, with their replies if these were kept; "-" for standard input

Options:
  -o, --output <FILE.svg>  Where the chart goes; standard output if neither file is named
      --vcd <FILE.vcd>     Where the signals go, for a waveform viewer
      --title <TITLE>      The chart's title [default: the machine's name]
      --from <FROM>        The first instant drawn, in the unit of the chart's axis
      --to <TO>            The last instant drawn
      --only <ONLY>        Draws only the figure over distance, or only the rows [possible values: figure, rows]
      --as-recorded        Draws replies that differ from the kernel's in red, with exit code 1 if there are any; else the first one is an error
  -h, --help               Print help

"#]]
    );
}

/// A trace that cannot be drawn: exit code 1, a message with the file and the line, and no file.
#[test]
fn a_bad_trace_is_named_with_its_line_and_nothing_is_written() {
    let start = r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":[25,45]}}}"#;
    let step = r#"{"step":{"detected_km_h":[25]}}"#;
    let output = r#"{"output":{"display_km_h":null}}"#;
    let cases = [
        (String::new(), "t.jsonl: the trace has no {\"start\":{…}}"),
        (format!("{start}\n"), "t.jsonl: line 1: the case has no step"),
        (format!("{start}\nhello\n"), "t.jsonl: line 2: neither a request nor a reply of protocol 1"),
        (format!("{step}\n"), "t.jsonl: line 1: a step outside a case"),
        ("{\"stop\":{}}\n".to_owned(), "t.jsonl: line 1: a stop outside a case"),
        (format!("{start}\n{start}\n"), "t.jsonl: line 2: a start inside a case"),
        (format!("{start}\n{{\"stop\":{{\"now\":1}}}}\n"), "t.jsonl: line 2, column 14: unknown field `now`"),
        (format!("{start}\n{output}\n"), "t.jsonl: line 2: a reply \"output\" to no request"),
        (format!("{start}\n{step}\n{output}\n{output}\n"), "t.jsonl: line 4: a reply \"output\" to no request"),
        (
            format!("{start}\n\n{{\"step\":{{\"detected_km_h\":[55]}}}}\n"),
            "t.jsonl: line 3: detected_km_h[0] is 55 km/h",
        ),
        (
            format!("{start}\n{{\"step\":{{\"detected\":[]}}}}\n"),
            "t.jsonl: line 2, column 19: unknown field `detected`",
        ),
        (
            start.replace("25,45", "45,25"),
            "t.jsonl: line 1: a start to reject: aspects_km_h[1] is 25 km/h after 45 km/h",
        ),
        (start.replace("aspect-", "a-"), "there is no machine \"a-acceptance\""),
        (start.replace("\"protocol\":1", "\"protocol\":3"), "protocol 3 is not spoken here"),
        (
            format!("{start}\n{step}\n{}\n", output.replace("null", "25")),
            "t.jsonl: line 3: the record says {\"display_km_h\":25}, the kernel {\"display_km_h\":null} (cycle 0 of the case); draw the record with --as-recorded",
        ),
        (format!("{start}\n{step}\n{{\"malformed\":{{\"reason\":\"no\"}}}}\n"), "line 2: recorded as malformed"),
        (
            format!("{start}\n{{\"rejected\":{{\"reason\":\"too slow\"}}}}\n"),
            "the start was rejected, there is no case to draw: too slow",
        ),
        (
            format!("{start}\n{step}\n{{\"output\":{{\"display\":1}}}}\n"),
            "line 3: an output of aspect-acceptance cannot be read",
        ),
    ];
    for (trace, message) in cases {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("t.jsonl"), &trace).expect("a trace");
        let output = oracle(folder.path(), &["chart", "t.jsonl", "-o", "t.svg", "--vcd", "t.vcd"]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{trace}: {said}");
        assert!(said.starts_with("oracle: ") && said.contains(message), "{trace}\nwas answered by {said}");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "{trace} left a file behind");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let output = oracle(folder.path(), &["chart", "nowhere.jsonl"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("nowhere.jsonl cannot be read"));
    fs::write(folder.path().join("t.jsonl"), format!("{start}\n{step}\n")).expect("a trace");
    let output = oracle(folder.path(), &["chart", "t.jsonl", "-o", "no/such/folder.svg"]);
    assert!(text(&output.stderr).contains("no/such/folder.svg cannot be written"));
    let output = oracle(folder.path(), &["chart", "t.jsonl", "--from", "10"]);
    assert!(text(&output.stderr).contains("case 1 is 10 ms long; the view from 10 to 10 ms shows nothing of it"));
    let output = oracle(folder.path(), &["draw"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn the_examples_are_drawn_and_the_files_are_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in [
        "figure-3",
        "figure-6",
        "figure-7",
        "figure-8",
        "supervision",
        "block-count",
        "telegram-codec",
        "braking-pattern",
        "speed-pattern",
        "train-position",
        "train",
        "wayside",
    ] {
        let trace = examples().join(format!("{name}.jsonl"));
        // The requests alone, and with the replies of a session in which they were sent ahead.
        let requests = fs::read(&trace).expect("an example");
        let replies = device::converse(device::oracle(), requests.clone()).expect("a session");
        let both = format!("{}{}\n", text(&requests), replies.join("\n"));
        fs::write(folder.path().join("both.jsonl"), both).expect("a trace");
        let trace = trace.to_str().expect("a path");
        let output = oracle(folder.path(), &["chart", trace, "-o", "one.svg", "--vcd", "one.vcd"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let output = oracle(folder.path(), &["chart", "both.jsonl", "-o", "two.svg", "--vcd", "two.vcd"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect("a file");
        assert_eq!(read("one.svg"), read("two.svg"));
        assert_eq!(read("one.vcd"), read("two.vcd"));
        let output = oracle(folder.path(), &["chart", trace]);
        assert_eq!(text(&output.stdout), read("one.svg"));
    }
}

#[test]
fn the_schema_that_is_committed_is_the_schema_of_the_types() {
    let committed = concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracle/protocol-1.schema.json");
    let committed = fs::read_to_string(committed).expect("the schema");
    let folder = tempfile::tempdir().expect("a folder");
    let current = text(&oracle(folder.path(), &["schema"]).stdout);
    assert!(committed == current, "renew it: cargo run -p atc-oracle -- schema > oracle/protocol-1.schema.json");
}

/// Whoever asks how to serve sees a session, and its lines are right.
#[test]
fn the_help_of_serve_shows_lines_that_are_right() {
    let folder = tempfile::tempdir().expect("a folder");
    let help = text(&oracle(folder.path(), &["serve", "--help"]).stdout);
    let lines: Vec<_> = help.lines().map(str::trim).filter(|line| line.starts_with("{\"")).collect();
    assert_eq!(lines.len(), 3, "{help}");
    let replies = device::converse(device::oracle(), lines.join("\n").into_bytes()).expect("a session");
    let kinds: Vec<_> = replies.iter().map(|reply| &reply[..10]).collect();
    assert_eq!(kinds, ["{\"started\"", "{\"output\":", "{\"stopped\""]);
}

/// A record that differs is drawn, with every field that differs in the note, and the exit code says so.
#[test]
fn a_record_that_differs_is_drawn_and_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let start = r#"{"start":{"protocol":1,"machine":"block-count","config":{"sections":2,"max_trains":2,"tail_hold_sections":0}}}"#;
    let step = r#"{"step":{"check_in":false,"check_out":false,"present":[],"reset":0}}"#;
    let reply = |occupied: &str, count: u8| {
        format!(
            r#"{{"output":{{"occupied":{occupied},"behind_hold_sections":0,"agree":true,"count":{count},"fault":null}}}}"#
        )
    };
    for (said, code) in [(reply("[]", 0), 0), (reply("[1]", 1), 1)] {
        fs::write(folder.path().join("t.jsonl"), format!("{start}\n{step}\n{said}\n{step}\n{said}\n"))
            .expect("a trace");
        let drawn = oracle(folder.path(), &["chart", "--as-recorded", "t.jsonl"]);
        assert_eq!(drawn.status.code(), Some(code), "{}", text(&drawn.stderr));
        assert_eq!(text(&drawn.stdout).contains("There it says: occupied [1], count 1."), code == 1);
    }
}

/// A client that waits for each answer before it goes on gets it.
#[test]
fn every_answer_comes_at_once() {
    let mut child = device::serving(device::oracle()).expect("the oracle runs");
    let mut stdin = child.stdin.take().expect("a pipe");
    let mut stdout = BufReader::new(child.stdout.take().expect("a pipe"));
    let (sender, answers) = mpsc::channel();
    let reader = std::thread::spawn(move || {
        let mut line = String::new();
        while stdout.read_line(&mut line).expect("a line") > 0 {
            sender.send(std::mem::take(&mut line)).expect("a receiver");
        }
    });
    let patience = Duration::from_secs(20);
    for request in ["{\"start\":{\"protocol\":1,\"machine\":\"speed-supervision\"}}\n", "{\"stop\":{}}\n", "hello\n"] {
        // In two pieces: the answer comes with the newline, not before.
        let (one, other) = request.split_at(4);
        stdin.write_all(one.as_bytes()).expect("a pipe");
        assert!(answers.recv_timeout(Duration::from_millis(50)).is_err(), "an answer to half a line");
        stdin.write_all(other.as_bytes()).expect("a pipe");
        assert!(answers.recv_timeout(patience).expect("an answer").starts_with("{\""));
    }
    drop(stdin);
    assert_eq!(child.wait().expect("an end").code(), Some(0));
    reader.join().expect("the reader ends");
}

/// A client that goes away: no message, no error.
#[test]
fn a_closed_output_ends_the_process_quietly() {
    let mut child = Command::new(device::oracle())
        .arg("serve")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the oracle runs");
    let mut stdin = child.stdin.take().expect("a pipe");
    drop(child.stdout.take());
    // The process is gone after the first replies: then this end of the pipe is closed as well.
    for _ in 0..100_000 {
        if stdin.write_all(b"{\"stop\":{}}\n").is_err() {
            break;
        }
    }
    drop(stdin);
    let mut said = String::new();
    child.stderr.take().expect("a pipe").read_to_string(&mut said).expect("text");
    assert_eq!((child.wait().expect("an end").code(), said.as_str()), (Some(0), ""));
}
