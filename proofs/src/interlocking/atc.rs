//! ATC (T-ATC-1, T-ATC-2, T-ATC-4): from what is granted to one telegram.
//!
//! What a route grants is proven elsewhere (T-ATC-1) and supposed here (`held-routes-compatible`): circuits of its path that follow each other and
//! are free and unblocked, to one circuit that is not among them; and no circuit is granted by two routes.

use super::any::{any_circuits, bit};
use super::line::{BOUND, Line, PATH, ROUTES, SEGMENTS, UNDER_KANI, any_line, in_direction, is_joint, passed};
use crate::engine::{any_byte, any_flag};
use atc_kernel::distance::Metres;
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Contents, Grant, Layout, MAX_CIRCUITS, MAX_CODES, Movement, PerCircuit, Route, SegmentSet,
    Small, SpeedCode, SpeedLimits, Standing, begins, connect, movement, telegram,
};

/// What a route may grant, by places of its path.
fn any_grant<E: crate::Engine + ?Sized>(e: &mut E, route: &Route<PATH>) -> Grant {
    let train = CircuitSet::from_bits(bit(e.word("granted to the train in (number)", 0..=8)));
    let (first, last) = (any_byte(e, "first place granted", 0..=1), any_byte(e, "last place granted", 0..=2));
    let complete = any_flag(e, "to the end of the route (odd: yes)") && last.wrapping_add(1) == route.length;
    let speed = SpeedCode(any_byte(e, "speed code of the route", 0..=7));
    let mut grant = Grant { train, complete, heading: route.heading, speed, ..Grant::NONE };
    let mut end = CircuitSet::EMPTY;
    for (place, element) in (0_u8..).zip(&route.path) {
        let circuit = element.circuits;
        if place >= first && place <= last && last < route.length {
            grant.circuits = grant.circuits.or(circuit);
            grant.last = circuit;
        }
        end = if place < route.length { circuit } else { end };
    }
    let apart = grant.circuits.bits() & train.bits() == 0;
    e.suppose("held-routes-compatible", apart);
    if grant.circuits.bits() != 0 {
        grant
    } else if complete && !route.to.is_empty() && !end.is_empty() {
        // The train is on the last circuit of a route out.
        Grant { train: end, last: end, ..grant }
    } else {
        Grant::NONE
    }
}

/// Any contents that the interlocking may write for the ATC, by what is proven of grants.
pub(super) fn any_contents<E: crate::Engine + ?Sized>(e: &mut E, line: &Line) -> Contents<ROUTES> {
    let grants = [any_grant(e, &line.plan().routes[0]), any_grant(e, &line.plan().routes[1])];
    e.suppose("held-routes-compatible", !grants[0].circuits.meets(grants[1].circuits));
    let granted = grants[0].circuits.or(grants[1].circuits);
    let toward = any_byte(e, "toward (segments)", 0..=3) & 3;
    let away = any_byte(e, "away (segments)", 0..=3) & 3 & !toward;
    Contents {
        occupied: any_circuits(e, "occupied (bits)", 0..=u16::MAX).without(granted),
        blocked: any_circuits(e, "blocked (bits)", 0..=0).without(granted),
        grants,
        toward: SegmentSet::from_bits(toward),
        away: SegmentSet::from_bits(away),
        standing: STANDING,
    }
}

/// No train stands anywhere but at its front, and nothing is limited: what is granted does not depend on it.
const STANDING: Standing<ROUTES> =
    Standing { bodies: [CircuitSet::EMPTY; ROUTES], loose: CircuitSet::EMPTY, limits: SpeedLimits::NONE };

/// The limit of one circuit, and of all others.
fn limits(number: u16, its: u8, others: u8) -> SpeedLimits {
    let it = CircuitSet::from_bits(bit(number));
    let all = SpeedLimits::NONE.and_at_most(SpeedCode(its), it);
    all.and_at_most(SpeedCode(others), CircuitSet::ALL.without(it))
}

/// The telegram that is sent in a circuit.
pub(super) fn sent(line: &Line, contents: &Contents<ROUTES>, circuit: CircuitId) -> Movement {
    telegram(line, Some(contents), begins(line, contents), circuit)
}

/// Whether the first route grants anything to the train in this circuit.
fn grants_to(contents: &Contents<ROUTES>, here: u64) -> bool {
    contents.grants[0].circuits.bits() != 0 && contents.grants[0].train.bits() == here
}

