//! A dispatcher: sends the trains to and fro, asks for routes, and turns the lines. It knows where the trains are and what
//! the devices put out, and nothing of what they remember.
//!
//! A train leaves a station only when a track of the next one is kept for it, and each direction has its own tracks where
//! lines lead both ways; so no train waits for one that waits for it.

use std::collections::VecDeque;

use atc_kernel::interlocking::{Refusal, Request, RouteId, SegmentId, Travel};

use crate::bound::Bound;
use crate::event::What;
use crate::line::Line;
use crate::sizes::Routes;

/// After how long a signal that does not show proceed is given up, in ms.
const PATIENCE_MS: u64 = 20_000;
/// How long the dispatcher waits after a refusal, in ms.
const AGAIN_MS: u64 = 1_000;
/// How many trains may follow each other into a line while one waits at its other end.
const IN_A_ROW: usize = 2;

/// What the dispatcher sees of a train.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// The circuit of its front, and that of its tail.
    pub front: usize,
    /// The circuit of its tail.
    pub tail: usize,
    /// Whether it stands.
    pub stands: bool,
}

/// What a train is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// At a track, until then at least.
    Waits(u64),
    /// On its way; the front may still be at its track.
    Runs,
}

#[derive(Clone, Copy, Debug)]
struct Job {
    station: usize,
    request: Request,
}

#[derive(Clone, Copy, Debug)]
struct Watch {
    station: usize,
    route: usize,
    since_ms: u64,
}

/// What the dispatcher knows of a train.
#[derive(Clone, Debug)]
pub struct Agent {
    /// Where it goes.
    pub bound: Bound,
    /// The station and the track where it stands, or that it left.
    pub at: (usize, usize),
    /// The track of the next station that is kept for it.
    pub target: Option<(usize, usize)>,
    phase: Phase,
    /// Whether its track is still its own.
    holds: bool,
    entry_asked: bool,
    jobs: VecDeque<Job>,
    again_ms: u64,
    watch: Option<Watch>,
}

impl Agent {
    /// Whether the train may leave its track.
    pub fn may_leave(&self) -> bool {
        self.phase == Phase::Runs
    }
}

#[derive(Clone, Debug, Default)]
struct Section {
    bound: Option<Bound>,
    trains: Vec<usize>,
    in_a_row: usize,
}

/// The dispatcher of a line.
#[derive(Clone)]
pub struct Dispatcher<'a> {
    line: &'a Line,
    /// One for each train.
    pub agents: Vec<Agent>,
    sections: Vec<Section>,
    owners: Vec<Vec<Option<usize>>>,
    asked: Vec<Option<usize>>,
    turn: usize,
}

impl<'a> Dispatcher<'a> {
    /// Trains that stand at these tracks, bound so.
    pub fn new(line: &'a Line, trains: &[((usize, usize), Bound)]) -> Self {
        let mut owners: Vec<Vec<Option<usize>>> =
            line.stations.iter().map(|station| vec![None; station.platforms.len()]).collect();
        let mut agents = Vec::new();
        for (number, ((station, track), bound)) in trains.iter().copied().enumerate() {
            owners[station][track] = Some(number);
            agents.push(Agent {
                bound,
                at: (station, track),
                target: None,
                phase: Phase::Waits(0),
                holds: true,
                entry_asked: false,
                jobs: VecDeque::new(),
                again_ms: 0,
                watch: None,
            });
        }
        let (sections, asked) = (vec![Section::default(); line.links.len()], vec![None; line.stations.len()]);
        Self { line, agents, sections, owners, asked, turn: 0 }
    }

    /// The line that a train bound so runs over from `station`; none at the end.
    fn link(&self, station: usize, bound: Bound) -> Option<usize> {
        let west = if bound == Bound::West { station.checked_sub(1)? } else { station };
        let mut links = self.line.links.iter().zip(&self.line.ways);
        links.position(|(link, ways)| link.west == west && ways[bound.side()])
    }

    fn next(station: usize, bound: Bound) -> usize {
        match bound {
            Bound::West => station - 1,
            Bound::East => station + 1,
        }
    }

    /// A free track of the next station for a train that comes from `station`.
    fn free_track(&self, station: usize, bound: Bound) -> Option<(usize, usize)> {
        let next = Self::next(station, bound);
        let goes_on = self.link(next, bound).is_some();
        let onward = if goes_on { bound } else { bound.other() };
        let tracks = &self.line.stations[next].platforms;
        let fits = |number: usize| {
            let own = !goes_on || tracks.len() < 2 || number % 2 == bound.side();
            let ways =
                tracks[number].arrive[bound.other().side()].is_some() && tracks[number].depart[onward.side()].is_some();
            own && ways && self.owners[next][number].is_none()
        };
        (0..tracks.len()).find(|number| fits(*number)).map(|number| (next, number))
    }

