use atc_models::{check, Entry, About};
use atc_models::block::fault::Kind;
use atc_models::interlocking::counted_between::*;
use atc_models::interlocking::between::Lives;
fn main() {
    let lives = Lives { permission: 1, residual: 1 };
    let trains: u8 = std::env::args().nth(1).unwrap().parse().unwrap();
    let show = |name: &str, faults: Vec<Faults>| {
        let mut m = CountedBetween::<1>::new(2, trains, lives, faults, Purpose::Safe);
        m.resets_together = std::env::args().nth(2).is_some();
        let e = Entry::new(About { name: "x", statement: String::new(), requirements: &[], environment: String::new(), in_force: &[], lifted: &[] }, m);
        let o = check(&e, 1);
        let bad: Vec<_> = o.properties.iter().filter(|p| !p.ok()).map(|p| format!("{} {:?}", p.name, p.verdict)).collect();
        println!("{name}: {} states {} gen depth {} {:.2}s complete {} bad {bad:?}", o.unique_states, o.generated_states, o.max_depth, o.seconds, o.complete);
    };
    if std::env::var_os("ONE").is_some() {
        for often in [Often::AtWill, Often::Once] { for withdraws in [Withdraws::AtWill] {
            let kinds = [Failure::Counting(Kind::Missed), Failure::Counting(Kind::CheckInLost)];
            let mut m = CountedBetween::<1>::new(2, trains, lives, cut_sets::places(&kinds, 2, 1), Purpose::Safe);
            m.resets_together = true; m.often = often; m.withdraws = withdraws;
        let e = Entry::new(About { name: "x", statement: String::new(), requirements: &[], environment: String::new(), in_force: &[], lifted: &[] }, m);
        let o = check(&e, 1);
        let bad: Vec<_> = o.properties.iter().filter(|p| !p.ok()).map(|p| format!("{} {:?}", p.name, p.verdict)).collect();
        println!("{often:?} {withdraws:?}: {} states {} gen depth {} {:.2}s complete {} bad {bad:?}", o.unique_states, o.generated_states, o.max_depth, o.seconds, o.complete);
        }}
        return;
    }
    if std::env::var_os("PAIRS").is_some() {
        for (n, lives, withdraws) in [(3, Lives { permission: 1, residual: 0 }, Withdraws::InUse)] {
        let mut m = CountedBetween::<1>::new(n, trains, lives, vec![Faults::NONE], Purpose::Pairs(&["independent-detectors"]));
        m.resets_together = true; m.often = Often::Once; m.withdraws = withdraws;
        let t = std::time::Instant::now();
        let cuts = atc_models::Subject::cut_sets(&m, atc_models::Limits::default());
        println!("{n} {lives:?} {withdraws:?} {:?} {:?}", t.elapsed(), cuts.map(|c| c.iter().map(|c| (c.faults.clone(), c.excluded_by.clone(), c.trace.steps.len())).collect::<Vec<_>>()));
        }
        return;
    }
    show("none", vec![Faults::NONE]);
    let _ = Kind::ALL;
    for kind in Failure::all() { show(kind.name(), kind.single(2, 1)); }
}
