//! From movements to frames and codes (T-WAY-3, T-WAY-4), and what the constructor asks of the signals.

use super::{LONGEST, plan};
use crate::Engine;
use crate::engine::{any_byte, any_flag};
use crate::interlocking::any_heading;
use atc_kernel::Machine;
use atc_kernel::aspect::{AspectId, AspectTable};
use atc_kernel::code::{CodeFrequencies, CodeTable, MAX_CODES as PLACES, Millihertz};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Commands, Contents, Epoch, Grant, Heading, Layout, MAX_CIRCUITS, MAX_CODES, Memory,
    Movement, Orders, Positions, RouteSet, Segment, SegmentSet, SpeedCode, SpeedLimits, Standing, Table, begins,
    telegram,
};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Counter, Frame, Gradient, Main, Route, SectionId, Sub, Telegram, decode};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{
    Counters, Equipment, Facing, Feed, Fixed, Reading, Saying, Session, SignalPlan, Signals, Wayside, WaysideError,
};

/// The circuits with a length: the own one, number 0, and three ahead.
const CIRCUITS: usize = 4;
/// The speeds of the trains' table.
const SPEEDS: usize = 3;

const BOUND: &str = "1 route, 4 circuits, tables of 3 speeds, 2 code frequencies of each carrier";

type Station = Layout<1, 1, 0, 1>;
type Device<'a> = Wayside<'a, 0, 1, 1, 0, 1>;

/// A station whose circuits have any lengths.
fn any_station<E: Engine + ?Sized>(e: &mut E) -> Option<Station> {
    let mut made = plan::<1, 1, 1>();
    made.turn = Ticks(2);
    for (number, length) in made.lengths.iter_mut().enumerate() {
        *length = if number < CIRCUITS { Metres(e.word("length of a circuit (m)", 1..=300)) } else { Metres(0) };
    }
    for (code, distance) in made.braking.iter_mut().enumerate() {
        if code < SPEEDS {
            *distance = Metres(e.word(
                "braking distance of a code (m, 65535: no such code)",
                [0..=0, 100..=100, u16::MAX..=u16::MAX][code].clone(),
            ));
        }
    }
    let layout = Layout::with_what_proofs_need(made).ok();
    e.assume(layout.is_some());
    layout
}

/// Any tables of speeds and codes.
fn any_tables<E: Engine + ?Sized>(e: &mut E) -> Option<(AspectTable, CodeTable)> {
    let mut likely = 0;
    let speeds: [KmhTenths; SPEEDS] = core::array::from_fn(|_| {
        likely += 1;
        KmhTenths(e.word("a speed (tenths of km/h)", likely - 1..=likely - 1))
    });
    let aspects = AspectTable::new(&speeds).ok();
    let codes = CodeFrequencies::new(&[Millihertz(10_000), Millihertz(15_000)], Millihertz(1_000)).ok()?;
    let mut named = [[None; PLACES]; PLACES];
    let mut likely = 0;
    for row in named.iter_mut().take(2) {
        for speed in row.iter_mut().take(2) {
            let its = KmhTenths(e.word("speed of a pair of codes (tenths of km/h)", likely..=likely));
            likely += 1;
            *speed = if e.word("the pair names a speed (odd: yes)", 1..=1) & 1 == 1 { Some(its) } else { None };
        }
    }
    let table = CodeTable::new(codes, codes, named).ok();
    e.assume(aspects.is_some() && table.is_some());
    Some((aspects?, table?))
}

fn any_rank<E: Engine + ?Sized>(e: &mut E) -> Option<AspectId> {
    let rank = AspectId::new(any_byte(e, "curve limit (rank)", 0..=2));
    e.assume(rank.is_some());
    rank
}

fn any_facing<E: Engine + ?Sized>(e: &mut E, likely: u16) -> Option<Facing> {
    Some(Facing {
        section: SectionId(e.word("section number", likely..=likely + 1)),
        gradient: Gradient(i8::from_le_bytes([any_byte(e, "gradient (‰, two's complement)", 0..=255)])),
        curve: any_rank(e)?,
    })
}

