//! What lies ahead of the ghost train and under it: points that do not move (T-ILK-4), and no block that staff rely on (T-ILK-8).
//!
//! The accidents: a train runs over a point that moves, or lies the other way; a train runs into a circuit whose block was confirmed.
//! The train is that of T-ILK-10 ([`super::train`]), with all that may happen around it.

use super::any::{any_circuits, any_settling, bit};
use super::scene::{APPROACH, BOUND, BUILT_IN, Beside, ENTRY, FIRST, ROUTES, Scene, Train, UNDER_KANI, any_scene};
use crate::Engine;
use crate::engine::{any_byte, any_flag};
use atc_kernel::interlocking::{CircuitSet, Element, PointSet, Positions, Settling};

const POINTS: usize = 2;

/// How the train and the blades are, by construction.
const POINTS_BUILT_IN: &[(&str, &str)] = &[
    BUILT_IN[0],
    BUILT_IN[1],
    BUILT_IN[2],
    BUILT_IN[3],
    BUILT_IN[4],
    (
        "points-leave-while-driven",
        "a stroke begins within the settling time after a drive, or never; nothing else moves a point",
    ),
];

/// What the route has prepared for the train that is still ahead of it, or under it.
pub(super) fn needed<const R: usize, const N: usize>(scene: &Scene<R, N, 0>, train: &Train) -> Element {
    let (mut circuits, mut beside, mut normal, mut reverse) = (0, 0, 0, 0);
    let passed = train.tail.saturating_sub(FIRST);
    for (place, element) in (0..).zip(&scene.route.path) {
        if train.counts() && passed <= place && place < scene.route.length {
            circuits |= element.circuits.bits();
            beside |= element.beside.bits();
            normal |= element.positions.normal.bits();
            reverse |= element.positions.reverse.bits();
        }
    }
    let ground = &scene.ground;
    // On a calling-on route who stands there goes on into the berth.
    let whole = train.tail == ground.last && train.front == ground.last && train.moving == 0;
    let stands = whole && !ground.calling_on;
    let goes_on = train.front >= ground.over && !train.slid;
    if train.counts() && !stands && !goes_on {
        let overlap = scene.route.overlap;
        circuits |= overlap.circuits.bits();
        beside |= overlap.beside.bits();
        normal |= overlap.positions.normal.bits();
        reverse |= overlap.positions.reverse.bits();
    }
    Element {
        circuits: CircuitSet::from_bits(circuits),
        positions: Positions { normal: PointSet::from_bits(normal), reverse: PointSet::from_bits(reverse) },
        beside: CircuitSet::from_bits(beside),
    }
}

/// What a train that counts on the signal may still run over before it is there. The approach has no order: all of it, while the front is in it.
fn before_signal<const R: usize, const N: usize>(scene: &Scene<R, N, 0>, train: &Train) -> CircuitSet {
    let ground = &scene.ground;
    let on_approach = train.is_live() && train.front == APPROACH;
    // The circuit that the front has just entered may not report it yet.
    let at_entry = train.is_live() && train.front == ENTRY && train.late > 0;
    ground.approach.only_if(on_approach).or(ground.entry.only_if(on_approach || at_entry))
}

/// The blades of a point: a ghost of their own. In neither position they are between the two.
#[derive(Clone, Copy, Debug)]
struct Blades {
    normal: bool,
    reverse: bool,
    /// For how many cycles more a stroke that was commanded may begin, or not show yet.
    stroke: u8,
}

impl Blades {
    fn any<E: Engine + ?Sized>(e: &mut E) -> Self {
        Self { stroke: any_byte(e, "a stroke may begin for (cycles)", 0..=0), ..Self::anywhere(e) }
    }

    fn anywhere<E: Engine + ?Sized>(e: &mut E) -> Self {
        let (normal, reverse) = (any_flag(e, "the blades lie normal (odd: yes)"), any_flag(e, "reverse (odd: yes)"));
        Self { normal: normal && !reverse, reverse: reverse && !normal, stroke: 0 }
    }

