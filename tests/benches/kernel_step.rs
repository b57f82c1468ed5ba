//! One logic cycle of the kernel with busy input: 16 aspects, target well under 100 ns; a block of 16 sections, target well under
//! 50 ns; a line of four such blocks.

use std::hint::black_box;

use atc_kernel::aspect::{MAX_ASPECTS, State, step};
use atc_kernel::{Machine as _, block};
use atc_tests::{traffic, workload};
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
    let (parameters, inputs) = (traffic::block(), traffic::block_inputs());
    group.bench_function("block step, 16 sections", |bencher| {
        let mut state = block::State::INITIAL;
        let mut inputs = inputs.iter().cycle();
        bencher.iter(|| {
            let Some(input) = inputs.next() else { return block::SectionSet::ALL };
            let (next, output) = block::step(black_box(parameters), black_box(state), black_box(*input));
            state = next;
            black_box(output).occupied
        });
    });
    let (line, inputs) = (traffic::line(), traffic::line_inputs());
    group.bench_function("line step, 4 blocks of 16 sections", |bencher| {
        let mut state = block::LineState::INITIAL;
        let mut inputs = inputs.iter().cycle();
        bencher.iter(|| {
            let Some(input) = inputs.next() else { return block::Hold::MOST };
            let (next, output) = black_box(&line).step(black_box(state), black_box(*input));
            state = next;
            black_box(output).before_hold
        });
    });
    group.finish();
}

criterion_group!(benches, kernel_step);
criterion_main!(benches);
