//! The frame: TEL-1 to TEL-5.

use super::{any_bits, any_telegram, framed};
use crate::{any_byte, any_flag};
use atc_kernel::Machine;
use atc_kernel::telegram::{
    Deframer, FRAME_BITS, Frame, FrameError, Reception, Telegram, Window, check, check_byte, decode, encode,
};

harness! {
    /// Every telegram is read as it was sent, and its frame has the layout of TEL-1.
    t_tel_1(e)
    theorem "T-TEL-1";
    requirements ["TEL-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Back: "what is decoded from the frame of a telegram is that telegram",
        Layout: "the frame is the synchronisation word and ten bytes with guard bits, of which the last two are the check of the first eight",
        Fields: "kind, counter, section, distance or length, and the rest stand at their places, the highest byte first",
    }
    covers {
        Main: "a main telegram",
        Sub: "a sub telegram",
    }
    {
        let Some(telegram) = any_telegram(e) else { return };
        let frame = encode(telegram);
        e.claim(Claim::Back as u32, decode(frame) == Ok(telegram));
        let mut bytes = [0_u8; 10];
        for (place, byte) in bytes.iter_mut().enumerate() {
            *byte = (frame.bits() >> (9 * (9 - place) + 1)).to_le_bytes()[0];
        }
        let [b0, b1, b2, b3, b4, b5, b6, b7, high, low] = bytes;
        let rest = check([b0, b1, b2, b3, b4, b5, b6, b7]);
        e.claim(Claim::Layout as u32, frame == framed(bytes) && u16::from_be_bytes([high, low]) == rest);
        let word = |high: u8, low: u8| u16::from(high) << 8 | u16::from(low);
        let fields = match telegram {
            Telegram::Main(main) => {
                let beyond = word(b4, b5) == main.route.beyond_exit().0;
                let header = b1 == main.counter.0 && word(b2, b3) == main.section.0;
                b0 == 0x4D && header && beyond && b7 == main.speed.rank()
            }
            Telegram::Sub(sub) => {
                let header = b1 == sub.counter.0 && word(b2, b3) == sub.section.0;
                let limits = b7 >> 4 == sub.curve.rank() && b7 & 15 == sub.restriction.rank();
                b0 == 0x53 && header && word(b4, b5) == sub.length.metres().0 && b6 == sub.gradient.0.to_le_bytes()[0] && limits
            }
        };
        e.claim(Claim::Fields as u32, fields);
        e.cover(Cover::Main as u32, matches!(telegram, Telegram::Main(_)));
        e.cover(Cover::Sub as u32, matches!(telegram, Telegram::Sub(_)));
    }
}

harness! {
    /// Nothing but the frame of a telegram is taken for one: what decodes, encodes to the same bits.
    t_tel_2(e)
    theorem "T-TEL-2";
    requirements ["TEL-2"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Only: "bits from which a telegram is decoded are the frame of that telegram",
        Told: "bits without the synchronisation word, and then bits with a guard bit of 1, are refused for that reason",
    }
    covers {
        Decoded: "bits from which a telegram is decoded",
        Refused: "bits from which none is decoded",
    }
    {
        // Mostly the bits of a telegram, as arbitrary ones never are.
        let bits = if any_flag(e, "the bits of a telegram (odd: yes)") {
            let Some(telegram) = any_telegram(e) else { return };
            encode(telegram).bits()
        } else {
            any_bits(e, "bits")
        };
        let decoded = decode(Frame::from_bits(bits));
        let same = |telegram: &Telegram| encode(*telegram).bits() == bits;
        e.claim(Claim::Only as u32, decoded.as_ref().map_or(true, same));
        let sync = bits >> 90 == 0x7FFE;
        let mut guards = false;
        for place in 0..10 {
            guards |= bits >> (9 * place) & 1 == 1;
        }
        let told = (decoded == Err(FrameError::Synchronisation)) != sync
            && (decoded == Err(FrameError::Guard)) == (sync && guards);
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Decoded as u32, decoded.is_ok());
        e.cover(Cover::Refused as u32, decoded.is_err());
    }
}

