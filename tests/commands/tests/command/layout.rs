//! `oracle layout` on the command line: the real process, its exit codes, messages and files.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use atc_tests::device;
use tempfile::TempDir;

const LAYOUTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts");

/// What every output file holds before a command that must leave it alone.
const BEFORE: &str = "what was here before\n";

fn layout(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(device::oracle());
    command.arg("layout").args(arguments).current_dir(folder).stdin(Stdio::null());
    command.output().expect("the oracle runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

fn sample(name: &str) -> String {
    fs::read_to_string(Path::new(LAYOUTS).join(name)).expect(name)
}

/// A folder with the samples.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for entry in fs::read_dir(LAYOUTS).expect(LAYOUTS) {
        let entry = entry.expect("an entry");
        fs::copy(entry.path(), folder.path().join(entry.file_name())).expect("a copy");
    }
    folder
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// What it says on standard output; it must succeed.
#[track_caller]
fn said(folder: &Path, arguments: &[&str]) -> (String, String) {
    let output = layout(folder, arguments);
    let (said, remarks) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {remarks}");
    (said, remarks)
}

/// The passing loop with one change, and where in the text the change is: line and column, both from 1.
fn changed(from: &str, to: &str) -> (String, String) {
    let loop_text = sample("passing-loop.toml");
    let at = loop_text.find(from).unwrap_or_else(|| panic!("{from} is not in the sample"));
    let line = loop_text[..at].matches('\n').count() + 1;
    (loop_text.replacen(from, to, 1), format!("{line}:"))
}

/// A layout that breaks a rule, or a file that is none, in every command that writes: exit code 1, every line with file and place,
/// nothing on standard output, and the file that was there before is as it was.
#[test]
fn what_is_wrong_is_named_with_its_place_and_nothing_is_written() {
    let (no_circuit, circuit_at) = changed("path = [\"P1T\", \"1T\"]", "path = [\"P1T\", \"9T\"]");
    let (no_number, number_at) = changed("length_m = 60", "length_m = \"far\"");
    let (no_field, field_at) = changed("toe = \"c\"", "tow = \"c\"");
    let railml = sample("passing-loop.railml.xml");
    let cut = &railml[..railml.len() / 2];
    let cases: [(&str, &[u8], String, &str); 9] = [
        ("l.toml", no_circuit.as_bytes(), format!("l.toml:{circuit_at}16: "), "there is no circuit 9T; is 1T meant?"),
        (
            "l.toml",
            no_number.as_bytes(),
            format!("l.toml:{number_at}12: "),
            "expected u16 (a whole number, 0 to 65535)",
        ),
        ("l.toml", no_field.as_bytes(), format!("l.toml:{field_at}1: "), "unknown field `tow`"),
        ("l.toml", b"name = [", "l.toml:1:".to_owned(), "[form]"),
        ("l.toml", b"name = \"\xff\"", "l.toml: ".to_owned(), "line 1, byte 8 is not UTF-8; save the file as UTF-8"),
        ("l.xml", cut.as_bytes(), "l.xml:".to_owned(), "this is no XML"),
        ("l.railml", b"<html/>", "l.railml:1:1: ".to_owned(), "[form]"),
        ("l.json", b"{}", "l.json:1:2: ".to_owned(), "an OSRD infrastructure in JSON is expected"),
        ("l.txt", b"", "l.txt: ".to_owned(), "it must end in .toml, .xml, .railml, .ppxml or .json"),
    ];
    for (file, bytes, place, message) in &cases {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join(file), bytes).expect("a layout");
        for output in ["o.toml", "o.html", "o.svg"] {
            fs::write(folder.path().join(output), BEFORE).expect("a file");
        }
        let before = names(folder.path());
        let mut commands: Vec<Vec<&str>> =
            vec![vec!["check", file], vec!["table", file, "-o", "o.html"], vec!["draw", file, "-o", "o.svg"]];
        // A layout that breaks a rule can be written down all the same.
        if !message.starts_with("there is no circuit") {
            commands.push(vec!["import", file, "-o", "o.toml"]);
        }
        for command in commands {
            let output = layout(folder.path(), &command);
            let errors = text(&output.stderr);
            assert_eq!(output.status.code(), Some(1), "{command:?}: {errors}");
            assert!(output.stdout.is_empty(), "{command:?}");
            assert!(errors.starts_with(place) && errors.contains(message), "{command:?} was answered by {errors}");
            assert!(errors.lines().all(|line| line.starts_with(file)), "{errors}");
            assert_eq!(names(folder.path()), before, "{command:?}");
        }
        for output in ["o.toml", "o.html", "o.svg"] {
            assert_eq!(fs::read_to_string(folder.path().join(output)).expect("a file"), BEFORE, "{file}");
        }
    }
}

