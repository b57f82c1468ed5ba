//! A find as a trace for `oracle explore --as-recorded`, in the form of the models' traces: what the device read and
//! said in each cycle, and what was true on the ground.

use atc_kernel::interlocking::Refusal;
use atc_layout::Description;
use atc_protocol::machine::interlocking::{Phase, Reason};
use serde_json::{Map, Value, json};

use super::device::{Ask, Device, Read, Said};
use super::ground::{Ground, Mask, members};
use super::hunt::Find;
use super::moves::Move;
use super::train::Train;
use super::world::World;

/// The trace of a find, from the device's last start up to its accident.
///
/// # Errors
/// A layout that cannot be written.
pub fn of(device: &mut dyn Device, ground: &Ground, description: &Description, find: &Find) -> Result<Value, String> {
    let config = serde_json::to_value(&description.station).map_err(|error| format!("the layout: {error}"))?;
    let mut world = World::new(ground, find.scenario.setting);
    device.restart();
    let (mut at, mut steps) = (0, Vec::new());
    while world.truth.now <= find.accident.cycle {
        let now = world.truth.now;
        let from = at;
        while find.scenario.moves.get(at).is_some_and(|(cycle, _)| *cycle == now) {
            at += 1;
        }
        let moves: Vec<Move> = find.scenario.moves[from..at].iter().map(|(_, it)| *it).collect();
        if moves.contains(&Move::Restart) {
            // What the device remembered is lost: it is as if it began here.
            steps.clear();
        }
        world.cycle(device, &moves, &[]);
        let mut words = truth(&world);
        if !moves.is_empty() {
            let told: Vec<String> = moves.iter().map(|it| it.words(ground)).collect();
            words.insert("what happens".to_owned(), json!(told.join("; ")));
        }
        let harm = if now == find.accident.cycle { find.accident.text.as_str() } else { "none" };
        words.insert("harm".to_owned(), json!(harm));
        let output = output(device, ground, world.read(), &world.said);
        steps.push(json!({"input": input(ground, world.read()), "output": output, "words": words}));
    }
    let title = format!("{}: {}", ground.name, find.accident.family.name());
    Ok(json!({"title": title, "machine": "interlocking", "config": config, "steps": steps}))
}

fn circuits(ground: &Ground, mask: Mask) -> Vec<&str> {
    members(mask).filter(|circuit| *circuit < ground.seen).map(|circuit| ground.circuits[circuit].as_str()).collect()
}

fn lines(ground: &Ground, set: u8) -> Vec<&str> {
    let lines = ground.lines.iter().enumerate();
    lines.filter(|(number, _)| set >> number & 1 == 1).map(|(_, line)| line.name.as_str()).collect()
}

fn positions(ground: &Ground, [normal, reverse]: [u64; 2]) -> Value {
    let side = |number: usize| match (normal >> number & 1, reverse >> number & 1) {
        (1, 0) => Some("normal"),
        (0, 1) => Some("reverse"),
        _ => None,
    };
    let points = ground.points.iter().enumerate();
    Value::Object(points.filter_map(|(number, name)| Some((name.clone(), json!(side(number)?)))).collect())
}

/// A speed in km/h.
const fn km_h(mm_s: i64) -> i64 {
    (mm_s * 36 + 5_000) / 10_000
}

fn input(ground: &Ground, read: &Read) -> Value {
    let route = |number: usize| ground.routes[number].name.as_str();
    let request = match read.ask {
        None => Value::Null,
        Some(Ask::Set(number)) => json!({"set": route(number)}),
        Some(Ask::Withdraw(number)) => json!({"withdraw": route(number)}),
        Some(Ask::Drive(point, reverse)) => {
            json!({"drive": ground.points[point], "to": if reverse { "reverse" } else { "normal" }})
        }
        Some(Ask::Turn(line, away)) => {
            json!({"turn": ground.lines[line].name, "to": if away { "away" } else { "toward" }})
        }
    };
    let commands = &read.commands;
    let (restricted, code) = commands.restrict;
    let speed = km_h(ground.codes[usize::from(code)]);
    let restrict: Map<String, Value> =
        circuits(ground, restricted).into_iter().map(|name| (name.to_owned(), json!(speed))).collect();
    json!({
        "occupied": circuits(ground, read.occupied),
        "detected": positions(ground, read.detected),
        "request": request,
        "orders": {
            "block": circuits(ground, commands.block),
            "unblock": circuits(ground, commands.unblock),
            "restrict": restrict,
            "lift": circuits(ground, commands.lift),
        },
        "consent": lines(ground, read.consent),
    })
}

