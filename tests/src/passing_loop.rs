//! A passing loop, for charts of the interlocking.
//!
//! ```text
//!      W          P      d      Q          E
//!   a ═══ b │── c ──<─────────>── f ──│ g ═══ h        d and e are the tracks of the loop
//!                   \─── e ───/
//!
//!   route 0: b to d   2: d to g   4: g to d   6: d to b      over P and Q normal
//!   route 1: b to e   3: e to g   5: g to e   7: e to b      over P and Q reverse
//! ```
//!
//! 0, 1, 4 and 5 have an overlap over the point at the far end; the route that goes on there may run over it. Points may take 4
//! cycles, a withdrawn route stays locked for 5, a train stands for 3 before its overlap is given up, a segment turns after 3; a
//! circuit is clear at once.

use atc_kernel::interlocking::{Position, Travel};

use crate::sketch::{Line, Need, Sketch, Way};
use crate::station_chart::Lines;

/// Trains come from W and leave to E.
pub const EASTWARD: Lines = Lines { west: Travel::Toward, east: Travel::Away };
/// Trains come from both sides.
pub const INWARD: Lines = Lines { west: Travel::Toward, east: Travel::Toward };

fn route(entry: usize, path: &[(usize, Option<Need>)], overlap: Option<(usize, Need)>, beyond: usize) -> Way {
    let needs = |need: Option<Need>| need.into_iter().collect();
    Way {
        entry,
        approach: vec![entry],
        path: path.iter().map(|(circuit, need)| (*circuit, needs(*need))).collect(),
        overlap: overlap.map(|(circuit, need)| (vec![circuit], vec![need])).unwrap_or_default(),
        beyond: vec![beyond],
        drive: 4,
        release: 5,
        stay: 3,
        speed: 3,
        ..Way::default()
    }
}

/// The station.
#[expect(clippy::many_single_char_names, reason = "the names of the drawing")]
pub fn loop_station() -> Sketch {
    let (b, c, d, e, f, g) = (1, 2, 3, 4, 5, 6);
    let (p, q) = ((0, Position::Normal), (1, Position::Normal));
    let (p_reverse, q_reverse) = ((0, Position::Reverse), (1, Position::Reverse));
    let mut routes = vec![
        route(b, &[(c, Some(p)), (d, None)], Some((f, q)), f),
        route(b, &[(c, Some(p_reverse)), (e, None)], Some((f, q_reverse)), f),
        route(d, &[(f, Some(q))], None, g),
        route(e, &[(f, Some(q_reverse))], None, g),
        route(g, &[(f, Some(q)), (d, None)], Some((c, p)), c),
        route(g, &[(f, Some(q_reverse)), (e, None)], Some((c, p_reverse)), c),
        route(d, &[(c, Some(p))], None, b),
        route(e, &[(c, Some(p_reverse))], None, b),
    ];
    for (one, other) in [(0, 2), (1, 3), (4, 6), (5, 7)] {
        routes[one].continuing = vec![other];
    }
    for (number, way) in routes.iter_mut().enumerate() {
        match number {
            0 | 1 => way.from = Some(0),
            4 | 5 => way.from = Some(1),
            2 | 3 => way.to = Some(1),
            _ => way.to = Some(0),
        }
        way.leftward = number > 3;
        way.speed = if number % 2 == 0 { 3 } else { 2 };
    }
    Sketch {
        lengths: vec![200; 8],
        points: vec![vec![c], vec![f]],
        routes,
        segments: vec![
            Line { circuits: vec![1, 0], throat: Some(c), leftward: true },
            Line { circuits: vec![6, 7], throat: Some(f), leftward: false },
        ],
        braking: vec![0, 100, 300, 700],
        clear: 1,
        turn: 3,
        ..Sketch::default()
    }
    .apart()
}