/// Every broken rule is told, in the order of the file.
#[test]
fn all_that_is_broken_is_told_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let loop_text = sample("passing-loop.toml");
    let wrong = loop_text.replace("entry = \"W1\"", "entry = \"X1\"").replace("circuit = \"P2T\"", "circuit = \"Y2\"");
    fs::write(folder.path().join("l.toml"), wrong).expect("a layout");
    let output = layout(folder.path(), &["check", "l.toml"]);
    assert_eq!(output.status.code(), Some(1));
    let errors = text(&output.stderr);
    let lines: Vec<usize> = errors
        .lines()
        .map(|line| line.split(':').nth(1).and_then(|line| line.parse().ok()).unwrap_or_else(|| panic!("{line}")))
        .collect();
    assert!(lines.len() > 2 && lines.is_sorted(), "{errors}");
    assert!(errors.matches("there is no circuit X1").count() == 2 && errors.contains("there is no circuit Y2"));
}

#[test]
fn the_samples_are_sound() {
    let folder = folder();
    for name in names(folder.path()) {
        let (text, _) = said(folder.path(), &["check", &name]);
        assert!(text.starts_with(&format!("{name}: no broken rule; ")), "{text}");
    }
    let (plain, _) = said(folder.path(), &["check", "passing-loop.toml"]);
    assert_eq!(plain, "passing-loop.toml: no broken rule; 8 routes, 2 points, 8 circuits, 2 segments\n");
    let (derived, _) = said(folder.path(), &["check", "passing-loop.toml", "--derived"]);
    assert!(derived.starts_with(&plain) && derived.lines().count() > plain.lines().count(), "{derived}");
    let (assumed, _) = said(folder.path(), &["check", "passing-loop.railml.xml"]);
    assert!(assumed.contains("values were assumed on import and are to be confirmed:\n  "), "{assumed}");
}

/// What is imported is a layout with nothing wrong, the same on standard output and in a file; the report is on standard error.
#[test]
fn an_import_is_a_layout_and_its_report_stands_apart() {
    let folder = folder();
    let railml = ["passing-loop", "junction", "terminus", "station-30"].map(|name| (name, "railml.xml"));
    for (name, form) in railml.into_iter().chain([("passing-loop", "ppxml")]) {
        let (from, to) = (format!("{name}.{form}"), format!("{name}.{form}.toml"));
        let (printed, report) = said(folder.path(), &["import", &from]);
        for part in ["taken:", "defaulted, to be confirmed:", "lacking:", "not used:", "the layout breaks no rule"] {
            assert!(report.contains(part), "{name}: {report}");
        }
        let (nothing, again) = said(folder.path(), &["import", &from, "--output", &to]);
        assert_eq!((nothing.as_str(), again), ("", report), "{name}");
        assert_eq!(fs::read_to_string(folder.path().join(&to)).expect("a layout"), printed, "{name}");
        let (checked, _) = said(folder.path(), &["check", &to]);
        let (source, _) = said(folder.path(), &["check", &format!("{name}.toml")]);
        let counts = |line: &str| line.lines().next().and_then(|line| line.split_once(": ").map(|it| it.1.to_owned()));
        assert_eq!(counts(&checked), counts(&source), "{name}");
        // The file is read a second time, and held against what was made of it.
        let (same, _) = said(folder.path(), &["compare", &to, &from]);
        assert_eq!(same, "no difference\n", "{from}");
    }
}

/// An import whose layout breaks a rule is done, and says so; the check of what it wrote fails.
#[test]
fn an_import_that_breaks_a_rule_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let (wrong, _) = changed("path = [\"P1T\", \"1T\"]", "path = [\"P1T\", \"9T\"]");
    fs::write(folder.path().join("l.toml"), wrong).expect("a layout");
    let (_, report) = said(folder.path(), &["import", "l.toml", "-o", "o.toml"]);
    assert!(report.contains("the layout breaks 1 rules:\nl.toml:"), "{report}");
    assert_eq!(layout(folder.path(), &["check", "o.toml"]).status.code(), Some(1));
}

