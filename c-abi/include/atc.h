/*
 * The verified train control kernel for C. README.md beside the library's source has the rules of this border.
 * Made from the source by cbindgen; a test holds the two against each other. Not to be edited.
 */

#ifndef ATC_H
#define ATC_H

#include <stddef.h>
#include <stdint.h>

/// The version of the border and of the states behind it. `atc_version` returns it.
#define ATC_VERSION 2

/// The size of an aspect acceptance in bytes.
#define ATC_ASPECT_SIZE 144

/// The alignment of an aspect acceptance in bytes.
#define ATC_ASPECT_ALIGN 8

/// The size of a speed supervision in bytes.
#define ATC_SUPERVISION_SIZE 40

/// The alignment of a speed supervision in bytes.
#define ATC_SUPERVISION_ALIGN 8

/// No braking by this device.
#define ATC_BRAKE_RELEASE 0

/// Service brake.
#define ATC_BRAKE_SERVICE 1

/// Emergency brake.
#define ATC_BRAKE_EMERGENCY 2

/// The size of a block in bytes.
#define ATC_BLOCK_SIZE 40

/// The alignment of a block in bytes.
#define ATC_BLOCK_ALIGN 8

/// Nobody has verified the count since the start, or a reset was refused.
#define ATC_BLOCK_UNVERIFIED 0

/// The count is in force.
#define ATC_BLOCK_COUNTING 1

/// A train checked out of a block that had none left. The count is not in force until a reset.
#define ATC_BLOCK_CHECK_OUT_AT_ZERO 2

/// A train checked in to a block that had its most. The count is not in force until a reset.
#define ATC_BLOCK_CHECK_IN_AT_MAXIMUM 3

/// The check-in stayed on for longer than a train takes to pass. The count is not in force until a reset.
#define ATC_BLOCK_CHECK_IN_STAYS_ON 4

/// The size of a permitted speed in bytes.
#define ATC_PERMITTED_SIZE 144

/// The alignment of a permitted speed in bytes.
#define ATC_PERMITTED_ALIGN 8

/// The train is told nothing of the line in this cycle.
#define ATC_LINE_UNCHANGED 0

/// A line with analog codes only begins here.
#define ATC_LINE_ANALOG 1

/// A line with analog codes and telegrams begins here.
#define ATC_LINE_DIGITAL 2

/// Nothing that permits: no code, or telegrams missing for too long.
#define ATC_BASIS_NOTHING 0

/// The analog code alone.
#define ATC_BASIS_ANALOG 1

/// The pattern alone.
#define ATC_BASIS_PATTERN 2

/// The lower of analog code and pattern.
#define ATC_BASIS_BOTH 3

/// Telegrams are missing: the lower of analog code and the last pattern, which is running down.
#define ATC_BASIS_RUNNING_DOWN 4

/// The size of a deframer in bytes.
#define ATC_DEFRAMER_SIZE 40

/// The alignment of a deframer in bytes.
#define ATC_DEFRAMER_ALIGN 8

/// No telegram.
#define ATC_TELEGRAM_NONE 0

/// A main telegram: what changes.
#define ATC_TELEGRAM_MAIN 1

/// A sub telegram: what does not change.
#define ATC_TELEGRAM_SUB 2

/// The receiver decided for a 0.
#define ATC_RECEPTION_ZERO 0

/// The receiver decided for a 1.
#define ATC_RECEPTION_ONE 1

/// The receiver hears nothing that it could decide on.
#define ATC_RECEPTION_NOTHING 2

/// The size of an on-board device in bytes.
#define ATC_TRAIN_SIZE 584

/// The alignment of an on-board device in bytes.
#define ATC_TRAIN_ALIGN 8

/// The most pairs of codes: 8 codes of the main carrier, each with 8 of the sub carrier.
#define ATC_MAX_CODE_PAIRS 64

/// At how many distances an attenuation table has values.
#define ATC_TABLE_KNOTS 17

/// The size of an interlocking in bytes.
#define ATC_INTERLOCKING_SIZE 32072

/// The alignment of an interlocking in bytes.
#define ATC_INTERLOCKING_ALIGN 8

/// The size of an interlocking of a large station in bytes.
#define ATC_LARGE_INTERLOCKING_SIZE 899424

/// The alignment of an interlocking of a large station in bytes.
#define ATC_LARGE_INTERLOCKING_ALIGN 8

/// The most track circuits of a plan.
#define ATC_MAX_CIRCUITS 64

/// The most points of a plan.
#define ATC_MAX_POINTS 32

/// The most segments of a plan.
#define ATC_MAX_SEGMENTS 8

/// The most routes of a plan.
#define ATC_MAX_ROUTES 64

/// The most places of one route's path, and circuits of one segment.
#define ATC_MAX_PLACES 16

/// The most places of all paths of a plan.
#define ATC_MAX_ELEMENTS 1024

/// The most circuits of all segments of a plan.
#define ATC_MAX_SEGMENT_CIRCUITS 128

/// The most speed codes of a plan, 0 (stop) among them, of a large station too.
#define ATC_MAX_CODES 8

/// The most track circuits of a large station's plan.
#define ATC_LARGE_MAX_CIRCUITS 256

/// The most points of a large station's plan.
#define ATC_LARGE_MAX_POINTS 128

/// The most segments of a large station's plan.
#define ATC_LARGE_MAX_SEGMENTS 32

/// The most routes of a large station's plan.
#define ATC_LARGE_MAX_ROUTES 256

/// The most places of one route's path, and circuits of one segment, in a large station.
#define ATC_LARGE_MAX_PLACES 32

/// The most places of all paths of a large station's plan.
#define ATC_LARGE_MAX_ELEMENTS 8192

/// The most circuits of all segments of a large station's plan.
#define ATC_LARGE_MAX_SEGMENT_CIRCUITS 1024

/// No direction of travel.
#define ATC_HEADING_NONE 0

/// Towards the ends of circuits that the plan calls left.
#define ATC_HEADING_LEFT 1

/// Towards the ends of circuits that the plan calls right.
#define ATC_HEADING_RIGHT 2

/// No request.
#define ATC_REQUEST_NONE 0

/// Set the route `number`.
#define ATC_REQUEST_SET 1

/// Withdraw the route `number`.
#define ATC_REQUEST_WITHDRAW 2

/// Drive the point `number` to normal position, in this cycle.
#define ATC_REQUEST_DRIVE_NORMAL 3

/// Drive the point `number` to reverse position, in this cycle.
#define ATC_REQUEST_DRIVE_REVERSE 4

/// Give the segment `number` the direction towards this station: the neighbour sends.
#define ATC_REQUEST_TURN_TOWARD 5

/// Give the segment `number` the direction away from this station: this station sends.
#define ATC_REQUEST_TURN_AWAY 6

/// There was no request.
#define ATC_ANSWER_NONE 0

/// The request is carried out.
#define ATC_ANSWER_ACCEPTED 1

/// Refused: there is no route, point or segment of this number.
#define ATC_ANSWER_UNKNOWN 2

/// Refused: the device has just started, and a train may still count on what was before.
#define ATC_ANSWER_STARTING 3

/// Refused: the route to be set is held already.
#define ATC_ANSWER_ALREADY_HELD 4

/// Refused: the route to be withdrawn is not held.
#define ATC_ANSWER_NOT_HELD 5

/// Refused: a route that is declared to conflict is held.
#define ATC_ANSWER_CONFLICT 6

/// Refused: a circuit of the path, or the point's detector, is held by another route.
#define ATC_ANSWER_PATH_HELD 7

/// Refused: a circuit of the overlap is held by another route.
#define ATC_ANSWER_OVERLAP_HELD 8

/// Refused: a point is needed or locked in another position by a route.
#define ATC_ANSWER_POINT_LOCKED 9

/// Refused: a circuit of path or overlap is occupied.
#define ATC_ANSWER_OCCUPIED 10

/// Refused: a train from before the start may still be on its way there.
#define ATC_ANSWER_UNSWEPT 11

/// Refused: a circuit of path or overlap, the point's detector, or a circuit of the segment is blocked.
#define ATC_ANSWER_BLOCKED 12

/// Refused: a point must move, and a train stands on it.
#define ATC_ANSWER_POINT_UNDER_TRAIN 13

/// Refused: a segment does not have the direction that the route needs, or cannot turn because of a route or a train.
#define ATC_ANSWER_DIRECTION 14

/// Refused: the permission to the neighbour is withdrawn, and the segment cannot be turned away yet.
#define ATC_ANSWER_WAITING 15

/// Refused: a calling-on route without a train that waits at its signal, or without one in its berth.
#define ATC_ANSWER_NOT_CALLED_FOR 16

/// Nothing is held.
#define ATC_PHASE_IDLE 0

