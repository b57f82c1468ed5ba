//! The counter: TEL-6 and TEL-7.

use super::{any_bits, any_header};
use crate::{Engine, any_byte, any_flag, any_u32};
use atc_kernel::Machine;
use atc_kernel::telegram::{Counter, Deframer, Header, Judgement, Reception, Sequence, SequenceError, Stream, Window};
use atc_kernel::time::Ticks;

/// Arbitrary parameters.
pub(crate) fn any_sequence<E: Engine + ?Sized>(e: &mut E) -> Option<Sequence> {
    let (window, run) = (any_byte(e, "window", 1..=3), any_byte(e, "run", 1..=2));
    let sequence = Sequence::new(window, run, Ticks(e.word("memory (cycles)", 1..=4)));
    e.assume(sequence.is_ok());
    sequence.ok()
}

/// An arbitrary header, or none.
pub(crate) fn any_heard<E: Engine + ?Sized>(e: &mut E) -> Option<Header> {
    let (section, counter) = any_header(e);
    any_flag(e, "a telegram (odd: yes)").then_some(Header { section, counter })
}

/// An arbitrary state of a stream, valid or not.
pub(crate) fn any_bits_of_stream<E: Engine + ?Sized>(e: &mut E) -> Stream {
    let last = any_heard(e);
    let in_order = any_byte(e, "telegrams in order", 0..=3);
    let age = Ticks(e.word("age (cycles)", 0..=3));
    // What is likely is valid: without a last telegram the rest is 0.
    match last {
        None if any_flag(e, "nothing remembered (odd: nor a number)") => Stream::EMPTY,
        _ => Stream { last, in_order, age },
    }
}

/// An arbitrary valid state of a stream.
fn any_stream<E: Engine + ?Sized>(e: &mut E, sequence: Sequence) -> Stream {
    let stream = any_bits_of_stream(e);
    e.assume(stream.is_valid(&sequence));
    stream
}

harness! {
    /// A telegram is used if and only if it is the last of more in order than the run: the first one of a section or after a silence as
    /// long as the memory, and then each that advances the counter by 1 to the window. After one out of order it is as many and one more.
    /// The history is the observer's.
    t_tel_6(e)
    theorem "T-TEL-6";
    requirements ["TEL-6", "TEL-8", "GEN-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Used: "used if and only if the observer counts more telegrams in order than the run",
        Nothing: "nothing is judged if and only if nothing came",
        Observer: "the state is what the observer knows: the last telegram, its age, and how many are in order, up to the run and one",
        Valid: "a valid state leads to a valid one",
    }
    covers {
        Used: "a telegram is used",
        Wrapped: "a telegram is used whose counter went from 255 to 0",
        Skipped: "a telegram beyond the window",
        Forgotten: "a stream is forgotten",
        OtherSection: "a telegram of another section",
    }
    {
        let Some(sequence) = any_sequence(e) else { return };
        let before = any_stream(e, sequence);
        // Ghosts: the observer's count of telegrams in order, and the time since the last telegram.
        let row = e.word("telegrams in order, all of them", 0..=4);
        let silent = e.word("cycles since the last telegram", 0..=6);
        let run = u16::from(sequence.run());
        let up_to = |row: u16| row.min(run + 1);
        let knows = |stream: &Stream, row: u16, silent: u16| match stream.last {
            Some(_) => u16::from(stream.in_order) == up_to(row) && stream.age.0 == silent && silent < sequence.memory().0,
            None => silent >= sequence.memory().0,
        };
        e.assume(knows(&before, row, silent));
        let heard = any_heard(e);
        let (after, judgement) = sequence.step(before, heard);

        // Everything from the greatest number on is alike.
        let now = silent.saturating_add(1);
        let (mut row_after, mut silent_after) = (row, now);
        let mut proper = false;
        if let Some(header) = heard {
            let mut first = true;
            if let (Some(last), true) = (before.last, now < sequence.memory().0) {
                let ahead = (i32::from(header.counter.0) - i32::from(last.counter.0)).rem_euclid(256);
                first = header.section != last.section;
                proper = !first && 1 <= ahead && ahead <= i32::from(sequence.window());
            }
            row_after = if proper { row.saturating_add(1) } else { u16::from(first) };
            silent_after = 0;
        }
        e.claim(Claim::Used as u32, (judgement == Judgement::Accepted) == (heard.is_some() && row_after > run));
        e.claim(Claim::Nothing as u32, (judgement == Judgement::Nothing) == heard.is_none());
        let last = if heard.is_some() { heard } else { before.last.filter(|_| now < sequence.memory().0) };
        e.claim(Claim::Observer as u32, knows(&after, row_after, silent_after) && after.last == last);
        e.claim(Claim::Valid as u32, after.is_valid(&sequence));
        e.cover(Cover::Used as u32, judgement == Judgement::Accepted);
        let wrapped = matches!((before.last, heard), (Some(last), Some(header)) if last.counter.0 == 255 && header.counter.0 == 0);
        e.cover(Cover::Wrapped as u32, wrapped && judgement == Judgement::Accepted);
        let same = matches!((before.last, heard), (Some(last), Some(header)) if last.section == header.section);
        e.cover(Cover::Skipped as u32, same && !proper && now < sequence.memory().0);
        e.cover(Cover::Forgotten as u32, before.last.is_some() && after.last.is_none());
        e.cover(Cover::OtherSection as u32, heard.is_some() && before.last.is_some() && !same);
    }
}

