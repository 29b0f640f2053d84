//! Bytes from the host to lines.

use heapless::String;

/// Longest line from the host, in bytes, without its end.
pub const LINE_MAX: usize = 96;

/// Longest line to the host, in bytes, without a finger before it and without its end.
pub const ANSWER_MAX: usize = 172;

/// One complete line.
pub type Line = String<LINE_MAX>;

/// Why bytes did not make a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineError {
    /// More than [`LINE_MAX`] bytes before the end of the line.
    TooLong,
    /// A byte that is not printable ASCII.
    NotText(u8),
    /// A byte was damaged or lost on the line.
    Reception,
    /// More lines were waiting for their answers than there is room for.
    Refused,
}

/// Collects bytes into lines; a bad line is dropped whole, up to its end.
#[derive(Debug, Default)]
pub struct LineReader {
    line: Line,
    error: Option<LineError>,
}

impl LineReader {
    /// An empty reader.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            line: String::new(),
            error: None,
        }
    }

    /// Spoils the line that is being collected; its end is then answered with `error`.
    pub fn fail(&mut self, error: LineError) {
        self.error.get_or_insert(error);
    }

    /// Whether a byte ends a line, empty or not.
    #[must_use]
    pub const fn is_end(byte: u8) -> bool {
        matches!(byte, b'\r' | b'\n')
    }

    /// Takes one byte; carriage return or line feed ends a line, empty lines are skipped.
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