/// Any signals of the own circuit, and of the next if there are two.
fn any_signals<E: Engine + ?Sized>(e: &mut E, circuits: usize) -> Option<SignalPlan> {
    let (aspects, codes) = any_tables(e)?;
    let mut made = SignalPlan { circuits: [None; MAX_CIRCUITS], speeds: [None; MAX_CODES], aspects, codes };
    for (number, speed) in (0_u16..).zip(made.speeds.iter_mut().take(SPEEDS)) {
        let its = KmhTenths(e.word("speed of a code (tenths of km/h)", number..=number));
        *speed = if e.word("there is such a code (odd: yes)", 1..=1 + number / 2) & 1 == 1 { Some(its) } else { None };
    }
    for (number, circuit) in (0_u16..).zip(made.circuits.iter_mut().take(circuits)) {
        *circuit = Some(Fixed { left: any_facing(e, 4 * number)?, right: any_facing(e, 4 * number + 2)? });
    }
    Some(made)
}

/// The signals, checked.
fn made<E: Engine + ?Sized>(e: &mut E, station: &Station, signals: &SignalPlan) -> Option<Signals> {
    let made = Signals::new(station, signals).ok();
    e.assume(made.is_some());
    made
}

/// Any movement of a train in circuit 0, whatever the ATC may say.
fn any_movement<E: Engine + ?Sized>(e: &mut E) -> Movement {
    let heading = any_heading(e, "heading of the movement (odd: right)");
    Movement {
        stop: CircuitId::ZERO,
        heading: if any_flag(e, "the train may leave its circuit (odd: yes)") { Some(heading) } else { None },
        speed: SpeedCode(any_byte(e, "speed code", 0..=3)),
        hold: CircuitSet::from_bits(u64::from(e.word("granted (bits)", 0..=15) & 15)),
    }
}

/// The main telegram of a frame, as trains decode it.
fn main_of(frame: Frame) -> Option<Main> {
    match decode(frame) {
        Ok(Telegram::Main(main)) => Some(main),
        _ => None,
    }
}

/// The sub telegram of a frame, as trains decode it.
fn sub_of(frame: Frame) -> Option<Sub> {
    match decode(frame) {
        Ok(Telegram::Sub(sub)) => Some(sub),
        _ => None,
    }
}

/// The speed that the highest known code up to `code` stands for.
fn speed_of(signals: &SignalPlan, code: SpeedCode) -> KmhTenths {
    let mut speed = KmhTenths(0);
    for number in 0..SPEEDS {
        if let (Some(its), true) = (signals.speeds[number], number <= usize::from(code.0)) {
            speed = its;
        }
    }
    speed
}

/// What trains of a direction of travel know of circuit 0.
fn its_facing(signals: &SignalPlan, heading: Heading) -> Option<Facing> {
    let fixed = signals.circuits[0]?;
    Some(if heading == Heading::Left { fixed.left } else { fixed.right })
}

/// What they hear there.
fn heard<E: Engine + ?Sized>(
    e: &mut E,
    station: &Station,
    signals: &Signals,
    movement: Movement,
    heading: Heading,
) -> Option<(Feed, Counters, SpeedLimits)> {
    let mut any = |what| Counter(any_byte(e, what, 0..=255));
    let counters = Counters { main: any("number of the main telegram"), sub: any("number of the sub telegram") };
    let limit = SpeedCode(any_byte(e, "temporary restriction (code)", 0..=3));
    let here = CircuitSet::from_bits(u64::from(e.word("restricted circuits (bits)", 0..=15) & 15));
    let restrictions = SpeedLimits::NONE.and_at_most(limit, here);
    let saying = Saying { circuit: CircuitId::ZERO, movement, restrictions, counters };
    let sent = signals.transmission(&station.plan().lengths, saying)?;
    Some((if heading == Heading::Left { sent.left } else { sent.right }, counters, restrictions))
}

