//! Frames against a second description of them: characters, and the check by long division of a polynomial written as a list of
//! bits. And what a frame must survive: every error of one and two bits, a million of three, bursts, and other frames around it.

use atc_kernel::Machine as _;
use atc_kernel::aspect::AspectId;
use atc_kernel::distance::Metres;
use atc_kernel::telegram::{
    Counter, Deframer, FRAME_BITS, Frame, FrameError, Gradient, Length, Main, Reception, Route, SectionId, Sub,
    Telegram, Window, check, check_byte, decode, encode,
};
use proptest::prelude::*;

/// A source of numbers, the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: u32) -> u32 {
        u32::try_from(self.next() % u64::from(end)).expect("less than a u32")
    }

    fn telegram(&mut self) -> Telegram {
        let bytes = self.next().to_le_bytes();
        let other = self.next().to_le_bytes();
        let section = SectionId(u16::from_le_bytes([bytes[0], bytes[1]]));
        let distance = u16::from_le_bytes([bytes[2], bytes[3]]);
        let (counter, rank) = (Counter(bytes[4]), |byte: u8| AspectId::new(byte % 16).expect("a rank"));
        if bytes[7].is_multiple_of(2) {
            let route = if bytes[7].is_multiple_of(4) { Route::Closed } else { Route::OpenFor(Metres(distance)) };
            Telegram::Main(Main { section, counter, route, speed: rank(bytes[5]) })
        } else {
            let length = Length::new(Metres(distance.max(1))).expect("not 0");
            let gradient = Gradient(i8::from_le_bytes([other[0]]));
            Telegram::Sub(Sub {
                section,
                counter,
                length,
                gradient,
                curve: rank(bytes[5]),
                restriction: rank(bytes[6]),
            })
        }
    }
}

/// Bits of a number, the highest first.
fn bits(number: u32, count: u32) -> Vec<bool> {
    (0..count).rev().map(|place| number >> place & 1 == 1).collect()
}

/// The information of a telegram, 64 bits.
fn information(telegram: Telegram) -> Vec<bool> {
    let fields: [(u32, u32); 6] = match telegram {
        Telegram::Main(main) => {
            let (beyond, route) = match main.route {
                Route::Closed => (0, 0x0F),
                Route::OpenFor(distance) => (distance.0, 0xF0),
            };
            let section = main.section.0.into();
            [
                (0x4D, 8),
                (main.counter.0.into(), 8),
                (section, 16),
                (beyond.into(), 16),
                (route, 8),
                (main.speed.rank().into(), 8),
            ]
        }
        Telegram::Sub(sub) => {
            let gradient = u32::try_from(i32::from(sub.gradient.0).rem_euclid(256)).expect("a byte");
            let limits = u32::from(sub.curve.rank()) * 16 + u32::from(sub.restriction.rank());
            let (section, length) = (sub.section.0.into(), sub.length.metres().0.into());
            [(0x53, 8), (sub.counter.0.into(), 8), (section, 16), (length, 16), (gradient, 8), (limits, 8)]
        }
    };
    fields.iter().flat_map(|(number, count)| bits(*number, *count)).collect()
}

/// The remainder of long division by x¹⁶ + x¹² + x⁵ + 1; a start of ones inverts the first 16 bits.
fn remainder(message: &[bool]) -> Vec<bool> {
    let mut rest = message.to_vec();
    rest.extend([false; 16]);
    for bit in rest.iter_mut().take(16) {
        *bit = !*bit;
    }
    for at in 0..message.len() {
        if rest[at] {
            for term in [0, 4, 11, 16] {
                rest[at + term] = !rest[at + term];
            }
        }
    }
    rest[message.len()..].to_vec()
}

/// The frame as characters: 0, fourteen 1, 0; then bytes, each with a 0 behind it.
fn characters(telegram: Telegram) -> String {
    let mut message = information(telegram);
    message.extend(remainder(&message));
    let byte = |byte: &[bool]| byte.iter().map(|bit| if *bit { '1' } else { '0' }).chain(['0']).collect::<String>();
    format!("0{}0{}", "1".repeat(14), message.chunks(8).map(byte).collect::<String>())
}

fn frame(characters: &str) -> Frame {
    Frame::from_bits(u128::from_str_radix(characters, 2).expect("zeros and ones"))
}

#[test]
fn the_check_is_the_catalogued_one() {
    // CRC-16/IBM-3740 (also called CRC-16/CCITT-FALSE): its check value is that of the nine digits.
    assert_eq!(b"123456789".iter().fold(u16::MAX, |remainder, byte| check_byte(remainder, *byte)), 0x29B1);
}