/// Reserved provisionally: its points are being driven.
#define ATC_PHASE_PROVISIONAL 1

/// A point did not arrive in time; nothing is driven any more.
#define ATC_PHASE_FAILED 2

/// Reserved: its points are locked and its signal may show proceed.
#define ATC_PHASE_SET 3

/// A train has entered the path, or something has occupied it.
#define ATC_PHASE_IN_USE 4

/// Withdrawn: nobody may enter, and everything stays locked until the release time has passed.
#define ATC_PHASE_RELEASING 5

/// The plan as a whole.
#define ATC_PLACE_PLAN 0

/// The route `first`.
#define ATC_PLACE_ROUTE 1

/// The place `second` of the path of the route `first`.
#define ATC_PLACE_PATH 2

/// The overlap of the route `first`.
#define ATC_PLACE_OVERLAP 3

/// The routes `first` and `second`.
#define ATC_PLACE_ROUTES 4

/// The point `first`.
#define ATC_PLACE_POINT 5

/// The segment `first`.
#define ATC_PLACE_SEGMENT 6

/// The segments `first` and `second`.
#define ATC_PLACE_SEGMENTS 7

/// The track circuit `first`.
#define ATC_PLACE_CIRCUIT 8

/// What became of a call. Every function of this library returns one, and 0 is the only success.
///
/// A call that does not return `ATC_STATUS_OK` has changed no state, and has written the safe output wherever an
/// output can
/// be written. `atc_status_text` says in a sentence what is wrong and what would be right.
typedef enum atc_status {
  /// The call was carried out.
  ATC_STATUS_OK = 0,
  /// A pointer is null.
  ATC_STATUS_NULL = 1,
  /// A pointer is not aligned for what it points to.
  ATC_STATUS_MISALIGNED = 2,
  /// The memory for a state is smaller than the state.
  ATC_STATUS_TOO_SMALL = 3,
  /// Two of the places that the call was given overlap.
  ATC_STATUS_OVERLAP = 4,
  /// The memory holds no state of this machine and this version: it was never started, or is of another machine.
  ATC_STATUS_NOT_STARTED = 5,
  /// The state was started, and its bytes have changed since in another way than by a step.
  ATC_STATUS_DAMAGED = 6,
  /// An array has more entries than there is room for.
  ATC_STATUS_TOO_MANY_ENTRIES = 7,
  /// A place of a plan lies beyond the end of its array.
  ATC_STATUS_BEYOND_ARRAY = 8,
  /// A flag is neither 0 nor 1.
  ATC_STATUS_BAD_FLAG = 10,
  /// A choice is none of its constants.
  ATC_STATUS_UNKNOWN_CHOICE = 11,
  /// An aspect is named that the line does not have.
  ATC_STATUS_UNKNOWN_ASPECT = 12,
  /// A section is named that the block does not have.
  ATC_STATUS_UNKNOWN_SECTION = 13,
  /// A rank of a speed is over 15.
  ATC_STATUS_UNKNOWN_RANK = 14,
  /// More than 16 sections are to be held.
  ATC_STATUS_HOLD_TOO_LONG = 15,
  /// The section of a sub telegram has no length.
  ATC_STATUS_NO_SECTION_LENGTH = 16,
  /// A main telegram has a closed route and a distance beyond the exit.
  ATC_STATUS_CLOSED_ROUTE_WITH_DISTANCE = 17,
  /// A bit of a frame is neither 0 nor 1.
  ATC_STATUS_BAD_BIT = 18,
  /// A circuit is named that the plan does not have.
  ATC_STATUS_UNKNOWN_CIRCUIT = 19,
  /// A point is named that the plan does not have.
  ATC_STATUS_UNKNOWN_POINT = 20,
  /// A route is named that the plan does not have.
  ATC_STATUS_UNKNOWN_ROUTE = 21,
  /// A segment is named that the plan does not have.
  ATC_STATUS_UNKNOWN_SEGMENT = 22,
  /// A speed code is over 7.
  ATC_STATUS_UNKNOWN_CODE = 23,
  /// The logic cycle has no length.
  ATC_STATUS_NO_CYCLE = 30,
  /// A time is over 60 000 logic cycles.
  ATC_STATUS_TIME_TOO_LONG = 31,
  /// The operate time (T1) is 0.
  ATC_STATUS_NO_OPERATE_TIME = 32,
  /// The recovery time (T2) is shorter than one logic cycle.
  ATC_STATUS_NO_RECOVERY_TIME = 33,
  /// The shortened operate time (T5) is 0.
  ATC_STATUS_NO_SHORTENED_OPERATE_TIME = 34,
  /// The shortened operate time (T5) is not shorter than the operate time (T1), in whole cycles.
  ATC_STATUS_SHORTENED_NOT_SHORTER = 35,
  /// The table of speeds is empty.
  ATC_STATUS_NO_SPEEDS = 36,
  /// The table of speeds has more than 16 entries.
  ATC_STATUS_TOO_MANY_SPEEDS = 37,
  /// The table of speeds does not rise strictly.
  ATC_STATUS_SPEEDS_NOT_RISING = 38,
  /// The highest plausible speed is 0.
  ATC_STATUS_NO_MAXIMUM = 40,
  /// The release margin is above the highest plausible speed.
  ATC_STATUS_MARGIN_ABOVE_MAXIMUM = 41,
  /// The block has no section.
  ATC_STATUS_NO_SECTIONS = 50,
  /// The block has more than 16 sections.
  ATC_STATUS_TOO_MANY_SECTIONS = 51,
  /// No train may be in the block.
  ATC_STATUS_NO_TRAINS = 52,
  /// More trains may be in the block than it has sections.
  ATC_STATUS_MORE_TRAINS_THAN_SECTIONS = 53,
  /// The pass time is shorter than one logic cycle.
  ATC_STATUS_PASS_TOO_SHORT = 54,
  /// The brake is 0 or over 4095 mm/s2.
  ATC_STATUS_BAD_BRAKE = 60,
  /// The rank of the lowest limit is not in the table of speeds.
  ATC_STATUS_UNKNOWN_LIMIT = 61,
  /// The time for which a main telegram is fresh is shorter than one logic cycle.
  ATC_STATUS_NO_FRESHNESS = 62,
  /// The life of a main telegram is shorter than the time for which it is fresh.
  ATC_STATUS_LIFE_SHORTER_THAN_FRESHNESS = 63,
  /// The life of a sub telegram is shorter than one logic cycle.
  ATC_STATUS_NO_FIXED_LIFE = 64,
  /// The memory is longer than the life of a main or of a sub telegram.
  ATC_STATUS_MEMORY_LONGER_THAN_LIFE = 65,
  /// The window of the counter is 0 or over 127.
  ATC_STATUS_BAD_WINDOW = 66,
  /// The run of the counter is 0 or over 15.
  ATC_STATUS_BAD_RUN = 67,
  /// The memory is shorter than one logic cycle.
  ATC_STATUS_NO_MEMORY = 68,
  /// The bits are no frame: the synchronisation word is not there.
  ATC_STATUS_FRAME_SYNCHRONISATION = 70,
  /// The bits are no frame: a guard bit is 1.
  ATC_STATUS_FRAME_GUARD = 71,
  /// The bits are no frame: the check does not fit the information.
  ATC_STATUS_FRAME_CHECK = 72,
  /// The bits are no frame: the check fits, and the information is of no telegram.
  ATC_STATUS_FRAME_CONTENT = 73,
  /// An on-board device has no pair of codes.
  ATC_STATUS_NO_CODES = 80,
  /// A carrier has more than 8 different codes, or there are more than 64 pairs.
  ATC_STATUS_TOO_MANY_CODES = 81,
  /// The band of a code reaches down to 0, or beyond the highest number.
  ATC_STATUS_CODE_OUT_OF_RANGE = 82,
  /// The bands of two codes of a carrier touch.
  ATC_STATUS_CODE_BANDS_TOUCH = 83,
  /// A pair of codes comes twice.
  ATC_STATUS_CODE_PAIR_TWICE = 84,
  /// A pair of codes names a speed that is not in the table of speeds.
  ATC_STATUS_UNKNOWN_CODE_SPEED = 85,
  /// A speed of the line is above the highest plausible one.
  ATC_STATUS_IMPLAUSIBLE_SPEED = 86,
  /// The spacing of an attenuation table is out of its range.
  ATC_STATUS_BAD_SPACING = 87,
  /// The lowest difference of an attenuation table is above the highest.
  ATC_STATUS_TABLE_CROSSED = 88,
  /// In no span of an attenuation table both curves rise.
  ATC_STATUS_TABLE_NOWHERE_RISING = 89,
  /// The tolerance of a level is negative.
  ATC_STATUS_BAD_TOLERANCE = 90,
  /// The least correction is above the most.
  ATC_STATUS_BAD_CORRECTION = 91,
  /// The least movement is above the most.
  ATC_STATUS_BAD_MOVEMENT = 92,
  /// A path or a segment has more places than there is room for: 16, in a large station 32.
  ATC_STATUS_PLAN_PATH_TOO_LONG = 100,
  /// A time of the plan is 0.
  ATC_STATUS_PLAN_NO_TIME = 101,
  /// A circuit counts as clear sooner than a train may be lost for.
  ATC_STATUS_PLAN_CLEAR_SHORT = 102,
  /// A release time does not cover the residual running and the longest loss.
  ATC_STATUS_PLAN_RELEASE_SHORT = 103,
  /// A stay time does not cover the standstill time, the longest loss and one cycle more.
  ATC_STATUS_PLAN_STAY_SHORT = 104,
  /// A route needs a point both ways.
  ATC_STATUS_PLAN_POINT_BOTH_WAYS = 105,
  /// A point with a detector on a place of a path, or on an overlap, is not positioned there.
  ATC_STATUS_PLAN_POINT_NOT_POSITIONED = 106,
  /// A declared conflict goes one way only.
  ATC_STATUS_PLAN_CONFLICT_ONE_WAY = 107,
  /// Two routes start from one circuit in opposite directions and do not conflict.
  ATC_STATUS_PLAN_OPPOSING_STARTS = 108,
  /// A route that continues another one does not enter at that one's last circuit.
  ATC_STATUS_PLAN_CONTINUES_ELSEWHERE = 109,
  /// A route turns back on the route that it continues, or on its segment.
  ATC_STATUS_PLAN_TURNS_BACK = 110,
  /// A route out to a segment does not end at the segment's throat.
  ATC_STATUS_PLAN_THROATS_DIFFER = 111,
  /// A segment shares a circuit with a path, an overlap, a throat or another segment.
  ATC_STATUS_PLAN_SEGMENT_SHARED = 112,
  /// A circuit of a segment is a detector of a point.
  ATC_STATUS_PLAN_POINT_IN_SEGMENT = 113,
  /// A place of a path or of a segment is not exactly one circuit.
  ATC_STATUS_PLAN_NOT_ONE_CIRCUIT = 114,
  /// A circuit comes twice in a path or in a segment.
  ATC_STATUS_PLAN_CIRCUIT_TWICE = 115,
  /// The braking distances do not rise with the code.
  ATC_STATUS_PLAN_BRAKING_FALLS = 116,
  /// An overlap has a circuit of its own path.
  ATC_STATUS_PLAN_OVERLAP_UNDER_OWN_PATH = 117,
  /// The entry is not exactly one circuit of the approach.
  ATC_STATUS_PLAN_ENTRY_NOT_IN_APPROACH = 118,
  /// The approach has a circuit of the path or of the overlap.
  ATC_STATUS_PLAN_APPROACH_IN_PATH = 119,
  /// There is no circuit beyond the end of a route, or it is the last one of its path.
  ATC_STATUS_PLAN_NOTHING_BEYOND = 120,
  /// A route conflicts with itself.
  ATC_STATUS_PLAN_CONFLICTS_WITH_ITSELF = 121,
  /// A route names a route, a point or a segment that is not there.
  ATC_STATUS_PLAN_NOT_THERE = 122,
  /// A point that a route needs has no detector.
  ATC_STATUS_PLAN_NO_DETECTOR = 123,
  /// A circuit of a path or of a segment has no length.
  ATC_STATUS_PLAN_NO_LENGTH = 124,
  /// The speed code of a route has no braking distance.
  ATC_STATUS_PLAN_CODE_OUT_OF_TABLE = 125,
  /// A route comes from more than one segment, or goes to more than one.
  ATC_STATUS_PLAN_MANY_SEGMENTS = 126,
  /// A calling-on route has no berth, is continued by another route, or leads to a segment.
  ATC_STATUS_PLAN_CALLING_ON_ENDS = 127,
  /// A route that starts in a berth runs over a circuit of it, or against the called train elsewhere than over its last circuit.
  ATC_STATUS_PLAN_CALLING_ON_AGAINST = 128,
  /// The berth of a calling-on route is not the track up to the next signal, or its trains act on telegrams alone.
  ATC_STATUS_PLAN_CALLING_ON_BERTH = 129,
} atc_status;

