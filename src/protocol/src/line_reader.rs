//! Assembly of the bytes received from the host to lines.

use heapless::String;

/// Length of the longest line that is accepted from the host, bytes, with its checksum and without its line ending.
pub const LINE_MAX_BYTES: usize = 96;

/// Length of the longest line to the host, bytes, without the address of a finger, its checksum and its line ending. It
/// is the answer to an unknown command, which lists all commands.
pub const ANSWER_MAX_BYTES: usize = 286;

/// A complete line from the host, without its line ending: at most 96 characters of printable ASCII.
pub type Line = String<LINE_MAX_BYTES>;

/// Why bytes received from the host form no valid line. The line is not executed, and its answer is this error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineError {
    /// The line from the host is longer than [`LINE_MAX_BYTES`], 96 bytes.
    TooLong,
    /// The line from the host contains this byte, which is not printable ASCII (0x20 to 0x7e).
    NotText(u8),
    /// The serial port reported that a byte of the line was damaged or lost; the host must send the line again.
    Reception,
    /// The line was dropped because the queue of received lines was full, or because answers to lines dropped before
    /// are still due: the host sends lines faster than it awaits their answers.
    QueueFull,
}

/// Collects the bytes received from the host to lines. An invalid line is dropped as a whole, and its first error is
/// returned when its line ending arrives.
#[derive(Clone, Debug, Default)]
pub struct LineReader {
    line: Line,
    error: Option<LineError>,
}

impl LineReader {
    /// A reader that has received no byte of a line yet.
    pub const fn new() -> Self {
        Self { line: String::new(), error: None }
    }

    /// Marks the line that is being received as invalid; [`Self::push`] returns `error`, or an earlier error of the
    /// same line, when the line ending arrives. Called when the serial port reports a damaged or lost byte.
    pub fn mark_invalid(&mut self, error: LineError) {
        self.error.get_or_insert(error);
    }

    /// Whether `byte` is a line ending: carriage return or line feed.
    pub const fn is_line_end(byte: u8) -> bool {
        matches!(byte, b'\r' | b'\n')
    }

    /// Processes one received byte. At the line ending, carriage return or line feed, returns the complete line or, if
    /// the line is invalid, its first error; returns `None` for an empty line, and for every byte that is not a line
    /// ending.
    pub fn push(&mut self, byte: u8) -> Option<Result<Line, LineError>> {
        match byte {
            _ if Self::is_line_end(byte) => {
                let line = core::mem::take(&mut self.line);
                match self.error.take() {
                    Some(error) => Some(Err(error)),
                    None if line.is_empty() => None,
                    None => Some(Ok(line)),
                }
            }
            b' '..=b'~' => {
                if self.line.push(char::from(byte)).is_err() {
                    self.error.get_or_insert(LineError::TooLong);
                }
                None
            }
            other => {
                self.error.get_or_insert(LineError::NotText(other));
                None
            }
        }
    }
}
