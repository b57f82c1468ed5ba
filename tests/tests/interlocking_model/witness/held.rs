//! A route: what it holds, and how it follows its train.

use atc_tests::sketch::{Need, Way};

use super::{Set, meets};

/// What is known of one place of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Place {
    Ahead,
    Entered,
    Released,
}

/// The phase of a route, with the time that has passed in it where that matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    Idle,
    Provisional(u16),
    Failed,
    Set,
    InUse,
    Releasing(u16),
}

/// A route.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Held {
    pub stage: Stage,
    /// Whether it has been set since it was reserved. If not, no train may use it, and it follows none.
    pub once_set: bool,
    pub places: Vec<Place>,
    pub overlap: bool,
    pub stood: u16,
}

impl Held {
    pub(super) fn idle(way: &Way) -> Self {
        let places = vec![Place::Ahead; way.path.len()];
        Self { stage: Stage::Idle, once_set: false, places, overlap: false, stood: 0 }
    }

    pub fn is_held(&self) -> bool {
        self.stage != Stage::Idle
    }

    /// The places of the path that are still held.
    pub(super) fn kept<'a>(&'a self, way: &'a Way) -> impl Iterator<Item = &'a (usize, Vec<Need>)> {
        let kept = way.path.iter().zip(&self.places).filter(|(_, place)| self.is_held() && **place != Place::Released);
        kept.map(|(element, _)| element)
    }

    pub fn path(&self, way: &Way) -> Vec<usize> {
        self.kept(way).map(|element| element.0).collect()
    }

    pub(super) fn overlap<'a>(&self, way: &'a Way) -> &'a [usize] {
        if self.overlap { &way.overlap.0 } else { &[] }
    }

    pub fn circuits(&self, way: &Way) -> Vec<usize> {
        [self.path(way), self.overlap(way).to_vec()].concat()
    }

    pub fn needs(&self, way: &Way) -> Vec<Need> {
        let mut needs: Vec<_> = self.kept(way).flat_map(|element| element.1.clone()).collect();
        if self.overlap {
            needs.extend(&way.overlap.1);
        }
        needs
    }

    /// The train moves on by at most one place at either end, and time passes.
    pub(super) fn follow(&mut self, way: &Way, occupied: &Set) {
        if !matches!(self.stage, Stage::Set | Stage::InUse | Stage::Releasing(_)) {
            return;
        }
        if self.stage == Stage::Set && meets(&self.path(way), occupied) {
            self.stage = Stage::InUse;
        }
        if self.once_set {
            self.follow_train(way, occupied);
        }
        if let Stage::Releasing(time) = self.stage {
            self.stage = match time + 1 {
                now if now < way.release => Stage::Releasing(now),
                _ if !meets(&self.circuits(way), occupied) => Stage::Idle,
                _ if self.once_set => Stage::InUse,
                _ => Stage::Failed,
            };
        }
        if self.stage == Stage::Idle || self.is_behind() && !self.overlap {
            *self = Self::idle(way);
        }
    }

    /// Whether the whole path is behind the train.
    fn is_behind(&self) -> bool {
        self.places.iter().all(|place| *place == Place::Released)
    }

    fn follow_train(&mut self, way: &Way, occupied: &Set) {
        if let Some(next) = self.places.iter().position(|place| *place == Place::Ahead) {
            let behind = if next == 0 { way.entry } else { way.path[next - 1].0 };
            if occupied.contains(&way.path[next].0) && occupied.contains(&behind) {
                self.places[next] = Place::Entered;
            }
        }
        let first = self.places.iter().position(|place| *place != Place::Released);
        if let Some(first) = first.filter(|first| self.places[*first] == Place::Entered) {
            let gone_on = match self.places.get(first + 1) {
                Some(next) => *next == Place::Entered,
                None => meets(&way.beyond, occupied),
            };
            if gone_on && !occupied.contains(&way.path[first].0) {
                self.places[first] = Place::Released;
            }
        }
        let standing = self.places.last() == Some(&Place::Entered) && occupied.contains(&way.last());
        self.stood = if standing && self.overlap { self.stood + 1 } else { 0 };
        if self.stood >= way.stay || self.is_behind() && !meets(&way.overlap.0, occupied) {
            self.overlap = false;
            self.stood = 0;
        }
    }

    pub(super) fn withdraw(&mut self, way: &Way, occupied: &Set) {
        let path_clear = !meets(&self.path(way), occupied);
        let at_once = match self.stage {
            Stage::Provisional(_) | Stage::Failed => path_clear,
            Stage::Set => path_clear && !meets(&way.approach, occupied),
            _ => false,
        };
        if at_once {
            *self = Self::idle(way);
        } else {
            self.stage = Stage::Releasing(0);
        }
    }
}
