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
    InUse(u16),
    Releasing(u16),
}

/// The circuits before a route where a train may still be that may enter it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Behind {
    /// Any of the approach.
    Approach,
    /// The entry.
    Entry,
    /// None.
    Nothing,
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
    pub behind: Behind,
}

impl Held {
    pub(super) fn idle(way: &Way) -> Self {
        let places = vec![Place::Ahead; way.path.len()];
        Self { stage: Stage::Idle, once_set: false, places, overlap: false, stood: 0, behind: Behind::Entry }
    }

    pub fn is_held(&self) -> bool {
        self.stage != Stage::Idle
    }

    /// Whether it was withdrawn when its train was in it already: then it may be asked for once more.
    pub(super) fn may_go_on(&self) -> bool {
        matches!(self.stage, Stage::Releasing(_)) && self.places.first().is_some_and(|place| *place != Place::Ahead)
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
        self.stage = match self.stage {
            Stage::Set if meets(&self.path(way), occupied) => Stage::InUse(0),
            Stage::InUse(time) => Stage::InUse((time + 1).min(way.release)),
            Stage::Releasing(time) => Stage::Releasing((time + 1).min(way.release)),
            Stage::Set => Stage::Set,
            Stage::Idle | Stage::Provisional(_) | Stage::Failed => return,
        };
        if self.once_set {
            self.look_back(way, occupied);
            self.follow_train(way, occupied);
        }
        let never_used = self.places.iter().all(|place| *place == Place::Ahead);
        let all = if way.calling_on && never_used { self.path(way) } else { self.circuits(way) };
        let over = self.stage == Stage::Releasing(way.release) && !meets(&all, occupied);
        if over || self.is_behind() && !self.overlap {
            *self = Self::idle(way);
        }
    }

    /// Where trains may be that may still come in: seen while the route is set, and swept after that.
    pub(super) fn look_back(&mut self, way: &Way, occupied: &Set) {
        let waits = super::waits(way, occupied);
        let at_signal = occupied.contains(&way.entry);
        match self.stage {
            Stage::InUse(time) | Stage::Releasing(time) => {
                if !waits && self.behind == Behind::Approach {
                    self.behind = Behind::Entry;
                }
                if time == way.release || !at_signal && self.behind == Behind::Entry {
                    self.behind = Behind::Nothing;
                }
            }
            _ if !way.cab => self.behind = Behind::Approach,
            _ if !waits => self.behind = Behind::Entry,
            _ if !at_signal => self.behind = Behind::Approach,
            _ => {}
        }
    }

    /// Whether the whole path is behind the train.
    fn is_behind(&self) -> bool {
        self.places.iter().all(|place| *place == Place::Released)
    }

    fn follow_train(&mut self, way: &Way, occupied: &Set) {
        if let Some(next) = self.places.iter().position(|place| *place == Place::Ahead) {
            let behind = if next == 0 { way.entry } else { way.path[next - 1].0 };
            let follows = occupied.contains(&behind) || way.calling_on && next == 0;
            if occupied.contains(&way.path[next].0) && follows {
                self.places[next] = Place::Entered;
            }
        }
        let first = self.places.iter().position(|place| *place != Place::Released);
        let swept = self.behind == Behind::Nothing;
        if let Some(first) = first.filter(|first| swept && self.places[*first] == Place::Entered) {
            let gone_on = match self.places.get(first + 1) {
                Some(next) => *next == Place::Entered,
                None => meets(&way.beyond, occupied),
            };
            if gone_on && !occupied.contains(&way.path[first].0) {
                self.places[first] = Place::Released;
            }
        }
        let only_last = self.places.iter().rev().skip(1).all(|place| *place == Place::Released);
        let came_in = way.path.len() > 1 || self.stood > 0 || !occupied.contains(&way.entry);
        let there = self.places.last() == Some(&Place::Entered) && occupied.contains(&way.last());
        let standing = swept && only_last && came_in && there && self.overlap && !way.calling_on;
        self.stood = if standing { (self.stood + 1).min(way.stay) } else { 0 };
        if (self.stood >= way.stay || self.is_behind()) && !meets(&way.overlap.0, occupied) {
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
