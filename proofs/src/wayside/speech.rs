//! From movements to frames and codes (T-WAY-3, T-WAY-4), what is sent where, and the safe output (T-WAY-8).

use super::plans::{LONGEST, plan};
use super::said::{CIRCUITS, any_lengths, any_movement, any_said, heard};
use crate::engine::{any_byte, any_flag};
use crate::interlocking::any_heading;
use atc_kernel::Machine;
use atc_kernel::interlocking::{
    CircuitId, CircuitSet, Contents, Grant, Heading, Layout, Movement, SegmentSet, SpeedCode, SpeedLimits, Standing,
    begins, telegram,
};
use atc_kernel::telegram::{Counter, Route};
use atc_kernel::wayside::{Counters, Wayside};

const BOUND: &str = "4 circuits, 3 speed codes";
const BOUND_SAFE: &str = "2 blocks, 2 routes, 2 segments";
harness! {
    /// What trains are told by a main telegram never permits more than the movement: it is open only under the number of the movement's direction of travel, no
    /// farther than the granted circuits are long together, and rank and codes are those of the movement's code, or of the
    /// highest known one below it.
    t_way_3(e)
    theorem "T-WAY-3";
    requirements ["WAY-3", "WAY-4", "WAY-5"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Read: "the main telegram has this number and the section number of the direction of travel, which trains of the other do not have",
        Open: "it is open only for the movement's direction of travel, and then the distance is that of the granted circuits, or the longest there is",
        Rank: "its rank is that of the movement's code, or of the highest known code below it",
        Codes: "the codes are those of the same code",
        Stop: "for the other direction of travel it is closed, and rank and codes are those of code 0",
    }
    covers {
        Open: "an open telegram",
        Two: "two circuits are granted",
        Saturated: "the granted circuits are longer than a telegram can tell",
        Other: "trains of the other direction of travel hear of an open movement",
        Lower: "the movement's code is not known",
    }
    {
        let lengths = any_lengths(e);
        let Some(said) = any_said(e, &lengths) else { return };
        let movement = any_movement(e);
        let heading = any_heading(e, "heading of the train (odd: right)");
        let Some((told, counters, _)) = heard(e, &lengths, &said, movement, heading) else { return e.claim(Claim::Read as u32, false) };
        let main = told.main;
        let own = main.section == said.its(heading).section && main.section != said.its(heading.opposite()).section;
        e.claim(Claim::Read as u32, own && main.counter == counters.main);
        let mut together = 0_u32;
        for (number, length) in lengths.iter().enumerate().take(CIRCUITS) {
            let granted = movement.hold.bits() >> number & 1 == 1;
            together += if granted { u32::from(length.0) } else { 0 };
        }
        let most = if together < 0xFFFF { together } else { 0xFFFF };
        let meant = movement.heading == Some(heading);
        let distance = match main.route {
            Route::OpenFor(distance) => meant && u32::from(distance.0) == most,
            Route::Closed => !meant,
        };
        e.claim(Claim::Open as u32, distance);
        let word = said.word(movement.speed);
        e.claim(Claim::Rank as u32, !meant || main.speed == word.rank);
        e.claim(Claim::Codes as u32, !meant || told.codes == word.codes);
        e.claim(Claim::Stop as u32, meant || main.speed == said.stop.rank && told.codes == said.stop.codes);
        e.cover(Cover::Open as u32, meant && main.speed != said.stop.rank);
        e.cover(Cover::Two as u32, meant && movement.hold.bits() == 6);
        e.cover(Cover::Saturated as u32, meant && together > 0xFFFF);
        e.cover(Cover::Other as u32, movement.heading.is_some() && !meant);
        e.cover(Cover::Lower as u32, meant && movement.speed.0 == 2 && said.words[2].is_none());
    }
}

