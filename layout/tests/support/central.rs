//! A junction station as one meets it: a double line and a single one on each side, scissors, double slips, ladders, a bay, and calling-on routes
//! into every track.
//!
//! ```text
//!              ┌─ 9   bay
//!   N ══╲   ╱══╪═ 1 ═╪══╲      one side; the other one is its mirror image
//!        ╳     ├─ 2
//!   D ═╲ ╱ ╲   └─ 3
//!       ╳   ╲ ╱─── 4, 5
//!   U ═╱ ╲═══╳──── 6, 7, 8
//! ```

use atc_layout::At;
use atc_layout::form::{Circuit, Crossing, Element, End, EndKind, Platform, Point, Position, Route, Segment, Station};

use super::{at, circuit, element};

/// The through tracks.
const TRACKS: usize = 8;

/// What stands at a leg where a signal faces the vehicles that could come.
const SIGNALS: &str = "trains that could come obey their signal and are braked by ATC; no vehicle is parked there";

/// What stands at a leg that leads to the scissors.
const THROAT: &str = "no vehicle is left in the throat: a train stops there on its own route only, and goes on over it";

/// What stands at the leg towards the line on which trains only leave.
const OUT: &str = "trains only leave over the line behind it, and no vehicle is left in the throat";

/// Why the legs of a point need no protection: the normal one, and the reverse one.
fn reasons(name: &str) -> [Option<&'static str>; 2] {
    match name {
        "1a" => [None, None],
        "2a" => [Some(SIGNALS), None],
        "1b" | "2b" => [None, Some(THROAT)],
        "3a" => [Some(SIGNALS), Some(THROAT)],
        "4a" => [None, Some(OUT)],
        _ => [Some(SIGNALS), Some(SIGNALS)],
    }
}

/// A side of the station.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    West,
    East,
}

/// A line: the letter of its circuits, its name, and whether trains come in and go out over it.
#[derive(Clone, Copy)]
struct Line {
    letter: char,
    name: &'static str,
    comes: bool,
    goes: bool,
}

impl Side {
    const fn prefix(self) -> char {
        match self {
            Self::West => 'W',
            Self::East => 'E',
        }
    }

    /// The line beside, the one that comes in, the one that goes out.
    const fn lines(self) -> [Line; 3] {
        let [single, comes, goes] = match self {
            Self::West => [('N', "North"), ('D', "West in"), ('U', "West out")],
            Self::East => [('S', "South"), ('V', "East in"), ('A', "East out")],
        };
        [
            Line { letter: single.0, name: single.1, comes: true, goes: true },
            Line { letter: comes.0, name: comes.1, comes: true, goes: false },
            Line { letter: goes.0, name: goes.1, comes: false, goes: true },
        ]
    }

    /// Whether the bay is here.
    const fn has_bay(self) -> bool {
        matches!(self, Self::West)
    }

    /// The tracks of each ladder: beside the single line, in the middle, beside the line out.
    const fn ladders(self) -> [&'static [usize]; 3] {
        match self {
            Self::West => [&[9, 1, 2, 3], &[4, 5], &[6, 7, 8]],
            Self::East => [&[8, 7, 6], &[5, 4], &[3, 2, 1]],
        }
    }

    /// A joint of this side.
    fn joint(self, name: &str) -> String {
        format!("{}-{name}", self.prefix())
    }

    /// A circuit or a point of this side.
    fn own(self, name: &str) -> String {
        format!("{}{name}", self.prefix())
    }

    /// The ends of a plain track: outer and inner joint as left and right.
    fn ends(self, outer: String, inner: String) -> (String, String) {
        if self == Self::West { (outer, inner) } else { (inner, outer) }
    }
}

/// The station.
pub fn central() -> Station {
    let mut made = Station { name: "Central".to_owned(), longest_train_m: Some(at_number(250)), ..Station::default() };
    made.speed.line_kmh = Some(at_number(75));
    made.speed.reverse_kmh = Some(at_number(45));
    made.speed.calling_on_kmh = Some(at_number(15));
    for side in [Side::West, Side::East] {
        for line in side.lines() {
            plain_line(&mut made, side, line);
        }
        throat(&mut made, side);
    }
    for track in 1..=TRACKS {
        platform(&mut made, track);
    }
    bay(&mut made);
    for side in [Side::West, Side::East] {
        routes(&mut made, side);
    }
    made
}

