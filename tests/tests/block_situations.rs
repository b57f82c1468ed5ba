//! The special situations of `spec/block.md` that befall one block, and every reason to refuse a reset, drawn as charts: what is
//! reported, and what is left to others.
//!
//! How to read a chart: `atc_tests::block_chart`. If nothing else is said the block has three sections, at most three trains, no
//! tail hold, and a pass time of ten cycles.

use atc_protocol::machine::block::Config;
use atc_tests::block_chart::check;

fn block() -> Config {
    Config { sections: 3, max_trains: 3, tail_hold_sections: 0, cycle_ms: 1000, pass_ms: 10_000 }
}

// ---- Start-up and power loss -----------------------------------------------------------------------------------------------

/// Nothing is counted before a reset, not the train that enters; and a wrong number brings nothing into force.
#[test]
fn start_up_is_unverified_until_a_reset_with_the_right_number() {
    check(
        &block(),
        "
        reset     ....0..1...
        in        .##........
        hears 0   .#########.
        hears 1   ..........#
        count     00000001111
        status    uuuuuuucccc
        reports 0 aaaaaaaddd.
        reports 1 aaaaaaa...d
        reports 2 aaaaaaa....
        ",
    );
}

/// Power comes back with a train on the check-in: no reset while the level is on.
#[test]
fn power_loss_in_the_middle_of_a_train_that_enters() {
    check(
        &block(),
        "
        reset     ..1..1..
        in        ####....
        hears 0   ########
        count     00000111
        status    uuuuuccc
        reports 0 aaaaaddd
        reports 1 aaaaa...
        reports 2 aaaaa...
        ",
    );
}

/// Power comes back with a train on the check-out, its head in the block ahead, which kept its state: the level is no check-out,
/// there is no reset while it is on, and the tail goes on being held for the block ahead.
#[test]
fn power_loss_in_the_middle_of_a_train_that_leaves() {
    check(
        &Config { tail_hold_sections: 1, ..block() },
        "
        reset     .0..0....
        out       ###......
        asks      1111111..
        count     000000000
        status    uuuuccccc
        reports 0 aaaa.....
        reports 1 aaaa.....
        reports 2 aaaahhh..
        behind    111100000
        ",
    );
}

// ---- Boundaries ------------------------------------------------------------------------------------------------------------

#[test]
fn a_train_on_a_section_boundary_that_no_loop_hears() {
    check(
        &block(),
        "
        reset     0.........
        in        .##.......
        hears 0   .###......
        hears 1   .....#####
        count     0111111111
        status    cccccccccc
        reports 0 .ddda.....
        reports 1 ....addddd
        reports 2 ....a.....
        ",
    );
}

#[test]
fn a_train_on_a_section_boundary_that_two_loops_hear() {
    check(
        &block(),
        "
        reset     0.........
        in        .##.......
        hears 0   .####.....
        hears 1   ....######
        count     0111111111
        status    cccccccccc
        reports 0 .ddda.....
        reports 1 ....addddd
        reports 2 ....a.....
        ",
    );
}

/// What the machine cannot see (condition `overlapping-detectors`): while a train is heard twice, one missed detection elsewhere
/// brings the numbers together, and a section with a train (section 2 in column 8) is reported FREE.
#[test]
fn a_train_heard_twice_hides_one_that_is_missed() {
    check(
        &block(),
        "
        reset     0............
        in        .#...#.......
        hears 0   .##..####....
        hears 1   ...#....#####
        hears 2   ....####.####
        count     0111122222222
        status    ccccccccccccc
        reports 0 .dd..dddd....
        reports 1 ...d....ddddd
        reports 2 ....dddd.dddd
        ",
    );
}

/// The other way about: while a train on a gap is not heard, one phantom does the same (sections 0 and 1 in column 4).
#[test]
fn a_train_on_a_gap_is_hidden_by_a_phantom() {
    check(
        &block(),
        "
        reset     0.......
        in        .##.....
        hears 0   .###....
        hears 1   .....###
        hears 2   ....#...
        count     01111111
        status    cccccccc
        reports 0 .ddd....
        reports 1 .....ddd
        reports 2 ....d...
        ",
    );
}

#[test]
fn two_trains_in_one_section() {
    check(
        &block(),
        "
        reset     0.........
        in        .#..#.....
        hears 0   .#########
        hears 1   .......###
        count     0111222222
        status    cccccccccc
        reports 0 .dddaaaddd
        reports 1 ....aaaddd
        reports 2 ....aaa...
        ",
    );
}

// ---- Reversing, splitting, silence -----------------------------------------------------------------------------------------

