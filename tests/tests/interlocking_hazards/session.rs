//! A device of the passing loop, stepped by names.

use atc_kernel::Machine;
use atc_kernel::interlocking::{
    CircuitSet, Input, Movement, Orders, Output, Phase, PointId, Position, Positions, Refusal, Request, RouteId,
    SegmentId, SegmentSet, SpeedCode, State, Station, Travel,
};
use atc_kernel::time::Ticks;
use atc_layout::{Description, Names};

const LOOP: &str = include_str!("../../../layouts/passing-loop.toml");

const TERMINUS: &str = include_str!("../../../layouts/terminus.toml");

/// All circuits, from west to east.
pub const ALL: [&str; 8] = ["W2", "W1", "P1T", "1T", "2T", "P2T", "E1", "E2"];

/// A device and what it said last.
pub struct Session {
    layout: Box<Station>,
    names: Names,
    state: Box<State<64, 8>>,
    said: Box<Output<64>>,
    /// Where the points are detected.
    pub detected: Positions,
    /// The segments where the neighbour permits this station to send.
    pub consent: SegmentSet,
}

fn number(names: &[String], name: &str) -> u8 {
    let place = names.iter().position(|own| own == name).unwrap_or_else(|| panic!("no {name}"));
    u8::try_from(place).expect("a small number")
}

impl Session {
    /// The passing loop with these lines added to its file; unblocked, all points normal, and quiet until it may be used.
    pub fn new(lines: &str) -> Self {
        let mut session = Self::started(lines);
        session.wait(usize::from(session.layout.plan().start.0), &[]);
        session
    }

    /// The same, just started.
    pub fn started(lines: &str) -> Self {
        Self::of(&format!("{LOOP}\n{lines}\n"))
    }

    /// The same without these routes.
    pub fn without(routes: &[&str], lines: &str) -> Self {
        let kept = LOOP
            .split("[[route]]")
            .filter(|part| !routes.iter().any(|name| part.contains(&format!("name = \"{name}\""))));
        let mut session = Self::of(&format!("{}\n{lines}\n", kept.collect::<Vec<_>>().join("[[route]]")));
        session.wait(usize::from(session.layout.plan().start.0), &[]);
        session
    }

    /// A device of the terminus, unblocked, and quiet until it may be used.
    pub fn terminus() -> Self {
        let mut session = Self::of(TERMINUS);
        session.wait(usize::from(session.layout.plan().start.0), &[]);
        session
    }

    /// These points lie so from now on, and no others are detected.
    pub fn lie(&mut self, points: &[(&str, Position)]) {
        let of = |(name, position): &(&str, Position)| {
            Positions::of(PointId::new(number(&self.names.points, name)).expect("a point"), *position)
        };
        self.detected = points.iter().map(of).fold(Positions::NONE, Positions::or);
    }

    /// All points lie in reverse from now on.
    pub fn reverse(&mut self) {
        let points = |point: u8| Positions::of(PointId::new(point).expect("a point"), Position::Reverse);
        self.detected = points(0).or(points(1));
    }

    /// The same where the neighbour in the west sees these circuits too.
    pub fn sharing(circuits: &[&str]) -> Self {
        let shared = format!("name = \"West\"\nshared = {circuits:?}\n");
        let mut session = Self::of(&LOOP.replace("name = \"West\"\n", &shared));
        session.wait(usize::from(session.layout.plan().start.0), &[]);
        session
    }

    fn of(text: &str) -> Self {
        let description = Description::from_toml("loop", text).expect("a layout");
        let compiled = description.compile().expect("a layout without problems");
        let layout = compiled.layout();
        let points = |point: u8| Positions::of(PointId::new(point).expect("a point"), Position::Normal);
        let mut session = Self {
            names: compiled.names.clone(),
            state: Box::new(layout.initial()),
            said: Box::new(<Station as Machine>::SAFE),
            layout,
            detected: points(0).or(points(1)),
            consent: SegmentSet::EMPTY,
        };
        let orders = Orders { unblock: CircuitSet::ALL, lift: CircuitSet::ALL, ..Orders::default() };
        session.step(&[], None, orders);
        session
    }