fn at_number(value: u16) -> At<u16> {
    At::derived(value)
}

fn plain_line(made: &mut Station, side: Side, line: Line) {
    let name = |number: usize| format!("{}{number}", line.letter);
    let joint = |number: usize| side.joint(&format!("{}{number}", line.letter));
    for (circuit_number, outer) in [(2, 0), (1, 1)] {
        let ends = side.ends(joint(outer), joint(outer + 1));
        made.circuits.push(circuit(name(circuit_number), 350, Some(ends)));
    }
    made.ends.push(End { joint: at(joint(0)), kind: EndKind::Line });
    let circuits = vec![at(name(1)), at(name(2))];
    made.segments.push(Segment { name: at(line.name), circuits, ..Segment::default() });
}

/// From the lines to the ladders. Outer joints of the lines: `n2`, `d2`, `u2`, whatever their letters.
fn throat(made: &mut Station, side: Side) {
    let [single, comes, goes] = side.lines().map(|line| side.joint(&format!("{}2", line.letter)));
    let joint = |name: &str| side.joint(name);
    // Scissors between the two tracks of the double line.
    let crossing = |left: &str, right: &str| {
        let (left, right) = side.ends(joint(left), joint(right));
        Crossing { left: at(left), right: at(right), ..Crossing::default() }
    };
    made.circuits.push(Circuit {
        crossings: vec![crossing("m1", "x1"), crossing("x2", "m2")],
        ..circuit(side.own("SD"), 80, None)
    });
    made.circuits.push(circuit(side.own("SU"), 80, None));
    point(made, side, ("1a", "SD"), [&comes, &joint("i"), &joint("m1")]);
    point(made, side, ("2a", "SD"), [&joint("d3"), &joint("i"), &joint("m2")]);
    point(made, side, ("2b", "SU"), [&goes, &joint("j"), &joint("x2")]);
    point(made, side, ("1b", "SU"), [&joint("u3"), &joint("j"), &joint("x1")]);
    // Double slips: two points, toe to toe, in one circuit.
    for (name, numbers, outer, inner) in [
        ("DN", ["3a", "3b"], [single, joint("d3")], ["n3", "d4"]),
        ("DU", ["4a", "4b"], [joint("d4"), joint("u3")], ["d5", "u4"]),
    ] {
        made.circuits.push(circuit(side.own(name), 60, None));
        let toe = joint(&name.to_lowercase());
        point(made, side, (numbers[0], name), [&toe, &outer[0], &outer[1]]);
        point(made, side, (numbers[1], name), [&toe, &joint(inner[0]), &joint(inner[1])]);
    }
    for (lead, tracks) in ["n3", "d5", "u4"].into_iter().zip(side.ladders()) {
        let mut toe = joint(lead);
        for (place, track) in tracks.iter().enumerate().take(tracks.len() - 1) {
            let name = format!("L{track}");
            made.circuits.push(circuit(side.own(&name), 60, None));
            let last = place + 2 == tracks.len();
            let next = if last { joint(&format!("t{}", tracks[place + 1])) } else { joint(&format!("l{track}")) };
            point(made, side, (&format!("{}", 10 + track), &name), [&toe, &next, &joint(&format!("t{track}"))]);
            toe = next;
        }
    }
}

fn point(made: &mut Station, side: Side, (name, circuit): (&str, &str), [toe, normal, reverse]: [&String; 3]) {
    let [normal_unprotected, reverse_unprotected] = reasons(name).map(|reason| reason.map(at));
    made.points.push(Point {
        normal_unprotected,
        reverse_unprotected,
        name: at(side.own(name)),
        circuit: at(side.own(circuit)),
        toe: at(toe),
        normal: at(normal),
        reverse: at(reverse),
        ..Point::default()
    });
}

