//! Lines that mean nothing, by the thousand, into one oracle: each has one reply, and it stands. `ATC_MALFORMED_LINES=10000000` makes ten million of them.

use std::fs;
use std::io::{BufRead as _, BufReader, BufWriter, Write as _};
use std::process::{Command, Stdio};
use std::thread;
use std::time::Instant;

use atc_tests::device;
use serde_json::Value;

/// As many as a test has time for.
const LINES: u64 = 20_000;

/// What a number may be that nobody meant.
const NUMBERS: [&str; 12] =
    ["-1", "0", "255", "256", "65535", "65536", "4294967296", "-9223372036854775809", "1e309", "1e-400", "0.5", "NaN"];

/// Numbers that look random and are the same every time.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, most: usize) -> usize {
        usize::try_from(self.roll() % u64::try_from(most.max(1)).expect("small")).expect("small")
    }
}

/// One thing wrong with a line.
fn batter(line: &mut Vec<u8>, other: &[u8], dice: &mut Dice) {
    let at = dice.below(line.len() + 1);
    let to = (at + 1 + dice.below(12)).min(line.len());
    match dice.below(10) {
        0 if at < line.len() => line[at] ^= 1 << dice.below(8),
        1 => drop(line.drain(at..to.max(at))),
        2 => line.truncate(at),
        3 => {
            let again = line.get(at..to).unwrap_or_default().to_vec();
            line.splice(at..at, again);
        }
        4 => {
            let from = dice.below(other.len() + 1);
            line.truncate(at);
            line.extend(&other[from..]);
        }
        5 => line.insert(at, u8::try_from(dice.below(256)).expect("a byte")),
        // A number where one stands.
        6 | 7 => {
            let digit = |byte: &u8| byte.is_ascii_digit();
            let Some(first) = line.iter().skip(at).position(digit).map(|place| at + place) else { return };
            let length = line[first..].iter().take_while(|byte| digit(byte)).count();
            let number = NUMBERS[dice.below(NUMBERS.len())];
            line.splice(first..first + length, number.bytes());
        }
        8 => {
            let deep = 1 + dice.below(400);
            line.splice(at..at, std::iter::repeat_n(b"[{"[dice.below(2)], deep));
        }
        _ => line.splice(at..at, *b"\"\\ud800\"").for_each(drop),
    }
    line.retain(|byte| *byte != b'\n');
}

#[test]
fn every_battered_line_has_one_reply_and_the_oracle_stands() {
    let lines =
        std::env::var("ATC_MALFORMED_LINES").ok().map_or(LINES, |many| many.parse().expect("a number of lines"));
    let mut sessions: Vec<Vec<Vec<u8>>> = Vec::new();
    for entry in fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../oracle/examples")).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|end| end == "jsonl") {
            let text = fs::read(&path).expect("a session");
            let lines = text.split(|byte| *byte == b'\n').filter(|line| !line.is_empty());
            sessions.push(lines.map(<[u8]>::to_vec).collect());
        }
    }
    sessions.sort();
    let mut oracle = Command::new(device::oracle())
        .arg("serve")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("it runs");
    let mut input = BufWriter::new(oracle.stdin.take().expect("a pipe"));
    let output = BufReader::new(oracle.stdout.take().expect("a pipe"));
    let begin = Instant::now();
    let writer = thread::spawn(move || {
        let mut dice = Dice(2026);
        let (mut session, mut place) = (&sessions[0], 0);
        for _ in 0..lines {
            // A session goes on for a while, so that steps meet a machine; then it stops, and another one begins.
            let ends = dice.below(60) == 0;
            let mut line = if ends { br#"{"stop":{}}"#.to_vec() } else { session[place].clone() };
            let begins = ends || place == 0 && dice.below(8) > 0;
            if ends {
                (session, place) = (&sessions[dice.below(sessions.len())], 0);
            } else {
                place = (place + 1) % session.len();
            }
            if !begins && dice.below(4) > 0 {
                let from = &sessions[dice.below(sessions.len())];
                for _ in 0..=dice.below(3) {
                    batter(&mut line, &from[dice.below(from.len())], &mut dice);
                }
            }
            line.push(b'\n');
            input.write_all(&line).expect("the oracle reads on");
        }
    });
    let (mut replies, mut taken) = (0, 0);
    for reply in output.lines() {
        let reply = reply.expect("the oracle goes on");
        replies += 1;
        taken += u64::from(!reply.starts_with("{\"malformed\"") && !reply.starts_with("{\"rejected\""));
        // Reading each as JSON takes longer than making it.
        let sampled = replies % 64 == 0;
        assert!(reply.starts_with('{') && reply.ends_with('}'), "reply {replies}: {reply}");
        assert!(!sampled || serde_json::from_str::<Value>(&reply).is_ok_and(|reply| reply.is_object()), "{reply}");
    }
    writer.join().expect("all lines are written");
    let status = oracle.wait().expect("it ends");
    println!("{lines} lines, {taken} of them taken, in {:.1} s", begin.elapsed().as_secs_f64());
    assert!(status.success() && replies == lines, "{status}: {replies} replies to {lines} lines");
    assert!(taken > lines / 5 && taken < lines / 2, "{taken} of {lines} lines were taken");
}
