//! A walk through stations: trains that mostly obey their telegrams, points that take their time, false occupancy, and
//! requests that make sense or do not. What comes next depends on the replies of the kernel.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use serde_json::{Map, Value, json};

use crate::draw::Draw;
use crate::side::Asked;
use crate::small;

struct Plan {
    json: Value,
    circuits: Vec<String>,
    points: Vec<String>,
    segments: Vec<String>,
    routes: Vec<String>,
    /// The entry of each route.
    entries: Vec<String>,
    /// The routes that continue each route, or the route itself.
    onward: BTreeMap<String, Vec<String>>,
    /// From end to end.
    ways: Vec<Vec<String>>,
}

/// Points and their positions, as in `P1=normal P5=normal`.
fn positions(text: &str) -> Value {
    let pairs = text.split_whitespace().map(|pair| pair.split_once('=').expect("a pair"));
    Value::Object(pairs.map(|(point, position)| (point.to_owned(), position.into())).collect())
}

fn element((circuits, points): (&str, &str)) -> Value {
    json!({"circuits": circuits.split_whitespace().collect::<Vec<_>>(), "points": positions(points)})
}

struct Route<'a> {
    name: String,
    heading: &'a str,
    approach: Vec<&'a str>,
    path: Vec<(&'a str, String)>,
    overlap: (&'a str, String),
    beyond: &'a str,
    continuing: Vec<String>,
    conflicts: Vec<String>,
    from: &'a [&'a str],
    to: &'a [&'a str],
}

impl Route<'_> {
    /// In the protocol's form; it may be a calling-on route if what lies beyond its end can be a `berth`.
    fn json(&self, draw: &mut Draw, (cab, overlaps, berth): (bool, bool, bool)) -> Value {
        let path: Vec<Value> = self.path.iter().map(|(circuit, points)| element((circuit, points))).collect();
        let overlap = if overlaps { element((self.overlap.0, &self.overlap.1)) } else { element(("", "")) };
        let calling_on = overlaps && !cab && berth && draw.chance(200);
        let continuing = if calling_on { Vec::new() } else { self.continuing.clone() };
        let mut route = json!({
            "name": self.name, "heading": self.heading, "entry": [self.approach[0]], "approach": self.approach,
            "path": path, "overlap": overlap, "beyond": [self.beyond], "continuing": continuing,
            "conflicts": self.conflicts, "from": self.from, "to": self.to, "cab_signalled": cab, "calling_on": calling_on,
            "drive_cycles": draw.from(1, 7), "release_cycles": draw.one(&[1, 2, 4, 8, 20]), "stay_cycles": draw.from(1, 5),
            "speed_code": draw.one(&[1, 3, 5, 7, 7, 7]),
        });
        // Absent, it is that of the route.
        if let Some(code) = draw.one(&[None, Some(1), Some(4), Some(7)]) {
            route["overlap_speed_code"] = code.into();
        }
        route
    }
}

fn at(point: &str, track: &str) -> String {
    format!("{point}={}", if track == "1" || track == "3" { "normal" } else { "reverse" })
}

/// Two tracks between the points P1 and P2; or two such loops, with one track between them.
fn plan(draw: &mut Draw, long: bool) -> Plan {
    let (overlaps, flank) = (draw.chance(700), draw.chance(500));
    // From the tracks to M in one route, or in two, the first of one place; the plan may have both.
    let short = long && draw.chance(500);
    let mut routes = near(draw, long, if flank { " P5=normal" } else { "" }, short);
    routes.extend(far(draw, long));
    let throat = if long { "D" } else { "B" };
    let mut circuits = vec!["W2", "W1", "A", "1T", "2T", "B", "E1", "E2", "X"];
    let mut points = vec![("P1", "A"), ("P2", "B"), ("P5", "X")];
    if long {
        circuits.extend(["M", "C", "3T", "4T", "D"]);
        points.extend([("P3", "C"), ("P4", "D")]);
    }
    let segments = vec![
        json!({"name": "West", "circuits": ["W1", "W2"], "throat": ["A"], "outward": "left", "shared": draw.from(0, 2)}),
        json!({"name": "East", "circuits": ["E1", "E2"], "throat": [throat], "outward": "right", "shared": draw.from(0, 2)}),
    ];
    let mut ways = Vec::new();
    for near in ["1T", "2T"] {
        for beyond in if long { vec!["3T", "4T"] } else { vec![""] } {
            let mut way = vec!["W2", "W1", "A", near, "B"];
            if long {
                way.extend(["M", "C", beyond, "D"]);
            }
            way.extend(["E1", "E2"]);
            ways.push(own(&way));
            way.reverse();
            ways.push(own(&way));
        }
    }
    whole(draw, (&circuits, &points, &segments), &routes, ways, overlaps)
}