harness! {
    /// A frame with one wrong bit is no telegram.
    t_tel_3(e)
    theorem "T-TEL-3";
    requirements ["TEL-3"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        One: "the frame of any telegram with any one bit wrong is refused",
    }
    covers {
        Checked: "the wrong bit is found by the check",
    }
    {
        let Some(telegram) = any_telegram(e) else { return };
        let wrong = u32::from(e.word("wrong bit", 0..=105));
        e.assume(wrong < FRAME_BITS);
        let decoded = decode(Frame::from_bits(encode(telegram).bits() ^ 1_u128 << (wrong & 127)));
        e.claim(Claim::One as u32, decoded.is_err());
        e.cover(Cover::Checked as u32, decoded == Err(FrameError::Check));
    }
}

harness! {
    /// The check is linear: with errors in the bytes, it changes by the remainder of the errors alone. One byte's step
    /// from any two remainders; and the check is that step byte by byte, so it holds for all eight.
    t_tel_3_linear(e)
    theorem "T-TEL-3";
    requirements ["TEL-3"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Step: "if two remainders differ by a third, they differ after a byte that is wrong by x by the third's remainder after x",
        Division: "a byte's step is eight steps of the division by x¹⁶ + x¹² + x⁵ + 1",
        Start: "all frames have the same start, which is sixteen ones",
        Bytes: "the check of eight bytes is the step of each of them, in their order, from the start",
    }
    covers {
        Wrong: "the bytes differ",
    }
    {
        let (sent, error) = (e.word("remainder", 0..=65535), e.word("difference", 0..=65535));
        let (byte, wrong) = (any_byte(e, "byte", 0..=255), any_byte(e, "wrong bits", 0..=255));
        let after = check_byte(sent, byte) ^ check_byte(sent ^ error, byte ^ wrong);
        e.claim(Claim::Step as u32, after == check_byte(error, wrong));
        let mut division = u32::from(sent) << 8 ^ u32::from(byte) << 16;
        for place in (16..24).rev() {
            if division >> place & 1 == 1 {
                division ^= 0x0001_1021 << (place - 16);
            }
        }
        e.claim(Claim::Division as u32, u32::from(check_byte(sent, byte)) == division);
        let start = check([0; 8]) ^ check([0, 0, 0, 0, 0, 0, 0, 1]);
        // From sixteen ones, eight bytes of zeros leave this remainder.
        e.claim(Claim::Start as u32, start == check_byte(0, 1) && check([0; 8]) == 0x313E);
        let (mut information, mut bytewise) = ([0; 8], u16::MAX);
        for place in &mut information {
            *place = any_byte(e, "information byte", 0..=255);
            bytewise = check_byte(bytewise, *place);
        }
        e.claim(Claim::Bytes as u32, check(information) == bytewise);
        e.cover(Cover::Wrong as u32, wrong != 0);
    }
}

/// The remainder of errors in ten bytes from a start of 0, and of the check that they are compared with.
fn remainder(errors: [u8; 10]) -> u16 {
    let mut remainder = 0;
    for error in &errors[..8] {
        remainder = check_byte(remainder, *error);
    }
    remainder ^ u16::from_be_bytes([errors[8], errors[9]])
}

/// The bytes of 80 bits, the first one the highest.
fn bytes(bits: u128) -> [u8; 10] {
    let mut bytes = [0; 10];
    for (place, byte) in bytes.iter_mut().enumerate() {
        *byte = (bits >> (8 * (9 - place))).to_le_bytes()[0];
    }
    bytes
}

