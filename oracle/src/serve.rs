//! Lines in and out: the loop of `oracle serve`.

use std::io::{self, BufRead, BufReader, ErrorKind, Read, Write};

use memchr::memchr;

use atc_protocol::{MAX_LINE, Session};

/// Bytes that are read or written at once.
const CHUNK: usize = 1 << 16;

/// Answers every line of `input` on `output` until the input ends or nobody reads the output any more.
///
/// Replies are held back only while more input is at hand: a client that waits for each answer gets it at once, and
/// one that sends many requests ahead gets its answers in large pieces. A last line without a newline is a line.
///
/// # Errors
/// If the input cannot be read or the output cannot be written. A closed output is not an error.
pub fn serve(input: impl Read, output: impl Write) -> io::Result<()> {
    match converse(BufReader::with_capacity(CHUNK, input), output) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

fn converse<R: Read>(mut input: BufReader<R>, mut output: impl Write) -> io::Result<()> {
    let mut session = Session::new();
    let mut replies = Vec::with_capacity(2 * CHUNK);
    // The beginning of a line whose end has not been read yet.
    let mut begun: Vec<u8> = Vec::new();
    // Set once that line is too long: the rest of it is passed over.
    let mut overlong = false;
    loop {
        if !replies.is_empty() && (input.buffer().is_empty() || replies.len() >= CHUNK) {
            output.write_all(&replies)?;
            output.flush()?;
            replies.clear();
        }
        let chunk = match input.fill_buf() {
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            chunk => chunk?,
        };
        if chunk.is_empty() {
            break;
        }
        if let Some(end) = memchr(b'\n', chunk) {
            let line = &chunk[..end];
            if overlong {
                session.answer_overlong(&mut replies);
            } else if begun.is_empty() {
                session.answer(line, &mut replies);
            } else {
                begun.extend_from_slice(line);
                session.answer(&begun, &mut replies);
            }
            overlong = false;
            begun.clear();
            input.consume(end + 1);
        } else {
            let length = chunk.len();
            overlong |= begun.len() + length > MAX_LINE;
            if overlong {
                begun = Vec::new();
            } else {
                begun.extend_from_slice(chunk);
            }
            input.consume(length);
        }
    }
    if overlong {
        session.answer_overlong(&mut replies);
    } else if !begun.is_empty() {
        session.answer(&begun, &mut replies);
    }
    output.write_all(&replies)?;
    output.flush()
}
