//! The ground's device as one machine, beside a glue of its parts that is written from `spec/wayside.md` alone; its two channels; and a
//! counted line in front of a station, where one missed detection must not release a route.

use atc_kernel::Machine as _;
use atc_kernel::aspect::AspectTable;
use atc_kernel::block::{
    Beyond, Block, Detection, Direction, Hold, Line, LineInput, LineState, Metres, SectionSet, TrainCount,
};
use atc_kernel::code::{Code, CodeFrequencies, CodeTable, Millihertz};
use atc_kernel::duplex::Duplex;
use atc_kernel::interlocking::{
    self as kernel, CircuitId, CircuitSet, Combined, Epoch, Heading, Layout, MAX_CIRCUITS, Memory, Orders, PerCircuit,
    Plan, Position, Positions, Refusal, Request, RouteId, SegmentId, SegmentSet, SpeedCode, SpeedLimits, Travel,
};
use atc_kernel::speed::KmhTenths;
use atc_kernel::telegram::{Counter, Gradient, Main, Route, SectionId, Sub, Telegram, decode};
use atc_kernel::time::Ticks;
use atc_kernel::wayside::{
    Equipment, Facing, Fixed, Framed, Input, Join, Message, Output, Permission, Session, SignalPlan, Stamp, State,
    Wayside, WaysideError,
};
use atc_tests::sketch::{self, Line as Segment, Need, Sketch, Way};

type Station = Layout<2, 2, 1, 2>;
type Device<'a> = Wayside<'a, 2, 2, 2, 1, 2>;

const LIFE: Ticks = Ticks(4);
const SPEEDS: [u16; 4] = [0, 250, 450, 750];

/// `2 1 │ 0 3 │ 4 5`: from the line over circuits 0 and 3 to the line, with one point. Lengths differ.
fn station() -> Station {
    let needs: Vec<Need> = vec![(0, Position::Normal)];
    let sketch = Sketch {
        lengths: vec![210, 220, 230, 240, 250, 260],
        points: vec![vec![0]],
        routes: vec![Way {
            entry: 1,
            approach: vec![1, 2],
            path: vec![(0, needs), (3, vec![])],
            beyond: vec![4],
            from: Some(0),
            to: Some(1),
            drive: 4,
            release: 40,
            stay: 4,
            speed: 3,
            ..Way::default()
        }],
        segments: vec![
            Segment { circuits: vec![1, 2], throat: None, leftward: true },
            Segment { circuits: vec![4, 5], throat: Some(3), leftward: false },
        ],
        braking: vec![0, 100, 300, 700],
        clear: 3,
        turn: 5,
        ..Sketch::default()
    };
    Layout::new(sketch.plan()).expect("a station")
}

fn codes() -> CodeTable {
    let frequencies = |hertz: [u32; 4]| {
        CodeFrequencies::new(&hertz.map(|hertz| Millihertz(hertz * 1000)), Millihertz(1000)).expect("frequencies")
    };
    let mut speeds = [[None; 8]; 8];
    for (place, speed) in SPEEDS.into_iter().enumerate() {
        speeds[place][3 - place] = Some(KmhTenths(speed));
    }
    CodeTable::new(frequencies([10, 15, 22, 29]), frequencies([12, 17, 21, 27]), speeds).expect("a table")
}

/// The trains' table has one speed more than the station has codes.
fn aspects() -> AspectTable {
    AspectTable::new(&[0, 150, 250, 450, 750].map(KmhTenths)).expect("speeds")
}

fn signals() -> SignalPlan {
    let curve = aspects().aspect(KmhTenths(750)).expect("a rank");
    let facing = |section, gradient| Facing { section: SectionId(section), gradient: Gradient(gradient), curve };
    let mut circuits = PerCircuit::NONE;
    for (number, circuit) in (0_u16..6).zip(&mut circuits) {
        *circuit = Some(Fixed { left: facing(101 + 2 * number, -3), right: facing(200 + 2 * number, 5) });
    }
    let mut speeds = [None; 8];
    for (code, speed) in SPEEDS.into_iter().enumerate() {
        speeds[code] = Some(KmhTenths(speed));
    }
    SignalPlan { circuits, speeds, aspects: aspects(), codes: codes() }
}

