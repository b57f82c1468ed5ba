//! What the antennas give, read: T-TRN-4.

use super::facing::{ahead, any_way};
use super::{RANKS, any_device, any_moved, codes};
use crate::permitted::{any_line, knows_main, knows_sub};
use crate::telegram::any_telegram;
use crate::{Engine, any_flag, any_u32};
use atc_kernel::aspect::{Acceptance, AspectId, AspectTable, Times};
use atc_kernel::code::Millihertz;
use atc_kernel::distance::Metres;
use atc_kernel::pattern::Deceleration;
use atc_kernel::permitted::{Permitted, Settings};
use atc_kernel::position::{Millibels, Moved};
use atc_kernel::speed::{KmhTenths, RawKmhTenths};
use atc_kernel::supervision::Supervision;
use atc_kernel::telegram::{Frame, Gradient, Sequence, Telegram, decode, encode};
use atc_kernel::time::Ticks;
use atc_kernel::train::{Antennas, Carrier, Parts, Train};

/// A device; what it accepts, and when, does not matter here.
fn any_receiver<E: Engine + ?Sized>(e: &mut E) -> Option<super::Device> {
    let line = any_line(e)?;
    let times = Times::from_ticks(Ticks(3), Ticks(4), Ticks(4), Ticks(7), Ticks(1)).ok()?;
    any_device(e, line, Acceptance { times }, None)
}

/// A device for these speeds, and codes that name these.
fn receiver(speeds: [KmhTenths; RANKS], named: [KmhTenths; RANKS]) -> Option<Train<RANKS>> {
    let sequence = Sequence::new(3, 1, Ticks(4)).ok()?;
    let permitted = Permitted::new(Settings {
        speeds: AspectTable::new(&speeds).ok()?,
        lowest: AspectId::new(1)?,
        brake: Deceleration::brake(1000)?,
        worst: Gradient(-10),
        margin: Metres(10),
        fresh: Ticks(4),
        life: Ticks(8),
        fixed_life: Ticks(8),
        sequence,
    });
    let times = Times::from_ticks(Ticks(3), Ticks(4), Ticks(4), Ticks(7), Ticks(1)).ok()?;
    let (permitted, supervision) = (permitted.ok()?, Supervision::default());
    Train::new(Parts { codes: codes(named)?, acceptance: Acceptance { times }, permitted, supervision, position: None })
        .ok()
}

/// Anything that the antennas give besides the two carriers.
fn any_antennas<E: Engine + ?Sized>(e: &mut E, main: Carrier, sub: Carrier) -> Option<Antennas> {
    let [first, second] = [0..=255, 0..=0].map(|likely| {
        let level = Millibels(crate::position::signed(e.word("level (mB)", likely)));
        any_flag(e, "that level is heard (odd: yes)").then_some(level)
    });
    let moved = any_moved(e)?;
    let told = any_flag(e, "a line begins (odd: yes)");
    let kind = crate::permitted::any_kind(e, "line that begins (odd: digital)");
    Some(Antennas {
        main,
        sub,
        first,
        second,
        moved: any_flag(e, "the odometer says it (odd: yes)").then_some(moved),
        speed: crate::supervision::any_speed(e, "measured speed (0.1 km/h, two's complement)").map(RawKmhTenths),
        line: told.then_some(kind),
        facing: any_way(e, "facing (0: not known, 1: left, else right)"),
    })
}

/// A frame of an arbitrary telegram, perhaps with bits that are wrong.
fn any_frame<E: Engine + ?Sized>(e: &mut E) -> Option<Frame> {
    let telegram = any_telegram(e)?;
    let wrong = u128::from(any_u32(e, "wrong bits", 0..=1));
    let place = u32::from(e.word("which begin at (bit)", 0..=100) & 127);
    Some(Frame::from_bits(encode(telegram).bits() ^ wrong.wrapping_shl(place)))
}

