//! The drawn timing charts: what stands in them, against times that are known by hand.

use atc_oracle::chart::{self, View};
use atc_oracle::trace::{Replies, Trace};
use atc_tests::drawing::{self, titles};
use atc_tests::session;

const FIGURE_3: &str = include_str!("../../../../oracle/examples/figure-3.jsonl");
const FIGURE_6: &str = include_str!("../../../../oracle/examples/figure-6.jsonl");
const FIGURE_7: &str = include_str!("../../../../oracle/examples/figure-7.jsonl");
const SUPERVISION: &str = include_str!("../../../../oracle/examples/supervision.jsonl");

fn draw(trace: &str) -> String {
    drawing::draw(trace, Replies::MustAgree, None)
}

fn assert_bars(svg: &str, expected: &[&str]) {
    assert_eq!(titles(svg), expected);
}

#[test]
fn figure_3_in_titles() {
    assert_bars(
        &draw(FIGURE_3),
        &[
            "T2 400 ms: 600 to 1000 ms",
            "T3: 350 ms of 400: 1000 to 1350 ms",
            "T1 300 ms: 0 to 300 ms",
            "T5 100 ms, after 650 ms ≤ T4: 1250 to 1350 ms",
            "no display: 0 to 300 ms",
            "45 km/h: 300 to 1850 ms",
        ],
    );
}

#[test]
fn figure_6_in_titles() {
    assert_bars(
        &draw(FIGURE_6),
        &[
            "T1 300 ms: 1450 to 1750 ms",
            "T2 400 ms: 600 to 1000 ms",
            "T3: 50 ms of 400: 1000 to 1050 ms",
            "T2 400 ms: 1150 to 1550 ms",
            "T3: 200 ms of 400: 1550 to 1750 ms",
            "dropped 200 ms: 1750 to 1950 ms",
            "T1 300 ms: 0 to 300 ms",
            "T1 300 ms, after 150 ms > T4: 750 to 1050 ms",
            "no display: 0 to 300 ms",
            "45 km/h: 300 to 1750 ms",
            "90 km/h: 1750 to 2150 ms",
        ],
    );
}

#[test]
fn figure_7_in_two_panels() {
    let svg = draw(FIGURE_7);
    assert!(svg.contains("case 1") && svg.contains("case 2"));
    let bars = titles(&svg);
    assert!(bars.contains(&"T3: 550 ms of 800: 1000 to 1550 ms".to_owned()), "{bars:?}");
    assert!(bars.contains(&"T3 400 ms: 1000 to 1400 ms".to_owned()), "{bars:?}");
    assert!(bars.contains(&"no display: 1400 to 1550 ms".to_owned()), "{bars:?}");
}

#[test]
fn a_recovery_time_of_one_cycle_is_drawn() {
    let start = r#"{"start":{"protocol":1,"machine":"aspect-acceptance","config":{"aspects_km_h":[25],"operate_ms":20,"recovery_ms":10,"mask_ms":30,"shortened_operate_ms":10}}}"#;
    let step = |heard: &str| format!("{{\"step\":{{\"detected_km_h\":[{heard}]}}}}\n");
    let steps: String = ["25", "25", "", "", "", "", "", ""].map(step).concat();
    assert_bars(
        &draw(&format!("{start}\n{steps}")),
        &[
            "T2 10 ms: 20 to 30 ms",
            "T3 30 ms: 30 to 60 ms",
            "T1 20 ms: 0 to 20 ms",
            "no display: 0 to 20 ms",
            "25 km/h: 20 to 60 ms",
            "no display: 60 to 80 ms",
        ],
    );
}

#[test]
fn supervision_in_titles() {
    let bars = titles(&draw(SUPERVISION));
    assert_eq!(bars[..3], ["emergency: 0 to 1 cycles", "release: 1 to 5 cycles", "service: 5 to 8 cycles"]);
}