    /// Whether they may move on.
    const fn may_move(self) -> bool {
        self.stroke > 0 || !self.normal && !self.reverse
    }

    /// One cycle, before the device reads.
    fn moves<E: Engine + ?Sized>(self, e: &mut E) -> Self {
        let stroke = self.stroke.saturating_sub(1);
        let anywhere = Self::anywhere(e);
        if self.may_move() { Self { stroke, ..anywhere } } else { self }
    }

    /// They are driven: a stroke begins at once, or within `settle` cycles, or never.
    fn driven<E: Engine + ?Sized>(self, e: &mut E, settle: u8) -> Self {
        let anywhere = Self::anywhere(e);
        let begins = any_flag(e, "the stroke begins at once (odd: yes)");
        if begins { Self { stroke: settle, ..anywhere } } else { Self { stroke: settle, ..self } }
    }

    /// Whether detection may say so: the truth or nothing, but while a stroke may not show yet.
    const fn may_read(self, normal: bool, reverse: bool) -> bool {
        self.stroke > 0 || (!normal || self.normal) && (!reverse || self.reverse)
    }

    /// Whether they lie where they are wanted, and stay there.
    const fn serve(self, normal: bool, reverse: bool) -> bool {
        !(normal || reverse) || self.stroke == 0 && (!normal || self.normal) && (!reverse || self.reverse)
    }
}

harness! {
    /// While a train may enter a route or is in it, every point of the path that is not behind its tail, and every point of the overlap into which
    /// it may slide, lies where the route needs it and does not move: whatever is falsely occupied, undetected or commanded.
    t_ilk_train_points(e)
    theorem "T-ILK-4";
    requirements ["ILK-3", "ILK-7", "ILK-8", "ILK-23", "ATC-1"];
    assumptions [
        "loss-of-shunt-within-clear", "approach-covers-braking", "release-covers-residual-running", "overlap-covers-sliding", "trains-obey-signals",
        "all-cab-signalled", "path-complete", "train-whole", "no-setting-back", "start-outlasts-running",
        "points-detect-truly", "points-leave-while-driven",
    ];
    built_in POINTS_BUILT_IN;
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Lie: "a point that the train still needs lies as the route needs it, and no stroke of it can begin",
        Counted: "the machine counts no more cycles than have passed since a stroke could last begin",
    }
    covers {
        Let: "a train is let in over a point that was driven, once its settling time is over",
        Behind: "a point is driven behind the tail of a train that is still in the path",
        Undetected: "a point under a train is not detected",
        Late: "a point leaves its position after it was driven, and is still detected there",
    }
    {
        let beside = |e: &mut E, _: &mut _| Beside { points: any_settling(e), ..Beside::NOTHING };
        let Some(scene) = any_scene::<E, ROUTES, POINTS, 0>(e, beside) else { return };
        let number = e.word("a point that stands for all (number)", 0..=1) & 1;
        let has = |points: PointSet| u64::from(points.bits()) & bit(number) != 0;
        let count = |settling: &Settling| settling.parts().0[usize::from(number & 1)];
        let settle = scene.plan.settle;
        let serves = |blades: &Blades, train: &Train| {
            let positions = needed(&scene, train).positions;
            blades.serve(has(positions.normal), has(positions.reverse))
        };
        let counted = |blades: &Blades, count: u8| {
            blades.stroke <= settle && count <= settle && (blades.stroke == 0 || count <= settle - blades.stroke)
        };
        let (device, end) = &scene.devices;
        let still = Blades::any(e);
        e.assume(counted(&still, count(&device.points)) && serves(&still, &scene.earlier));
        let blades = still.moves(e);
        let (normal, reverse) = (has(scene.input.detected.normal), has(scene.input.detected.reverse));
        e.suppose("points-detect-truly", blades.may_read(normal, reverse));
        let driven = has(scene.output.drives.points());
        let later = blades.driven(e, settle);
        let later = if driven { later } else { blades };
        e.claim(Claim::Lie as u32, serves(&later, &scene.informed));
        e.claim(Claim::Counted as u32, counted(&later, count(&end.points)));
        let positions = needed(&scene, &scene.informed).positions;
        let here = has(positions.points());
        let entered = scene.informed.authority && !scene.earlier.is_live() && here && settle > 1;
        e.cover(Cover::Let as u32, entered && count(&device.points) == settle - 1 && still.stroke == 1);
        let inside = scene.informed.front >= FIRST && scene.informed.front <= scene.ground.last;
        e.cover(Cover::Behind as u32, driven && inside && has(scene.route.path[0].positions.points()));
        e.cover(Cover::Undetected as u32, here && inside && !normal && !reverse);
        e.cover(Cover::Late as u32, still.normal && !blades.normal && normal);
    }
}