harness! {
    /// What trains decode of a main frame never permits more than the movement: it is open only under the number of the movement's direction of travel, no
    /// farther than the granted circuits are long together, and rank and codes, by the trains' tables, name a speed that is not above that of the
    /// movement's code.
    t_way_3(e)
    theorem "T-WAY-3";
    requirements ["WAY-3", "WAY-4", "WAY-5"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Read: "the frame is read as a main telegram of this number and of the section number of the direction of travel, which trains of the other do not have",
        Open: "it is open only for the movement's direction of travel, and then the distance is that of the granted circuits, or the longest there is",
        Rank: "its rank is of the speed of the movement's code, or of the highest known code below it",
        Codes: "the codes name the same speed as the rank",
        Stop: "for the other direction of travel it is closed, and rank and codes are of speed 0",
    }
    covers {
        Open: "an open telegram",
        Two: "two circuits are granted",
        Saturated: "the granted circuits are longer than a telegram can tell",
        Other: "trains of the other direction of travel hear of an open movement",
        Lower: "the movement's code is not known",
    }
    {
        let Some(station) = any_station(e) else { return };
        let Some(signals) = any_signals(e, 1) else { return };
        let Some(said) = made(e, &station, &signals) else { return };
        let movement = any_movement(e);
        let heading = any_heading(e, "heading of the train (odd: right)");
        let Some((feed, counters, _)) = heard(e, &station, &said, movement, heading) else { return e.claim(Claim::Read as u32, false) };
        let Some(main) = main_of(feed.main) else { return e.claim(Claim::Read as u32, false) };
        let (Some(its), Some(other)) = (its_facing(&signals, heading), its_facing(&signals, heading.opposite())) else { return };
        let own = main.section == its.section && main.section != other.section;
        e.claim(Claim::Read as u32, own && main.counter == counters.main);
        let mut together = 0_u32;
        for number in 0..CIRCUITS {
            let granted = movement.hold.bits() >> number & 1 == 1;
            together += if granted { u32::from(station.plan().lengths[number].0) } else { 0 };
        }
        let most = if together < 0xFFFF { together } else { 0xFFFF };
        let meant = movement.heading == Some(heading);
        let distance = match main.route {
            Route::OpenFor(distance) => meant && u32::from(distance.0) == most,
            Route::Closed => !meant,
        };
        e.claim(Claim::Open as u32, distance);
        let speed = signals.aspects.speed(main.speed);
        e.claim(Claim::Rank as u32, !meant || speed == Some(speed_of(&signals, movement.speed)));
        e.claim(Claim::Codes as u32, signals.codes.speed(Some(feed.codes.main), Some(feed.codes.sub)) == speed && speed.is_some());
        e.claim(Claim::Stop as u32, meant || speed == Some(KmhTenths(0)));
        e.cover(Cover::Open as u32, meant && speed != Some(KmhTenths(0)));
        e.cover(Cover::Two as u32, meant && movement.hold.bits() == 6);
        e.cover(Cover::Saturated as u32, meant && together > 0xFFFF);
        e.cover(Cover::Other as u32, movement.heading.is_some() && !meant);
        e.cover(Cover::Lower as u32, meant && movement.speed.0 == 2 && signals.speeds[2].is_none());
    }
}

