//! A signal is generated, crosses a channel, and is heard: the same telegrams, the same codes, and never others.

mod common;

use atc_kernel::Machine;
use atc_kernel::distance;
use atc_kernel::telegram::{Counter, Deframer, Gradient, Length, Main, Reception, Route, SectionId, Sub, Telegram};
use atc_waveform::channel::{Channel, Crosstalk, Gain, Harmonic, Interruption, Interruptions, Noise, Stage, Traction};
use atc_waveform::config::{Carrier, Codes, TransmitterConfig};
use atc_waveform::generator::Generator;
use atc_waveform::rail::{Line, Metres, OhmKilometres, Rails, Track};
use atc_waveform::receiver::{
    CodeConfidence, Conventional, Heard, MAIN_CODES, MskDemodulator, OnBoard, SUB_CODES, Squelch,
};
use atc_waveform::transmitter::{TelegramBits, Transmitter};
use atc_waveform::units::{Decibels, Hertz, Level, Seconds, Seed};
use common::{Log, OWN, codes, main_telegram, rank, samples, sub_telegram, table};
use proptest::prelude::*;
use rand::{Rng, SeedableRng};
use rand_distr::StandardNormal;

fn any_main() -> impl Strategy<Value = Main> {
    let route =
        prop_oneof![Just(Route::Closed), any::<u16>().prop_map(|metres| Route::OpenFor(distance::Metres(metres)))];
    (any::<u16>(), any::<u8>(), route, 0..16_u8).prop_map(|(section, counter, route, speed)| Main {
        section: SectionId(section),
        counter: Counter(counter),
        route,
        speed: rank(speed),
    })
}

