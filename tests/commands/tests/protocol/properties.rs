//! The oracle against the kernel on random configurations and sessions; the rounding of times; and any bytes at all
//! against the protocol.

use std::fmt::Write as _;
use std::sync::LazyLock;

use atc_kernel::aspect::{AspectSet, Times, TimesMs};
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::{self, Brake, Speeds, Supervision};
use atc_kernel::time::{MAX_TICKS, Millis};
use atc_protocol::Kmh;
use atc_protocol::machine::aspect::Config;
use atc_tests::device;
use atc_tests::session::replies;
use jsonschema::Validator;
use proptest::prelude::*;
use serde_json::{Value, json};

static REQUEST: LazyLock<Validator> = LazyLock::new(|| part("request"));
static REPLY: LazyLock<Validator> = LazyLock::new(|| part("reply"));

fn part(name: &str) -> Validator {
    let mut schema = atc_protocol::schema::schema();
    schema["anyOf"] = json!([{ "$ref": format!("#/$defs/{name}") }]);
    jsonschema::validator_for(&schema).expect("a schema")
}

/// Whatever comes in: one reply for each line, valid by the schema; and what was understood is valid by it as well.
fn check_session(input: &[u8]) -> Result<(), TestCaseError> {
    let mut lines: Vec<&[u8]> = input.split(|byte| *byte == b'\n').collect();
    if lines.last().is_some_and(|last| last.is_empty()) {
        lines.pop();
    }
    let replies = replies(input);
    prop_assert_eq!(replies.len(), lines.len());
    for (line, reply) in lines.iter().zip(&replies) {
        let reply: Value =
            serde_json::from_str(reply).map_err(|error| TestCaseError::fail(format!("{reply}: {error}")))?;
        prop_assert!(REPLY.is_valid(&reply), "the reply {} is not of the schema", reply);
        // A machine that is not here is rejected: the schema knows only those that are.
        if reply.get("malformed").is_none() && reply.get("rejected").is_none() {
            // A number beyond a double is a speed for the oracle and nothing for this reader.
            if let Ok(request) = serde_json::from_slice::<Value>(line) {
                prop_assert!(REQUEST.is_valid(&request), "taken, but not of the schema: {}", request);
            }
        }
    }
    Ok(())
}

prop_compose! {
    /// A configuration that the kernel takes: short times, so that a session of some hundred cycles meets every rule.
    fn config()(
        cycle in 1_u32..60,
        recovery in 1_u32..12,
        mask in 0_u32..12,
        interruption in 0_u32..30,
        (operate, shortened) in (2_u32..12).prop_flat_map(|operate| (Just(operate), 1..operate)),
        part in prop::array::uniform5(0_u32..60),
        steps in prop::collection::vec(1_i32..300, 1..=16),
    ) -> Config {
        let mut speed = -1;
        Config {
            cycle_ms: cycle,
            aspects_km_h: steps.into_iter().map(|step| { speed += step; Kmh(speed) }).collect(),
            // Any part of a cycle less, or more, that rounds to these numbers of cycles.
            operate_ms: operate * cycle - part[0] % cycle,
            recovery_ms: recovery * cycle + part[1] % cycle,
            mask_ms: mask * cycle + part[2] % cycle,
            interruption_ms: interruption * cycle + part[3] % cycle,
            shortened_operate_ms: shortened * cycle - part[4] % cycle,
        }
    }
}

/// Signals that come and go in runs, as on a line, on the ranks of a configuration.
fn detections(aspects: usize) -> impl Strategy<Value = Vec<AspectSet>> {
    let mask = u16::MAX >> (16 - aspects);
    prop::collection::vec((any::<u16>(), any::<u16>(), 1_usize..14), 1..30).prop_map(move |runs| {
        let sets = runs.into_iter().flat_map(|(one, other, length)| {
            // Few aspects at a time.
            std::iter::repeat_n(AspectSet::from_bits(one & other & mask), length)
        });
        sets.collect()
    })
}

fn case() -> impl Strategy<Value = (Config, Vec<AspectSet>)> {
    config().prop_flat_map(|config| {
        let aspects = config.aspects_km_h.len();
        (Just(config), detections(aspects))
    })
}

fn session(config: &Config, detections: &[AspectSet]) -> String {
    let start = json!({"start": {"protocol": 1, "machine": "aspect-acceptance", "config": config}});
    let mut text = format!("{start}\n");
    for detected in detections {
        let step = json!({"step": {"detected_km_h": device::speeds(config, *detected)}});
        writeln!(text, "{step}").expect("memory");
    }
    text
}

fn expected_displays(config: &Config, detections: &[AspectSet]) -> Vec<Option<Kmh>> {
    let displays = device::kernel(config.times().expect("a valid configuration"), detections);
    displays
        .iter()
        .map(|display| display.aspect().map(|aspect| config.aspects_km_h[usize::from(aspect.rank())]))
        .collect()
}

