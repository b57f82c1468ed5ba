//! Walks through the small machines: each holds to the limits of the machine's times and numbers, and beyond them.

use serde_json::{Value, json};

use crate::draw::Draw;

fn start(machine: &str, config: &Value) -> String {
    json!({"start": {"protocol": 1, "machine": machine, "config": config}}).to_string()
}

fn step(input: &Value) -> String {
    json!({ "step": input }).to_string()
}

fn stop() -> String {
    r#"{"stop":{}}"#.to_owned()
}

/// So many tenths or thousandths as a number.
fn part(count: i64, of: i32) -> Value {
    if count % i64::from(of) == 0 {
        return json!(count / i64::from(of));
    }
    json!(f64::from(i32::try_from(count).expect("small")) / f64::from(of))
}

/// Now and then, what is no request.
fn nonsense(draw: &mut Draw) -> Value {
    draw.one(&[json!(-1), json!(0.0001), json!("a"), json!({}), json!([0, 0]), json!(7e9)])
}

/// Some lines that no machine takes.
pub fn malformed() -> Vec<String> {
    let lines = [
        "",
        "{",
        "[]",
        r#"{"step":{}}"#,
        r#"{"stop":{}}"#,
        r#"{"start":{}}"#,
        r#"{"stop":{"a":1}}"#,
        r#"{"start":{"protocol":2,"machine":"none"}}"#,
        r#"{"start":{"protocol":1,"machine":"none"}}"#,
        r#"{"step":{},"stop":{}}"#,
        "null",
        "\u{fe}",
    ];
    lines.map(ToOwned::to_owned).to_vec()
}

pub fn aspect(seed: u64, steps: usize) -> Vec<String> {
    let mut draw = Draw::new(seed);
    let mut lines = malformed();
    while lines.len() < steps {
        let count = draw.one(&[1, 2, 3, 4, 4, 6, 16]);
        let mut speeds = vec![draw.from(0, 90)];
        for _ in 1..count {
            speeds.push(speeds[speeds.len() - 1] + draw.from(1, 70));
        }
        let cycle = draw.one(&[10, 20, 33, 50, 100]);
        let (operate, recovery, mask, limit) = (draw.from(2, 12), draw.from(1, 10), draw.from(0, 10), draw.from(0, 22));
        let (zero, long) = (draw.chance(50), draw.chance(50));
        let shortened = draw.from(i64::from(!zero), if long { operate } else { operate - 1 });
        let up = |draw: &mut Draw, cycles: i64| (cycles * cycle - draw.from(0, cycle - 1)).max(0);
        let down = |draw: &mut Draw, cycles: i64| cycles * cycle + draw.from(0, cycle - 1);
        let speeds: Vec<Value> = speeds.iter().map(|speed| part(*speed, 10)).collect();
        let config = json!({
            "aspects_km_h": speeds, "cycle_ms": cycle,
            "operate_ms": up(&mut draw, operate), "shortened_operate_ms": up(&mut draw, shortened),
            "recovery_ms": down(&mut draw, recovery), "mask_ms": down(&mut draw, mask),
            "interruption_ms": down(&mut draw, limit),
        });
        lines.push(start("aspect-acceptance", &config));
        let limits =
            [operate, shortened, recovery, recovery + mask, limit, operate - shortened, recovery + mask - shortened];
        let (mut on, mut left) = (vec![false; speeds.len()], vec![0_i64; speeds.len()]);
        for _ in 0..1500 {
            for place in 0..speeds.len() {
                if left[place] <= 0 {
                    on[place] = if draw.chance(850) { !on[place] } else { on[place] };
                    let near = draw.one(&limits) + draw.one(&[-1, 0, 0, 0, 1]);
                    left[place] = if draw.chance(850) { near.max(1) } else { draw.from(1, 30) };
                    if speeds.len() > 4 && !on[place] && draw.chance(300) {
                        left[place] *= 4;
                    }
                }
                left[place] -= 1;
            }
            let heard = speeds.iter().zip(&on).filter(|(_, on)| **on).map(|(speed, _)| speed.clone());
            let mut heard: Vec<Value> = heard.collect();
            if draw.chance(1) {
                heard.push(nonsense(&mut draw));
            }
            lines.push(step(&json!({ "detected_km_h": heard })));
        }
        lines.push(stop());
    }
    lines
}

