//! What C gives and gets: the plan in flat arrays, a cycle's input and its output.
//!
//! A structure with sets is written once, for sets `C` of circuits and of routes, `P` of points and `S` of segments. C has it
//! under two names, for a small station and for a large one.

/// The size of an interlocking in bytes.
pub const ATC_INTERLOCKING_SIZE: usize = 32072;
/// The alignment of an interlocking in bytes.
pub const ATC_INTERLOCKING_ALIGN: usize = 8;
/// The size of an interlocking of a large station in bytes.
pub const ATC_LARGE_INTERLOCKING_SIZE: usize = 899_424;
/// The alignment of an interlocking of a large station in bytes.
pub const ATC_LARGE_INTERLOCKING_ALIGN: usize = 8;

/// The most track circuits of a plan.
pub const ATC_MAX_CIRCUITS: usize = 64;
/// The most points of a plan.
pub const ATC_MAX_POINTS: usize = 32;
/// The most segments of a plan.
pub const ATC_MAX_SEGMENTS: usize = 8;
/// The most routes of a plan.
pub const ATC_MAX_ROUTES: usize = 64;
/// The most places of one route's path, and circuits of one segment.
pub const ATC_MAX_PLACES: usize = 16;
/// The most places of all paths of a plan.
pub const ATC_MAX_ELEMENTS: usize = 1024;
/// The most circuits of all segments of a plan.
pub const ATC_MAX_SEGMENT_CIRCUITS: usize = 128;
/// The most speed codes of a plan, 0 (stop) among them, of a large station too.
pub const ATC_MAX_CODES: usize = 8;

/// The most track circuits of a large station's plan.
pub const ATC_LARGE_MAX_CIRCUITS: usize = 256;
/// The most points of a large station's plan.
pub const ATC_LARGE_MAX_POINTS: usize = 128;
/// The most segments of a large station's plan.
pub const ATC_LARGE_MAX_SEGMENTS: usize = 32;
/// The most routes of a large station's plan.
pub const ATC_LARGE_MAX_ROUTES: usize = 256;
/// The most places of one route's path, and circuits of one segment, in a large station.
pub const ATC_LARGE_MAX_PLACES: usize = 32;
/// The most places of all paths of a large station's plan.
pub const ATC_LARGE_MAX_ELEMENTS: usize = 8192;
/// The most circuits of all segments of a large station's plan.
pub const ATC_LARGE_MAX_SEGMENT_CIRCUITS: usize = 1024;

/// No direction of travel.
pub const ATC_HEADING_NONE: u8 = 0;
/// Towards the ends of circuits that the plan calls left.
pub const ATC_HEADING_LEFT: u8 = 1;
/// Towards the ends of circuits that the plan calls right.
pub const ATC_HEADING_RIGHT: u8 = 2;

/// No request.
pub const ATC_REQUEST_NONE: u32 = 0;
/// Set the route `number`.
pub const ATC_REQUEST_SET: u32 = 1;
/// Withdraw the route `number`.
pub const ATC_REQUEST_WITHDRAW: u32 = 2;
/// Drive the point `number` to normal position, in this cycle.
pub const ATC_REQUEST_DRIVE_NORMAL: u32 = 3;
/// Drive the point `number` to reverse position, in this cycle.
pub const ATC_REQUEST_DRIVE_REVERSE: u32 = 4;
/// Give the segment `number` the direction towards this station: the neighbour sends.
pub const ATC_REQUEST_TURN_TOWARD: u32 = 5;
/// Give the segment `number` the direction away from this station: this station sends.
pub const ATC_REQUEST_TURN_AWAY: u32 = 6;

