//! Points that take time: where each lies, and whether it moves.

use super::ground::Ground;

/// One point.
#[derive(Clone, Copy, Debug)]
struct Blade {
    /// The position that it lies in, or moves to; `true` is reverse.
    reverse: bool,
    /// The cycles that its stroke yet takes; 0 if it is at rest.
    left: i64,
    /// A command that takes effect after so many reports more.
    late: Option<(bool, i64)>,
    /// Whether commands take effect a cycle late.
    slow: bool,
    /// The time of its stroke.
    throw: i64,
    /// For how many cycles yet its detection is lost.
    blind: i64,
    /// The cycles since it was driven last.
    driven: i64,
}

/// All points.
#[derive(Clone, Debug, Default)]
pub struct Points {
    blades: Vec<Blade>,
    /// The longest time after a drive at which a point has left its position.
    pub latest: i64,
}

impl Points {
    /// All points at rest in normal; bit `i` of `slow` says that point `i`, and each 32nd after it, takes a command a cycle late.
    pub fn at_rest(ground: &Ground, slow: u32, throw_percent: i64) -> Self {
        let blades = ground.throw.iter().enumerate().map(|(number, throw)| Blade {
            reverse: false,
            left: 0,
            late: None,
            slow: slow >> (number % 32) & 1 == 1,
            throw: (throw * throw_percent / 100).max(1),
            blind: 0,
            driven: i64::MAX / 2,
        });
        Self { blades: blades.collect(), latest: 0 }
    }

    /// Where the point lies, or goes.
    pub fn lies(&self, point: usize) -> bool {
        self.blades[point].reverse
    }

    /// Whether it rests in that position.
    pub fn rests(&self, point: usize, reverse: bool) -> bool {
        self.blades[point].left == 0 && self.blades[point].reverse == reverse
    }

    /// Whether it is in its stroke.
    pub fn moves(&self, point: usize) -> bool {
        self.blades[point].left > 0
    }

    /// Its detection is lost for so many cycles.
    pub fn blind(&mut self, point: usize, cycles: i64) {
        self.blades[point].blind = cycles;
    }

    /// A cycle passes.
    pub fn pass(&mut self) {
        for blade in &mut self.blades {
            blade.blind = (blade.blind - 1).max(0);
            blade.driven += 1;
            if blade.left > 0 {
                blade.left -= 1;
            } else if let Some((reverse, reports)) = blade.late {
                blade.late = (reports > 0).then_some((reverse, reports - 1));
                if reports == 0 {
                    // It leaves in the cycle after the drive, after that cycle's report (`points-leave-while-driven`).
                    self.latest = self.latest.max(blade.driven - 1);
                    (blade.reverse, blade.left) = (reverse, blade.throw);
                }
            }
        }
    }

    /// The device drives: `drives` are the points to normal, and to reverse.
    pub fn drive(&mut self, drives: [u64; 2]) {
        for (number, blade) in self.blades.iter_mut().enumerate() {
            let wanted = match (drives[0] >> number & 1, drives[1] >> number & 1) {
                (1, 0) => false,
                (0, 1) => true,
                _ => continue,
            };
            blade.driven = 0;
            if blade.reverse == wanted {
                continue;
            }
            if blade.slow && blade.left == 0 {
                blade.late = blade.late.or(Some((wanted, 1)));
            } else {
                (blade.reverse, blade.left) = (wanted, blade.throw);
            }
        }
    }

    /// The points that are detected normal, and reverse: only at rest (`points-detect-truly`).
    pub fn detected(&self) -> [u64; 2] {
        let mut detected = [0, 0];
        for (number, blade) in self.blades.iter().enumerate() {
            if blade.left == 0 && blade.blind == 0 {
                detected[usize::from(blade.reverse)] |= 1 << number;
            }
        }
        detected
    }
}
