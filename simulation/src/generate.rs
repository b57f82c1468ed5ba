//! Stations of a single line, written as layout files: passing loops of several tracks, and a terminus at either end.
//!
//! Track `t` is two circuits, `tA` in the west and `tB` in the east: the code of the last circuit of a route is stop, so
//! that a train on codes stops in it, and the circuit before it is there for its rear. Block `i` of line `k` is `Lk-i`.

use std::fmt::Write as _;

/// The shape of a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shape {
    /// How many tracks each station has, 1 to 8; there are two stations or more.
    pub tracks: Vec<usize>,
    /// How many blocks each line between two stations has, 3 to 12: one less than there are stations.
    pub blocks: Vec<usize>,
}

const UNPROTECTED: &str = "trains on the tracks obey their signals and are braked by ATC; no vehicle is parked there";
/// The last circuit is 200 m long. A train comes into it at 55 km/h at most, the highest code from which it stops in 200 m.
const SHORT: &str = "the code of the last circuit is stop, and it is longer than a train needs that comes into it";

impl Shape {
    /// Passing loops of two tracks, `stations` of them, with `blocks` between two.
    pub fn loops(stations: usize, blocks: usize) -> Self {
        Self { tracks: vec![2; stations], blocks: vec![blocks; stations.saturating_sub(1)] }
    }

    /// Four stations of six tracks: 64 circuits, room for 23 trains.
    pub fn large() -> Self {
        Self { tracks: vec![6; 4], blocks: vec![4, 3, 3] }
    }

    /// What is wrong with it; `None` if a line can be made of it.
    pub fn wrong(&self) -> Option<String> {
        if self.tracks.len() < 2 || self.tracks.len() > 12 {
            Some(format!("{} stations: a line has 2 to 12", self.tracks.len()))
        } else if self.blocks.len() + 1 != self.tracks.len() {
            Some(format!(
                "{} stations and {} numbers of blocks: give one number for each line between two",
                self.tracks.len(),
                self.blocks.len()
            ))
        } else if let Some(tracks) = self.tracks.iter().find(|tracks| !(2..=8).contains(*tracks)) {
            Some(format!("a station of {tracks} tracks: 2 to 8 are possible"))
        } else {
            let blocks = self.blocks.iter().find(|blocks| !(3..=12).contains(*blocks));
            blocks.map(|blocks| format!("a line of {blocks} blocks: 3 to 12 are possible"))
        }
    }

    /// The layout file of each station, with its name.
    pub fn stations(&self) -> Vec<(String, String)> {
        (0..self.tracks.len()).map(|number| (format!("Station {}", number + 1), self.station(number))).collect()
    }

    fn station(&self, number: usize) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.write(number, &mut text);
        text
    }

    fn write(&self, number: usize, out: &mut String) -> std::fmt::Result {
        let tracks = self.tracks[number];
        let west = number.checked_sub(1).map(|line| (line, self.blocks[line]));
        let east = self.blocks.get(number).map(|blocks| (number, *blocks));
        writeln!(out, "name = \"Station {}\"\nlongest_train_m = 200", number + 1)?;
        writeln!(out, "[times]\ntelegram_age_ms = 2000\n[speed]\nline_kmh = 75\nreverse_kmh = 45")?;
        for (side, line) in [('W', west), ('E', east)] {
            let Some((line, blocks)) = line else {
                for track in 1..=tracks {
                    writeln!(out, "[[end]]\njoint = \"{side}{track}\"\nkind = \"buffer\"")?;
                }
                continue;
            };
            seen(out, side, line, blocks)?;
            throat(out, side, tracks, &joint(line, if side == 'W' { blocks } else { 0 }))?;
        }
        for track in 1..=tracks {
            let ends = |side: char| format!("{side}{track}");
            circuit(out, &format!("{track}A"), 200, &ends('W'), &format!("m{track}"))?;
            circuit(out, &format!("{track}B"), 200, &format!("m{track}"), &ends('E'))?;
            writeln!(out, "[[platform]]\nname = \"Track {track}\"\ncircuits = [\"{track}A\", \"{track}B\"]")?;
            for (side, line) in [('W', west), ('E', east)] {
                let Some((line, blocks)) = line else { continue };
                let near = block(line, if side == 'W' { blocks } else { 1 });
                let (first, last) = if side == 'W' { ('A', 'B') } else { ('B', 'A') };
                writeln!(out, "[[route]]\nname = \"{side}-{track}\"\nsignal = \"{side}\"\nentry = \"{near}\"")?;
                writeln!(
                    out,
                    "path = [\"{side}T\", \"{track}{first}\", \"{track}{last}\"]\nshort_overlap = \"{SHORT}\""
                )?;
                writeln!(out, "[[route]]\nname = \"{track}-{side}\"\nsignal = \"{track}{side}\"")?;
                writeln!(out, "entry = \"{track}{first}\"\npath = [\"{side}T\"]")?;
            }
        }
        Ok(())
    }
}

fn block(line: usize, number: usize) -> String {
    format!("L{}-{number}", line + 1)
}

fn joint(line: usize, number: usize) -> String {
    format!("l{}-{number}", line + 1)
}

fn circuit(out: &mut String, name: &str, length: u32, left: &str, right: &str) -> std::fmt::Result {
    writeln!(out, "[[circuit]]\nname = \"{name}\"\nlength_m = {length}\nleft = \"{left}\"\nright = \"{right}\"")
}

/// The blocks that a station sees: all but the one next to its neighbour, and that one's neighbours they share.
fn seen(out: &mut String, side: char, line: usize, blocks: usize) -> std::fmt::Result {
    let outward: Vec<usize> = if side == 'W' { (2..=blocks).rev().collect() } else { (1..blocks).collect() };
    for number in &outward {
        circuit(out, &block(line, *number), 300, &joint(line, number - 1), &joint(line, *number))?;
    }
    let far = if side == 'W' { 1 } else { blocks - 1 };
    writeln!(out, "[[end]]\njoint = \"{}\"\nkind = \"line\"", joint(line, far))?;
    let names = |numbers: &[usize]| {
        numbers.iter().map(|number| format!("\"{}\"", block(line, *number))).collect::<Vec<_>>().join(", ")
    };
    writeln!(out, "[[segment]]\nname = \"{side}\"\ncircuits = [{}]", names(&outward))?;
    writeln!(out, "line = \"Line {}\"\nshared = [{}]", line + 1, names(&outward[1..]))
}

/// The points between the line and the tracks, one behind the other, all in one circuit.
fn throat(out: &mut String, side: char, tracks: usize, line: &str) -> std::fmt::Result {
    writeln!(out, "[[circuit]]\nname = \"{side}T\"\nlength_m = 60")?;
    for point in 1..tracks {
        let toe = if point == 1 { line.to_owned() } else { format!("{side}c{point}") };
        let reverse = if point + 1 == tracks { format!("{side}{tracks}") } else { format!("{side}c{}", point + 1) };
        writeln!(out, "[[point]]\nname = \"{side}P{point}\"\ncircuit = \"{side}T\"\ntoe = \"{toe}\"")?;
        writeln!(out, "normal = \"{side}{point}\"\nreverse = \"{reverse}\"")?;
        writeln!(out, "normal_unprotected = \"{UNPROTECTED}\"\nreverse_unprotected = \"{UNPROTECTED}\"")?;
    }
    Ok(())
}
