//! JPS5937270B2, Figure 8, and then every fault and the pending check-outs of one block, drawn as charts and
//! checked against the kernel and against a process that speaks the oracle's protocol (see `atc_tests::device::device`).
//!
//! How to read a chart: `atc_tests::block_chart`. If nothing else is said the block has three sections, at most three trains, no
//! tail hold, and a pass time of ten cycles.

use atc_protocol::machine::block::Config;
use atc_tests::block_chart::{BlockChart, check};
use atc_tests::device;

fn block() -> Config {
    Config { sections: 3, max_trains: 3, tail_hold_sections: 0, cycle_ms: 1000, pass_ms: 10_000 }
}

/// Figure 8: three trains enter a block of three sections one after the other, stand in it together, and leave.
const FIGURE_8: &str = "
    reset     .0.........................
    in        ...##..##..##..............
    out       ...............##...##..##.
    hears 0   ...###.###.######..........
    hears 1   ......###.######.####......
    hears 2   .........######.####.###...
    count     000111122223333222221111000
    status    ucccccccccccccccccccccccccc
    reports 0 a..ddd.ddd.dddddd..........
    reports 1 a.....ddd.dddddd.dddd......
    reports 2 a........dddddd.dddd.ddd...
    ";

#[test]
fn figure_8_three_trains_in_three_sections() {
    check(&block(), FIGURE_8);
}

/// The same three trains, with one detection missed for two cycles: everything is occupied for these two, and no longer.
#[test]
fn figure_8_with_a_missed_detection() {
    check(
        &block(),
        "
        reset     .0.........................
        in        ...##..##..##..............
        out       ...............##...##..##.
        hears 0   ...###.###.######..........
        hears 1   ......###.##..##.####......
        hears 2   .........######.####.###...
        count     000111122223333222221111000
        status    ucccccccccccccccccccccccccc
        reports 0 a..ddd.ddd.daaddd..........
        reports 1 a.....ddd.ddaadd.dddd......
        reports 2 a........dddaad.dddd.ddd...
        ",
    );
}

// ---- Faults (BLK-3) --------------------------------------------------------------------------------------------------------

#[test]
fn a_check_out_at_zero_is_a_fault_even_with_a_check_in() {
    check(
        &block(),
        "
        reset     0....0.....
        in        ........#..
        out       ..#.....#..
        hears 0   ........###
        count     00000000000
        status    cczzzccczzz
        reports 0 ..aaa...aaa
        reports 1 ..aaa...aaa
        reports 2 ..aaa...aaa
        ",
    );
}

#[test]
fn a_check_in_at_the_maximum_is_a_fault_even_with_a_check_out() {
    check(
        &Config { max_trains: 2, ..block() },
        "
        reset     0........
        in        .#.#..#..
        out       ......#..
        hears 0   .#.####..
        hears 1   ..####...
        count     011222222
        status    ccccccmmm
        reports 0 .d.dddaaa
        reports 1 ..ddddaaa
        reports 2 ......aaa
        ",
    );
}

/// A pass time of 4.999 s is 4 cycles: the fifth with the level on is the fault. After it no edge is counted (column 7).
#[test]
fn a_check_in_that_stays_on_is_a_fault() {
    check(
        &Config { pass_ms: 4999, ..block() },
        "
        reset     0........0.
        in        .#####.#...
        hears 0   .#####.....
        count     01111111100
        status    cccccsssscc
        reports 0 .ddddaaaa..
        reports 1 .....aaaa..
        reports 2 .....aaaa..
        ",
    );
}

/// It makes no edge for the next train, which so stays in the count.
#[test]
fn a_check_out_that_stays_on_keeps_trains_in_the_count() {
    check(
        &block(),
        "
        reset     0..........
        in        .#.#.......
        out       ....#######
        hears 0   .#.#.......
        hears 1   ..#.#......
        hears 2   ...#.#.....
        count     01121111111
        status    ccccccccccc
        reports 0 .d.d..aaaaa
        reports 1 ..d.d.aaaaa
        reports 2 ...d.daaaaa
        ",
    );
}

