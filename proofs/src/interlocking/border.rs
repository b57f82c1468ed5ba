//! The border (T-ATC-6): in a circuit that two stations see, a train is told by one of them, or by each for another direction of travel.
//!
//! The accident: two devices tell a train in the last circuit of a line different things for the same way; or the one that does not see what
//! is ahead of the train tells it to stop for ever.

use super::any::any_heading;
use super::atc::{any_contents, sent};
use super::line::{BOUND, PATH, SEGMENTS, UNDER_KANI, any_line};
use atc_kernel::interlocking::{CircuitId, CircuitSet, SegmentSet, silent};

harness! {
    /// A ghost train stands with its front in any circuit. Where the neighbour's device sees it too, this device says something only while the line is
    /// travelled towards its own station, and then for that direction alone. Two devices whose lines lead out in opposite directions so never both
    /// let one train go.
    t_atc_6(e)
    theorem "T-ATC-6";
    requirements ["ATC-12"];
    assumptions ["held-routes-compatible", "routes-lead-off-the-line", "trains-know-facing", "views-of-a-line-meet"];
    built_in &[
        ("trains-know-facing", "left and right are the same for the train as for the layout"),
        ("views-of-a-line-meet", "the neighbour's device sees the circuits that the layout says, and speaks there"),
    ];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Silent: "in a circuit that the neighbour's device sees too nothing is sent while the line is not travelled towards this station",
        Inward: "what is sent there lets no train go that faces away from this station",
        Others: "in every other circuit something is sent",
        Unread: "without a table nothing is sent where the neighbour's device sees too",
    }
    covers {
        Out: "a train on the last circuit out hears nothing of this device",
        In: "a train on the first circuit in is let in",
    }
    {
        let Some(line) = any_line(e) else { return };
        let contents = any_contents(e, &line);
        let own = e.word("the train's circuit (number)", 12..=18) & 31;
        let Some(circuit) = CircuitId::new(own.to_le_bytes()[0]) else { return };
        let faces = any_heading(e, "the train faces (odd: right)");
        let it = CircuitSet::from_bits(1 << own);
        let (mut both_see, mut inward, mut away) = (false, false, false);
        for number in 0..SEGMENTS {
            let segment = &line.plan().segments[number];
            for place in 0..PATH {
                let from_outside = usize::from(segment.length).wrapping_sub(place + 1);
                let here = place < usize::from(segment.length) && segment.circuits[place] == it;
                if here && from_outside < usize::from(segment.shared) {
                    both_see = true;
                    inward = contents.toward.bits() >> number & 1 == 1;
                    away = segment.outward == faces;
                    for grant in contents.grants {
                        let inward = grant.circuits.bits() == 0 || grant.train != it || grant.heading != segment.outward;
                        e.suppose("routes-lead-off-the-line", inward);
                    }
                }
            }
        }
        let unheard = silent(&line, Some(&contents)).bits() >> own & 1 == 1;
        let told = sent(&line, &contents, circuit).facing(circuit, Some(faces));
        e.claim(Claim::Silent as u32, !both_see || inward || unheard);
        e.claim(Claim::Inward as u32, !both_see || unheard || !away || !told.is_open());
        e.claim(Claim::Others as u32, both_see || !unheard);
        e.claim(Claim::Unread as u32, !both_see || silent(&line, None).bits() >> own & 1 == 1);
        let occupied = contents.occupied.bits() >> own & 1 == 1;
        e.cover(Cover::Out as u32, both_see && unheard && occupied && contents.away != SegmentSet::EMPTY);
        e.cover(Cover::In as u32, both_see && !unheard && told.is_open());
    }
}