pub fn block(seed: u64, steps: usize) -> Vec<String> {
    let mut draw = Draw::new(seed);
    let mut lines = malformed();
    while lines.len() < steps {
        let sections = draw.one(&[1, 2, 3, 3, 4, 5, 8, 16]);
        let (over, under) = (draw.chance(20), draw.chance(20));
        let most = draw.from(1, sections + i64::from(over));
        let (cycle, pass) = (draw.one(&[10, 100, 1000]), draw.from(i64::from(!under), 8));
        let config = json!({
            "sections": sections, "max_trains": most, "tail_hold_sections": draw.one(&[0, 1, 1, 2, 3, 5, 16]),
            "cycle_ms": cycle, "pass_ms": pass * cycle + draw.from(0, cycle - 1),
        });
        lines.push(start("block-count", &config));
        let (mut check_in, mut check_out, mut present) = (false, draw.chance(500), Vec::new());
        let (mut in_left, mut out_left) = (0, 0);
        for _ in 0..1000 {
            if in_left <= 0 {
                check_in = !check_in;
                in_left =
                    if check_in { draw.one(&[1, 1, 2, pass, pass + 1, pass + 2]) } else { draw.one(&[1, 2, 3, 5, 9]) };
            }
            if out_left <= 0 {
                check_out = !check_out;
                out_left = if check_out { draw.one(&[1, 1, 2, 3]) } else { draw.one(&[1, 2, 3, 5, 9]) };
            }
            in_left -= 1;
            out_left -= 1;
            if draw.chance(400) {
                let often = draw.one(&[100, 300, 600]);
                present = (0..sections).filter(|_| draw.chance(often)).collect::<Vec<i64>>();
            }
            let mut input = json!({ "present": present });
            if draw.chance(500) {
                input["ahead_entered"] = draw.chance(500).into();
            }
            if draw.chance(300) {
                input["ahead_hold_sections"] = draw.one(&[0, 1, 2, 3, sections, 16]).into();
            }
            if draw.chance(80) {
                let heard = i64::try_from(present.len()).expect("few");
                input["reset"] =
                    if draw.chance(800) { heard } else { draw.one(&[0, 1, sections, most, most + 1, 255]) }.into();
                if draw.chance(700) {
                    (check_in, check_out) = (false, false);
                }
            } else if draw.chance(20) {
                input["reset"] = Value::Null;
            } else if draw.chance(1) {
                input[draw.one(&["present", "reset", "ahead_hold_sections", "ahead_entered", "other"])] =
                    nonsense(&mut draw);
            }
            input["check_in"] = check_in.into();
            input["check_out"] = check_out.into();
            lines.push(step(&input));
        }
        lines.push(stop());
    }
    lines
}

fn main_telegram(draw: &mut Draw) -> Value {
    let beyond = draw.edge(0, 65535);
    json!({
        "section": draw.edge(0, 65535), "counter": draw.edge(0, 255), "speed_rank": draw.edge(0, 15),
        "beyond_exit_m": draw.one(&[Value::Null, json!(0), json!(beyond)]),
    })
}

fn sub_telegram(draw: &mut Draw) -> Value {
    json!({
        "section": draw.edge(0, 65535), "counter": draw.edge(0, 255), "length_m": draw.edge(1, 65535),
        "gradient_permille": draw.edge(-128, 127), "curve_rank": draw.edge(0, 15), "restriction_rank": draw.edge(0, 15),
    })
}

