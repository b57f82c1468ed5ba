//! What a case is shown of faults: that no single one leads to harm, and which two together do.
//!
//! A cut set is two things that are wrong, of which neither alone leads to harm in the same run. That the runs here come to harm
//! shows that a campaign can see it.

use serde::{Deserialize, Serialize};

use crate::campaign::{self, Campaign, Cause};
use crate::defect::Defect;
use crate::driver::Drivers;
use crate::event::Event;
use crate::fault::{Extent, Kind};
use crate::film;
use crate::generate::Shape;
use crate::line::Line;
use crate::onboard::Signal;
use crate::world::World;

/// Two things that are wrong, and a run that comes to harm with both.
#[derive(Clone, Debug)]
pub struct CutSet {
    /// Its name in files.
    pub name: &'static str,
    /// What happens, in words.
    pub happens: &'static str,
    /// The two.
    pub both: [Cause; 2],
    line: fn() -> Result<Line, String>,
    campaign: Campaign,
}

/// What became of a cut set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Its name in files.
    pub name: String,
    /// What happens, in words.
    pub happens: String,
    /// The two, by name.
    pub both: [String; 2],
    /// The harm that both came to, as an event in JSON; none if nothing was seen.
    pub harm: Option<String>,
    /// The same for each of the two alone.
    pub alone: [Option<String>; 2],
}

/// What became of the runs with single faults, on one kind of signal.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Single {
    /// What trains run on.
    pub signal: String,
    /// How many runs there were; each kind of fault has its share.
    pub runs: u64,
    /// In how many of them something unsafe happened.
    pub unsafe_runs: u64,
    /// How often trains came to a station.
    pub arrivals: u64,
    /// In the first unsafe run what happened, in JSON, with its seed.
    pub first: Option<String>,
}

/// Everything that was seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// The single faults.
    pub singles: Vec<Single>,
    /// The cut sets.
    pub cut_sets: Vec<Row>,
}

/// A page that plays the accident of a cut set.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Page {
    /// Its name in files.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// The page, whole.
    pub html: String,
}

fn wrong(defect: Defect) -> Cause {
    Cause { defects: vec![defect], ..Cause::default() }
}

fn three_stations() -> Result<Line, String> {
    Line::generate("Three stations", &Shape::loops(3, 4))
}

/// The cut sets that are known.
pub fn all() -> [CutSet; 8] {
    let run = |signal, faults, seed| Campaign {
        runs: 1,
        causes: Vec::new(),
        extent: Extent::Tolerated,
        faults,
        trains: 4,
        seconds: 600,
        seed,
        signal,
        drivers: Drivers::Heedless,
    };
    let restart = || Cause::from(Kind::RestartStation);
    [
        CutSet {
            name: "codes-and-pattern-too-high",
            happens: "The ground tells codes from which trains do not stop, and the pattern on board is too high as well: a train runs over \
                      the end of the track.",
            both: [wrong(Defect::CodesTooHigh), wrong(Defect::PatternTooHigh)],
            line: three_stations,
            campaign: run(Signal::Both, 1, 1),
        },
        CutSet {
            name: "telegrams-live-on",
            happens: "The station starts anew and has forgotten what it granted; the train still runs on its telegram, and goes where nobody \
                      has let it.",
            both: [wrong(Defect::TelegramsLiveOn), restart()],
            line: three_stations,
            campaign: run(Signal::Telegrams, 1, 997),
        },
        CutSet {
            name: "codes-live-on",
            happens: "The station starts anew and is silent; the train still shows the last code, and goes where nobody has let it.",
            both: [wrong(Defect::CodesLiveOn), restart()],
            line: three_stations,
            campaign: run(Signal::Codes, 1, 1366),
        },
        CutSet {
            name: "clears-at-once",
            happens: "A train is not reported for a moment, and its circuits count as clear at once: it is told a speed that is too high for the \
                      points under it.",
            both: [wrong(Defect::ClearsAtOnce), Cause::from(Kind::ShuntLoss)],
            line: || Line::generate("Four tracks", &Shape::single(vec![4; 3], vec![4; 2])),
            campaign: Campaign { trains: 8, ..run(Signal::Codes, 150, 2) },
        },
        CutSet {
            name: "not-heard-and-checked-out",
            happens: "The detectors of a counted line do not hear a train, and a check-out takes it from the count: its section counts as free, and the \
                      next train is sent there.",
            both: [Cause::from(Kind::MissedHead), Cause::from(Kind::SpuriousCheckOut)],
            line: Line::double_track,
            campaign: Campaign { trains: 8, ..run(Signal::Codes, 20, 46) },
        },
        CutSet {
            name: "not-heard-and-not-checked-in",
            happens: "A train is neither counted where it enters a counted line nor heard in it: its section counts as free, and the next train is \
                      sent there.",
            both: [Cause::from(Kind::MissedHead), Cause::from(Kind::CheckInLost)],
            line: Line::double_track,
            campaign: Campaign { trains: 8, ..run(Signal::Telegrams, 20, 49) },
        },
        CutSet {
            name: "not-heard-and-reset",
            happens: "The detectors of a counted line do not hear a train; staff reset its block, which disagrees, to a number without it: its section \
                      counts as free, and the next train is sent there.",
            both: [Cause::from(Kind::MissedHead), Cause::from(Kind::WrongReset)],
            line: Line::double_track,
            campaign: Campaign { trains: 8, extent: Extent::Beyond, ..run(Signal::Telegrams, 20, 12) },
        },
        CutSet {
            name: "not-heard-and-a-phantom",
            happens: "The detectors of a counted line do not hear a train, and hear one farther on that is not there: the count agrees, the train's section \
                      counts as free, and the next train is sent there.",
            both: [Cause::from(Kind::MissedHead), Cause::from(Kind::PhantomHead)],
            line: Line::long_block,
            campaign: Campaign { trains: 8, extent: Extent::Beyond, ..run(Signal::Telegrams, 4, 19) },
        },
    ]
}