/// It is counted in a second time by the check that it goes back over: everything is occupied until a reset.
#[test]
fn a_train_reverses_out_over_the_entry() {
    check(
        &block(),
        "
        reset     0........0.
        in        .##..##....
        hears 0   .#####.....
        count     01111222200
        status    ccccccccccc
        reports 0 .ddddaaaa..
        reports 1 .....aaaa..
        reports 2 .....aaaa..
        ",
    );
}

#[test]
fn a_train_reverses_out_of_a_full_block() {
    check(
        &Config { max_trains: 1, ..block() },
        "
        reset     0........0.
        in        .##..##....
        hears 0   .#####.....
        count     01111111100
        status    cccccmmmmcc
        reports 0 .ddddaaaa..
        reports 1 .....aaaa..
        reports 2 .....aaaa..
        ",
    );
}

/// It is heard and not counted; when it leaves for the second time, the empty count latches a fault.
#[test]
fn a_train_reverses_in_over_the_exit() {
    check(
        &block(),
        "
        reset     0............
        in        .#...........
        out       .....##...##.
        hears 0   .##..........
        hears 1   ...#.........
        hears 2   ....#...##...
        count     0111100000000
        status    cccccccccczzz
        reports 0 .dd.....aaaaa
        reports 1 ...d....aaaaa
        reports 2 ....d...aaaaa
        ",
    );
}

/// A part without a transmitter stays behind in section 0. It is held while the front is within k = 1 sections; from column 6 on,
/// with the front in section 2, its section is reported FREE while it stands there (condition `train-whole`).
#[test]
fn a_split_train_is_not_protected_beyond_the_hold() {
    check(
        &Config { tail_hold_sections: 1, ..block() },
        "
        reset     0........
        in        .##......
        hears 0   .##......
        hears 1   ...###...
        hears 2   ......###
        count     011111111
        status    ccccccccc
        reports 0 .ddhhh...
        reports 1 ...dddhhh
        reports 2 ......ddd
        behind    011000000
        ",
    );
}

/// The train is counted and not heard, and a number that says so is refused.
#[test]
fn a_transmitter_dies_within_the_block() {
    check(
        &block(),
        "
        reset     0.....1..
        in        .#.......
        hears 0   .##......
        count     011111000
        status    ccccccuuu
        reports 0 .ddaaaaaa
        reports 1 ...aaaaaa
        reports 2 ...aaaaaa
        ",
    );
}

// ---- Resets (BLK-4): refused for each reason, then accepted ----------------------------------------------------------------

#[test]
fn a_reset_with_another_number_than_detected_is_refused() {
    check(
        &block(),
        "
        reset     0..1.0.
        count     0000000
        status    cccuucc
        reports 0 ...aa..
        reports 1 ...aa..
        reports 2 ...aa..
        ",
    );
}

#[test]
fn a_reset_over_the_maximum_is_refused() {
    check(
        &Config { max_trains: 2, ..block() },
        "
        reset     0..3.2.
        hears 0   ...####
        hears 1   ...####
        hears 2   ...#...
        count     0000022
        status    cccuucc
        reports 0 ...aadd
        reports 1 ...aadd
        reports 2 ...aa..
        ",
    );
}

#[test]
fn a_reset_with_the_check_in_on_is_refused() {
    check(
        &block(),
        "
        reset     0..0.0.
        in        ...#...
        count     0000000
        status    cccuucc
        reports 0 ...aa..
        reports 1 ...aa..
        reports 2 ...aa..
        ",
    );
}

#[test]
fn a_reset_with_the_check_out_on_is_refused() {
    check(
        &block(),
        "
        reset     0.....0.0.
        in        .#........
        out       ....###...
        hears 0   .#........
        hears 1   ..#.......
        hears 2   ...#......
        count     0111000000
        status    ccccccuucc
        reports 0 .d....aa..
        reports 1 ..d...aa..
        reports 2 ...d..aa..
        ",
    );
}

#[test]
fn a_reset_with_a_check_out_pending_is_refused() {
    check(
        &block(),
        "
        reset     0.....0.0.
        in        .#........
        out       ....#.....
        ahead     ..........
        hears 0   .#........
        hears 1   ..#.......
        hears 2   ...#......
        count     0111110000
        status    ccccccuucc
        reports 0 .d..aaaa..
        reports 1 ..d.aaaa..
        reports 2 ...daaaa..
        ",
    );
}

/// The check-out was pending when the cycle began.
#[test]
fn a_reset_in_the_cycle_of_the_take_over_is_refused() {
    check(
        &block(),
        "
        reset     0.....0.0.
        in        .#........
        out       ....#.....
        ahead     ......#...
        hears 0   .#........
        hears 1   ..#.......
        hears 2   ...#......
        count     0111110000
        status    ccccccuucc
        reports 0 .d..aaaa..
        reports 1 ..d.aaaa..
        reports 2 ...daaaa..
        ",
    );
}