/// A frame as the specification draws it, often one of a telegram.
fn frame(draw: &mut Draw) -> Vec<u8> {
    let mut bytes: Vec<i64> = (0..8).map(|_| draw.edge(0, 255)).collect();
    let other = draw.edge(0, 255);
    bytes[0] = draw.one(&[0x4d, 0x53, 0x4d, 0x53, other]);
    if bytes[0] == 0x4d && draw.chance(700) {
        bytes[6] = draw.one(&[0x0f, 0xf0]);
        bytes[7] &= 15;
    }
    if draw.chance(300) {
        (bytes[4], bytes[5]) = (0, 0);
    }
    let check = bytes.iter().fold(0xffff, |rest, byte| {
        (0..8).fold(rest ^ (byte << 8), |rest, _| if rest & 0x8000 == 0 { rest << 1 } else { (rest << 1) ^ 0x1_1021 })
    });
    bytes.extend([check >> 8, check & 255]);
    let mut bits = b"0111111111111110".to_vec();
    for byte in bytes {
        bits.extend((0..8).rev().map(|bit| if byte >> bit & 1 == 1 { b'1' } else { b'0' }));
        bits.push(b'0');
    }
    bits
}

fn text(bits: &[u8]) -> String {
    bits.iter().map(|bit| char::from(*bit)).collect()
}

pub fn telegram(seed: u64, steps: usize) -> Vec<String> {
    let mut draw = Draw::new(seed);
    let mut lines = malformed();
    lines.push(start("telegram-codec", &json!({})));
    while lines.len() < steps {
        match draw.from(0, 99) {
            0..40 => {
                let main = json!({"encode": {"main": main_telegram(&mut draw)}});
                let sub = json!({"encode": {"sub": sub_telegram(&mut draw)}});
                lines.push(step(&draw.one(&[main, sub])));
            }
            40..85 => {
                let mut bits = frame(&mut draw);
                for _ in 0..draw.one(&[0, 0, 0, 1, 2, 4]) {
                    let at = usize::try_from(draw.from(0, 105)).expect("a place");
                    bits[at] ^= 1;
                }
                lines.push(step(&json!({ "decode": text(&bits) })));
            }
            85..99 => {
                let mut bits = Vec::new();
                for _ in 0..draw.from(0, 2) {
                    let mut one = frame(&mut draw);
                    let at = usize::try_from(draw.from(0, 105)).expect("a place");
                    match draw.from(0, 9) {
                        0 => one.truncate(at),
                        1 => one[at] = draw.one(b".01"),
                        2 => {
                            let _ = one.remove(at);
                        }
                        3 => one.insert(at, b'.'),
                        _ => {}
                    }
                    bits.extend(one);
                    bits.extend((0..draw.one(&[0, 0, 1, 5])).map(|_| draw.one(b".01")).collect::<Vec<u8>>());
                }
                let end = i64::try_from(bits.len()).expect("short");
                let at = usize::try_from(draw.from(0, end)).expect("a place");
                lines.push(step(&json!({ "bits": text(&bits[..at]) })));
                lines.push(step(&json!({ "bits": text(&bits[at..]) })));
            }
            _ => {
                let wrong = draw.one(&[
                    json!({"bits": "012"}),
                    json!({"decode": "01"}),
                    json!({"decode": ".".repeat(106)}),
                    json!({"encode": {}}),
                    json!({"encode": {"main": {}}}),
                    json!({"bits": "", "decode": ""}),
                    json!({}),
                ]);
                lines.push(step(&wrong));
            }
        }
    }
    lines.push(stop());
    lines
}