harness! {
    /// Where two grants begin at a circuit, none is used; where one does, it is that one. On plain line a train is granted the free and unblocked circuits that
    /// follow its own in the direction of the segment, up to the next that is not, and no other.
    t_atc_1_connect(e)
    theorem "T-ATC-1";
    requirements ["ATC-2", "ATC-3"];
    assumptions ["held-routes-compatible"];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Two: "where more than one grant begins, of routes or of segments, none is used",
        One: "where one route's grant begins, and no segment's, it is used, and leads to the segments of the route if it reaches its end",
        Line: "where one segment's begins, and no route's, it is the circuits that follow without a gap, free and unblocked, as far as there are such",
        Last: "the last circuit is the farthest of them, and it says it is complete only if no circuit of the segment follows",
        None: "where none begins nothing is granted",
    }
    covers {
        Routes: "two routes grant to the same circuit",
        Mixed: "a route and a segment grant to the same circuit",
        Away: "two circuits are granted from the throat",
        Toward: "a circuit is granted towards the station",
        Stops: "a train ahead ends what is granted",
    }
    {
        let Some(line) = any_line(e) else { return };
        let contents = any_contents(e, &line);
        let here = CircuitSet::from_bits(bit(e.word("the train's circuit (number)", 0..=15)));
        let to = SegmentSet::from_bits(any_byte(e, "segments to which the route leads that ends there", 0..=3) & 3);
        let (link, leads) = connect(&line, &contents, (here, to));
        let closed = contents.occupied.bits() | contents.blocked.bits();
        let (mut of_routes, mut of_segments) = (0_u32, 0_u32);
        let mut expected = (Grant::NONE, 0);
        for (route, grant) in line.plan().routes.iter().zip(contents.grants) {
            if to.bits() == 0 && grant.train.bits() == here.bits() && grant.train.bits() != 0 {
                of_routes += 1;
                expected = (grant, if grant.complete { route.to.bits() } else { 0 });
            }
        }
        let mut rightly = false;
        let mut ends = false;
        let mut steps = 0;
        for number in 0..SEGMENTS {
            let Some(passed) = passed(&line, &contents, number, here, to) else { continue };
            let (mut circuits, mut last, mut open) = (0, 0, true);
            for step in 0..PATH {
                let next = in_direction(&line, &contents, number, step);
                if step >= passed && next != 0 {
                    open &= next & closed == 0;
                    circuits |= if open { next } else { 0 };
                    last = if open { next } else { last };
                    steps += usize::from(open);
                }
            }
            if circuits != 0 {
                of_segments += 1;
                rightly = link.circuits.bits() == circuits && link.train.bits() == here.bits();
                ends = link.last.bits() == last && (!link.complete || open);
                e.cover(Cover::Stops as u32, !open);
            }
        }
        let found = of_routes + of_segments;
        e.claim(Claim::Two as u32, found < 2 || link == Grant::NONE);
        e.claim(Claim::One as u32, found != 1 || of_routes == 0 || link == expected.0 && leads.bits() == expected.1);
        e.claim(Claim::Line as u32, found != 1 || of_segments == 0 || rightly);
        e.claim(Claim::Last as u32, found != 1 || of_segments == 0 || ends);
        e.claim(Claim::None as u32, found != 0 || link == Grant::NONE && leads.bits() == 0);
        e.cover(Cover::Routes as u32, of_routes == 2);
        e.cover(Cover::Mixed as u32, of_routes == 1 && of_segments == 1);
        e.cover(Cover::Away as u32, found == 1 && of_segments == 1 && steps == 2 && contents.away.bits() != 0 && contents.toward.bits() == 0);
        e.cover(Cover::Toward as u32, found == 1 && of_segments == 1 && contents.away.bits() == 0);
    }
}