proptest! {
    #[test]
    fn the_oracle_says_what_the_kernel_displays((config, detections) in case()) {
        let text = session(&config, &detections);
        check_session(text.as_bytes())?;
        let replies = replies(text.as_bytes());
        prop_assert!(replies[0].starts_with("{\"started\""), "{}", replies[0]);
        let expected = expected_displays(&config, &detections);
        prop_assert_eq!(replies.len(), expected.len() + 1);
        for (reply, display) in replies[1..].iter().zip(expected) {
            let display = display.map_or("null".to_owned(), |speed| speed.to_string());
            prop_assert_eq!(reply, &format!("{{\"output\":{{\"display_km_h\":{display}}}}}"));
        }
    }

    #[test]
    fn the_oracle_brakes_as_the_kernel_does(
        maximum in 1_u16..,
        margin in 0_u16..,
        steps in prop::collection::vec((
            prop::option::of(-100_i32..7000), prop::option::of(-100_i32..7000), prop::option::of(0_usize..3),
        ), 1..60),
    ) {
        let start = json!({"start": {"protocol": 1, "machine": "speed-supervision",
            "config": {"maximum_km_h": Kmh(maximum.into()), "release_margin_km_h": Kmh(margin.into())}}});
        let kernel = Supervision::new(KmhTenths(maximum), KmhTenths(margin));
        let names = ["release", "service", "emergency"];
        let mut text = format!("{start}\n");
        for (speed, permitted, previous) in &steps {
            let mut step = json!({"speed_km_h": speed.map(Kmh), "permitted_km_h": permitted.map(Kmh)});
            if let Some(previous) = previous {
                step["previous"] = names[*previous].into();
            }
            writeln!(text, "{}", json!({ "step": step })).expect("memory");
        }
        check_session(text.as_bytes())?;
        let replies = replies(text.as_bytes());
        let Ok(kernel) = kernel else {
            prop_assert!(margin > maximum && replies[0].contains("rejected"), "{}", replies[0]);
            return Ok(());
        };
        let mut brake = Brake::Emergency;
        for (reply, (speed, permitted, previous)) in replies[1..].iter().zip(steps) {
            let all = [Brake::Release, Brake::Service, Brake::Emergency];
            let speeds = Speeds { measured: speed.map(RawKmhTenths), permitted: permitted.map(RawKmhTenths) };
            brake = supervision::step(kernel, previous.map_or(brake, |previous| all[previous]), speeds);
            let name = names[all.iter().position(|known| *known == brake).expect("one of three")];
            prop_assert_eq!(reply, &format!("{{\"output\":{{\"brake\":\"{name}\"}}}}"));
        }
    }

    /// T1 and T5 are the fewest cycles that last as long, T2, T3 and T4 the most that do not last longer; and what
    /// the constructor refuses breaks a rule by these numbers.
    #[test]
    fn times_round_to_the_safe_side(
        cycle in 1_u32..5000,
        times in prop::array::uniform5(prop_oneof![0_u32..3000, 0_u32..400_000_000, any::<u32>()]),
    ) {
        let [operate, recovery, mask, interruption, shortened] = times;
        let up = |ms: u32| u64::from(ms).div_ceil(u64::from(cycle));
        let down = |ms: u32| u64::from(ms / cycle);
        let result = Times::from_millis(Millis(cycle), TimesMs {
            operate: Millis(operate), recovery: Millis(recovery), mask: Millis(mask),
            interruption: Millis(interruption), shortened_operate: Millis(shortened),
        });
        let most = u64::from(MAX_TICKS);
        let expiry = down(recovery) + down(mask);
        let valid = operate > 0 && recovery >= cycle && shortened > 0 && up(shortened) < up(operate)
            && up(operate) <= most && expiry <= most && down(interruption) <= most;
        prop_assert_eq!(result.is_ok(), valid, "{:?}", result);
        if let Ok(times) = result {
            let covers = |cycles: u16, ms: u32| {
                let lasts = u64::from(cycles) * u64::from(cycle);
                lasts >= u64::from(ms) && lasts < u64::from(ms) + u64::from(cycle)
            };
            let within = |cycles: u16, ms: u32| {
                let lasts = u64::from(cycles) * u64::from(cycle);
                lasts <= u64::from(ms) && lasts + u64::from(cycle) > u64::from(ms)
            };
            prop_assert!(covers(times.operate().0, operate));
            prop_assert!(covers(times.shortened_operate().0, shortened));
            prop_assert!(within(times.recovery().0, recovery));
            prop_assert!(within(times.expiry().0 - times.recovery().0, mask));
            let limit = u64::from(times.interruption().0);
            prop_assert_eq!(limit, down(interruption).min(expiry - 1));
        }
    }

    #[test]
    fn any_bytes_are_answered_line_by_line(input in prop::collection::vec(any::<u8>(), 0..400)) {
        check_session(&input)?;
    }

    /// Lines made of the protocol's own words get further into the parser.
    #[test]
    fn any_words_are_answered_line_by_line(words in prop::collection::vec(prop::sample::select(WORDS), 0..80)) {
        check_session(words.concat().as_bytes())?;
    }

    #[test]
    fn a_mutated_session_is_answered_line_by_line(
        (config, detections) in case(),
        mutations in prop::collection::vec((any::<prop::sample::Index>(), 0_u8..4, any::<u8>()), 1..12),
    ) {
        let mut input = session(&config, &detections).into_bytes();
        for (place, kind, byte) in mutations {
            let at = place.index(input.len());
            match kind {
                0 => input[at] = byte,
                1 => input.insert(at, byte),
                2 => { input.remove(at); }
                _ => { let copy = input[at..(at + 20).min(input.len())].to_vec(); input.splice(at..at, copy); }
            }
            if input.is_empty() {
                break;
            }
        }
        check_session(&input)?;
    }

    #[test]
    fn a_speed_is_read_exactly(tenths in any::<i32>(), zeros in 0_usize..4, exponent in -12_i32..12) {
        let text = Kmh(tenths).to_string();
        prop_assert_eq!(Kmh::parse(&text), Ok(Kmh(tenths)));
        prop_assert_eq!(serde_json::to_string(&Kmh(tenths)).ok().map(|text| Kmh::parse(&text)), Some(Ok(Kmh(tenths))));
        // The same number with its point elsewhere.
        let scaled = format!("{tenths}{}e{}", "0".repeat(zeros), -1 - i32::try_from(zeros).unwrap_or(0));
        prop_assert_eq!(Kmh::parse(&scaled), Ok(Kmh(tenths)));
        // Against plain integers: v·10^e is a whole number of tenths or it is refused.
        let number = i128::from(tenths);
        let scale = 10_i128.pow(exponent.unsigned_abs());
        let wanted = if exponent >= 0 { Some(number * scale) } else if number % scale == 0 { Some(number / scale) } else { None };
        let wanted = wanted.map(|wanted| Kmh(i32::try_from(wanted).unwrap_or(if wanted < 0 { i32::MIN } else { i32::MAX })));
        prop_assert_eq!(Kmh::parse(&format!("{tenths}e{}", exponent - 1)).ok(), wanted);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    /// The same through the real process and its pipes.
    #[test]
    fn the_process_says_what_the_kernel_displays((config, detections) in case()) {
        let shown = device::process(device::oracle(), &config, &detections);
        let shown = shown.map_err(|refused| TestCaseError::fail(refused.to_string()))?;
        prop_assert_eq!(shown, expected_displays(&config, &detections));
    }
}

const WORDS: &[&str] = &[
    "{",
    "}",
    "[",
    "]",
    ":",
    ",",
    "\n",
    " ",
    "\"",
    "\\u0000",
    "null",
    "true",
    "0",
    "-1",
    "44.9",
    "44.95",
    "1e400",
    "25",
    "90",
    "{\"start\":",
    "{\"step\":",
    "{\"stop\":{}}\n",
    "\"protocol\":1",
    "\"machine\":\"speed-supervision\"",
    "\"machine\":\"aspect-acceptance\"",
    "\"machine\":\"block-count\"",
    "\"config\":",
    "{\"sections\":2,\"max_trains\":1,\"tail_hold_sections\":1}",
    "\"sections\":",
    "\"pass_ms\":",
    "\"check_in\":true",
    "\"check_out\":false",
    "\"present\":",
    "\"reset\":",
    "\"ahead_hold_sections\":",
    "\"ahead_entered\":",
    "{\"aspects_km_h\":[25,90]}",
    "\"aspects_km_h\":",
    "\"detected_km_h\":",
    "{\"detected_km_h\":[25]}",
    "\"speed_km_h\":",
    "\"permitted_km_h\":",
    "\"previous\":\"service\"",
    "}}\n",
    "{\"start\":{\"protocol\":1,\"machine\":\"aspect-acceptance\",\"config\":{\"aspects_km_h\":[25,90]}}}\n",
    "{\"start\":{\"protocol\":1,\"machine\":\"speed-supervision\"}}\n",
    "{\"start\":{\"protocol\":1,\"machine\":\"block-count\",\"config\":{\"sections\":2,\"max_trains\":1,\"tail_hold_sections\":1}}}\n",
    "{\"step\":{\"check_in\":true,\"check_out\":false,\"present\":[1,0],\"reset\":null}}\n",
    "{\"step\":{\"speed_km_h\":44.9,\"permitted_km_h\":45}}\n",
    "{\"step\":{\"detected_km_h\":[90]}}\n",
];
