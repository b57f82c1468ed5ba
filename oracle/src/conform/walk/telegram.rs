//! Walks of `telegram-codec`: telegrams at the limits of their fields, frames with wrong bits, and frames in a stream.

use serde_json::{Value, json};

use super::source::{Source, Walk};
use crate::conform::random::Random;

pub(super) const SOURCE: Source =
    Source { machine: "telegram-codec", small, large: small, wrong, begin, most: (40, 40), own: 40 };

fn small() -> Vec<Value> {
    vec![json!({})]
}

fn wrong() -> Vec<Value> {
    Vec::new()
}

#[derive(Default)]
struct Codec {
    /// Frames that the kernel has made in this walk.
    frames: Vec<Vec<u8>>,
    /// What of a frame has not been sent yet.
    rest: Vec<u8>,
}

fn begin(_: &Value, _: &Value, _: &mut Random) -> Box<dyn Walk> {
    Box::<Codec>::default()
}

fn telegram(random: &mut Random) -> Value {
    let number = random.between(0, 65_535);
    let section = random.one_of(&[0, 1, 255, 256, 65_535, number]);
    let counter = random.one_of(&[0, 1, 127, 128, 255]);
    let distance = random.one_of(&[0, 1, 400, 65_534, 65_535]);
    let rank = random.between(0, 15);
    if random.one_in(2) {
        let beyond = if random.one_in(4) { Value::Null } else { distance.into() };
        json!({"main": {"section": section, "counter": counter, "beyond_exit_m": beyond, "speed_rank": rank}})
    } else {
        let (length, gradient) = (distance.max(1), random.one_of(&[-128, -12, -1, 0, 1, 35, 127]));
        let other = random.between(0, 15);
        json!({"sub": {
            "section": section, "counter": counter, "length_m": length, "gradient_permille": gradient,
            "curve_rank": rank, "restriction_rank": other,
        }})
    }
}

fn text(bits: &[u8]) -> String {
    String::from_utf8_lossy(bits).into_owned()
}

impl Codec {
    /// A frame: as it was made, with up to four wrong bits, with wrong bits next to each other, or the sum of three, whose check is
    /// right again, for contents that no telegram has.
    fn frame(&self, random: &mut Random) -> Vec<u8> {
        let Some(mut frame) = random.pick(&self.frames).cloned() else { return vec![b'0'; 106] };
        let flip = |frame: &mut Vec<u8>, place: usize| {
            if let Some(bit) = frame.get_mut(place) {
                *bit ^= 1;
            }
        };
        match random.below(6) {
            0 => {
                for _ in 0..=random.below(4) {
                    flip(&mut frame, random.below(106));
                }
            }
            1 => {
                let first = random.below(106);
                (first..first + random.below(18)).for_each(|place| flip(&mut frame, place));
            }
            2 => {
                for _ in 0..2 {
                    if let Some(other) = random.pick(&self.frames) {
                        frame.iter_mut().zip(other).for_each(|(bit, other)| *bit ^= other & 1);
                    }
                }
            }
            _ => {}
        }
        frame
    }

    fn stream(&mut self, random: &mut Random) -> Vec<u8> {
        let mut bits = std::mem::take(&mut self.rest);
        if bits.is_empty() {
            match random.below(6) {
                0 => bits.extend((0..random.below(20)).map(|_| if random.one_in(2) { b'1' } else { b'0' })),
                1 => bits.extend(std::iter::repeat_n(b'1', random.below(20))),
                2 => bits.push(b'.'),
                _ => {}
            }
            let mut frame = self.frame(random);
            if random.one_in(4) {
                // Its first bits are not heard: what stands in their place may be nothing, or what went before.
                frame.drain(..=random.below(3));
            }
            bits.extend(frame);
            match random.below(9) {
                3 => {
                    let at = random.below(bits.len());
                    bits[at] = b'.';
                }
                0 => bits.insert(random.below(bits.len()), b'.'),
                1 => drop(bits.remove(random.below(bits.len()))),
                2 => bits.extend(self.frame(random)),
                _ => {}
            }
        }
        if random.one_in(2) {
            self.rest = bits.split_off(random.below(bits.len()));
        }
        bits
    }
}

impl Walk for Codec {
    fn next(&mut self, random: &mut Random, last: Option<&Value>) -> Value {
        if let Some(frame) = last.and_then(|last| last["frame"].as_str()) {
            self.frames.push(frame.as_bytes().to_vec());
        }
        if self.frames.is_empty() || random.one_in(3) {
            return json!({"encode": telegram(random)});
        }
        if random.one_in(2) {
            json!({"decode": text(&self.frame(random))})
        } else {
            json!({"bits": text(&self.stream(random))})
        }
    }
}