harness! {
    /// Trains in two different circuits are never told that they may enter the same circuit, nor one that is occupied or blocked.
    t_atc_1_apart(e)
    theorem "T-ATC-1";
    requirements ["ATC-2", "ATC-3"];
    assumptions ["held-routes-compatible"];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Apart: "no circuit is granted to trains in two different circuits",
        Free: "no circuit that is granted is occupied or blocked",
    }
    covers {
        Both: "both trains may run",
        Line: "both trains may run in one segment",
        Chain: "a train is granted circuits of a route and of a segment",
    }
    {
        let Some(line) = any_line(e) else { return };
        let contents = any_contents(e, &line);
        let numbers = (e.word("a train's circuit (number)", 0..=4) & 31, e.word("another train's circuit (number)", 12..=15) & 31);
        let Some(one) = CircuitId::new(numbers.0.to_le_bytes()[0]) else { return };
        let Some(other) = CircuitId::new(numbers.1.to_le_bytes()[0]) else { return };
        e.assume(numbers.0 != numbers.1);
        let (first, second) = (sent(&line, &contents, one), sent(&line, &contents, other));
        e.claim(Claim::Apart as u32, first.hold.bits() & second.hold.bits() == 0);
        let closed = contents.occupied.bits() | contents.blocked.bits();
        e.claim(Claim::Free as u32, first.hold.bits() & closed == 0);
        e.cover(Cover::Both as u32, first.is_open() && second.is_open());
        let segment = line.plan().segments[0];
        let mut all = 0;
        for place in 0..PATH {
            all |= if place < usize::from(segment.length) { segment.circuits[place].bits() } else { 0 };
        }
        e.cover(Cover::Line as u32, first.hold.bits() & all != 0 && second.hold.bits() & all != 0);
        e.cover(Cover::Chain as u32, first.hold.bits() & all != 0 && first.hold.bits() & contents.grants[0].circuits.bits() != 0);
    }
}

harness! {
    /// The speed code is not above that of a route that is granted, nor the limit of the own circuit or a granted one, nor above one from which a
    /// train stops within what is granted.
    t_atc_2(e)
    theorem "T-ATC-2";
    requirements ["ATC-4"];
    assumptions ["held-routes-compatible"];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Route: "the speed code is not above that of a route with a granted circuit",
        Limit: "the speed code is not above the limit of the own circuit or of a granted one",
        Distance: "the braking distance of the speed code is not longer than the granted circuits together",
        Table: "a code without a braking distance is never sent",
    }
    covers {
        ByRoute: "the route limits the code",
        ByLimit: "the limit of a circuit limits the code",
        ByDistance: "the distance limits the code",
        Most: "the highest code is sent",
    }
    {
        let Some(line) = any_line(e) else { return };
        let mut contents = any_contents(e, &line);
        let number = e.word("a circuit that stands for all (number)", 0..=15) & 31;
        let own = e.word("the train's circuit (number)", 0..=8) & 31;
        let Some(circuit) = CircuitId::new(own.to_le_bytes()[0]) else { return };
        let (its, others) = (any_byte(e, "its limit (code)", 6..=7), any_byte(e, "limit elsewhere (code)", 7..=7));
        contents.standing.limits = limits(number, its, others);
        let long = e.word("length of circuits with an even number (m)", 0..=400);
        let short = e.word("length of circuits with an odd number (m)", 0..=400);
        let mut plan = *line.plan();
        plan.lengths = PerCircuit::from_fn(|place| Metres(if place % 2 == 0 { long } else { short }));
        let mut distance = 0;
        let mut braking = [Metres(0); MAX_CODES];
        for braking in &mut braking[1..] {
            distance += 50;
            *braking = Metres(e.word("braking distance of a code (m)", distance..=distance + 20));
        }
        plan.braking = braking;
        let Ok(line) = Layout::with_what_proofs_need(plan) else { return e.assume(false) };
        let telegram = sent(&line, &contents, circuit);
        let speed = telegram.speed.0;
        let hold = telegram.hold.bits();
        if !telegram.is_open() {
            // Nothing is granted, and the train stands (ATC-7).
            return e.claim(Claim::Table as u32, speed == 0);
        }
        let mut by_route = true;
        let mut limit = 7;
        for grant in contents.grants {
            let granted = grant.circuits.bits() & hold != 0;
            by_route &= !granted || speed <= grant.speed.0;
            limit = if granted && grant.speed.0 < limit { grant.speed.0 } else { limit };
        }
        e.claim(Claim::Route as u32, by_route);
        let restricted = hold >> number & 1 == 1 || own == number && telegram.is_open();
        e.claim(Claim::Limit as u32, !restricted || speed <= its);
        let (mut sum, mut needed) = (0_u32, 0_u32);
        for place in 0..MAX_CIRCUITS {
            let length = if place % 2 == 0 { long } else { short };
            if hold & 1 << place != 0 {
                sum = sum.saturating_add(u32::from(length));
            }
        }
        for (code, braking) in (0_u8..).zip(&braking) {
            needed = if code == speed { u32::from(braking.0) } else { needed };
        }
        e.claim(Claim::Distance as u32, needed <= sum);
        e.claim(Claim::Table as u32, usize::from(speed) < MAX_CODES && needed < u32::from(u16::MAX));
        e.cover(Cover::ByRoute as u32, telegram.is_open() && speed == limit && speed > 0 && its == 7);
        e.cover(Cover::ByLimit as u32, telegram.is_open() && restricted && speed == its && speed < limit && speed > 0);
        e.cover(Cover::ByDistance as u32, telegram.is_open() && speed < limit && its == 7 && others == 7);
        e.cover(Cover::Most as u32, speed == 7);
    }
}