    fn is_ready(&self, train: usize, now_ms: u64) -> bool {
        matches!(self.agents[train].phase, Phase::Waits(until) if until <= now_ms)
    }

    /// Looks at the trains, and decides; `told` hears of what happens. The trains whose driver changes ends are returned.
    pub fn look(&mut self, now_ms: u64, seen: &[Seen], proceed: &[Routes], told: &mut dyn FnMut(What)) -> Vec<usize> {
        let mut turned = Vec::new();
        for (train, seen) in seen.iter().enumerate() {
            self.follow(train, (now_ms, *seen), proceed, told, &mut turned);
        }
        for step in 0..self.agents.len() {
            let train = (step + self.turn) % self.agents.len();
            if self.is_ready(train, now_ms) {
                self.send(train, now_ms, told);
            }
        }
        turned
    }

    fn follow(
        &mut self,
        train: usize,
        (now_ms, seen): (u64, Seen),
        proceed: &[Routes],
        told: &mut dyn FnMut(What),
        turned: &mut Vec<usize>,
    ) {
        let line = self.line;
        let agent = &mut self.agents[train];
        if let Some(watch) = &mut agent.watch {
            if line.stations[watch.station].paths[watch.route].contains(&seen.front) {
                agent.watch = None;
            } else if proceed[watch.station].meets(Routes::nth(watch.route)) {
                watch.since_ms = now_ms;
            } else if now_ms - watch.since_ms > PATIENCE_MS {
                let (station, id) = (watch.station, route_id(watch.route));
                agent.jobs.push_front(Job { station, request: Request::Set(id) });
                agent.jobs.push_front(Job { station, request: Request::Withdraw(id) });
                agent.watch = None;
            }
        }
        let (Phase::Runs, Some((station, track))) = (agent.phase, agent.target) else { return };
        let bound = agent.bound;
        let own = &line.stations[agent.at.0].platforms[agent.at.1].circuits;
        if agent.holds && !own.contains(&seen.front) && !own.contains(&seen.tail) {
            agent.holds = false;
            self.owners[agent.at.0][agent.at.1] = None;
        }
        let there = &line.stations[station].platforms[track];
        let Some(link) = self.link(self.agents[train].at.0, bound) else { return };
        let first = self.sections[link].trains.first() == Some(&train);
        let agent = &mut self.agents[train];
        if !agent.entry_asked && first && line.links[link].circuits.contains(&seen.front) {
            agent.entry_asked = true;
            if let Some(route) = there.arrive[bound.other().side()] {
                agent.jobs.push_back(Job { station, request: Request::Set(route_id(route)) });
            }
        }
        if there.circuits.contains(&seen.front) && there.circuits.contains(&seen.tail) && seen.stands {
            *agent = Agent {
                at: (station, track),
                target: None,
                phase: Phase::Waits(now_ms + u64::from(line.dynamics.dwell_s) * 1000),
                holds: true,
                entry_asked: false,
                jobs: VecDeque::new(),
                again_ms: 0,
                watch: None,
                bound,
            };
            self.sections[link].trains.retain(|other| *other != train);
            told(What::Arrived { train, station: line.stations[station].name.clone(), track: there.name.clone() });
            if self.link(station, bound).is_none() {
                self.agents[train].bound = bound.other();
                turned.push(train);
                // A train that goes back never leaves the route at its end, which would release it.
                if let Some(route) = there.arrive[bound.other().side()] {
                    self.agents[train].jobs.push_back(Job { station, request: Request::Withdraw(route_id(route)) });
                }
            }
        }
    }

