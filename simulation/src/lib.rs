//! A line with trains in continuous motion, under the kernel's own machines.
#![forbid(unsafe_code)]
pub mod campaign;
pub mod dispatcher;
pub mod driver;
pub mod event;
pub mod fault;
pub mod generate;
pub mod ground;
pub mod headline;
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
        let start = std::time::Instant::now();
        let headline = super::headline::measure(&super::headline::Extent::default()).unwrap();
        eprintln!("{:?}\n{}{:?}", start.elapsed(), headline.csv(), headline.edges_ms(0.5));
    }
    #[test]
    fn camp() {
        use super::*;
        let line = headline::line().unwrap();
        for extent in [fault::Extent::Tolerated, fault::Extent::Beyond] {
            let start = std::time::Instant::now();
            let campaign = campaign::Campaign { runs: 220, kinds: fault::Kind::ALL.to_vec(), extent, faults: 1, trains: 3, seconds: 600, seed: 1 };
            let outcomes = campaign::run(&line, &campaign, &|_| ()).unwrap();
            eprintln!("{:?}", start.elapsed());
            for (kind, outcome) in outcomes { eprintln!("{kind:?} {outcome:?}"); }
        }
    }
}