harness! {
    /// While a train may enter a route or is in it, no circuit of the approach over which it may still run to the signal, no circuit of the path that
    /// is not behind its tail, none of the overlap into which it may slide, and none beside these, is confirmed to staff; whatever is blocked, falsely occupied or commanded.
    t_ilk_train_worker(e)
    theorem "T-ILK-8";
    requirements ["ILK-5", "ILK-7", "ILK-15", "ILK-16", "ILK-37", "ATC-1"];
    assumptions [
        "loss-of-shunt-within-clear", "approach-covers-braking", "release-covers-residual-running", "overlap-covers-sliding", "trains-obey-signals",
        "all-cab-signalled", "path-complete", "train-whole", "no-setting-back", "start-outlasts-running",
    ];
    built_in BUILT_IN;
    bound BOUND;
    cases 1;
    unwind 65 = 1 + crate::interlocking::LONGEST;
    under_kani UNDER_KANI;
    claims {
        Apart: "no circuit that the train may still reach, or is in, or that is beside one of these, is confirmed",
        Kept: "nor does the device remember one as confirmed",
    }
    covers {
        Blocked: "the circuit ahead of a train in the path is blocked, and not confirmed",
        Behind: "a circuit behind the tail of a train that is still in the path is confirmed",
        Runs: "a circuit is blocked in front of a train that runs on without authority",
        Before: "the entry is blocked in front of a train on the approach, and not confirmed",
    }
    {
        let beside = |e: &mut E, _: &mut _| Beside { confirmed: any_circuits(e, "confirmed (bits)", 0..=0), ..Beside::NOTHING };
        let Some(scene) = any_scene::<E, ROUTES, 0, 0>(e, beside) else { return };
        let (device, end) = &scene.devices;
        let confirmed = device.works.confirmed;
        let reaches = |train: &Train| {
            let needed = needed(&scene, train);
            needed.circuits.or(needed.beside).or(before_signal(&scene, train))
        };
        let before = !confirmed.meets(reaches(&scene.earlier)) && device.works.is_valid();
        e.assume(before);
        let ahead = reaches(&scene.informed);
        e.claim(Claim::Apart as u32, !scene.output.confirmed.meets(ahead));
        e.claim(Claim::Kept as u32, !end.works.confirmed.meets(ahead));
        let inside = scene.informed.front >= FIRST && scene.informed.front <= scene.ground.last;
        let blocked = end.works.blocked;
        e.cover(Cover::Blocked as u32, inside && blocked.meets(scene.ground.at(scene.informed.front + 1)));
        e.cover(Cover::Behind as u32, inside && scene.output.confirmed.meets(scene.ground.at(FIRST)));
        let runs = !scene.informed.authority && scene.informed.is_live() && scene.informed.run > 1;
        e.cover(Cover::Runs as u32, runs && blocked.meets(scene.ground.at(FIRST)));
        let waits = scene.informed.is_live() && scene.informed.front == APPROACH;
        e.cover(Cover::Before as u32, waits && blocked.meets(scene.ground.entry) && !scene.input.occupied.meets(scene.ground.entry));
    }
}
