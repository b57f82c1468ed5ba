//! The models of the border between two blocks.

use super::shared::{
    BORDER, BORDER_FAULTS, BORDER_NO_FAULT, BORDER_ONE_FAULT, FAULTS, NO_FAULT, NOT_HEARD_BY_ONE, ONE_FAULT, USUAL,
    about,
};
use crate::block::border::{Layout, Pair, Showing};
use crate::block::fault::{Faults, Kind};
use crate::block::lines::{Lining, OnDisagreement, OnNotCounting, RealLine};
use crate::check::Entry;

/// Without faults, with one, and with what the assumptions exclude.
pub(super) fn entries() -> Vec<Entry> {
    let mut entries = borders();
    entries.extend(hazards());
    entries
}

fn pair<L: Lining>(device: L, layout: Layout, budget: u8) -> Pair<L> {
    Pair {
        device,
        trains: 3,
        hold: 1,
        pass: 2,
        layout,
        check_out_at_border: true,
        reset_while_crossing: false,
        faults: Faults::up_to(budget, 2, 2),
        showing: Showing::Safe,
    }
}

fn borders() -> Vec<Entry> {
    let statement = "Trains cross the border of two blocks where check-in ahead and check-out behind overlap: no section with a head \
                     or a tail is reported free";
    let crossing = |name, more: &str, environment, in_force, lifted, layout, budget| {
        let about = about(name, &format!("{statement}{more}"), environment, BORDER, in_force, lifted);
        Entry::new(about, pair(RealLine, layout, budget))
    };
    let no_fault = "no fault; right resets of either block while no head is crossing";
    let one_fault = "one component at most is faulty, and free to fail in every cycle; right resets of either block while no head \
                     is crossing";
    let overlapping = Layout::Overlapping;
    vec![
        crossing("border", ", and no train is in neither count.", no_fault, BORDER_NO_FAULT, &[], overlapping, 0),
        crossing(
            "border-fault",
            ", with any one faulty component.",
            one_fault,
            BORDER_ONE_FAULT,
            FAULTS,
            overlapping,
            1,
        ),
        crossing(
            "border-fault-heard-twice",
            ", with any one faulty component, also if both detectors at the border hear a head for a while.",
            one_fault,
            BORDER_ONE_FAULT,
            FAULTS,
            Layout::HeardTwice,
            1,
        ),
        Entry::new(
            about(
                "border-check-out-first",
                "A check-out that lies before the check-in ahead: without a fault no section with a head or a tail is reported \
                 free, and no train is in neither count.",
                no_fault,
                BORDER,
                NO_FAULT,
                &["loops-overlap"],
            ),
            pair(RealLine, Layout::CheckOutFirst, 0),
        ),
        Entry::new(
            about(
                "border-fault-check-out-first",
                "A check-out that lies before the check-in ahead, with the head heard behind until then: with any one faulty \
                 component no section with a head or a tail is reported free.",
                one_fault,
                BORDER,
                ONE_FAULT,
                BORDER_FAULTS,
            ),
            pair(RealLine, Layout::CheckOutFirst, 1),
        ),
    ]
}

fn hazards() -> Vec<Entry> {
    let missed = || Faults::single(Kind::Missed, 2, 2);
    let phantom = || Faults::single(Kind::Phantom, 2, 2);
    let rule = "another take-over rule than the kernel's";
    let apart = "a missed detection; a head is past the check-out before it is at the check-in ahead";
    let resets = with(RealLine, Layout::Overlapping, missed(), &["verified-reset"]);
    let resets = Pair { reset_while_crossing: true, ..resets };
    vec![
        Entry::new(
            about(
                "border-reset-while-crossing",
                "A reset with the right number after a head has passed the check-in ahead and before it is in the block there: \
                 it is counted no more, and with one missed detection reported free.",
                "a missed detection; resets with the right number at any time, also while a head is crossing",
                BORDER,
                USUAL,
                &["verified-reset", "independent-detectors", "loops-overlap"],
            ),
            resets,
        ),
        hazard(
            "border-check-out-first-on-not-counting",
            "A check-out that lies before the check-in ahead, if a block that does not count took over at once: the head is still \
             heard behind, where it is counted no more, and makes up for another one there that is missed.",
            &format!("{apart}; {rule}"),
            with(OnNotCounting, Layout::CheckOutFirst, missed(), &["loops-overlap", "BLK-10"]),
        ),
        hazard(
            "border-check-out-first-on-disagreement",
            "The same if a block took over whenever it reports everything occupied.",
            &format!("{apart}; {rule}"),
            with(OnDisagreement, Layout::CheckOutFirst, missed(), &["loops-overlap", "BLK-10"]),
        ),
        hazard(
            "border-unheard-phantom",
            "No detector hears a head between check-out and check-in ahead: one phantom behind makes up for it, and its tail is \
             reported free.",
            "a phantom detection; a head is unheard from the check-out to the check-in ahead",
            with(RealLine, Layout::CheckOutFirstUnheard, phantom(), &["loops-overlap", "heard-by-one"]),
        ),
        hazard(
            "border-unheard-on-disagreement",
            "No detector hears a head between check-out and check-in ahead, and a block takes over whenever it reports everything \
             occupied: the train is lost between the two without any fault.",
            &format!("no fault; {rule}"),
            with(
                OnDisagreement,
                Layout::CheckOutFirstUnheard,
                vec![Faults::NONE],
                &["loops-overlap", "heard-by-one", "BLK-10"],
            ),
        ),
        hazard(
            "border-detected-late-missed",
            "A detector behind that still hears a head after the check-out: it makes up for another one there that is missed.",
            "a missed detection; the detectors change over after the check-out",
            with(RealLine, Layout::DetectedLate, missed(), &["loops-overlap"]),
        ),
        hazard(
            "border-detected-early-missed",
            "A detector ahead that hears a head before the check-in: it makes up for another one there that is missed, or is \
             itself deaf while nobody counts the train.",
            "a missed detection; the detectors change over before the check-in ahead",
            with(RealLine, Layout::DetectedEarly, missed(), &["loops-overlap"]),
        ),
    ]
}

fn with<L: Lining>(device: L, layout: Layout, faults: Vec<Faults>, excluded_by: &'static [&'static str]) -> Pair<L> {
    Pair { faults, showing: Showing::Hazard(excluded_by), ..pair(device, layout, 0) }
}

/// A model of a border with a hazard.
fn hazard<L: Lining>(name: &'static str, statement: &str, environment: &str, model: Pair<L>) -> Entry {
    let lifted = &["loops-overlap", "heard-by-one", "independent-detectors"];
    Entry::new(about(name, statement, environment, BORDER, NOT_HEARD_BY_ONE, lifted), model)
}