    /// Sends a train to the next station, if a track and the line are free for it.
    fn send(&mut self, train: usize, now_ms: u64, told: &mut dyn FnMut(What)) {
        let Agent { bound, at: (station, track), .. } = self.agents[train];
        let Some(link) = self.link(station, bound) else { return };
        let Some(target) = self.free_track(station, bound) else { return };
        let opposite = |other: &usize| {
            let agent = &self.agents[*other];
            agent.bound != bound
                && self.link(agent.at.0, agent.bound) == Some(link)
                && self.is_ready(*other, now_ms)
                && self.free_track(agent.at.0, agent.bound).is_some()
        };
        let waits = (0..self.agents.len()).any(|other| opposite(&other));
        let section = &self.sections[link];
        let enough = waits && section.in_a_row >= IN_A_ROW && section.bound == Some(bound);
        let free = section.trains.is_empty() || section.bound == Some(bound);
        if enough || !free {
            return;
        }
        let section = &mut self.sections[link];
        if section.bound == Some(bound) {
            section.in_a_row += 1;
        } else {
            section.bound = Some(bound);
            section.in_a_row = 1;
            told(What::Turned { line: link, bound });
        }
        section.trains.push(train);
        self.turn = train + 1;
        self.owners[target.0][target.1] = Some(train);
        let mut jobs = self.turning(link, bound);
        if let Some(route) = self.line.stations[station].platforms[track].depart[bound.side()] {
            jobs.push_back(Job { station, request: Request::Set(route_id(route)) });
        }
        let agent = &mut self.agents[train];
        (agent.target, agent.phase) = (Some(target), Phase::Runs);
        agent.jobs.append(&mut jobs);
        told(What::Left { train, station: self.line.stations[station].name.clone(), bound });
    }

    /// What gives a line its direction.
    fn turning(&self, link: usize, bound: Bound) -> VecDeque<Job> {
        let (segments, west) = (self.line.links[link].segments, self.line.links[link].west);
        let (from, to) = if bound == Bound::East { (0, 1) } else { (1, 0) };
        let job = |side: usize, travel: Travel| {
            let segment = SegmentId::new(u8::try_from(segments[side]).unwrap_or(0)).unwrap_or(SegmentId::ZERO);
            Job { station: west + side, request: Request::Turn(segment, travel) }
        };
        VecDeque::from([job(to, Travel::Toward), job(from, Travel::Away)])
    }

    /// Whether a train that is to leave before this one is still at its track.
    fn is_behind(&self, train: usize) -> bool {
        let mine = |section: &&Section| section.trains.contains(&train);
        let Some(section) = self.sections.iter().find(mine) else { return false };
        section.trains.iter().take_while(|other| **other != train).any(|other| self.agents[*other].holds)
    }

    /// What is asked of each station in this cycle.
    pub fn requests(&mut self, now_ms: u64) -> Vec<Option<Request>> {
        self.asked.fill(None);
        let mut requests = vec![None; self.asked.len()];
        for (train, agent) in self.agents.iter().enumerate() {
            let Some(job) = agent.jobs.front().filter(|_| agent.again_ms <= now_ms) else { continue };
            if job.station == agent.at.0 && matches!(job.request, Request::Set(_)) && self.is_behind(train) {
                continue;
            }
            if requests[job.station].is_none() {
                requests[job.station] = Some(job.request);
                self.asked[job.station] = Some(train);
            }
        }
        requests
    }

    /// What became of the request to `station`; the route that was accepted, if one was.
    pub fn answered(&mut self, now_ms: u64, station: usize, answer: Option<Result<(), Refusal>>) -> Option<usize> {
        let train = self.asked[station]?;
        let bound = self.agents[train].bound;
        let agent = &mut self.agents[train];
        let job = *agent.jobs.front()?;
        match (answer?, job.request) {
            (Ok(()), Request::Set(route)) => {
                agent.jobs.pop_front();
                let route = usize::from(route.number());
                agent.watch = Some(Watch { station, route, since_ms: now_ms });
                return Some(route);
            }
            (Ok(()), _) | (Err(Refusal::NotHeld), Request::Withdraw(_)) => {
                agent.jobs.pop_front();
            }
            (Err(refusal), request) => {
                agent.again_ms = now_ms + AGAIN_MS;
                // A device that started anew has forgotten the direction.
                let forgotten = refusal == Refusal::Direction && matches!(request, Request::Set(_));
                let (at, target) = (agent.at.0, agent.target.filter(|_| forgotten && agent.jobs.len() < 3));
                if let Some(((to, _), link)) = target.zip(self.link(at, bound)) {
                    let mut jobs = self.turning(link, bound);
                    if station == to {
                        jobs.truncate(1);
                    }
                    let agent = &mut self.agents[train];
                    jobs.append(&mut agent.jobs);
                    agent.jobs = jobs;
                }
            }
        }
        None
    }
}

fn route_id(route: usize) -> RouteId {
    RouteId::new(u8::try_from(route).unwrap_or(0)).unwrap_or(RouteId::ZERO)
}