harness! {
    /// Errors that stand one place further on have the remainder of one more step of the division, and that is 0 only for 0. So
    /// errors have the remainder 0 at any place if and only if they have it with their last bit at the end.
    t_tel_3_shift(e)
    theorem "T-TEL-3";
    requirements ["TEL-3"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Shift: "the remainder of errors moved by one place is that of the errors after one step of the division",
        Kept: "a step of the division makes 0 of 0 only",
    }
    covers {
        Far: "errors that reach over the first byte",
    }
    {
        let high = e.word("errors", 0..=65535) & 0x7FFF;
        let rest = [0..=0, 0..=0, 0..=1, 0..=65535].map(|likely| e.word("errors", likely));
        let mut errors = u128::from(high);
        for word in rest {
            errors = errors << 16 | u128::from(word);
        }
        let step = |remainder: u16| remainder << 1 ^ if remainder >> 15 == 1 { 0x1021 } else { 0 };
        e.claim(Claim::Shift as u32, remainder(bytes(errors << 1)) == step(remainder(bytes(errors))));
        let any = e.word("remainder", 0..=65535);
        e.claim(Claim::Kept as u32, (step(any) == 0) == (any == 0));
        e.cover(Cover::Far as u32, high > 0xFF);
    }
}

harness! {
    /// Up to three wrong bits, and wrong bits within 16 in a row, never have the remainder 0: here with the last of them at the
    /// end (`t_tel_3_shift` moves them, `t_tel_3_linear` puts them into any telegram).
    t_tel_3_few(e)
    theorem "T-TEL-3";
    requirements ["TEL-3"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Three: "one, two or three wrong bits among the 80 have a remainder other than 0",
        Burst: "any wrong bits within 16 in a row have a remainder other than 0",
    }
    covers {
        Different: "three different bits",
        Whole: "16 wrong bits in a row",
    }
    {
        let (second, third) = (u32::from(e.word("second wrong bit", 0..=79)), u32::from(e.word("third wrong bit", 0..=79)));
        e.assume(second < 80 && third < 80);
        let bit = |place: u32| if place == 0 { 0 } else { 1_u128 << (place & 127) };
        // One bit if both places are the same one, or none; two bits if one of them is no place.
        let errors = 1 | bit(second) ^ bit(third);
        e.claim(Claim::Three as u32, remainder(bytes(errors)) != 0);
        let burst = e.word("wrong bits", 1..=65535);
        e.claim(Claim::Burst as u32, burst == 0 || remainder(bytes(u128::from(burst))) != 0);
        e.cover(Cover::Different as u32, 0 < second && second < third);
        e.cover(Cover::Whole as u32, burst == u16::MAX);
    }
}

harness! {
    /// Information that passes the check is a telegram if and only if its content is defined.
    t_tel_4(e)
    theorem "T-TEL-4";
    requirements ["TEL-4"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Exact: "a telegram if and only if the kind is main or sub, ranks are under 16, a main telegram's route byte is closed (with distance 0) or open, and a sub telegram's length is not 0; otherwise refused for its content",
    }
    covers {
        Main: "a main telegram",
        Sub: "a sub telegram",
        ClosedWithDistance: "a closed route with a distance",
        UnknownRank: "a main telegram with a rank of 16 or more",
    }
    {
        let kind = match any_byte(e, "kind (0 main, 1 sub, else itself)", 0..=2) {
            0 => 0x4D,
            1 => 0x53,
            other => other,
        };
        let seventh = match any_byte(e, "route (0 closed, 1 open, else itself)", 0..=2) {
            0 => 0x0F,
            1 => 0xF0,
            other => other,
        };
        let header = [any_byte(e, "counter", 0..=255), any_byte(e, "section", 0..=255), any_byte(e, "section", 0..=255)];
        let distance = e.word("distance or length (m)", 0..=1);
        let [high, low] = distance.to_be_bytes();
        let eighth = any_byte(e, "ranks", 14..=17);
        let information = [kind, header[0], header[1], header[2], high, low, seventh, eighth];
        let [first, second] = check(information).to_be_bytes();
        let [b0, b1, b2, b3, b4, b5, b6, b7] = information;
        let decoded = decode(framed([b0, b1, b2, b3, b4, b5, b6, b7, first, second]));
        let main = kind == 0x4D && eighth < 16 && (seventh == 0xF0 || seventh == 0x0F && distance == 0);
        let sub = kind == 0x53 && distance != 0;
        let right = match decoded {
            Ok(Telegram::Main(_)) => main,
            Ok(Telegram::Sub(_)) => sub,
            Err(error) => !main && !sub && error == FrameError::Content,
        };
        e.claim(Claim::Exact as u32, right);
        e.cover(Cover::Main as u32, main);
        e.cover(Cover::Sub as u32, sub);
        e.cover(Cover::ClosedWithDistance as u32, kind == 0x4D && seventh == 0x0F && eighth < 16 && distance != 0);
        e.cover(Cover::UnknownRank as u32, kind == 0x4D && seventh == 0xF0 && eighth >= 16);
    }
}