fn block() -> Block {
    Block::new(1, 1, Hold::new(1).expect("a hold"), Ticks(20)).expect("a block")
}

/// Circuits 2 and 1, in the direction of travel.
fn join() -> Join<2> {
    let mut circuits = [[None; 16]; 2];
    circuits[0][0] = CircuitId::new(2);
    circuits[1][0] = CircuitId::new(1);
    Join {
        blocks: [block(); 2],
        direction: Direction::Up,
        train: Metres(200),
        segment: SegmentId::ZERO,
        travel: Travel::Toward,
        circuits,
    }
}

fn equipment() -> Equipment<2> {
    Equipment { counted: Some(join()), signals: signals(), life: LIFE, session: Session(7) }
}

fn device(station: &Station) -> Device<'_> {
    Wayside::new(station, &equipment()).expect("a device")
}

const STILL: Detection = Detection { low_check: false, high_check: false, present: SectionSet::EMPTY, reset: None };

fn quiet() -> Input<2, 2> {
    Input {
        blocks: [STILL; 2],
        occupied: CircuitSet::EMPTY,
        detected: sketch::positions(&[(0, Position::Normal)]),
        request: None,
        orders: Orders::default(),
        messages: [None; 2],
        framed: Framed { main: CircuitSet::ALL, sub: CircuitSet::ALL },
    }
}

/// A stream of numbers that is the same every time.
struct Draw(u64);

impl Draw {
    fn below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % end
    }

    fn one_in(&mut self, number: u64) -> bool {
        self.below(number) == 0
    }
}

/// What the neighbour may say: mostly an answer to one of the last cycles.
fn message(draw: &mut Draw, cycle: u32) -> Option<Message> {
    if draw.one_in(6) {
        return None;
    }
    let session = Session(if draw.one_in(16) { 6 } else { 7 });
    let back = u32::try_from(if draw.one_in(4) { draw.below(8) } else { 1 }).expect("small");
    let echo = Stamp { session, cycle: Epoch(cycle.wrapping_sub(back)) };
    Some(Message {
        permission: if draw.one_in(12) { Permission::Withheld } else { Permission::Granted },
        sent: Stamp { session: Session(1), cycle: Epoch(cycle) },
        echo: if draw.one_in(8) { None } else { Some(echo) },
    })
}

/// Inputs that let a train run now and then, with anything else that may be.
fn input(draw: &mut Draw, cycle: u32) -> Input<2, 2> {
    let all = CircuitSet::ALL;
    let orders = if draw.one_in(6) {
        Orders { unblock: all, lift: all, ..Orders::default() }
    } else if draw.one_in(20) {
        let circuit = CircuitSet::nth(usize::try_from(draw.below(6)).expect("small"));
        Orders { restrict: circuit, speed: SpeedCode(1), block: circuit.only_if(draw.one_in(4)), ..Orders::default() }
    } else {
        Orders::default()
    };
    let segment = |number| SegmentId::new(number).expect("a segment");
    let request = match draw.below(12) {
        0 => Some(Request::Turn(segment(0), Travel::Toward)),
        1 => Some(Request::Turn(segment(0), Travel::Away)),
        2 | 3 => Some(Request::Turn(segment(1), Travel::Away)),
        4..=6 => Some(Request::Set(RouteId::ZERO)),
        7 if draw.one_in(4) => Some(Request::Withdraw(RouteId::ZERO)),
        _ => None,
    };
    // Mostly the line is verified and empty.
    let mut detection = || {
        let train = draw.one_in(12);
        Detection {
            low_check: draw.one_in(40),
            high_check: draw.one_in(40),
            present: SectionSet::from_bits(u16::from(train)),
            reset: draw.one_in(2).then_some(TrainCount(u8::from(train))),
        }
    };
    let blocks = [detection(), detection()];
    let occupied = CircuitSet::from_bits(if draw.one_in(12) { draw.below(64) } else { 0 });
    Input {
        blocks,
        occupied,
        request,
        orders,
        detected: if draw.one_in(30) { Positions::NONE } else { quiet().detected },
        messages: [message(draw, cycle), message(draw, cycle)],
        framed: Framed { main: CircuitSet::from_bits(draw.below(64)), sub: CircuitSet::from_bits(draw.below(64)) },
    }
}

