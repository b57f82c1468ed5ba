//! The timing charts of JP3886280B2, Figures 3, 6 and 7, and of the rules that go beyond them, checked against the
//! kernel and against a process that speaks the oracle's protocol (see `atc_tests::device::device`).
//!
//! How to read a chart: `atc_tests::timing_chart`. If nothing else is said the times are those of the patent's
//! \[0051\] with T4 = 800 ms: T1 = 300, T2 = T3 = 400, T5 = 100 ms, and a column is 50 ms.

use atc_kernel::aspect::{AspectId, Display};
use atc_protocol::Kmh;
use atc_protocol::machine::aspect::Config;
use atc_tests::device;
use atc_tests::timing_chart::{ChartError, TimingChart};

/// Permitted speeds for the letters A, B, C, D.
fn line() -> Config {
    Config::with_defaults(vec![Kmh(250), Kmh(450), Kmh(650), Kmh(900)])
}

/// The same without the shortened operate time: no interruption is short enough for it.
fn conventional() -> Config {
    Config { interruption_ms: 0, ..line() }
}

fn check(config: &Config, chart: &str) {
    check_columns(config, 50, chart);
}

fn check_columns(config: &Config, column_ms: u32, chart: &str) {
    if let Err(error) = compare(config, column_ms, chart) {
        panic!("{error}\n{chart}");
    }
}

fn compare(config: &Config, column_ms: u32, chart: &str) -> Result<(), ChartError> {
    let chart = TimingChart::parse(chart, column_ms, config.cycle_ms)?;
    let times = config.times().map_err(|refusal| ChartError(refusal.what))?;
    let detections = chart.detections();
    let said = |device: &str| {
        let device = device.to_owned();
        move |error: ChartError| ChartError(format!("{device}: {error}"))
    };
    chart.compare(&device::kernel(times, &detections)).map_err(said("kernel"))?;
    if config.interruption_ms == 0 {
        chart.compare(&device::kernel(times.conventional(), &detections)).map_err(said("kernel, conventional"))?;
    }
    let program = device::device();
    let shown = device::process(&program, config, &detections)
        .map_err(|refused| said("device")(ChartError(refused.to_string())))?;
    let shown: Vec<_> = shown
        .into_iter()
        .map(|speed| {
            let Some(speed) = speed else { return Ok(Display::NOTHING) };
            let rank = config.aspects_km_h.iter().position(|known| *known == speed);
            let aspect = rank.and_then(|rank| u8::try_from(rank).ok()).and_then(AspectId::new);
            aspect.map(Display::of).ok_or_else(|| ChartError(format!("{speed} km/h is no aspect of the line")))
        })
        .collect::<Result<_, _>>()?;
    chart.compare(&shown).map_err(said("device"))
}

// ---- The patent's figures ------------------------------------------------------------------------------------------

/// Figure 6: A is accepted after T1; a loss shorter than T2 does not show; a longer one runs into the mask; and the
/// mask ends, before its time, when B has been heard for T1.
#[test]
fn figure_6_operate_recovery_and_mask() {
    check(
        &conventional(),
        "
        ms       0     300   600            1350  1650
        B        .............................##############
        A        ############...########....................
        display  ......AAAAAAAAAAAAAAAAAAAAAAAAAAAAABBBBBBBB
        ",
    );
}

/// Figure 7, the solid line: without T5 a long mask is needed to carry the display over an interruption.
#[test]
fn figure_7_a_long_mask_bridges_the_interruption() {
    check(
        &Config { mask_ms: 800, ..conventional() },
        "
        ms       0     300   600          1250  1550
        A        ############.............############
        display  ......AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA
        ",
    );
}

/// Figure 7, the broken line: with a short mask the display fails although the signal is back.
#[test]
fn figure_7_a_short_mask_drops_the_display() {
    check(
        &conventional(),
        "
        ms       0     300   600             1400
        A        ############.............############
        display  ......AAAAAAAAAAAAAAAAAAAAAA...AAAAAA
        ",
    );
}

