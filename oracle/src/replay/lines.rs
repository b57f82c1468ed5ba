//! The lines of a file of any size, one at a time, with their places.

use std::io::{self, ErrorKind, Read};

use memchr::memchr;

use atc_protocol::MAX_LINE;

/// Bytes that are read at once. The buffer grows to hold the longest line, and no further.
const CHUNK: usize = 1 << 18;

/// A line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Line<'a> {
    /// Where it begins, in bytes from the beginning of the file.
    pub(super) offset: u64,
    /// Where the next one begins.
    pub(super) end: u64,
    /// Its number, from 1 at the place where reading began.
    pub(super) number: u64,
    /// Its bytes without the newline; none if there are more than [`MAX_LINE`].
    pub(super) text: Option<&'a [u8]>,
    /// Whether it has its newline: the last line of a file may have none.
    pub(super) ended: bool,
}

/// Reads lines.
pub(super) struct Lines<R> {
    input: R,
    buffer: Vec<u8>,
    /// What was read and not yet given out: from here to there in the buffer.
    begin: usize,
    end: usize,
    /// Where the next line begins in the file, and its number.
    offset: u64,
    number: u64,
    /// How many lines have one number.
    of_one: u64,
}

impl<R: Read> Lines<R> {
    /// Lines from here on; `offset` says where in the file that is.
    pub(super) fn new(input: R, offset: u64) -> Self {
        Self::of_rows(input, offset, 1)
    }

    /// The same; so many lines in a row have one number.
    pub(super) fn of_rows(input: R, offset: u64, of_one: u64) -> Self {
        Self { input, buffer: vec![0; CHUNK], begin: 0, end: 0, offset, number: 1, of_one: of_one.max(1) }
    }

    /// The next line; none at the end.
    ///
    /// # Errors
    /// If the input cannot be read.
    pub(super) fn next(&mut self) -> io::Result<Option<Line<'_>>> {
        // How much of the line is known to have no newline, and how much of it was too long to be kept.
        let (mut searched, mut dropped) = (0, 0_u64);
        loop {
            let held = &self.buffer[self.begin..self.end];
            if let Some(end) = memchr(b'\n', &held[searched..]) {
                return Ok(Some(self.line(searched + end, dropped, true)));
            }
            searched = held.len();
            if dropped > 0 || searched > MAX_LINE {
                dropped += searched as u64;
                (self.begin, self.end, searched) = (0, 0, 0);
            }
            if !self.fill()? {
                let nothing = searched == 0 && dropped == 0;
                return Ok(if nothing { None } else { Some(self.line(searched, dropped, false)) });
            }
        }
    }

    fn line(&mut self, length: usize, dropped: u64, ended: bool) -> Line<'_> {
        let (offset, number, from) = (self.offset, (self.number - 1) / self.of_one + 1, self.begin);
        self.begin += length + usize::from(ended);
        self.offset += dropped + length as u64 + u64::from(ended);
        self.number += 1;
        let text = (dropped == 0 && length <= MAX_LINE).then(|| &self.buffer[from..from + length]);
        Line { offset, end: self.offset, number, text, ended }
    }

    /// Reads more behind what is held; false at the end of the input.
    fn fill(&mut self) -> io::Result<bool> {
        if self.begin > 0 {
            self.buffer.copy_within(self.begin..self.end, 0);
            (self.begin, self.end) = (0, self.end - self.begin);
        }
        if self.end == self.buffer.len() {
            self.buffer.resize(2 * self.end, 0);
        }
        loop {
            match self.input.read(&mut self.buffer[self.end..]) {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
                Ok(read) => {
                    self.end += read;
                    return Ok(read > 0);
                }
            }
        }
    }
}

/// The name of a line's one field, read from its beginning alone: the rest may be wrong.
pub(super) fn key(text: &[u8]) -> Option<&[u8]> {
    let rest = text.trim_ascii_start().strip_prefix(b"{")?.trim_ascii_start().strip_prefix(b"\"")?;
    memchr(b'"', rest).map(|end| &rest[..end])
}

/// Whether a line begins a session. Nothing but its own bytes decides that: whoever begins to read in the middle of a
/// file finds the same sessions.
pub(super) fn is_start(text: &[u8]) -> bool {
    key(text) == Some(b"start")
}

#[cfg(test)]
mod tests {
    use super::{Lines, key};
    use atc_protocol::MAX_LINE;

    /// Offset, number, length (none: too long), whether it has its end.
    type Place = (u64, u64, Option<usize>, bool);

    /// Gives a few bytes at a time.
    struct Slow<'a>(&'a [u8], usize);

    impl std::io::Read for Slow<'_> {
        fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
            let (now, later) = self.0.split_at(self.0.len().min(self.1).min(into.len()));
            into[..now.len()].copy_from_slice(now);
            self.0 = later;
            Ok(now.len())
        }
    }

    fn places(text: &[u8], piece: usize) -> Vec<Place> {
        let mut lines = Lines::new(Slow(text, piece), 0);
        let mut all = Vec::new();
        while let Some(line) = lines.next().expect("memory is read") {
            let start = usize::try_from(line.offset).expect("a place");
            if let Some(held) = line.text {
                assert_eq!(held, &text[start..start + held.len()]);
            }
            all.push((line.offset, line.number, line.text.map(<[u8]>::len), line.ended));
        }
        all
    }

    #[test]
    fn lines_have_their_places_however_they_come() {
        let text = b"one\n\n three\r\nlast";
        let right = [(0, 1, Some(3), true), (4, 2, Some(0), true), (5, 3, Some(7), true), (13, 4, Some(4), false)];
        for piece in [1, 2, 3, 5, 100] {
            assert_eq!(places(text, piece), right, "in pieces of {piece}");
        }
        assert!(places(b"", 1).is_empty());
        assert_eq!(places(b"\n", 1), [(0, 1, Some(0), true)]);
    }

    #[test]
    fn a_line_that_is_too_long_is_passed_over_and_the_next_one_is_read() {
        for (length, kept) in [(MAX_LINE, Some(MAX_LINE)), (MAX_LINE + 1, None), (5 * MAX_LINE, None)] {
            let text = [vec![b'x'; length], b"\nshort\n".to_vec()].concat();
            let places = places(&text, 100_000);
            assert_eq!(places, [(0, 1, kept, true), (length as u64 + 1, 2, Some(5), true)]);
        }
    }

    #[test]
    fn the_key_is_read_whatever_stands_behind_it() {
        assert_eq!(key(br#" { "start" : {"#), Some(&b"start"[..]));
        assert_eq!(key(br#"{"output":{"disp"#), Some(&b"output"[..]));
        for text in [&b""[..], b"{", b"{\"sta", b"start", b"[\"start\"]", b"\xff"] {
            assert_eq!(key(text), None);
        }
    }
}
