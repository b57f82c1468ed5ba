//! Numbers for runs that are drawn.

/// Numbers that look drawn: the same on every machine.
pub struct Drawn(pub u64);

impl Drawn {
    /// One of so many.
    pub fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).expect("31 bits") % count
    }
}