pub fn permitted(seed: u64, steps: usize) -> Vec<String> {
    let mut draw = Draw::new(seed);
    let mut lines = malformed();
    while lines.len() < steps {
        let cycle = draw.one(&[10, 100, 250]);
        let (memory, fresh) = (draw.from(1, 12), draw.from(1, 14));
        let (life, fixed_life) = (fresh.max(memory) + draw.from(0, 8), memory + draw.from(0, 15));
        let (window, run) = (draw.one(&[1, 2, 3, 127]), draw.one(&[1, 1, 1, 2, 3]));
        let speeds = draw.one(&[vec![0, 150, 250, 450, 550, 650, 750, 900], vec![0, 151, 449], vec![500]]);
        let ranks = i64::try_from(speeds.len()).expect("few");
        let later = |draw: &mut Draw, cycles: i64| cycles * cycle + draw.from(0, cycle - 1);
        let speed_list: Vec<Value> = speeds.iter().map(|speed| part(*speed, 10)).collect();
        let config = json!({
            "cycle_ms": cycle, "window": window, "run": run, "speeds_km_h": speed_list,
            "memory_ms": later(&mut draw, memory), "fresh_ms": later(&mut draw, fresh),
            "life_ms": later(&mut draw, life), "fixed_life_ms": later(&mut draw, fixed_life),
            "lowest_limit_km_h": draw.one(&speed_list), "worst_gradient_permille": draw.one(&[-35, -60, 0, 10, -128]),
            "brake_mm_s2": draw.one(&[300, 800, 800, 1300, 4095, 1]), "margin_m": draw.one(&[0, 1, 10, 50]),
        });
        lines.push(start("permitted-speed", &config));
        let (mut section, mut main, mut sub) = (1, draw.from(0, 255), draw.from(0, 255));
        let (mut code, mut beyond, mut rank) = (draw.one(&speed_list), json!(100), 0);
        let (often, seldom, measured) =
            (draw.one(&[200, 500, 800]), draw.one(&[100, 300, 600]), draw.one(&[0, 100, 500]));
        let fast = draw.one(&[0, 1000, 5000, 20000]);
        for _ in 0..400 {
            let moved = draw.from(0, fast);
            let mut input = json!({
                "analog_km_h": if draw.chance(800) { code.clone() } else { Value::Null },
                "moved_m": part(draw.one(&[0, fast, moved]), 1000),
            });
            if draw.chance(30) {
                input["line"] = draw.one(&[json!("analog"), json!("digital"), json!("digital"), Value::Null]);
            }
            section = if draw.chance(50) { draw.from(1, 3) } else { section };
            code = if draw.chance(100) { draw.one(&speed_list) } else { code };
            if draw.chance(100) {
                beyond =
                    draw.one(&[Value::Null, json!(0), json!(50), json!(100), json!(300), json!(1000), json!(65535)]);
            }
            rank = if draw.chance(100) { draw.from(0, ranks.min(15)) } else { rank };
            let advance =
                |draw: &mut Draw| if draw.chance(700) { 1 } else { draw.one(&[0, 1, window, window + 1, 2, 128, 255]) };
            if draw.chance(often) {
                main = (main + advance(&mut draw)) % 256;
                let of = if draw.chance(970) { section } else { draw.from(1, 4) };
                input["main"] = json!({"section": of, "counter": main, "beyond_exit_m": beyond, "speed_rank": rank});
            }
            if draw.chance(seldom) {
                sub = (sub + advance(&mut draw)) % 256;
                input["sub"] = json!({
                    "section": if draw.chance(950) { section } else { draw.from(1, 4) }, "counter": sub, "length_m": 200,
                    "gradient_permille": draw.one(&[0, -10, 10, -35, 127, -128, 5]),
                    "curve_rank": if draw.chance(900) { draw.from(0, ranks - 1) } else { 15 },
                    "restriction_rank": if draw.chance(900) { ranks - 1 } else { draw.from(0, 15) },
                });
            }
            if draw.chance(measured) {
                input["to_exit_m"] =
                    draw.one(&[json!(0), json!(100), json!(500), json!(1234.567), json!(4_294_967.295)]);
            }
            if draw.chance(1) {
                input[draw.one(&["line", "moved_m", "main", "to_exit_m", "other"])] = nonsense(&mut draw);
            }
            lines.push(step(&input));
        }
        lines.push(stop());
    }
    lines
}