impl CutSet {
    /// Both together.
    pub fn cause(&self) -> Cause {
        let of = |cause: &Cause| (cause.defects.clone(), cause.kinds.clone());
        let [(one, kinds), (other, more)] = [of(&self.both[0]), of(&self.both[1])];
        Cause { defects: [one, other].concat(), kinds: [kinds, more].concat() }
    }

    /// The run with this cause.
    fn run<'a>(&self, line: &'a Line, cause: Cause) -> Result<World<'a>, String> {
        let campaign = Campaign { causes: vec![cause], ..self.campaign.clone() };
        World::new(line, campaign::setting(line, &campaign, 0).1)
    }

    /// What becomes of both, with its film, and of each alone.
    ///
    /// # Errors
    /// What is wrong with the line; it is tested.
    pub fn show(&self) -> Result<(Row, Page), String> {
        let line = (self.line)()?;
        let end_ms = u64::from(self.campaign.seconds) * 1000;
        let harm = |world: &World<'_>| -> Result<Option<String>, String> {
            let event: Option<&Event> = world.events.iter().find(|event| event.what.is_unsafe());
            event.map(serde_json::to_string).transpose().map_err(|error| error.to_string())
        };
        let mut world = self.run(&line, self.cause())?;
        let mut film = film::of(&mut world, end_ms, 1_000)?;
        film.title = format!("{}: {}", self.name, self.cause());
        let alone = |cause: &Cause| -> Result<Option<String>, String> {
            let mut world = self.run(&line, cause.clone())?;
            world.run(end_ms);
            harm(&world)
        };
        let row = Row {
            name: self.name.to_owned(),
            happens: self.happens.to_owned(),
            both: self.both.each_ref().map(Cause::to_string),
            harm: harm(&world)?,
            alone: [alone(&self.both[0])?, alone(&self.both[1])?],
        };
        let page = Page { name: self.name.to_owned(), caption: self.happens.to_owned(), html: film.page() };
        Ok((row, page))
    }
}

/// Runs with one fault each under drivers who obey nothing, `each` with each kind of fault, on every kind of signal, and half as many on a line
/// where trains are counted; and shows every cut set.
///
/// # Errors
/// What is wrong with a line; they are tested.
pub fn see(each: u64) -> Result<(Seen, Vec<Page>), String> {
    let (three, double) = (three_stations()?, Line::double_track()?);
    let singles = [
        single(&three, "codes", (Signal::Codes, each, 4))?,
        single(&three, "telegrams", (Signal::Telegrams, each, 4))?,
        single(&three, "both", (Signal::Both, each, 4))?,
        single(&double, "both, with counted blocks", (Signal::Both, each.div_ceil(2), 6))?,
    ];
    let shown: Vec<(Row, Page)> = all().iter().map(CutSet::show).collect::<Result<_, _>>()?;
    let (cut_sets, pages) = shown.into_iter().unzip();
    Ok((Seen { singles: singles.to_vec(), cut_sets }, pages))
}

/// Runs of `trains` trains with one fault each, `each` with each kind that the line can have.
fn single(line: &Line, name: &str, (signal, each, trains): (Signal, u64, usize)) -> Result<Single, String> {
    let causes: Vec<Cause> = Kind::of(line).into_iter().map(Cause::from).collect();
    let campaign = Campaign {
        runs: each * causes.len() as u64,
        causes,
        extent: Extent::Tolerated,
        faults: 1,
        trains,
        seconds: 600,
        seed: 1,
        signal,
        drivers: Drivers::Heedless,
    };
    let mut single = Single { signal: name.to_owned(), runs: 0, unsafe_runs: 0, arrivals: 0, first: None };
    for (cause, outcome) in campaign::run(line, &campaign, &|_| ())? {
        single.runs += outcome.runs;
        single.unsafe_runs += outcome.unsafe_runs;
        single.arrivals += outcome.arrivals;
        if let Some((seed, event)) = outcome.first.filter(|_| single.first.is_none()) {
            let event = serde_json::to_string(&event).map_err(|error| error.to_string())?;
            single.first = Some(format!("{cause}, seed {seed}: {event}"));
        }
    }
    Ok(single)
}