harness! {
    /// A frame that is no telegram, that came on the other carrier, that has a rank that the line has not, or that is for trains of the other direction of
    /// travel, is as no frame, and so is any while the direction is not known: what is received is the same as without it. (What a cycle without a telegram
    /// does is T-PER-8's: ages.) A frame that is a telegram of its carrier, with known ranks, for the direction in which the train faces, is received as it is.
    t_trn_4(e)
    theorem "T-TRN-4";
    requirements ["TRN-3", "TRN-11"];
    assumptions ["four-speeds", "trains-know-facing"];
    built_in &[("trains-know-facing", "what the device is told is how the train faces")];
    bound "tables of 4 speeds, 32 wrong bits in a frame";
    cases 2;
    unwind 33 = 1 + crate::aspect::LONGEST;
    solver kissat;
    apart [0 1];
    claims {
        Own: "a telegram of the carrier's own kind with known ranks, for the direction in which the train faces, is received, as it was sent",
        Other: "a frame of the other kind, one with an unknown rank, one for the other direction of travel or while that is not known, and one that is no telegram are as no frame",
    }
    covers {
        Received: "a telegram is received",
        Wrong: "a telegram comes on the wrong carrier",
        Unknown: "a telegram has an unknown rank",
        Damaged: "a frame is no telegram",
        Against: "a telegram is for trains of the other direction of travel",
        Lost: "a telegram comes while the direction is not known",
    }
    {
        let on_main = e.choose("carrier (0: main, 1: sub)", 2) == 0;
        let Some(device) = any_receiver(e) else { return };
        let Some(frame) = any_frame(e) else { return };
        let carrier = Carrier { code: None, frame: Some(frame) };
        let silent = Carrier { code: None, frame: None };
        let (main, sub) = if on_main { (carrier, silent) } else { (silent, carrier) };
        let Some(antennas) = any_antennas(e, main, sub) else { return };
        let received = device.train.receive(antennas);
        let without = device.train.receive(Antennas { main: silent, sub: silent, ..antennas });
        let read = decode(frame).ok();
        let (mut own, mut known, mut for_it) = (false, false, false);
        let mut right = true;
        match read {
            Some(Telegram::Main(main)) => {
                (own, known, for_it) = (on_main, knows_main(main), ahead(main.section, antennas.facing));
                right = received.main == Some(main) && received.sub.is_none();
            }
            Some(Telegram::Sub(sub)) => {
                (own, known, for_it) = (!on_main, knows_sub(sub), ahead(sub.section, antennas.facing));
                right = received.sub == Some(sub) && received.main.is_none();
            }
            None => {}
        }
        let good = own && known && for_it;
        e.claim(Claim::Own as u32, !good || right);
        e.claim(Claim::Other as u32, good || received == without);
        e.cover(Cover::Received as u32, good && right);
        e.cover(Cover::Wrong as u32, read.is_some() && !own && known);
        e.cover(Cover::Unknown as u32, own && !known);
        e.cover(Cover::Damaged as u32, read.is_none());
        e.cover(Cover::Against as u32, own && known && !for_it && antennas.facing.is_some());
        e.cover(Cover::Lost as u32, own && known && antennas.facing.is_none());
    }
}

harness! {
    /// The aspect that counts as detected is the one whose speed the two code frequencies name in the code table; none, if one is missing, in no band, or
    /// if the pair names nothing. All else is handed on as it is measured; without an odometer the train may have moved as far as can be said.
    t_trn_4_code(e)
    theorem "T-TRN-4";
    requirements ["TRN-1", "TRN-6"];
    assumptions ["printed-sizes", "detected-throughout"];
    built_in &[("detected-throughout", "a code frequency is there in a cycle or it is not")];
    bound "one table of codes and of 4 speeds";
    cases 1;
    unwind 33 = 1 + crate::aspect::LONGEST;
    claims {
        Aspect: "detected is the rank, in the line's table, of the speed that the pair names, alone",
        None: "and nothing if the pair names no speed",
        Rest: "levels, speed and kind of line are handed on as they are, and the movement",
        Odometer: "without an odometer the movement is from −32 768 to 32 767 mm",
    }
    covers {
        Detected: "an aspect is detected",
        Pair: "two codes that are no pair",
        Silent: "the odometer says nothing",
    }
    {
        // The places of the codes are not the ranks of their speeds.
        let speeds = [0, 150, 450, 900].map(KmhTenths);
        let Some(train) = receiver(speeds, [2, 0, 3, 1].map(|rank: usize| speeds[rank])) else { return };
        let any_code = |e: &mut E, what, likely| {
            let measured = any_u32(e, what, likely);
            any_flag(e, "a code there (odd: yes)").then_some(Millihertz(measured))
        };
        let main_code = any_code(e, "main code frequency (mHz)", 8..=42);
        let sub_code = any_code(e, "sub code frequency (mHz)", 13..=47);
        let carrier = |code| Carrier { code, frame: None };
        let Some(antennas) = any_antennas(e, carrier(main_code), carrier(sub_code)) else { return };
        let received = train.receive(antennas);
        // The codes are 10 mHz apart, with 2 mHz either way.
        let place = |code: Option<Millihertz>, first: u32| {
            let mut found = None;
            for rank in 0..RANKS {
                let nominal = first + 10 * u32::from(rank.to_le_bytes()[0]);
                if code.is_some_and(|code| nominal - 2 <= code.0 && code.0 <= nominal + 2) {
                    found = Some(rank);
                }
            }
            found
        };
        let (main, sub) = (place(main_code, 10), place(sub_code, 15));
        let pair = main.filter(|main| sub == Some(*main));
        let bits = received.detected.bits();
        e.claim(Claim::Aspect as u32, pair.is_none_or(|place| bits == [4, 1, 8, 2][place]));
        e.claim(Claim::None as u32, pair.is_some() || bits == 0);
        let levels = received.measured.first == antennas.first && received.measured.second == antennas.second;
        let moved = antennas.moved.is_none_or(|moved| received.measured.moved == moved);
        e.claim(Claim::Rest as u32, levels && moved && received.speed == antennas.speed && received.line == antennas.line);
        let any = Moved::new(i16::MIN, i16::MAX);
        e.claim(Claim::Odometer as u32, antennas.moved.is_some() || Some(received.measured.moved) == any);
        e.cover(Cover::Detected as u32, bits != 0);
        e.cover(Cover::Pair as u32, main.is_some() && sub.is_some() && pair.is_none());
        e.cover(Cover::Silent as u32, antennas.moved.is_none());
    }
}
