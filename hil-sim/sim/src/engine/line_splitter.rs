//! Bytes of the device to lines.

/// What has come of lines that are not complete yet.
#[derive(Clone, Debug, Default)]
pub struct LineSplitter(Vec<u8>);

impl LineSplitter {
    /// Where bytes that have come are appended.
    pub const fn received(&mut self) -> &mut Vec<u8> {
        &mut self.0
    }

    /// Takes the lines that are complete, without their ends.
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