/// The line's aspects and times.
typedef struct atc_aspect_config {
  /// The length of a logic cycle in ms, 1 or more.
  uint32_t cycle_ms;
  /// T1: an aspect heard for so long is accepted. Rounded up to cycles.
  uint32_t operate_ms;
  /// T2: a lost aspect stands so long as if it were heard. Rounded down to cycles.
  uint32_t recovery_ms;
  /// T3: and after that so long, if nothing contradicts it. Rounded down to cycles.
  uint32_t mask_ms;
  /// T4: the longest interruption after which T5 takes the place of T1. Rounded down to cycles.
  uint32_t interruption_ms;
  /// T5: the operate time after a short interruption, below T1. Rounded up to cycles.
  uint32_t shortened_operate_ms;
  /// How many aspects the line has: 1 to 16.
  uint32_t aspect_count;
  /// The permitted speeds that the aspects name, in tenths of km/h, strictly rising. From `aspect_count` on not
  /// looked at.
  uint16_t speeds[16];
} atc_aspect_config;

/// An aspect acceptance with its state. Its bytes are the library's; it may be moved and copied as a whole.
typedef struct atc_aspect {
  /// Not to be read or written.
  uint64_t opaque[18];
} atc_aspect;

/// One logic cycle's input.
typedef struct atc_aspect_input {
  /// The aspects whose signal was heard throughout the cycle: bit `i` for the aspect of rank `i`, 0 the lowest.
  uint16_t detected;
} atc_aspect_input;

/// One logic cycle's output. The safe one is all zeros: no display.
typedef struct atc_aspect_output {
  /// 1: an aspect is displayed from the end of the cycle on. 0: none is, and that means stop.
  uint8_t displayed;
  /// Its rank, 0 to 15; 0 if none is displayed.
  uint8_t rank;
  /// The speed that it permits in tenths of km/h; 0 if none is displayed.
  uint16_t speed;
} atc_aspect_output;

/// The parameters of the supervision, in tenths of km/h.
typedef struct atc_supervision_config {
  /// The highest plausible speed, above 0. A measured speed above it is implausible.
  uint16_t maximum;
  /// How far below the permitted speed the train must be before a brake that is on is released: 0 to `maximum`.
  uint16_t margin;
} atc_supervision_config;

/// A speed supervision with its state. Its bytes are the library's; it may be moved and copied as a whole.
typedef struct atc_supervision {
  /// Not to be read or written.
  uint64_t opaque[5];
} atc_supervision;

/// One logic cycle's input. Any speed is an input, plausible or not.
typedef struct atc_supervision_input {
  /// The measured speed in tenths of km/h. Not looked at if `has_measured` is 0.
  int32_t measured;
  /// The permitted speed in tenths of km/h. Not looked at if `has_permitted` is 0.
  int32_t permitted;
  /// 1: there is a measured speed. 0: there is none, and that is the emergency brake.
  uint8_t has_measured;
  /// 1: there is a permitted speed. 0: nothing is displayed, and that is the emergency brake.
  uint8_t has_permitted;
} atc_supervision_input;

/// One logic cycle's output. The safe one is the emergency brake.
typedef struct atc_supervision_output {
  /// The brake command from the end of the cycle on: `ATC_BRAKE_RELEASE`, `ATC_BRAKE_SERVICE` or
  /// `ATC_BRAKE_EMERGENCY`.
  uint32_t brake;
} atc_supervision_output;

/// The parameters of a block.
typedef struct atc_block_config {
  /// The length of a logic cycle in ms, 1 or more.
  uint32_t cycle_ms;
  /// The longest that a passing train keeps the check-in on. Rounded down to cycles.
  uint32_t pass_ms;
  /// How many sections the block has: 1 to 16.
  uint8_t sections;
  /// The most trains that may be in it: 1 to that many.
  uint8_t max_trains;
  /// How many sections are held occupied behind every head: 0 to 16.
  uint8_t tail_hold_sections;
} atc_block_config;

/// A block with its state. Its bytes are the library's; it may be moved and copied as a whole.
typedef struct atc_block {
  /// Not to be read or written.
  uint64_t opaque[5];
} atc_block;

