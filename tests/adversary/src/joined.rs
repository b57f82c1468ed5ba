//! Two stations and the line between them as one ground: the last circuit that both see is one circuit, or their views meet at a joint.

use atc_layout::Description;
use atc_layout::border::compare;

use super::device::{self, Device};
use super::ground::{Ground, Line, Mask, OUTSIDE_MM, Piece, Route, bit, members};
use super::stations;

/// The name of the circuit that both stations see.
const SHARED: &str = "S";

/// Where the things of a station are in the joined ground.
#[derive(Clone, Debug)]
pub struct Place {
    /// The circuit there of each circuit that the station sees.
    pub circuits: Vec<usize>,
    /// The number of its first point.
    pub points: usize,
    /// How many it has.
    pub point_count: usize,
    /// The number of its first route.
    pub routes: usize,
    /// How many it has.
    pub route_count: usize,
    /// The number of its first line.
    pub lines: usize,
    /// How many it has.
    pub line_count: usize,
    /// Which of these leads to the other station.
    pub inner: usize,
    /// The circuits of the joined ground whose restrictions it is told besides its own, and where (`limits-known-on-both-sides`).
    pub told: Vec<(usize, usize)>,
    /// How long a train may take to a stand in its last circuit, in cycles.
    pub standstill: i64,
    /// The overlap of each route, as circuits of the joined ground.
    pub overlaps: Vec<Vec<usize>>,
}

/// Two stations.
pub struct Joined {
    /// The ground of both.
    pub ground: Ground,
    /// Where each is in it.
    pub places: [Place; 2],
    /// Their devices.
    pub devices: [Box<dyn Device>; 2],
    /// For how long a permission of the neighbour counts, in cycles.
    pub life: i64,
    /// The circuits that both see.
    pub shared: Mask,
}

/// The text of a station with its `side` turned to the other one.
fn text(number: Option<u64>, side: &str, meets: bool) -> String {
    let text = if let Some(number) = number {
        stations::random(number).source.text
    } else {
        let text = stations::of("passing-loop").source.text;
        let text = text.replace("name = \"East\"", "name = \"E\"").replace("name = \"West\"", "name = \"W\"");
        let alone = format!("circuits = [\"{side}1\", \"{side}2\"]");
        text.replace(&alone, &format!("{alone}\nshared = [\"{side}2\"]"))
    };
    let outer = format!("\"{side}2\"");
    let segment = format!("name = \"{side}\"\ncircuits");
    let mut text = text.replace(&segment, &format!("name = \"{side}\"\nline = \"L\"\ncircuits"));
    if meets {
        let shared = format!("circuits = [\"{side}1\", {outer}]\nshared = [{outer}]");
        text = text.replace(&shared, &format!("circuits = [\"{side}1\", {outer}]"));
        let end = match (number, side) {
            (Some(_), _) => format!("\"{side}a\""),
            (None, "E") => "\"j\"".to_owned(),
            (None, _) => "\"a\"".to_owned(),
        };
        return text.replace(&outer, &format!("\"{side}2 of {side}\"")).replace(&end, "\"border\"");
    }
    text.replace(&outer, &format!("\"{SHARED}\""))
}

/// What stands behind `key` in the text, up to the end of the line.
fn value<'a>(text: &'a str, key: &str) -> &'a str {
    text.split_once(key).map_or("", |(_, rest)| rest.lines().next().unwrap_or(""))
}

/// `text` with what stands behind `key` put to what it is in `other`.
fn same(text: &str, other: &str, key: &str) -> String {
    let (old, new) = (value(text, key), value(other, key));
    text.replacen(&format!("{key}{old}\n"), &format!("{key}{new}\n"), 1)
}

/// Two stations, each random or, without a number, the passing loop; `meets`: no circuit is seen by both. `checked`: their border must be sound.
///
/// # Errors
/// What is wrong with the border, or that there are too many things for one ground.
pub fn join(numbers: [Option<u64>; 2], meets: bool, checked: bool) -> Result<Joined, String> {
    let first = text(numbers[0], "E", meets);
    let mut second = text(numbers[1], "W", meets);
    second = same(&second, &first, "line_kmh = ");
    if !meets {
        second = same(&second, &first, &format!("name = \"{SHARED}\"\nlength_m = "));
    }
    let read = |text: &str| Description::from_toml("station", text).map_err(|error| error.to_string());
    let stations = [read(&first)?, read(&second)?];
    let model = |station: &Description| station.model().map_err(|error| error.to_string());
    let models = [model(&stations[0])?, model(&stations[1])?];
    if checked {
        compare((&stations[0], &models[0]), (&stations[1], &models[1])).map_err(|error| error.to_string())?;
    }
    let kernel = |station: &Description| device::kernel(station).map_err(|error| error.to_string());
    let ((one, ground), (two, other)) = (kernel(&stations[0])?, kernel(&stations[1])?);
    let mut joined = lay(&[ground, other], [one, two], meets)?;
    for (place, model) in joined.places.iter_mut().zip(&models) {
        place.standstill = i64::from(model.values.standstill.0);
        let overlap = |route: &atc_layout::model::Route| route.overlap.iter().map(|at| place.circuits[*at]).collect();
        place.overlaps = model.routes.iter().map(overlap).collect();
    }
    let life = |at: usize| {
        let values = &models[at].values;
        let age = i64::from(values.telegram_age_ms / values.cycle_ms);
        age.min(i64::from(values.turn.0) - i64::from(values.residual.0) - joined.ground.loss)
            .min(i64::from(values.turn.0) - 1)
    };
    joined.life = life(0).min(life(1));
    Ok(joined)
}

