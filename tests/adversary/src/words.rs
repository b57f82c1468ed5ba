//! A find in the words of the railway: the moves, what the ground was like, the accident, the conditions.

use std::fmt::Write as _;

use super::conditions::conditions;
use super::device::Device;
use super::ground::{Ground, members};
use super::hunt::{Find, Scenario};
use super::moves::Move;
use super::world::World;

/// A find as a text of several lines.
pub fn tell(device: &mut dyn Device, ground: &Ground, find: &Find) -> String {
    let mut text = String::new();
    let setting = find.scenario.setting;
    let view = if setting.manner.overlaps { "see the whole line" } else { "see what lies beyond the border" };
    let _ = writeln!(text, "{}: {} (episode seed {:#x})", ground.name, find.accident.family.name(), find.seed);
    let _ = writeln!(
        text,
        "  a cycle is {} ms; points take {} % of the longest stroke; neighbours {view}, and their consent comes {} cycles late",
        ground.cycle_ms, setting.throw_percent, setting.manner.late
    );
    for line in story(device, ground, &find.scenario, find.accident.cycle) {
        let _ = writeln!(text, "  {line}");
    }
    let _ = writeln!(text, "  cycle {}: ACCIDENT: {}", find.accident.cycle, find.accident.text);
    let held: Vec<String> = conditions(ground, &find.measured)
        .into_iter()
        .map(|(name, held)| format!("{name} {}", if held { "held" } else { "BROKEN" }))
        .collect();
    let _ = writeln!(text, "  conditions: {}", held.join(", "));
    text
}

/// What happens: the moves, and where trains and points are when they come.
fn story(device: &mut dyn Device, ground: &Ground, scenario: &Scenario, last: i64) -> Vec<String> {
    let mut lines = Vec::new();
    let mut world = World::new(ground, scenario.setting);
    device.restart();
    let mut at = 0;
    let mut before = state(&world);
    while world.truth.now <= last {
        let now = world.truth.now;
        let from = at;
        while scenario.moves.get(at).is_some_and(|(cycle, _)| *cycle == now) {
            at += 1;
        }
        let moves: Vec<Move> = scenario.moves[from..at].iter().map(|(_, it)| *it).collect();
        for it in &moves {
            lines.push(format!("cycle {now}: {}", it.words(ground)));
        }
        world.cycle(device, &moves, &[]);
        for it in &moves {
            if matches!(it, Move::Ask(_)) && !world.said.done {
                lines.push(format!("cycle {now}:     refused"));
            }
        }
        let after = state(&world);
        if after != before || now == last {
            lines.push(format!("cycle {now}:     {}", truth(&world)));
        }
        before = after;
    }
    lines
}

/// What makes a line of its own worth it: the circuits under each train, the signals, the detected points.
fn state(world: &World) -> (Vec<u128>, u128, [u64; 2]) {
    let under = world.trains.iter().map(|train| train.under).collect();
    (under, world.said.proceed, world.points.detected())
}

fn truth(world: &World) -> String {
    let ground = world.ground;
    let mut parts = Vec::new();
    for train in &world.trains {
        let kmh = train.speed * 36 / 10_000;
        let under = members(train.under).map(|circuit| ground.circuits[circuit].as_str()).collect::<Vec<_>>().join("+");
        let front = &ground.circuits[train.front_circuit(ground)];
        let mut part = format!(
            "train {} on {under}, front {} m before the end of {front}, {kmh} km/h",
            train.number,
            train.to_joint() / 1000
        );
        if train.authority != 0 {
            part.extend([", may enter ", &ground.named(train.authority)]);
        }
        parts.push(part);
    }
    let detected = world.points.detected();
    for (number, name) in ground.points.iter().enumerate() {
        let is = match (detected[0] >> number & 1, detected[1] >> number & 1) {
            (1, _) => continue,
            (_, 1) => "reverse",
            _ => "moves or is not detected",
        };
        parts.push(format!("{name} {is}"));
    }
    let proceed: Vec<&str> = (0..ground.routes.len())
        .filter(|route| world.said.proceed >> route & 1 == 1)
        .map(|route| ground.routes[route].name.as_str())
        .collect();
    if !proceed.is_empty() {
        parts.push(format!("proceed {}", proceed.join(", ")));
    }
    parts.join("; ")
}