harness! {
    /// A ghost train on metres that stops before the end of what it decodes, whatever it knows besides, has its front within its own circuit or in one that was
    /// granted: the circuits ahead of it are as long as the layout says, and those that are granted follow its own without a gap.
    t_way_3_train(e)
    theorem "T-WAY-3";
    requirements ["WAY-3"];
    assumptions ["path-complete", "trains-know-facing", "held-routes-compatible"];
    built_in &[
        ("path-complete", "the circuits ahead of the ghost are 1, 2 and 3, with the layout's lengths"),
        ("trains-know-facing", "the ghost uses the frame of the direction of travel that it faces"),
        ("held-routes-compatible", "what is granted are the first circuits ahead, for the direction in which they lie"),
    ];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Within: "a front beyond the exit is in a granted circuit",
        Faces: "a train that faces the other way does not leave its circuit",
    }
    covers {
        First: "the front is in the first circuit ahead",
        Third: "the front is in the third circuit ahead",
        Faces: "a train faces the other way",
    }
    {
        let Some(station) = any_station(e) else { return };
        let Some(signals) = any_signals(e, 1) else { return };
        let Some(said) = made(e, &station, &signals) else { return };
        let ahead = any_heading(e, "direction in which the circuits lie (odd: right)");
        let granted = e.word("circuits granted", 0..=3);
        e.assume(granted <= 3);
        let hold = CircuitSet::from_bits(match granted { 0 => 0, 1 => 2, 2 => 6, _ => 14 });
        let heading = if granted > 0 { Some(ahead) } else { None };
        let speed = SpeedCode(any_byte(e, "speed code", 0..=3));
        let movement = Movement { stop: CircuitId::ZERO, heading, speed, hold };
        let faces = any_heading(e, "heading of the train (odd: right)");
        let Some((feed, _, _)) = heard(e, &station, &said, movement, faces) else { return e.claim(Claim::Within as u32, false) };
        let Some(main) = main_of(feed.main) else { return e.claim(Claim::Within as u32, false) };
        // Metres of the ghost's front beyond the exit; 0: in its own circuit. It is before the stopping point, or at it.
        let front = u32::from(e.word("front beyond the exit (m)", 0..=900));
        let may = match main.route {
            Route::OpenFor(distance) => front <= u32::from(distance.0),
            Route::Closed => front == 0,
        };
        e.assume(may);
        let (mut begins, mut within) = (0_u32, front == 0);
        let mut circuit = 0;
        for number in 1..CIRCUITS {
            let ends = begins + u32::from(station.plan().lengths[number].0);
            let there = front > begins && front <= ends;
            within |= there && hold.bits() >> number & 1 == 1;
            circuit = if there { number } else { circuit };
            begins = ends;
        }
        e.claim(Claim::Within as u32, within);
        e.claim(Claim::Faces as u32, faces == ahead || front == 0);
        e.cover(Cover::First as u32, circuit == 1);
        e.cover(Cover::Third as u32, circuit == 3);
        e.cover(Cover::Faces as u32, faces != ahead && granted > 0);
    }
}

harness! {
    /// What trains decode of a sub frame is the fixed data of the circuit for their direction of travel, with the layout's length, and a restriction that is not
    /// above the temporary restriction of the circuit.
    t_way_3_sub(e)
    theorem "T-WAY-3";
    requirements ["WAY-6"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Read: "the frame is read as a sub telegram of this number and of the section number of the direction of travel",
        Fixed: "it has the layout's length, and gradient and curve of the direction of travel",
        Limit: "its restriction is of a speed that is not above that of the temporary restriction",
    }
    covers {
        Restricted: "the circuit is restricted to speed 0",
        Free: "the circuit is not restricted",
    }
    {
        let Some(station) = any_station(e) else { return };
        let Some(signals) = any_signals(e, 1) else { return };
        let Some(said) = made(e, &station, &signals) else { return };
        let heading = any_heading(e, "heading of the train (odd: right)");
        let movement = Movement::stop_in(CircuitId::ZERO);
        let Some((feed, counters, restrictions)) = heard(e, &station, &said, movement, heading) else { return e.claim(Claim::Read as u32, false) };
        let Some(sub) = sub_of(feed.sub) else { return e.claim(Claim::Read as u32, false) };
        let Some(its) = its_facing(&signals, heading) else { return };
        e.claim(Claim::Read as u32, sub.section == its.section && sub.counter == counters.sub);
        let length = sub.length.metres() == station.plan().lengths[0];
        e.claim(Claim::Fixed as u32, length && sub.gradient == its.gradient && sub.curve == its.curve);
        let mut limit = SpeedCode::MOST;
        for (code, circuits) in (0_u8..).zip(restrictions.parts()) {
            if circuits.bits() & 1 == 1 && code < limit.0 {
                limit = SpeedCode(code);
            }
        }
        e.claim(Claim::Limit as u32, signals.aspects.speed(sub.restriction) == Some(speed_of(&signals, limit)));
        e.cover(Cover::Restricted as u32, limit.0 == 0 && signals.aspects.speed(sub.restriction) == Some(KmhTenths(0)));
        e.cover(Cover::Free as u32, limit == SpeedCode::MOST);
    }
}

