//! Numbers that look random and are the same for the same seed, on every machine and in every version.
//!
//! A library's generator may change with its version; a seed in a report, and the identity of a vector, may not.

/// The generator SplitMix64 (Steele, Lea, Flood, 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The numbers of a seed.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The numbers of a seed for one purpose, which is named, and for one place in it.
    pub fn of(seed: u64, purpose: &str, place: u64) -> Self {
        let mut random = Self(seed);
        for byte in purpose.bytes() {
            random.0 = random.0.rotate_left(8) ^ u64::from(byte);
            random.0 = random.number();
        }
        random.0 ^= place.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        Self(random.number())
    }

    /// The next number.
    pub const fn number(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number from the first to the last, both included; the first if they are in the wrong order.
    pub fn between(&mut self, first: i64, last: i64) -> i64 {
        let count = last.saturating_sub(first).saturating_add(1);
        let count = u64::try_from(count).unwrap_or(1).max(1);
        first.saturating_add(i64::try_from(self.number() % count).unwrap_or(0))
    }

    /// A place in something of this length, which must not be 0.
    pub fn below(&mut self, length: usize) -> usize {
        usize::try_from(self.number() % (length.max(1) as u64)).unwrap_or(0)
    }

    /// True once in so many times.
    pub const fn one_in(&mut self, times: u64) -> bool {
        times == 0 || self.number().is_multiple_of(times)
    }

    /// One of these, which must not be none.
    pub fn pick<'a, T>(&mut self, items: &'a [T]) -> Option<&'a T> {
        if items.is_empty() { None } else { items.get(self.below(items.len())) }
    }

    /// One of these numbers.
    pub fn one_of(&mut self, numbers: &[i64]) -> i64 {
        self.pick(numbers).copied().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::Random;

    /// The first numbers of seed 0, as the authors' program gives them. If they change, old seeds say nothing.
    #[test]
    fn the_numbers_are_those_of_the_authors() {
        let mut random = Random::new(0);
        let numbers = [random.number(), random.number(), random.number()];
        assert_eq!(numbers, [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f]);
    }

    #[test]
    fn ranges_hold() {
        let mut random = Random::of(7, "ranges", 3);
        let mut seen = [false; 3];
        for _ in 0..200 {
            let number = random.between(-1, 1);
            seen[usize::try_from(number + 1).expect("within the range")] = true;
        }
        assert_eq!(seen, [true; 3]);
        assert_eq!(random.between(5, 4), 5);
        assert_eq!(random.pick::<u8>(&[]), None);
    }
}