#[test]
fn a_thousand_frames_are_what_the_second_description_says() {
    let mut random = Random(1);
    for _ in 0..1000 {
        let telegram = random.telegram();
        let expected = characters(telegram);
        assert_eq!(expected.len(), FRAME_BITS as usize);
        assert_eq!(encode(telegram), frame(&expected), "{telegram:?}");
        assert_eq!(decode(frame(&expected)), Ok(telegram));
    }
}

proptest! {
    #[test]
    fn the_check_of_any_bytes(bytes in any::<[u8; 8]>()) {
        let message: Vec<_> = bytes.iter().flat_map(|byte| bits(u32::from(*byte), 8)).collect();
        let expected = remainder(&message).iter().fold(0, |number, bit| number << 1 | u16::from(*bit));
        prop_assert_eq!(check(bytes), expected);
    }
}

/// Two hundred frames; each of their errors of one bit and of two bits is noticed.
#[test]
fn every_error_of_one_and_two_bits_is_noticed() {
    let mut random = Random(2);
    for _ in 0..200 {
        let sent = encode(random.telegram()).bits();
        for one in 0..FRAME_BITS {
            assert!(decode(Frame::from_bits(sent ^ 1 << one)).is_err(), "bit {one} of {sent:0106b}");
            for other in 0..one {
                let received = Frame::from_bits(sent ^ 1 << one ^ 1 << other);
                assert!(decode(received).is_err(), "bits {one} and {other} of {sent:0106b}");
            }
        }
    }
}

#[test]
fn a_million_errors_of_three_bits_are_noticed() {
    let mut random = Random(3);
    let mut sent = 0;
    for count in 0..1_000_000 {
        if count % 1000 == 0 {
            sent = encode(random.telegram()).bits();
        }
        let one = random.below(FRAME_BITS);
        let two = (one + 1 + random.below(FRAME_BITS - 1)) % FRAME_BITS;
        let mut three = random.below(FRAME_BITS);
        while three == one || three == two {
            three = random.below(FRAME_BITS);
        }
        let received = Frame::from_bits(sent ^ 1 << one ^ 1 << two ^ 1 << three);
        assert!(decode(received).is_err(), "bits {one}, {two}, {three} of {sent:0106b}");
    }
}

/// A million bursts of 1 to 16 bits: the first and the last bit of a burst are wrong, those between as it happens.
#[test]
fn a_million_bursts_are_noticed() {
    let mut random = Random(4);
    let mut sent = 0;
    for count in 0..1_000_000 {
        if count % 1000 == 0 {
            sent = encode(random.telegram()).bits();
        }
        let length = 1 + random.below(16);
        let inner = u128::from(random.below(1 << 16)) & ((1 << length) - 1);
        let burst = (inner | 1 | 1 << (length - 1)) << random.below(FRAME_BITS - length + 1);
        assert!(decode(Frame::from_bits(sent ^ burst)).is_err(), "{burst:0106b} on {sent:0106b}");
    }
}

/// A frame of these information bytes with the right check.
fn sealed(bytes: [u8; 8]) -> Frame {
    let message: Vec<_> = bytes.iter().flat_map(|byte| bits(u32::from(*byte), 8)).collect();
    let whole: Vec<_> = message.iter().copied().chain(remainder(&message)).collect();
    let body: String =
        whole.chunks(8).flat_map(|byte| byte.iter().map(|bit| if *bit { '1' } else { '0' }).chain(['0'])).collect();
    frame(&format!("0{}0{body}", "1".repeat(14)))
}