/// There was no request.
pub const ATC_ANSWER_NONE: u32 = 0;
/// The request is carried out.
pub const ATC_ANSWER_ACCEPTED: u32 = 1;
/// Refused: there is no route, point or segment of this number.
pub const ATC_ANSWER_UNKNOWN: u32 = 2;
/// Refused: the device has just started, and a train may still count on what was before.
pub const ATC_ANSWER_STARTING: u32 = 3;
/// Refused: the route to be set is held already.
pub const ATC_ANSWER_ALREADY_HELD: u32 = 4;
/// Refused: the route to be withdrawn is not held.
pub const ATC_ANSWER_NOT_HELD: u32 = 5;
/// Refused: a route that is declared to conflict is held.
pub const ATC_ANSWER_CONFLICT: u32 = 6;
/// Refused: a circuit of the path, or the point's detector, is held by another route.
pub const ATC_ANSWER_PATH_HELD: u32 = 7;
/// Refused: a circuit of the overlap is held by another route.
pub const ATC_ANSWER_OVERLAP_HELD: u32 = 8;
/// Refused: a point is needed or locked in another position by a route.
pub const ATC_ANSWER_POINT_LOCKED: u32 = 9;
/// Refused: a circuit of path or overlap is occupied.
pub const ATC_ANSWER_OCCUPIED: u32 = 10;
/// Refused: a train from before the start may still be on its way there.
pub const ATC_ANSWER_UNSWEPT: u32 = 11;
/// Refused: a circuit of path or overlap, the point's detector, or a circuit of the segment is blocked.
pub const ATC_ANSWER_BLOCKED: u32 = 12;
/// Refused: a point must move, and a train stands on it.
pub const ATC_ANSWER_POINT_UNDER_TRAIN: u32 = 13;
/// Refused: a segment does not have the direction that the route needs, or cannot turn because of a route or a train.
pub const ATC_ANSWER_DIRECTION: u32 = 14;
/// Refused: the permission to the neighbour is withdrawn, and the segment cannot be turned away yet.
pub const ATC_ANSWER_WAITING: u32 = 15;
/// Refused: a calling-on route without a train that waits at its signal, or without one in its berth.
pub const ATC_ANSWER_NOT_CALLED_FOR: u32 = 16;

/// Nothing is held.
pub const ATC_PHASE_IDLE: u8 = 0;
/// Reserved provisionally: its points are being driven.
pub const ATC_PHASE_PROVISIONAL: u8 = 1;
/// A point did not arrive in time; nothing is driven any more.
pub const ATC_PHASE_FAILED: u8 = 2;
/// Reserved: its points are locked and its signal may show proceed.
pub const ATC_PHASE_SET: u8 = 3;
/// A train has entered the path, or something has occupied it.
pub const ATC_PHASE_IN_USE: u8 = 4;
/// Withdrawn: nobody may enter, and everything stays locked until the release time has passed.
pub const ATC_PHASE_RELEASING: u8 = 5;

/// The plan as a whole.
pub const ATC_PLACE_PLAN: u32 = 0;
/// The route `first`.
pub const ATC_PLACE_ROUTE: u32 = 1;
/// The place `second` of the path of the route `first`.
pub const ATC_PLACE_PATH: u32 = 2;
/// The overlap of the route `first`.
pub const ATC_PLACE_OVERLAP: u32 = 3;
/// The routes `first` and `second`.
pub const ATC_PLACE_ROUTES: u32 = 4;
/// The point `first`.
pub const ATC_PLACE_POINT: u32 = 5;
/// The segment `first`.
pub const ATC_PLACE_SEGMENT: u32 = 6;
/// The segments `first` and `second`.
pub const ATC_PLACE_SEGMENTS: u32 = 7;
/// The track circuit `first`.
pub const ATC_PLACE_CIRCUIT: u32 = 8;

/// An interlocking with its plan and its state. Its bytes are the library's; it may be moved and copied as a whole.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct atc_interlocking {
    /// Not to be read or written.
    pub opaque: [u64; 4009],
}

/// An interlocking of a large station, as `atc_interlocking` is one of a small station.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct atc_large_interlocking {
    /// Not to be read or written.
    pub opaque: [u64; 112_428],
}