/// The routes of the tracks 1 and 2, those from and to the line in the west among them.
fn near(draw: &mut Draw, long: bool, flank: &str, short: bool) -> Vec<Route<'static>> {
    let mut routes: Vec<Route> = Vec::new();
    let middle_far = draw.one(&["3", "4"]);
    for track in ["1", "2"] {
        let circuit = if track == "1" { "1T" } else { "2T" };
        let onward = if long { format!("{track}-M") } else { format!("{track}-E") };
        routes.push(Route {
            name: format!("W-{track}"),
            heading: "right",
            approach: draw.one(&[vec!["W1"], vec!["W1", "W2"]]),
            path: vec![("A", at("P1", track) + flank), (circuit, String::new())],
            overlap: ("B", at("P2", track)),
            beyond: "B",
            continuing: vec![onward.clone()],
            conflicts: vec![],
            from: &["West"],
            to: &[],
        });
        routes.push(Route {
            name: format!("{track}-W"),
            heading: "left",
            approach: draw.one(&[vec![circuit], vec![circuit, "B"]]),
            path: vec![("A", at("P1", track))],
            overlap: ("", String::new()),
            beyond: "W1",
            continuing: vec![],
            conflicts: if short { vec![onward.clone(), format!("{track}-B")] } else { vec![onward.clone()] },
            from: &[],
            to: &["West"],
        });
        if short {
            routes.push(Route {
                name: format!("{track}-B"),
                heading: "right",
                approach: vec![circuit, "A", "W1"],
                path: vec![("B", at("P2", track))],
                overlap: ("M", String::new()),
                beyond: "M",
                continuing: vec!["B-M".to_owned()],
                conflicts: vec![format!("{track}-W")],
                from: &[],
                to: &[],
            });
        }
        if long {
            routes.push(Route {
                name: onward,
                heading: "right",
                approach: draw.one(&[vec![circuit], vec![circuit, "A"]]),
                path: vec![("B", at("P2", track)), ("M", String::new())],
                overlap: ("C", at("P3", middle_far)),
                beyond: "C",
                continuing: vec!["M-3".to_owned(), "M-4".to_owned()],
                conflicts: vec![format!("{track}-W")],
                from: &[],
                to: &[],
            });
            routes.push(Route {
                name: format!("M-{track}"),
                heading: "left",
                approach: draw.one(&[vec!["M"], vec!["M", "C"]]),
                path: vec![("B", at("P2", track)), (circuit, String::new())],
                overlap: ("A", at("P1", track)),
                beyond: "A",
                continuing: vec![format!("{track}-W")],
                conflicts: vec!["M-3".to_owned(), "M-4".to_owned()],
                from: &[],
                to: &[],
            });
        }
    }
    if short {
        routes.push(Route {
            name: "B-M".to_owned(),
            heading: "right",
            approach: vec!["B", "1T", "2T"],
            path: vec![("M", String::new())],
            overlap: ("C", at("P3", middle_far)),
            beyond: "C",
            continuing: vec!["M-3".to_owned(), "M-4".to_owned()],
            conflicts: vec![],
            from: &[],
            to: &[],
        });
    }
    routes
}

