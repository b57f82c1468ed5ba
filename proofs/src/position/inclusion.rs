//! Less known, no narrower interval: T-POS-2.

use super::{any_curves, signed, table};
use atc_kernel::position::Spacing;

harness! {
    /// The spans for differences from `least` to `most` are among those for any differences that contain these. (In a span the
    /// part of a greater difference is not smaller, as it is rounded exactly: `t_pos_1_span`, `pos_part`.)
    t_pos_2(e)
    theorem "T-POS-2";
    requirements ["POS-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 35 = 1 + 2 * crate::position::KNOTS;
    claims {
        Inside: "where both tell the spans, the wider differences have a nearest span that is no farther, and a farthest one that is no nearer",
    }
    covers {
        Wider: "both tell the spans, and the wider ones another nearest span",
        Lost: "the narrower tell the spans, and the wider ones do not",
    }
    {
        let curves = any_curves(e, 0xFFFF);
        let Some(table) = Spacing::new(4).and_then(|spacing| table(e, curves, spacing)) else { return };
        let mut level = |what, likely| i32::from(signed(e.word(what, likely)));
        let (least, most) = (level("least difference (mB)", 0..=160), level("greatest difference (mB)", 0..=160));
        let (less, more) = (level("least of the wider differences (mB)", 0..=40), level("greatest of the wider ones (mB)", 0..=160));
        e.assume(less <= least && least <= most && most <= more);
        let (narrow, wide) = (table.spans(least, most), table.spans(less, more));
        let inside = narrow.is_none_or(|narrow| wide.is_none_or(|wide| {
            wide.nearest.number <= narrow.nearest.number && narrow.farthest.number <= wide.farthest.number
        }));
        e.claim(Claim::Inside as u32, inside);
        e.cover(Cover::Wider as u32, narrow.is_some_and(|narrow| wide.is_some_and(|wide| narrow.nearest.number != wide.nearest.number)));
        e.cover(Cover::Lost as u32, narrow.is_some() && wide.is_none());
    }
}
