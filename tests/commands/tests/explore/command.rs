//! `oracle explore` on the command line.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use atc_tests::device;
use serde_json::{Value, json};
use snapbox::{IntoData as _, assert_data_eq, str};

use super::file;

fn explore(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(device::oracle());
    command.arg("explore").args(arguments).current_dir(folder).stdin(Stdio::null());
    command.output().expect("the oracle runs")
}

fn said(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

fn example(name: &str) -> String {
    file(name).display().to_string()
}

#[test]
fn a_session_becomes_a_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let session = example("oracle/examples/interlocking.jsonl");
    let output = explore(folder.path(), &[&session, "-o", "film.html", "--title", "A & B"]);
    assert!(output.status.success(), "{}", said(&output.stderr));
    assert_eq!((said(&output.stdout), said(&output.stderr)), (String::new(), String::new()));
    let page = fs::read_to_string(folder.path().join("film.html")).expect("a page");
    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
    assert!(page.contains("<title>A &amp; B</title>"));
    // The same on standard output.
    let output = explore(folder.path(), &[&session, "--title", "A & B"]);
    assert_eq!(said(&output.stdout), page);
}

#[test]
fn a_case_of_several_is_chosen() {
    let folder = tempfile::tempdir().expect("a folder");
    let session = example("oracle/examples/figure-7.jsonl");
    let output = explore(folder.path(), &[&session, "-o", "film.html"]);
    assert_eq!(said(&output.stderr), "case 1 of 2; --case NUMBER shows another\n");
    let output = explore(folder.path(), &[&session, "--case", "3", "-o", "other.html"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output.stderr).ends_with("figure-7.jsonl: --case 3: the session has 2 cases, from 1\n"));
    assert!(!folder.path().join("other.html").exists());
}

#[test]
fn what_is_wrong_is_said_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    put("empty.jsonl", "");
    put("words.jsonl", "what?\n");
    put("nothing.json", "[]");
    put("other.json", r#"[{"name":"x"}]"#);
    put("wrong.toml", "name = 3\n");
    put(
        "refused.jsonl",
        "{\"start\":{\"protocol\":1,\"machine\":\"block-count\",\"config\":{\"sections\":0,\"max_trains\":1,\"tail_hold_sections\":0}}}\n{\"step\":{}}\n",
    );
    let session = example("oracle/examples/interlocking.jsonl");
    let supervised = example("oracle/examples/supervision.jsonl");
    put("empty.wasm", "\0asm");
    let terminus = example("layouts/terminus.toml");
    let line = example("simulation/examples/three-stations.toml");
    let cases: &[(&[&str], &str)] = &[
        (&["absent.jsonl"], "absent.jsonl cannot be read"),
        (&["empty.jsonl"], "the trace has no {\"start\":{…}}"),
        (&["words.jsonl"], "line 1: neither a request nor a reply of protocol 1"),
        (&["nothing.json"], "there is no trace in it"),
        (&["other.json"], "neither a session nor traces as `models check --json` writes them"),
        (&["wrong.toml"], "wrong.toml"),
        (&["refused.jsonl"], "line 1: a start to reject: "),
        (&[&session, "--layout", &terminus], "is not that of the session: it has no circuit W2"),
        (&[&session, "--layout", "absent.toml"], "absent.toml"),
        (&[&session, "--trains", "3"], "--trains is for a line that is simulated (.toml)"),
        (&[&session, "--each", "3"], "--each is for a line that is simulated (.toml)"),
        (&[&session, "--trace", "x"], "a session has no traces with names"),
        (
            &[&session, "--kernel", "words.jsonl"],
            "--kernel words.jsonl: this is no WebAssembly module; ci/page-kernel makes one",
        ),
        (&[&session, "--kernel", "absent.wasm"], "--kernel absent.wasm: it cannot be read"),
        (
            &[&supervised, "--kernel", "empty.wasm"],
            "the kernel can be put into films of an interlocking; this session is of speed-supervision",
        ),
        (&[&line, "--trace", "x"], "--trace is for a session"),
        (&[&line, "--trains", "99"], "99 trains: 1 to 5 are possible"),
        (&[&line, "--each", "3"], "--each 3: name the kinds of faults with --faults"),
    ];
    for (arguments, expected) in cases {
        let output = explore(folder.path(), &[*arguments, &["-o", "film.html"]].concat());
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(said(&output.stderr).contains(expected), "{arguments:?}: {}", said(&output.stderr));
        assert!(output.stdout.is_empty() && !folder.path().join("film.html").exists(), "{arguments:?}");
    }
}