/// Circuits or routes of a large station: bit `i % 64` of word `i / 64` for the one of number `i`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_set256 {
    /// The bits, those of the lowest numbers in the first word.
    pub words: [u64; 4],
}

/// Points of a large station: bit `i % 32` of word `i / 32` for point `i`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_set128 {
    /// The bits, those of the lowest numbers in the first word.
    pub words: [u32; 4],
}

/// Segments of a large station: bit `i % 8` of word `i / 8` for segment `i`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_set32 {
    /// The bits, those of the lowest numbers in the first word.
    pub words: [u8; 4],
}

/// One place of a route's path, or its overlap: what is held there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct element_of<C, P> {
    /// The track circuit as a set of one. An overlap may have several, or none.
    pub circuits: C,
    /// The points that must stand normal, flank points included, as a set.
    pub normal: P,
    /// The points that must stand reverse, flank points included.
    pub reverse: P,
    /// The circuits beside it that are proved clear and not run over, as a set.
    pub beside: C,
}

/// A route: from the signal at the exit of `entry` over its path to the end of its last circuit.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct route_of<C, P, S> {
    /// The circuit in rear of the route's signal, as a set of one.
    pub entry: C,
    /// The circuits on which a train may be that counts on the signal: `entry` among them.
    pub approach: C,
    /// The circuits that adjoin the end of the route.
    pub beyond: C,
    /// The routes that go on where this one ends, as a set.
    pub continuing: C,
    /// The routes that must not be held together with this one.
    pub conflicts: C,
    /// What is kept free beyond the end, in case the train does not stop in time.
    pub overlap: element_of<C, P>,
    /// Where the path begins in the array `elements`.
    pub path_first: u16,
    /// How many places the path has: 1 to `ATC_MAX_PLACES`, of a large station `ATC_LARGE_MAX_PLACES`.
    pub path_length: u16,
    /// How many cycles the points may take to arrive, 1 or more.
    pub drive_cycles: u16,
    /// How many cycles a withdrawn route stays locked where a train may be coming.
    pub release_cycles: u16,
    /// How many cycles a train must have stood on the last circuit before the overlap is given up.
    pub stay_cycles: u16,
    /// The direction of travel: `ATC_HEADING_LEFT` or `ATC_HEADING_RIGHT`.
    pub heading: u8,
    /// The segment that the route's train comes from, as a set of one; 0 if it comes from none.
    pub from: S,
    /// The segment that the route's train goes out to, as a set of one; 0 if it goes to none.
    pub to: S,
    /// The highest speed code on the route: 1 to 7.
    pub speed_code: u8,
    /// The highest speed code on its overlap, 0 to 7: for a train that has slid there and goes back. 0 lets none of these leave.
    pub overlap_speed_code: u8,
    /// 1: every train that uses the route acts on telegrams alone, and not on what a driver sees. 0: some do not.
    pub cab_signalled: u8,
    /// 1: a calling-on route, whose train goes on sight into the overlap, the berth, where another one stands. 0: any other.
    pub calling_on: u8,
}

/// A stretch of plain line to a neighbouring station.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct segment_of<C> {
    /// The last circuit of every route that goes out to the segment, as a set of one; 0 if no route does.
    pub throat: C,
    /// Where its circuits begin in the array `segment_circuits`.
    pub circuits_first: u16,
    /// How many circuits it has: 1 to `ATC_MAX_PLACES`, of a large station `ATC_LARGE_MAX_PLACES`.
    pub circuits_length: u16,
    /// The direction of travel away from the station: `ATC_HEADING_LEFT` or `ATC_HEADING_RIGHT`.
    pub outward: u8,
    /// How many of its circuits, the outermost ones, the neighbour's device sees too.
    pub shared: u8,
}

