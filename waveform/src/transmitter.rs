//! From what the ground wants to say to samples: telegrams, one after the other, and codes (SIG-2).

use atc_kernel::telegram::{Counter, FRAME_BITS, Main, Sub, Telegram, encode};

use crate::config::{Codes, TransmitterConfig};
use crate::generator::Generator;

/// The endless bits of one telegram, sent again and again; each time the counter is one higher.
#[derive(Clone, Debug)]
pub struct TelegramBits {
    telegram: Telegram,
    bits: u128,
    left: u32,
}

impl TelegramBits {
    /// Starts with this telegram, its counter as it stands there.
    pub fn new(telegram: Telegram) -> Self {
        Self { telegram, bits: encode(telegram).bits(), left: FRAME_BITS }
    }

    /// Sends this from the next telegram on; the telegram in progress is finished, and the counter runs on.
    pub fn set(&mut self, telegram: Telegram) {
        let counter = counter(self.telegram);
        self.telegram = with_counter(telegram, counter);
    }

    /// The telegram in progress, or after [`set`](Self::set) what follows it, with the counter of the one in progress.
    pub fn telegram(&self) -> Telegram {
        self.telegram
    }
}

impl Iterator for TelegramBits {
    type Item = bool;

    fn next(&mut self) -> Option<bool> {
        if self.left == 0 {
            let next = Counter(counter(self.telegram).0.wrapping_add(1));
            self.telegram = with_counter(self.telegram, next);
            self.bits = encode(self.telegram).bits();
            self.left = FRAME_BITS;
        }
        self.left -= 1;
        Some(self.bits >> self.left & 1 == 1)
    }
}

/// The counter of a telegram of either kind.
pub fn counter(telegram: Telegram) -> Counter {
    match telegram {
        Telegram::Main(main) => main.counter,
        Telegram::Sub(sub) => sub.counter,
    }
}

fn with_counter(telegram: Telegram, counter: Counter) -> Telegram {
    match telegram {
        Telegram::Main(main) => Telegram::Main(Main { counter, ..main }),
        Telegram::Sub(sub) => Telegram::Sub(Sub { counter, ..sub }),
    }
}

/// A transmitter of a digital line: telegrams and codes on both carriers.
pub struct Transmitter {
    generator: Generator<TelegramBits, TelegramBits>,
}

impl Transmitter {
    /// Starts with these telegrams and codes.
    pub fn new(config: &TransmitterConfig, codes: Codes, main: Main, sub: Sub) -> Self {
        let main = TelegramBits::new(Telegram::Main(main));
        let sub = TelegramBits::new(Telegram::Sub(sub));
        Self { generator: Generator::new(config, codes, main, sub) }
    }

    /// Changes the main telegram; the one in progress is finished, and the counter runs on.
    pub fn set_main(&mut self, main: Main) {
        self.generator.main_bits().set(Telegram::Main(main));
    }

    /// Changes the sub telegram; the one in progress is finished, and the counter runs on.
    pub fn set_sub(&mut self, sub: Sub) {
        self.generator.sub_bits().set(Telegram::Sub(sub));
    }

    /// Changes the codes from the next sample on.
    pub fn set_codes(&mut self, codes: Codes) {
        self.generator.set_codes(codes);
    }

    /// The next samples. Allocates nothing.
    pub fn fill(&mut self, block: &mut [f32]) {
        self.generator.fill(block);
    }

    /// The generator below, for what only tests and measurements change.
    pub fn generator(&mut self) -> &mut Generator<TelegramBits, TelegramBits> {
        &mut self.generator
    }
}