harness! {
    /// The reach of the counter. The ghosts are the whole numbers of the telegrams, without an end. While the stream is remembered, a
    /// telegram that was sent before the last one, by fewer than 256 less the window, is not used, and nothing is in order behind it. One
    /// that was sent earlier is taken for a new one where its number, modulo 256, says so: that is a condition. What late ones and a
    /// transmitter that has frozen can do together is `t_tel_8`.
    t_tel_6_repeated(e)
    theorem "T-TEL-6";
    requirements ["TEL-6"];
    assumptions ["counter-reach", "telegrams-numbered"];
    built_in &[("counter-reach", "of a telegram that was sent 256 less the window before the last one, or more, it is claimed only what becomes of it")];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Repeated: "a telegram of the section that was sent 0 to 255 less the window before the last one is refused",
        Beyond: "one that was sent exactly 256 less any advance within the window before it counts as that advance: no counter of 8 bits tells them apart",
        Again: "nothing is in order after it",
        First: "the first telegram of a section, and the first one after a silence as long as the memory, are refused, and in order",
    }
    covers {
        Same: "the same counter again",
        Older: "an older telegram",
        Recorded: "one that was sent 255 before the last one, and is used",
    }
    {
        let Some(sequence) = any_sequence(e) else { return };
        let before = any_stream(e, sequence);
        let Some(header) = any_heard(e) else { return e.assume(false) };
        let (after, judgement) = sequence.step(before, Some(header));
        // How many telegrams before the last one this one was sent: 0 is the last one again.
        let earlier = any_u32(e, "sent so many telegrams before the last one", 0..=300);
        let window = u32::from(sequence.window());
        let (mut repeated, mut beyond, mut same, mut first) = (false, false, false, true);
        if let Some(last) = before.last {
            same = header == last;
            e.suppose("telegrams-numbered", header.section != last.section || u32::from(last.counter.0) == (u32::from(header.counter.0) + earlier % 256) % 256);
            repeated = header.section == last.section && earlier < 256 - window;
            let remembered = u32::from(before.age.0) + 1 < u32::from(sequence.memory().0);
            beyond = remembered && header.section == last.section && (256 - window..256).contains(&earlier);
            first = header.section != last.section || u32::from(before.age.0) + 1 >= u32::from(sequence.memory().0);
        }
        e.claim(Claim::Repeated as u32, !repeated || judgement == Judgement::Refused);
        let more = u32::from(before.in_order) + 1;
        let run = u32::from(sequence.run());
        e.claim(Claim::Beyond as u32, !beyond || u32::from(after.in_order) == more.min(run + 1));
        e.claim(Claim::Again as u32, !repeated || first || after.in_order == 0);
        e.claim(Claim::First as u32, !first || judgement == Judgement::Refused && after.in_order == 1);
        e.cover(Cover::Same as u32, same);
        e.cover(Cover::Older as u32, repeated && !same);
        e.cover(Cover::Recorded as u32, beyond && earlier == 255 && judgement == Judgement::Accepted);
    }
}