/// One logic cycle's input.
typedef struct atc_block_input {
  /// The sections in which a detector hears a head: bit `i` for section `i`, 0 at the entry end.
  uint16_t present;
  /// 1: the check at the entry end is on. 0: it is off.
  uint8_t check_in;
  /// 1: the check at the exit end is on. 0: it is off.
  uint8_t check_out;
  /// 1: staff reset the count in this cycle. 0: no reset.
  uint8_t has_reset;
  /// The number of trains that staff have verified. Not looked at if `has_reset` is 0.
  uint8_t reset;
  /// How many sections the block ahead asks to hold on this side of the border: 0 to 16.
  uint8_t ahead_hold_sections;
  /// 1: the block ahead has a train that is still pending here, or the line ends here. 0: neither.
  uint8_t ahead_entered;
} atc_block_input;

/// One logic cycle's output. The safe one is everything occupied, 16 sections held, nothing counted.
typedef struct atc_block_output {
  /// Whether the count is in force, or what contradicted it: one of the `ATC_BLOCK_` constants.
  uint32_t status;
  /// The sections that are occupied, or not shown to be free: bit `i` for section `i`.
  uint16_t occupied;
  /// How many sections the block behind is asked to hold on its side of the border: 0 to 16.
  uint8_t behind_hold_sections;
  /// 1: the count is in force and equals the number of sections that detect.
  uint8_t agree;
  /// Trains, pending check-outs included.
  uint8_t count;
  /// 1: a check-in was counted in this cycle.
  uint8_t counted_in;
  /// 1: a check-out took effect in this cycle.
  uint8_t counted_out;
} atc_block_output;

/// The parameters of line and train. Every time is rounded down to cycles.
typedef struct atc_permitted_config {
  /// The length of a logic cycle in ms, 1 or more.
  uint32_t cycle_ms;
  /// For how long a main telegram is fresh: one cycle or more.
  uint32_t fresh_ms;
  /// For how long the pattern of the last main telegram runs down: `fresh_ms` or more.
  uint32_t life_ms;
  /// For how long a sub telegram is used: one cycle or more.
  uint32_t fixed_life_ms;
  /// After how long without a telegram its predecessors are forgotten: no longer than either life.
  uint32_t memory_ms;
  /// How many speeds the line has: 1 to 16.
  uint32_t speed_count;
  /// The line's speeds in tenths of km/h, strictly rising. From `speed_count` on not looked at.
  uint16_t speeds[16];
  /// The train's deceleration by its service brake on the level, in mm/s2: 1 to 4095.
  uint16_t brake_mm_s2;
  /// What is taken off every distance to a stopping point, in metres.
  uint16_t margin_m;
  /// The lowest limit that a sub telegram of this line carries, as a rank in `speeds`.
  uint8_t lowest_rank;
  /// The worst gradient that a sub telegram of this line carries, in thousandths, negative where the train descends.
  int8_t worst_gradient_permille;
  /// By how much the counter may advance from one telegram to the next: 1 to 127.
  uint8_t window;
  /// How many telegrams in a row must have advanced their counter before one is used: 1 to 15.
  uint8_t run;
} atc_permitted_config;

/// A permitted speed with its state. Its bytes are the library's; it may be moved and copied as a whole.
typedef struct atc_permitted {
  /// Not to be read or written.
  uint64_t opaque[18];
} atc_permitted;

/// The variable data of a section: how far the line is free, and how fast.
typedef struct atc_main_telegram {
  /// The section that the telegram is for.
  uint16_t section;
  /// How far beyond the exit of the section the train must stop, in metres; 0 if the route is closed.
  uint16_t beyond_exit_m;
  /// The telegram's number in its stream.
  uint8_t counter;
  /// 1: the route beyond the exit is open. 0: the train must stop before the exit.
  uint8_t route_open;
  /// The speed that the ground permits, as a rank in the table of the line's speeds: 0 to 15.
  uint8_t speed_rank;
} atc_main_telegram;

/// The fixed data of a section.
typedef struct atc_sub_telegram {
  /// The section that the telegram is for.
  uint16_t section;
  /// The length of the section in metres, 1 or more.
  uint16_t length_m;
  /// The telegram's number in its stream.
  uint8_t counter;
  /// The least favourable gradient in thousandths, positive where the train climbs.
  int8_t gradient_permille;
  /// The limit by curves and points, as a rank: 0 to 15.
  uint8_t curve_rank;
  /// The limit by a temporary restriction, as a rank: 0 to 15; the highest rank if there is none.
  uint8_t restriction_rank;
} atc_sub_telegram;

/// What is heard and measured in one cycle.
typedef struct atc_permitted_input {
  /// The kind of line that begins here: `ATC_LINE_UNCHANGED`, `ATC_LINE_ANALOG` or `ATC_LINE_DIGITAL`.
  uint32_t line;
  /// A distance from which the exit of the section is no nearer, in mm. Not looked at if `has_to_exit` is 0.
  uint32_t to_exit_mm;
  /// The most that the train can have moved forward since the last cycle, in mm.
  uint32_t moved_mm;
  /// The main telegram that was completed in this cycle. Not looked at if `has_main` is 0.
  struct atc_main_telegram main_data;
  /// The sub telegram that was completed in this cycle. Not looked at if `has_sub` is 0.
  struct atc_sub_telegram sub_data;
  /// The speed of the accepted analog code in tenths of km/h. Not looked at if `has_analog` is 0.
  uint16_t analog;
  /// 1: an analog code is accepted. 0: none is.
  uint8_t has_analog;
  /// 1: a main telegram was completed in this cycle. 0: none was.
  uint8_t has_main;
  /// 1: a sub telegram was completed in this cycle. 0: none was.
  uint8_t has_sub;
  /// 1: the distance to the exit is measured. 0: it is not.
  uint8_t has_to_exit;
} atc_permitted_input;

/// One cycle's output. The safe one is all zeros: no permission, and that is the emergency brake.
typedef struct atc_permitted_output {
  /// What the permission rests on: one of the `ATC_BASIS_` constants.
  uint32_t basis;
  /// The permitted speed in tenths of km/h; 0 is a stop by the service brake, or nothing is permitted.
  uint16_t speed;
  /// 1: there is a permitted speed. 0: nothing is heard, and that is the emergency brake.
  uint8_t has_speed;
} atc_permitted_output;

/// One question to the braking pattern.
typedef struct atc_pattern_input {
  /// The train's deceleration by its service brake on the level, in mm/s2: 1 to 4095.
  uint16_t brake_mm_s2;
  /// The distance in which the train must stop, in metres.
  uint16_t distance_m;
  /// The gradient in thousandths, positive where the train climbs.
  int8_t gradient_permille;
} atc_pattern_input;

/// The answer of the braking pattern. The safe one is 0.
typedef struct atc_pattern_output {
  /// The highest speed from which the train stops within the distance, in tenths of km/h: 0 to 4095.
  uint16_t speed;
} atc_pattern_output;

/// A telegram of either kind, or none. All zeros is none.
typedef struct atc_telegram {
  /// Which of the two it is: `ATC_TELEGRAM_NONE`, `ATC_TELEGRAM_MAIN` or `ATC_TELEGRAM_SUB`.
  uint32_t kind;
  /// The main telegram; zeros if it is none, and then not looked at.
  struct atc_main_telegram main_data;
  /// The sub telegram; zeros if it is none, and then not looked at.
  struct atc_sub_telegram sub_data;
} atc_telegram;

/// A frame: 106 bits in the order in which they are sent.
typedef struct atc_frame {
  /// The bits, each 0 or 1.
  uint8_t bits[106];
} atc_frame;

/// A deframer with the bits that it has heard. Its bytes are the library's; it may be moved and copied as a whole.
typedef struct atc_deframer {
  /// Not to be read or written.
  uint64_t opaque[5];
} atc_deframer;

/// What the receiver says of one bit time.
typedef struct atc_deframer_input {
  /// `ATC_RECEPTION_ZERO`, `ATC_RECEPTION_ONE` or `ATC_RECEPTION_NOTHING`.
  uint32_t reception;
} atc_deframer_input;

/// A pair of codes, and the speed that it names.
typedef struct atc_code_pair {
  /// The code frequency of the main carrier in thousandths of a hertz.
  uint32_t main_millihertz;
  /// The code frequency of the sub carrier in thousandths of a hertz.
  uint32_t sub_millihertz;
  /// The speed in tenths of km/h: one of the line's.
  uint16_t speed;
} atc_code_pair;

/// How the train finds its position by two signals that the rail attenuates differently. Levels are in hundredths of a decibel.
typedef struct atc_position_config {
  /// The lowest difference, first level less second, at each of the 17 distances, 0 first.
  int16_t lowest[17];
  /// The highest difference there: not below the lowest.
  int16_t highest[17];
  /// By how much each level may be off, 0 or more.
  int16_t tolerance;
  /// The lowest level that is no noise.
  int16_t floor;
  /// The least that is added to the difference.
  int16_t correction_least;
  /// The most that is added to it: not below the least.
  int16_t correction_most;
  /// From one distance to the next it is 2 to this power decimetres: 4 to 11 (1.6 m to 204.8 m).
  uint8_t spacing_exponent;
} atc_position_config;