harness! {
    /// The speed code is not above the limit of any circuit on which the train may stand: its front's, and with each of its circuits every other
    /// occupied one that is joined to it. By induction from joint to joint these are all circuits of a train of any length.
    t_atc_2_train(e)
    theorem "T-ATC-2";
    requirements ["ATC-4", "ATC-8"];
    assumptions ["held-routes-compatible", "path-complete"];
    built_in &[("path-complete", "a train stands only in circuits that are joined: it comes into a path from its entry")];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Front: "the circuit of the front is one of the train's",
        Joined: "an occupied circuit that is joined to one of the train's is one of the train's",
        Limit: "the speed code is not above the limit of any circuit of the train's",
    }
    covers {
        Far: "the limit of a circuit that is not joined to that of the front limits the code",
        Line: "a train stands on a route and on plain line",
        Free: "an occupied circuit is not one of the train's",
    }
    {
        let Some(line) = any_line(e) else { return };
        let mut contents = any_contents(e, &line);
        let occupied = contents.occupied;
        let mut any = |what| any_circuits(e, what, 0..=0).and(occupied);
        contents.standing.bodies = [any("on the first route (bits)"), any("on the second route (bits)")];
        contents.standing.loose = any("in circuits that no route holds (bits)");
        let own = e.word("the train's circuit (number)", 0..=8) & 31;
        let (near, far) = (e.word("a circuit of the train (number)", 0..=15) & 31, e.word("one joined to it (number)", 0..=15) & 31);
        let Some(front) = CircuitId::new(own.to_le_bytes()[0]) else { return };
        let its = any_byte(e, "its limit (code)", 3..=4);
        contents.standing.limits = limits(far, its, 7);
        let mut plan = *line.plan();
        // One circuit is enough to stop from every code.
        plan.lengths = PerCircuit::all(Metres(8));
        plan.braking = [0, 1, 2, 3, 4, 5, 6, 7].map(Metres);
        let Ok(line) = Layout::with_what_proofs_need(plan) else { return e.assume(false) };
        let train = contents.standing.train(&line, occupied, front.alone());
        let telegram = sent(&line, &contents, front);
        e.claim(Claim::Front as u32, train.bits() >> own & 1 == 1);
        let joint = occupied.bits() & bit(far) != 0 && is_joint(&line, &contents.standing, bit(near), bit(far));
        let (has_near, has_far) = (train.bits() & bit(near) != 0, train.bits() & bit(far) != 0);
        e.claim(Claim::Joined as u32, !joint || !has_near || has_far);
        e.claim(Claim::Limit as u32, !telegram.is_open() || !has_far || telegram.speed.0 <= its);
        let apart = near != own && far != own && !is_joint(&line, &contents.standing, bit(own), bit(far));
        e.cover(Cover::Far as u32, telegram.is_open() && apart && joint && has_near && telegram.speed.0 == its);
        let path = line.plan().routes[0].path[0].circuits.bits();
        let outer = line.plan().segments[0].circuits[0].bits();
        e.cover(Cover::Line as u32, train.bits() & path != 0 && train.bits() & outer != 0 && telegram.is_open() && contents.standing.loose.bits() == 0);
        e.cover(Cover::Free as u32, telegram.is_open() && occupied.bits() & !train.bits() != 0);
    }
}

