//! The parts of EN 50129 around the technical safety report; each says what verification cannot support.

use super::parts::{badge, date};
use crate::case::Case;
use maud::{Markup, html};

/// Section 1.
pub fn definition(case: &Case) -> Markup {
    html! {
        h2 #system { "1 System definition" }
        p { "The generic product is the kernel package " code { "atc-kernel" } ": the machines of an automatic train control \
             system, each a pure and total function from state and input to state and output, without heap, clock, floating \
             point or unsafe code; its one dependency is the project's own " code { "atc-arithmetic" } "." }
        ul {
            li { strong { "Aspect acceptance" } " (JP3886280B2): from the codes that the receiver detects in each logic cycle to the \
                one aspect that is displayed. Nothing displayed means stop." }
            li { strong { "Speed supervision" } ": from measured and permitted speed to the brake command." }
            li { strong { "Two channels" } ": any of the machines twice on the same inputs, states and outputs compared in every cycle; any \
                difference latches the safe output." }
            li { strong { "Block counting" } " (JPS5937270B2), on the ground: from the checks at the ends of a block and the detectors of its \
                sections to the sections that are reported occupied; blocks chained to a line, with holds for the tails of trains." }
            li { strong { "Telegrams, codes, permitted speed" } " (JP4845985B2), on board: from bits to telegrams with their check and counter, from \
                code frequencies to speeds, and from both, the odometer and the distance to the exit to the one speed that is permitted." }
            li { strong { "Interlocking and ATC" } " (JP4290933B2), on the ground: in one cycle from the occupied circuits, the detected points and one \
                request to signals, point drives, and a telegram for each circuit; for every layout that its validator accepts." }
            li { strong { "Train position" } " (JP4045174B2), on board: from the levels of two signals to an interval that contains the train, or unknown." }
        }
        p { "Boundary: inputs are sets of detected aspects and speeds, received bits, code frequencies and levels, the odometer, check levels, \
             detections and resets, track circuits, points and requests, once a logic cycle; outputs are the display, the brake command, the permitted speed, the position, the \
             occupied sections, signals, point drives and telegrams of the ATC. Receiver, antenna, brake, checks and detectors, hardware and operating system are outside; what is needed of them is in the "
             a href="#conditions" { "application conditions" } "." }
        p { "The requirements are the " (case.requirements.len()) " sentences with MUST in " code { "spec/" } ", listed under "
            a href="#traceability" { "traceability" } ". The specific application of this document is " a href="#line" { (case.line.name) }
            @if let Some(station) = &case.station { ", and on the ground the station " a href="#layouts" { (station.name) } } "." }
    }
}

/// Sections 2 and 3.
pub fn management(case: &Case) -> Markup {
    html! {
        h2 #quality { "2 Quality management report" }
        p { "What verification supports: the sources are under version control; this document names the commit, the lock file and a \
             hash of every folder; all tests, proofs and models run by one command; a falling number of theorems, claims, models or \
             wrong kernels stops the generation (" code { "evidence/ratchet.toml" } ")." }
        p.cannot { "What it cannot support: organisation, competence of staff, supplier control, configuration and change management \
             outside the repository, audits. These are for the manufacturer's quality management (EN 50126, ISO 9001)." }
        h2 #safety { "3 Safety management report" }
        p { "What verification supports: a hazard log of " (case.hazards.len()) " hazards with their mitigations (" a href="#hazards" { "4.7" }
            "), requirements with rationale, traceability, the techniques of Annex A that are claimed (" a href="#techniques" { "4.11" }
            "), tool classes (" a href="#tools" { "4.12" } ")." }
        p.cannot { "What it cannot support: the safety plan, the independence of roles, the risk analysis and its tolerable hazard rates, \
             the completeness of the hazard identification, safety reviews, and the allocation of a safety integrity level." }
    }
}

/// Sections 5 to 7.
pub fn ending(case: &Case) -> Markup {
    let provenance = &case.provenance;
    html! {
        h2 #related { "5 Related safety cases" }
        p { "None is included. Needed for a whole device: the safety cases of the hardware (processor, memory, comparator, watchdog), of \
             the receiver, of the brake interface, and of the compiler or its qualification. What is needed of each is in the conditions." }
        h2 #conclusion { "6 Conclusion" }
        @for conclusion in &case.conclusions { p { (badge(conclusion.verdict)) " " (conclusion.sentence) } }
        @let (_, words) = super::page_one::headline(case);
        p { (words) @if !case.open_items.is_empty() { " They are listed on page one." } }
        p.cannot { "This document concludes nothing on the parts that verification cannot support (2, 3, 5). They are to be added by those who \
             answer for them." }
        h2 #provenance { "7 Provenance" }
        p { "The case holds for these sources and no others." }
        p { "Beside this page: the whole case as data (" code { "case.json" } ", its shape in " code { "case.schema.json" }
            "), the argument (" code { "gsn.yaml" } "), the results for build servers (" code { "junit.xml" }
            "), what is not good, with file and line, for editors and code review (" code { (crate::render::sarif::FILE) }
            "), the registers (" code { "*.csv" } "), and the hashes of all of them (" code { (crate::render::files::SUMS) } ")." }
        dl.facts {
            dt { "Generated" } dd { (date(provenance.generated_unix)) ", in " (format!("{:.0}", provenance.seconds)) " s" }
            dt { "Commit" } dd { (provenance.commit.as_deref().unwrap_or("not a git checkout"))
                @match provenance.dirty { Some(true) => " (with changes)", Some(false) => " (clean)", None => "" } }
            dt { "Cargo.lock" } dd { code { (provenance.cargo_lock_sha256) } }
            dt { "Kernel and proofs" } dd { code { (provenance.sources_sha256) } }
            @for (name, hash) in &provenance.folders { dt { (name) "/" } dd { code { (hash) } } }
            @for (name, version) in &provenance.tools { dt { (name) } dd { (version) } }
            dt { "Prover flags" } dd { code { (provenance.flags.join(" ")) } }
            dt { "Aspects in sized harnesses" } dd { (provenance.aspects) }
            dt { "Required" } dd { (case.status.required.as_deref().unwrap_or("nothing beyond no defect")) }
            dt { "Exit code" } dd { (case.status.exit_code) }
            @if let Some(since) = case.run.kept_since {
                dt { "Not run again" } dd { "results of an earlier run of this commit, from " (date(since)) }
            }
            @if !case.run.joined.is_empty() { dt { "Joined from" } dd { (case.run.joined.join(", ")) } }
        }
        (super::times::render(&case.run))
        @if !case.status.reasons.is_empty() {
            h4 { "Why the exit code is not 0" }
            ul { @for reason in &case.status.reasons { li { (reason) } } }
        }
        @if !case.status.missing.is_empty() {
            h4 { "Without a result for these sources" }
            p.small { (case.status.missing.join(", ")) }
        }
    }
}