/// The routes from and to the line in the east, and of the tracks 3 and 4 if there are any.
fn far(draw: &mut Draw, long: bool) -> Vec<Route<'static>> {
    // The last point of the station, its circuit, and the tracks before it.
    let (last, throat, far) = if long { ("P4", "D", ["3", "4"]) } else { ("P2", "B", ["1", "2"]) };
    let mut routes: Vec<Route> = Vec::new();
    let middle = draw.one(&["1", "2"]);
    for track in far {
        let circuit = match track {
            "1" => "1T",
            "2" => "2T",
            "3" => "3T",
            _ => "4T",
        };
        let inward = if long { format!("{track}-m") } else { format!("{track}-W") };
        let (end, end_point) = if long { ("C", "P3") } else { ("A", "P1") };
        routes.push(Route {
            name: format!("E-{track}"),
            heading: "left",
            approach: draw.one(&[vec!["E1"], vec!["E1", "E2"]]),
            path: vec![(throat, at(last, track)), (circuit, String::new())],
            overlap: (end, at(end_point, track)),
            beyond: end,
            continuing: vec![inward.clone()],
            conflicts: vec![],
            from: &["East"],
            to: &[],
        });
        routes.push(Route {
            name: format!("{track}-E"),
            heading: "right",
            approach: draw.one(&[vec![circuit], vec![circuit, end]]),
            path: vec![(throat, at(last, track))],
            overlap: ("", String::new()),
            beyond: "E1",
            continuing: vec![],
            conflicts: vec![inward.clone()],
            from: &[],
            to: &["East"],
        });
        if long {
            routes.push(Route {
                name: inward,
                heading: "left",
                approach: draw.one(&[vec![circuit], vec![circuit, "D"]]),
                path: vec![("C", at("P3", track)), ("M", String::new())],
                overlap: ("B", at("P2", middle)),
                beyond: "B",
                continuing: vec!["M-1".to_owned(), "M-2".to_owned()],
                conflicts: vec![format!("{track}-E")],
                from: &[],
                to: &[],
            });
            routes.push(Route {
                name: format!("M-{track}"),
                heading: "right",
                approach: draw.one(&[vec!["M"], vec!["M", "B"]]),
                path: vec![("C", at("P3", track)), (circuit, String::new())],
                overlap: ("D", at("P4", track)),
                beyond: "D",
                continuing: vec![format!("{track}-E")],
                conflicts: vec!["M-1".to_owned(), "M-2".to_owned()],
                from: &[],
                to: &[],
            });
        }
    }
    routes
}

/// One track of eight circuits with a signal at each: routes of one place, that may all be set before one train.
fn row(draw: &mut Draw) -> Plan {
    let circuits = ["C0", "C1", "C2", "C3", "C4", "C5", "C6", "C7"];
    let at = |circuit: &str| if circuit == "C4" { "P=normal".to_owned() } else { String::new() };
    let mut routes: Vec<Route> = (0..6)
        .map(|place| Route {
            name: format!("R{place}"),
            heading: "right",
            approach: circuits[place.max(1) - 1..=place].iter().rev().copied().collect(),
            path: vec![(circuits[place + 1], at(circuits[place + 1]))],
            overlap: (circuits[place + 2], at(circuits[place + 2])),
            beyond: circuits[place + 2],
            continuing: if place < 5 { vec![format!("R{}", place + 1)] } else { vec![] },
            conflicts: vec![],
            from: &[],
            to: &[],
        })
        .collect();
    routes.push(Route {
        name: "L".to_owned(),
        heading: "left",
        approach: vec!["C7"],
        path: vec![("C6", String::new()), ("C5", String::new())],
        overlap: ("C4", at("C4")),
        beyond: "C4",
        continuing: vec![],
        conflicts: vec![],
        from: &[],
        to: &[],
    });
    let way = own(&circuits);
    let back = way.iter().rev().cloned().collect();
    let overlaps = draw.chance(700);
    whole(draw, (&circuits, &[("P", "C4")], &[]), &routes, vec![way.clone(), way.clone(), way, back], overlaps)
}

