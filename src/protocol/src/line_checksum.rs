//! Checksum at the end of a line: `*` and two hexadecimal digits, as in `state*77`, the form of NMEA 0183.

use core::fmt::{self, Write as _};
use core::ops::Deref;

use thermal_wire::{QuotedWordExcerpt, TwoHexDigits};

use crate::ANSWER_MAX_BYTES;

/// Bytes of the longest line to the host: address of a finger, longest answer, checksum and line feed.
const OUTGOING_LINE_MAX_BYTES: usize = "@0 ".len() + ANSWER_MAX_BYTES + "*00".len() + 1;

/// A line to the host with its line feed; dereferences to its bytes.
#[derive(Clone, Debug)]
pub struct OutgoingLine {
    bytes: [u8; OUTGOING_LINE_MAX_BYTES],
    length: usize,
}

impl OutgoingLine {
    /// An empty line.
    pub const fn new() -> Self {
        Self { bytes: [0; OUTGOING_LINE_MAX_BYTES], length: 0 }
    }

    /// Appends bytes, if there is room for all of them.
    #[inline]
    fn push(&mut self, bytes: &[u8]) -> fmt::Result {
        let end = self.length + bytes.len();
        let place = self.bytes.get_mut(self.length..end).ok_or(fmt::Error)?;
        place.copy_from_slice(bytes);
        self.length = end;
        Ok(())
    }
}

impl Default for OutgoingLine {
    fn default() -> Self {
        Self::new()
    }
}

impl Deref for OutgoingLine {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or_default()
    }
}

impl fmt::Write for OutgoingLine {
    #[inline]
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.push(text.as_bytes())
    }
}

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
pub fn line_checksum(line: &[u8]) -> u8 {
    line.iter().fold(0, |checksum, byte| checksum ^ byte)
}

/// The content of a line without its checksum, if it has one.
///
/// # Errors
/// The checksum is wrong, or what follows `*` is none.
#[inline(never)]
pub fn strip_checksum(line: &str) -> Result<&str, ChecksumError> {
    let Some((content, digits)) = line.split_once(['*']) else {
        return Ok(line);
    };
    // `from_str_radix` accepts a leading `+`.
    let valid = digits.len() == 2 && !digits.starts_with('+');
    let Some(received) = u8::from_str_radix(digits, 16).ok().filter(|_| valid) else {
        return Err(ChecksumError::Malformed(digits.into()));
    };
    let actual = line_checksum(content.as_bytes());
    if received == actual { Ok(content) } else { Err(ChecksumError::Wrong(received, actual)) }
}

/// Replaces `line` by this content, a checksum if it shall have one, and a line feed.
#[inline]
pub fn write_line(line: &mut OutgoingLine, content: &dyn fmt::Display, with_checksum: bool) {
    line.length = 0;
    // All lines of the protocol fit; of a longer one the part that does not fit is left out.
    let _ = write!(line, "{content}");
    if with_checksum {
        let checksum = line_checksum(line);
        let _ = write!(line, "*{}", TwoHexDigits(checksum));
    }
    line.length = line.length.min(OUTGOING_LINE_MAX_BYTES - 1);
    let _ = line.push(b"\n");
}
