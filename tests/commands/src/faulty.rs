//! Implementations with one rule broken each, for the conformance kit to find: the kernel behind the protocol, with a wrapper that
//! changes a configuration, a step or an output.

use atc_protocol::Session;
use serde_json::{Value, json};

/// What a wrapper remembers of a case.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    /// The configuration as the client gave it.
    pub config: Value,
    /// The last step as the client gave it.
    pub step: Value,
    /// The last output as it was told.
    pub output: Value,
    /// A number for the fault's own use.
    pub count: u64,
}

/// A fault.
pub struct Fault {
    /// Its name.
    pub name: &'static str,
    /// The machine that it is in.
    pub machine: &'static str,
    /// The requirement that it breaks.
    pub requirement: &'static str,
    /// What becomes of a configuration.
    pub config: fn(&mut Value),
    /// What becomes of a step.
    pub step: fn(&mut Memory, &mut Value),
    /// What becomes of an output.
    pub output: fn(&mut Memory, &mut Value),
}

const fn config(name: &'static str, machine: &'static str, requirement: &'static str, config: fn(&mut Value)) -> Fault {
    Fault { name, machine, requirement, config, step: |_, _| (), output: |_, _| () }
}

const fn step(
    name: &'static str,
    machine: &'static str,
    requirement: &'static str,
    step: fn(&mut Memory, &mut Value),
) -> Fault {
    Fault { name, machine, requirement, config: |_| (), step, output: |_, _| () }
}

const fn output(
    name: &'static str,
    machine: &'static str,
    requirement: &'static str,
    output: fn(&mut Memory, &mut Value),
) -> Fault {
    Fault { name, machine, requirement, config: |_| (), step: |_, _| (), output }
}

/// Adds so many units to a number, which has a default; not below 0.
fn add(config: &mut Value, field: &str, default: i64, number: i64) {
    let now = config.get(field).and_then(Value::as_i64).unwrap_or(default);
    config[field] = (now + number).max(0).into();
}

/// Adds so many cycles to a time.
fn cycles(config: &mut Value, field: &str, default: i64, number: i64) {
    let cycle = config.get("cycle_ms").and_then(Value::as_i64).unwrap_or(10);
    add(config, field, default, number * cycle);
}

/// Changes a plan; a layout stays as it is.
fn plan(config: &mut Value, change: fn(&mut Value)) {
    if let Some(plan) = config.get_mut("plan") {
        change(plan);
    }
}

fn routes(config: &mut Value, change: fn(&mut Value)) {
    if let Some(Value::Array(routes)) = config.get_mut("plan").and_then(|plan| plan.get_mut("routes")) {
        routes.iter_mut().for_each(change);
    }
}

fn swap(value: &mut Value, one: &str, other: &str) {
    if value == one {
        *value = other.into();
    } else if value == other {
        *value = one.into();
    }
}

const ASPECT: &str = "aspect-acceptance";
const SUPERVISION: &str = "speed-supervision";
const BLOCK: &str = "block-count";
const TELEGRAM: &str = "telegram-codec";
const PATTERN: &str = "braking-pattern";
const PERMITTED: &str = "permitted-speed";
const POSITION: &str = "train-position";
const INTERLOCKING: &str = "interlocking";
const WAYSIDE: &str = "wayside";

