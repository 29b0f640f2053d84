//! Assembly of received bytes to lines.

use heapless::String;

/// Longest line from the host, bytes, without its line ending.
pub const LINE_MAX_BYTES: usize = 96;

/// Longest line to the host, bytes, without the address of a finger and without its line ending.
pub const ANSWER_MAX_BYTES: usize = 172;

/// A complete line from the host, without its line ending.
pub type Line = String<LINE_MAX_BYTES>;

/// Why received bytes form no line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineError {
    /// The line is longer than [`LINE_MAX_BYTES`].
    TooLong,
    /// The line contains this byte, which is not printable ASCII.
    NotText(u8),
    /// A byte of the line was damaged or lost during reception.
    Reception,
    /// The queue of lines that wait for their answers was full.
    QueueFull,
}

/// Collects bytes to lines. An invalid line is dropped as a whole, and reported at its end.
#[derive(Debug, Default)]
pub struct LineReader {
    line: Line,
    error: Option<LineError>,
}

impl LineReader {
    /// A reader that has received no byte of a line yet.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            line: String::new(),
            error: None,
        }
    }

    /// Marks the line that is being collected as invalid; [`Self::push`] returns `error` at its end.
    pub fn fail(&mut self, error: LineError) {
        self.error.get_or_insert(error);
    }

    /// Whether a byte ends a line, empty or not.
    #[must_use]
    pub const fn is_end(byte: u8) -> bool {
        matches!(byte, b'\r' | b'\n')
    }

    /// Takes one byte, and returns the line that it ends. Carriage return and line feed end a line; empty lines are skipped.
    pub fn push(&mut self, byte: u8) -> Option<Result<Line, LineError>> {
        match byte {
            _ if Self::is_end(byte) => {
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
