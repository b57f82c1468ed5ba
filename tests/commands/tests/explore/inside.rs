//! The kernel in the page: its words there and back; and in a browser, that it says what the film says, and what the
//! kernel outside says to a reader's own inputs.

use std::path::{Path, PathBuf};
use std::process::Command;

use atc_film_kernel::{Device, OUTPUT, input_of, input_words, place, plan_of, plan_words};
use atc_kernel::interlocking::{CircuitSet, RouteSet};
use atc_oracle::film::{self, Setting};
use atc_oracle::trace::Trace;
use atc_protocol::machine::Machine as _;
use atc_protocol::machine::interlocking::{Config, Interlocked, Step};
use atc_tests::browser::{Browser, chromium};
use serde_json::{Value, json};

use super::{answered, file, random_session, text};

fn machine(session: &str) -> Interlocked {
    let start: Value = serde_json::from_str(session.lines().next().expect("a start")).expect("JSON");
    let config: Config = serde_json::from_value(start["start"]["config"].clone()).expect("a layout");
    Interlocked::open(&config).expect("a machine")
}

#[test]
fn plans_go_there_and_back() {
    for name in ["junction", "passing-loop", "station-30", "terminus"] {
        let layout = atc_layout::read(file(&format!("layouts/{name}.toml"))).expect("a layout");
        let plan = *layout.compile().expect("a plan").layout().plan();
        assert_eq!(plan_of(&plan_words(&plan)), plan, "{name}");
        // The page's buffer has room for 8,192 words.
        assert!(plan_words(&plan).len() <= 8192);
    }
    // The greatest plan: every route there.
    let mut plan = *machine(&random_session(1, 1)).layout().plan();
    let route = plan.routes[0];
    plan.routes.fill(route);
    assert!(plan_words(&plan).len() <= 8192);
    assert_eq!(plan_of(&plan_words(&plan)), plan);
}

/// The device behind words is the kernel behind the protocol.
#[test]
fn the_device_behind_words_answers_as_the_kernel() {
    for seed in 1..12 {
        let session = random_session(seed, 200);
        let mut kernel = machine(&session);
        let mut device = Device::new(&plan_words(kernel.layout().plan())).expect("a device");
        let names = kernel.names().clone();
        for body in answered(&session).0 {
            let step: Step = serde_json::from_value(body).expect("a step");
            let input = kernel.input(&step).expect("an input");
            let words = input_words(&input);
            assert_eq!(input_of(&words), input);
            let output = kernel.step(&step).expect("an output");
            let said = device.step(&words);
            assert_eq!(said.len(), OUTPUT);
            for (number, name) in names.routes.iter().enumerate() {
                let proceed = RouteSet::from_bits(said[place::PROCEED]).meets(RouteSet::nth(number));
                assert_eq!(proceed, output.proceed.contains(name));
                assert_eq!(said[place::PHASES + number] != 0, output.routes.contains_key(name));
            }
            for (number, name) in names.circuits.iter().enumerate() {
                let confirmed = CircuitSet::from_bits(said[place::CONFIRMED]).meets(CircuitSet::nth(number));
                assert_eq!(confirmed, output.confirmed.contains(name));
                let told = said[place::TELEGRAMS + number];
                let stop = names.circuits.get(usize::try_from(told >> 8 & 0xff).expect("a byte"));
                let telegram = output.telegrams.get(name).filter(|telegram| telegram.open);
                assert_eq!(told & 1 == 1, telegram.is_some());
                assert!(telegram.is_none_or(|telegram| Some(&telegram.stop) == stop));
            }
            assert_eq!(said[place::ANSWER] == 0, output.answer.is_none());
        }
    }
}

/// The module, compiled here; none where no Rust has the target.
fn module(folder: &Path) -> Option<PathBuf> {
    let path = folder.join("kernel.wasm");
    let made = Command::new(file("ci/page-kernel")).arg(&path).output().expect("a shell");
    if !made.status.success() {
        let why = String::from_utf8_lossy(&made.stderr).into_owned();
        assert!(why.contains("no Rust with wasm32-unknown-unknown here"), "{why}");
        eprintln!("NOT RUN: {why}");
        return None;
    }
    Some(path)
}