/// What an observer who sees the numbers without an end knows of the telegrams that one train has received of one section.
#[derive(Clone, Copy)]
struct Received {
    /// The newest of them.
    newest: u32,
    /// The last one.
    last: u32,
    /// How many in a row, up to the last one, are late: were sent before the newest.
    late: u32,
}

impl Received {
    /// Whether the stream can be what it is after these: the last one is remembered. It is the newest, or else late, and then fewer than
    /// the late ones are in order.
    fn explains(self, stream: &Stream, sequence: Sequence) -> bool {
        let Some(last) = stream.last else { return false };
        let numbered = u32::from(last.counter.0) == self.last % 256;
        let reach = 256 - u32::from(sequence.window());
        let is_late = self.last < self.newest && self.newest - self.last < reach;
        let late = is_late && self.late <= u32::from(sequence.run()) && u32::from(stream.in_order) < self.late;
        numbered && (self.last == self.newest && self.late == 0 || late)
    }
}

harness! {
    /// No late telegram, and no transmitter that has frozen, makes an old one new: a telegram that is used was sent after every one that the
    /// train has received of its section before. The transmitter may go on with its last telegram alone at any time, telegrams are lost,
    /// and late ones come between, as many in a row as the run; the ground's device may start anew, and counts from anywhere then.
    t_tel_8(e)
    theorem "T-TEL-6";
    requirements ["TEL-8"];
    assumptions ["counter-reach", "telegrams-numbered", "transmitter-does-not-loop"];
    built_in &[
        ("transmitter-does-not-loop", "what is sent twice is the newest telegram alone"),
        ("telegrams-numbered", "the counter is the number modulo 256"),
    ];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Newer: "one that is used was sent after all that were received before it",
        Explained: "what is remembered is explained by what was received, one cycle on",
    }
    covers {
        Used: "a telegram is used",
        Late: "a late one as the last of as many as the run",
        Frozen: "the newest again, behind a late one and in order",
        Anew: "the first one that is used after a start of the ground's device follows",
    }
    {
        let Some(sequence) = any_sequence(e) else { return };
        let mut before = any_stream(e, sequence);
        // The numbers that are sent are those without an end, modulo 256.
        let numbered = |number: u32| Counter((number & 0xff) as u8);
        let (last, since, late) = (any_u32(e, "last number", 0..=600), any_u32(e, "the newest is so many later", 0..=3), any_u32(e, "late ones", 0..=2));
        let received = Received { newest: last.saturating_add(since), last, late };
        if let Some(header) = &mut before.last {
            header.counter = numbered(last);
        }
        // Nothing is remembered of a section that the train has come into, or after a silence.
        let known = before.last.is_some();
        e.assume(!known || received.explains(&before, sequence));
        // The newest again, one close to the last, or any other: which of them is no matter but for drawn values.
        let number = match any_byte(e, "the number is the newest (0), some more than the last (1), or any", 0..=2) {
            0 => received.newest,
            1 => last.saturating_add(any_u32(e, "more than the last", 0..=4)),
            _ => any_u32(e, "number of the telegram", 0..=900),
        };
        let heard = any_heard(e).map(|header| Header { counter: numbered(number), ..header });
        let (after, judgement) = sequence.step(before, heard);

        let remembered = known && u32::from(before.age.0) + 1 < u32::from(sequence.memory().0);
        let same = matches!((before.last, heard), (Some(last), Some(header)) if last.section == header.section);
        let anew = any_flag(e, "the ground's device has started (odd: yes)");
        let is_late = remembered && same && !anew && number < received.newest;
        let mut next = received;
        if heard.is_some() {
            let reach = 256 - u32::from(sequence.window());
            let in_reach = received.late < u32::from(sequence.run()) && (!is_late || received.newest - number < reach);
            e.suppose("counter-reach", !is_late || in_reach);
            next = match (remembered && same && !anew, is_late) {
                (true, true) => Received { last: number, late: received.late + 1, ..received },
                // Sent after all others; or the newest, once more.
                _ => Received { newest: number, last: number, late: 0 },
            };
        }
        let newer = remembered && same && (anew || number > received.newest);
        e.claim(Claim::Newer as u32, judgement != Judgement::Accepted || newer);
        e.claim(Claim::Explained as u32, after.last.is_none() || next.explains(&after, sequence));
        e.cover(Cover::Used as u32, judgement == Judgement::Accepted && !anew);
        e.cover(Cover::Late as u32, is_late && next.late == u32::from(sequence.run()));
        let frozen = same && remembered && !anew && received.late > 0 && number == received.newest;
        e.cover(Cover::Frozen as u32, frozen && after.in_order == sequence.run());
        e.cover(Cover::Anew as u32, anew && judgement == Judgement::Accepted);
    }
}

