//! Text files that people and their tools write: UTF-8, with or without a byte order mark.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// Byte order mark of UTF-8, which spreadsheets and some editors write.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// Opens a text file behind its byte order mark.
///
/// # Errors
/// The file cannot be read, or is UTF-16 or UTF-32 (`InvalidData`).
pub fn open(path: &Path) -> io::Result<BufReader<File>> {
    let mut file = BufReader::new(File::open(path)?);
    let mark = mark_length(file.fill_buf()?)?;
    file.consume(mark);
    Ok(file)
}

/// The text of a file without its byte order mark.
///
/// # Errors
/// The file cannot be read, or is not UTF-8 (`InvalidData`).
pub fn read(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    open(path)?.read_to_end(&mut bytes)?;
    decode(bytes)
}

/// The text of a file's bytes without its byte order mark.
///
/// # Errors
/// The bytes are not UTF-8 (`InvalidData`).
pub fn decode(mut bytes: Vec<u8>) -> io::Result<String> {
    bytes.drain(..mark_length(&bytes)?);
    String::from_utf8(bytes).map_err(|error| {
        let (at, bytes) = (error.utf8_error().valid_up_to(), error.as_bytes());
        let line = bytes[..at].iter().filter(|byte| **byte == b'\n').count() + 1;
        invalid(format!("line {line}: byte 0x{:02x} is not UTF-8; allowed is UTF-8", bytes[at]))
    })
}

/// Length of the byte order mark with which these first bytes begin.
///
/// # Errors
/// They are UTF-16 or UTF-32, with a mark, or without one as a tool writes them that says its byte order elsewhere: an ASCII
/// character beside a zero.
pub fn mark_length(first: &[u8]) -> io::Result<usize> {
    let encoding = match first {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => "UTF-32",
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [1..=0xff, 0, ..] | [0, 1..=0xff, ..] => "UTF-16",
        _ => return Ok(if first.starts_with(MARK) { MARK.len() } else { 0 }),
    };
    Err(invalid(format!("this is {encoding}; allowed is UTF-8")))
}

fn invalid(problem: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, problem)
}

#[cfg(test)]
mod tests {
    use super::decode;

    /// What a text editor saves as each of its encodings.
    #[test]
    fn utf_8_is_read_with_and_without_a_mark_and_other_encodings_are_named() {
        for bytes in ["state\n°C\n".as_bytes(), "\u{feff}state\n°C\n".as_bytes()] {
            assert_eq!(decode(bytes.to_vec()).unwrap(), "state\n°C\n");
        }
        assert_eq!(decode(Vec::new()).unwrap(), "");
        let utf_16 = |to_bytes: fn(u16) -> [u8; 2], text: &str| {
            text.encode_utf16().flat_map(to_bytes).collect::<Vec<u8>>()
        };
        for text in ["\u{feff}state\n", "state\n"] {
            for to_bytes in [u16::to_le_bytes, u16::to_be_bytes] {
                let error = decode(utf_16(to_bytes, text)).unwrap_err();
                assert_eq!(error.to_string(), "this is UTF-16; allowed is UTF-8");
            }
        }
        for to_bytes in [u32::to_le_bytes, u32::to_be_bytes] {
            let bytes = "\u{feff}state".chars().flat_map(|c| to_bytes(u32::from(c)));
            let error = decode(bytes.collect()).unwrap_err();
            assert_eq!(error.to_string(), "this is UTF-32; allowed is UTF-8");
        }
        let latin_1 = decode(b"state\n23 \xb0C\n".to_vec()).unwrap_err();
        assert_eq!(latin_1.to_string(), "line 2: byte 0xb0 is not UTF-8; allowed is UTF-8");
    }
}