/// The line of a station that leads to the other one.
fn inner(ground: &Ground, name: &str) -> Result<usize, String> {
    ground.lines.iter().position(|line| line.name == name).ok_or_else(|| format!("no line {name}"))
}

/// Lays the tracks of both.
fn lay(grounds: &[Ground; 2], devices: [Box<dyn Device>; 2], meets: bool) -> Result<Joined, String> {
    let inner = [inner(&grounds[0], "E")?, inner(&grounds[1], "W")?];
    let [first, second] = grounds;
    if first.codes != second.codes || first.cycle_ms != second.cycle_ms {
        return Err("their codes or cycles differ".to_owned());
    }
    let last = [first.lines[inner[0]].outermost, second.lines[inner[1]].outermost];
    let mut places = Vec::new();
    let mut circuits: Vec<usize> = (0..first.seen).collect();
    places.push(place(first, (circuits.clone(), inner[0]), [0, 0, 0]));
    circuits.clear();
    let mut next = first.seen;
    for circuit in 0..second.seen {
        let is_shared = !meets && circuit == last[1];
        circuits.push(if is_shared { last[0] } else { next });
        next += usize::from(!is_shared);
    }
    places.push(place(second, (circuits, inner[1]), [first.points.len(), first.routes.len(), first.lines.len()]));
    let seen = next;
    let mut ground = Ground { seen, circuits: vec![String::new(); seen], lengths: vec![0; seen], ..first.clone() };
    ground.pieces.clear();
    ground.lines.clear();
    let limits = |pick: fn(&Ground) -> i64| (pick(first), pick(second));
    let least = |(one, two): (i64, i64)| one.min(two);
    let most = |(one, two): (i64, i64)| one.max(two);
    (ground.loss, ground.life, ground.fastest) =
        (least(limits(|it| it.loss)), least(limits(|it| it.life)), least(limits(|it| it.fastest)));
    (ground.clear, ground.turn, ground.start) =
        (most(limits(|it| it.clear)), most(limits(|it| it.turn)), most(limits(|it| it.start)));
    ground.longest = least(limits(|it| it.longest));
    let meeting = joints_of(first, last[0], inner[0]);
    let theirs = joints_of(second, last[1], inner[1]);
    // Inner and outer joint: the outer one of each view is the inner one of the other, or both are one.
    let same =
        if meets { vec![(theirs[1], meeting[1])] } else { vec![(theirs[1], meeting[0]), (theirs[0], meeting[1])] };
    let shift = first.joints.len();
    let joint = |at: usize, number: usize| {
        let mapped = same.iter().find(|(its, _)| at == 1 && *its == number).map(|(_, ours)| *ours);
        mapped.unwrap_or(if at == 0 { number } else { shift + number })
    };
    let mut outer = Vec::new();
    for (at, it) in grounds.iter().enumerate() {
        for piece in &it.pieces {
            let joints: Vec<usize> = piece.joints.iter().map(|number| joint(at, *number)).collect();
            if piece.circuit >= it.seen {
                outer.push(joints);
            } else if at == 0 || meets || piece.circuit != last[1] {
                let point = piece.point.map(|point| point + places[at].points);
                ground.pieces.push(Piece {
                    circuit: places[at].circuits[piece.circuit],
                    joints,
                    point,
                    length: piece.length,
                });
            }
        }
        for circuit in 0..it.seen {
            let here = places[at].circuits[circuit];
            ground.circuits[here] = format!("{}{}", ["A.", "B."][at], it.circuits[circuit]);
            ground.lengths[here] = it.lengths[circuit];
        }
    }
    if !meets && first.lengths[last[0]] != second.lengths[last[1]] {
        return Err("the circuit that both see has two lengths".to_owned());
    }
    ground.points = [&first.points[..], &second.points[..]].concat();
    ground.throw = [&first.throw[..], &second.throw[..]].concat();
    ground.reverse = [&first.reverse[..], &second.reverse[..]].concat();
    ground.routes =
        grounds.iter().enumerate().flat_map(|(at, it)| routes(it, &places[at], &|number| joint(at, number))).collect();
    if ground.routes.len() > 64 || ground.points.len() > 32 {
        return Err("too many routes or points for one ground".to_owned());
    }
    let joints = outward(&mut ground, (grounds, &places, inner), &outer, shift + second.joints.len());
    ground.joints = vec![Vec::new(); joints];
    for (number, piece) in ground.pieces.iter().enumerate() {
        for joint in &piece.joints {
            ground.joints[*joint].push(number);
        }
    }
    ground.name = format!("{} and {}", first.name, second.name);
    let shared = if meets { 0 } else { bit(last[0]) };
    let mut places: [Place; 2] = places.try_into().map_err(|_| "two stations")?;
    neighbours(&ground, &mut places, last, meets);
    Ok(Joined { ground, places, devices, life: 0, shared })
}

