//! The oracle in this process: parse a step, step the kernel, write the output. Without pipes.

use atc_protocol::Session;
use atc_tests::{reception, traffic, workload};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

fn oracle_session(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("oracle");
    group.throughput(Throughput::Elements(1));
    for (name, (start, steps)) in [
        ("step, in process", workload::lines()),
        ("block-count step, in process", traffic::lines()),
        ("permitted-speed step, in process", reception::lines()),
    ] {
        let steps: Vec<&str> = steps.lines().collect();
        group.bench_function(name, |bencher| {
            let mut session = Session::new();
            let mut reply = Vec::new();
            session.answer(start.trim_end().as_bytes(), &mut reply);
            assert!(reply.starts_with(b"{\"started\""));
            let mut input = steps.iter().cycle();
            bencher.iter(|| {
                reply.clear();
                session.answer(input.next().map_or(&b""[..], |line| line.as_bytes()), &mut reply);
                assert!(reply.starts_with(b"{\"output\""));
            });
        });
    }
    group.finish();
}

criterion_group!(benches, oracle_session);
criterion_main!(benches);