harness! {
    /// A circuit without a train has a stop telegram, and so has one whose train is granted nothing. Any other names the last circuit that is granted.
    t_atc_4(e)
    theorem "T-ATC-4";
    requirements ["ATC-7"];
    assumptions ["held-routes-compatible"];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Train: "a circuit that counts as clear has a stop telegram",
        Nothing: "a telegram that grants no circuit is a stop telegram: its own circuit, not open, no speed",
        Last: "the stop circuit is granted, and the last of its route's grant, or of what its segment grants",
        Ends: "what is granted of a route that is not granted to its end ends there",
    }
    covers {
        Clear: "something is granted at a circuit without a train",
        Route: "the stop circuit is on a route",
        Line: "the stop circuit is on plain line, beyond a route",
    }
    {
        let Some(line) = any_line(e) else { return };
        let contents = any_contents(e, &line);
        let own = e.word("the train's circuit (number)", 0..=8) & 31;
        let Some(circuit) = CircuitId::new(own.to_le_bytes()[0]) else { return };
        let telegram = sent(&line, &contents, circuit);
        let Movement { stop, heading, speed, hold } = telegram;
        let open = heading.is_some();
        let is_stop = !open && speed.0 == 0 && u16::from(stop.number()) == own && hold.bits() == 0;
        let train = contents.occupied.bits() >> own & 1 == 1;
        e.claim(Claim::Train as u32, train || is_stop);
        e.claim(Claim::Nothing as u32, hold.bits() != 0 || is_stop);
        let stop = 1_u64 << stop.number();
        let mut last = hold.bits() & stop != 0;
        let mut on_route = false;
        for grant in contents.grants {
            on_route |= grant.circuits.bits() & stop != 0;
            last &= grant.circuits.bits() & stop == 0 || grant.last.bits() == stop;
        }
        let mut on_line = false;
        for number in 0..SEGMENTS {
            for step in 0..PATH {
                if in_direction(&line, &contents, number, step) == stop {
                    on_line = true;
                    last &= in_direction(&line, &contents, number, step + 1) & hold.bits() == 0;
                }
            }
        }
        e.claim(Claim::Last as u32, hold.bits() == 0 || open && last && (on_route || on_line));
        let mut ends = true;
        for grant in contents.grants {
            ends &= grant.circuits.bits() & hold.bits() == 0 || grant.complete || grant.last.bits() == stop;
        }
        e.claim(Claim::Ends as u32, ends);
        let granted = grants_to(&contents, 1 << own);
        e.cover(Cover::Clear as u32, !train && granted);
        e.cover(Cover::Route as u32, open && on_route);
        e.cover(Cover::Line as u32, open && on_line && hold.bits() & contents.grants[0].circuits.bits() != 0);
    }
}

harness! {
    /// Where no grant begins, and so nothing is looked for, nothing would have been found; and the circuit of a number is that of the number. Here a grant
    /// may be to trains in any circuits, in several at once included.
    t_atc_4_each(e)
    theorem "T-ATC-4";
    requirements ["ATC-7"];
    assumptions ["held-routes-compatible"];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Own: "the circuit with a number is the one of that number",
        Nothing: "where no grant begins, a train is granted nothing",
    }
    covers {
        Train: "a train is nowhere near a grant",
        Grant: "something is granted to a circuit without a train",
    }
    {
        let Some(line) = any_line(e) else { return };
        let mut contents = any_contents(e, &line);
        for grant in &mut contents.grants {
            let train = any_circuits(e, "granted to the trains in (bits)", 1..=2);
            *grant = Grant { train, ..*grant };
        }
        let number = e.word("the circuit (number)", 0..=15) & 63;
        let circuit = CircuitSet::<Small>::nth(usize::from(number)).first().unwrap_or(CircuitId::ZERO);
        e.claim(Claim::Own as u32, u16::from(circuit.number()) == number);
        let none = begins(&line, &contents).bits() >> number & 1 == 0;
        let found = movement(&line, &contents, circuit);
        e.claim(Claim::Nothing as u32, !none || found == Movement::stop_in(circuit));
        let train = contents.occupied.bits() >> number & 1 == 1;
        let granted = grants_to(&contents, 1 << number);
        e.cover(Cover::Train as u32, none && train);
        e.cover(Cover::Grant as u32, none && granted);
    }
}