/// Every fault.
pub const FAULTS: &[Fault] = &[
    config("operate-short", ASPECT, "ACC-1", |config| cycles(config, "operate_ms", 300, -1)),
    config("operate-long", ASPECT, "ACC-1", |config| cycles(config, "operate_ms", 300, 1)),
    config("shortened-short", ASPECT, "ACC-8", |config| cycles(config, "shortened_operate_ms", 100, -1)),
    config("interruption-strict", ASPECT, "ACC-8", |config| cycles(config, "interruption_ms", 800, -1)),
    config("interruption-long", ASPECT, "ACC-8", |config| cycles(config, "interruption_ms", 800, 1)),
    config("recovery-long", ASPECT, "ACC-4", |config| {
        cycles(config, "recovery_ms", 400, 1);
        cycles(config, "mask_ms", 400, -1);
    }),
    config("expiry-late", ASPECT, "ACC-6", |config| cycles(config, "mask_ms", 400, 1)),
    config("recovery-rounded-up", ASPECT, "TIME-1", |config| {
        let cycle = config["cycle_ms"].as_i64().unwrap_or(10).max(1);
        let recovery = config["recovery_ms"].as_i64().unwrap_or(400);
        config["recovery_ms"] = ((recovery + cycle - 1) / cycle * cycle).into();
    }),
    step("gap-of-one-not-heard", ASPECT, "ACC-1", |memory, step| {
        // What was heard in the cycle before counts as heard.
        let before = memory.step["detected_km_h"].as_array().cloned().unwrap_or_default();
        if let Some(now) = step.get_mut("detected_km_h").and_then(Value::as_array_mut) {
            now.extend(before.into_iter().filter(|speed| !now.contains(speed)).collect::<Vec<_>>());
        }
    }),
    output("display-held", ASPECT, "ACC-3", |memory, output| {
        let before = memory.output["display_km_h"].clone();
        if output["display_km_h"].is_null() && memory.count == 0 && !before.is_null() {
            output["display_km_h"] = before;
            memory.count = 1;
        } else {
            memory.count = 0;
        }
    }),
    output("brake-at-equal", SUPERVISION, "SUP-1", |memory, output| {
        if memory.step["speed_km_h"] == memory.step["permitted_km_h"] && output["brake"] == "release" {
            output["brake"] = "service".into();
        }
    }),
    config("margin-ignored", SUPERVISION, "SUP-1", |config| config["release_margin_km_h"] = 0.into()),
    config("maximum-doubled", SUPERVISION, "SUP-2", |config| {
        let maximum = config.get("maximum_km_h").and_then(Value::as_f64).unwrap_or(400.0);
        config["maximum_km_h"] = (maximum.trunc() * 2.0).clamp(1.0, 6553.0).into();
    }),
    output("missing-speed-is-service", SUPERVISION, "SUP-2", |memory, output| {
        if memory.step["speed_km_h"].is_null() {
            output["brake"] = "service".into();
        }
    }),
    step("previous-ignored", SUPERVISION, "SUP-1", |_, step| {
        step.as_object_mut().map(|step| step.remove("previous"));
    }),
    config("pass-late", BLOCK, "BLK-3", |config| cycles(config, "pass_ms", 10_000, 1)),
    config("hold-short", BLOCK, "BLK-5", |config| add(config, "tail_hold_sections", 0, -1)),
    config("one-train-more", BLOCK, "BLK-3", |config| {
        if config["max_trains"].as_i64() < config["sections"].as_i64() {
            add(config, "max_trains", 1, 1);
        }
    }),
    step("takes-effect-at-once", BLOCK, "BLK-6", |_, step| step["ahead_entered"] = true.into()),
    step("reset-trusts-detectors", BLOCK, "BLK-4", |_, step| {
        if !step["reset"].is_null() {
            step["reset"] = step["present"].as_array().map_or(0, Vec::len).into();
        }
    }),
    step("hold-ahead-ignored", BLOCK, "BLK-5", |_, step| step["ahead_hold_sections"] = 0.into()),
    step("edges-cancel", BLOCK, "BLK-7", |memory, step| {
        let rises = |name: &str| step[name] == true && memory.step[name] != true;
        if rises("check_in") && rises("check_out") {
            step["check_in"] = false.into();
            step["check_out"] = false.into();
        }
    }),
    output("fault-words", BLOCK, "BLK-3", |_, output| {
        swap(&mut output["fault"], "check-out-at-zero", "check-in-at-maximum");
    }),
    step("gap-is-a-zero", TELEGRAM, "TEL-5", |_, step| {
        if let Some(bits) = step["bits"].as_str() {
            *step = json!({"bits": bits.replace('.', "0")});
        }
    }),
    output("bit-times-of-bits", TELEGRAM, "TEL-5", |memory, output| {
        let gaps = memory.step["bits"].as_str().map_or(0, |bits| bits.matches('.').count());
        memory.count += gaps as u64;
        for found in output.get_mut("telegrams").and_then(Value::as_array_mut).into_iter().flatten() {
            found["last_bit"] = found["last_bit"].as_u64().map(|bit| bit.saturating_sub(memory.count)).into();
        }
    }),
    step("bits-behind-the-first-corrected", TELEGRAM, "TEL-2", |_, step| {
        // The synchronisation word is put right.
        if let Some(bits) = step["decode"].as_str().filter(|bits| bits.len() == 106) {
            *step = json!({"decode": format!("0111111111111110{}", &bits[16..])});
        }
    }),
    output("error-words", TELEGRAM, "TEL-4", |_, output| {
        if let Some(error) = output.get_mut("error") {
            swap(error, "check", "content");
        }
    }),
    output("rounded-up", PATTERN, "PAT-1", |memory, output| {
        if memory.step["distance_m"].as_i64().unwrap_or(0) % 7 == 3
            && let Some(speed) = output["speed_km_h"].as_f64()
        {
            output["speed_km_h"] = ((speed * 10.0).round() / 10.0 + 0.1).into();
        }
    }),
    step("gradient-cut-off", PATTERN, "PAT-2", |_, step| {
        if let Some(gradient) = step["gradient_permille"].as_i64() {
            step["gradient_permille"] = gradient.max(-100).into();
        }
    }),
    config("fresh-late", PERMITTED, "PER-1", |config| cycles(config, "fresh_ms", 2200, 1)),
    config("life-late", PERMITTED, "PER-8", |config| cycles(config, "life_ms", 5000, 1)),
    config("fixed-life-late", PERMITTED, "PER-8", |config| cycles(config, "fixed_life_ms", 10_000, 1)),
    config("memory-short", PERMITTED, "TEL-6", |config| {
        if config["memory_ms"].as_i64() >= Some(20) {
            cycles(config, "memory_ms", 2000, -1);
        }
    }),
    config("window-wide", PERMITTED, "TEL-6", |config| {
        if config["window"].as_i64() < Some(127) {
            add(config, "window", 3, 1);
        }
    }),
    config("run-of-one", PERMITTED, "TEL-6", |config| config["run"] = 1.into()),
    config("level-assumed", PERMITTED, "PER-5", |config| config["worst_gradient_permille"] = 0.into()),
    step("movement-ignored", PERMITTED, "PER-4", |_, step| step["moved_m"] = 0.into()),
    step("fix-ignored", PERMITTED, "PER-10", |_, step| {
        step.as_object_mut().map(|step| step.remove("to_exit_m"));
    }),
    config("tolerance-ignored", POSITION, "POS-1", |config| config["tolerance_db"] = 0.into()),
    config("floor-ignored", POSITION, "POS-2", |config| config["floor_db"] = (-300).into()),
    config("correction-ignored", POSITION, "POS-1", |config| config["correction_db"] = json!([0, 0])),
    step("odometer-ignored", POSITION, "POS-4", |_, step| step["moved_m"] = json!([-32.768, 32.767])),
    output("rounded-inwards", POSITION, "POS-3", |_, output| {
        if let Some(far) = output["interval_m"][1].as_f64().filter(|far| *far >= 1.0) {
            output["interval_m"][1] = ((far * 1000.0).round() / 1000.0 - 0.001).into();
        }
    }),
    config("clear-early", INTERLOCKING, "TRK-1", |config| {
        plan(config, |plan| {
            if plan["clear_cycles"].as_i64() > plan["loss_cycles"].as_i64().map(|loss| loss + 1) {
                add(plan, "clear_cycles", 1, -1);
            }
        });
    }),
    // What shows first: a train that stood in its route before the start keeps no overlap.
    config("overlap-not-held", INTERLOCKING, "ILK-28", |config| {
        routes(config, |route| route["overlap"] = json!({"circuits": [], "points": {}}));
    }),
    config("release-early", INTERLOCKING, "ILK-13", |config| {
        routes(config, |route| add(route, "release_cycles", 1, -1));
    }),
    config("drive-long", INTERLOCKING, "ILK-5", |config| routes(config, |route| add(route, "drive_cycles", 1, 1))),
    config("not-settled", INTERLOCKING, "ILK-23", |config| plan(config, |plan| plan["settle_cycles"] = 0.into())),
    config("no-start-time", INTERLOCKING, "ILK-24", |config| plan(config, |plan| plan["start_cycles"] = 0.into())),
    config("turn-long", INTERLOCKING, "ILK-19", |config| plan(config, |plan| add(plan, "turn_cycles", 1, 1))),
    step("consent-taken", INTERLOCKING, "ILK-26", |memory, step| {
        let config = memory.config.get("plan").map_or(&memory.config["segment"], |plan| &plan["segments"]);
        let names = config.as_array().into_iter().flatten().map(|segment| segment["name"].clone());
        step["consent"] = names.collect();
    }),
    step("blocks-ignored", INTERLOCKING, "ILK-15", |_, step| {
        if let Some(orders) = step.get_mut("orders").and_then(Value::as_object_mut) {
            orders.remove("block");
        }
    }),
    step("restrictions-ignored", INTERLOCKING, "ILK-15", |_, step| {
        if let Some(orders) = step.get_mut("orders").and_then(Value::as_object_mut) {
            orders.remove("restrict");
        }
    }),
    output("refusal-words", INTERLOCKING, "ILK-1", |_, output| {
        if output["answer"].get("refused").is_some() {
            swap(&mut output["answer"]["refused"], "occupied", "path-held");
        }
    }),
    output("heading-turned", INTERLOCKING, "ATC-10", |_, output| {
        for telegram in output.get_mut("telegrams").and_then(Value::as_object_mut).into_iter().flatten() {
            swap(&mut telegram.1["heading"], "left", "right");
        }
    }),
    step("answers-never-age", WAYSIDE, "WAY-8", |memory, step| {
        for (name, message) in step.get_mut("messages").and_then(Value::as_object_mut).into_iter().flatten() {
            let own = memory.output["messages"][name]["sent"].clone();
            if own["session"] == message["echo"]["session"] {
                message["echo"] = own;
            }
        }
    }),
    step("withheld-is-granted", WAYSIDE, "WAY-9", |_, step| {
        for (_, message) in step.get_mut("messages").and_then(Value::as_object_mut).into_iter().flatten() {
            message["permission"] = "granted".into();
        }
    }),
    step("restart-ignored", WAYSIDE, "WAY-22", |_, step| {
        step.as_object_mut().map(|step| step.remove("restart"));
    }),
    step("frames-always-taken", WAYSIDE, "WAY-7", |_, step| {
        step.as_object_mut().map(|step| step.remove("framed"));
    }),
    output("line-turned", WAYSIDE, "WAY-10", |memory, output| {
        if output["answer"]["refused"] == "direction" && memory.step["request"].get("turn").is_some() {
            output["answer"] = "accepted".into();
        }
    }),
    output("both-directions", WAYSIDE, "WAY-3", |_, output| {
        for (_, sent) in output.get_mut("transmissions").and_then(Value::as_object_mut).into_iter().flatten() {
            sent["left"]["main"]["beyond_exit_m"] = sent["right"]["main"]["beyond_exit_m"].clone();
        }
    }),
    output("one-rank-up", WAYSIDE, "WAY-4", |_, output| {
        for (_, sent) in output.get_mut("transmissions").and_then(Value::as_object_mut).into_iter().flatten() {
            if let Some(rank) = sent["right"]["main"]["speed_rank"].as_u64().filter(|rank| *rank > 0) {
                sent["right"]["main"]["speed_rank"] = (rank + 1).into();
            }
        }
    }),
];

