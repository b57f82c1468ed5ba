//! Speed, in tenths of a kilometre an hour.

/// A speed that has been checked: tenths of km/h, never negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct KmhTenths(pub u16);

/// A speed as a sensor or a telegram delivers it: tenths of km/h, not yet known to be plausible, perhaps negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct RawKmhTenths(pub i32);
