//! Stations whose times are a few cycles: a layout's plan in the kernel's own terms, with other times. On a layout as a line has it a
//! train takes hundreds of cycles, and so would every trace.

use atc_kernel::interlocking::{Element, Heading, SegmentSet};
use serde_json::{Value, json};

use super::station::{circuits, points, routes};
use atc_protocol::machine::Machine as _;
use atc_protocol::machine::interlocking::{Config, Interlocked};

/// Times in cycles.
#[derive(Clone, Copy)]
pub(super) struct Times {
    pub(super) clear: u8,
    pub(super) turn: u16,
    pub(super) start: u16,
    pub(super) settle: u8,
    pub(super) loss: u8,
    pub(super) residual: u16,
    pub(super) standstill: u16,
    pub(super) drive: u16,
    pub(super) release: u16,
    pub(super) stay: u16,
}

/// The layout of a file as the body of a configuration.
pub(super) fn layout(toml: &str) -> Value {
    toml::from_str(toml).unwrap_or_default()
}

/// The plan of a layout with these times; null if the kernel does not take the layout.
pub(super) fn with_times(layout: &Value, times: Times) -> Value {
    let config = serde_json::from_value::<Config>(layout.clone());
    let machine = config.ok().and_then(|config| Interlocked::open(&config).ok());
    machine.map(|machine| plan(&machine, times)).unwrap_or_default()
}

fn plan(machine: &Interlocked, times: Times) -> Value {
    let (plan, names) = (machine.layout().plan(), machine.names());
    let named = |all: &[String], numbers: Vec<usize>| -> Vec<String> {
        numbers.into_iter().filter_map(|number| all.get(number).cloned()).collect()
    };
    let of_circuits = |set| named(&names.circuits, circuits(set));
    let segments_of =
        |set: SegmentSet| named(&names.segments, (0..8).filter(|number| set.meets(SegmentSet::nth(*number))).collect());
    let element = |element: &Element| {
        let mut at = serde_json::Map::new();
        for (side, set) in [("normal", element.positions.normal), ("reverse", element.positions.reverse)] {
            at.extend(named(&names.points, points(set)).into_iter().map(|point| (point, side.into())));
        }
        let mut form = json!({"circuits": of_circuits(element.circuits), "points": at});
        if !element.beside.is_empty() {
            form["beside"] = of_circuits(element.beside).into();
        }
        form
    };
    let circuit_forms = names.circuits.iter().zip(&plan.lengths);
    let point_forms = names.points.iter().zip(&plan.points);
    let segment_forms = names.segments.iter().zip(&plan.segments);
    let route_forms = names.routes.iter().zip(&plan.routes);
    json!({"plan": {
        "station": names.station, "cycle_ms": 1000,
        "clear_cycles": times.clear, "turn_cycles": times.turn, "start_cycles": times.start,
        "settle_cycles": times.settle, "loss_cycles": times.loss, "residual_cycles": times.residual,
        "standstill_cycles": times.standstill,
        "speeds_km_h": [0, 15, 25, 45, 55, 65, 75, 90],
        "braking_m": plan.braking.iter().map(|braking| braking.0).collect::<Vec<_>>(),
        "circuits": circuit_forms.map(|(name, length)| json!({"name": name, "length_m": length.0})).collect::<Vec<_>>(),
        "points": point_forms
            .map(|(name, point)| json!({"name": name, "detectors": of_circuits(point.detectors)}))
            .collect::<Vec<_>>(),
        "segments": segment_forms.map(|(name, segment)| json!({
            "name": name,
            "circuits": segment.circuits.iter().take(segment.length.into()).flat_map(|set| of_circuits(*set))
                .collect::<Vec<_>>(),
            "throat": of_circuits(segment.throat), "outward": heading(segment.outward), "shared": segment.shared,
        })).collect::<Vec<_>>(),
        "routes": route_forms.map(|(name, route)| json!({
            "name": name, "heading": heading(route.heading),
            "entry": of_circuits(route.entry), "approach": of_circuits(route.approach),
            "path": route.path.iter().take(route.length.into()).map(element).collect::<Vec<_>>(),
            "overlap": element(&route.overlap), "beyond": of_circuits(route.beyond),
            "continuing": named(&names.routes, routes(route.continuing)),
            "conflicts": named(&names.routes, routes(route.conflicts)),
            "from": segments_of(route.from), "to": segments_of(route.to),
            "drive_cycles": times.drive, "release_cycles": times.release, "stay_cycles": times.stay,
            "speed_code": route.speed.0, "overlap_speed_code": route.overlap_speed.0, "cab_signalled": route.cab_signalled,
        })).collect::<Vec<_>>(),
    }})
}

const fn heading(heading: Heading) -> &'static str {
    match heading {
        Heading::Left => "left",
        Heading::Right => "right",
    }
}
