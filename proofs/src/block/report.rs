//! What is reported: T-BLK-1, T-BLK-4 (the machine's half), T-BLK-5 (exactness of the report) and T-BLK-6.

use super::{all, any_byte, any_cycle, any_trains, has, ones, suppose_count, suppose_no_phantom};

harness! {
    /// With a count that is not under the trains, and no detector that hears a train where there is none, every section with
    /// a head is reported occupied, whichever detections are missed.
    t_blk_1(e)
    theorem "T-BLK-1";
    requirements ["BLK-1", "BLK-2"];
    assumptions [
        "no-phantom", "heard-by-one", "loops-overlap", "entries-apart", "check-in-fail-safe", "live-transmitter", "check-out-not-spurious",
        "verified-reset", "no-reversing-over-exit",
    ];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        Occupied: "every section with a head is reported occupied",
    }
    covers {
        Missed: "a detection is missed",
        Free: "a section is reported free while another has a head",
        Together: "two trains are in one section",
        Full: "every section has a head, and all are detected",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let trains = any_trains(e, cycle.block);
        let (heads, detected) = (trains.heads, cycle.detected());
        suppose_no_phantom(e, detected, heads);
        suppose_count(e, !cycle.counts() || u32::from(cycle.output.count.0) >= trains.number);
        e.claim(Claim::Occupied as u32, heads & !cycle.output.occupied.bits() == 0);
        e.cover(Cover::Missed as u32, detected != heads);
        e.cover(Cover::Free as u32, heads != 0 && cycle.output.occupied.bits() != all(cycle.sections()));
        e.cover(Cover::Together as u32, trains.number > ones(heads));
        e.cover(Cover::Full as u32, heads == all(cycle.sections()) && cycle.output.agree);
    }
}

harness! {
    /// Tail cover, the machine's half: with a count that is not under the trains and no phantom detection, each of the k
    /// sections behind every head is reported occupied or asked of the block behind, and so is what the block ahead asks.
    t_blk_4(e)
    theorem "T-BLK-4";
    requirements ["BLK-5"];
    assumptions [
        "no-phantom", "heard-by-one", "loops-overlap", "entries-apart", "check-in-fail-safe", "live-transmitter", "check-out-not-spurious",
        "verified-reset", "no-reversing-over-exit",
    ];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        Here: "a section of the block that is at most k behind a head is occupied",
        Behind: "a section before the entry that is at most k behind a head is asked for",
        AheadHere: "a section that the block ahead asks for is occupied",
        AheadBehind: "what the block ahead asks for beyond the entry is asked for",
    }
    covers {
        Crosses: "a tail reaches over the entry",
        PassedOn: "a hold of the block ahead reaches over the entry",
        Agreed: "the counts agree and a tail is held",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let trains = any_trains(e, cycle.block);
        suppose_no_phantom(e, cycle.detected(), trains.heads);
        suppose_count(e, !cycle.counts() || u32::from(cycle.output.count.0) >= trains.number);
        let (hold, ahead) = (cycle.block.hold().sections(), cycle.input.ahead_hold.sections());
        let head = any_byte(e, "a head's section", 0..=5);
        let distance = any_byte(e, "sections behind", 1..=3);
        e.assume((1..=16).contains(&distance));
        let held = distance <= hold && has(trains.heads, head);
        let occupied = cycle.output.occupied.bits();
        let behind = cycle.output.behind_hold.sections();
        e.claim(Claim::Here as u32, !held || distance > head || has(occupied, head.wrapping_sub(distance)));
        e.claim(Claim::Behind as u32, !held || distance <= head || behind >= distance - head);
        // The section `distance` from the exit, or so many beyond the entry.
        let (asked, sections) = (distance <= ahead, cycle.sections());
        e.claim(Claim::AheadHere as u32, !asked || distance > sections || has(occupied, sections.wrapping_sub(distance)));
        e.claim(Claim::AheadBehind as u32, !asked || distance <= sections || behind >= distance - sections);
        e.cover(Cover::Crosses as u32, held && distance > head);
        e.cover(Cover::PassedOn as u32, asked && distance > sections);
        e.cover(Cover::Agreed as u32, held && cycle.output.agree && distance <= head);
    }
}

