//! Stations for the hunt: those of `layouts/`, and random ones.

use std::fmt::Write as _;
use std::path::Path;

use atc_layout::Description;

use super::dice::Dice;

/// The small stations of `layouts/`, by name.
pub const NAMES: [&str; 4] = ["passing-loop", "junction", "terminus", "station-30"];

/// The large ones, each with the cycles of a hunt in the tests.
pub const LARGE: [(&str, u64); 2] = [("station-100", 60_000), ("central", 60_000)];

/// A station of `layouts/`.
///
/// # Panics
/// If there is none of this name.
pub fn of(name: &str) -> Description {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../layouts").join(format!("{name}.toml"));
    atc_layout::read(path).expect("the layouts of the project are sound")
}

/// The same as it comes of its railML file: with the defaults of the import, such as the speed of the line.
///
/// # Panics
/// If there is none of this name.
pub fn imported(name: &str) -> Description {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../layouts").join(format!("{name}.railml.xml"));
    atc_layout::import::read_any(path).expect("the layouts of the project are sound").description
}

/// A random station: a single line with 2 to 4 tracks between two ladders of points, of random lengths and speeds.
///
/// # Panics
/// Never: every such station keeps the rules of layouts.
pub fn random(number: u64) -> Description {
    let mut dice = Dice::new(number);
    let tracks = 2 + dice.below(3);
    let mut text = format!("name = \"Random station {number}\"\nlongest_train_m = 200\n\n");
    let line = [55, 65, 75][dice.below(3)];
    let reverse = [25, 45][dice.below(2)];
    let _ = writeln!(
        text,
        "[times]\nrelease_ms = {}\nturn_ms = {}",
        dice.within(45_000, 90_000),
        dice.within(34_300, 40_000)
    );
    let _ = writeln!(text, "\n[speed]\nline_kmh = {line}\nreverse_kmh = {reverse}\n");
    for side in ["W", "E"] {
        for (circuit, outer, inner) in [("2", "a", "b"), ("1", "b", "c")] {
            let (left, right) = if side == "W" { (outer, inner) } else { (inner, outer) };
            let length = dice.within(450, 700);
            circuit_of(
                &mut text,
                &format!("{side}{circuit}"),
                length,
                Some([left, right].map(|end| format!("{side}{end}"))),
            );
        }
        for point in 1..tracks {
            circuit_of(&mut text, &format!("{side}P{point}T"), dice.within(40, 80), None);
        }
    }
    for track in 1..=tracks {
        let length = dice.within(330, 500);
        circuit_of(&mut text, &format!("{track}T"), length, Some([format!("W-{track}"), format!("E-{track}")]));
    }
    for side in ["W", "E"] {
        for point in 1..tracks {
            ladder(&mut text, side, point, tracks);
        }
        let _ = writeln!(text, "[[end]]\njoint = \"{side}a\"\nkind = \"line\"\n");
        let _ = writeln!(
            text,
            "[[segment]]\nname = \"{side}\"\ncircuits = [\"{side}1\", \"{side}2\"]\nshared = [\"{side}2\"]\n"
        );
    }
    for (side, other) in [("W", "E"), ("E", "W")] {
        for track in 1..=tracks {
            let points: Vec<String> = (1..=track.min(tracks - 1)).map(|point| format!("\"{side}P{point}T\"")).collect();
            let out: Vec<String> = points.iter().rev().cloned().collect();
            let beyond = track.min(tracks - 1);
            let _ = writeln!(
                text,
                "[[route]]\nname = \"{side}-{track}\"\nsignal = \"{side}\"\nentry = \"{side}1\"\npath = [{}, \"{track}T\"]\n\
                 overlap = [\"{other}P{beyond}T\"]\nshort_overlap = \"trains are braked by ATC\"\n",
                points.join(", ")
            );
            let _ = writeln!(
                text,
                "[[route]]\nname = \"{track}-{side}\"\nsignal = \"{track}{side}\"\nentry = \"{track}T\"\npath = [{}]\n",
                out.join(", ")
            );
        }
    }
    let description = Description::from_toml("random", &text).expect("the text is a layout");
    description.model().expect("the station keeps the rules");
    description
}

fn circuit_of(text: &mut String, name: &str, length: i64, ends: Option<[String; 2]>) {
    let _ = writeln!(text, "[[circuit]]\nname = \"{name}\"\nlength_m = {length}");
    if let Some([left, right]) = ends {
        let _ = writeln!(text, "left = \"{left}\"\nright = \"{right}\"");
    }
    text.push('\n');
}

/// Point `point` of the ladder on one side: its normal leg goes to track `point`, its reverse leg on to the next point or the last track.
fn ladder(text: &mut String, side: &str, point: usize, tracks: usize) {
    let toe = if point == 1 { format!("{side}c") } else { format!("{side}l{point}") };
    let reverse = if point + 1 == tracks { format!("{side}-{tracks}") } else { format!("{side}l{}", point + 1) };
    let reason = "trains beyond it obey their signal and are braked by ATC; no vehicle is parked there";
    let _ = writeln!(
        text,
        "[[point]]\nname = \"{side}P{point}\"\ncircuit = \"{side}P{point}T\"\ntoe = \"{toe}\"\nnormal = \"{side}-{point}\"\n\
         reverse = \"{reverse}\"\nnormal_unprotected = \"{reason}\"\nreverse_unprotected = \"{reason}\"\n"
    );
}