/// A wrong implementation's session: shown as it was recorded, with what the kernel says beside it, and exit code 1.
#[test]
fn a_record_that_differs_is_an_error_or_is_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    let session = super::text("oracle/examples/interlocking.jsonl");
    let (steps, mut outputs) = super::answered(&session);
    // A signal that stays at proceed under the train.
    let first = outputs.iter().position(|output| output["proceed"] == json!(["W-1"])).expect("proceed");
    for output in &mut outputs[first..first + 40] {
        output["proceed"] = json!(["W-1"]);
    }
    let start = session.lines().next().expect("a start").to_owned();
    let pairs =
        steps.iter().zip(&outputs).flat_map(|(step, output)| [json!({"step": step}), json!({"output": output})]);
    let lines: Vec<String> = std::iter::once(start).chain(pairs.map(|line| line.to_string())).collect();
    fs::write(folder.path().join("wrong.jsonl"), lines.join("\n")).expect("a file");
    let output = explore(folder.path(), &["wrong.jsonl", "-o", "film.html"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output.stderr).contains("draw the record with --as-recorded"), "{}", said(&output.stderr));
    assert!(!folder.path().join("film.html").exists());
    let output = explore(folder.path(), &["wrong.jsonl", "-o", "film.html", "--as-recorded"]);
    assert_eq!(output.status.code(), Some(1));
    let page = fs::read_to_string(folder.path().join("film.html")).expect("a page");
    assert!(page.contains("THE RECORD DIFFERS FROM THE KERNEL"));
    assert!(page.contains("the record differs; the kernel says proceed: "));
    // One that does not differ is no difference.
    let right = example("oracle/examples/interlocking.jsonl");
    assert!(explore(folder.path(), &[&right, "-o", "film.html", "--as-recorded"]).status.success());
}

#[test]
fn harm_is_exit_code_1_and_a_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = example("simulation/examples/four-tracks.toml");
    let faults = ["--faults", "misread-code,misread-code,misread-code", "--time", "500", "--beyond", "-o", "film.html"];
    let output = explore(folder.path(), &[&[line.as_str()][..], &faults].concat());
    assert_eq!(output.status.code(), Some(1));
    let event: Value =
        serde_json::from_str(said(&output.stderr).trim().trim_start_matches("UNSAFE: ")).expect("an event");
    assert_eq!(event["event"], "overspeed");
    let page = fs::read_to_string(folder.path().join("film.html")).expect("a page");
    assert!(page.contains("IS TOO FAST in"));
}

#[test]
fn the_help_says_what_can_be_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    assert_data_eq!(said(&explore(folder.path(), &["--help"]).stdout), str![[r#"
Makes a page that plays a session, a trace of a model or a simulated line: track plan, trains, signals, rows over time

Usage: oracle explore [OPTIONS] <FILE>

Arguments:
  <FILE>
          A session (JSON lines), a trace of a model (JSON) or a line (.toml); "-" for a session from standard input

Options:
  -o, --output <FILE.html>
          Where the page goes [default: standard output]

      --title <TITLE>
          The page's title [default: what it is of]

      --layout <LAYOUT>
          The layout whose drawing is the track plan, for a session that has a plan in the kernel's own terms

      --case <NUMBER>
          Which case of a session with several, from 1
          
          [default: 1]

      --trace <MODEL/PROPERTY>
          Which trace of a file with several: the model and the property, or the property alone

      --as-recorded
          Shows replies that differ from the kernel's as they were recorded; else the first one is an error

      --kernel <FILE.wasm>
          The kernel as a WebAssembly module, made by ci/page-kernel: a reader can change the inputs of an interlocking and go on

  -h, --help
          Print help (see a summary with '-h')

A simulated line:
      --seed <SEED>
          What chance depends on; a run is the same every time for one seed
          
          [default: 1]

      --time <TIME>
          How long a run is, in seconds of the line [default: 1800; in a campaign 600; with --rare 180]

      --trains <TRAINS>
          How many trains there are [default: as the file says]

      --faults <FAULT,…>
          What fails, each once at a random time; in a campaign each run has one of them [default there: everything]

      --beyond
          Faults last far longer than the conditions allow

      --device <DEVICE>
          The trains' device

          Possible values:
          - shortened:    With the shortened operate time
          - conventional: Without it
          
          [default: shortened]

      --signal <SIGNAL>
          What trains run on

          Possible values:
          - codes:     Codes alone
          - telegrams: Telegrams alone: the ground's transmitters send frames for both directions of travel in turn
          - both:      Telegrams with codes beside them
          
          [default: codes]

      --drivers <DRIVERS>
          What drivers do with the cab signal

          Possible values:
          - careful:  They obey it
          - heedless: They motor whatever it says, and stop at stations alone: the device on board holds the train
          
          [default: careful]

      --defects <PART,…>
          Parts that are wrong all the time

      --each <FAULTS>
          Draws so many of each kind of --faults, as the run of a campaign with this seed has them

What can be shown:
  session.jsonl   what `oracle serve` read, with its replies if these were kept
  models.json     what `models check --json models.json` found; --trace names one of its traces
  line.toml       a line, which is simulated: what is below "A simulated line" is for it

The page is one file. It opens in a browser from where it lies: no network, no server.
Keys in it: space plays and pauses, left and right step, up and down go to events, Home and End.

Exit code: 0; 1 if a record differs from the kernel (--as-recorded) or a simulation ends in harm, the page is written then;
or if nothing could be made, with the reason.

"#]].raw());
}
