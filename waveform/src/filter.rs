//! What the filters share: the last samples in one piece, a weighted sum, and the sinc function.

use std::f64::consts::PI;

/// The last samples, kept twice so that they always lie in one piece.
#[derive(Clone, Debug)]
pub(crate) struct Recent {
    samples: Box<[f32]>,
    next: usize,
}

impl Recent {
    /// Silence, `length` samples of it, at least 1.
    pub fn new(length: usize) -> Self {
        Self { samples: vec![0.0; 2 * length].into(), next: 0 }
    }

    pub fn push(&mut self, sample: f32) {
        let length = self.samples.len() / 2;
        self.samples[self.next] = sample;
        self.samples[self.next + length] = sample;
        self.next = (self.next + 1) % length;
    }

    /// Oldest first.
    pub fn window(&self) -> &[f32] {
        &self.samples[self.next..self.next + self.samples.len() / 2]
    }
}

/// Partial sums, so that the compiler can use vector instructions.
const LANES: usize = 8;

/// The sum of the products of two lists of one length.
pub(crate) fn dot(a: &[f32], b: &[f32]) -> f32 {
    let (a_chunks, b_chunks) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let tail: f32 = a_chunks.remainder().iter().zip(b_chunks.remainder()).map(|(x, y)| x * y).sum();
    let mut sums = [0.0_f32; LANES];
    for (x, y) in a_chunks.zip(b_chunks) {
        for lane in 0..LANES {
            sums[lane] += x[lane] * y[lane];
        }
    }
    sums.iter().sum::<f32>() + tail
}

/// sin πx / πx.
pub(crate) fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) }
}
