//! The drawn charts of block counting: what stands in them, against times that are known by hand.

use atc_oracle::chart::{self, View};
use atc_oracle::trace::{Replies, Trace};
use atc_tests::drawing::{self, titles};
use atc_tests::session;

const FIGURE_8: &str = include_str!("../../../../oracle/examples/figure-8.jsonl");
const EXAMPLES: &str = include_str!("../../../../oracle/examples/block-count.jsonl");

fn draw(trace: &str, replies: Replies) -> String {
    drawing::draw(trace, replies, None)
}

#[test]
fn figure_8_in_titles() {
    let svg = draw(FIGURE_8, Replies::MustAgree);
    assert_eq!(
        titles(&svg),
        [
            "0 verified: accepted: 1000 to 2000 ms",
            "unverified: 0 to 2000 ms",
            "in force: 2000 to 48000 ms",
            "differ 2000 ms: 0 to 2000 ms",
            "agree: 2000 to 48000 ms",
            "all 2000 ms: 0 to 2000 ms",
            "detected 6000 ms: 4000 to 10000 ms",
            "detected 6000 ms: 12000 to 18000 ms",
            "detected 10000 ms: 20000 to 30000 ms",
            "all 2000 ms: 0 to 2000 ms",
            "detected 6000 ms: 10000 to 16000 ms",
            "detected 10000 ms: 18000 to 28000 ms",
            "detected 8000 ms: 30000 to 38000 ms",
            "all 2000 ms: 0 to 2000 ms",
            "detected 10000 ms: 16000 to 26000 ms",
            "detected 8000 ms: 28000 to 36000 ms",
            "detected 6000 ms: 38000 to 44000 ms",
        ]
    );
    // The two staircases, with their numbers, and the headways.
    let texts: Vec<_> = svg.lines().map(str::trim).filter(|line| !line.starts_with('<')).collect();
    let after = |label: &str| {
        let place = texts.iter().position(|text| *text == label).expect(label);
        texts[place + 1..].iter().take_while(|text| text.parse::<u8>().is_ok()).copied().collect::<String>()
    };
    assert_eq!((after("C1, detections").as_str(), after("C2, checks").as_str()), ("0123210", "0123210"));
    assert_eq!(texts.iter().filter(|text| **text == "8000 ms").count(), 3);
    assert_eq!(texts.iter().filter(|text| **text == "10000 ms").count(), 1);
    assert!(!svg.contains("pending") && !svg.contains("asked") && !svg.contains("DIFFERS"));
}

/// Two cases: a missed detection, holds and pending check-outs; and faults with refused resets.
#[test]
fn the_other_rows_are_drawn_where_they_are_needed() {
    let bars = titles(&draw(EXAMPLES, Replies::MustAgree));
    for bar in [
        "differ 3000 ms: 22000 to 25000 ms",
        "all 3000 ms: 22000 to 25000 ms",
        "1 pending: 25000 to 26000 ms",
        "1 pending: 44000 to 47000 ms",
        "held 8000 ms: 30000 to 38000 ms",
        "0 verified: refused: 12000 to 13000 ms",
        "1 verified: accepted: 14000 to 15000 ms",
        "check-out-at-zero: 21000 to 25000 ms",
        "check-in-stays-on: 38000 to 44000 ms",
        "all: 28000 to 44000 ms",
    ] {
        assert!(bars.contains(&bar.to_owned()), "{bar} is not among {bars:#?}");
    }
    let svg = draw(EXAMPLES, Replies::MustAgree);
    for label in ["taken over ahead", "asked by ahead", "asked of behind", "check-outs", "fault, reset refused"] {
        assert!(svg.contains(label), "{label}");
    }
}