/// The plan of a station in flat arrays. They are read by the call that gets them, and not kept. An array without an
/// entry may be null. A set is a word with bit `i` for the thing of number `i`; of a large station it is one of
/// `atc_set256`, `atc_set128` and `atc_set32`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct interlocking_config_of<C, P, S> {
    /// The length of each circuit in metres: `circuit_count` entries.
    pub lengths_m: *const u16,
    /// The line speed of each circuit as a code, 0 to 7: `circuit_count` entries. Null: no circuit has a limit.
    pub line_codes: *const u8,
    /// The circuits that say that a train may stand on a point, for each point as a set: `point_count` entries.
    pub detectors: *const C,
    /// The segments of plain line: `segment_count` entries.
    pub segments: *const segment_of<C>,
    /// The numbers of the segments' circuits, one segment after the other, the circuit next to the station first.
    pub segment_circuits: *const u8,
    /// The routes: `route_count` entries.
    pub routes: *const route_of<C, P, S>,
    /// The places of the routes' paths, one route after the other in order of travel.
    pub elements: *const element_of<C, P>,
    /// How far a train runs from the speed of each code when a lower one goes out, in metres: `code_count` entries.
    pub braking_m: *const u16,
    /// How many circuits there are: 0 to `ATC_MAX_CIRCUITS`, of a large station `ATC_LARGE_MAX_CIRCUITS`.
    pub circuit_count: usize,
    /// How many points there are: 0 to `ATC_MAX_POINTS`, of a large station `ATC_LARGE_MAX_POINTS`.
    pub point_count: usize,
    /// How many segments there are: 0 to `ATC_MAX_SEGMENTS`, of a large station `ATC_LARGE_MAX_SEGMENTS`.
    pub segment_count: usize,
    /// How many entries `segment_circuits` has: 0 to `ATC_MAX_SEGMENT_CIRCUITS`, of a large station `ATC_LARGE_MAX_SEGMENT_CIRCUITS`.
    pub segment_circuit_count: usize,
    /// How many routes there are: 0 to `ATC_MAX_ROUTES`, of a large station `ATC_LARGE_MAX_ROUTES`.
    pub route_count: usize,
    /// How many entries `elements` has: 0 to `ATC_MAX_ELEMENTS`, of a large station `ATC_LARGE_MAX_ELEMENTS`.
    pub element_count: usize,
    /// How many speed codes there are, 0 (stop) among them: 0 to `ATC_MAX_CODES`.
    pub code_count: usize,
    /// For how many cycles a segment's permission must have been withdrawn before it turns: 1 or more.
    pub turn_cycles: u16,
    /// For how many cycles after a start nothing moves, is confirmed or turned.
    pub start_cycles: u16,
    /// For how many cycles a train may run on after its authority was taken away.
    pub residual_cycles: u16,
    /// For how many cycles a train may still slide once it is wholly in the last circuit of a route.
    pub standstill_cycles: u16,
    /// How many cycles in a row a circuit must be reported clear before it counts as clear: 1 or more.
    pub clear_cycles: u8,
    /// For how many cycles in a row a point must be detected, undriven, before it counts as detected.
    pub settle_cycles: u8,
    /// For how many cycles in a row an occupied circuit may at most not be reported.
    pub loss_cycles: u8,
}

/// Where a plan breaks a rule. Everything is numbered from 0.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct atc_place {
    /// What is meant: one of the `ATC_PLACE_` constants.
    pub kind: u32,
    /// Its number; 0 if it has none.
    pub first: u32,
    /// The number of a place or of the other one; 0 if there is none.
    pub second: u32,
}

