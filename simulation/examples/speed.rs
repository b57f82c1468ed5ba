//! How fast a large line runs.
use atc_simulation::{generate::Shape, line::Line, onboard::Operate, world::{Setting, World}};
fn main() {
    let line = Line::generate("x", &Shape::large()).unwrap();
    for compared in [false, true] {
    let setting = Setting { operate: Operate::Shortened, trains: 20, seed: 1, faults: vec![], compared };
    let mut world = World::new(&line, setting).unwrap();
    let start = std::time::Instant::now();
    world.run(3_600_000);
    println!("{} s took {:?}", world.now_ms / 1000, start.elapsed());
    }
}