/// The parameters of the on-board device: those of its parts. There is one table of speeds, that of `permitted`.
typedef struct atc_train_config {
  /// The cycle, the line's speeds, the brake, the lives of telegrams and the counters.
  struct atc_permitted_config permitted;
  /// T1: an aspect heard for so long is accepted. Rounded up to cycles.
  uint32_t operate_ms;
  /// T2: a lost aspect stands so long as if it were heard. Rounded down to cycles.
  uint32_t recovery_ms;
  /// T3: and after that so long, if nothing contradicts it. Rounded down to cycles.
  uint32_t mask_ms;
  /// T4: the longest interruption after which T5 takes the place of T1. Rounded down to cycles.
  uint32_t interruption_ms;
  /// T5: the operate time after a short interruption, below T1. Rounded up to cycles.
  uint32_t shortened_operate_ms;
  /// By how much a measured code frequency may be off, in thousandths of a hertz.
  uint32_t code_tolerance_millihertz;
  /// How many pairs of codes there are: 1 to `ATC_MAX_CODE_PAIRS`.
  uint32_t code_count;
  /// The pairs of codes; of each carrier up to 8 different ones. From `code_count` on not looked at.
  struct atc_code_pair codes[64];
  /// The highest plausible speed, and the margin of the release.
  struct atc_supervision_config supervision;
  /// The position. Not looked at if `has_position` is 0.
  struct atc_position_config position;
  /// 1: the train measures its position. 0: it does not; every distance begins at the exit of its section.
  uint8_t has_position;
} atc_train_config;

/// An on-board device with its state. Its bytes are the library's; it may be moved and copied as a whole.
typedef struct atc_train {
  /// Not to be read or written.
  uint64_t opaque[73];
} atc_train;

/// What antennas, odometer, speed generator and balises give in one cycle. All zeros: nothing is heard or known.
typedef struct atc_train_input {
  /// The code frequency of the main carrier in thousandths of a hertz. Not looked at if `has_main_code` is 0.
  uint32_t main_code_millihertz;
  /// The code frequency of the sub carrier in thousandths of a hertz. Not looked at if `has_sub_code` is 0.
  uint32_t sub_code_millihertz;
  /// The kind of line that begins here: `ATC_LINE_UNCHANGED`, `ATC_LINE_ANALOG` or `ATC_LINE_DIGITAL`.
  uint32_t line;
  /// The measured speed in tenths of km/h; any number is an input. Not looked at if `has_speed` is 0.
  int32_t speed;
  /// The frame of the main carrier whose last bit came in this cycle. Not looked at if `has_main_frame` is 0.
  struct atc_frame main_frame;
  /// The frame of the sub carrier whose last bit came in this cycle. Not looked at if `has_sub_frame` is 0.
  struct atc_frame sub_frame;
  /// The level of the signal that the rail attenuates less, in hundredths of a decibel. Not looked at if `has_first` is 0.
  int16_t first;
  /// The level of the signal that the rail attenuates more, in hundredths of a decibel. Not looked at if `has_second` is 0.
  int16_t second;
  /// The least that the train moved towards the exit since the last cycle, in mm. Not looked at if `has_moved` is 0.
  int16_t moved_least_mm;
  /// The most that it moved: not below the least. Not looked at if `has_moved` is 0.
  int16_t moved_most_mm;
  /// The direction of travel in which the train faces: `ATC_HEADING_LEFT`, `ATC_HEADING_RIGHT`, or `ATC_HEADING_NONE` if that
  /// is not known; then no telegram is used.
  uint8_t facing;
  /// 1: there is a code on the main carrier. 0: there is none.
  uint8_t has_main_code;
  /// 1: there is a code on the sub carrier. 0: there is none.
  uint8_t has_sub_code;
  /// 1: a frame of the main carrier was completed. 0: none was.
  uint8_t has_main_frame;
  /// 1: a frame of the sub carrier was completed. 0: none was.
  uint8_t has_sub_frame;
  /// 1: the first signal is heard. 0: it is not.
  uint8_t has_first;
  /// 1: the second signal is heard. 0: it is not.
  uint8_t has_second;
  /// 1: the odometer says something. 0: the train may have moved as far as can be said.
  uint8_t has_moved;
  /// 1: there is a measured speed. 0: there is none, and that is the emergency brake.
  uint8_t has_speed;
} atc_train_input;

/// One logic cycle's output. The safe one displays and permits nothing, knows no position, and commands the emergency brake.
typedef struct atc_train_output {
  /// The brake command from the end of the cycle on: one of the `ATC_BRAKE_` constants.
  uint32_t brake;
  /// What the permission rests on: one of the `ATC_BASIS_` constants.
  uint32_t basis;
  /// The least distance of the front to the exit of the section whose signal is heard, in mm; 0 if it is not known.
  uint32_t nearest_mm;
  /// The greatest distance; 0 if it is not known.
  uint32_t farthest_mm;
  /// The speed of the displayed aspect in tenths of km/h; 0 if none is displayed.
  uint16_t display;
  /// The permitted speed in tenths of km/h; 0 is a stop by the service brake, or nothing is permitted.
  uint16_t permitted;
  /// 1: an aspect is displayed. 0: none is.
  uint8_t has_display;
  /// 1: there is a permitted speed. 0: there is none, and that is the emergency brake.
  uint8_t has_permitted;
  /// 1: the position is known. 0: it is not.
  uint8_t has_position;
} atc_train_output;

/// A stretch of plain line to a neighbouring station.
typedef struct atc_segment {
  /// The last circuit of every route that goes out to the segment, as a set of one; 0 if no route does.
  uint64_t throat;
  /// Where its circuits begin in the array `segment_circuits`.
  uint16_t circuits_first;
  /// How many circuits it has: 1 to `ATC_MAX_PLACES`, of a large station `ATC_LARGE_MAX_PLACES`.
  uint16_t circuits_length;
  /// The direction of travel away from the station: `ATC_HEADING_LEFT` or `ATC_HEADING_RIGHT`.
  uint8_t outward;
  /// How many of its circuits, the outermost ones, the neighbour's device sees too.
  uint8_t shared;
} atc_segment;

/// One place of a route's path, or its overlap: what is held there.
typedef struct atc_element {
  /// The track circuit as a set of one. An overlap may have several, or none.
  uint64_t circuits;
  /// The points that must stand normal, flank points included, as a set.
  uint32_t normal;
  /// The points that must stand reverse, flank points included.
  uint32_t reverse;
  /// The circuits beside it that are proved clear and not run over, as a set.
  uint64_t beside;
} atc_element;

/// A route: from the signal at the exit of `entry` over its path to the end of its last circuit.
typedef struct atc_route {
  /// The circuit in rear of the route's signal, as a set of one.
  uint64_t entry;
  /// The circuits on which a train may be that counts on the signal: `entry` among them.
  uint64_t approach;
  /// The circuits that adjoin the end of the route.
  uint64_t beyond;
  /// The routes that go on where this one ends, as a set.
  uint64_t continuing;
  /// The routes that must not be held together with this one.
  uint64_t conflicts;
  /// What is kept free beyond the end, in case the train does not stop in time.
  struct atc_element overlap;
  /// Where the path begins in the array `elements`.
  uint16_t path_first;
  /// How many places the path has: 1 to `ATC_MAX_PLACES`, of a large station `ATC_LARGE_MAX_PLACES`.
  uint16_t path_length;
  /// How many cycles the points may take to arrive, 1 or more.
  uint16_t drive_cycles;
  /// How many cycles a withdrawn route stays locked where a train may be coming.
  uint16_t release_cycles;
  /// How many cycles a train must have stood on the last circuit before the overlap is given up.
  uint16_t stay_cycles;
  /// The direction of travel: `ATC_HEADING_LEFT` or `ATC_HEADING_RIGHT`.
  uint8_t heading;
  /// The segment that the route's train comes from, as a set of one; 0 if it comes from none.
  uint8_t from;
  /// The segment that the route's train goes out to, as a set of one; 0 if it goes to none.
  uint8_t to;
  /// The highest speed code on the route: 1 to 7.
  uint8_t speed_code;
  /// The highest speed code on its overlap, 0 to 7: for a train that has slid there and goes back. 0 lets none of these leave.
  uint8_t overlap_speed_code;
  /// 1: every train that uses the route acts on telegrams alone, and not on what a driver sees. 0: some do not.
  uint8_t cab_signalled;
  /// 1: a calling-on route, whose train goes on sight into the overlap, the berth, where another one stands. 0: any other.
  uint8_t calling_on;
} atc_route;