fn own(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// With lengths and times that are drawn.
fn whole(
    draw: &mut Draw,
    (circuits, points, segments): (&[&str], &[(&str, &str)], &[Value]),
    routes: &[Route],
    ways: Vec<Vec<String>>,
    overlaps: bool,
) -> Plan {
    let cab = draw.from(0, 2);
    let lengths: Vec<Value> = circuits
        .iter()
        .map(|name| {
            let mut circuit = json!({"name": name, "length_m": draw.one(&[20, 60, 120, 300, 400, 800])});
            if draw.chance(200) {
                circuit["speed_code"] = draw.from(0, 7).into();
            }
            circuit
        })
        .collect();
    let detectors: Vec<Value> =
        points.iter().map(|(name, circuit)| json!({"name": name, "detectors": [circuit]})).collect();
    let onward = |route: &Route| {
        let this = vec![route.name.clone()];
        (route.name.clone(), if route.continuing.is_empty() { this } else { route.continuing.clone() })
    };
    Plan {
        json: json!({
            "station": "foreign", "cycle_ms": 1000, "clear_cycles": draw.from(1, 4),
            "settle_cycles": draw.one(&[0, 0, 1, 2, 3]), "start_cycles": draw.one(&[0, 0, 3, 7]),
            "turn_cycles": draw.from(1, 6), "speeds_km_h": [0, 15, 25, 45, 55, 65, 75, 90],
            "braking_m": draw.one(&[[0, 20, 50, 110, 160, 220, 290, 410], [0, 20, 50, 300, 700, 1200, 1700, 2500]]),
            "circuits": lengths, "points": detectors, "segments": segments,
            "routes": routes.iter().map(|route| {
                let own = draw.chance(500);
                // No route starts there against it.
                let starts = |other: &Route| other.heading != route.heading && other.approach[0] == route.overlap.0;
                let berth = !route.overlap.0.is_empty() && route.to.is_empty() && !routes.iter().any(starts);
                route.json(draw, (cab == 1 || (cab == 2 && own), overlaps, berth))
            }).collect::<Vec<_>>(),
        }),
        circuits: own(circuits),
        points: points.iter().map(|(name, _)| (*name).to_owned()).collect(),
        segments: segments.iter().filter_map(|segment| segment["name"].as_str()).map(ToOwned::to_owned).collect(),
        entries: routes.iter().map(|route| route.approach[0].to_owned()).collect(),
        onward: routes.iter().map(onward).collect(),
        routes: routes.iter().map(|route| route.name.clone()).collect(),
        ways,
    }
}

struct Point {
    stands: Option<&'static str>,
    goes: &'static str,
    left: i64,
}

struct Train {
    way: Vec<String>,
    front: usize,
    rear: usize,
}

struct Walk<'a> {
    plan: &'a Plan,
    points: BTreeMap<String, Point>,
    trains: Vec<Train>,
    falsely: BTreeMap<String, i64>,
    consent: BTreeSet<String>,
    /// Out of a thousand: false occupancy, orders, requests, obedience, points that do not arrive, sense.
    noise: i64,
    orders: i64,
    requests: i64,
    obeys: i64,
    stuck: i64,
    sense: i64,
    consents: i64,
}

impl<'a> Walk<'a> {
    fn new(draw: &mut Draw, plan: &'a Plan) -> Self {
        let points = plan.points.iter().map(|name| {
            let stands = Some(draw.one(&["normal", "reverse"]));
            (name.clone(), Point { stands, goes: "normal", left: 0 })
        });
        Self {
            points: points.collect(),
            trains: Vec::new(),
            falsely: BTreeMap::new(),
            consent: BTreeSet::new(),
            noise: draw.one(&[0, 0, 2, 10, 50]),
            orders: draw.one(&[0, 2, 20, 100]),
            requests: draw.one(&[100, 300, 600]),
            obeys: draw.one(&[1000, 900, 500, 0]),
            stuck: draw.one(&[0, 0, 200]),
            sense: draw.one(&[0, 500, 900, 1000]),
            consents: draw.one(&[3, 20]),
            plan,
        }
    }

    fn move_points(&mut self, draw: &mut Draw, drives: &Map<String, Value>) {
        for (name, point) in &mut self.points {
            if let Some(to) = drives.get(name) {
                let to = if to == "normal" { "normal" } else { "reverse" };
                if draw.chance(self.stuck) {
                    point.stands = None;
                } else if point.left == 0 || point.goes != to {
                    (point.goes, point.left) = (to, draw.one(&[1, 1, 2, 3, 4]));
                }
            }
            if point.left > 0 {
                point.left -= 1;
                if point.left == 0 {
                    point.stands = Some(point.goes);
                } else if draw.chance(700) {
                    point.stands = None;
                }
            }
            if draw.chance(self.noise / 3) {
                point.stands = draw.one(&[None, Some("normal"), Some("reverse")]);
            }
        }
    }