#[test]
fn tables_and_drawings_go_to_a_file_or_to_standard_output() {
    let folder = folder();
    for (command, begins) in [
        (&["table", "terminus.toml"][..], "<!doctype html>"),
        (&["table", "terminus.toml", "--form", "csv"], "route,signal,heading,entry,path,"),
        (&["draw", "terminus.toml"], "<svg "),
    ] {
        let (printed, remarks) = said(folder.path(), command);
        assert!(printed.to_lowercase().starts_with(begins), "{}", printed.lines().next().unwrap_or(""));
        assert_eq!(remarks, "");
        fs::write(folder.path().join("out"), BEFORE).expect("a file");
        let (nothing, _) = said(folder.path(), &[command, &["-o", "out"]].concat());
        assert_eq!((nothing.as_str(), fs::read_to_string(folder.path().join("out")).expect("a file")), ("", printed));
    }
    // One row for each route, and only those that are asked for.
    let rows = |more: &[&str]| {
        let (csv, _) = said(folder.path(), &[&["table", "passing-loop.toml", "--form", "csv"], more].concat());
        csv.lines().skip(1).map(|row| row.split(',').next().unwrap_or("").to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(rows(&[]).len(), 8);
    assert_eq!(rows(&["--only", "W-1,1-E"]), ["W-1", "1-E"]);
    let output = layout(folder.path(), &["draw", "passing-loop.toml", "--only", "W-9", "-o", "o.svg"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("there is no route W-9; the first routes are W-1, "));
    assert!(!folder.path().join("o.svg").exists());
}

/// Files that cannot be read or written, and commands that are none.
#[test]
fn files_and_commands_that_are_not_there() {
    let folder = folder();
    let before = names(folder.path());
    for (command, code, message) in [
        (&["check", "nowhere.toml"][..], 1, "nowhere.toml: cannot be read: "),
        (&["draw", "."], 1, "cannot be read"),
        (&["table", "junction.toml", "-o", "no/such/table.html"], 1, "no/such/table.html cannot be written"),
        (&["import", "junction.railml.xml", "-o", "no/such/j.toml"], 1, "no/such/j.toml cannot be written"),
        (&["table", "junction.toml", "--form", "pdf"], 2, "[possible values: html, csv, rendo]"),
        (&["check"], 2, "<FILE>"),
        (&["paint", "junction.toml"], 2, "unrecognized subcommand 'paint'"),
    ] {
        let output = layout(folder.path(), command);
        assert_eq!(output.status.code(), Some(code), "{command:?}");
        assert!(text(&output.stderr).contains(message), "{command:?} was answered by {}", text(&output.stderr));
        assert!(output.stdout.is_empty(), "{command:?}");
        assert_eq!(names(folder.path()), before, "{command:?}");
    }
}

/// The schema that is printed is the one of the repository, and the samples fit it.
#[test]
fn the_schema_is_printed() {
    let folder = folder();
    let (printed, _) = said(folder.path(), &["schema"]);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../layout/layout.schema.json");
    assert_eq!(printed, fs::read_to_string(path).expect(path));
}

#[test]
fn two_descriptions_of_one_station_are_compared_cell_by_cell() {
    let folder = folder();
    let (same, _) = said(folder.path(), &["compare", "passing-loop.toml", "passing-loop.toml"]);
    assert_eq!(same, "no difference\n");
    let (other, _) = changed("name = \"W2\"\nlength_m = 300", "name = \"W2\"\nlength_m = 310");
    fs::write(folder.path().join("other.toml"), other).expect("written");
    let output = layout(folder.path(), &["compare", "passing-loop.toml", "other.toml"]);
    assert_eq!(output.status.code(), Some(1), "they differ");
    assert_eq!(text(&output.stdout), "circuit W2: length m: 300 | 310\n");
    // What no cell of the table shows.
    let (train, _) = changed(
        "longest_train_m = 200\n",
        "longest_train_m = 190\nshortest_train_m = 20\n\n[overlaps]\nleast_m = 40\n\n[braking]\nstrongest_mm_s2 = 800\n",
    );
    fs::write(folder.path().join("other.toml"), train).expect("written");
    let output = layout(folder.path(), &["compare", "passing-loop.toml", "other.toml"]);
    let said = text(&output.stdout);
    for differs in ["longest train m: 200 | 190", "shortest train m: nothing | 20", "least overlap m: 50 | 40"] {
        assert!(said.contains(&format!("station: {differs}\n")), "{said}");
    }
    assert!(!said.contains("strongest"), "as strong as all are: {said}");
    let missing = layout(folder.path(), &["compare", "passing-loop.toml", "terminus.toml"]);
    assert_eq!(missing.status.code(), Some(1));
    assert!(
        text(&missing.stdout).contains("route W-1: the whole of it: there | not there\n"),
        "{}",
        text(&missing.stdout)
    );
}

#[test]
fn a_layout_comes_from_standard_input_in_any_form() {
    let folder = folder();
    for name in ["passing-loop.toml", "passing-loop.railml.xml", "passing-loop.ppxml"] {
        let file = fs::File::open(folder.path().join(name)).expect(name);
        let mut command = Command::new(device::oracle());
        let output = command.args(["layout", "check", "-"]).stdin(file).output().expect("the oracle runs");
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        assert!(text(&output.stdout).starts_with("-: no broken rule"), "{}", text(&output.stdout));
    }
}

#[test]
fn a_check_is_told_as_json() {
    let folder = folder();
    let (whole, _) = said(folder.path(), &["check", "--json", "passing-loop.railml.xml"]);
    let whole: serde_json::Value = serde_json::from_str(&whole).expect("JSON");
    assert_eq!((&whole["problems"], &whole["routes"]), (&serde_json::json!([]), &serde_json::json!(8)));
    assert!(!whole["defaulted"].as_array().expect("a list").is_empty());
    let (other, place) = changed("name = \"W2\"\nlength_m = 300", "name = \"W2\"\nlength_m = 0");
    fs::write(folder.path().join("other.toml"), other).expect("written");
    let output = layout(folder.path(), &["check", "--json", "other.toml"]);
    assert_eq!(output.status.code(), Some(1));
    let broken: serde_json::Value = serde_json::from_str(&text(&output.stdout)).expect("JSON");
    assert_eq!(broken["problems"][0]["rule"], "range", "{place}");
}

#[test]
fn nothing_imported_is_a_failure_and_says_why() {
    let folder = folder();
    let none = sample("passing-loop.railml.xml")
        .replace("<routeEntry", "<routeStart")
        .replace("</routeEntry>", "</routeStart>");
    fs::write(folder.path().join("none.railml"), none).expect("written");
    let output = layout(folder.path(), &["import", "none.railml", "-o", "new.toml"]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("no route was imported") && said.contains("it has no routeEntry; it is left out"), "{said}");
    assert!(!folder.path().join("new.toml").exists());
    let output = layout(folder.path(), &["check", "none.railml"]);
    assert!(text(&output.stderr).contains("the layout has no route: nothing can be set"));
}

/// A pipe, a link and a read-only file are not what a new file may take the place of.
#[cfg(unix)]
#[test]
fn what_is_no_plain_file_is_written_to_and_not_replaced() {
    use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _, symlink};
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    assert_eq!(layout(folder.path(), &["draw", "passing-loop.toml", "-o", "/dev/null"]).status.code(), Some(0));
    assert!(fs::metadata("/dev/null").expect("there").file_type().is_char_device(), "it is the device that it was");
    let full = layout(folder.path(), &["draw", "passing-loop.toml", "-o", "/dev/full"]);
    assert_eq!(full.status.code(), Some(1));
    assert!(text(&full.stderr).starts_with("oracle: /dev/full cannot be written"), "{}", text(&full.stderr));

    fs::write(at("real.svg"), BEFORE).expect("written");
    symlink("real.svg", at("link.svg")).expect("a link");
    said(folder.path(), &["draw", "passing-loop.toml", "-o", "link.svg"]);
    assert!(at("link.svg").is_symlink() && fs::read_to_string(at("real.svg")).expect("read").starts_with("<svg"));

    fs::write(at("fixed.svg"), BEFORE).expect("written");
    fs::set_permissions(at("fixed.svg"), fs::Permissions::from_mode(0o444)).expect("set");
    let fixed = layout(folder.path(), &["draw", "passing-loop.toml", "-o", "fixed.svg"]);
    assert_eq!(fixed.status.code(), Some(1), "it is read-only");
    assert_eq!(fs::read_to_string(at("fixed.svg")).expect("read"), BEFORE);
}

/// Where nobody reads what is remarked, that is no panic.
#[cfg(unix)]
#[test]
fn a_full_standard_error_is_no_panic() {
    let folder = folder();
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").expect("the device");
    for (arguments, code) in
        [(["layout", "import", "passing-loop.railml.xml"], 0), (["layout", "check", "nothing.toml"], 1)]
    {
        let mut command = Command::new(device::oracle());
        command.args(arguments).current_dir(folder.path()).stdin(Stdio::null()).stdout(Stdio::null()).stderr(full());
        assert_eq!(command.status().expect("the oracle runs").code(), Some(code), "{arguments:?}");
    }
}