/// The plan of a station in flat arrays. They are read by the call that gets them, and not kept. An array without an
/// entry may be null. A set is a word with bit `i` for the thing of number `i`; of a large station it is one of
/// `atc_set256`, `atc_set128` and `atc_set32`.
typedef struct atc_interlocking_config {
  /// The length of each circuit in metres: `circuit_count` entries.
  const uint16_t *lengths_m;
  /// The line speed of each circuit as a code, 0 to 7: `circuit_count` entries. Null: no circuit has a limit.
  const uint8_t *line_codes;
  /// The circuits that say that a train may stand on a point, for each point as a set: `point_count` entries.
  const uint64_t *detectors;
  /// The segments of plain line: `segment_count` entries.
  const struct atc_segment *segments;
  /// The numbers of the segments' circuits, one segment after the other, the circuit next to the station first.
  const uint8_t *segment_circuits;
  /// The routes: `route_count` entries.
  const struct atc_route *routes;
  /// The places of the routes' paths, one route after the other in order of travel.
  const struct atc_element *elements;
  /// How far a train runs from the speed of each code when a lower one goes out, in metres: `code_count` entries.
  const uint16_t *braking_m;
  /// How many circuits there are: 0 to `ATC_MAX_CIRCUITS`, of a large station `ATC_LARGE_MAX_CIRCUITS`.
  size_t circuit_count;
  /// How many points there are: 0 to `ATC_MAX_POINTS`, of a large station `ATC_LARGE_MAX_POINTS`.
  size_t point_count;
  /// How many segments there are: 0 to `ATC_MAX_SEGMENTS`, of a large station `ATC_LARGE_MAX_SEGMENTS`.
  size_t segment_count;
  /// How many entries `segment_circuits` has: 0 to `ATC_MAX_SEGMENT_CIRCUITS`, of a large station `ATC_LARGE_MAX_SEGMENT_CIRCUITS`.
  size_t segment_circuit_count;
  /// How many routes there are: 0 to `ATC_MAX_ROUTES`, of a large station `ATC_LARGE_MAX_ROUTES`.
  size_t route_count;
  /// How many entries `elements` has: 0 to `ATC_MAX_ELEMENTS`, of a large station `ATC_LARGE_MAX_ELEMENTS`.
  size_t element_count;
  /// How many speed codes there are, 0 (stop) among them: 0 to `ATC_MAX_CODES`.
  size_t code_count;
  /// For how many cycles a segment's permission must have been withdrawn before it turns: 1 or more.
  uint16_t turn_cycles;
  /// For how many cycles after a start nothing moves, is confirmed or turned.
  uint16_t start_cycles;
  /// For how many cycles a train may run on after its authority was taken away.
  uint16_t residual_cycles;
  /// For how many cycles a train may still slide once it is wholly in the last circuit of a route.
  uint16_t standstill_cycles;
  /// How many cycles in a row a circuit must be reported clear before it counts as clear: 1 or more.
  uint8_t clear_cycles;
  /// For how many cycles in a row a point must be detected, undriven, before it counts as detected.
  uint8_t settle_cycles;
  /// For how many cycles in a row an occupied circuit may at most not be reported.
  uint8_t loss_cycles;
} atc_interlocking_config;

/// Where a plan breaks a rule. Everything is numbered from 0.
typedef struct atc_place {
  /// What is meant: one of the `ATC_PLACE_` constants.
  uint32_t kind;
  /// Its number; 0 if it has none.
  uint32_t first;
  /// The number of a place or of the other one; 0 if there is none.
  uint32_t second;
} atc_place;

/// An interlocking with its plan and its state. Its bytes are the library's; it may be moved and copied as a whole.
typedef struct atc_interlocking {
  /// Not to be read or written.
  uint64_t opaque[4009];
} atc_interlocking;

/// One logic cycle's input.
typedef struct atc_interlocking_input {
  /// The circuits that are reported occupied.
  uint64_t occupied;
  /// The circuits that staff block.
  uint64_t block;
  /// The circuits that staff unblock; one that is to be blocked as well is blocked.
  uint64_t unblock;
  /// The circuits that staff restrict to `restrict_code`.
  uint64_t restrict_circuits;
  /// The circuits whose restriction staff lift; one that is to be restricted as well has the new restriction only.
  uint64_t lift;
  /// The points that are detected in normal position.
  uint32_t detected_normal;
  /// The points that are detected in reverse position; a point that is in both is in neither.
  uint32_t detected_reverse;
  /// The request: one of the `ATC_REQUEST_` constants.
  uint32_t request;
  /// The number of the route, point or segment that the request is for. Not looked at without a request.
  uint8_t number;
  /// The highest speed code on the circuits that are restricted: 0 to 7.
  uint8_t restrict_code;
  /// The segments where the neighbour permits this station to send trains.
  uint8_t consent;
} atc_interlocking_input;

/// What the telegram of one circuit tells the train there.
typedef struct atc_movement {
  /// The circuits that the train may enter. Their transmitters are held on for it.
  uint64_t hold;
  /// 1: this device sends the telegram. 0: it sends nothing there; the neighbour's device is the one that speaks.
  uint8_t sent;
  /// The last circuit that the train may enter; its own if it must stay there.
  uint8_t stop;
  /// The direction in which it may leave its circuit; `ATC_HEADING_NONE` if it must stay there.
  uint8_t heading;
  /// The highest speed code, 0 to 7.
  uint8_t speed_code;
} atc_movement;

/// One logic cycle's output. The safe one shows no proceed, drives, permits and confirms nothing, and sends nothing; every
/// circuit counts as occupied. Of circuits and routes beyond the plan nothing is said, but in the safe output.
typedef struct atc_interlocking_output {
  /// The routes whose signals show proceed; all others show stop.
  uint64_t proceed;
  /// The blocked circuits that staff may rely on.
  uint64_t confirmed;
  /// The circuits that count as occupied.
  uint64_t occupied;
  /// The points that are driven to normal position.
  uint32_t drive_normal;
  /// The points that are driven to reverse position.
  uint32_t drive_reverse;
  /// What became of the request: one of the `ATC_ANSWER_` constants.
  uint32_t answer;
  /// The segments where this station permits the neighbour to send trains.
  uint8_t permits;
  /// The phase of each route: one of the `ATC_PHASE_` constants.
  uint8_t phases[64];
  /// The telegram of each circuit.
  struct atc_movement telegrams[64];
} atc_interlocking_output;

/// Circuits or routes of a large station: bit `i % 64` of word `i / 64` for the one of number `i`.
typedef struct atc_set256 {
  /// The bits, those of the lowest numbers in the first word.
  uint64_t words[4];
} atc_set256;

/// A stretch of plain line to a neighbouring station.
typedef struct atc_large_segment {
  /// The last circuit of every route that goes out to the segment, as a set of one; 0 if no route does.
  struct atc_set256 throat;
  /// Where its circuits begin in the array `segment_circuits`.
  uint16_t circuits_first;
  /// How many circuits it has: 1 to `ATC_MAX_PLACES`, of a large station `ATC_LARGE_MAX_PLACES`.
  uint16_t circuits_length;
  /// The direction of travel away from the station: `ATC_HEADING_LEFT` or `ATC_HEADING_RIGHT`.
  uint8_t outward;
  /// How many of its circuits, the outermost ones, the neighbour's device sees too.
  uint8_t shared;
} atc_large_segment;

/// Points of a large station: bit `i % 32` of word `i / 32` for point `i`.
typedef struct atc_set128 {
  /// The bits, those of the lowest numbers in the first word.
  uint32_t words[4];
} atc_set128;

/// One place of a route's path, or its overlap: what is held there.
typedef struct atc_large_element {
  /// The track circuit as a set of one. An overlap may have several, or none.
  struct atc_set256 circuits;
  /// The points that must stand normal, flank points included, as a set.
  struct atc_set128 normal;
  /// The points that must stand reverse, flank points included.
  struct atc_set128 reverse;
  /// The circuits beside it that are proved clear and not run over, as a set.
  struct atc_set256 beside;
} atc_large_element;

/// Segments of a large station: bit `i % 8` of word `i / 8` for segment `i`.
typedef struct atc_set32 {
  /// The bits, those of the lowest numbers in the first word.
  uint8_t words[4];
} atc_set32;

