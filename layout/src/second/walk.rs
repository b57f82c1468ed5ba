//! A train runs over the net elements, in metres, from a signal to an exit.

use std::collections::BTreeMap;

use super::file::{Branch, Divider, File, Spot};

/// How many ways are followed before a file is said to be unclear.
const MOST: usize = 256;

/// How far in rear of a signal a joint may lie that belongs to it, in metres.
pub const OFFSET: f64 = 20.0;
/// A joint so many metres in rear of a signal is at it.
pub const NEAR: f64 = 1.0;

/// A way that a train can run.
#[derive(Clone, Debug, Default)]
pub struct Walk<'a> {
    /// What it passes that divides the tracks, with metres from the signal: less than 0 in rear of it.
    pub dividers: Vec<(Divider<'a>, f64)>,
    /// The branches of switches that it runs over, with metres from the signal.
    pub branches: Vec<(Branch<'a>, f64)>,
    /// The stretches of net elements that it runs over: begin, end, and metres from the signal to where it enters.
    pub stretches: Vec<(&'a str, f64, f64, f64)>,
    /// Metres from the signal to its exit.
    pub exit: Option<f64>,
    /// Metres to the end of the tracks or to a buffer stop, if it comes there, and its net element and place.
    pub end: Option<(f64, (&'a str, f64))>,
}

/// Which branch a file asks of a switch: by relation, if several may be meant.
pub type Asked<'a> = BTreeMap<&'a str, Vec<&'a str>>;

/// Every way from a signal, in a direction, to the exit and on to what divides the tracks there.
///
/// # Errors
/// There are too many.
pub fn walks<'a>(
    file: &File<'a>,
    from: Spot<'a>,
    toward_end: bool,
    exit: Option<Spot<'a>>,
    longest: usize,
    asked: &Asked<'a>,
) -> Result<Vec<Walk<'a>>, ()> {
    let mut search = Search { file, exit, longest, asked, found: Vec::new(), steps: 0 };
    let length = file.lengths.get(from.element).copied().unwrap_or(0.0);
    let back = (if toward_end { from.at } else { length - from.at }).min(OFFSET);
    let at = if toward_end { from.at - back } else { from.at + back };
    search.go((from.element, at, toward_end), -back, &mut Walk::default(), &mut Vec::new())?;
    Ok(search.found)
}

struct Search<'a, 'b> {
    file: &'b File<'a>,
    exit: Option<Spot<'a>>,
    /// How many sections a way may have where no exit ends it.
    longest: usize,
    asked: &'b Asked<'a>,
    found: Vec<Walk<'a>>,
    steps: usize,
}

impl<'a> Search<'a, '_> {
    fn go(
        &mut self,
        (element, at, toward_end): (&'a str, f64, bool),
        run: f64,
        walk: &mut Walk<'a>,
        seen: &mut Vec<(&'a str, bool)>,
    ) -> Result<(), ()> {
        self.steps += 1;
        if self.steps > 20_000 || self.found.len() > MOST {
            return Err(());
        }
        let length = self.file.lengths.get(element).copied().unwrap_or(0.0);
        if seen.iter().any(|(other, _)| *other == element) {
            return Ok(());
        }
        seen.push((element, toward_end));
        let mut here = walk.clone();
        let ahead = |place: f64| if toward_end { place - at } else { at - place };
        // At a buffer stop beyond its signal a train comes to an end, wherever that stands.
        let buffer = self.file.stop_ahead(element, at, toward_end, (0.001 - run).max(-0.001));
        let room = buffer.unwrap_or(f64::MAX) + 0.001;
        let to = match buffer {
            Some(buffer) if toward_end => at + buffer,
            Some(buffer) => at - buffer,
            None if toward_end => length,
            None => 0.0,
        };
        here.stretches.push((element, at.min(to), at.max(to), run));
        let is_here = |exit: &Spot<'_>| exit.element == element && (-0.001..=room).contains(&ahead(exit.at));
        if let Some(exit) = self.exit.filter(is_here) {
            // In rear of the signal there is no exit for it.
            if run + ahead(exit.at) > 0.0 {
                here.exit = Some(run + ahead(exit.at));
            }
        }
        let mut dividers: Vec<(Divider<'a>, f64)> =
            self.file.dividers.get(element).into_iter().flatten().map(|one| (one.clone(), ahead(one.at))).collect();
        dividers.retain(|(_, distance)| (-0.001..=room).contains(distance));
        dividers.sort_by(|one, other| one.1.total_cmp(&other.1));
        for (divider, distance) in dividers {
            here.dividers.push((divider, run + distance));
            let is_over = match (here.exit, self.exit) {
                (Some(exit), _) => run + distance >= exit - NEAR,
                (None, Some(_)) => false,
                (None, None) => here.dividers.len() > self.longest,
            };
            if is_over {
                self.found.push(here);
                seen.pop();
                return Ok(());
            }
        }
        let run = run + ahead(to);
        let onward = self.file.onward.get(&(element, toward_end)).cloned().unwrap_or_default();
        if onward.is_empty() || buffer.is_some() {
            here.end = Some((run, (element, to)));
            if here.exit.is_some() || self.exit.is_none() {
                self.found.push(here);
            }
            seen.pop();
            return Ok(());
        }
        for ((next, at_its_end), relation) in onward {
            let branch = self.file.branches.get(relation).copied();
            let asked = branch.and_then(|branch| self.asked.get(branch.switch));
            if asked.is_some_and(|asked| !asked.contains(&relation)) {
                continue;
            }
            let mut further = here.clone();
            further.branches.extend(branch.map(|branch| (branch, run)));
            let begin = if at_its_end { self.file.lengths.get(next).copied().unwrap_or(0.0) } else { 0.0 };
            self.go((next, begin, !at_its_end), run, &mut further, seen)?;
        }
        seen.pop();
        Ok(())
    }
}
