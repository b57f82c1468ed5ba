//! A line with trains in continuous motion, under the kernel's own machines.
#![forbid(unsafe_code)]
pub mod dispatcher;
pub mod driver;
pub mod event;
pub mod fault;
pub mod generate;
pub mod ground;
mod judge;
pub mod line;
pub mod motion;
pub mod onboard;
pub mod rolling;
pub mod track;
pub mod world;

#[cfg(test)]
mod tests {
    #[test]
    fn runs() {
        for (shape, trains) in [(super::generate::Shape::loops(3, 4), 3), (super::generate::Shape::large(), 20)] {
            let line = super::line::Line::generate("x", &shape).unwrap_or_else(|e| panic!("{e}"));
            let setting = super::world::Setting { operate: super::onboard::Operate::Shortened, trains, seed: 1, faults: vec![], compared: true };
            let mut world = super::world::World::new(&line, setting).unwrap();
            let start = std::time::Instant::now();
            world.run(1_200_000);
            eprintln!("{} s took {:?}", world.now_ms / 1000, start.elapsed());
            for e in world.events.iter().take(0) { eprintln!("{}", serde_json::to_string(e).unwrap()); }
            for t in &world.trains { eprintln!("{:?} ran {} app {} needless {}", t.margins, t.ran_m, t.applications, t.needless); }
            eprintln!("{:?}", world.events.last());
            if trains == 20 { for e in &world.events { if e.at_ms > 300_000 { eprintln!("{}", serde_json::to_string(e).unwrap()); } }
            for a in &world.dispatcher.agents { eprintln!("{a:?}"); }
            for t in &world.trains { eprintln!("{:?} {} {:?}", t.body, t.body.along_m(&line.track), t.cab); }
            }
        }
    }

    #[test]
    fn lines() {
        for shape in [super::generate::Shape::loops(3, 4), super::generate::Shape::large()] {
            let line = super::line::Line::generate("x", &shape).unwrap_or_else(|e| panic!("{e}"));
            eprintln!("{} {} {:?}", line.track.circuits.len(), line.room(), line.track.along_m);
            for s in &line.stations { for p in &s.platforms { eprintln!("{} {:?} {:?} {:?}", s.name, p.name, p.arrive, p.depart); } }
            for s in 0..line.stations.len() { line.device(s).unwrap_or_else(|e| panic!("{e}")); }
        }
    }
}