/// Lays the lines of both; `outer` are the ends of what lies beyond each. How many joints there are then, of `joints` before.
fn outward(
    ground: &mut Ground,
    (grounds, places, inner): (&[Ground; 2], &[Place], [usize; 2]),
    outer: &[Vec<usize>],
    mut joints: usize,
) -> usize {
    for (at, it) in grounds.iter().enumerate() {
        for (number, line) in it.lines.iter().enumerate() {
            let mapped = mask(&places[at], line.mask);
            let (circuit, piece) = (ground.circuits.len(), ground.pieces.len());
            ground.circuits.push(format!("beyond {} of {}", line.name, ["A", "B"][at]));
            ground.lengths.push(OUTSIDE_MM);
            let ends = outer[ground.lines.len()].clone();
            let leads_out = number != inner[at];
            // Beyond the inner line is the other station: what stands for it here lies nowhere.
            let ends = if leads_out { ends } else { vec![joints, joints + 1] };
            joints += if leads_out { 0 } else { 2 };
            let outermost = if leads_out { places[at].circuits[line.outermost] } else { circuit };
            ground.lines.push(Line {
                name: format!("{}{}", ["A.", "B."][at], line.name),
                mask: mapped,
                outermost,
                outside: circuit,
                piece,
                far: ends[0],
                border: ends[1],
                ways: if leads_out { line.ways } else { [false, false] },
            });
            ground.pieces.push(Piece { circuit, joints: ends, point: None, length: OUTSIDE_MM });
        }
    }
    joints
}

/// Which restrictions of the other one each station is told of: those within a train's length of where it begins to speak.
fn neighbours(ground: &Ground, places: &mut [Place; 2], last: [usize; 2], meets: bool) {
    for at in 0..2 {
        let nearest = places[at].circuits[last[at]];
        let other = &places[1 - at];
        let line = members(ground.lines[other.lines + other.inner].mask).collect::<Vec<_>>();
        // The circuits of the other one's line, from the shared one inward.
        let outermost = other.circuits[last[1 - at]];
        let mut inward: Vec<usize> = line.into_iter().filter(|circuit| *circuit != outermost).collect();
        if meets {
            inward.insert(0, outermost);
        }
        let mut covered = 0;
        let mut told = Vec::new();
        for circuit in inward {
            if covered < ground.longest {
                told.push((circuit, nearest));
            }
            covered += ground.lengths[circuit];
        }
        places[at].told = told;
    }
}

/// The inner and the outer joint of a line's outermost circuit.
fn joints_of(ground: &Ground, circuit: usize, line: usize) -> [usize; 2] {
    let border = ground.lines[line].border;
    let piece = ground.pieces.iter().find(|piece| piece.circuit == circuit && piece.joints.contains(&border));
    let inner = piece.and_then(|piece| piece.joints.iter().copied().find(|joint| *joint != border));
    [inner.unwrap_or(border), border]
}

fn place(ground: &Ground, (circuits, inner): (Vec<usize>, usize), [points, routes, lines]: [usize; 3]) -> Place {
    Place {
        circuits,
        points,
        point_count: ground.points.len(),
        routes,
        route_count: ground.routes.len(),
        lines,
        line_count: ground.lines.len(),
        inner,
        told: Vec::new(),
        standstill: 0,
        overlaps: Vec::new(),
    }
}

/// A set of the station's circuits in the joined ground.
pub fn mask(place: &Place, local: Mask) -> Mask {
    members(local).filter_map(|circuit| place.circuits.get(circuit)).fold(0, |all, circuit| all | bit(*circuit))
}

fn routes(ground: &Ground, place: &Place, joint: &dyn Fn(usize) -> usize) -> Vec<Route> {
    let moved = |route: &Route| Route {
        name: route.name.clone(),
        start: joint(route.start),
        exit: joint(route.exit),
        entry: place.circuits[route.entry],
        path: route.path.iter().map(|circuit| place.circuits[*circuit]).collect(),
        mask: mask(place, route.mask),
        approach: mask(place, route.approach),
        points: route.points.iter().map(|(point, reverse)| (point + place.points, *reverse)).collect(),
        limit: route.limit,
        lines: route.lines.map(|line| line.map(|line| line + place.lines)),
        reverses: route.reverses,
        release: route.release,
    };
    ground.routes.iter().map(moved).collect()
}
