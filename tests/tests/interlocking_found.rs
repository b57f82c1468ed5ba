//! Situations that the models and the comparison of implementations found, drawn: a route that was never set, the point under a train's
//! front, blocks on plain line, turning a line over trains, a speed code that is not in the table, and what is unknown.
//!
//! How to read a chart: `atc_tests::station_chart`. The station: `atc_tests::passing_loop`.

use atc_kernel::interlocking::{
    CircuitSet, Input, Orders, PointId, Position, Positions, Refusal, Request, RouteId, SegmentId, SegmentSet, State,
    Travel,
};
use atc_tests::passing_loop::{EASTWARD, INWARD, loop_station};
use atc_tests::sketch::{Sketch, Way};
use atc_tests::station_chart::{Lines, Small, check};

// ---- Routes and their trains -----------------------------------------------------------------------------------------------

/// A train runs past the signal into a route whose point has never arrived: the route is no train's, neither while its release time
/// runs nor after it, and it is released when the train is gone.
#[test]
fn a_route_that_was_never_set_grants_nothing_and_follows_no_train() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b      ####..........
        occ c      ..########....
        occ e      .......#####..
        point P    nn............
        point Q    rrrrrrrrrrrrrr
        set 1      .#............
        withdraw 1 ...#..........
        drives P   .r............
        phase 1    .pprrrrrrrrr..
        signal 1   ..............
        stop b     ..............
        stop c     ..............
        stop e     ..............
        held c     .11111111111..
        held e     .11111111111..
        held f     .11111111111..
        ",
    );
}

/// The front may still stand before the point of its own circuit.
#[test]
fn a_train_is_told_to_stop_while_the_point_under_it_is_not_right() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b     ###......
        occ c     .########
        point P   nnn.nxrnn
        set 0     #........
        phase 0   suuuuuuuu
        stop c    .dd.d..dd
        ",
    );
}

/// The last occupied circuit has not been entered in order: whatever is there is not the route's train.
#[test]
fn what_is_before_the_train_has_no_authority() {
    let mut station = loop_station();
    // One route right through, from W to E.
    let out = station.routes[2].clone();
    let through = &mut station.routes[0];
    through.path.extend(out.path);
    (through.overlap, through.beyond, through.to) = ((vec![], vec![]), out.beyond, out.to);
    through.continuing = vec![];
    check(
        &station,
        EASTWARD,
        "
        occ b     ##.....
        occ c     .#..##.
        occ d     ..#####
        set 0     #......
        phase 0   suuuuuu
        stop c    .h.....
        stop d    ....hhh
        ",
    );
}

// ---- Blocks on plain line --------------------------------------------------------------------------------------------------

/// The neighbour is no longer permitted to send at once; but what it has sent may come until the turn time is over.
#[test]
fn a_block_on_a_line_that_trains_come_from_waits_for_the_turn_time() {
    check(
        &loop_station(),
        EASTWARD,
        "
        block a     .#.......
        turn W      ...a.....
        answer      ...w.....
        permits W   #........
        confirmed a ......###
        ",
    );
}

/// A train in the segment or in its throat is on its way, whichever circuit of it is blocked.
#[test]
fn a_block_on_a_line_waits_for_a_train_that_goes_out() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ f       ##....
        occ g       .###..
        block h     #.....
        stop f      ......
        stop g      ......
        confirmed h ....##
        ",
    );
}

/// A route out to a blocked line: its signal falls and comes back, and while it is held nobody may rely on the block.
#[test]
fn a_block_on_a_line_and_the_routes_out_to_it() {
    check(
        &loop_station(),
        EASTWARD,
        "
        set 2       #..........
        block h     ..#...#....
        unblock h   ....#......
        withdraw 2  ........#..
        set 3       .........#.
        answer      +.......+b.
        phase 2     ssssssss...
        signal 2    ##..##.....
        confirmed h ........###
        ",
    );
}

/// A line with a block gets no direction, and the neighbour is not permitted to send.
#[test]
fn a_line_with_a_block_is_not_turned() {
    check(
        &loop_station(),
        INWARD,
        "
        block h   .#........
        unblock h ........#.
        consent E ##########
        turn E    ..ta...a.a
        answer    ..bw...w.+
        permits E #.........
        ",
    );
    // Unblocked, the line has the direction that it had.
    check(
        &loop_station(),
        INWARD,
        "
        block h   .#....
        unblock h ...#..
        permits E #..###
        ",
    );
}

// ---- A block between a train and its signal --------------------------------------------------------------------------------

const WESTWARD: Lines = Lines { west: Travel::Away, east: Travel::Toward };

/// The loop, with f on the approach of the route from d to b.
fn turned_back() -> Sketch {
    let mut station = loop_station();
    station.routes[6].approach = vec![3, 5];
    station
}

