//! Import and check of a railML and of a PlanPro file with 77 routes; target: under 100 ms.

#[path = "../tests/support/mod.rs"]
mod support;

use std::hint::black_box;

use atc_layout::Description;
use atc_layout::import::{planpro, railml};
use criterion::{Criterion, criterion_group, criterion_main};
use support::planpro::Tool;
use support::railml::{Version, railml as written};
use support::{East, seventy_seven, station};

fn import(criterion: &mut Criterion) {
    let text = written(&seventy_seven(), Version::V31);
    criterion.bench_function("layout/railml of 77 routes: import and check", |bencher| {
        bencher.iter(|| {
            let imported = railml("77", black_box(&text)).expect("it imports");
            imported.description.model().expect("it breaks no rule of its own").routes.len()
        });
    });
    let text = support::planpro::written(&seventy_seven(), &Tool::PLAIN);
    criterion.bench_function("layout/planpro of 77 routes: import and check", |bencher| {
        bencher.iter(|| {
            let imported = planpro("77", black_box(&text)).expect("it imports");
            imported.description.model().expect("it breaks no rule of its own").routes.len()
        });
    });
    let native = Description { station: station(16, East::AllThrough), ..Description::default() }.to_toml();
    criterion.bench_function("layout/toml of 64 routes: read, check, compile", |bencher| {
        bencher.iter(|| {
            let description = Description::from_toml("64", black_box(&native)).expect("it is of the form");
            description.compile().expect("it breaks no rule").plan.clear
        });
    });
}

criterion_group!(benches, import);
criterion_main!(benches);
