//! Films: that each frame says what the machine answered in it; that the command makes whole pages or a clear error;
//! and that the page plays, in a browser where there is one.

mod command;
mod data;
mod hunted;
mod inside;
mod logic;
mod page;
mod simulated;
mod traces;

use std::path::{Path, PathBuf};

use atc_film::Film;
use atc_oracle::film::{self, Setting};
use atc_oracle::trace::Trace;
use serde_json::{Value, json};

/// A file of the checkout.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)
}

/// Its text.
fn text(name: &str) -> String {
    std::fs::read_to_string(file(name)).expect(name)
}

/// The film of the first case of a session.
fn filmed(session: &str) -> Film {
    let trace = Trace::parse(session).expect("a session");
    film::film(&trace.cases[0], &Setting::default()).expect("a film")
}

/// The bodies of the steps of the first case, and the kernel's outputs.
fn answered(session: &str) -> (Vec<Value>, Vec<Value>) {
    let lines: Vec<Value> = session.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let replies: Vec<Value> = atc_tests::session::replies(session.as_bytes())
        .iter()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    let first = lines.iter().skip(1).take_while(|line| line.get("start").is_none()).count() + 1;
    let steps = lines[..first].iter().filter_map(|line| line.get("step").cloned()).collect();
    let outputs = replies[..first].iter().filter_map(|line| line.get("output").cloned()).collect();
    (steps, outputs)
}

/// Numbers that look random and are the same every time.
struct Dice(u64);

impl Dice {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).expect("31 bits") % most
    }
}

/// A session on the passing loop in which circuits, points, requests, orders and consent change as the dice fall.
fn random_session(seed: u64, steps: usize) -> String {
    const CIRCUITS: [&str; 8] = ["W2", "W1", "P1T", "1T", "2T", "P2T", "E1", "E2"];
    const ROUTES: [&str; 8] = ["W-1", "W-2", "E-1", "E-2", "1-E", "2-E", "1-W", "2-W"];
    let mut dice = Dice(seed);
    let mut text = text("oracle/examples/interlocking.jsonl").lines().next().expect("a start").to_owned() + "\n";
    let mut occupied = [false; 8];
    let mut points = [json!("normal"), json!("normal")];
    for step in 0..steps {
        // More clear than occupied, and more normal than reverse: or no route is ever set.
        let at = dice.below(8);
        occupied[at] = !occupied[at] && dice.below(5) == 0;
        if dice.below(6) == 0 {
            points[dice.below(2)] =
                [json!("normal"), json!("reverse"), Value::Null, json!("normal")][dice.below(4)].clone();
        }
        let list: Vec<&str> = (0..8).filter(|at| occupied[*at]).map(|at| CIRCUITS[at]).collect();
        let mut body = json!({"occupied": list, "detected": {"P1": points[0], "P2": points[1]}});
        body["request"] = match dice.below(8) {
            0..=2 => json!({"set": ROUTES[dice.below(8)]}),
            3 => json!({"withdraw": ROUTES[dice.below(8)]}),
            4 => json!({"drive": (["P1", "P2"][dice.below(2)]), "to": (["normal", "reverse"][dice.below(2)])}),
            5 => json!({"turn": (["West", "East"][dice.below(2)]), "to": (["toward", "away"][dice.below(2)])}),
            _ => Value::Null,
        };
        if step == 0 {
            body["orders"] = json!({"unblock": CIRCUITS, "lift": CIRCUITS});
            occupied = [false; 8];
        } else if dice.below(30) == 0 {
            body["orders"] = json!({(["block", "unblock"][dice.below(2)]): [CIRCUITS[dice.below(8)]]});
        }
        if dice.below(2) == 0 {
            body["consent"] = json!(["East"]);
        }
        text += &json!({"step": body}).to_string();
        text.push('\n');
    }
    text
}