    /// In cycles: the turn time, the residual running, and the longest loss of shunt.
    pub fn line_times(&self) -> (Ticks, Ticks, u8) {
        let plan = self.layout.plan();
        (plan.turn, plan.residual, plan.loss)
    }

    /// So many quiet cycles with these circuits occupied.
    pub fn wait(&mut self, cycles: usize, occupied: &[&str]) {
        for _ in 0..cycles {
            self.step(occupied, None, Orders::default());
        }
    }

    /// One cycle in which these circuits are to be blocked.
    pub fn block(&mut self, blocked: &[&str], occupied: &[&str]) {
        let orders = Orders { block: self.circuits(blocked), ..Orders::default() };
        self.step(occupied, None, orders);
    }

    /// One cycle in which these circuits are restricted to the code.
    pub fn restrict(&mut self, restricted: &[&str], code: SpeedCode, occupied: &[&str]) {
        let orders = Orders { restrict: self.circuits(restricted), speed: code, ..Orders::default() };
        self.step(occupied, None, orders);
    }

    /// Whether staff may rely on a block of the circuit.
    pub fn is_confirmed(&self, circuit: &str) -> bool {
        self.said.confirmed.meets(self.circuits(&[circuit]))
    }

    /// One cycle with a request; whether it was accepted.
    pub fn ask(&mut self, request: Request, occupied: &[&str]) -> Result<(), Refusal> {
        self.step(occupied, Some(request), Orders::default());
        self.said.answer.expect("an answer")
    }

    fn step(&mut self, occupied: &[&str], request: Option<Request>, orders: Orders) {
        let occupied = self.circuits(occupied);
        let input = Input { occupied, detected: self.detected, request, orders, consent: self.consent };
        let (state, said) = self.layout.cycle(*self.state, input);
        (*self.state, *self.said) = (state, said);
    }

    pub fn circuits(&self, names: &[&str]) -> CircuitSet {
        names
            .iter()
            .fold(CircuitSet::EMPTY, |all, name| all.or(CircuitSet::nth(number(&self.names.circuits, name).into())))
    }

    fn route(&self, name: &str) -> RouteId {
        RouteId::new(number(&self.names.routes, name)).expect("a route")
    }

    pub fn set(&self, route: &str) -> Request {
        Request::Set(self.route(route))
    }

    pub fn withdraw(&self, route: &str) -> Request {
        Request::Withdraw(self.route(route))
    }

    pub fn drive(&self, point: &str, position: Position) -> Request {
        Request::Drive(PointId::new(number(&self.names.points, point)).expect("a point"), position)
    }

    pub fn turn(&self, segment: &str, travel: Travel) -> Request {
        Request::Turn(SegmentId::new(number(&self.names.segments, segment)).expect("a segment"), travel)
    }

    pub fn phase(&self, route: &str) -> Phase {
        self.state.routes[usize::from(number(&self.names.routes, route))].phase
    }

    pub fn proceed(&self, route: &str) -> bool {
        self.said.proceed.has(self.route(route))
    }

    pub fn drives(&self) -> Positions {
        self.said.drives
    }

    /// The telegram of a circuit, of which the neighbour's device sees nothing.
    pub fn telegram(&self, circuit: &str) -> Movement {
        self.sent(circuit).expect("this device speaks")
    }

    /// The telegram of a circuit, if this device sends one there.
    pub fn sent(&self, circuit: &str) -> Option<Movement> {
        let all = self.layout.telegrams(&self.said.table, self.state.epoch);
        all[usize::from(number(&self.names.circuits, circuit))]
    }

    /// Whether a route holds the circuit.
    pub fn holds(&self, circuit: &str) -> bool {
        let it = self.circuits(&[circuit]);
        let routes = self.layout.plan().routes.iter().zip(&self.state.routes);
        routes.into_iter().any(|(route, state)| state.circuits(route).meets(it))
    }
}