/// A train changes ends in f, and staff are in d: the signal behind them is not for it.
#[test]
fn a_train_that_changes_ends_is_not_let_over_a_block_to_its_signal() {
    check(
        &turned_back(),
        WESTWARD,
        "
        occ f       ##########
        block d     .#........
        unblock d   ......#...
        set 6       ...#....#.
        answer      ...b....+.
        signal 6    ........##
        confirmed d .#####....
        ",
    );
    // Where nobody is in f, the block concerns nobody who looks at the signal.
    check(
        &turned_back(),
        WESTWARD,
        "
        block d     .#........
        set 6       ...#......
        answer      ...+......
        occ f       .......###
        signal 6    ...####...
        confirmed d .#########
        ",
    );
}

/// It has seen the signal, and may be on its way: the block stops it, and staff wait until it stands.
#[test]
fn a_block_waits_for_a_train_that_may_be_on_its_way_to_the_signal() {
    check(
        &turned_back(),
        WESTWARD,
        "
        occ f       ################
        set 6       .#..............
        block d     ...#............
        withdraw 6  .......#........
        signal 6    .##.............
        confirmed d ............####
        ",
    );
}

// ---- Turning a line over trains --------------------------------------------------------------------------------------------

#[test]
fn a_line_is_not_taken_from_the_train_in_its_throat() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ f     ###.....
        occ g     ..##....
        turn E    .t.t.t..
        answer    .d.d.+..
        permits E .....###
        stop f    ........
        ",
    );
}

/// The train came on a permission that was withdrawn since. Nobody could ever let it in if the line had to be clear.
#[test]
fn a_train_that_the_neighbour_has_sent_is_let_in() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ a     ..##....
        occ b     ...#####
        turn W    a.a.t...
        set 0     ......#.
        answer    w.d.+.+.
        permits W ....####
        stop a    ........
        stop b    ......dd
        ",
    );
}

// ---- Speed codes and what is unknown ---------------------------------------------------------------------------------------

/// The circuits ahead are longer than any braking distance can be written: the highest code is that of the table all the same.
#[test]
fn a_code_that_is_not_in_the_table_is_never_sent() {
    let mut station = loop_station();
    station.lengths = vec![40_000; 8];
    check(
        &station,
        EASTWARD,
        "
        occ a   #..
        occ b   ..#
        occ g   .#.
        set 0   ..#
        stop a  b..
        stop b  ..d
        stop g  .h.
        speed a 300
        speed b 003
        speed g 030
        ",
    );
}

/// Numbers that the layout has room for and does not use, and numbers that it has no room for.
#[test]
fn what_is_not_there_is_unknown() {
    let mut station = loop_station();
    // The one route from d to b, the point that it needs, the one segment that it leads to.
    station.routes = vec![Way { conflicts: vec![], ..station.routes[6].clone() }];
    station.points.truncate(1);
    station.segments.truncate(1);
    let layout = Small::new(station.plan()).expect("a station");
    let quiet = Input {
        occupied: CircuitSet::EMPTY,
        detected: Positions::of(PointId::ZERO, Position::Normal),
        request: None,
        orders: Orders { unblock: CircuitSet::ALL, lift: CircuitSet::ALL, ..Orders::default() },
        consent: SegmentSet::ALL,
    };
    let mut state = State::INITIAL;
    for _ in 0..station.turn {
        state = layout.cycle(state, quiet).0;
    }
    let route = |number| RouteId::new(number).expect("a route");
    let point = |number| PointId::new(number).expect("a point");
    let segment = |number| SegmentId::new(number).expect("a segment");
    for request in [
        Request::Set(route(1)),
        Request::Set(route(63)),
        Request::Withdraw(route(1)),
        Request::Withdraw(route(63)),
        Request::Drive(point(1), Position::Normal),
        Request::Drive(point(31), Position::Normal),
        Request::Turn(segment(1), Travel::Toward),
        Request::Turn(segment(1), Travel::Away),
        Request::Turn(segment(7), Travel::Away),
    ] {
        let (after, output) = layout.cycle(state, Input { request: Some(request), ..quiet });
        let (unasked, _) = layout.cycle(state, quiet);
        assert_eq!((after, output.answer), (unasked, Some(Err(Refusal::Unknown))), "{request:?}");
    }
    for (request, answer) in [
        (Request::Turn(segment(0), Travel::Away), Ok(())),
        (Request::Drive(point(0), Position::Reverse), Ok(())),
        (Request::Withdraw(route(0)), Err(Refusal::NotHeld)),
        (Request::Set(route(0)), Err(Refusal::Direction)),
    ] {
        let (_, output) = layout.cycle(state, Input { request: Some(request), ..quiet });
        assert_eq!(output.answer, Some(answer), "{request:?}");
    }
}
