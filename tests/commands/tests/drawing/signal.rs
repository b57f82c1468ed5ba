//! The drawn charts of the train control signal and the train's position: what stands in them, and differences in red.

use atc_oracle::chart::{self, Part, View};
use atc_oracle::trace::{Replies, Trace};
use atc_tests::drawing::{draw, titles};
use atc_tests::session;

const CODEC: &str = include_str!("../../../../oracle/examples/telegram-codec.jsonl");
const GROUND: &str = include_str!("../../../../oracle/examples/speed-pattern.jsonl");
const POSITION: &str = include_str!("../../../../oracle/examples/train-position.jsonl");
const PATTERN: &str = include_str!("../../../../oracle/examples/braking-pattern.jsonl");

#[test]
fn the_fields_of_the_frames() {
    let titles = titles(&draw(CODEC, Replies::MustAgree, None));
    assert_eq!(
        titles[..16],
        [
            "synchronisation: 0 to 16 bits",
            "kind main: 16 to 25 bits",
            "counter 1: 25 to 34 bits",
            "section 7: 34 to 52 bits",
            "beyond exit 400 m: 52 to 70 bits",
            "route open: 70 to 79 bits",
            "speed rank 4: 79 to 88 bits",
            "check 13F7: 88 to 106 bits",
            "synchronisation: 0 to 16 bits",
            "kind sub: 16 to 25 bits",
            "counter 1: 25 to 34 bits",
            "section 7: 34 to 52 bits",
            "length 250 m: 52 to 70 bits",
            "gradient -12 ‰: 70 to 79 bits",
            "curve 6, restriction 7: 79 to 88 bits",
            "check 0A4D: 88 to 106 bits",
        ]
    );
    assert!(titles.contains(&"byte 4D: 16 to 25 bits".to_owned()), "the bytes of a frame that is none");
    assert!(titles.contains(&"sub 1 of section 7, begun in an earlier step: 0 to 46 bits".to_owned()), "{titles:?}");
}

#[test]
fn both_trains_on_one_figure() {
    let svg = draw(GROUND, Replies::MustAgree, Some(Part::Figure));
    for text in [
        "new train, speed",
        "new train, permitted",
        "conventional train, speed",
        "conventional train, permitted",
        "sub telegram of a section is first used",
        "stopping point",
        "section 101",
        "section 105",
        "distance, m",
    ] {
        assert!(svg.lines().any(|line| line == text), "{text}");
    }
    assert_eq!(svg.matches("<polyline").count(), 4, "one curve for each of four");
    let arrivals: Vec<_> = titles(&svg).into_iter().filter(|title| title.starts_with("sub telegram of")).collect();
    assert_eq!(arrivals.len(), 5, "{arrivals:?}");
    assert!(!svg.contains("time, ms"));
    let rows = draw(GROUND, Replies::MustAgree, Some(Part::Rows));
    assert!(rows.contains("time, ms") && !rows.contains("distance, m") && rows.contains("case 2"));
    let all = draw(GROUND, Replies::MustAgree, None);
    assert!(all.contains("time, ms") && all.contains("distance, m"));
    // A machine without a figure.
    let view = View { only: Some(Part::Figure), ..View::default() };
    let error = chart::svg(&Trace::parse(CODEC).expect("a trace"), Replies::MustAgree, &view).expect_err("no figure");
    assert!(error.to_string().contains("no figure, only rows"), "{error}");
}

#[test]
fn what_the_permission_rests_on() {
    let titles = titles(&draw(GROUND, Replies::MustAgree, Some(Part::Rows)));
    assert_eq!(titles[0], "nothing: 0 to 1250 ms");
    assert!(titles.contains(&"running down: 39250 to 39750 ms".to_owned()), "{:?}", &titles[..8]);
    assert!(titles.iter().any(|title| title.starts_with("main 2 of section 101, not used")));
    assert!(titles.iter().any(|title| title.starts_with("main 3 of section 101, used")));
    assert!(titles.iter().any(|title| title.starts_with("analog code: ")));
}

#[test]
fn the_interval_and_the_unknown() {
    let svg = draw(POSITION, Replies::MustAgree, None);
    let titles = titles(&svg);
    assert_eq!(titles, ["unknown: 0 to 1 cycles", "unknown: 26 to 33 cycles"]);
    let real = draw(PATTERN, Replies::MustAgree, None);
    assert!(real.contains("real curve with 800 mm/s²") && real.contains("answers at -35 ‰"));
}