/// A route: from the signal at the exit of `entry` over its path to the end of its last circuit.
typedef struct atc_large_route {
  /// The circuit in rear of the route's signal, as a set of one.
  struct atc_set256 entry;
  /// The circuits on which a train may be that counts on the signal: `entry` among them.
  struct atc_set256 approach;
  /// The circuits that adjoin the end of the route.
  struct atc_set256 beyond;
  /// The routes that go on where this one ends, as a set.
  struct atc_set256 continuing;
  /// The routes that must not be held together with this one.
  struct atc_set256 conflicts;
  /// What is kept free beyond the end, in case the train does not stop in time.
  struct atc_large_element overlap;
  /// Where the path begins in the array `elements`.
  uint16_t path_first;
  /// How many places the path has: 1 to `ATC_MAX_PLACES`, of a large station `ATC_LARGE_MAX_PLACES`.
  uint16_t path_length;
  /// How many cycles the points may take to arrive, 1 or more.
  uint16_t drive_cycles;
  /// How many cycles a withdrawn route stays locked where a train may be coming.
  uint16_t release_cycles;
  /// How many cycles a train must have stood on the last circuit before the overlap is given up.
  uint16_t stay_cycles;
  /// The direction of travel: `ATC_HEADING_LEFT` or `ATC_HEADING_RIGHT`.
  uint8_t heading;
  /// The segment that the route's train comes from, as a set of one; 0 if it comes from none.
  struct atc_set32 from;
  /// The segment that the route's train goes out to, as a set of one; 0 if it goes to none.
  struct atc_set32 to;
  /// The highest speed code on the route: 1 to 7.
  uint8_t speed_code;
  /// The highest speed code on its overlap, 0 to 7: for a train that has slid there and goes back. 0 lets none of these leave.
  uint8_t overlap_speed_code;
  /// 1: every train that uses the route acts on telegrams alone, and not on what a driver sees. 0: some do not.
  uint8_t cab_signalled;
  /// 1: a calling-on route, whose train goes on sight into the overlap, the berth, where another one stands. 0: any other.
  uint8_t calling_on;
} atc_large_route;

/// The plan of a station in flat arrays. They are read by the call that gets them, and not kept. An array without an
/// entry may be null. A set is a word with bit `i` for the thing of number `i`; of a large station it is one of
/// `atc_set256`, `atc_set128` and `atc_set32`.
typedef struct atc_large_interlocking_config {
  /// The length of each circuit in metres: `circuit_count` entries.
  const uint16_t *lengths_m;
  /// The line speed of each circuit as a code, 0 to 7: `circuit_count` entries. Null: no circuit has a limit.
  const uint8_t *line_codes;
  /// The circuits that say that a train may stand on a point, for each point as a set: `point_count` entries.
  const struct atc_set256 *detectors;
  /// The segments of plain line: `segment_count` entries.
  const struct atc_large_segment *segments;
  /// The numbers of the segments' circuits, one segment after the other, the circuit next to the station first.
  const uint8_t *segment_circuits;
  /// The routes: `route_count` entries.
  const struct atc_large_route *routes;
  /// The places of the routes' paths, one route after the other in order of travel.
  const struct atc_large_element *elements;
  /// How far a train runs from the speed of each code when a lower one goes out, in metres: `code_count` entries.
  const uint16_t *braking_m;
  /// How many circuits there are: 0 to `ATC_MAX_CIRCUITS`, of a large station `ATC_LARGE_MAX_CIRCUITS`.
  size_t circuit_count;
  /// How many points there are: 0 to `ATC_MAX_POINTS`, of a large station `ATC_LARGE_MAX_POINTS`.
  size_t point_count;
  /// How many segments there are: 0 to `ATC_MAX_SEGMENTS`, of a large station `ATC_LARGE_MAX_SEGMENTS`.
  size_t segment_count;
  /// How many entries `segment_circuits` has: 0 to `ATC_MAX_SEGMENT_CIRCUITS`, of a large station `ATC_LARGE_MAX_SEGMENT_CIRCUITS`.
  size_t segment_circuit_count;
  /// How many routes there are: 0 to `ATC_MAX_ROUTES`, of a large station `ATC_LARGE_MAX_ROUTES`.
  size_t route_count;
  /// How many entries `elements` has: 0 to `ATC_MAX_ELEMENTS`, of a large station `ATC_LARGE_MAX_ELEMENTS`.
  size_t element_count;
  /// How many speed codes there are, 0 (stop) among them: 0 to `ATC_MAX_CODES`.
  size_t code_count;
  /// For how many cycles a segment's permission must have been withdrawn before it turns: 1 or more.
  uint16_t turn_cycles;
  /// For how many cycles after a start nothing moves, is confirmed or turned.
  uint16_t start_cycles;
  /// For how many cycles a train may run on after its authority was taken away.
  uint16_t residual_cycles;
  /// For how many cycles a train may still slide once it is wholly in the last circuit of a route.
  uint16_t standstill_cycles;
  /// How many cycles in a row a circuit must be reported clear before it counts as clear: 1 or more.
  uint8_t clear_cycles;
  /// For how many cycles in a row a point must be detected, undriven, before it counts as detected.
  uint8_t settle_cycles;
  /// For how many cycles in a row an occupied circuit may at most not be reported.
  uint8_t loss_cycles;
} atc_large_interlocking_config;

/// An interlocking of a large station, as `atc_interlocking` is one of a small station.
typedef struct atc_large_interlocking {
  /// Not to be read or written.
  uint64_t opaque[112428];
} atc_large_interlocking;

/// One logic cycle's input.
typedef struct atc_large_interlocking_input {
  /// The circuits that are reported occupied.
  struct atc_set256 occupied;
  /// The circuits that staff block.
  struct atc_set256 block;
  /// The circuits that staff unblock; one that is to be blocked as well is blocked.
  struct atc_set256 unblock;
  /// The circuits that staff restrict to `restrict_code`.
  struct atc_set256 restrict_circuits;
  /// The circuits whose restriction staff lift; one that is to be restricted as well has the new restriction only.
  struct atc_set256 lift;
  /// The points that are detected in normal position.
  struct atc_set128 detected_normal;
  /// The points that are detected in reverse position; a point that is in both is in neither.
  struct atc_set128 detected_reverse;
  /// The request: one of the `ATC_REQUEST_` constants.
  uint32_t request;
  /// The number of the route, point or segment that the request is for. Not looked at without a request.
  uint8_t number;
  /// The highest speed code on the circuits that are restricted: 0 to 7.
  uint8_t restrict_code;
  /// The segments where the neighbour permits this station to send trains.
  struct atc_set32 consent;
} atc_large_interlocking_input;

/// What the telegram of one circuit tells the train there.
typedef struct atc_large_movement {
  /// The circuits that the train may enter. Their transmitters are held on for it.
  struct atc_set256 hold;
  /// 1: this device sends the telegram. 0: it sends nothing there; the neighbour's device is the one that speaks.
  uint8_t sent;
  /// The last circuit that the train may enter; its own if it must stay there.
  uint8_t stop;
  /// The direction in which it may leave its circuit; `ATC_HEADING_NONE` if it must stay there.
  uint8_t heading;
  /// The highest speed code, 0 to 7.
  uint8_t speed_code;
} atc_large_movement;

/// One logic cycle's output. The safe one shows no proceed, drives, permits and confirms nothing, and sends nothing; every
/// circuit counts as occupied. Of circuits and routes beyond the plan nothing is said, but in the safe output.
typedef struct atc_large_interlocking_output {
  /// The routes whose signals show proceed; all others show stop.
  struct atc_set256 proceed;
  /// The blocked circuits that staff may rely on.
  struct atc_set256 confirmed;
  /// The circuits that count as occupied.
  struct atc_set256 occupied;
  /// The points that are driven to normal position.
  struct atc_set128 drive_normal;
  /// The points that are driven to reverse position.
  struct atc_set128 drive_reverse;
  /// What became of the request: one of the `ATC_ANSWER_` constants.
  uint32_t answer;
  /// The segments where this station permits the neighbour to send trains.
  struct atc_set32 permits;
  /// The phase of each route: one of the `ATC_PHASE_` constants.
  uint8_t phases[256];
  /// The telegram of each circuit.
  struct atc_large_movement telegrams[256];
} atc_large_interlocking_output;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/// The version of this library's border: `ATC_VERSION` of its header. A program compares the two once.
uint32_t atc_version(void);

/// What a status means, as a sentence in ASCII that ends with a zero byte. Any number may be asked for. The text is
/// never
/// freed.
const char *atc_status_text(int32_t status);

/// The size of an aspect acceptance in bytes: `ATC_ASPECT_SIZE`.
size_t atc_aspect_size(void);

/// The alignment of an aspect acceptance in bytes: `ATC_ASPECT_ALIGN`.
size_t atc_aspect_align(void);

