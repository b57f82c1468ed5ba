//! The situations of `spec/interlocking.md` with trains under way, drawn: release behind a train, overlaps, blocks, the direction of
//! plain line, and what trains are told.
//!
//! How to read a chart: `atc_tests::station_chart`. The station: `atc_tests::passing_loop`.

use atc_kernel::interlocking::Travel;
use atc_tests::passing_loop::{EASTWARD, INWARD, loop_station};
use atc_tests::station_chart::{Lines, check};

// ---- A train runs through --------------------------------------------------------------------------------------------------

#[test]
fn release_behind_a_train_and_its_overlap_after_the_stay() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b     ####..............
        occ c     ..#####...........
        occ d     .....##########...
        occ f     .............####.
        occ g     ................##
        set 0     #.................
        set 2     ..........#.......
        phase 0   ssuuuuuuuuuuuuu...
        phase 2   ..........sssuuuu.
        held c    0000000...........
        held d    000000000000000...
        held f    000000000.2222222.
        stop b    dd................
        stop c    ..ddd.............
        stop d    ..........hhh.....
        stop f    .............hhh..
        ",
    );
}

/// The stay time begins anew when the circuit clears in between.
#[test]
fn the_stay_is_counted_without_a_break() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b     ##..........
        occ c     .#####......
        occ d     ...##.######
        set 0     #...........
        held f    00000000....
        phase 0   suuuuuuuuuuu
        ",
    );
}

/// Nothing is released by a circuit that flickers: the one before was not occupied with it.
#[test]
fn a_flicker_in_the_path_releases_nothing() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b      #########
        occ d      ..#.#....
        set 0      #........
        signal 0   ##.......
        phase 0    ssuuuuuuu
        held c     000000000
        held d     000000000
        ",
    );
}

/// Something in the path that did not come over the entry circuit has not entered, and nothing is released behind it.
#[test]
fn what_did_not_come_in_order_has_not_entered() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ c      ..#....
        occ d      ...##..
        set 0      #......
        phase 0    ssuuuuu
        held c     0000000
        stop c     .......
        ",
    );
}

/// A train whose shunt is lost for longer than the time to clear: its circuit is not released, because the next was not entered.
#[test]
fn a_train_that_is_lost_keeps_its_route() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b      ###......
        occ c      ..##..##.
        occ d      .......##
        set 0      #........
        phase 0    ssuuuuuuu
        held c     00000000.
        held d     000000000
        ",
    );
}

// ---- Blocks ----------------------------------------------------------------------------------------------------------------

#[test]
fn a_block_under_a_set_route_stops_trains_at_once_and_protects_when_the_route_is_gone() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b       ######.........
        set 0       #..............
        block c     ..#............
        withdraw 0  ....#..........
        set 6       ............#..
        signal 0    ##.............
        stop b      dd.............
        phase 0     ssssrrrrr......
        confirmed c .........######
        answer      +...+.......b..
        ",
    );
}

// ---- Direction -------------------------------------------------------------------------------------------------------------

/// To turn a line outwards the own permission goes first, and for longer than telegrams live, and the neighbour must permit.
#[test]
fn a_line_turns_outwards_with_consent_and_after_the_turn_time() {
    check(
        &loop_station(),
        INWARD,
        "
        occ h     ##..........
        consent E ......######
        turn E    a..aa.aa....
        set 2     .........#..
        turn W    ..........a.
        answer    d..ww.++.+w.
        permits E ###.........
        ",
    );
}

#[test]
fn a_line_does_not_turn_against_a_route() {
    check(
        &loop_station(),
        Lines { west: Travel::Toward, east: Travel::Away },
        "
        set 2      #......
        turn E     .t.t...
        withdraw 2 ..#....
        set 4      ....#..
        set 3      .....#.
        answer     +d+++p.
        permits E  ...####
        ",
    );
}

/// The route that a train came in by needs the line only until the train has left the first circuit of it.
#[test]
fn a_line_is_free_once_the_train_is_in() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b     ###......
        occ c     .####....
        occ d     ....#####
        consent W #########
        set 0     #........
        turn W    ...a.a.aa
        answer    +..d.w.w+
        ",
    );
}

// ---- What trains are told --------------------------------------------------------------------------------------------------

/// Two trains in the same direction: the second learns only what the first has left.
#[test]
fn a_train_follows_another() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ a     .......#####
        occ b     ##......####
        occ c     .###........
        occ d     ...##.......
        occ f     ....###.....
        occ g     ......######
        set 0     #...........
        set 2     .#..........
        stop a    .......b....
        stop b    d...........
        stop c    .hh.........
        stop d    ...h........
        stop f    ....hh......
        stop g    ......hhhhhh
        speed b   200000000000
        speed f   000022000000
        ",
    );
}

/// On plain line a train learns the circuits that are free ahead of it, up to the next train or block. A train in the throat that no route
/// out has brought there learns nothing.
#[test]
fn trains_on_plain_line() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ f     ##......
        occ g     .##...##
        occ h     ##.#....
        occ a     ....####
        block b   .....#..
        unblock b ......#.
        stop f    ........
        stop g    ..h...hh
        stop h    ........
        stop a    ....b.bb
        ",
    );
}

/// Two routes from one circuit to either side: whose train is meant nobody would know, and the second is refused.
#[test]
fn opposing_starts_are_refused() {
    check(
        &loop_station(),
        Lines { west: Travel::Away, east: Travel::Away },
        "
        occ d     #######
        set 2     .#.....
        set 6     ...#...
        answer    .+.c...
        signal 2  .######
        stop d    .hhhhhh
        ",
    );
}

/// With a time to clear, a short loss of the shunt is no gap.
#[test]
fn a_short_loss_of_shunt_clears_nothing() {
    let mut station = loop_station();
    station.clear = 3;
    check(
        &station,
        EASTWARD,
        "
        occ c     ..##..#....
        set 0     ....##...#.
        answer    ....oo...+.
        ",
    );
}