harness! {
    /// The deframer reports exactly the telegrams whose frames end with the bit that it is given, and none before all bits of
    /// a frame came since the last gap.
    t_tel_5(e)
    theorem "T-TEL-5";
    requirements ["TEL-5", "GEN-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Window: "the window is the last 106 bits, and after a gap it is empty; it stays valid",
        Reported: "a telegram is reported if and only if the window is the frame of one",
        NotBefore: "with fewer than 106 bits since the start or the last gap nothing is reported",
        Since: "bits that did not come are ones, before the step and after it",
        Start: "the empty window is the initial one, and is valid; nothing is the safe output",
    }
    covers {
        Reported: "a telegram is reported",
        Gap: "a gap",
    }
    {
        // Ghost: how many bits came since the start or the last gap, 106 for all that matter.
        let came = u32::from(e.word("bits since the last gap", 105..=106));
        e.assume(came <= FRAME_BITS);
        let bits = if any_flag(e, "a frame but for its last bit (odd: yes)") {
            let Some(telegram) = any_telegram(e) else { return };
            encode(telegram).bits() >> 1
        } else {
            any_bits(e, "window")
        };
        let missing = |came: u32| (!0_u128 << (came & 127)) & ((1 << FRAME_BITS) - 1);
        let window = Window::from_bits(bits | missing(came));
        e.assume(window.is_valid());
        let reception = match e.word("received (0, 1, else nothing)", 0..=2) {
            0 => Reception::Zero,
            1 => Reception::One,
            _ => Reception::Nothing,
        };
        let (next, reported) = Deframer.step(window, reception);
        let all = (1_u128 << FRAME_BITS) - 1;
        let expected = match reception {
            Reception::Zero => window.bits() << 1 & all,
            Reception::One => (window.bits() << 1 | 1) & all,
            Reception::Nothing => all,
        };
        e.claim(Claim::Window as u32, next.bits() == expected && next.is_valid());
        e.claim(Claim::Reported as u32, reported == decode(Frame::from_bits(expected)).ok());
        let now = if reception == Reception::Nothing { 0 } else if came < FRAME_BITS { came + 1 } else { FRAME_BITS };
        e.claim(Claim::NotBefore as u32, reported.is_none() || now == FRAME_BITS);
        e.claim(Claim::Since as u32, next.bits() & missing(now) == missing(now));
        let start = Deframer.initial();
        e.claim(Claim::Start as u32, start.is_valid() && start.bits() == all && Deframer::SAFE.is_none());
        e.cover(Cover::Reported as u32, reported.is_some());
        e.cover(Cover::Gap as u32, reception == Reception::Nothing);
    }
}

harness! {
    /// In a stream of frames without errors a frame is found only where one was sent: at no other place there is even a
    /// synchronisation word.
    t_tel_5_apart(e)
    theorem "T-TEL-5";
    requirements ["TEL-1", "TEL-5"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Apart: "the bits from any place between the beginnings of two frames in a row have no synchronisation word",
    }
    covers {
        Late: "a place in the second half of the first frame",
    }
    {
        let (Some(first), Some(second)) = (any_telegram(e), any_telegram(e)) else { return };
        let (first, second) = (encode(first).bits(), encode(second).bits());
        let after = u32::from(e.word("bits after the beginning of the first frame", 1..=105));
        e.assume((1..FRAME_BITS).contains(&after));
        let bits = first << (after & 127) | second >> (FRAME_BITS.wrapping_sub(after) & 127);
        e.claim(Claim::Apart as u32, decode(Frame::from_bits(bits)) == Err(FrameError::Synchronisation));
        e.cover(Cover::Late as u32, after > 53);
    }
}
