//! Splits received bytes into lines.

/// Received bytes of incomplete lines.
#[derive(Clone, Debug, Default)]
pub struct LineSplitter(Vec<u8>);

impl LineSplitter {
    /// The buffer to which received bytes are appended.
    pub const fn received(&mut self) -> &mut Vec<u8> {
        &mut self.0
    }

    /// Removes and returns the complete lines, without line ends.
    pub fn complete(&mut self) -> Vec<String> {
        let Some(end) = self.0.iter().rposition(|byte| *byte == b'\n') else {
            return Vec::new();
        };
        let complete: Vec<u8> = self.0.drain(..=end).collect();
        String::from_utf8_lossy(&complete)
            .lines()
            .map(|line| line.trim_end().to_owned())
            .collect()
    }
}