    fn move_trains(&mut self, draw: &mut Draw, telegrams: &Map<String, Value>) {
        if self.trains.len() < 3 && draw.chance(60) {
            self.trains.push(Train { way: draw.one(&self.plan.ways), front: 0, rear: 0 });
        }
        let obeys = self.obeys;
        self.trains.retain_mut(|train| {
            if train.rear < train.front && draw.chance(500) {
                train.rear += 1;
            } else if draw.chance(400) {
                let last = train.front + 1 == train.way.len();
                let open = telegrams.get(&train.way[train.front]).is_some_and(|telegram| telegram["open"] == true);
                if last && train.rear == train.front {
                    return false;
                }
                if !last && (open || !draw.chance(obeys)) {
                    train.front += 1;
                }
            }
            true
        });
    }

    fn occupied(&mut self, draw: &mut Draw) -> BTreeSet<String> {
        for circuit in &self.plan.circuits {
            if let Some(left) = self.falsely.get_mut(circuit) {
                *left -= 1;
                if *left == 0 {
                    self.falsely.remove(circuit);
                }
            } else if draw.chance(self.noise) {
                self.falsely.insert(circuit.clone(), draw.one(&[1, 1, 2, 5, 20]));
            }
        }
        let trains = self.trains.iter().flat_map(|train| train.way[train.rear..=train.front].iter().cloned());
        let mut occupied: BTreeSet<String> = trains.chain(self.falsely.keys().cloned()).collect();
        if draw.chance(self.noise) {
            occupied.pop_first();
        }
        occupied
    }

    fn orders(&self, draw: &mut Draw) -> Value {
        let all = &self.plan.circuits;
        let one = |draw: &mut Draw| vec![draw.one(all)];
        let mut orders = json!({});
        if draw.chance(400) {
            orders["block"] = one(draw).into();
        }
        if draw.chance(700) {
            orders["unblock"] = if draw.chance(500) { all.clone() } else { one(draw) }.into();
        }
        if draw.chance(200) {
            let speed = draw.one(&[0, 5, 25, 30, 90]);
            let circuits = [draw.one(all), draw.one(all)];
            orders["restrict"] =
                circuits.into_iter().map(|circuit| (circuit, Value::from(speed))).collect::<Map<_, _>>().into();
        }
        if draw.chance(600) {
            orders["lift"] = if draw.chance(500) { all.clone() } else { one(draw) }.into();
        }
        orders
    }

    fn request(&self, draw: &mut Draw, occupied: &BTreeSet<String>, output: &Value) -> Value {
        let held = output["routes"].as_object().cloned().unwrap_or_default();
        let mut segment = "none".to_owned();
        if !self.plan.segments.is_empty() {
            segment = draw.one(&self.plan.segments);
        }
        if draw.chance(self.sense) {
            let permitted =
                output["permits"].as_array().is_some_and(|names| names.iter().any(|name| *name == *segment));
            if !self.plan.segments.is_empty() && draw.chance(300) && (self.consent.contains(&segment) || !permitted) {
                let to = if self.consent.contains(&segment) { "away" } else { "toward" };
                return json!({"turn": segment, "to": to});
            }
            if let Some((route, _)) =
                held.iter().find(|(_, phase)| *phase == "failed" || (*phase == "set" && draw.chance(50)))
                && draw.chance(500)
            {
                return json!({ "withdraw": route });
            }
            if let Some(route) = held.keys().nth(usize::try_from(draw.from(0, 2)).expect("small")) {
                // What a train will need next.
                if draw.chance(500) {
                    return json!({ "set": draw.one(&self.plan.onward[route]) });
                }
            }
            let routes = self.plan.routes.iter().zip(&self.plan.entries);
            let waiting: Vec<&String> = routes
                .filter(|(route, entry)| occupied.contains(*entry) && !held.contains_key(*route))
                .map(|(route, _)| route)
                .collect();
            if !waiting.is_empty() {
                return json!({ "set": draw.one(&waiting) });
            }
        }
        let names: Vec<&String> = held.keys().collect();
        match draw.from(0, 99) {
            0..45 => json!({ "set": draw.one(&self.plan.routes) }),
            45..50 if !names.is_empty() => json!({ "set": draw.one(&names) }),
            50..60 if !names.is_empty() => json!({ "withdraw": draw.one(&names) }),
            45..63 => json!({ "withdraw": draw.one(&self.plan.routes) }),
            63..75 => json!({"drive": draw.one(&self.plan.points), "to": draw.one(&["normal", "reverse"])}),
            75..99 => json!({"turn": segment, "to": draw.one(&["toward", "away"])}),
            _ => draw.one(&[
                json!({"set": "none"}),
                json!({"turn": "West", "to": "left"}),
                json!({"set": "W-1", "to": 1}),
            ]),
        }
    }

