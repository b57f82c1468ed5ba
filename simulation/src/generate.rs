//! Stations of a single line, written as layout files: passing loops of several tracks, and a terminus at either end.
//!
//! Track `t` is two circuits, `tA` in the west and `tB` in the east: the code of the last circuit of a route is stop, so
//! that a train on codes stops in it, and the circuit before it is there for its rear. Block `i` of line `k` is `Lk-i`.
//!
//! With a double track there are two lines between two stations: `LkE-i` are the blocks of the one for trains to the east, `LkW-i` those of the
//! other. Both meet in a point before the tracks of a station.

use std::fmt::Write as _;

/// The shape of a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shape {
    /// How many tracks each station has, 2 to 64 (from 17 on it is a large station); there are two stations or more.
    pub tracks: Vec<usize>,
    /// How many blocks each line between two stations has, 3 to 12: one less than there are stations.
    pub blocks: Vec<usize>,
    /// Whether there are two lines between two stations, one for each direction.
    pub double: bool,
}

/// A line as one of its stations sees it.
#[derive(Clone, Copy)]
struct End {
    /// The number of the line.
    line: usize,
    /// `W` or `E`: where it lies.
    side: char,
    /// How many blocks it has.
    blocks: usize,
}

/// One track of a line: on a single line trains run both ways, otherwise to the east or to the west.
#[derive(Clone, Copy)]
struct OneTrack {
    at: End,
    /// `E`, `W`, or nothing on a single line.
    way: &'static str,
}

const UNPROTECTED: &str = "trains on the tracks obey their signals and are braked by ATC; no vehicle is parked there";
/// The last circuit is 200 m long. A train comes into it at 55 km/h at most, the highest code from which it stops in 200 m.
const SHORT: &str = "the code of the last circuit is stop, and it is longer than a train needs that comes into it";

impl Shape {
    /// Stations of so many tracks each, with single lines of so many blocks between them.
    pub const fn single(tracks: Vec<usize>, blocks: Vec<usize>) -> Self {
        Self { tracks, blocks, double: false }
    }

    /// Passing loops of two tracks, `stations` of them, with `blocks` between two.
    pub fn loops(stations: usize, blocks: usize) -> Self {
        Self::single(vec![2; stations], vec![blocks; stations.saturating_sub(1)])
    }

    /// Four stations of six tracks: 64 circuits, room for 23 trains.
    pub fn large() -> Self {
        Self::single(vec![6; 4], vec![4, 3, 3])
    }

