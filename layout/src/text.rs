//! Files as text, and what is wrong with them in words that an engineer reads.

use std::fs;
use std::path::Path;

/// The text of a file.
///
/// # Errors
/// It cannot be read, or is not UTF-8: why.
pub fn read(path: &Path) -> Result<String, String> {
    let bytes = fs::read(path).map_err(|error| format!("cannot be read: {error}"))?;
    utf8(bytes).map_err(|place| format!("{place}; save the file as UTF-8"))
}

/// The text that these bytes are.
///
/// # Errors
/// Where they are not UTF-8: `line 3, byte 40 is not UTF-8`. Lines are counted from 1, bytes of the file from 0.
pub fn utf8(bytes: Vec<u8>) -> Result<String, String> {
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..valid].split(|byte| *byte == b'\n').count();
        format!("line {line}, byte {valid} is not UTF-8")
    })
}

/// Types of Rust at the end of a message, and what an engineer writes for them.
const TYPES: [(&str, &str); 9] = [
    ("expected u8", "a whole number, 0 to 255"),
    ("expected u16", "a whole number, 0 to 65535"),
    ("expected u32", "a whole number, 0 to 4294967295"),
    ("expected u64", "a whole number, 0 or more"),
    ("expected usize", "a whole number, 0 or more"),
    ("expected i8", "a whole number, -128 to 127"),
    ("expected f64", "a number, with or without a point"),
    ("expected a boolean", "true or false, without quotation marks"),
    ("expected a sequence", "a list in square brackets"),
];

/// A message of a reader in one line, with what a type is written as.
#[must_use]
pub fn in_words(message: &str) -> String {
    let line = message.trim_end().replace('\n', " ");
    match TYPES.iter().find(|(end, _)| line.ends_with(end)) {
        Some((_, written)) => format!("{line} ({written})"),
        None => line,
    }
}

#[cfg(test)]
mod tests {
    use super::{in_words, utf8};

    #[test]
    fn a_byte_that_is_no_text_is_told_with_its_line() {
        assert_eq!(utf8(b"a\nb\xff".to_vec()), Err("line 2, byte 3 is not UTF-8".to_owned()));
        assert_eq!(utf8("Straße".as_bytes().to_vec()), Ok("Straße".to_owned()));
    }

    #[test]
    fn a_type_is_said_in_words_once() {
        assert_eq!(
            in_words("invalid type: string \"far\", expected u16\n"),
            "invalid type: string \"far\", expected u16 (a whole number, 0 to 65535)"
        );
        assert_eq!(in_words("unknown field `tow`"), "unknown field `tow`");
        assert!(!in_words("expected u16 or nothing").contains("65535"));
    }
}