/// A chart can stand in any page: no script, no style sheet, no id, nothing from elsewhere; and text is escaped.
#[test]
fn a_chart_is_safe_to_embed() {
    let trace = Trace::parse(FIGURE_7).expect("a trace");
    let view = View { title: Some("<script>alert(1)</script> & co".to_owned()), ..View::default() };
    let svg = chart::svg(&trace, Replies::MustAgree, &view).expect("a chart");
    assert!(svg.contains("&lt;script&gt;alert(1)&lt;/script&gt; &amp; co"));
    for forbidden in ["<script", "<style", " id=", "href", "url(", "<image", "<foreignObject"] {
        assert!(!svg.contains(forbidden), "{forbidden}");
    }
    assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"));
}

/// One wrong reply: refused, or drawn in red where it is, and only there.
#[test]
fn a_difference_is_refused_or_drawn() {
    let mut lines = session::replies(FIGURE_3.as_bytes());
    assert_eq!(lines[10], r#"{"output":{"display_km_h":45}}"#);
    lines[10] = r#"{"output":{"display_km_h":null,"note":"more may be said"}}"#.to_owned();
    let trace = Trace::parse(&format!("{FIGURE_3}{}", lines.join("\n"))).expect("a trace");
    let error = chart::svg(&trace, Replies::MustAgree, &View::default()).expect_err("a difference");
    assert_eq!(error.line, FIGURE_3.lines().count() + 11);
    let svg = chart::svg(&trace, Replies::AsRecorded, &View::default()).expect("a chart");
    assert!(svg.contains("THE RECORD DIFFERS FROM THE KERNEL, first at 500 ms."));
    let recorded: Vec<_> = titles(&svg).into_iter().rev().take(4).collect();
    assert_eq!(
        recorded,
        ["45 km/h: 550 to 1850 ms", "no display: 500 to 550 ms", "45 km/h: 300 to 500 ms", "no display: 0 to 300 ms"]
    );
    assert!(chart::vcd(&trace, Replies::AsRecorded).expect("signals").contains("display_as_recorded"));
    assert!(!draw(FIGURE_3).contains("DIFFERS"));
}

#[test]
fn a_view_shows_its_part() {
    let trace = Trace::parse(FIGURE_3).expect("a trace");
    let view = View { from: Some(500), to: Some(1100), ..View::default() };
    let svg = chart::svg(&trace, Replies::MustAgree, &view).expect("a chart");
    assert_bars(&svg, &["T2 400 ms: 600 to 1000 ms", "T3: 350 ms of 400: 1000 to 1350 ms", "45 km/h: 300 to 1850 ms"]);
}

/// The VCD as a viewer reads it: the names of the states at their times.
#[test]
fn the_signals_of_figure_3() {
    use vcd::{Command, Parser, ScopeItem};
    let trace = Trace::parse(FIGURE_3).expect("a trace");
    let text = chart::vcd(&trace, Replies::MustAgree).expect("signals");
    let mut parser = Parser::new(text.as_bytes());
    let header = parser.parse_header().expect("a header");
    let scope = header.find_scope(&["case_1_aspect_acceptance"]).expect("the scope of the case");
    assert_eq!(scope.items.iter().filter(|item| matches!(item, ScopeItem::Var(_))).count(), 4 * 3 + 2);
    let state = header.find_var(&["case_1_aspect_acceptance", "state_45_km_h"]).expect("the state").code;
    let display = header.find_var(&["case_1_aspect_acceptance", "display"]).expect("the display").code;
    let (mut now, mut states, mut displays) = (0, Vec::new(), Vec::new());
    for command in parser.map(|command| command.expect("a command")) {
        match command {
            Command::Timestamp(at) => now = at,
            Command::ChangeString(id, name) if id == state => states.push((now, name)),
            Command::ChangeString(id, name) if id == display => displays.push((now, name)),
            _ => {}
        }
    }
    let at = |at: u64, name: &str| (at, name.to_owned());
    // A state holds from the end of the logic cycle (50 ms) that led to it.
    assert_eq!(
        states,
        [
            at(0, "none"),
            at(50, "operating_T1"),
            at(300, "accepted"),
            at(650, "recovery"),
            at(1000, "masked"),
            at(1350, "accepted")
        ]
    );
    assert_eq!(displays, [at(0, "none"), at(300, "45_km/h")]);
    assert_eq!(now, 1850);
}
