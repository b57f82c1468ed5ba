//! How trains move: from circuit to circuit, as far as signals or telegrams let them.

use super::environment::{Environment, Obey};
use super::ground::{Ahead, Blade, Ground, Heading};
use super::sizes::{POINTS, SIGNALS};

/// Where a train is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Place {
    /// Not there yet.
    Coming,
    /// Its front and its rear are in these circuits, which are the same or adjoin.
    Here {
        /// The circuit of the front.
        front: u8,
        /// The circuit of the rear.
        rear: u8,
    },
    /// It has arrived where it ends.
    Gone,
}

/// A train, and what it knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Train {
    /// Where it is.
    pub place: Place,
    /// Which way it goes.
    pub heading: Heading,
    /// Cycles since the signal ahead showed proceed to it while it counted on it; one more than the residual running if it never did.
    pub since_proceed: u8,
    /// Cycles since its front came into its circuit, as far as it may still slide.
    pub arrived: u8,
    /// How many circuits it may still slide, once it has slid past a signal.
    pub sliding: Option<u8>,
    /// The circuits that telegrams let it enter.
    pub granted: u8,
    /// Cycles since telegrams let it enter fewer.
    pub since_fewer: u8,
    /// For how many cycles in a row the circuits of its front and its rear have not been reported.
    pub unheard: [u8; 2],
    /// Whether the aspect that it saw last is that of a calling-on route: it runs on sight.
    pub called: bool,
}

/// What became of a train by its move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// Nothing bad.
    Sound,
    /// It ran over a point that did not lead there, or off the end of the track.
    Derailed,
    /// It passed a signal that had not shown proceed to it.
    Overrun,
}

impl Train {
    /// A train that is not there yet.
    pub const fn coming(heading: Heading, residual: u8) -> Self {
        Self {
            place: Place::Coming,
            heading,
            since_proceed: residual + 1,
            arrived: 0,
            sliding: None,
            granted: 0,
            since_fewer: 0,
            unheard: [0; 2],
            called: false,
        }
    }

    /// A train that has arrived: nothing of it matters any more.
    const GONE: Self = Self { place: Place::Gone, ..Self::coming(Heading::Up, 0) };

    /// The circuits that it is in: a mask.
    pub const fn occupies(&self) -> u8 {
        match self.place {
            Place::Here { front, rear } => 1 << front | 1 << rear,
            Place::Coming | Place::Gone => 0,
        }
    }

    /// The circuit of its front.
    pub const fn front(&self) -> Option<u8> {
        match self.place {
            Place::Here { front, .. } => Some(front),
            Place::Coming | Place::Gone => None,
        }
    }

    /// Whether this train, which runs on sight, does not run into another one in a circuit of its own: that stands there, or goes away from it.
    pub fn sees(&self, other: &Self, environment: &Environment) -> bool {
        let Place::Here { front, rear } = other.place else { return true };
        let comes = environment.draws_up && other.heading != self.heading && !other.called;
        let stands = front == rear && other.arrived >= environment.slides_for && !comes;
        let goes_on = front != rear && self.occupies() >> front & 1 == 0 && other.heading == self.heading;
        self.called && (stands || goes_on)
    }

    /// Whether the signal at the end of its circuit is for the other train there: the one that was called came second.
    pub fn is_behind(&self, other: &Self) -> bool {
        let together = self.occupies() & other.occupies() != 0;
        together && (self.called || other.called && other.heading != self.heading)
    }

    /// Every way in which it may move in one cycle, standing still included.
    ///
    /// `fallen`: for each signal the cycles since it showed proceed, as far as anybody asks.
    pub(super) fn moves(
        &self,
        ground: &Ground,
        environment: &Environment,
        blades: [Blade; POINTS],
        fallen: [u8; SIGNALS],
    ) -> Vec<(Self, Fate)> {
        let Place::Here { front, rear } = self.place else { return vec![(*self, Fate::Sound)] };
        let waited = Self { arrived: (self.arrived + 1).min(environment.slides_for), ..*self };
        let mut ways = vec![(waited, Fate::Sound)];
        if front != rear {
            let unheard = [self.unheard[0]; 2];
            ways.push((Self { place: Place::Here { front, rear: front }, unheard, ..waited }, Fate::Sound));
        } else if ground.ends.contains(&(front, self.heading)) {
            ways.push((Self::GONE, Fate::Sound));
        } else if ground.turning >> front & 1 == 1 && ground.ahead(front, self.heading, blades) == Ahead::Nothing {
            let turned = Self { heading: self.heading.turned(), since_proceed: environment.residual + 1, ..waited };
            ways.push((turned, Fate::Sound));
        }
        ways.extend(self.advance(front, ground, environment, blades, fallen));
        ways
    }

