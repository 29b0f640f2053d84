//! Checksum at the end of a line: `*` and two hexadecimal digits, as in `state*77`, the form of NMEA 0183.

use core::fmt::{self, Write as _};

use heapless::Vec;

use crate::{ANSWER_MAX_BYTES, QuotedWordExcerpt};

/// Bytes of the longest line to the host: address of a finger, longest answer, checksum and line feed.
const OUTGOING_LINE_MAX_BYTES: usize = "@0 ".len() + ANSWER_MAX_BYTES + "*00".len() + 1;

/// A line to the host with its line feed.
pub type OutgoingLine = Vec<u8, OUTGOING_LINE_MAX_BYTES>;

/// Why a line is rejected for its checksum. It is not executed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ChecksumError {
    /// The line ends with the first checksum, but its bytes have the second one.
    Wrong(u8, u8),
    /// What follows `*`, quoted here, is not a hexadecimal number of two digits.
    Malformed(QuotedWordExcerpt),
    /// The line has no checksum, although checksums are on; its bytes have this one.
    Missing(u8),
}

/// Checksum of a line: the exclusive or of all bytes before the `*`.
#[must_use]
pub fn line_checksum(line: &[u8]) -> u8 {
    line.iter().fold(0, |checksum, byte| checksum ^ byte)
}

/// The content of a line without its checksum, if it has one.
///
/// # Errors
/// The checksum is wrong, or what follows `*` is none.
#[inline(never)]
pub fn strip_checksum(line: &str) -> Result<&str, ChecksumError> {
    let Some((content, digits)) = line.split_once('*') else {
        return Ok(line);
    };
    // `from_str_radix` accepts a leading `+`.
    let valid = digits.len() == 2 && !digits.starts_with('+');
    let Some(received) = u8::from_str_radix(digits, 16).ok().filter(|_| valid) else {
        return Err(ChecksumError::Malformed(digits.into()));
    };
    let actual = line_checksum(content.as_bytes());
    if received == actual {
        Ok(content)
    } else {
        Err(ChecksumError::Wrong(received, actual))
    }
}

/// A byte, written with two upper-case digits. `{:02X}` would add 0.9 KB to the image.
pub struct TwoHexDigits(pub u8);

impl fmt::Display for TwoHexDigits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        [self.0 >> 4, self.0 & 0x0f]
            .into_iter()
            .try_for_each(|digit| {
                let first = if digit < 10 { b'0' } else { b'A' - 10 };
                f.write_char(char::from(first + digit))
            })
    }
}

/// Replaces `line` by this content, a checksum if it shall have one, and a line feed.
#[inline(never)]
pub fn write_line(line: &mut OutgoingLine, content: &dyn fmt::Display, with_checksum: bool) {
    line.clear();
    // All lines of the protocol fit; a longer one would be truncated.
    let _ = write!(line, "{content}");
    if with_checksum {
        let checksum = line_checksum(line);
        let _ = write!(line, "*{}", TwoHexDigits(checksum));
    }
    line.truncate(OUTGOING_LINE_MAX_BYTES - 1);
    let _ = line.push(b'\n');
}