/// A through track: a stretch for the overlap at each end, and where trains stop between them.
fn platform(made: &mut Station, track: usize) {
    let (left, right) = (format!("W-t{track}"), format!("E-t{track}"));
    let (west, east) = (format!("W-s{track}"), format!("E-s{track}"));
    made.circuits.push(circuit(format!("{track}W"), 60, Some((left, west.clone()))));
    made.circuits.push(circuit(format!("{track}"), 300, Some((west, east.clone()))));
    made.circuits.push(circuit(format!("{track}E"), 60, Some((east, right))));
    made.platforms.push(Platform { name: format!("Platform {track}"), circuits: vec![at(format!("{track}"))] });
}

fn bay(made: &mut Station) {
    made.circuits.push(circuit("9W".to_owned(), 60, Some(("W-t9".to_owned(), "W-s9".to_owned()))));
    made.circuits.push(circuit("9".to_owned(), 200, Some(("W-s9".to_owned(), "W-b9".to_owned()))));
    made.ends.push(End { joint: at("W-b9"), kind: EndKind::Buffer });
    made.platforms.push(Platform { name: "Platform 9".to_owned(), circuits: vec![at("9")] });
}

/// From each line into each track, by a main and by a calling-on signal, and out of each track to each line.
fn routes(made: &mut Station, side: Side) {
    let other = if side == Side::West { 'E' } else { 'W' };
    for (ladder, tracks) in side.ladders().into_iter().enumerate() {
        for (place, track) in tracks.iter().enumerate() {
            let points = tracks.iter().take((place + 1).min(tracks.len() - 1)).map(|at| format!("L{at}"));
            let inner: Vec<String> =
                points.map(|name| side.own(&name)).chain([format!("{track}{}", side.prefix())]).collect();
            for (number, line) in side.lines().into_iter().enumerate() {
                let outer = throat_of(number, ladder).iter().map(|name| side.own(name));
                let path: Vec<String> = outer.chain(inner.iter().cloned()).collect();
                let letter = line.letter;
                if line.comes {
                    let whole = path.iter().cloned().chain([track.to_string()]).map(element).collect();
                    let overlap = (*track <= TRACKS).then(|| element(format!("{track}{other}")));
                    made.routes.push(Route {
                        name: at(format!("{letter}-{track}")),
                        signal: Some(letter.to_string()),
                        entry: at(format!("{letter}1")),
                        path: whole,
                        overlap: overlap.into_iter().collect(),
                        ..Route::default()
                    });
                    made.routes.push(Route {
                        name: at(format!("{letter}-{track}c")),
                        signal: Some(format!("{letter}c")),
                        entry: at(format!("{letter}1")),
                        path: path.iter().cloned().map(element).collect(),
                        berth: vec![element(track.to_string())],
                        ..Route::default()
                    });
                }
                if line.goes {
                    let out = throat_of(number, ladder).iter().map(|name| side.own(name));
                    let path: Vec<String> = out.chain(inner.iter().cloned()).rev().collect();
                    made.routes.push(Route {
                        name: at(format!("{track}-{letter}")),
                        signal: Some(format!("{track}{}", side.prefix())),
                        entry: at(track.to_string()),
                        path: path.into_iter().map(|circuit| beside_scissors(side, circuit, ladder)).collect(),
                        ..Route::default()
                    });
                }
            }
        }
    }
}

/// Who runs straight past the scissors keeps those of the other track straight too: a vehicle between them would face no signal.
fn beside_scissors(side: Side, circuit: String, ladder: usize) -> At<Element> {
    let kept = if circuit == side.own("SU") && ladder > 0 { ["1a", "2a"].as_slice() } else { &[] };
    let points = kept.iter().map(|point| (side.own(point), At::derived(Position::Normal))).collect();
    At::derived(Element { circuit, points })
}

/// The circuits from a line (single, in, out) to a ladder, from the outside.
const fn throat_of(line: usize, ladder: usize) -> &'static [&'static str] {
    match (line, ladder) {
        (0, 0) => &["DN"],
        (0, _) => &["DN", "DU"],
        (1, 0) => &["SD", "DN"],
        (1, _) => &["SD", "DN", "DU"],
        (_, 0) => &["SU", "SD", "DN"],
        _ => &["SU", "DU"],
    }
}