/// Wrong replies: refused, or drawn in red where they are, each with what the record says.
#[test]
fn a_difference_is_refused_or_drawn() {
    let mut lines = session::replies(FIGURE_8.as_bytes());
    // Replies 1 to 48 are those of cycles 0 to 47; the train is in section 0 from cycle 3 on.
    assert!(lines[5].contains(r#""occupied":[0]"#), "{}", lines[5]);
    lines[5] = lines[5].replace("[0]", "[1]");
    lines[6] = lines[6].replace(r#""count":1"#, r#""count":7"#).replace("null", "\"check-in-stays-on\"");
    lines[20] = lines[20].replace(r#""agree":true"#, r#""agree":false"#);
    lines[30] = lines[30].replace(r#""behind_hold_sections":0"#, r#""behind_hold_sections":2"#);
    lines[40] = lines[40].replace(r#""counting":true"#, r#""counting":false"#);
    let trace = format!("{FIGURE_8}{}", lines.join("\n"));
    let parsed = Trace::parse(&trace).expect("a trace");
    let error = chart::svg(&parsed, Replies::MustAgree, &View::default()).expect_err("a difference");
    assert_eq!(error.line, FIGURE_8.lines().count() + 6);
    let svg = draw(&trace, Replies::AsRecorded);
    assert!(svg.contains("THE RECORD DIFFERS FROM THE KERNEL, first at 5000 ms."));
    let bars = titles(&svg);
    assert_eq!(
        bars[bars.len() - 5..],
        [
            "occupied [1]: 5000 to 6000 ms",
            "count 7, fault check-in-stays-on: 6000 to 7000 ms",
            "agree false: 20000 to 21000 ms",
            "behind_hold_sections 2: 30000 to 31000 ms",
            "counting false: 40000 to 41000 ms",
        ]
    );
    let signals = chart::vcd(&parsed, Replies::AsRecorded).expect("signals");
    assert!(signals.contains("record_says") && signals.contains("soccupied_[1] "));
}

/// The VCD as a viewer reads it.
#[test]
fn the_signals_of_figure_8() {
    use vcd::{Command, Parser};
    let text = chart::vcd(&Trace::parse(FIGURE_8).expect("a trace"), Replies::MustAgree).expect("signals");
    let mut parser = Parser::new(text.as_bytes());
    let header = parser.parse_header().expect("a header");
    let code = |name: &str| header.find_var(&["case_1_block_count", name]).expect(name).code;
    let (count, section) = (code("c2_checks"), code("occupied_2"));
    for name in ["check_in", "check_out", "ahead_entered", "heard_0", "agree", "behind_hold_sections", "c1_detections"]
    {
        code(name);
    }
    let (mut now, mut counts, mut reports) = (0, Vec::new(), Vec::new());
    for command in parser.map(|command| command.expect("a command")) {
        match command {
            Command::Timestamp(at) => now = at / 1000,
            Command::ChangeReal(id, number) if id == count && !number.is_nan() => {
                counts.push(format!("{now}:{number}"));
            }
            Command::ChangeString(id, name) if id == section => reports.push(format!("{now}:{name}")),
            _ => {}
        }
    }
    assert_eq!(counts, ["2:0", "4:1", "12:2", "20:3", "26:2", "36:1", "44:0"]);
    let expected = ["0:all", "2:free", "16:detected", "26:free", "28:detected", "36:free", "38:detected", "44:free"];
    assert_eq!(reports, expected);
}

/// Sixteen sections, all rows, and no number or bar outside the page.
#[test]
fn the_largest_block_is_drawn() {
    let start = r#"{"start":{"protocol":1,"machine":"block-count","config":{"sections":16,"max_trains":16,"tail_hold_sections":2}}}"#;
    let reset =
        r#"{"step":{"check_in":false,"check_out":false,"present":[0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15],"reset":16}}"#;
    let svg = draw(&format!("{start}\n{reset}\n{reset}\n{reset}\n"), Replies::MustAgree);
    assert!(svg.contains("section 15 occupied") && svg.contains("section 15 hears"));
    let places = |name: &str| -> Vec<f64> {
        let name = format!(" {name}=\"");
        svg.split(name.as_str()).skip(1).filter_map(|rest| rest.split('"').next()?.parse().ok()).collect()
    };
    assert!(places("x").iter().all(|x| (0.0..=1000.0).contains(x)));
    let height = places("height").into_iter().fold(0.0, f64::max);
    assert!(places("y").iter().all(|y| (0.0..=height).contains(y)));
}