/// A browser at the page of a session with the kernel in it.
fn opened(session: &str) -> Option<(Browser, tempfile::TempDir)> {
    let folder = tempfile::tempdir().expect("a folder");
    let module = module(folder.path())?;
    let Some(chromium) = chromium() else {
        eprintln!("NOT RUN: no chromium here: nothing is known of how the kernel in the page behaves");
        return None;
    };
    let trace = Trace::parse(session).expect("a session");
    let setting = Setting { kernel: Some(std::fs::read(module).expect("a module")), ..Setting::default() };
    let page = folder.path().join("film.html");
    std::fs::write(&page, film::film(&trace.cases[0], &setting).expect("a film").page()).expect("a page");
    let mut browser = Browser::open(&chromium, &page, (1280, 900));
    browser.wait("typeof Live === 'object'");
    Some((browser, folder))
}

#[test]
fn the_kernel_in_the_page_says_what_the_film_says() {
    for session in [text("oracle/examples/interlocking.jsonl"), random_session(2, 300)] {
        let Some((mut browser, _folder)) = opened(&session) else { return };
        assert_eq!(browser.value("Live.replay()"), Value::Null);
        // A film that says something else is found out.
        browser.value("Player.reel.channels.get(Logic.key('circuit', 'W1', 'counted')).is.fill(0)");
        let told = browser.value("Live.replay()");
        assert!(
            told.as_str().is_some_and(|told| told.contains("circuit W1 counted is nothing in the film, occupied here")),
            "{told}"
        );
    }
}

#[test]
fn a_reader_changes_inputs_and_goes_on() {
    let session = text("oracle/examples/interlocking.jsonl");
    let Some((mut browser, _folder)) = opened(&session) else { return };
    browser.value("Player.go(20)");
    browser.settle();
    browser.click("#live-enter");
    let says = browser.value("document.getElementById('live-says').textContent");
    assert_eq!(says, json!("The kernel has run steps 0 to 20 again and says what the film says."));
    // A train runs on by clicks: W1 by its button, P1T on the plan; then the one circuit that nobody may be in.
    let start = session.lines().next().expect("a start").to_owned();
    let mut lines: Vec<String> = vec![start];
    lines.extend(answered(&session).0[..=20].iter().map(|step| json!({"step": step}).to_string()));
    let mut occupied = vec!["W2"];
    for (circuit, request) in [("W1", ""), ("P1T", "withdraw W-1"), ("E1", "set E-2"), ("1T", "")] {
        if circuit == "P1T" {
            browser.value("document.querySelector(\"polyline[data-circuit='P1T']\").dispatchEvent(new MouseEvent('click', {bubbles: true}))");
            browser.settle();
        } else {
            browser.click(&format!("[data-toggle='{circuit}']"));
        }
        let pressed = format!("document.querySelector(\"[data-toggle='{circuit}']\").getAttribute('aria-pressed')");
        assert_eq!(browser.value(&pressed), json!("true"));
        let ask = format!(
            "(() => {{ const it = document.getElementById('live-request'); it.value = [...it.options].find((one) => one.textContent === {:?}).value; it.dispatchEvent(new Event('change')); }})()",
            if request.is_empty() { "no request" } else { request }
        );
        browser.value(&ask);
        browser.click("#live-step");
        occupied.push(circuit);
        let asked = request.split_once(' ').map_or(Value::Null, |(what, route)| json!({ (what): route }));
        let step = json!({"occupied": occupied, "detected": {"P1": "normal", "P2": "normal"}, "request": asked});
        lines.push(json!({"step": step}).to_string());
    }
    let outputs = answered(&(lines.join("\n") + "\n")).1;
    for (frame, output) in (21..25).zip(&outputs[21..]) {
        let word = |kind: &str, name: &str, what: &str| {
            format!("Logic.word(Player.reel, '{kind}', '{name}', '{what}', {frame})")
        };
        for route in ["W-1", "W-2", "E-1", "E-2", "1-E", "2-E", "1-W", "2-W"] {
            let phase = output["routes"][route].as_str().unwrap_or_default();
            assert_eq!(browser.value(&word("route", route, "phase")), json!(phase), "frame {frame}: {output}");
        }
        let answer = match &output["answer"] {
            Value::Null => String::new(),
            Value::String(accepted) => accepted.clone(),
            refused => format!("refused: {}", refused["refused"].as_str().expect("a reason")),
        };
        assert_eq!(browser.value(&word("request", "request", "answer")), json!(answer), "frame {frame}");
    }
    assert_eq!(browser.value("Player.frame()"), json!(24));
    // Ten more, and back to the film where it was left.
    browser.click("#live-ten");
    assert_eq!(browser.value("Player.frame()"), json!(34));
    assert_eq!(browser.value("document.getElementById('now').textContent"), json!("step 34 of 34 · 34 s · live"));
    browser.click("#live-leave");
    assert_eq!(
        browser.value("[Player.frame(), document.getElementById('now').textContent]"),
        json!([20, "step 20 of 131 · 20 s"])
    );
}