/// Starts an aspect acceptance in the `size` bytes at `state`, which must be aligned: in its most restrictive state,
/// with these parameters.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it.
///
/// Of the caller:
/// `state` leads to `size` bytes of the caller's, `config` to a configuration. Nobody else uses them during the call.
enum atc_status atc_aspect_start(void *state, size_t size, const struct atc_aspect_config *config);

/// One logic cycle of an aspect acceptance: reads the aspects that were heard, and puts out the aspect that is
/// displayed.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// Of the caller:
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
enum atc_status atc_aspect_step(struct atc_aspect *state,
                                const struct atc_aspect_input *input,
                                struct atc_aspect_output *output);

/// The size of a speed supervision in bytes: `ATC_SUPERVISION_SIZE`.
size_t atc_supervision_size(void);

/// The alignment of a speed supervision in bytes: `ATC_SUPERVISION_ALIGN`.
size_t atc_supervision_align(void);

/// Starts a speed supervision in the `size` bytes at `state`, which must be aligned: in its most restrictive state,
/// with these parameters.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it.
///
/// Of the caller:
/// `state` leads to `size` bytes of the caller's, `config` to a configuration. Nobody else uses them during the call.
enum atc_status atc_supervision_start(void *state, size_t size, const struct atc_supervision_config *config);

/// One logic cycle of a speed supervision: reads the measured and the permitted speed, and puts out the brake command.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// Of the caller:
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
enum atc_status atc_supervision_step(struct atc_supervision *state,
                                     const struct atc_supervision_input *input,
                                     struct atc_supervision_output *output);

/// The size of a block in bytes: `ATC_BLOCK_SIZE`.
size_t atc_block_size(void);

/// The alignment of a block in bytes: `ATC_BLOCK_ALIGN`.
size_t atc_block_align(void);

/// Starts a block in the `size` bytes at `state`, which must be aligned: in its most restrictive state, with these
/// parameters.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it.
///
/// Of the caller:
/// `state` leads to `size` bytes of the caller's, `config` to a configuration. Nobody else uses them during the call.
enum atc_status atc_block_start(void *state, size_t size, const struct atc_block_config *config);

/// One logic cycle of a block: reads what its checks and detectors say, and puts out what is occupied.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// Of the caller:
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
enum atc_status atc_block_step(struct atc_block *state,
                               const struct atc_block_input *input,
                               struct atc_block_output *output);

/// The size of a permitted speed in bytes: `ATC_PERMITTED_SIZE`.
size_t atc_permitted_size(void);

/// The alignment of a permitted speed in bytes: `ATC_PERMITTED_ALIGN`.
size_t atc_permitted_align(void);

/// Starts a permitted speed in the `size` bytes at `state`, which must be aligned: in its most restrictive state,
/// with these parameters.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it.
///
/// Of the caller:
/// `state` leads to `size` bytes of the caller's, `config` to a configuration. Nobody else uses them during the call.
enum atc_status atc_permitted_start(void *state, size_t size, const struct atc_permitted_config *config);

/// One logic cycle of a permitted speed: reads what is heard and measured, and puts out the permitted speed.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// Of the caller:
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
enum atc_status atc_permitted_step(struct atc_permitted *state,
                                   const struct atc_permitted_input *input,
                                   struct atc_permitted_output *output);

/// The braking pattern: the highest speed from which a train stops in a distance. It needs no state. If anything is
/// wrong, the
/// output is 0.
///
/// Of the caller:
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
enum atc_status atc_pattern(const struct atc_pattern_input *input, struct atc_pattern_output *output);

/// The frame of a telegram. It needs no state. If anything is wrong, the frame is 106 zeros, which are no frame.
///
/// Of the caller:
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
enum atc_status atc_telegram_encode(const struct atc_telegram *telegram, struct atc_frame *frame);

/// The telegram of a frame. It needs no state. If the bits are no frame, the status says why, and the telegram is none.
///
/// Of the caller:
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
enum atc_status atc_telegram_decode(const struct atc_frame *frame, struct atc_telegram *telegram);

/// The size of a deframer in bytes: `ATC_DEFRAMER_SIZE`.
size_t atc_deframer_size(void);

/// The alignment of a deframer in bytes: `ATC_DEFRAMER_ALIGN`.
size_t atc_deframer_align(void);

/// Starts a deframer in the `size` bytes at `state`, which must be aligned: with no bit heard. It has no parameters.
///
/// Of the caller:
/// `state` leads to `size` bytes of the caller's. Nobody else uses them during the call.
enum atc_status atc_deframer_start(void *state, size_t size);

/// One bit time of a deframer: reads what the receiver decided, and puts out the telegram whose last bit this one
/// is, or none.
///
/// If anything is wrong, the state is as before and the telegram is none.
///
/// Of the caller:
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
enum atc_status atc_deframer_step(struct atc_deframer *state,
                                  const struct atc_deframer_input *input,
                                  struct atc_telegram *telegram);

/// The size of an on-board device in bytes: `ATC_TRAIN_SIZE`.
size_t atc_train_size(void);

/// The alignment of an on-board device in bytes: `ATC_TRAIN_ALIGN`.
size_t atc_train_align(void);

/// Starts an on-board device in the `size` bytes at `state`, which must be aligned: nothing is heard or known, and the emergency
/// brake is on.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it.
///
/// Of the caller:
/// `state` leads to `size` bytes of the caller's, `config` to a configuration. Nobody else uses them during the call.
enum atc_status atc_train_start(void *state,
                                size_t size,
                                const struct atc_train_config *config);

/// One logic cycle of an on-board device: reads what the antennas give, and puts out the display, the permitted speed, the position
/// and the brake.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// Of the caller:
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
enum atc_status atc_train_step(struct atc_train *state,
                               const struct atc_train_input *input,
                               struct atc_train_output *output);

/// The size of an interlocking in bytes: `ATC_INTERLOCKING_SIZE`.
size_t atc_interlocking_size(void);

/// The alignment of an interlocking in bytes: `ATC_INTERLOCKING_ALIGN`.
size_t atc_interlocking_align(void);

/// Checks a plan without starting anything, and says where it breaks a rule. If it breaks none, the place is all zeros.
///
/// Of the caller:
/// The pointers lead to what they say, and each array of the configuration has as many entries as it says.
enum atc_status atc_interlocking_check_plan(const atc_interlocking_config *config, struct atc_place *place);

/// Starts an interlocking in the `size` bytes at `state`, which must be aligned: in its most restrictive state, on
/// this plan.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it. `atc_interlocking_check_plan`
/// says where
/// a plan is wrong.
///
/// Of the caller:
/// `state` leads to `size` bytes of the caller's, `config` to a configuration, each array of which has as many
/// entries as it
/// says. Nobody else uses them during the call.
enum atc_status atc_interlocking_start(void *state, size_t size, const atc_interlocking_config *config);

/// One logic cycle of an interlocking: reads detection, requests, orders and consent, and puts out signals, points
/// and telegrams.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// Of the caller:
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
enum atc_status atc_interlocking_step(struct atc_interlocking *state,
                                      const atc_interlocking_input *input,
                                      atc_interlocking_output *output);

/// The size of an interlocking of a large station in bytes: `ATC_LARGE_INTERLOCKING_SIZE`.
size_t atc_large_interlocking_size(void);

/// The alignment of an interlocking of a large station in bytes: `ATC_LARGE_INTERLOCKING_ALIGN`.
size_t atc_large_interlocking_align(void);

/// Checks the plan of a large station without starting anything, and says where it breaks a rule. If it breaks none, the place is all zeros.
///
/// Of the caller:
/// The pointers lead to what they say, and each array of the configuration has as many entries as it says.
enum atc_status atc_large_interlocking_check_plan(const atc_large_interlocking_config *config,
                                                  struct atc_place *place);

/// Starts an interlocking of a large station in the `size` bytes at `state`, which must be aligned: in its most restrictive state, on
/// this plan.
///
/// If anything is wrong, the memory holds no state afterwards, and a step refuses it. `atc_large_interlocking_check_plan`
/// says where
/// a plan is wrong.
///
/// Of the caller:
/// `state` leads to `size` bytes of the caller's, `config` to a configuration, each array of which has as many
/// entries as it
/// says. Nobody else uses them during the call.
enum atc_status atc_large_interlocking_start(void *state,
                                             size_t size,
                                             const atc_large_interlocking_config *config);

/// One logic cycle of an interlocking of a large station: reads detection, requests, orders and consent, and puts out signals, points
/// and telegrams.
///
/// If anything is wrong, the state is as before and the output is the safe one.
///
/// Of the caller:
/// The pointers lead to what they say, of the caller's. Nobody else uses it during the call.
enum atc_status atc_large_interlocking_step(struct atc_large_interlocking *state,
                                            const atc_large_interlocking_input *input,
                                            atc_large_interlocking_output *output);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* ATC_H */