harness! {
    /// A ghost train on metres that stops before the end of what it is told, whatever it knows besides, has its front within its own circuit or in one that was
    /// granted: the circuits ahead of it are as long as the layout says, and those that are granted follow its own without a gap.
    t_way_3_train(e)
    theorem "T-WAY-3";
    requirements ["WAY-3"];
    assumptions ["path-complete", "trains-know-facing", "held-routes-compatible"];
    built_in &[
        ("path-complete", "the circuits ahead of the ghost are 1, 2 and 3, with the layout's lengths"),
        ("trains-know-facing", "the ghost uses the telegram of the direction of travel that it faces"),
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
        let lengths = any_lengths(e);
        let Some(said) = any_said(e, &lengths) else { return };
        let ahead = any_heading(e, "direction in which the circuits lie (odd: right)");
        let granted = e.word("circuits granted", 0..=3);
        e.assume(granted <= 3);
        let hold = CircuitSet::from_bits(match granted { 0 => 0, 1 => 2, 2 => 6, _ => 14 });
        let heading = if granted > 0 { Some(ahead) } else { None };
        let speed = SpeedCode(any_byte(e, "speed code", 0..=3));
        let movement = Movement { stop: CircuitId::ZERO, heading, speed, hold };
        let faces = any_heading(e, "heading of the train (odd: right)");
        let Some((told, _, _)) = heard(e, &lengths, &said, movement, faces) else { return e.claim(Claim::Within as u32, false) };
        // Metres of the ghost's front beyond the exit; 0: in its own circuit. It is before the stopping point, or at it.
        let front = u32::from(e.word("front beyond the exit (m)", 0..=900));
        let may = match told.main.route {
            Route::OpenFor(distance) => front <= u32::from(distance.0),
            Route::Closed => front == 0,
        };
        e.assume(may);
        let (mut begins, mut within) = (0_u32, front == 0);
        let mut circuit = 0;
        for (number, length) in lengths.iter().enumerate().take(CIRCUITS).skip(1) {
            let ends = begins + u32::from(length.0);
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
    /// What trains are told by a sub telegram is the fixed data of the circuit for their direction of travel, with the layout's length, and a restriction that is not
    /// of a higher code than the temporary restriction of the circuit.
    t_way_3_sub(e)
    theorem "T-WAY-3";
    requirements ["WAY-6"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Read: "the sub telegram has this number and the section number of the direction of travel",
        Fixed: "it has the layout's length, and gradient and curve of the direction of travel",
        Limit: "its restriction is the rank of the temporary restriction, or of the highest known code below it",
    }
    covers {
        Restricted: "the circuit is restricted to code 0",
        Free: "the circuit is not restricted",
    }
    {
        let lengths = any_lengths(e);
        let Some(said) = any_said(e, &lengths) else { return };
        let heading = any_heading(e, "heading of the train (odd: right)");
        let movement = Movement::stop_in(CircuitId::ZERO);
        let Some((told, counters, restrictions)) = heard(e, &lengths, &said, movement, heading) else { return e.claim(Claim::Read as u32, false) };
        let (sub, its) = (told.sub, said.its(heading));
        e.claim(Claim::Read as u32, sub.section == its.section && sub.counter == counters.sub);
        let fixed = sub.length.metres() == lengths[0] && sub.gradient == its.gradient && sub.curve == its.curve;
        e.claim(Claim::Fixed as u32, fixed);
        let mut limit = SpeedCode::MOST;
        for (code, circuits) in (0_u8..).zip(restrictions.parts()) {
            if circuits.bits() & 1 == 1 && code < limit.0 {
                limit = SpeedCode(code);
            }
        }
        e.claim(Claim::Limit as u32, sub.restriction == said.word(limit).rank);
        e.cover(Cover::Restricted as u32, limit.0 == 0 && sub.restriction == said.stop.rank);
        e.cover(Cover::Free as u32, limit == SpeedCode::MOST);
    }
}

harness! {
    /// Where the table cannot be read, the circuit is not occupied, or nothing is granted to the train there, trains of both directions of travel are told a closed
    /// telegram with the rank of code 0, and its codes. That a table of another cycle or a damaged one cannot be read is T-ATC-3.
    t_way_4(e)
    theorem "T-WAY-4";
    requirements ["WAY-5"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Closed: "the telegram is closed",
        Speed: "its rank and the codes are those of code 0",
    }
    covers {
        Stale: "the table cannot be read, and granted",
        Empty: "the table grants, and the circuit is not occupied",
        Nothing: "the circuit is occupied, and nothing is granted",
    }
    {
        let lengths = any_lengths(e);
        let Some(said) = any_said(e, &lengths) else { return };
        let Some(station) = Layout::with_what_proofs_need(plan::<1, 1, 1>()).ok() else { return e.claim(Claim::Closed as u32, false) };
        let here = CircuitSet::nth(0);
        let ahead = CircuitSet::nth(1);
        let (stale, occupied) = (any_flag(e, "the table cannot be read (odd: yes)"), any_flag(e, "the circuit is occupied (odd: yes)"));
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
        let read = if stale { None } else { Some(contents) };
        let begins = read.as_ref().map_or(CircuitSet::EMPTY, |contents| begins(&station, contents));
        let movement = telegram(&station, read.as_ref(), begins, CircuitId::ZERO);
        let faces = any_heading(e, "heading of the train (odd: right)");
        let Some((told, _, _)) = heard(e, &lengths, &said, movement, faces) else { return e.claim(Claim::Closed as u32, false) };
        e.claim(Claim::Closed as u32, told.main.route == Route::Closed);
        e.claim(Claim::Speed as u32, told.main.speed == said.stop.rank && told.codes == said.stop.codes);
        e.cover(Cover::Stale as u32, stale && occupied && grants);
        e.cover(Cover::Empty as u32, !stale && !occupied && grants);
        e.cover(Cover::Nothing as u32, !stale && occupied && !grants);
    }
}

harness! {
    /// A circuit in which the ATC is silent gets nothing, whatever is remembered of it; any other that is described gets frames and codes for both directions of travel.
    t_way_8_sent(e)
    theorem "T-WAY-8";
    requirements ["WAY-21"];
    assumptions [];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Silent: "where the ATC is silent nothing is sent",
        Sent: "where it is not, something is sent if and only if the circuit is described",
        Codes: "the codes that are sent are those of what is said to each direction of travel",
    }
    covers {
        Silent: "the ATC is silent in a circuit that is described",
        Sent: "the ATC speaks there",
        Elsewhere: "it speaks in a circuit that is not described",
    }
    {
        let lengths = any_lengths(e);
        let Some(said) = any_said(e, &lengths) else { return };
        let movement = any_movement(e);
        let movement = if any_flag(e, "the ATC is silent (odd: yes)") { None } else { Some(movement) };
        let circuit = CircuitId::new(any_byte(e, "the circuit (number)", 0..=1) & 63);
        e.assume(circuit.is_some());
        let Some(circuit) = circuit else { return };
        let counters = Counters { main: Counter(any_byte(e, "number", 0..=255)), sub: Counter(0) };
        let restrictions = SpeedLimits::NONE;
        let sent = said.signals.sent(&lengths, circuit, movement, restrictions, counters);
        e.claim(Claim::Silent as u32, movement.is_some() || sent.is_none());
        let described = circuit.number() == 0;
        e.claim(Claim::Sent as u32, movement.is_none() || sent.is_some() == described);
        let mut codes = true;
        if let (Some(sent), Some(movement)) = (sent, movement) {
            for heading in [Heading::Left, Heading::Right] {
                let goes = movement.heading == Some(heading);
                let word = if goes { said.word(movement.speed) } else { said.stop };
                let its = if heading == Heading::Left { sent.left } else { sent.right };
                codes &= its.codes == word.codes;
            }
        }
        e.claim(Claim::Codes as u32, codes);
        e.cover(Cover::Silent as u32, movement.is_none() && described);
        e.cover(Cover::Sent as u32, sent.is_some());
        e.cover(Cover::Elsewhere as u32, movement.is_some() && !described);
    }
}

harness! {
    /// The safe output is stop at every signal, no drive, no permission, no confirmed block and silence in every circuit.
    way_safe(e)
    theorem "T-WAY-8";
    requirements ["WAY-23"];
    assumptions [];
    bound BOUND_SAFE;
    cases 1;
    unwind 65 = 1 + LONGEST;
    claims {
        Signals: "no signal shows proceed, no point is driven, no block is confirmed, and no request is answered",
        Neighbours: "no neighbour is told anything",
        Silence: "nothing is sent in any circuit",
    }
    covers {
        Any: "there is one",
    }
    {
        let safe = <Wayside<'_, 2, 2, 1, 1, 2> as Machine>::SAFE;
        let still = safe.proceed.is_empty() && safe.drives.is_empty() && safe.confirmed.is_empty();
        e.claim(Claim::Signals as u32, still && safe.answer.is_none() && safe.line.is_none());
        e.claim(Claim::Neighbours as u32, safe.messages[0].is_none() && safe.messages[1].is_none());
        // Any one of them stands for all.
        let number = usize::from(e.word("a circuit (number)", 0..=63) & 63);
        let mut silent = true;
        for (its, sent) in safe.transmissions.iter().enumerate() {
            silent &= its != number || sent.is_none();
        }
        e.claim(Claim::Silence as u32, silent);
        e.cover(Cover::Any as u32, number == 63);
    }
}