harness! {
    /// Where the table cannot be read, the circuit is not occupied, or nothing is granted to the train there, trains of both directions of travel decode a closed
    /// telegram with the rank of speed 0, and hear its codes.
    t_way_4(e)
    theorem "T-WAY-4";
    requirements ["WAY-5"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Closed: "the telegram is closed",
        Speed: "its rank and the codes are of speed 0",
    }
    covers {
        Stale: "the table is of another cycle, and grants",
        Empty: "the table is of this cycle and grants, and the circuit is not occupied",
        Nothing: "the circuit is occupied, and nothing is granted",
    }
    {
        let Some(station) = any_station(e) else { return };
        let Some(signals) = any_signals(e, 1) else { return };
        let Some(said) = made(e, &station, &signals) else { return };
        let here = CircuitSet::nth(0);
        let ahead = CircuitSet::nth(1);
        let (stale, occupied) = (any_flag(e, "the table is of another cycle (odd: yes)"), any_flag(e, "the circuit is occupied (odd: yes)"));
        let grants = any_flag(e, "a circuit is granted (odd: yes)");
        let heading = any_heading(e, "heading of the grant (odd: right)");
        let grant = Grant { train: here, circuits: ahead, last: ahead, complete: true, heading, speed: SpeedCode::MOST };
        let contents = Contents {
            occupied: here.only_if(occupied),
            blocked: CircuitSet::EMPTY,
            grants: [if grants { grant } else { Grant::NONE }],
            toward: SegmentSet::EMPTY,
            away: SegmentSet::EMPTY,
            standing: Standing { bodies: [CircuitSet::EMPTY], loose: CircuitSet::EMPTY, limits: SpeedLimits::NONE },
        };
        e.assume(stale || !occupied || !grants);
        let table = Table::write(Epoch(7), contents);
        let read = table.read(Epoch(if stale { 8 } else { 7 }));
        let begins = read.as_ref().map_or(CircuitSet::EMPTY, |contents| begins(&station, contents));
        let movement = telegram(&station, read.as_ref(), begins, CircuitId::ZERO);
        let faces = any_heading(e, "heading of the train (odd: right)");
        let Some((feed, _, _)) = heard(e, &station, &said, movement, faces) else { return e.claim(Claim::Closed as u32, false) };
        let Some(main) = main_of(feed.main) else { return e.claim(Claim::Closed as u32, false) };
        e.claim(Claim::Closed as u32, main.route == Route::Closed);
        let codes = signals.codes.speed(Some(feed.codes.main), Some(feed.codes.sub));
        let stop = Some(KmhTenths(0));
        e.claim(Claim::Speed as u32, signals.aspects.speed(main.speed) == stop && codes == stop);
        e.cover(Cover::Stale as u32, stale && occupied && grants);
        e.cover(Cover::Empty as u32, !stale && !occupied && grants);
        e.cover(Cover::Nothing as u32, !stale && occupied && !grants);
    }
}