harness! {
    /// The constructor accepts exactly what TEL-7 allows.
    tel_7(e)
    theorem "T-TEL-6";
    requirements ["TEL-7"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Exact: "accepted if and only if the window is 1 to 127, the run 1 to 15 and the memory 1 to 60 000 cycles; kept as asked",
        Told: "the error names a rule that is broken",
    }
    covers {
        Accepted: "parameters are accepted",
        Refused: "parameters are refused",
    }
    {
        let (window, run) = (any_byte(e, "window", 0..=130), any_byte(e, "run", 0..=16));
        let memory = e.word("memory (cycles)", 0..=60);
        let result = Sequence::new(window, run, Ticks(memory));
        let right = (1..=127).contains(&window) && (1..=15).contains(&run) && (1..=60_000).contains(&memory);
        let kept = |kept: &Sequence| kept.window() == window && kept.run() == run && kept.memory().0 == memory;
        e.claim(Claim::Exact as u32, result.is_ok() == right && result.as_ref().map_or(true, kept));
        let told = match result {
            Ok(_) => true,
            Err(SequenceError::NoWindow) => window == 0,
            Err(SequenceError::WindowTooWide) => window > 127,
            Err(SequenceError::NoRun) => run == 0,
            Err(SequenceError::RunTooLong) => run > 15,
            Err(SequenceError::NoMemory) => memory == 0,
            Err(SequenceError::MemoryTooLong) => memory > 60_000,
        };
        e.claim(Claim::Told as u32, told);
        e.cover(Cover::Accepted as u32, right);
        e.cover(Cover::Refused as u32, !right);
    }
}

harness! {
    /// A stream begins unheard, which is a valid state from which no telegram is used at once.
    tel_sequence(e)
    theorem "T-TEL-6";
    requirements ["TEL-6", "GEN-1"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Start: "the initial state is unheard and valid; its first telegram is refused and remembered",
        Order: "nothing is below refused, and refused below accepted; nothing is the safe output",
    }
    covers {
        Heard: "a first telegram",
    }
    {
        let Some(sequence) = any_sequence(e) else { return };
        let start = sequence.initial();
        let heard = any_heard(e);
        let (after, judgement) = sequence.step(start, heard);
        let first = judgement != Judgement::Accepted && after.last == heard && after.in_order == u8::from(heard.is_some());
        e.claim(Claim::Start as u32, start == Stream::EMPTY && start.is_valid(&sequence) && first);
        let order = Judgement::Nothing < Judgement::Refused && Judgement::Refused < Judgement::Accepted;
        e.claim(Claim::Order as u32, order && Sequence::SAFE == Judgement::Nothing);
        e.cover(Cover::Heard as u32, heard.is_some());
    }
}

harness! {
    /// A bit time of the deframer and a cycle of a stream end from any state, valid or not.
    tel_total(e)
    theorem "T-TEL-6";
    requirements ["GEN-2"];
    assumptions [];
    bound "";
    cases 1;
    unwind 17 = 1 + size_of::<u128>();
    claims {
        Deframer: "a bit time ends, in a valid window",
        Stream: "a cycle ends, and judges nothing if and only if nothing came",
    }
    covers {
        Invalid: "neither state is one that occurs",
    }
    {
        let Some(sequence) = any_sequence(e) else { return };
        let stream = any_bits_of_stream(e);
        let heard = any_heard(e);
        let (_, judgement) = sequence.step(stream, heard);
        e.claim(Claim::Stream as u32, (judgement == Judgement::Nothing) == heard.is_none());
        let reception = if any_flag(e, "bit (odd: 1)") { Reception::One } else { Reception::Zero };
        let window = Window::from_memory(u128::from(e.word("window above its bits", 0..=9)) << 106 | any_bits(e, "window"));
        let (after, _) = Deframer.step(window, reception);
        e.claim(Claim::Deframer as u32, after.is_valid());
        e.cover(Cover::Invalid as u32, !stream.is_valid(&sequence) && !window.is_valid());
    }
}