/// Figure 3: the same short mask and the same interruption, and T5 carries the display over it.
#[test]
fn figure_3_the_shortened_operate_time_bridges_it() {
    check(
        &line(),
        "
        ms       0     300   600          1250
        A        ############.............############
        display  ......AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA
        ",
    );
}

// ---- Acceptance and loss -------------------------------------------------------------------------------------------

/// ACC-1: a detection shorter than T1 is nothing, however often it comes.
#[test]
fn acc_1_bursts_below_the_operate_time_are_not_accepted() {
    check(
        &line(),
        "
        A        #####.#####.#####...######.
        display  ..........................A
        ",
    );
}

/// ACC-2: of two, the lower one; and a lower one takes over as soon as it is accepted.
#[test]
fn acc_2_the_lowest_wins() {
    check(
        &line(),
        "
        C        ..########################
        B        ##########################
        A        ..........################
        display  ......BBBBBBBBBBAAAAAAAAAA
        ",
    );
}

/// ACC-4 and ACC-6: silence ends the display T2 + T3 after the loss.
#[test]
fn acc_6_silence_ends_the_display() {
    check(
        &line(),
        "
        ms       0     300 500             1300
        A        ##########....................
        display  ......AAAAAAAAAAAAAAAAAAAA....
        ",
    );
}

/// Re-detection does not restart the age: a glitch of one column does not hold an aspect up.
#[test]
fn acc_6_a_glitch_does_not_restart_the_age() {
    check(
        &line(),
        "
        ms       0     300 500             1300
        A        ##########......#.............
        display  ......AAAAAAAAAAAAAAAAAAAA....
        ",
    );
}

/// ACC-5: in the mask of B the lower A is accepted. B is dropped, and stays so.
#[test]
fn acc_5_a_lower_aspect_ends_the_mask() {
    check(
        &line(),
        "
        ms       0     300 500       1000  1300
        B        ##########....................
        A        ..............################
        display  ......BBBBBBBBBBBBBBAAAAAAAAAA
        ",
    );
}

/// ACC-7: B heard for T1 drops the masked A for good: when B is then lost as well, A does not come back, although
/// its T2 + T3 would last to 1650 ms.
#[test]
fn acc_7_a_drop_is_not_revoked() {
    check(
        &Config { recovery_ms: 50, mask_ms: 1000, interruption_ms: 400, ..line() },
        "
        ms       0     300   600   900          1550
        B        ............######............
        A        ############..................
        display  ......AAAAAAAAAAAABBBBBBBBBBBB
        ",
    );
}

// ---- ACC-9: no rise without evidence -------------------------------------------------------------------------------

/// Two aspects are lost one after the other. When A is gone B is still masked, but nobody hears it: no display.
#[test]
fn acc_9_no_rise_in_silence() {
    check(
        &line(),
        "
        ms       0     300   600             1400
        B        ################....................
        A        ############........................
        display  ......AAAAAAAAAAAAAAAAAAAAAA........
        ",
    );
}

/// B comes back on T5 while A is masked. When A is gone B may be displayed only once it has been heard for T1.
#[test]
fn acc_9_no_rise_on_a_short_detection() {
    check(
        &line(),
        "
        ms       0     300   600         1200  1500
        B        ############............############
        A        ############........................
        display  ......AAAAAAAAAAAAAAAAAAAAAA..BBBBBB
        ",
    );
}

/// What was displayed last is kept while nothing is: an aspect that is not above it needs no T1.
#[test]
fn acc_9_the_last_display_is_kept_while_nothing_is_displayed() {
    check(
        &line(),
        "
        ms       0     300   600            1350
        A        ############...............######
        display  ......AAAAAAAAAAAAAAAAAAAAAA.AAAA
        ",
    );
}

// ---- ACC-8: the limits of the shortened operate time, to the cycle -------------------------------------------------

