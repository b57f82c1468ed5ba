//! Try.
use atc_models::block::fault::Kind;
use atc_models::interlocking::between::Lives;
use atc_models::interlocking::counted_between::*;
use atc_models::{About, Entry, check};
fn show<const B: usize>(name: &str, m: CountedBetween<B>) {
    let e = Entry::new(
        About {
            name: "x",
            statement: String::new(),
            requirements: &[],
            environment: String::new(),
            in_force: &[],
            lifted: &[],
        },
        m,
    );
    let o = check(&e, 1);
    let bad: Vec<_> = o.properties.iter().filter(|p| !p.ok()).map(|p| format!("{} {:?}", p.name, p.verdict)).collect();
    println!(
        "{name}: {} states {} gen depth {} {:.2}s complete {} bad {bad:?} cuts {}",
        o.unique_states,
        o.generated_states,
        o.max_depth,
        o.seconds,
        o.complete,
        o.cut_sets.len()
    );
}
fn main() {
    let lives = Lives { permission: 1, residual: 1 };
    let singles =
        |n, b| Failure::all().iter().flat_map(|kind| kind.single(n, b)).chain([Faults::NONE]).collect::<Vec<_>>();
    let new = |n, trains, faults: &[Faults]| {
        let mut m = CountedBetween::<1>::new(n, trains, lives, faults.to_vec(), Purpose::Safe);
        m.resets_together = true;
        m
    };
    let starts = [
        Faults::NONE,
        Faults::around(Around::SenderStarts, true),
        Faults::around(Around::ReceiverStarts, true),
        Faults::around(Around::Consent, true),
    ];
    for wiring in [Wiring::HoldsNothing, Wiring::OnlyWhileCounting, Wiring::PermitsUnverified, Wiring::BelievesForEver]
    {
        show(&format!("{wiring:?} none"), new(2, 2, &[Faults::NONE]).wired(wiring));
        show(&format!("{wiring:?} starts"), new(2, 2, &starts).wired(wiring));
        show(&format!("{wiring:?} missed"), new(2, 2, &Failure::Counting(Kind::Missed).single(2, 1)).wired(wiring));
    }
    let mut m = new(2, 2, &[Faults::NONE]);
    m.heedless = true;
    show("heedless", m);
    let mut m = new(2, 3, &starts);
    m.resets_together = false;
    show("start 3", m);
    let mut m = CountedBetween::<2>::new(1, 2, lives, singles(1, 2), Purpose::Safe);
    m.resets_together = true;
    m.often = Often::Once;
    m.withdraws = Withdraws::InUse;
    show("blocks once inuse", m);
    let mut m = CountedBetween::<2>::new(1, 2, lives, singles(1, 2), Purpose::Safe);
    m.resets_together = true;
    m.withdraws = Withdraws::InUse;
    show("blocks at will inuse", m);
    let mut m = new(2, 2, &singles(2, 1));
    m.withdraws = Withdraws::InUse;
    show("singles inuse", m);
    show("singles", new(2, 2, &singles(2, 1)));
}
