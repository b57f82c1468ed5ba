//! The situations of `spec/interlocking.md` before a train moves, drawn: requests and why they are refused, reservation, withdrawal
//! and approach locking.
//!
//! How to read a chart: `atc_tests::station_chart`. The station: `atc_tests::passing_loop`.

use atc_kernel::interlocking::Position;
use atc_tests::passing_loop::{EASTWARD, INWARD, loop_station};
use atc_tests::sketch::Way;
use atc_tests::station_chart::check;

// ---- Requests and why they are refused -------------------------------------------------------------------------------------

#[test]
fn a_route_is_set_at_once_if_its_points_stand_right() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b     ######
        set 0     .#.#..
        withdraw 6 ....#.
        answer    .+.hn.
        phase 0   .sssss
        signal 0  .#####
        stop b    .ddddd
        speed b   022222
        held c    .00000
        held d    .00000
        held f    .00000
        ",
    );
}

#[test]
fn routes_that_are_in_the_way() {
    // Of the same path, of the other track, over the overlap from the other side; the route that continues is not in the way.
    check(
        &loop_station(),
        INWARD,
        "
        set 0     #.....
        set 1     .#....
        set 4     ..#...
        set 5     ...#..
        drive P   ....r.
        drive Q   .....r
        answer    +pppll
        phase 0   ssssss
        phase 4   ......
        ",
    );
    check(
        &loop_station(),
        EASTWARD,
        "
        set 0     #...
        set 2     .#..
        set 3     ..#.
        answer    ++p.
        phase 2   .sss
        held f    0***
        ",
    );
}

#[test]
fn a_declared_conflict() {
    let mut station = loop_station();
    station.routes[2].conflicts.push(0);
    station.routes[0].conflicts.push(2);
    check(
        &station,
        EASTWARD,
        "
        set 2     #..
        set 0     .#.
        set 1     ..#
        answer    +cv
        phase 0   ...
        ",
    );
}

/// Its overlap is wanted by a route from the other side: both overlaps would lie under the other's path.
#[test]
fn an_overlap_that_is_held() {
    let mut station = loop_station();
    // A short route to f alone, whose path is the other's overlap.
    station.routes[4].path.truncate(1);
    station.routes[4].overlap = (vec![], vec![]);
    station.routes[4].continuing = vec![];
    check(
        &station,
        INWARD,
        "
        set 4     #..
        set 0     .#.
        answer    +v.
        phase 0   ...
        ",
    );
}

/// Two overlaps are never held over one circuit, whatever goes on behind them.
#[test]
fn two_overlaps_over_one_circuit() {
    let mut station = loop_station();
    // A route to e alone, from the other side, with the overlap that route 0 has too.
    station.routes[3] = Way {
        leftward: true,
        entry: 6,
        approach: vec![6],
        path: vec![(4, vec![])],
        overlap: station.routes[0].overlap.clone(),
        beyond: vec![2],
        from: Some(1),
        to: None,
        ..station.routes[3].clone()
    };
    station.routes[1].continuing = vec![];
    check(
        &station,
        INWARD,
        "
        set 0     #..
        set 3     .#.
        answer    +v.
        phase 3   ...
        ",
    );
}

#[test]
fn a_point_that_another_route_holds_otherwise() {
    let mut station = loop_station();
    // The flank of route 2 wants P reverse.
    station.routes[2].path[0].1.push((0, Position::Reverse));
    check(
        &station,
        EASTWARD,
        "
        point P   rrr
        set 2     #..
        set 0     .#.
        drive P   ..n
        answer    +ll
        ",
    );
}

#[test]
fn occupied_blocked_and_a_point_under_a_train() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ d     ##......
        occ c     ....##..
        block f   ..#.....
        unblock f ...#....
        point P   nnnnnnnn
        set 0     .##.....
        drive P   ....r.r.
        drive Q   ...r....
        answer    .ob+u.+.
        drives P  ......r.
        drives Q  ...r....
        ",
    );
    let mut station = loop_station();
    // A flank point stands under a train, and would have to move.
    station.routes[2].path[0].1.push((0, Position::Reverse));
    check(
        &station,
        EASTWARD,
        "
        occ c     ##.
        set 2     #.#
        answer    u.+
        drives P  ..r
        ",
    );
}

#[test]
fn what_is_not_held_cannot_be_withdrawn() {
    check(
        &loop_station(),
        EASTWARD,
        "
        set 0      ..#.
        withdraw 0 #..#
        answer     n.++
        phase 0    ..s.
        ",
    );
}

// ---- Reservation -----------------------------------------------------------------------------------------------------------

#[test]
fn a_point_arrives_and_the_route_is_set() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b     #######
        point P   nn..rrr
        point Q   rrrrrrr
        set 1     .#.....
        drives P  .rrr...
        phase 1   .pppsss
        signal 1  ....###
        stop b    ....eee
        speed b   0000222
        ",
    );
}

#[test]
fn a_point_does_not_arrive_and_the_route_fails_until_it_is_withdrawn() {
    check(
        &loop_station(),
        EASTWARD,
        "
        point P    nn........n
        point Q    rrrrrrrrrrr
        set 1      .#.........
        set 0      .......#.#.
        withdraw 1 ........#..
        answer     .+.....p++.
        drives P   .rrrr....n.
        phase 1    .pppffff...
        phase 0    .........pp
        ",
    );
}

/// Something runs into the path while the points move: the drive is withdrawn, the route fails, and its withdrawal takes time.
#[test]
fn a_train_under_a_point_that_is_being_driven() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ c      ..#######..
        point P    nn.........
        point Q    rrrrrrrrrrr
        set 1      .#.........
        withdraw 1 ......#....
        drives P   .r.........
        phase 1    .pppffrrrrr
        ",
    );
}

#[test]
fn a_signal_is_suspended_while_something_is_not_as_it_must_be() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b     ##########
        occ f     ....#.....
        point P   nn.nxnnnnn
        block d   ......#...
        unblock d ........#.
        set 0     #.........
        phase 0   ssssssssss
        signal 0  ##.#.#..##
        stop b    dd.d.d..dd
        confirmed d ..........
        ",
    );
}

// ---- Withdrawal and approach locking ---------------------------------------------------------------------------------------

#[test]
fn a_withdrawn_route_is_free_at_once_if_nobody_comes() {
    check(
        &loop_station(),
        EASTWARD,
        "
        set 0      #...
        withdraw 0 ..#.
        signal 0   ##..
        phase 0    ss..
        held c     00..
        ",
    );
}

/// A train at the signal: the authority goes at once, the locks after the release time; asking again starts it anew.
#[test]
fn a_withdrawn_route_stays_locked_while_a_train_comes() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b      ############
        set 0      #...........
        set 1      ....#.......
        withdraw 0 ..#..#......
        answer     +.+.p+......
        signal 0   ##..........
        stop b     dd..........
        phase 0    ssrrrrrrrr..
        held c     0000000000..
        ",
    );
}

/// The train passed the signal: the route goes on protecting it, and tells it nothing.
#[test]
fn a_train_that_could_not_stop_keeps_its_route() {
    check(
        &loop_station(),
        EASTWARD,
        "
        occ b      #####.........
        occ c      ...#####......
        occ d      ......########
        set 0      #.............
        withdraw 0 ..#...........
        phase 0    ssrrrrrrrrrrrr
        held c     00000000......
        held d     00000000000000
        held f     0000000000....
        stop c     ..............
        ",
    );
}