/// T1 = 6, T2 = T3 = 8, T5 = 2 cycles, and a column is one cycle.
fn fine(interruption_ms: u32) -> Config {
    Config { operate_ms: 60, recovery_ms: 80, mask_ms: 80, interruption_ms, shortened_operate_ms: 20, ..line() }
}

/// g = 14 = T4, and g + T5 = T2 + T3 exactly: bridged without a gap.
#[test]
fn acc_8_an_interruption_of_exactly_t4_is_short() {
    check_columns(
        &fine(140),
        10,
        "
        ms       0     60              220
        A        ########..............########
        display  ......AAAAAAAAAAAAAAAAAAAAAAAA
        ",
    );
}

/// g = 15, one cycle over T4: the full operate time.
#[test]
fn acc_8_an_interruption_one_cycle_over_t4_is_not() {
    check_columns(
        &fine(140),
        10,
        "
        ms       0     60               230   290
        A        ########...............########
        display  ......AAAAAAAAAAAAAAAAAA.....AA
        ",
    );
}

/// g = 15 = T4, but g + T5 is one cycle over T2 + T3: the aspect expires, and its credit brings it back after T5.
#[test]
fn acc_8_the_credit_outlives_expiry() {
    check_columns(
        &fine(150),
        10,
        "
        ms       0     60               230
        A        ########...............########
        display  ......AAAAAAAAAAAAAAAAAA.AAAAAA
        ",
    );
}

/// The same at the limit of the mask: re-detected in the very cycle of expiry there is no credit, whatever T4 says.
#[test]
fn acc_8_no_credit_from_expiry_on() {
    check_columns(
        &fine(800),
        10,
        "
        ms       0     60                240
        A        ########................########
        display  ......AAAAAAAAAAAAAAAAAA......AA
        ",
    );
}

/// A credit is used up with its detection: after another silence T1 is needed.
#[test]
fn acc_8_an_interrupted_run_past_expiry_loses_the_credit() {
    check_columns(
        &fine(150),
        10,
        "
        ms       0     60                   270   330
        A        ########...............#.#.########
        display  ......AAAAAAAAAAAAAAAAAA.........AA
        ",
    );
}

// ---- The charts themselves -----------------------------------------------------------------------------------------

/// A chart that is wrong by one cycle anywhere is refused: the check can fail, for the kernel and for the oracle.
#[test]
fn a_wrong_chart_is_refused() {
    let right = "
        A        ########...............########
        display  ......AAAAAAAAAAAAAAAAAA.AAAAAA
        ";
    assert!(compare(&fine(150), 10, right).is_ok());
    let display = right.find("......A").expect("the display row");
    for place in display..display + 31 {
        let mut wrong = right.to_owned();
        let other = if &wrong[place..=place] == "." { "A" } else { "." };
        wrong.replace_range(place..=place, other);
        assert!(compare(&fine(150), 10, &wrong).is_err(), "{wrong}");
    }
}

/// Charts that say nothing, or not what they seem to, are refused before they are run.
#[test]
fn a_chart_that_cannot_be_read_is_refused() {
    let cases = [
        ("A ##\n", "no display row"),
        ("A ###\ndisplay ..\n", "a row of 3 columns"),
        ("A #\nA #\ndisplay .\n", "two rows for aspect A"),
        ("Q #\ndisplay .\n", "cannot be called"),
        ("A x\ndisplay .\n", "neither heard"),
        ("A #\ndisplay #\n", "neither an aspect"),
        ("ms       0 50\nA        ####\ndisplay  ....\n", "wrong place"),
    ];
    for (chart, fragment) in cases {
        let error = TimingChart::parse(chart, 50, 10).expect_err(chart);
        assert!(error.0.contains(fragment), "{chart}: {error}");
    }
    assert!(TimingChart::parse("A #\ndisplay .\n", 25, 10).is_err());
    let begins = TimingChart::parse("A ##\ndisplay AA\n", 10, 10).expect("a chart");
    assert!(begins.compare(&begins.displays()).is_err(), "no device displays at the start");
}
