//! States per second: Stateright over the kernel against SPIN's compiled checker, on the same model.

use crate::block::device::Real;
use crate::block::fault::Faults;
use crate::block::single::{Beyond, Purpose, Single};
use crate::search::visit;
use crate::spin::{COUNTER, Counted, Folder, Spin};
use crate::subject::Subject;
use std::time::Instant;

/// One checker's figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The checker, and how it was run.
    pub checker: String,
    /// Cores that it may use.
    pub cores: usize,
    /// States, steps and the shortest time of all runs in seconds; or why there is no figure.
    pub figures: Result<(u64, u64, f64), String>,
}

/// One block of 5 sections, 3 trains, two faults: larger than those of the catalogue, so that starting up matters less.
fn subject() -> Single<Real> {
    Single {
        device: Real,
        sections: 5,
        trains: 3,
        tail: 1,
        hold: 1,
        pass: 2,
        apart: 2,
        share: true,
        faults: Faults::up_to(2, 5, 1),
        beyond: Beyond::Nothing,
        purpose: Purpose::Hazard(&[]),
    }
}

/// What is measured on, in words.
pub fn model() -> String {
    format!("one block: {}; two components at most are faulty", subject().parameters())
}

/// The table: each checker on one core and on `cores`, `runs` times each (at least once).
pub fn bench(cores: usize, runs: usize) -> Vec<Row> {
    let cores = cores.max(2);
    let mut rows: Vec<_> = [1, cores].map(|cores| stateright(cores, runs)).into();
    rows.extend(spin(cores, runs).unwrap_or_else(|why| {
        [1, cores].map(|cores| Row { checker: "SPIN".to_owned(), cores, figures: Err(why.clone()) }).into()
    }));
    let first = rows[0].figures.clone();
    for row in &mut rows {
        // A checker that looks at other states has no figure to compare.
        if let (Ok((states, _, _)), Ok((first, _, _))) = (&row.figures, &first)
            && states != first
        {
            row.figures = Err(format!("not comparable: {states} states, not {first}"));
        }
    }
    rows
}

fn stateright(cores: usize, runs: usize) -> Row {
    let model = subject();
    let visits: Vec<_> = (0..runs.max(1)).map(|_| visit(&model, cores)).collect();
    let shortest = visits.iter().map(|visit| visit.seconds).fold(f64::INFINITY, f64::min);
    let figures = match visits.iter().find(|visit| !visit.complete) {
        Some(_) => Err("not every state was visited".to_owned()),
        None => Ok((wide(visits[0].unique), wide(visits[0].generated), shortest)),
    };
    Row { checker: "Stateright over the kernel".to_owned(), cores, figures }
}

fn wide(number: usize) -> u64 {
    u64::try_from(number).unwrap_or(u64::MAX)
}

fn spin(cores: usize, runs: usize) -> Result<Vec<Row>, String> {
    let spin = Spin::find()?;
    let twin = subject().twin().ok_or("the model has no twin")?;
    let folder = Folder::new("bench")?;
    spin.generate(&folder, &twin)?;
    let many = format!("-DNCORE={cores}");
    let row = |name: &str, cores, more: &[&str]| {
        let options = [&["-O2"], COUNTER, more].concat();
        let checker = format!("SPIN {}, {}", spin.version(), options.join(" "));
        Row { checker, cores, figures: measure(&folder, name, &options, runs) }
    };
    Ok(vec![row("one", 1, &[]), row("many", cores, &[&many])])
}

fn measure(folder: &Folder, name: &str, options: &[&str], runs: usize) -> Result<(u64, u64, f64), String> {
    let checker = folder.compile(name, options).map_err(|why| format!("not available: {why}"))?;
    let mut shortest = f64::INFINITY;
    let mut counted: Option<Counted> = None;
    for _ in 0..runs.max(1) {
        let start = Instant::now();
        counted = Some(checker.count().map_err(|why| format!("not available: {why}"))?);
        shortest = shortest.min(start.elapsed().as_secs_f64());
    }
    counted.map(|counted| (counted.states, counted.steps, shortest)).ok_or_else(|| "no run".to_owned())
}