#[test]
fn a_lost_check_in_shows_and_faults_at_the_exit() {
    check(
        &block(),
        "
        reset     0.......
        out       .....#..
        hears 0   ..#.....
        hears 1   ...#....
        hears 2   ....#...
        count     00000000
        status    ccccczzz
        reports 0 ..aaaaaa
        reports 1 ..aaaaaa
        reports 2 ..aaaaaa
        ",
    );
}

#[test]
fn a_spurious_check_out_shows() {
    check(
        &block(),
        "
        reset     0......
        in        .#.....
        out       ...#...
        hears 0   .######
        count     0110000
        status    ccccccc
        reports 0 .ddaaaa
        reports 1 ...aaaa
        reports 2 ...aaaa
        ",
    );
}

/// The limit of the comparison (T-BLK-6): a train that is missed and a phantom at the same time. Section 0 is reported FREE in
/// column 3, and no longer than the two coincide.
#[test]
fn a_missed_train_and_a_phantom_agree() {
    check(
        &block(),
        "
        reset     0....
        in        .#...
        hears 0   .##..
        hears 2   ...#.
        count     01111
        status    ccccc
        reports 0 .dd.a
        reports 1 ....a
        reports 2 ...da
        ",
    );
}

/// Condition `loops-overlap`: a head that is heard before its check-in acts as a phantom. Another train, missed in the same cycle,
/// is reported FREE (section 1 in column 4).
#[test]
fn a_head_heard_before_its_check_in_hides_one_that_is_missed() {
    check(
        &block(),
        "
        reset     0.......
        in        .#...#..
        hears 0   .#..####
        hears 1   ..##.###
        count     01111222
        status    cccccccc
        reports 0 .d..dddd
        reports 1 ..dd.ddd
        reports 2 ........
        ",
    );
}

/// And so does one that is still heard after its check-out took effect (section 0 in column 5).
#[test]
fn a_head_heard_after_its_check_out_hides_one_that_is_missed() {
    check(
        &block(),
        "
        reset     0.......
        in        .#.#....
        out       .....#..
        hears 0   .#.##.##
        hears 1   ..#.....
        hears 2   ...###..
        count     01122111
        status    cccccccc
        reports 0 .d.dd.dd
        reports 1 ..d.....
        reports 2 ...ddd..
        ",
    );
}

/// At the exit of a line nothing else is needed: the head is past the check-out, and is missed itself (all free in column 6).
#[test]
fn a_head_past_the_check_out_of_a_line_is_free_once_it_is_missed() {
    check(
        &block(),
        "
        reset     0.......
        in        .#......
        out       .....#..
        hears 0   ..#.....
        hears 1   ...#....
        hears 2   ....##.#
        count     01111000
        status    cccccccc
        reports 0 .ad..a.a
        reports 1 .a.d.a.a
        reports 2 .a..da.a
        ",
    );
}

/// Condition `verified-reset`: a block is reset while a head is past its check-in, and not in it yet. The head is in no count, and free once it is missed.
#[test]
fn a_head_between_check_in_and_block_is_in_no_count_after_a_reset() {
    check(
        &block(),
        "
        reset     0..0....
        in        .#......
        hears 0   .....#.#
        count     01100000
        status    cccccccc
        reports 0 .aa..a.a
        reports 1 .aa..a.a
        reports 2 .aa..a.a
        ",
    );
}

// ---- Pending check-outs (BLK-6) --------------------------------------------------------------------------------------------

#[test]
fn a_check_out_is_pending_until_the_block_ahead_has_the_train() {
    check(
        &block(),
        "
        reset     0........
        in        .#.......
        out       ....#....
        ahead     .......#.
        hears 0   .#.......
        hears 1   ..#......
        hears 2   ...#.....
        count     011111100
        status    ccccccccc
        reports 0 .d..aaa..
        reports 1 ..d.aaa..
        reports 2 ...daaa..
        ",
    );
}

