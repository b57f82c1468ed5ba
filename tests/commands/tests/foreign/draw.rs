//! Numbers that look drawn at random, the same for the same seed (splitmix64).

pub struct Draw(u64);

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From `least` to `most`, both included.
    pub fn from(&mut self, least: i64, most: i64) -> i64 {
        let count = u64::try_from(most - least).expect("a range") + 1;
        least + i64::try_from(self.next() % count).expect("within the range")
    }

    /// True `per_thousand` times out of a thousand.
    pub fn chance(&mut self, per_thousand: i64) -> bool {
        self.from(0, 999) < per_thousand
    }

    pub fn one<T: Clone>(&mut self, of: &[T]) -> T {
        let last = i64::try_from(of.len()).expect("a list") - 1;
        of[usize::try_from(self.from(0, last)).expect("a place")].clone()
    }

    /// The ends of a range and their neighbours as often as all between.
    pub fn edge(&mut self, least: i64, most: i64) -> i64 {
        let between = self.from(least, most);
        let more = self.from(least, most);
        self.one(&[least, most, least + 1, most - 1, between, more])
    }
}
