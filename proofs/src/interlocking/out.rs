//! Out to the line (T-ATC-7): plain line is granted only to a train that is on it, or that a route to that very line brings there.
//!
//! The accident: a train has slid past its signal into the throat of the station, or the route that brought it there was withdrawn, or it is on a
//! route to another platform. The line is free and travelled outwards, so it is told to go; the point under it lies the other way.

use super::any::bit;
use super::atc::{any_contents, sent};
use super::line::{BOUND, PATH, SEGMENTS, UNDER_KANI, any_line};
use atc_kernel::interlocking::CircuitId;

harness! {
    /// A ghost train stands with its front in a circuit that is not of a line. It may enter that line only if a route to it grants all of its path up
    /// to the throat from where the train's authority reaches, or if it has the train on its last circuit, the throat. A circuit of another line
    /// that begins there it may never enter.
    t_atc_7(e)
    theorem "T-ATC-7";
    requirements ["ATC-13"];
    assumptions ["held-routes-compatible", "path-complete"];
    built_in &[("path-complete", "from the end of a route the tracks lead to the line that the layout says")];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Route: "a train that is not on a line may enter it only by a grant to the end of a route to that line",
        Throat: "from the throat itself it may enter it only if that route has the train there",
        End: "the end of that route is the throat of that line",
    }
    covers {
        Chain: "a train may run over a route and out to the line",
        Throat: "a train in the throat may go out to the line",
        Waits: "a train in the throat of a free line that is travelled outwards must stay there",
        Other: "of two lines that begin in one throat a train may enter one",
    }
    {
        let Some(line) = any_line(e) else { return };
        let contents = any_contents(e, &line);
        let own = e.word("the train's circuit (number)", 0..=8) & 31;
        let Some(circuit) = CircuitId::new(own.to_le_bytes()[0]) else { return };
        let plan = line.plan();
        let number = usize::from(e.word("a segment that stands for all (number)", 0..=1) & 1);
        let segment = &plan.segments[number % SEGMENTS];
        let (here, throat) = (bit(own), segment.throat.bits());
        let (mut all, mut closed) = (0, contents.occupied.bits() | contents.blocked.bits());
        for place in 0..PATH {
            all |= if place < usize::from(segment.length) { segment.circuits[place].bits() } else { 0 };
        }
        closed &= segment.circuits[0].bits();
        let told = sent(&line, &contents, circuit);
        let goes_out = told.hold.bits() & all != 0 && here & all == 0;
        let (mut by_route, mut is_there, mut ends) = (false, false, false);
        for (route, grant) in plan.routes.iter().zip(contents.grants) {
            let leads = route.to.bits() >> number & 1 == 1 && grant.complete && grant.train.bits() != 0;
            let reaches = leads && grant.circuits.bits() != 0 && grant.circuits.bits() & !told.hold.bits() == 0;
            let stands = leads && grant.circuits.bits() == 0 && grant.train.bits() & (here | told.hold.bits()) != 0;
            by_route |= reaches || stands;
            is_there |= stands && grant.train.bits() == here;
            ends |= (reaches || stands) && grant.last.bits() == throat;
        }
        e.claim(Claim::Route as u32, !goes_out || by_route);
        e.claim(Claim::Throat as u32, !goes_out || here != throat || is_there);
        e.claim(Claim::End as u32, !goes_out || ends);
        e.cover(Cover::Chain as u32, goes_out && here != throat);
        e.cover(Cover::Throat as u32, goes_out && here == throat);
        let free = contents.away.bits() >> number & 1 == 1 && closed == 0 && segment.length > 0;
        let waits = free && here == throat && contents.occupied.bits() & here != 0 && !told.is_open();
        e.cover(Cover::Waits as u32, waits);
        let both = plan.segments[0].throat == plan.segments[1].throat && contents.away.bits() == 3;
        e.cover(Cover::Other as u32, goes_out && both && here == throat);
    }
}
