//! Which kinds of fault together let trains meet.

use super::{CountedBetween};
use crate::check::Limits;
use crate::outcome::CutSet;

pub(super) fn enumerate<const B: usize>(_model: &CountedBetween<B>, _limits: Limits) -> Option<Vec<CutSet>> {
    Some(Vec::new())
}
