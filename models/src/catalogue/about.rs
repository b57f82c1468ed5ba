//! What is said about a model, and lists of conditions.

use crate::check::About;

/// What a model assumes, and what it lifts.
pub(super) type Conditions = (&'static [&'static str], &'static [&'static str]);

/// What a model of this name is about.
pub(super) fn about(
    name: &'static str,
    statement: &str,
    environment: &str,
    requirements: &'static [&'static str],
    (in_force, lifted): Conditions,
) -> About {
    About { name, statement: statement.to_owned(), requirements, environment: environment.to_owned(), in_force, lifted }
}

/// The names of one list, and then those of another.
pub(super) const fn joined<const A: usize, const B: usize, const C: usize>(
    one: [&'static str; A],
    other: [&'static str; B],
) -> [&'static str; C] {
    assert!(A + B == C);
    let mut all = [""; C];
    let mut place = 0;
    while place < C {
        all[place] = if place < A { one[place] } else { other[place - A] };
        place += 1;
    }
    all
}

/// All conditions but the one at `place`. `M` is one less than `N`.
pub(super) const fn all_but<const N: usize, const M: usize>(all: [&'static str; N], place: usize) -> [&'static str; M] {
    let mut kept = [""; M];
    let mut next = 0;
    while next < M {
        kept[next] = all[if next < place { next } else { next + 1 }];
        next += 1;
    }
    kept
}