/// The parts, glued by hand.
struct Glue<'a> {
    station: &'a Station,
    line: Line<2>,
    counts: LineState<2>,
    memory: Memory<2, 2>,
    /// Of each segment: what the newest message permits, the own cycle that it answers, and the last stamp heard.
    heard: [(bool, Option<u32>, Option<Stamp>); 2],
    counters: [(u8, u8); MAX_CIRCUITS],
    sent: [bool; MAX_CIRCUITS],
    cycle: u32,
}

impl<'a> Glue<'a> {
    fn new(station: &'a Station) -> Self {
        let line = Line::new([block(); 2], &[Metres(230), Metres(220)], Metres(200), Direction::Up).expect("a line");
        Self {
            station,
            counts: line.initial(),
            line,
            memory: Memory::INITIAL,
            heard: [(false, None, None); 2],
            counters: [(0, 0); MAX_CIRCUITS],
            sent: [false; MAX_CIRCUITS],
            cycle: 0,
        }
    }

    fn consent(&mut self, messages: [Option<Message>; 2]) -> SegmentSet {
        let mut consent = SegmentSet::EMPTY;
        for (segment, (known, message)) in self.heard.iter_mut().zip(messages).enumerate() {
            if let Some(message) = message {
                let granted = message.permission == Permission::Granted;
                let answers = message.echo.filter(|echo| echo.session == Session(7)).map(|echo| echo.cycle.0);
                let recent = answers.filter(|cycle| self.cycle.wrapping_sub(*cycle) <= u32::from(LIFE.0));
                let newer = match (recent, known.1) {
                    (Some(recent), Some(before)) => self.cycle.wrapping_sub(recent) < self.cycle.wrapping_sub(before),
                    (recent, None) => recent.is_some(),
                    (None, Some(_)) => false,
                };
                if newer {
                    (known.0, known.1) = (granted, recent);
                }
                known.0 &= granted;
                known.2 = Some(message.sent);
            }
            let alive = known.1.is_some_and(|cycle| self.cycle.wrapping_sub(cycle) <= u32::from(LIFE.0));
            if known.0 && alive {
                consent = consent.or(SegmentSet::nth(segment));
            }
        }
        consent
    }

    fn step(&mut self, input: Input<2, 2>) -> Output<2, 2> {
        self.cycle += 1;
        let consent = self.consent(input.messages);
        for (number, counters) in self.counters.iter_mut().enumerate() {
            let taken = |set: CircuitSet| u8::from(self.sent[number] && set.meets(CircuitSet::nth(number)));
            counters.0 = counters.0.wrapping_add(taken(input.framed.main));
            counters.1 = counters.1.wrapping_add(taken(input.framed.sub));
        }
        let hold = if input.occupied.meets(CircuitSet::nth(0)) { Hold::new(1).expect("a hold") } else { Hold::NONE };
        let beyond = Beyond { hold, entered: true };
        let (counts, report) = self.line.step(self.counts, LineInput { blocks: input.blocks, beyond });
        self.counts = counts;
        let mut occupied = input.occupied;
        for (block, circuit) in [(0, 2), (1, 1)] {
            if report.blocks[block].occupied.contains(0) {
                occupied = occupied.or(CircuitSet::nth(circuit));
            }
        }
        let agree = report.blocks.iter().all(|block| block.agree);
        let turns = match input.request {
            Some(Request::Turn(SegmentId::ZERO, travel)) => travel == Travel::Away || !agree,
            _ => false,
        };
        let told = kernel::Input {
            occupied,
            detected: input.detected,
            request: input.request.filter(|_| !turns),
            orders: input.orders,
            consent,
        };
        let (memory, commands) = Combined(self.station).step(self.memory, told);
        self.memory = memory;
        let sent = Stamp { session: Session(7), cycle: Epoch(self.cycle) };
        let told = core::array::from_fn(|segment| {
            let permits = commands.interlocking.permits.meets(SegmentSet::nth(segment));
            let permission = if permits { Permission::Granted } else { Permission::Withheld };
            Some(Message { permission, sent, echo: self.heard[segment].2 })
        });
        let transmissions = core::array::from_fn(|number| {
            let movement = commands.telegrams[number].filter(|_| number < 6);
            self.sent[number] = movement.is_some();
            movement.map(|movement| self.transmission(number, movement))
        });
        Output {
            proceed: commands.interlocking.proceed,
            drives: commands.interlocking.drives,
            confirmed: commands.interlocking.confirmed,
            answer: if turns { Some(Err(Refusal::Direction)) } else { commands.interlocking.answer },
            messages: told,
            line: Some(report),
            transmissions: transmissions.into(),
        }
    }