harness! {
    /// What leaves the device in a cycle: nothing in a circuit where the ATC is silent, or of which nothing is said; in every other what is made of
    /// the ATC's movement there, the restrictions and the numbers; and signals, drives and confirmed blocks as the interlocking commands. The safe output
    /// is silence; and what is remembered to be sent is what was sent.
    t_way_8_sent(e)
    theorem "T-WAY-8";
    requirements ["WAY-21", "WAY-23"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Silent: "where the ATC is silent nothing is sent",
        Said: "where it is not, what is sent is made of its movement, the restrictions and the numbers of this circuit",
        Sent: "the circuits for which there are frames are remembered, and no others",
        Commands: "signals, drives and confirmed blocks are as the interlocking commands, and permissions go to the neighbour",
        Safe: "the safe output is stop, no drive, no confirmed block, silence in every circuit and to the neighbour",
    }
    covers {
        Silent: "the ATC is silent",
        Said: "an open telegram is sent",
    }
    {
        let Some(mut plan) = any_station(e).map(|station| *station.plan()) else { return };
        plan.segments = [Segment { circuits: [CircuitSet::nth(0)], length: 1, ..Segment::NONE }];
        let station = Layout::with_what_proofs_need(plan).ok();
        e.assume(station.is_some());
        let Some(station) = station else { return };
        let Some(signals) = any_signals(e, 1) else { return };
        let equipment = Equipment::<0> { counted: None, signals, life: Ticks(1), session: Session(0) };
        let device: Option<Device> = Wayside::new(&station, &equipment).ok();
        e.assume(device.is_some());
        let Some(device) = device else { return };
        let movement = any_movement(e);
        let silent = any_flag(e, "the ATC is silent (odd: yes)");
        let mut telegrams = [None; MAX_CIRCUITS];
        telegrams[0] = if silent { None } else { Some(movement) };
        // Of circuit 1 nothing is said.
        telegrams[1] = Some(movement);
        let mut state = device.initial();
        let counters = Counters { main: Counter(any_byte(e, "number of the main telegram", 0..=255)), sub: Counter(0) };
        state.counters[0] = counters;
        let limit = SpeedCode(any_byte(e, "temporary restriction (code)", 0..=3));
        let restrictions = SpeedLimits::NONE.and_at_most(limit, CircuitSet::nth(0));
        state.device = Memory::INITIAL;
        state.device.interlocking.works.restrictions = restrictions;
        let bits = e.word("commanded (bits)", 0..=1);
        let one = u64::from(bits & 1);
        let interlocking = atc_kernel::interlocking::Output {
            proceed: RouteSet::from_bits(one),
            drives: Positions::NONE,
            permits: SegmentSet::from_bits(one.to_le_bytes()[0]),
            confirmed: CircuitSet::from_bits(u64::from(bits >> 1)),
            answer: None,
            table: Table::UNREADABLE,
        };
        let told = atc_kernel::interlocking::Input {
            occupied: CircuitSet::EMPTY,
            detected: Positions::NONE,
            request: None,
            orders: Orders::default(),
            consent: SegmentSet::EMPTY,
        };
        let reading: Reading<0> = Reading { input: told, line: None, refused: None };
        let (after, output) = device.send(state, &reading, &Commands { interlocking, telegrams });
        let saying = Saying { circuit: CircuitId::ZERO, movement, restrictions, counters };
        let expected = device.signals().transmission(&station.plan().lengths, saying);
        e.claim(Claim::Silent as u32, (!silent || output.transmissions[0].is_none()) && output.transmissions[1].is_none());
        e.claim(Claim::Said as u32, silent || expected.is_some() && output.transmissions[0] == expected);
        e.claim(Claim::Sent as u32, after.sent.bits() == u64::from(!silent));
        let permitted = output.messages[0].is_some_and(|message| (message.permission == atc_kernel::wayside::Permission::Granted) == (one == 1));
        let commands = output.proceed == interlocking.proceed && output.drives == interlocking.drives && output.confirmed == interlocking.confirmed;
        e.claim(Claim::Commands as u32, commands && permitted && output.answer.is_none());
        let safe = <Device as Machine>::SAFE;
        let mut silence = safe.messages[0].is_none();
        for sent in safe.transmissions {
            silence &= sent.is_none();
        }
        e.claim(Claim::Safe as u32, silence && safe.proceed.bits() == 0 && safe.drives.is_empty() && safe.confirmed.bits() == 0 && safe.answer.is_none());
        e.cover(Cover::Silent as u32, silent);
        e.cover(Cover::Said as u32, !silent && movement.is_open());
    }
}