fn output(device: &dyn Device, ground: &Ground, read: &Read, said: &Said) -> Value {
    let phases = device.phases().into_iter();
    let phases: Map<String, Value> =
        phases.map(|(route, phase)| (ground.routes[route].name.clone(), json!(Phase(phase)))).collect();
    let routes = ground.routes.iter().enumerate();
    let proceed: Vec<&str> =
        routes.filter(|(number, _)| said.proceed >> number & 1 == 1).map(|(_, route)| route.name.as_str()).collect();
    let mut telegrams = Map::new();
    for circuit in 0..ground.seen {
        let told = device.telegram(circuit);
        if let Some(right) = told.right {
            let heading = if right { "right" } else { "left" };
            let speed = km_h(ground.codes[usize::from(told.code)]);
            let telegram =
                json!({"stop": ground.circuits[told.stop], "speed_km_h": speed, "open": true, "heading": heading});
            telegrams.insert(ground.circuits[circuit].clone(), telegram);
        }
    }
    let answer = match (read.ask, said.done, said.refused) {
        (None, ..) => Value::Null,
        (Some(_), true, _) => json!("accepted"),
        (Some(_), false, refusal) => {
            json!({"refused": Reason(refusal.unwrap_or(Refusal::Unknown))})
        }
    };
    json!({
        "routes": phases,
        "proceed": proceed,
        "drives": positions(ground, said.drives),
        "telegrams": telegrams,
        "permits": lines(ground, said.permits),
        "confirmed": circuits(ground, said.confirmed),
        "answer": answer,
    })
}

/// Trains and points as they are.
fn truth(world: &World<'_>) -> Map<String, Value> {
    let ground = world.ground;
    let mut words = Map::new();
    let place = |number: usize| match world.trains.iter().find(|train| train.number == number) {
        Some(train) => placed(ground, train),
        None => json!("gone"),
    };
    words.insert("trains".to_owned(), (1..=world.arrived()).map(place).collect());
    for (number, name) in ground.points.iter().enumerate() {
        let lies = match (world.points.rests(number, false), world.points.rests(number, true)) {
            (true, _) => "normal",
            (false, true) => "reverse",
            (false, false) => "moves",
        };
        words.insert(format!("{name} lies"), json!(lies));
    }
    words
}

/// Where a train is: its circuits, and the pieces under it from the rear to the front.
fn placed(ground: &Ground, train: &Train) -> Value {
    let circuit = |piece: usize| ground.circuits[ground.pieces[piece].circuit].as_str();
    let mut parts: Vec<_> = train.parts().map(|(leg, begin, end)| (*leg, begin, end)).collect();
    parts.reverse();
    let on: Vec<String> = parts
        .iter()
        .map(|(leg, ..)| {
            let joints = &ground.pieces[leg.piece].joints;
            let reverse = joints.get(2).is_some_and(|joint| leg.enter == *joint || leg.exit == *joint);
            let way = if joints.first() == Some(&leg.enter) { '+' } else { '-' };
            format!("{}{}{way}", leg.piece, if reverse { "r" } else { "" })
        })
        .collect();
    let share = |at: i64, length: i64| (at * 1000 / length.max(1)).clamp(0, 1000);
    let (Some((rear, begin, _)), Some((front, _, end))) = (parts.first(), parts.last()) else { return json!("gone") };
    json!({
        "name": train.number.to_string(),
        "front": circuit(front.piece),
        "rear": circuit(rear.piece),
        "heading": if ground.faces_right(&train.front()) { "right" } else { "left" },
        "on": on.join(" "),
        "front_share": share(*end, front.length),
        "rear_share": share(*begin, rear.length),
        "speed_km_h": km_h(train.speed),
    })
}