harness! {
    /// In agreement only detected sections and holds are reported, and in any case no more is asked of the block behind
    /// than the farther of the two holds needs.
    t_blk_5_report(e)
    theorem "T-BLK-5";
    requirements ["BLK-1", "BLK-5"];
    assumptions [];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        Exact: "in agreement a section is occupied if and only if it detects, is at most k behind one that does, or is asked for by the block ahead",
        NotBeyond: "no section is reported that the block does not have",
        Asked: "what is asked of the block behind is what reaches over the entry, of the heads or of the block ahead, and nothing more",
    }
    covers {
        Detected: "in agreement a section is occupied by a head",
        Held: "in agreement a section is occupied by a hold",
        AskedFor: "in agreement a section is occupied because the block ahead asks",
        Free: "in agreement a section is free",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let section = any_byte(e, "section looked at", 0..=5);
        let sections = cycle.sections();
        e.assume(section < 16);
        let (detected, agree) = (cycle.detected(), cycle.output.agree);
        let (hold, ahead) = (cycle.block.hold().sections(), cycle.input.ahead_hold.sections());
        let mut held = false;
        let mut reach = 0;
        for head in 0..16 {
            let is_head = if agree { has(detected, head) } else { head < sections };
            held |= is_head && head > section && head - section <= hold;
            if is_head && hold > head && hold - head > reach {
                reach = hold - head;
            }
        }
        if ahead > sections && ahead - sections > reach {
            reach = ahead - sections;
        }
        let asked = section < sections && sections - section <= ahead;
        let occupied = has(cycle.output.occupied.bits(), section);
        e.claim(Claim::Exact as u32, !agree || occupied == (has(detected, section) || held || asked));
        e.claim(Claim::NotBeyond as u32, !occupied || section < sections);
        e.claim(Claim::Asked as u32, cycle.output.behind_hold.sections() == reach);
        e.cover(Cover::Detected as u32, agree && has(detected, section));
        e.cover(Cover::Held as u32, agree && held && !has(detected, section));
        e.cover(Cover::AskedFor as u32, agree && asked && !held && !has(detected, section));
        e.cover(Cover::Free as u32, agree && section < sections && !occupied);
    }
}

harness! {
    /// Cut sets: a section with a head is reported free only if a detection is missed and, in number, phantom detections and
    /// trains that the count lacks together make up for the missed detections and the trains that share a section.
    t_blk_6(e)
    theorem "T-BLK-6";
    requirements ["BLK-1", "BLK-2"];
    assumptions [];
    bound "";
    cases 1;
    unwind 18 = 1 + crate::block::LONGEST;
    claims {
        Missed: "at least one detection is missed",
        Balance: "phantom + trains lacking in the count = missed + (trains - sections with a head)",
    }
    covers {
        Phantom: "a head is reported free by one missed and one phantom detection",
        Under: "a head is reported free by one missed detection and a count that is one under the trains",
        Shared: "a head is reported free while two trains share a section",
        Over: "a head is reported free with a count that is over the trains",
    }
    {
        let Some(cycle) = any_cycle(e) else { return };
        let trains = any_trains(e, cycle.block);
        let (heads, detected) = (trains.heads, cycle.detected());
        let (missed, phantom) = (ones(heads & !detected), ones(detected & !heads));
        let (number, count) = (trains.number, u32::from(cycle.output.count.0));
        let sharing = number - ones(heads);
        e.assume(heads & !cycle.output.occupied.bits() != 0);
        e.claim(Claim::Missed as u32, missed >= 1);
        // Phantom and trains; missed, sharing and the count: section by section, so that both sides grow together.
        let (mut with_phantom, mut with_missed) = (sharing, sharing);
        for section in 0..16 {
            with_phantom += u32::from(has(heads, section)) + u32::from(has(detected & !heads, section));
            with_missed += u32::from(has(detected, section)) + u32::from(has(heads & !detected, section));
        }
        e.claim(Claim::Balance as u32, count == ones(detected) && with_phantom == with_missed);
        e.cover(Cover::Phantom as u32, missed == 1 && phantom == 1 && number == count && sharing == 0);
        e.cover(Cover::Under as u32, missed == 1 && phantom == 0 && number == count + 1 && sharing == 0);
        e.cover(Cover::Shared as u32, sharing == 1);
        e.cover(Cover::Over as u32, number + 1 == count);
    }
}