    fn transmission(&self, number: usize, movement: kernel::Movement) -> atc_kernel::wayside::Transmission {
        let limits: SpeedLimits = self.memory.interlocking.works.restrictions;
        let restricted = (0..8).find(|code| limits.parts()[*code].meets(CircuitSet::nth(number)));
        let feed = |heading: Heading| {
            let goes = movement.heading == Some(heading);
            let code = if goes { usize::from(movement.speed.0).min(3) } else { 0 };
            let lengths = self.station.plan().lengths.iter().enumerate();
            let beyond: u16 = lengths.filter(|it| movement.hold.meets(CircuitSet::nth(it.0))).map(|it| it.1.0).sum();
            let rank = |speed: u16| aspects().aspect(KmhTenths(speed)).expect("a rank");
            let base = if heading == Heading::Left { 101 } else { 200 };
            let section = SectionId(base + 2 * u16::try_from(number).expect("small"));
            let main = Main {
                section,
                counter: Counter(self.counters[number].0),
                route: if goes { Route::OpenFor(Metres(beyond)) } else { Route::Closed },
                speed: rank(SPEEDS[code]),
            };
            let sub = Sub {
                section,
                counter: Counter(self.counters[number].1),
                length: atc_kernel::telegram::Length::new(self.station.plan().lengths[number]).expect("a length"),
                gradient: Gradient(if heading == Heading::Left { -3 } else { 5 }),
                curve: rank(750),
                restriction: rank(SPEEDS[restricted.unwrap_or(7).min(3)]),
            };
            let place = |place: usize| Code::new(u8::try_from(place).expect("small")).expect("a code");
            atc_kernel::wayside::Feed {
                main: atc_kernel::telegram::encode(Telegram::Main(main)),
                sub: atc_kernel::telegram::encode(Telegram::Sub(sub)),
                codes: atc_kernel::wayside::Codes { main: place(code), sub: place(3 - code) },
            }
        };
        atc_kernel::wayside::Transmission { left: feed(Heading::Left), right: feed(Heading::Right) }
    }
}

/// Whether a train that faces right is told to go.
fn open(output: &Output<2, 2>, number: usize) -> bool {
    let sent = output.transmissions[number].map(|sent| decode(sent.right.main));
    matches!(sent, Some(Ok(Telegram::Main(Main { route: Route::OpenFor(_), .. }))))
}

#[test]
fn the_device_is_its_parts() {
    let station = station();
    let device = device(&station);
    let mut draw = Draw(0x9E37_79B9_7F4A_7C15);
    let (mut opened, mut refused, mut permitted, mut disagreed) = (0, 0, 0, 0);
    for _ in 0..60 {
        let mut state = device.initial();
        let mut glue = Glue::new(&station);
        for cycle in 1..250 {
            let input = input(&mut draw, cycle);
            let (next, output) = device.step(state, input);
            assert!(next.is_valid(&device), "the state is not valid");
            assert_eq!(output, glue.step(input), "in cycle {cycle} with {input:?}");
            state = next;
            opened += usize::from(open(&output, 1));
            refused += usize::from(output.answer == Some(Err(Refusal::Direction)));
            permitted += usize::from(output.messages[0].is_some_and(|told| told.permission == Permission::Granted));
            disagreed += usize::from(output.line.is_some_and(|line| line.blocks.iter().any(|block| !block.agree)));
        }
    }
    assert!(
        opened > 20 && refused > 20 && permitted > 20 && disagreed > 20,
        "{opened} {refused} {permitted} {disagreed}"
    );
}

