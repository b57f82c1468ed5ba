//! The direction of travel (T-ATC-5): a train has authority for the way that it faces, or none.
//!
//! The accident: a train that faces right stands at a platform from which a route to the left is set. It takes the telegram for its own and
//! runs over the point ahead of it, where nothing is set for it.

use super::any::any_heading;
use super::atc::{any_contents, sent};
use super::line::{BOUND, PATH, SEGMENTS, UNDER_KANI, any_line};
use crate::engine::any_flag;
use atc_kernel::interlocking::CircuitId;

harness! {
    /// A ghost train stands with its front in a circuit and faces left, right, or does not know: it may enter a circuit only if a route that leads its way
    /// grants it, or a segment that is travelled its way; and of two trains in one circuit that face different ways at most one may go.
    t_atc_5(e)
    theorem "T-ATC-5";
    requirements ["ATC-10", "ATC-11"];
    assumptions ["held-routes-compatible", "trains-know-facing"];
    built_in &[("trains-know-facing", "left and right are the same for the train as for the layout; it takes a telegram for its own facing only")];
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Own: "a circuit that the train may enter is granted by a route in the direction that it faces, or lies on plain line that is travelled in that direction",
        Unknown: "a train that does not know which way it faces must stop: its own circuit, no speed, nothing to enter",
        One: "a train in the same circuit that faces the other way must stop if the first may go",
    }
    covers {
        Goes: "a train may enter a circuit of a route and one of plain line",
        Other: "a train that faces the other way may go",
        Turned: "a telegram ends where the next grant is for the other direction",
    }
    {
        let Some(line) = any_line(e) else { return };
        let contents = any_contents(e, &line);
        let own = e.word("the train's circuit (number)", 0..=8) & 31;
        let Some(circuit) = CircuitId::new(own.to_le_bytes()[0]) else { return };
        let telegram = sent(&line, &contents, circuit);
        let faces = any_heading(e, "the train faces (odd: right)");
        let knows = any_flag(e, "the train knows which way it faces (odd: yes)");
        let told = telegram.facing(circuit, knows.then_some(faces));
        let other = telegram.facing(circuit, Some(faces.opposite()));
        let mut rightly = 0;
        for grant in contents.grants {
            rightly |= if grant.heading == faces { grant.circuits.bits() } else { 0 };
        }
        let mut of_lines = 0;
        for number in 0..SEGMENTS {
            let segment = &line.plan().segments[number];
            let away = contents.away.bits() >> number & 1 == 1;
            let toward = contents.toward.bits() >> number & 1 == 1;
            let same = away && segment.outward == faces || toward && segment.outward != faces;
            for place in 0..PATH {
                let its = if same && place < usize::from(segment.length) { segment.circuits[place].bits() } else { 0 };
                of_lines |= its;
            }
        }
        let hold = told.hold.bits();
        e.claim(Claim::Own as u32, hold & !(rightly | of_lines) == 0);
        let stays = hold == 0 && told.speed.0 == 0 && u16::from(told.stop.number()) == own && !told.is_open();
        e.claim(Claim::Unknown as u32, knows || stays);
        e.claim(Claim::One as u32, !told.is_open() || !other.is_open() && other.hold.bits() == 0);
        e.cover(Cover::Goes as u32, hold & rightly != 0 && hold & of_lines & !rightly != 0);
        e.cover(Cover::Other as u32, knows && stays && other.is_open());
        let ends = contents.grants[0].complete && hold == contents.grants[0].circuits.bits() && hold != 0;
        let next = contents.grants[1];
        let turned = next.train == contents.grants[0].last && next.circuits.bits() != 0 && next.heading != faces;
        e.cover(Cover::Turned as u32, ends && turned);
    }
}