fn any_sub() -> impl Strategy<Value = Sub> {
    (any::<u16>(), any::<u8>(), 1..=u16::MAX, any::<i8>(), 0..16_u8, 0..16_u8).prop_map(
        |(section, counter, length, gradient, curve, restriction)| Sub {
            section: SectionId(section),
            counter: Counter(counter),
            length: Length::new(distance::Metres(length)).expect("not 0"),
            gradient: Gradient(gradient),
            curve: rank(curve),
            restriction: rank(restriction),
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// Any contents, any pair of codes, any start phase, carriers up to 1 Hz off, 10 dB over the noise.
    #[test]
    fn what_is_sent_is_heard(
        main in any_main(),
        sub in any_sub(),
        (main_code, sub_code) in (0..6_usize, 0..6_usize),
        (carrier, code) in (0.0..1.0, 0.0..1.0),
        offset in -1.0..1.0,
        seed in any::<u64>(),
    ) {
        let config = TransmitterConfig::default();
        let codes = codes(main_code, sub_code);
        let mut transmitter = Transmitter::new(&config, codes, main, sub);
        transmitter.generator().advance_phase(carrier, code);
        transmitter.generator().offset_carriers(Hertz(offset));
        let mut signal = samples(&config, 2.0);
        transmitter.fill(&mut signal);
        Noise::signal_to_noise(&config, codes, Decibels(10.0), Seed(seed)).apply(&mut signal);

        let log = Log::of(&config, &signal);
        prop_assert!(log.says_only(main, sub), "{log:?}");
        // Of the three telegrams in this time the first may be lost while the clock is being found.
        for (name, first, counters) in [
            ("main", main.counter, log.main.iter().map(|(_, heard)| heard.counter.0).collect::<Vec<_>>()),
            ("sub", sub.counter, log.sub.iter().map(|(_, heard)| heard.counter.0).collect::<Vec<_>>()),
        ] {
            let sent: Vec<u8> = (0..3).map(|n| first.0.wrapping_add(n)).collect();
            prop_assert!(counters == sent || counters == sent[1..], "{name}: {counters:?} of {sent:?}");
        }
        let expected = table().heard(Some(MAIN_CODES[main_code]), Some(SUB_CODES[sub_code]));
        prop_assert!(log.speeds.iter().all(|(_, speed)| speed.is_none() || *speed == expected));
        let (_, last) = log.speeds[log.speeds.len() - 1];
        prop_assert_eq!(last, expected);

        // The conventional receiver measures the same codes to a quarter of a hertz, half a second after the start.
        let mut receiver = Conventional::new(&config, table(), CodeConfidence::default());
        let mut hops = 0;
        receiver.process(&signal, |event| {
            if event.at.time(config.sample_rate()).0 > 0.5 {
                hops += 1;
                let off = [(event.main, MAIN_CODES[main_code]), (event.sub, SUB_CODES[sub_code])]
                    .map(|(heard, sent)| heard.map_or(u32::MAX, |heard| heard.0.abs_diff(sent.0)));
                assert!(off[0] <= 250 && off[1] <= 250, "{event:?}");
                assert_eq!(event.speed, expected);
            }
        });
        prop_assert_eq!(hops, 30);
    }
}

/// A message changed while it is sent: the telegram in progress is finished, the counter runs on.
#[test]
fn a_change_between_two_telegrams() {
    let config = TransmitterConfig::default();
    let (main, sub) = (main_telegram(OWN), sub_telegram(OWN));
    let mut transmitter = Transmitter::new(&config, codes(3, 3), main, sub);
    let mut signal = samples(&config, 4.0);
    let (first, second) = signal.split_at_mut(16_000);
    transmitter.fill(first);
    let closed = Main { route: Route::Closed, ..main };
    transmitter.set_main(closed);
    transmitter.set_codes(codes(0, 0));
    transmitter.fill(second);
    let log = Log::of(&config, &signal);
    let heard: Vec<(u8, bool)> =
        log.main.iter().map(|(_, main)| (main.counter.0, main.route == Route::Closed)).collect();
    // 2 s are 3.8 telegrams of 0.53 s: the change comes with the fifth.
    let open = [250, 251, 252, 253].map(|counter| (counter, false));
    let shut = [254, 255, 0].map(|counter| (counter, true));
    assert_eq!(heard, [open.as_slice(), &shut].concat()[heard.len().abs_diff(7)..]);
    assert!(heard.len() >= 6, "{heard:?}");
    assert_eq!(
        log.speeds.last().map(|(_, speed)| *speed),
        Some(table().heard(Some(MAIN_CODES[0]), Some(SUB_CODES[0])))
    );
}

/// ```text
/// signal   ████████████████        ████████████████████
/// s        0              2.5     3.2                6
/// ```
#[test]
fn an_interruption() {
    let config = TransmitterConfig::default();
    let (main, sub) = (main_telegram(OWN), sub_telegram(OWN));
    let mut transmitter = Transmitter::new(&config, codes(2, 2), main, sub);
    let gap = Interruption { start: Seconds(2.5), length: Seconds(0.7) };
    let mut channel = Channel::new()
        .with(Interruptions::new(config.sample_rate(), &[gap]))
        .with(Noise::signal_to_noise(&config, codes(2, 2), Decibels(15.0), Seed(5)));
    let mut signal = samples(&config, 6.0);
    transmitter.fill(&mut signal);
    channel.apply(&mut signal);
    let log = Log::of(&config, &signal);
    assert!(log.says_only(main, sub));
    // A bit is decided 0.1 s after it; so is a telegram whose last bit came before the gap.
    assert!(log.main.iter().all(|(time, _)| !(2.65..3.2 + 0.53).contains(time)), "{:?}", log.main);
    assert!(log.main.iter().filter(|(time, _)| *time < 2.6).count() >= 3, "{:?}", log.main);
    assert!(log.main.iter().any(|(time, _)| *time < 4.4 && *time > 3.7), "{:?}", log.main);
    // The speed is gone while there is none, and back after.
    let speed =
        |from: f64, to: f64| log.speeds.iter().filter(move |(time, _)| (from..to).contains(time)).map(|entry| entry.1);
    assert!(speed(2.75, 3.2).all(|speed| speed.is_none()));
    assert!(speed(0.5, 2.5).chain(speed(3.65, 6.0)).all(|speed| speed.is_some()));
    // The conventional receiver says the same at the same moments.
    let mut conventional = Vec::new();
    let mut receiver = Conventional::new(&config, table(), CodeConfidence::default());
    receiver.process(&signal, |event| {
        assert_eq!(event.speed, table().heard(event.main, event.sub));
        assert!(!(2.75..3.2).contains(&event.at.time(config.sample_rate()).0) || event.main.or(event.sub).is_none());
        conventional.push((event.at.time(config.sample_rate()).0, event.speed));
    });
    assert_eq!(conventional, log.speeds);
}

/// The neighbour at −20 dB, with noise: none of its telegrams, none of its codes.
#[test]
fn crosstalk() {
    let config = TransmitterConfig::default();
    let (main, sub) = (main_telegram(OWN), sub_telegram(OWN));
    let foreign = SectionId(999);
    let bits = (
        TelegramBits::new(Telegram::Main(main_telegram(foreign))),
        TelegramBits::new(Telegram::Sub(sub_telegram(foreign))),
    );
    let mut neighbour = Generator::new(&config, codes(5, 5), bits.0, bits.1);
    neighbour.advance_phase(0.3, 0.7);
    neighbour.offset_carriers(Hertz(0.4));
    let mut channel = Channel::new().with(Crosstalk::new(neighbour, Decibels(-20.0))).with(Noise::signal_to_noise(
        &config,
        codes(1, 1),
        Decibels(20.0),
        Seed(8),
    ));
    let mut transmitter = Transmitter::new(&config, codes(1, 1), main, sub);
    let mut signal = samples(&config, 10.0);
    transmitter.fill(&mut signal);
    channel.apply(&mut signal);
    let log = Log::of(&config, &signal);
    assert!(log.says_only(main, sub), "{log:?}");
    // 10 s hold 18 whole telegrams; the first may be lost.
    assert!(log.main.len() >= 17 && log.sub.len() >= 17, "{} {}", log.main.len(), log.sub.len());
    let expected = table().heard(Some(MAIN_CODES[1]), Some(SUB_CODES[1]));
    assert!(log.speeds.iter().filter(|(time, _)| *time > 0.5).all(|(_, speed)| *speed == expected));
}

/// Over 300 m of rail on wet and on dry ballast, which takes more from the sub carrier than from the main one; then noise.
#[test]
fn over_the_rail() {
    let config = TransmitterConfig::default();
    let (main, sub) = (main_telegram(OWN), sub_telegram(OWN));
    for ballast in [2.0, 50.0] {
        let line = Line::new(Rails::default(), OhmKilometres(ballast)).expect("a line");
        let track = Track::new(&line, Metres(300.0), config.sample_rate()).expect("a track");
        let mut channel =
            Channel::new().with(track).with(Noise::signal_to_noise(&config, codes(3, 3), Decibels(25.0), Seed(4)));
        let mut signal = samples(&config, 5.0);
        Transmitter::new(&config, codes(3, 3), main, sub).fill(&mut signal);
        channel.apply(&mut signal);
        let log = Log::of(&config, &signal);
        assert!(log.says_only(main, sub));
        // 5 s hold 9 telegrams; the track's filter delays them a little.
        assert!(log.main.len() >= 7 && log.sub.len() >= 7, "{ballast}: {} {}", log.main.len(), log.sub.len());
        let expected = table().heard(Some(MAIN_CODES[3]), Some(SUB_CODES[3]));
        assert_eq!(log.speeds.last().map(|(_, speed)| *speed), Some(expected));
    }
}

/// Harmonics of a 50 Hz traction current, 15 of them exactly on the main carrier and 24 exactly on the sub carrier.
#[test]
fn traction_current() {
    let config = TransmitterConfig::default();
    let (main, sub) = (main_telegram(OWN), sub_telegram(OWN));
    // Loud ones outside the bands, and one a tenth of the carrier on each of them.
    let harmonics = [(1, 0.3), (5, 0.1), (7, 0.1), (11, 0.05), (15, 0.025), (24, 0.025), (35, 0.05)];
    let harmonics = harmonics.map(|(number, level)| Harmonic { number, level: Level(level) });
    let mut signal = samples(&config, 6.0);
    Transmitter::new(&config, codes(4, 4), main, sub).fill(&mut signal);
    Traction::new(config.sample_rate(), Hertz(50.0), &harmonics).apply(&mut signal);
    let log = Log::of(&config, &signal);
    assert!(log.says_only(main, sub));
    assert!(log.main.len() >= 10 && log.sub.len() >= 10, "{} {}", log.main.len(), log.sub.len());
    let expected = table().heard(Some(MAIN_CODES[4]), Some(SUB_CODES[4]));
    assert!(log.speeds.iter().filter(|(time, _)| *time > 0.5).all(|(_, speed)| *speed == expected));
}

/// A loss of 30 dB changes nothing, a loss of 60 dB leaves nothing: the receivers have a floor.
#[test]
fn levels() {
    let config = TransmitterConfig::default();
    for (gain, heard) in [(0.0316, true), (0.001, false)] {
        let mut signal = samples(&config, 2.0);
        Transmitter::new(&config, codes(0, 0), main_telegram(OWN), sub_telegram(OWN)).fill(&mut signal);
        Channel::new().with(Gain(gain)).apply(&mut signal);
        let log = Log::of(&config, &signal);
        assert_eq!(!log.main.is_empty(), heard);
        assert_eq!(log.speeds.iter().any(|(_, speed)| speed.is_some()), heard);
    }
}

/// An analog-only line: codes, and no bit that anybody would believe.
#[test]
fn analog_only() {
    let config = TransmitterConfig::default();
    for place in 0..6 {
        let mut signal = samples(&config, 3.0);
        Generator::analog(&config, codes(place, place)).fill(&mut signal);
        Noise::signal_to_noise(&config, codes(place, place), Decibels(10.0), Seed(2)).apply(&mut signal);
        let log = Log::of(&config, &signal);
        assert!(log.main.is_empty() && log.sub.is_empty());
        let expected = table().heard(Some(MAIN_CODES[place]), Some(SUB_CODES[place]));
        assert!(expected.is_some());
        assert!(log.speeds.iter().filter(|(time, _)| *time > 0.5).all(|(_, speed)| *speed == expected));
        let bits =
            log.events.iter().filter(|event| matches!(event.heard, Heard::Bit(_, bit) if bit != Reception::Nothing));
        assert_eq!(bits.count(), 0);
    }
}

/// No code, no speed: a carrier that is keyed and not modulated.
#[test]
fn keyed_without_code() {
    let config = TransmitterConfig::default();
    let (main, sub) = (main_telegram(OWN), sub_telegram(OWN));
    let mut signal = samples(&config, 5.0);
    Transmitter::new(&config, Codes::NONE, main, sub).fill(&mut signal);
    let log = Log::of(&config, &signal);
    assert!(log.main.len() >= 8 && log.says_only(main, sub));
    assert!(log.speeds.iter().all(|(_, speed)| speed.is_none()));
}

/// Noise of every level, the squelch open: two million bits, no telegram.
#[test]
fn noise_alone_is_no_telegram() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(77);
    let mut demodulator = MskDemodulator::new(5.0);
    let mut window = Deframer.initial();
    let (mut bits, mut ones) = (0_u32, 0_u32);
    while bits < 2_000_000 {
        let (re, im) = (random.sample(StandardNormal), random.sample(StandardNormal));
        let Some(bit) = demodulator.push(atc_waveform::receiver::Complex32::new(re, im)) else { continue };
        bits += 1;
        ones += u32::from(bit.value);
        let (next, telegram) = Deframer.step(window, if bit.value { Reception::One } else { Reception::Zero });
        window = next;
        assert_eq!(telegram, None);
    }
    // It did decide: about as many ones as zeros.
    assert!((900_000..1_100_000).contains(&ones), "{ones}");
}

/// The whole chain in noise: no telegram, no speed, and with the squelch hardly a bit.
#[test]
fn noise_through_the_whole_chain() {
    let config = TransmitterConfig::default();
    let mut signal = samples(&config, 60.0);
    Noise::new(Level(0.1), Seed(4)).apply(&mut signal);
    let mut open = OnBoard::with_thresholds(&config, table(), CodeConfidence::default(), Squelch::OPEN);
    let mut bits = 0;
    open.process(&signal, |event| match event.heard {
        Heard::Bit(_, bit) => bits += u32::from(bit != Reception::Nothing),
        Heard::Code(..) => (),
        Heard::Speed(speed) => assert_eq!(speed, None),
        Heard::Main(_) | Heard::Sub(_) => panic!("a telegram in noise: {event:?}"),
    });
    assert!(bits > 20_000, "{bits}");
    let log = Log::of(&config, &signal);
    let believed =
        log.events.iter().filter(|event| matches!(event.heard, Heard::Bit(_, bit) if bit != Reception::Nothing));
    assert!(believed.count() < 6_000);
    assert_eq!((log.main.len(), log.sub.len()), (0, 0));
}

/// The sub telegram sent on the main carrier, and the reverse, are not taken for telegrams of this line.
#[test]
fn the_wrong_carrier() {
    let config = TransmitterConfig::default();
    let main = TelegramBits::new(Telegram::Main(main_telegram(OWN)));
    let sub = TelegramBits::new(Telegram::Sub(sub_telegram(OWN)));
    let mut signal = samples(&config, 3.0);
    Generator::new(&config, codes(0, 0), sub, main).fill(&mut signal);
    let log = Log::of(&config, &signal);
    assert_eq!((log.main.len(), log.sub.len()), (0, 0));
    // Both are heard well: it is the carrier that counts.
    let lost = log.events.iter().filter(|event| matches!(event.heard, Heard::Bit(_, Reception::Nothing)));
    assert!(lost.count() < 100);
}

/// The level that a receiver reports is that of the carrier, its code averaged out.
#[test]
fn levels_are_measured() {
    let config = TransmitterConfig::default();
    let mut signal = samples(&config, 1.0);
    Transmitter::new(&config, codes(1, 1), main_telegram(OWN), sub_telegram(OWN)).fill(&mut signal);
    let mut receiver = OnBoard::new(&config, table());
    receiver.process(&signal, |_| ());
    for carrier in [Carrier::Main, Carrier::Sub] {
        let level = receiver.level(carrier);
        assert!((level / 0.25 - 1.0).abs() < 0.1, "{carrier:?}: {level}");
    }
}

/// Half a hertz beside its band a code names no speed, also in the first hops, in which the window is not full yet: they used to read up to
/// 0.75 Hz high, and to name 45 km/h for 50 ms.
#[test]
fn a_code_beside_its_band_is_never_named() {
    let config = TransmitterConfig::default();
    for (main, sub) in [(20.5, 21.0), (23.5, 21.0), (22.0, 19.5), (40.0, 38.5)] {
        let codes = Codes::new(Some(Hertz(main)), Some(Hertz(sub))).expect("in range");
        for step in 0..16_u32 {
            let mut signal = samples(&config, 1.5);
            let mut transmitter = Transmitter::new(&config, codes, main_telegram(OWN), sub_telegram(OWN));
            transmitter.generator().advance_phase(0.0, f64::from(step % 8) / 8.0);
            // At once, or after a silence that is no whole number of hops.
            let start = if step < 8 { 0 } else { 2900 + 57 * step as usize };
            transmitter.fill(&mut signal[start..]);
            let log = Log::of(&config, &signal);
            assert!(log.speeds.iter().all(|(_, speed)| speed.is_none()), "{main} {sub} {step}: {:?}", log.speeds);
        }
    }
}

/// At the edge of its band a code is kept and no new one taken; outside it there is none.
#[test]
fn a_code_in_use_is_kept_within_its_band() {
    let config = TransmitterConfig::default();
    let codes = |main: f64| Codes::new(Some(Hertz(main)), Some(Hertz(21.0))).expect("in range");
    let named = table().heard(Some(MAIN_CODES[2]), Some(SUB_CODES[2]));
    let frequencies = [22.88, 22.0, 22.3, 22.6, 22.88, 23.3, 22.88];
    let mut transmitter = Transmitter::new(&config, codes(22.88), main_telegram(OWN), sub_telegram(OWN));
    let mut signal = Vec::new();
    for frequency in frequencies {
        transmitter.set_codes(codes(frequency));
        let mut piece = samples(&config, 1.0);
        transmitter.fill(&mut piece);
        signal.extend(piece);
    }
    let log = Log::of(&config, &signal);
    let mut at_the_end = (1..=7_u8).map(|second| {
        let until = f64::from(second) + 0.01;
        log.speeds.iter().rfind(|(time, _)| *time < until).expect("a report").1
    });
    for expected in [None, named, named, named, named, None, None] {
        assert_eq!(at_the_end.next(), Some(expected), "{:?}", log.speeds);
    }
    // The conventional receiver holds it the same way.
    let mut conventional = Vec::new();
    let mut receiver = Conventional::new(&config, table(), CodeConfidence::default());
    receiver.process(&signal, |event| conventional.push((event.at.time(config.sample_rate()).0, event.speed)));
    assert_eq!(conventional, log.speeds);
}

/// For how long the receiver names the old speed after the transmitter has changed to a lower one: longest where the level falls a little with it. The
/// examples of a line count at least that, in `code_way_ms` (tenth attack).
#[test]
fn for_how_long_an_old_code_is_named() {
    let config = TransmitterConfig::default();
    let mut longest_ms = 0.0_f64;
    for (old, new) in (1..6).flat_map(|old| (0..old).map(move |new| (old, new))) {
        for (main, sub) in [(new, new), (new, old), (old, new)] {
            for (gain, phase) in [1.0, 0.8].into_iter().flat_map(|gain| (0..10).map(move |phase| (gain, phase))) {
                let sent = 0.8075 + f64::from(phase) * 0.01;
                let mut signal = samples(&config, 1.4);
                let (before, after) = signal.split_at_mut(samples(&config, sent).len());
                let mut transmitter = Transmitter::new(&config, codes(old, old), main_telegram(OWN), sub_telegram(OWN));
                transmitter.fill(before);
                transmitter.set_codes(codes(main, sub));
                transmitter.fill(after);
                for sample in after {
                    *sample *= gain;
                }
                let speeds = Log::of(&config, &signal).speeds;
                let named = speeds.iter().rev().find(|(at, _)| *at <= sent).and_then(|(_, speed)| *speed);
                assert!(named.is_some(), "{speeds:?}");
                let last = speeds.iter().rposition(|(_, speed)| *speed == named).expect("it was named");
                let (gone, _) = speeds.get(last + 1).expect("another code, or none");
                longest_ms = longest_ms.max((gone - sent) * 1000.0);
            }
        }
    }
    assert!((251.0..260.0).contains(&longest_ms), "{longest_ms} ms");
    for (name, line) in [
        ("line.toml", include_str!("../../line/examples/line.toml")),
        ("my-line.toml", include_str!("../../evidence/examples/my-line.toml")),
    ] {
        let counted =
            line.lines().find_map(|line| line.strip_prefix("code_way_ms = ")?.split(' ').next()?.parse().ok());
        assert!(counted.is_some_and(|ms: f64| ms >= longest_ms), "{name}: {counted:?}, measured {longest_ms} ms");
    }
}
