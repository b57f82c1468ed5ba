//! One logic cycle of the kernel with 16 aspects and busy input. The target is well under 100 ns.

use std::hint::black_box;

use atc_kernel::aspect::{MAX_ASPECTS, State, step};
use atc_tests::workload;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

fn kernel_step(criterion: &mut Criterion) {
    let (times, detections) = (workload::times(), workload::detections());
    let mut group = criterion.benchmark_group("kernel");
    group.throughput(Throughput::Elements(1));
    group.bench_function("aspect step, 16 aspects", |bencher| {
        let mut state = State::<MAX_ASPECTS>::INITIAL;
        let mut input = detections.iter().cycle();
        bencher.iter(|| {
            let detected = input.next().copied().unwrap_or_default();
            let (next, display) = step(black_box(times), black_box(state), black_box(detected));
            state = next;
            display
        });
    });
    group.finish();
}

criterion_group!(benches, kernel_step);
criterion_main!(benches);