    fn step(&mut self, draw: &mut Draw, first: bool, output: &Value) -> Value {
        let empty = Map::new();
        self.move_points(draw, output["drives"].as_object().unwrap_or(&empty));
        self.move_trains(draw, output["telegrams"].as_object().unwrap_or(&empty));
        let occupied = self.occupied(draw);
        for segment in &self.plan.segments {
            if draw.chance(self.consents) && !self.consent.remove(segment) {
                self.consent.insert(segment.clone());
            }
        }
        let detected = self.points.iter().map(|(name, point)| (name.clone(), Value::from(point.stands)));
        let mut input =
            json!({"occupied": occupied, "detected": detected.collect::<Map<_, _>>(), "consent": self.consent});
        if draw.chance(50) {
            input["all_telegrams"] = true.into();
        }
        if first {
            input["orders"] = json!({"unblock": self.plan.circuits, "lift": self.plan.circuits});
        } else if draw.chance(self.orders) {
            input["orders"] = self.orders(draw);
        }
        if draw.chance(self.requests) {
            input["request"] = self.request(draw, &occupied, output);
        }
        input
    }
}

/// The requests and the oracle's replies.
/// Circuits of other routes beside those of some, as where a joint is too near to a point.
fn beside(draw: &mut Draw, plan: &mut Value) {
    let places = |route: &Value| -> Vec<Value> {
        let path = route["path"].as_array().into_iter().flatten().chain([&route["overlap"]]);
        path.flat_map(|at| at["circuits"].as_array().cloned().unwrap_or_default()).collect()
    };
    let all: Vec<Value> = plan["routes"].as_array().into_iter().flatten().flat_map(places).collect();
    for route in plan["routes"].as_array_mut().into_iter().flatten() {
        let mut own = places(route);
        own.extend(route["entry"].as_array().cloned().unwrap_or_default());
        let others: Vec<&Value> = all.iter().filter(|circuit| !own.contains(circuit)).collect();
        if others.is_empty() || draw.chance(600) {
            continue;
        }
        let last = route["path"].as_array().map_or(0, Vec::len);
        let place = usize::try_from(draw.from(0, i64::try_from(last).expect("a few"))).expect("a few");
        let at = if place < last { &mut route["path"][place] } else { &mut route["overlap"] };
        at["beside"] = json!([draw.one(&others)]);
    }
}

pub fn interlocking(seed: u64, steps: usize, oracle: Command) -> (Vec<String>, Vec<String>) {
    let mut draw = Draw::new(seed);
    let mut asked = Asked::new(oracle);
    let mut lines = small::malformed();
    let mut replies: Vec<String> = lines.iter().map(|line| asked.ask(line)).collect();
    while lines.len() < steps {
        let mut plan = match draw.from(0, 9) {
            0..4 => plan(&mut draw, true),
            4..7 => plan(&mut draw, false),
            _ => row(&mut draw),
        };
        if draw.chance(300) {
            beside(&mut draw, &mut plan.json);
        }
        let start =
            json!({"start": {"protocol": 1, "machine": "interlocking", "config": {"plan": plan.json}}}).to_string();
        let reply = asked.ask(&start);
        assert!(reply.starts_with(r#"{"started""#), "{reply}\n{start}");
        lines.push(start);
        replies.push(reply);
        let mut walk = Walk::new(&mut draw, &plan);
        let begins = draw.one(&[0, 0, 1, 8]);
        let mut output = json!({});
        for cycle in 0..500 {
            let step = json!({ "step": walk.step(&mut draw, cycle == begins, &output) }).to_string();
            let reply = asked.ask(&step);
            output = serde_json::from_str::<Value>(&reply).expect("JSON")["output"].take();
            lines.push(step);
            replies.push(reply);
        }
        replies.push(asked.ask(r#"{"stop":{}}"#));
        lines.push(r#"{"stop":{}}"#.to_owned());
    }
    (lines, replies)
}