    /// Stations of so many tracks each, with double tracks of so many blocks between them.
    pub const fn double(tracks: Vec<usize>, blocks: Vec<usize>) -> Self {
        Self { tracks, blocks, double: true }
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
        } else if let Some(tracks) = self.tracks.iter().find(|tracks| !(2..=64).contains(*tracks)) {
            Some(format!("a station of {tracks} tracks: 2 to 64 are possible"))
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
        let west = number.checked_sub(1).map(|line| End { line, side: 'W', blocks: self.blocks[line] });
        let east = self.blocks.get(number).map(|blocks| End { line: number, side: 'E', blocks: *blocks });
        writeln!(out, "name = \"Station {}\"\nlongest_train_m = 200", number + 1)?;
        writeln!(out, "[times]\ntelegram_age_ms = 2000\n[speed]\nline_kmh = 75\nreverse_kmh = 45")?;
        for (side, line) in [('W', west), ('E', east)] {
            let Some(line) = line else {
                for track in 1..=tracks {
                    writeln!(out, "[[end]]\njoint = \"{side}{track}\"\nkind = \"buffer\"")?;
                }
                continue;
            };
            let seen = line.tracks(self.double);
            seen.iter().try_for_each(|track| track.seen(out))?;
            let joints: Vec<String> = seen.iter().map(OneTrack::near_joint).collect();
            throat(out, side, tracks, &joints)?;
        }
        for track in 1..=tracks {
            let ends = |side: char| format!("{side}{track}");
            circuit(out, &format!("{track}A"), 200, &ends('W'), &format!("m{track}"))?;
            circuit(out, &format!("{track}B"), 200, &format!("m{track}"), &ends('E'))?;
            writeln!(out, "[[platform]]\nname = \"Track {track}\"\ncircuits = [\"{track}A\", \"{track}B\"]")?;
            for (side, line) in [('W', west), ('E', east)] {
                let Some(line) = line else { continue };
                let (first, last) = if side == 'W' { ('A', 'B') } else { ('B', 'A') };
                for one in line.tracks(self.double) {
                    if one.arrives() {
                        let near = one.near();
                        writeln!(out, "[[route]]\nname = \"{side}-{track}\"\nsignal = \"{side}\"")?;
                        let throat = over(side, track, tracks);
                        writeln!(
                            out,
                            "entry = \"{near}\"\npath = [{}, \"{track}{first}\", \"{track}{last}\"]",
                            throat.join(", ")
                        )?;
                        writeln!(out, "short_overlap = \"{SHORT}\"")?;
                    }
                    if one.departs() {
                        writeln!(out, "[[route]]\nname = \"{track}-{side}\"\nsignal = \"{track}{side}\"")?;
                        let throat: Vec<_> = over(side, track, tracks).into_iter().rev().collect();
                        writeln!(out, "entry = \"{track}{first}\"\npath = [{}]", throat.join(", "))?;
                        if self.double {
                            writeln!(out, "to = \"{}\"", one.segment())?;
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

fn circuit(out: &mut String, name: &str, length: u32, left: &str, right: &str) -> std::fmt::Result {
    writeln!(out, "[[circuit]]\nname = \"{name}\"\nlength_m = {length}\nleft = \"{left}\"\nright = \"{right}\"")
}

impl End {
    /// Its tracks: of a double one first that on which trains arrive.
    fn tracks(self, double: bool) -> Vec<OneTrack> {
        let ways: &[&str] = match (double, self.side) {
            (false, _) => &[""],
            (true, 'W') => &["E", "W"],
            (true, _) => &["W", "E"],
        };
        ways.iter().map(|way| OneTrack { at: self, way }).collect()
    }
}

impl OneTrack {
    fn block(&self, number: usize) -> String {
        format!("L{}{}-{number}", self.at.line + 1, self.way)
    }

    fn joint(&self, number: usize) -> String {
        format!("l{}{}-{number}", self.at.line + 1, self.way)
    }

    /// Whether trains come from it: they run away from the side where it lies.
    fn arrives(&self) -> bool {
        self.way.is_empty() || !self.way.contains(self.at.side)
    }

    /// Whether trains go out to it.
    fn departs(&self) -> bool {
        self.way.is_empty() || self.way.contains(self.at.side)
    }

    /// The block next to the station.
    fn near(&self) -> String {
        self.block(if self.at.side == 'W' { self.at.blocks } else { 1 })
    }

    /// The joint between it and the station.
    fn near_joint(&self) -> String {
        self.joint(if self.at.side == 'W' { self.at.blocks } else { 0 })
    }

    /// The segment of the station.
    fn segment(&self) -> String {
        let space = if self.way.is_empty() { "" } else { " " };
        format!("{}{space}{}", self.at.side, self.way)
    }

    /// The blocks that a station sees: all but the one next to its neighbour, and that one's neighbours they share.
    fn seen(&self, out: &mut String) -> std::fmt::Result {
        let End { line, side, blocks } = self.at;
        let outward: Vec<usize> = if side == 'W' { (2..=blocks).rev().collect() } else { (1..blocks).collect() };
        for number in &outward {
            circuit(out, &self.block(*number), 300, &self.joint(number - 1), &self.joint(*number))?;
        }
        let far = if side == 'W' { 1 } else { blocks - 1 };
        writeln!(out, "[[end]]\njoint = \"{}\"\nkind = \"line\"", self.joint(far))?;
        let names = |numbers: &[usize]| {
            numbers.iter().map(|number| format!("\"{}\"", self.block(*number))).collect::<Vec<_>>().join(", ")
        };
        let space = if self.way.is_empty() { "" } else { " " };
        writeln!(out, "[[segment]]\nname = \"{}\"\ncircuits = [{}]", self.segment(), names(&outward))?;
        writeln!(out, "line = \"Line {}{space}{}\"\nshared = [{}]", line + 1, self.way, names(&outward[1..]))
    }
}

/// The most tracks that one circuit of a throat leads to: it may have 12 points, and where two lines meet is one more.
const TRACKS: usize = 12;

/// The groups of tracks of a throat, as even as can be: of several each has a circuit of its own, so that all tracks are as far from the line.
fn groups(tracks: usize) -> Vec<std::ops::RangeInclusive<usize>> {
    let count = tracks.div_ceil(TRACKS);
    (0..count).map(|group| group * tracks / count + 1..=(group + 1) * tracks / count).collect()
}

/// The circuits of a throat that lead to a track, from the line on, as strings of TOML.
fn over(side: char, track: usize, tracks: usize) -> Vec<String> {
    let groups = groups(tracks);
    let own = groups.iter().position(|group| group.contains(&track)).filter(|_| groups.len() > 1);
    let own = own.map(|group| format!("\"{side}T{}\"", group + 1));
    std::iter::once(format!("\"{side}T\"")).chain(own).collect()
}

/// The points between the line and the tracks, in one circuit; of many tracks each group has one more. Where two lines meet, that on which trains
/// arrive is the straight one.
fn throat(out: &mut String, side: char, tracks: usize, lines: &[String]) -> std::fmt::Result {
    let groups = groups(tracks);
    let joints = |tracks: std::ops::RangeInclusive<usize>| tracks.map(|track| format!("{side}{track}")).collect();
    let circuit = format!("{side}T");
    writeln!(out, "[[circuit]]\nname = \"{circuit}\"\nlength_m = 60")?;
    let lead = match lines {
        [arrives, departs] => {
            let lead = format!("{side}c0");
            point(out, (side, 0), &circuit, [&lead, arrives, departs])?;
            lead
        }
        _ => lines.concat(),
    };
    let [all] = &groups[..] else {
        let leads: Vec<String> = (1..=groups.len()).map(|group| format!("{side}g{group}")).collect();
        ladder(out, (side, 1), &circuit, (&lead, &leads))?;
        let mut first = groups.len();
        for (number, (group, lead)) in groups.into_iter().zip(&leads).enumerate() {
            let circuit = format!("{circuit}{}", number + 1);
            writeln!(out, "[[circuit]]\nname = \"{circuit}\"\nlength_m = 60")?;
            let joints: Vec<String> = joints(group);
            ladder(out, (side, first), &circuit, (lead, &joints))?;
            first += joints.len() - 1;
        }
        return Ok(());
    };
    ladder(out, (side, 1), &circuit, (&lead, &joints(all.clone())))
}

/// Points one behind the other, numbered from `first`, from a lead to each of the joints.
fn ladder(
    out: &mut String,
    (side, first): (char, usize),
    circuit: &str,
    (lead, joints): (&str, &[String]),
) -> std::fmt::Result {
    let Some((last, others)) = joints.split_last() else { return Ok(()) };
    for (place, joint) in others.iter().enumerate() {
        let number = first + place;
        let toe = if place == 0 { lead.to_owned() } else { format!("{side}c{number}") };
        let more = format!("{side}c{}", number + 1);
        point(out, (side, number), circuit, [&toe, joint, if place + 1 == others.len() { last } else { &more }])?;
    }
    Ok(())
}

fn point(
    out: &mut String,
    (side, number): (char, usize),
    circuit: &str,
    [toe, normal, reverse]: [&str; 3],
) -> std::fmt::Result {
    writeln!(out, "[[point]]\nname = \"{side}P{number}\"\ncircuit = \"{circuit}\"\ntoe = \"{toe}\"")?;
    writeln!(out, "normal = \"{normal}\"\nreverse = \"{reverse}\"")?;
    writeln!(out, "normal_unprotected = \"{UNPROTECTED}\"\nreverse_unprotected = \"{UNPROTECTED}\"")
}