#[test]
fn two_pending_check_outs_are_taken_over_one_by_one() {
    check(
        &block(),
        "
        reset     0..........
        in        .#.#.......
        out       ....#.#....
        ahead     ........#.#
        hears 0   .#.#.......
        hears 1   ..#.#......
        hears 2   ...#.#.....
        count     01122222110
        status    ccccccccccc
        reports 0 .d.daaaaaa.
        reports 1 ..d.aaaaaa.
        reports 2 ...daaaaaa.
        ",
    );
}

/// One more check-out than trains that are not pending is a fault; what was pending is still taken over (column 8).
#[test]
fn a_check_out_when_all_are_pending_is_a_fault() {
    check(
        &block(),
        "
        reset     0.........
        in        .#........
        out       ....#.#...
        ahead     ........#.
        hears 0   .#........
        hears 1   ..#.......
        hears 2   ...#......
        count     0111111100
        status    cccccczzzz
        reports 0 .d..aaaaaa
        reports 1 ..d.aaaaaa
        reports 2 ...daaaaaa
        ",
    );
}

// ---- The charts themselves -----------------------------------------------------------------------------------------------------

/// A chart that is wrong in any one sign of what is put out is refused, by the kernel and by the process.
#[test]
fn a_wrong_chart_is_refused() {
    let kernel = block().block().unwrap();
    let mut wrong = 0;
    for (start, row) in FIGURE_8.lines().scan(0, |at, line| {
        let start = *at;
        *at += line.len() + 1;
        Some((start, line))
    }) {
        let others = match row.split_whitespace().next() {
            Some("count") => "09",
            Some("status") => "uczms",
            Some("reports") => ".dha",
            _ => continue,
        };
        let signs = row.len() - row.split_whitespace().last().unwrap().len()..row.len();
        for (place, other) in signs.flat_map(|place| others.chars().map(move |other| (place, other))) {
            if !row[place..].starts_with(other) {
                let mut chart = FIGURE_8.to_owned();
                chart.replace_range(start + place..=start + place, &other.to_string());
                let parsed = BlockChart::parse(&chart, 3).unwrap();
                assert!(parsed.check_kernel(kernel).is_err(), "{chart}");
                // A process is started for each: a few are enough.
                if wrong % 50 == 0 {
                    assert!(parsed.check_process(&device::device(), &block()).is_err(), "{chart}");
                }
                wrong += 1;
            }
        }
    }
    assert!(wrong > 300, "{wrong} wrong charts");
}

/// Charts that say nothing, or not what they seem to, are refused before they are run.
#[test]
fn a_chart_that_cannot_be_read_is_refused() {
    let whole = "in .\ncount 0\nstatus u\nreports 0 a\n";
    assert!(BlockChart::parse(whole, 1).is_ok());
    let cases = [
        (whole.replace("count 0\n", ""), "no row \"count\""),
        (whole.replace("status u\n", ""), "no row \"status\""),
        (whole.replace("reports 0 a\n", ""), "no row \"reports 0\""),
        (whole.replace("in .", "in .."), "another length"),
        (whole.replace("in .", "in x"), "neither on"),
        (whole.replace("in .", "into ."), "cannot be called"),
        (whole.replace("in .", "hears 1 ."), "cannot be called"),
        (format!("{whole}in .\n"), "not twice"),
        (whole.replace("in .", "reset x"), "not a digit"),
        (whole.replace("status u", "status x"), "not a sign"),
        (whole.replace("count 0", "count x"), "not a sign"),
        (whole.replace("0 a", "0 x"), "not a sign"),
        (format!("{whole}in"), "not a row"),
    ];
    for (chart, fragment) in cases {
        let error = BlockChart::parse(&chart, 1).expect_err(&chart);
        assert!(error.0.contains(fragment), "{chart}: {error}");
    }
}