/// Every word of the state with one bit changed, as far as one place stands for all of its kind.
fn damaged(state: &State<2, 2, 2>) -> Vec<State<2, 2, 2>> {
    let mut all = Vec::new();
    let mut with = |change: &dyn Fn(&mut State<2, 2, 2>)| {
        let mut other = *state;
        change(&mut other);
        all.push(other);
    };
    for bit in 0..16 {
        with(&|it| it.consents[1].age.0 ^= 1 << bit);
        with(&|it| it.device.interlocking.routes[0].time.0 ^= 1 << bit);
    }
    for bit in 0..32 {
        with(&|it| it.device.cycle.0 ^= 1 << bit);
        with(&|it| it.device.interlocking.epoch.0 ^= 1 << bit);
    }
    for number in 0..MAX_CIRCUITS {
        for bit in 0..8 {
            with(&|it| it.counters[number].main.0 ^= 1 << bit);
            with(&|it| it.counters[number].sub.0 ^= 1 << bit);
        }
        with(&|it| it.sent = CircuitSet::from_bits(it.sent.bits() ^ 1 << number));
        let works = |bits: u64| CircuitSet::from_bits(bits ^ 1 << number);
        with(&|it| it.device.interlocking.works.blocked = works(it.device.interlocking.works.blocked.bits()));
    }
    for bit in 0..5 {
        with(&|it| it.line.borders[1].0 ^= 1 << bit);
    }
    with(&|it| it.consents[0].permission = Permission::Granted);
    with(&|it| it.consents[0].heard = None);
    all
}

