//! One logic cycle of the kernel with busy input: 16 aspects, target well under 100 ns; a block of 16 sections, target well under
//! 50 ns; a line of four such blocks; the permitted speed, target well under 200 ns; the position, target well under 500 ns; a bit of
//! the deframer, target well under 50 ns; a cycle of the interlocking with its telegrams for a full station of each size, target under
//! 5 µs with 64 routes and under 40 µs with 256, with traffic and with a train in every circuit.

use std::hint::black_box;

use atc_kernel::aspect::{MAX_ASPECTS, State, step};
use atc_kernel::interlocking::{Layout, Size};
use atc_kernel::telegram::Deframer;
use atc_kernel::{Machine as _, block, interlocking, permitted, position};
use atc_tests::{busy_station, reception, traffic, workload};
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};

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
    let (parameters, inputs) = (reception::permitted(), reception::heard());
    group.bench_function("permitted step", |bencher| {
        let mut state = permitted::State::INITIAL;
        let mut inputs = inputs.iter().cycle();
        bencher.iter(|| {
            let input = inputs.next()?;
            let (next, permission) = permitted::step(black_box(&parameters), black_box(state), black_box(*input));
            state = next;
            permission.speed
        });
    });
    let (parameters, inputs) = (reception::position(), reception::measured());
    group.bench_function("position step", |bencher| {
        let mut state = None;
        let mut inputs = inputs.iter().cycle();
        bencher.iter(|| {
            let input = inputs.next()?;
            state = position::step(black_box(&parameters), black_box(state), black_box(*input));
            state
        });
    });
    let bits = reception::bits();
    group.bench_function("deframer, a bit", |bencher| {
        let mut window = Deframer.initial();
        let mut bits = bits.iter().cycle();
        bencher.iter(|| {
            let bit = bits.next()?;
            let (next, telegram) = Deframer.step(black_box(window), black_box(*bit));
            window = next;
            telegram
        });
    });
    cycles(&mut group, &busy_station::station());
    cycles(&mut group, &busy_station::large());
    group.finish();
}

/// Cycles of a station with every route that there is room for.
fn cycles<const R: usize, const P: usize, const N: usize, const S: usize, Z: Size>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    station: &Layout<R, P, N, S, Z>,
) {
    let rows = R / 16;
    for (name, inputs) in [("traffic", busy_station::traffic(rows)), ("all occupied", busy_station::full(rows))] {
        let mut state = interlocking::State::INITIAL;
        for input in busy_station::service(rows) {
            state = station.cycle(state, input).0;
        }
        group.bench_function(format!("interlocking cycle and telegrams, {R} routes, {name}"), |bencher| {
            let mut inputs = inputs.iter().cycle();
            bencher.iter(|| {
                let Some(input) = inputs.next() else { return false };
                let (next, output) = black_box(station).cycle(black_box(state), black_box(*input));
                state = next;
                black_box(station.telegrams(&output.table, state.epoch))[63].is_some()
            });
        });
    }
}

criterion_group!(benches, kernel_step);
criterion_main!(benches);