/// A wrong reply in each: refused with its line, or drawn in red.
#[test]
fn a_difference_is_refused_or_drawn() {
    let cases = [
        (CODEC, 1, "\"frame\":\"0111", "\"frame\":\"0110", "step 0", None),
        (CODEC, 5, "guard", "check", "step 4", None),
        (PATTERN, 2, "speed_km_h\":", "speed_km_h\":1", "first at 1 cycles", Some("record_says")),
        (GROUND, 40, "speed_km_h\":", "speed_km_h\":1", "first at ", Some("record_says")),
        (GROUND, 40, "both", "pattern", "first at ", Some("record_says")),
        (POSITION, 3, "[", "[1", "first at 3 cycles", Some("s1")),
    ];
    for (requests, reply, right, wrong, told, signal) in cases {
        let mut lines = session::replies(requests.as_bytes());
        let changed = lines[reply].replacen(right, wrong, 1);
        assert_ne!(lines[reply], changed);
        lines[reply] = changed;
        let trace = format!("{requests}{}", lines.join("\n"));
        let parsed = Trace::parse(&trace).expect("a trace");
        let error = chart::svg(&parsed, Replies::MustAgree, &View::default()).expect_err("a difference");
        assert_eq!(error.line, requests.lines().count() + reply + 1);
        let svg = draw(&trace, Replies::AsRecorded, None);
        let warning = svg.lines().find(|line| line.starts_with("THE RECORD DIFFERS FROM THE KERNEL"));
        assert!(warning.is_some_and(|warning| warning.contains(told)), "{warning:?}");
        assert!(svg.contains("record says"));
        let vcd = chart::vcd(&parsed, Replies::AsRecorded).expect("signals");
        assert!(signal.is_none_or(|signal| vcd.contains(signal)));
        assert!(!draw(requests, Replies::MustAgree, None).contains("THE RECORD DIFFERS"));
    }
}

/// The signals as a viewer reads them.
#[test]
fn the_signals() {
    use vcd::{Command, Parser};
    for (trace, scope, names) in [
        (CODEC, "case_1_telegram_codec", &["bit", "nothing", "step"][..]),
        (PATTERN, "case_1_braking_pattern", &["distance_m", "gradient_permille", "speed_km_h"]),
        (
            GROUND,
            "case_1_permitted_speed",
            &["analog_km_h", "main_used", "sub_used", "permitted_km_h", "to_stop_m", "basis"],
        ),
        (POSITION, "case_1_train_position", &["first_db", "second_db", "nearest_m", "farthest_m", "truth_m"]),
    ] {
        let text = chart::vcd(&Trace::parse(trace).expect("a trace"), Replies::MustAgree).expect("signals");
        let mut parser = Parser::new(text.as_bytes());
        let header = parser.parse_header().expect("a header");
        for name in names {
            assert!(header.find_var(&[scope, name]).is_some(), "{scope}.{name}");
        }
        assert!(parser.all(|command| command.is_ok_and(|command| !matches!(command, Command::Date(_)))));
    }
    let text = chart::vcd(&Trace::parse(GROUND).expect("a trace"), Replies::MustAgree).expect("signals");
    assert!(text.contains("srunning-down ") && text.contains("sboth "));
}

/// Nothing is drawn outside the page.
#[test]
fn everything_is_on_the_page() {
    for trace in [CODEC, GROUND, POSITION, PATTERN] {
        let svg = draw(trace, Replies::MustAgree, None);
        let places = |name: &str| -> Vec<f64> {
            let name = format!(" {name}=\"");
            svg.split(name.as_str()).skip(1).filter_map(|rest| rest.split('"').next()?.parse().ok()).collect()
        };
        for name in ["x", "x1", "x2"] {
            assert!(places(name).iter().all(|x| (0.0..=1000.0).contains(x)), "{name}");
        }
        let height = places("height").into_iter().fold(0.0, f64::max);
        for name in ["y", "y1", "y2"] {
            assert!(places(name).iter().all(|y| (0.0..=height).contains(y)), "{name}");
        }
        for points in svg.split(" points=\"").skip(1).filter_map(|rest| rest.split('"').next()) {
            for point in points.split(' ') {
                let (x, y) = point.split_once(',').expect("a point");
                let (x, y): (f64, f64) = (x.parse().expect("a number"), y.parse().expect("a number"));
                assert!((0.0..=1000.0).contains(&x) && (0.0..=height).contains(&y), "{point}");
            }
        }
    }
}