#[test]
fn two_channels_put_out_nothing_on_which_they_differ() {
    let station = station();
    let device = device(&station);
    let mut draw = Draw(3);
    let mut pair = Duplex::initial(&device);
    for cycle in 1..60 {
        let (next, agreed) = pair.step(&device, input(&mut draw, cycle));
        assert!(agreed.is_some());
        pair = next;
    }
    let mut heard = pair.a.state;
    heard.consents[0].heard = Some(Stamp::default());
    heard.consents[0].permission = Permission::Withheld;
    pair.a.state = heard;
    pair.b.state = heard;
    let states = damaged(&pair.a.state);
    assert!(states.len() > 1000);
    for state in states {
        let mut faulty = pair;
        faulty.a.state = state;
        let (after, agreed) = faulty.step(&device, quiet());
        assert!(agreed.is_none() && after.is_tripped(), "a difference passed");
        assert_eq!(atc_kernel::duplex::output::<Device<'_>>(agreed).transmissions, PerCircuit::NONE);
    }
}

/// The sessions `disagreement-*`: a train on the counted line before a set route, and one detection that is missed.
#[test]
fn a_missed_detection_releases_nothing_in_front_of_the_train() {
    let station = station();
    let device = device(&station);
    let mut state = device.initial();
    let mut cycle = 0;
    let mut step = |change: &dyn Fn(&mut Input<2, 2>)| {
        let mut input = quiet();
        let echo = Some(Stamp { session: Session(7), cycle: Epoch(cycle) });
        let sent = Stamp { session: Session(1), cycle: Epoch(cycle) };
        input.messages = [Some(Message { permission: Permission::Granted, sent, echo }); 2];
        change(&mut input);
        let (next, output) = device.step(state, input);
        state = next;
        cycle += 1;
        output
    };
    let turn = |segment, travel| Some(Request::Turn(SegmentId::new(segment).expect("a segment"), travel));
    let all = CircuitSet::ALL;
    let empty = |input: &mut Input<2, 2>| {
        input.blocks = [Detection { reset: Some(TrainCount(0)), ..STILL }; 2];
        input.orders = Orders { unblock: all, lift: all, ..Orders::default() };
    };
    // The check-out of the exit end counts as on before the first cycle.
    step(&|_| {});
    step(&empty);
    for _ in 0..6 {
        step(&|_| {});
    }
    assert_eq!(step(&|input| input.request = turn(0, Travel::Toward)).answer, Some(Ok(())));
    assert_eq!(step(&|input| input.request = turn(1, Travel::Away)).answer, Some(Ok(())));
    // The train comes in at the low end, and over the border.
    let at = |block: usize| SectionSet::from_bits(u16::from(block == 0));
    let here = |block: usize, input: &mut Input<2, 2>| {
        input.blocks[0].present = at(block);
        input.blocks[1].present = at(1 - block);
    };
    step(&|input| {
        here(0, input);
        input.blocks[0].low_check = true;
    });
    step(&|input| {
        here(1, input);
        input.blocks[0].high_check = true;
        input.blocks[1].low_check = true;
    });
    for _ in 0..4 {
        step(&|input| here(1, input));
    }
    let set = step(&|input| {
        here(1, input);
        input.request = Some(Request::Set(RouteId::ZERO));
    });
    assert_eq!(set.answer, Some(Ok(())));
    let before = step(&|input| here(1, input));
    assert!(!before.proceed.is_empty() && open(&before, 1), "the train may go: {before:?}");
    // Its detection is missed: the block has a train that nobody hears, and reports all of it occupied; besides, circuits 0 and 3 flash.
    for flash in [0, 0b1001, 0, 0] {
        step(&|input| input.occupied = CircuitSet::from_bits(flash));
    }
    for _ in 0..10 {
        let output = step(&|input| here(1, input));
        assert!(output.drives.is_empty(), "a point is driven in front of the train");
    }
    let drive = step(&|input| {
        here(1, input);
        input.request = Some(Request::Drive(kernel::PointId::ZERO, Position::Reverse));
    });
    assert!(matches!(drive.answer, Some(Err(_))) && drive.drives.is_empty(), "the point is released: {drive:?}");
}

#[test]
fn the_counted_line_is_told_to_turn_in_vain() {
    let station = station();
    let device = device(&station);
    let input = Input { request: Some(Request::Turn(SegmentId::ZERO, Travel::Away)), ..quiet() };
    let (state, output) = device.step(device.initial(), input);
    assert_eq!(output.answer, Some(Err(Refusal::Direction)));
    assert!(state.is_valid(&device));
}

#[test]
fn a_list_in_the_wrong_order_is_refused() {
    let station = station();
    let refused = |change: &dyn Fn(&mut Equipment<2>)| {
        let mut equipment = equipment();
        change(&mut equipment);
        Wayside::new(&station, &equipment).map(|_| ()).expect_err("a rule is broken")
    };
    let reversed = refused(&|it| it.counted.as_mut().expect("a line").direction = Direction::Down);
    assert!(matches!(reversed, WaysideError::SectionsOutOfOrder(_)), "{reversed:?}");
    assert_eq!(refused(&|it| it.life = Ticks(5)), WaysideError::LifeOutlastsTurn);
    // A train that is sent at the end of a permission runs on.
    let slow = Station::new(Plan { residual: Ticks(2), loss: 1, ..*station.plan() }).expect("a station");
    let made = |life| Wayside::new(&slow, &Equipment { life, ..equipment() }).map(|_| ());
    assert_eq!((made(Ticks(3)), made(Ticks(2))), (Err(WaysideError::LifeOutlastsTurn), Ok(())));
    assert_eq!(refused(&|it| it.signals.speeds[1] = Some(KmhTenths(260))), WaysideError::NoRank(SpeedCode(1)));
    let twice = refused(&|it| {
        let fixed = it.signals.circuits[0];
        it.signals.circuits[5] = fixed;
    });
    assert!(matches!(twice, WaysideError::SectionNumberTwice(_)), "{twice:?}");
    let other = refused(&|it| {
        let Fixed { left, right } = it.signals.circuits[5].expect("described");
        it.signals.circuits[5] = Some(Fixed { left: right, right: left });
    });
    assert!(matches!(other, WaysideError::SectionNumberOfOther(_)), "{other:?}");
}