#[test]
fn every_reason_by_name() {
    let main = [0x4D, 9, 0, 7, 1, 144, 0xF0, 4];
    let with = |place: usize, value: u8| {
        let mut bytes = main;
        bytes[place] = value;
        bytes
    };
    assert!(decode(sealed(main)).is_ok());
    let good = sealed(main).bits();
    for place in 0..16 {
        let received = Frame::from_bits(good ^ 1 << (FRAME_BITS - 1 - place));
        assert_eq!(decode(received), Err(FrameError::Synchronisation), "bit {place} of the synchronisation");
    }
    for byte in 0..10 {
        let guard = Frame::from_bits(good ^ 1 << (9 * byte));
        assert_eq!(decode(guard), Err(FrameError::Guard), "guard {byte} from the end");
        let information = Frame::from_bits(good ^ 1 << (9 * byte + 4));
        assert_eq!(decode(information), Err(FrameError::Check), "byte {byte} from the end");
    }
    // The first that applies is named.
    assert_eq!(decode(Frame::from_bits(good ^ 1 << 105 ^ 1 ^ 2)), Err(FrameError::Synchronisation));
    assert_eq!(decode(Frame::from_bits(good ^ 1 ^ 2)), Err(FrameError::Guard));
    for (bytes, what) in [
        (with(0, 0), "a kind that is none"),
        (with(0, 0x4C), "a kind beside that of a main telegram"),
        (with(6, 0x0F), "a closed route with a distance"),
        (with(6, 0), "a route that is none"),
        (with(7, 16), "a rank beyond 15"),
        ([0x53, 9, 0, 7, 0, 0, 0, 0], "a section of no length"),
    ] {
        assert_eq!(decode(sealed(bytes)), Err(FrameError::Content), "{what}");
    }
    for (bytes, what) in [
        ([0x4D, 9, 0, 7, 0, 0, 0x0F, 15], "a closed route"),
        ([0x4D, 9, 0, 7, 0, 0, 0xF0, 15], "a route open for no distance"),
        ([0x53, 255, 255, 255, 0, 1, 0x80, 0xFF], "the shortest section and the steepest fall"),
    ] {
        assert!(decode(sealed(bytes)).is_ok(), "{what}");
    }
}

/// Information bytes as they may come: what is decoded is encoded to the same bits.
#[test]
fn what_is_decoded_is_encoded_again() {
    let mut random = Random(5);
    let mut telegrams = 0;
    for _ in 0..100_000 {
        let mut bytes = random.next().to_le_bytes();
        // A kind and a route that exist, as often as not.
        bytes[0] = [0x4D, 0x53, bytes[0]][usize::from(bytes[0] % 3)];
        bytes[6] = [0x0F, 0xF0, bytes[6]][usize::from(bytes[6] % 3)];
        bytes[7] %= 32;
        let frame = sealed(bytes);
        if let Ok(telegram) = decode(frame) {
            assert_eq!(encode(telegram), frame, "{telegram:?}");
            telegrams += 1;
        }
    }
    assert!(telegrams > 20_000, "{telegrams}");
}

/// Frames one behind the other, with noise and gaps between them: exactly they are found, each with its last bit. The noise has no
/// synchronisation word in it, as it is shorter than one.
#[test]
fn the_deframer_finds_what_was_sent() {
    let mut random = Random(6);
    let (mut window, mut expected, mut found, mut at) = (Deframer.initial(), Vec::new(), Vec::new(), 0_u32);
    let mut hear = |reception: Reception, at: &mut u32| {
        let (next, telegram) = Deframer.step(window, reception);
        assert!(next.is_valid());
        window = next;
        found.extend(telegram.map(|telegram| (*at, telegram)));
        *at += 1;
    };
    for _ in 0..2000 {
        for _ in 0..random.below(3) * random.below(8) {
            let reception = [Reception::Zero, Reception::One, Reception::Nothing][random.below(3) as usize];
            hear(reception, &mut at);
        }
        let telegram = random.telegram();
        // One frame in eight has a hole.
        let hole = (random.below(8) == 0).then(|| random.below(FRAME_BITS));
        for (place, letter) in (0..).zip(characters(telegram).chars()) {
            let bit = if letter == '1' { Reception::One } else { Reception::Zero };
            hear(if hole == Some(place) { Reception::Nothing } else { bit }, &mut at);
        }
        if hole.is_none() {
            expected.push((at - 1, telegram));
        }
    }
    assert_eq!(found, expected);
    assert!(expected.len() > 1500 && expected.len() < 2000);
}

/// Whatever was heard before a gap: nothing is found until all bits of a frame have come after it.
#[test]
fn no_telegram_reaches_over_a_gap() {
    let mut random = Random(7);
    for _ in 0..200 {
        let text = characters(random.telegram());
        let hole = random.below(FRAME_BITS);
        let mut window = Window::from_bits(u128::from(random.next()) << 64 | u128::from(random.next()));
        (window, _) = Deframer.step(window, Reception::Nothing);
        assert_eq!(window, Window::EMPTY);
        for letter in text.chars().skip(hole as usize + 1) {
            let (next, telegram) = Deframer.step(window, if letter == '1' { Reception::One } else { Reception::Zero });
            assert_eq!(telegram, None);
            window = next;
        }
    }
}
