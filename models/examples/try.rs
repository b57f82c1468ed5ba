use atc_models::{check, Entry, About};
use atc_models::block::fault::Kind;
use atc_models::interlocking::counted_between::*;
use atc_models::interlocking::between::Lives;
fn main() {
    let lives = Lives { permission: 1, residual: 1 };
    let trains: u8 = std::env::args().nth(1).unwrap().parse().unwrap();
    let show = |name: &str, faults: Vec<Faults>| {
        let m = CountedBetween::<1>::new(2, trains, lives, faults, Purpose::Safe);
        let e = Entry::new(About { name: "x", statement: String::new(), requirements: &[], environment: String::new(), in_force: &[], lifted: &[] }, m);
        let o = check(&e, 1);
        let bad: Vec<_> = o.properties.iter().filter(|p| !p.ok()).map(|p| format!("{} {:?}", p.name, p.verdict)).collect();
        println!("{name}: {} states {} gen depth {} {:.2}s complete {} bad {bad:?}", o.unique_states, o.generated_states, o.max_depth, o.seconds, o.complete);
    };
    show("none", vec![Faults::NONE]);
    let _ = Kind::ALL;
    for kind in Failure::all() { show(kind.name(), kind.single(2, 1)); }
}