harness! {
    /// Signals are accepted if and only if code 0 is of speed 0 and speeds rise with the codes, each speed is in both of the trains' tables, every code with a
    /// braking distance has one, every circuit of the segment is described and has a length, curves are in the table, and no section number stands twice. The error
    /// names a rule that is broken.
    way_signals(e)
    theorem "T-WAY-8";
    requirements ["WAY-16", "WAY-17", "WAY-18", "WAY-19"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Exact: "accepted if and only if every rule is kept",
        Told: "the error names a rule that is broken",
    }
    covers {
        Accepted: "signals of two circuits are accepted",
        Falls: "a speed that does not rise",
        Twice: "a section number stands twice",
        Missing: "a circuit of the segment is not described",
    }
    {
        let Some(mut plan) = any_station(e).map(|station| *station.plan()) else { return };
        let segment = CircuitSet::nth(usize::from(e.word("circuit of the segment (number)", 0..=2) & 3));
        plan.segments = [Segment { circuits: [segment], length: 1, ..Segment::NONE }];
        let station = Layout::with_what_proofs_need(plan).ok();
        e.assume(station.is_some());
        let Some(station) = station else { return };
        let Some(signals) = any_signals(e, 2) else { return };
        let made = Signals::new(&station, &signals);
        let (mut rises, mut ranked, mut paired, mut every) = (true, true, true, true);
        let mut before: Option<KmhTenths> = None;
        for code in 0..SPEEDS {
            let braking = plan.braking[code].0 < u16::MAX;
            every &= signals.speeds[code].is_some() || !braking;
            let Some(speed) = signals.speeds[code] else { continue };
            rises &= before.is_none_or(|before| before < speed);
            before = Some(speed);
            let (mut rank, mut pair) = (false, false);
            for known in 0..3 {
                rank |= AspectId::new(known).is_some_and(|rank| signals.aspects.speed(rank) == Some(speed));
            }
            for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let pair_of = (atc_kernel::code::Code::new(row), atc_kernel::code::Code::new(column));
                pair |= signals.codes.speed(pair_of.0, pair_of.1) == Some(speed);
            }
            (ranked, paired) = (ranked & rank, paired & pair);
        }
        let stops = signals.speeds[0] == Some(KmhTenths(0));
        let (Some(one), Some(other)) = (signals.circuits[0], signals.circuits[1]) else { return };
        let ids = [one.left.section.0, one.right.section.0, other.left.section.0, other.right.section.0];
        let mut twice = false;
        for (place, id) in ids.iter().enumerate() {
            for (earlier, its) in ids.iter().enumerate() {
                twice |= earlier < place && id == its;
            }
        }
        let described = segment.bits() & 0b1100 == 0;
        let lengths = plan.lengths[0].0 > 0 && plan.lengths[1].0 > 0;
        let known = |rank: AspectId| usize::from(rank.rank()) < SPEEDS;
        let curves = known(one.left.curve) && known(one.right.curve) && known(other.left.curve) && known(other.right.curve);
        let legal = stops && rises && ranked && paired && every && described && lengths && curves && !twice;
        e.claim(Claim::Exact as u32, made.is_ok() == legal);
        let told = match made.as_ref().err() {
            None => true,
            Some(WaysideError::StopMoves) => !stops,
            Some(WaysideError::SpeedsFall(_)) => !rises,
            Some(WaysideError::NoRank(_)) => !ranked,
            Some(WaysideError::NoPair(_)) => !paired,
            Some(WaysideError::CodeWithoutSpeed(_)) => !every,
            Some(WaysideError::CircuitWithoutSignals(_)) => !described,
            Some(WaysideError::NoLength(_)) => !lengths,
            Some(WaysideError::UnknownCurve(_)) => !curves,
            Some(WaysideError::SectionNumberTwice(_)) => twice,
            Some(_) => false,
        };
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, made.is_ok());
        e.cover(Cover::Falls as u32, matches!(made, Err(WaysideError::SpeedsFall(_))));
        e.cover(Cover::Twice as u32, matches!(made, Err(WaysideError::SectionNumberTwice(_))));
        e.cover(Cover::Missing as u32, matches!(made, Err(WaysideError::CircuitWithoutSignals(_))));
    }
}