/// One logic cycle's input.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct interlocking_input_of<C, P, S> {
    /// The circuits that are reported occupied.
    pub occupied: C,
    /// The circuits that staff block.
    pub block: C,
    /// The circuits that staff unblock; one that is to be blocked as well is blocked.
    pub unblock: C,
    /// The circuits that staff restrict to `restrict_code`.
    pub restrict_circuits: C,
    /// The circuits whose restriction staff lift; one that is to be restricted as well has the new restriction only.
    pub lift: C,
    /// The points that are detected in normal position.
    pub detected_normal: P,
    /// The points that are detected in reverse position; a point that is in both is in neither.
    pub detected_reverse: P,
    /// The request: one of the `ATC_REQUEST_` constants.
    pub request: u32,
    /// The number of the route, point or segment that the request is for. Not looked at without a request.
    pub number: u8,
    /// The highest speed code on the circuits that are restricted: 0 to 7.
    pub restrict_code: u8,
    /// The segments where the neighbour permits this station to send trains.
    pub consent: S,
}

/// What the telegram of one circuit tells the train there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct movement_of<C> {
    /// The circuits that the train may enter. Their transmitters are held on for it.
    pub hold: C,
    /// 1: this device sends the telegram. 0: it sends nothing there; the neighbour's device is the one that speaks.
    pub sent: u8,
    /// The last circuit that the train may enter; its own if it must stay there.
    pub stop: u8,
    /// The direction in which it may leave its circuit; `ATC_HEADING_NONE` if it must stay there.
    pub heading: u8,
    /// The highest speed code, 0 to 7.
    pub speed_code: u8,
}

/// One logic cycle's output. The safe one shows no proceed, drives, permits and confirms nothing, and sends nothing; every
/// circuit counts as occupied. Of circuits and routes beyond the plan nothing is said, but in the safe output.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct interlocking_output_of<C, P, S, const MOST: usize> {
    /// The routes whose signals show proceed; all others show stop.
    pub proceed: C,
    /// The blocked circuits that staff may rely on.
    pub confirmed: C,
    /// The circuits that count as occupied.
    pub occupied: C,
    /// The points that are driven to normal position.
    pub drive_normal: P,
    /// The points that are driven to reverse position.
    pub drive_reverse: P,
    /// What became of the request: one of the `ATC_ANSWER_` constants.
    pub answer: u32,
    /// The segments where this station permits the neighbour to send trains.
    pub permits: S,
    /// The phase of each route: one of the `ATC_PHASE_` constants.
    pub phases: [u8; MOST],
    /// The telegram of each circuit.
    pub telegrams: [movement_of<C>; MOST],
}

/// One place of a route's path, or its overlap.
pub type atc_element = element_of<u64, u32>;
/// A route.
pub type atc_route = route_of<u64, u32, u8>;
/// A segment of plain line.
pub type atc_segment = segment_of<u64>;
/// The plan of a station.
pub type atc_interlocking_config = interlocking_config_of<u64, u32, u8>;
/// One logic cycle's input.
pub type atc_interlocking_input = interlocking_input_of<u64, u32, u8>;
/// What the telegram of one circuit tells the train there.
pub type atc_movement = movement_of<u64>;
/// One logic cycle's output.
pub type atc_interlocking_output = interlocking_output_of<u64, u32, u8, 64>;

/// One place of a route's path, or its overlap, in a large station.
pub type atc_large_element = element_of<atc_set256, atc_set128>;
/// A route of a large station.
pub type atc_large_route = route_of<atc_set256, atc_set128, atc_set32>;
/// A segment of plain line at a large station.
pub type atc_large_segment = segment_of<atc_set256>;
/// The plan of a large station.
pub type atc_large_interlocking_config = interlocking_config_of<atc_set256, atc_set128, atc_set32>;
/// One logic cycle's input of a large station.
pub type atc_large_interlocking_input = interlocking_input_of<atc_set256, atc_set128, atc_set32>;
/// What the telegram of one circuit of a large station tells the train there.
pub type atc_large_movement = movement_of<atc_set256>;
/// One logic cycle's output of a large station.
pub type atc_large_interlocking_output = interlocking_output_of<atc_set256, atc_set128, atc_set32, 256>;
