//! The machine as claimed, on charts.

use atc_kernel::aspect::{AspectId, AspectSet};
use atc_models::claimed::{State, step};
use atc_models::line::COARSE;

/// Runs the machine on a chart, a column a cycle of 100 ms, and draws what is displayed. `#`: detected.
fn displayed(low: &str, high: &str) -> String {
    let mut state = State::<2>::INITIAL;
    let columns = low.chars().zip(high.chars());
    columns
        .map(|(low, high)| {
            let detected = AspectSet::from_bits(u16::from(low == '#') | u16::from(high == '#') << 1);
            let (next, display) = step(COARSE.ticks(), state, detected);
            state = next;
            match display.aspect().map(AspectId::rank) {
                None => '.',
                Some(0) => 'l',
                Some(_) => 'h',
            }
        })
        .collect()
}

#[test]
fn accepts_holds_and_expires() {
    let low_ = "###...........";
    let high = "..............";
    let show = "..llllllll....";
    assert_eq!(displayed(low_, high), show);
}

#[test]
fn an_interruption_within_t4_ends_after_t5() {
    let low_ = "###.......#.....";
    let high = "................";
    let show = "..llllllllllllll";
    assert_eq!(displayed(low_, high), show);
}

#[test]
fn a_longer_interruption_ends_after_t1() {
    let low_ = "###........###";
    let high = "..............";
    let show = "..llllllll...l";
    assert_eq!(displayed(low_, high), show);
}

#[test]
fn the_lowest_wins_and_a_higher_one_ends_the_mask() {
    let low_ = "###.........";
    let high = "....#######.";
    let show = "..llllhhhhhh";
    assert_eq!(displayed(low_, high), show);
}

#[test]
fn rises_in_silence() {
    let low_ = "###.........";
    let high = "######......";
    let show = "..llllhhhhhh";
    assert_eq!(displayed(low_, high), show);
}

#[test]
fn rises_on_t5_past_a_masked_lower_aspect() {
    let low_ = "#####......";
    let high = "###......#.";
    let show = "..lllllllhh";
    assert_eq!(displayed(low_, high), show);
}

#[test]
fn of_two_masked_at_once_the_lower_stays() {
    let low_ = "###.........";
    let high = "###.........";
    let show = "..llllllll..";
    assert_eq!(displayed(low_, high), show);
}
