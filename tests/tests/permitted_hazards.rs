//! Sessions on board that ended in a hazard once, and how they end now.

use atc_protocol::machine::Machine as _;
use atc_protocol::machine::permitted::{Config, LineKind, Output, Permitting, Step};
use atc_protocol::telegrams::MainTelegram;
use atc_protocol::{Kmh, Metres};

const CYCLE_MS: u32 = 100;
const CODE: Kmh = Kmh(900);

fn train() -> Permitting {
    Permitting::open(&Config { cycle_ms: CYCLE_MS, ..Config::default() }).expect("valid")
}

fn step(line: Option<LineKind>, counter: Option<u32>) -> Step {
    let main = counter.map(|counter| MainTelegram {
        section: 7,
        counter: counter % 256,
        beyond_exit_m: Some(if counter < 256 { 900 } else { 100 }),
        speed_rank: 7,
    });
    Step { line, analog_km_h: Some(CODE), main, sub: None, to_exit_m: None, moved_m: Metres(0), speed_km_h: None }
}

fn hear(train: &mut Permitting, line: Option<LineKind>, counter: Option<u32>) -> Output {
    train.step(&step(line, counter)).expect("a step")
}

/// PER-11: analog and digital are told in turn, each second, to a train that never heard a telegram. It kept 90 km/h on both.
#[test]
fn alternating_announcements_permit_nothing_on_a_digital_line() {
    for telling in [1, 10, 37] {
        let mut train = train();
        for cycle in 0..600 {
            let analog = cycle / telling % 2 == 0;
            let kind = if analog { LineKind::Analog } else { LineKind::Digital };
            let line = (cycle % telling == 0).then_some(kind);
            let expected = if analog { CODE } else { Kmh(0) };
            assert_eq!(hear(&mut train, line, None).speed_km_h, Some(expected), "cycle {cycle}");
        }
    }
}

/// The same after telegrams that stop: the permission on the digital line ends with their life, not later for all the telling.
#[test]
fn announcements_lengthen_no_life() {
    let (mut told, mut untold) = (train(), train());
    let life = Config::default().life_ms / CYCLE_MS;
    let mut last = 0;
    for cycle in 0..200 {
        let counter = (cycle % 5 == 0 && cycle <= 20).then_some(cycle / 5);
        let line = if cycle % 4 < 2 { LineKind::Digital } else { LineKind::Analog };
        let by_told = hear(&mut told, Some(line), counter);
        let by_untold = hear(&mut untold, None, counter);
        if line == LineKind::Digital {
            assert_eq!(by_told.speed_km_h, by_untold.speed_km_h, "cycle {cycle}");
        }
        if by_untold.speed_km_h > Some(Kmh(0)) {
            last = cycle;
        }
    }
    // The telegram of cycle 20 was sent no earlier than that of cycle 15.
    assert_eq!(last, 15 + life);
}

/// TEL-6: a recording is refused up to 255 telegrams less the window, and not beyond: the condition counter-reach.
#[test]
fn the_reach_of_the_counter_is_what_the_condition_says() {
    let accepted = |late: u32| {
        let mut train = train();
        for counter in 300..303 {
            hear(&mut train, None, Some(counter));
        }
        // Recorded telegrams before number 256 are those that let the train go farther.
        let output = hear(&mut train, None, Some(302 - late));
        output.state.expect("told").to_stop_m == Some(Metres(900_000))
    };
    let reach = 255 - Config::default().window;
    assert!((47..=reach).all(|late| !accepted(late)));
    assert!((reach + 1..256).all(accepted));
    assert!((256..300).all(|late| !accepted(late)));
}

/// TEL-8: a transmitter freezes, and telegrams that it sent before come late, as many in a row as the run: the frozen one was used again.
#[test]
fn a_late_telegram_does_not_make_a_frozen_one_new() {
    for run in 1..=3 {
        for (pause, back) in [(0, 0), (1, 0), (7, 0), (0, 1), (1, 1), (3, 40)] {
            let mut train = Permitting::open(&Config { cycle_ms: CYCLE_MS, run, ..Config::default() }).expect("valid");
            let digital = Some(LineKind::Digital);
            for counter in 100..=110 {
                hear(&mut train, digital, Some(counter));
            }
            assert!(hear(&mut train, digital, None).state.expect("told").to_stop_m.is_some());
            // Two minutes of the last one alone.
            for _ in 0..1200 {
                hear(&mut train, digital, Some(110));
            }
            for late in (1..=run).rev() {
                hear(&mut train, digital, Some(110 - back - late));
                (0..pause).for_each(|_| drop(hear(&mut train, digital, None)));
            }
            for _ in 0..3 {
                let output = hear(&mut train, digital, Some(110));
                assert_eq!(output.state.expect("told").to_stop_m, None, "run {run}, {pause} cycles between");
            }
            // One that was sent afterwards is used again, with the run and one more.
            let used = (111..=112 + run).filter(|counter| {
                let output = hear(&mut train, digital, Some(*counter));
                output.state.expect("told").to_stop_m.is_some()
            });
            assert_eq!(used.count(), 2, "run {run}");
        }
    }
}
