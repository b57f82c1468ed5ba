//! Stations of both sizes on one line: everything around a device has the sets of a large station, and a small one's are a part of them.

use atc_kernel::interlocking::{
    CircuitSet, Input, Large, Movement, Orders, PointSet, Positions, RouteSet, SegmentSet, Size, Small,
};

/// Circuits of a station of either size.
pub type Circuits = CircuitSet<Large>;
/// Points of a station of either size.
pub type Points = PointSet<Large>;
/// Routes of a station of either size.
pub type Routes = RouteSet<Large>;
/// Segments of a station of either size.
pub type Segments = SegmentSet<Large>;

macro_rules! wide {
    ($($kind:ident $wide:ident $narrow:ident;)*) => {
        /// A size of station, whose sets become those of a large one, and back.
        pub trait Wide: Size {
            $(
                /// The same in a large station.
                fn $wide(set: $kind<Self>) -> $kind<Large>;
                /// The same in a station of this size: what it has room for.
                fn $narrow(set: $kind<Large>) -> $kind<Self>;
            )*
        }

        impl Wide for Small {
            $(
                fn $wide(set: $kind<Self>) -> $kind<Large> {
                    $kind::from_words([set.bits(), 0, 0, 0])
                }

                fn $narrow(set: $kind<Large>) -> $kind<Self> {
                    let [first, ..] = set.words();
                    $kind::from_bits(first)
                }
            )*
        }

        impl Wide for Large {
            $(
                fn $wide(set: $kind<Self>) -> $kind<Large> {
                    set
                }

                fn $narrow(set: $kind<Large>) -> $kind<Self> {
                    set
                }
            )*
        }
    };
}

wide! {
    CircuitSet wide_circuits narrow_circuits;
    PointSet wide_points narrow_points;
    RouteSet wide_routes narrow_routes;
    SegmentSet wide_segments narrow_segments;
}

/// Positions in a large station.
pub fn wide_positions<Z: Wide>(positions: Positions<Z>) -> Positions<Large> {
    Positions { normal: Z::wide_points(positions.normal), reverse: Z::wide_points(positions.reverse) }
}

/// A telegram in a large station.
pub fn wide_movement<Z: Wide>(movement: Movement<Z>) -> Movement<Large> {
    let Movement { stop, heading, speed, hold } = movement;
    Movement { stop, heading, speed, hold: Z::wide_circuits(hold) }
}

/// What a station of this size reads.
pub fn narrow<Z: Wide>(input: Input<Large>) -> Input<Z> {
    let Orders { block, unblock, restrict, speed, lift } = input.orders;
    Input {
        occupied: Z::narrow_circuits(input.occupied),
        detected: Positions {
            normal: Z::narrow_points(input.detected.normal),
            reverse: Z::narrow_points(input.detected.reverse),
        },
        request: input.request,
        orders: Orders {
            block: Z::narrow_circuits(block),
            unblock: Z::narrow_circuits(unblock),
            restrict: Z::narrow_circuits(restrict),
            speed,
            lift: Z::narrow_circuits(lift),
        },
        consent: Z::narrow_segments(input.consent),
    }
}