    /// Its front goes on into the next circuit, and its rear into the one that the front was in.
    fn advance(
        &self,
        front: u8,
        ground: &Ground,
        environment: &Environment,
        blades: [Blade; POINTS],
        fallen: [u8; SIGNALS],
    ) -> Option<(Self, Fate)> {
        let (to, mut fate) = match ground.ahead(front, self.heading, blades) {
            Ahead::Nothing => return None,
            Ahead::Circuit(to) => (to, Fate::Sound),
            // What slides into the sand over a point that moves is caught there; a trailing point it breaks open.
            Ahead::Between(_) if self.is_caught(front, ground) => return None,
            Ahead::Trailing(to) if self.is_caught(front, ground) => (to, Fate::Sound),
            Ahead::Between(to) | Ahead::Trailing(to) => (to, Fate::Derailed),
        };
        let (may, sliding) = self.may_go_on(front, to, ground, environment);
        if !may {
            return None;
        }
        let at_stop = |signal: usize| fallen[signal] > environment.residual;
        let passes = ground.number_of_signal(front, self.heading).is_some_and(at_stop);
        if passes && sliding.is_none() && fate == Fate::Sound && environment.obey == Obey::Telegrams {
            fate = Fate::Overrun;
        }
        let moved = Self {
            place: Place::Here { front: to, rear: front },
            since_proceed: environment.residual + 1,
            arrived: 0,
            sliding,
            granted: self.granted & !(1 << to),
            unheard: [0, self.unheard[0]],
            ..*self
        };
        Some((moved, fate))
    }

    /// Whether it slides where trains that slide are caught.
    pub(super) const fn is_caught(&self, front: u8, ground: &Ground) -> bool {
        self.sliding.is_some() && ground.catching >> front & 1 == 1
    }

    /// Whether the front may pass from `front` into `to`, and how far it slides if it should not.
    fn may_go_on(&self, front: u8, to: u8, ground: &Ground, environment: &Environment) -> (bool, Option<u8>) {
        if let Some(left) = self.sliding {
            return (left > 0, left.checked_sub(1));
        }
        let granted = self.granted >> to & 1 == 1;
        let signal = ground.signal(front, self.heading);
        let may = match environment.obey {
            Obey::Nothing => true,
            Obey::Telegrams => granted,
            Obey::Signals if ground.line >> to & 1 == 1 => granted,
            Obey::Signals => {
                let waits = signal.is_some() || ground.waits >> front & 1 == 1;
                !waits || self.since_proceed <= environment.residual
            }
        };
        if may {
            return (true, None);
        }
        match signal {
            // Who runs on sight does not slide.
            Some(signal) if signal.slide > 0 && !self.called && self.arrived < environment.slides_for => {
                (true, Some(signal.slide - 1))
            }
            _ => (false, None),
        }
    }

    /// What it learns at the end of a cycle: whether the signal that it counts on shows proceed, the aspect of a route to `call` on among them, and
    /// what its telegram grants.
    #[must_use]
    pub(super) fn informed(
        mut self,
        ground: &Ground,
        environment: &Environment,
        (proceed, call): (u8, u8),
        granted: u8,
    ) -> Self {
        let Place::Here { front, .. } = self.place else { return self };
        let counts = ground.signals.iter().find(|s| s.heading == self.heading && s.counted_on >> front & 1 == 1);
        let shows = counts.is_some_and(|signal| signal.routes & proceed != 0);
        if let Some(signal) = counts.filter(|_| shows) {
            self.called = signal.routes & proceed & call != 0;
        }
        let bound = environment.residual + 1;
        self.since_proceed = if shows { 0 } else { (self.since_proceed + 1).min(bound) };
        let read = match environment.obey {
            Obey::Signals => granted & ground.line,
            Obey::Telegrams => granted,
            Obey::Nothing => 0,
        };
        let fewer = self.granted & !read != 0;
        if fewer && self.since_fewer < environment.residual {
            self.since_fewer += 1;
            self.granted |= read;
        } else {
            self.since_fewer = 0;
            self.granted = read;
        }
        self
    }
}