/// The fault of that name.
pub fn fault(name: &str) -> Option<&'static Fault> {
    FAULTS.iter().find(|fault| fault.name == name)
}

/// The kernel behind the protocol, with a fault.
pub struct Faulty {
    fault: Option<&'static Fault>,
    session: Session,
    memory: Memory,
    here: bool,
}

impl Faulty {
    /// The kernel with this fault; without one, the kernel as it is.
    pub fn new(fault: Option<&'static Fault>) -> Self {
        Self { fault, session: Session::new(), memory: Memory::default(), here: false }
    }

    fn ask(&mut self, line: &str) -> String {
        let mut reply = Vec::new();
        self.session.answer(line.as_bytes(), &mut reply);
        String::from_utf8_lossy(&reply).trim_end().to_owned()
    }

    /// The reply to a request line.
    pub fn answer(&mut self, line: &str) -> String {
        let request: Value = serde_json::from_str(line).unwrap_or_default();
        if let Some(start) = request.get("start") {
            return self.start(line, start);
        }
        match (self.fault, request.get("step")) {
            (Some(fault), Some(step)) if self.here => {
                let mut given = step.clone();
                (fault.step)(&mut self.memory, &mut given);
                let reply = self.ask(&json!({"step": given}).to_string());
                let mut reply: Value = serde_json::from_str(&reply).unwrap_or_default();
                self.memory.step = step.clone();
                if let Some(output) = reply.get_mut("output") {
                    (fault.output)(&mut self.memory, output);
                    self.memory.output = output.clone();
                }
                reply.to_string()
            }
            _ => self.ask(line),
        }
    }

    fn start(&mut self, line: &str, start: &Value) -> String {
        self.memory = Memory { config: start["config"].clone(), ..Memory::default() };
        self.here = self.fault.is_some_and(|fault| start["machine"] == fault.machine);
        let asked = self.ask(line);
        if !self.here || !asked.starts_with(r#"{"started""#) {
            return asked;
        }
        // What is to be rejected is rejected; the case itself runs on the changed configuration, and does not tell its cycles.
        let mut changed = start.clone();
        if let Some(fault) = self.fault {
            (fault.config)(&mut changed["config"]);
        }
        self.ask(r#"{"stop":{}}"#);
        let reply = self.ask(&json!({"start": changed}).to_string());
        if !reply.starts_with(r#"{"started""#) {
            // A rule forbids the change here: this configuration runs as it is.
            self.here = false;
            return self.ask(line);
        }
        json!({"started": {"protocol": 1, "machine": start["machine"], "config": start["config"]}}).to_string()
    }
}
