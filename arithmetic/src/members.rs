//! Sets of any size.

#[cfg(creusot)]
use creusot_std::prelude::{View, ensures, invariant};

/// The lowest member of a set of any size, given as a flag for each rank: the first that is set.
///
/// The kernel's bit trick (`AspectSet::lowest`) is shown equal to this for 16 ranks (theorem SET-1); this is for any number.
#[cfg_attr(creusot, ensures(match result {
    Some(rank) => rank@ < members@.len() && members@[rank@]
        && (forall<i> 0 <= i && i < rank@ ==> !members@[i]),
    None => forall<i> 0 <= i && i < members@.len() ==> !members@[i],
}))]
pub fn lowest_member(members: &[bool]) -> Option<usize> {
    let mut rank = 0;
    #[cfg_attr(creusot, invariant(rank@ <= members@.len()))]
    #[cfg_attr(creusot, invariant(forall<i> 0 <= i && i < rank@ ==> !members@[i]))]
    while rank < members.len() {
        if members[rank] {
            return Some(rank);
        }
        rank += 1;
    }
    None
}
