//! Lines from the host to a device whose time stands still: the same parser, upload, checksums and answers as in [`wire`](crate::wire),
//! without control ticks, and so ten times as fast or more.
//!
//! The first byte selects the device: one finger in one of its states below 0xd0; below 0xf0 one that has received all points of
//! a course of 128 but two; else five fingers. The bytes after it are sent to the device, but for these:
//!
//! | byte         | meaning                                                                             |
//! |--------------|-------------------------------------------------------------------------------------|
//! | 0x80 to 0xbf | a line with the next point of the upload, one of [`STEPS_MS`] and [`STEPS_K`] behind |
//! | 0xd0, 0xd1   | a reception error, a full queue of lines                                            |
//! | 0xd3         | the checksum of the line so far                                                     |
//! | 0xd4         | a line that commits the upload, with its checksum                                   |
//!
//! Each answer is checked by [`ExpectedLines`]. A second device gets each accepted line with one space between words and a
//! checksum, and must answer it in the same way.

use std::sync::OnceLock;

use thermal_display::device::FingerIndex;
use thermal_display::protocol::{LineError, LineReader};

use crate::device::CheckedDevice;
use crate::expected_lines::{ExpectedLines, exclusive_or};
use crate::start::StartDevices;

/// Times between points. With 1 ms the limit of the rate is between two of the [`STEPS_K`].
const STEPS_MS: [u32; 8] = [1, 0, 2, 10, 50, 1000, 30_000, 600_000];
/// Differences of temperature.
const STEPS_K: [f64; 8] = [0.0, 0.05, -0.09, -0.12, 0.09, 0.12, 1.0, -5.0];

static ONE: StartDevices<1> = StartDevices::new();
static FIVE: StartDevices<5> = StartDevices::new();
/// A host that has uploaded all points of a course of 128 but two.
static UPLOADING: OnceLock<Host<1>> = OnceLock::new();

/// See [the module](self).
pub fn run(input: &[u8]) -> bool {
    match input.split_first() {
        None => return false,
        Some((first, bytes)) if *first < 0xd0 => Host::of(ONE.get(*first)).play(bytes),
        Some((first, bytes)) if *first < 0xf0 => {
            UPLOADING.get_or_init(uploading).clone().play(bytes)
        }
        Some((first, bytes)) => Host::of(FIVE.get(*first)).play(bytes),
    }
    true
}

fn uploading() -> Host<1> {
    // The third device is armed.
    let mut host = Host::of(ONE.get(2));
    host.send(b"upload begin course 128 absolute\n");
    (0..126).for_each(|_| host.send_next_point(0));
    host
}

/// The input, with bytes that are not printable escaped.
pub fn show(input: &[u8]) -> String {
    input.escape_ascii().to_string()
}

/// A host that knows what it has sent.
#[derive(Clone)]
struct Host<const FINGERS: usize> {
    device: CheckedDevice<FINGERS>,
    /// Gets accepted lines in another form.
    second: CheckedDevice<FINGERS>,
    reader: LineReader,
    expected: ExpectedLines,
    /// Bytes since the last line end.
    line: Vec<u8>,
}

impl<const FINGERS: usize> Host<FINGERS> {
    fn of(device: CheckedDevice<FINGERS>) -> Self {
        Self {
            second: device.clone(),
            device,
            reader: LineReader::new(),
            expected: ExpectedLines::new(FINGERS),
            line: Vec::new(),
        }
    }

    fn play(mut self, bytes: &[u8]) {
        for &byte in bytes {
            match byte {
                0x80..=0xbf => self.send_next_point(byte & 0x3f),
                0xd0 => self.reader.mark_invalid(LineError::Reception),
                0xd1 => self.reader.mark_invalid(LineError::QueueFull),
                0xd3 => {
                    let checksum = format!("*{:02X}", exclusive_or(&self.line));
                    self.send(checksum.as_bytes());
                }
                0xd4 => {
                    let checksum = self.expected.upload_checksum();
                    self.send(format!("\nupload commit {checksum:08x}\n").as_bytes());
                }
                byte => self.send(&[byte]),
            }
        }
        // Ends the last line.
        self.send(b"\n");
    }

    fn send_next_point(&mut self, steps: u8) {
        let row = self.expected.received();
        // 40 °C is near enough to 42 °C for a dose that is refused.
        let [time_s, celsius] = self.expected.last_row().unwrap_or([0.0, 40.0]);
        let time_s = time_s + 1e-3 * f64::from(STEPS_MS[usize::from(steps >> 3)]);
        let celsius = celsius + STEPS_K[usize::from(steps & 7)];
        self.send(format!("\nupload row {row} {time_s:.3} {celsius:.2}\n").as_bytes());
    }

    fn send(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            if LineReader::is_line_end(byte) {
                self.line.clear();
            } else {
                self.line.push(byte);
            }
            match self.reader.push(byte) {
                None => {}
                Some(Err(error)) => self.device.refuse(error),
                Some(Ok(line)) => self.answer(&line),
            }
        }
    }

    fn answer(&mut self, line: &str) {
        let tripped = FingerIndex::all().any(|finger| self.device.state(finger).fault().is_some());
        let answer = self.device.line(line);
        self.expected.check(line, &answer, tripped);
        let second = if answer.is_ok() {
            self.second.line(&in_another_form(line))
        } else {
            self.second.line(line)
        };
        assert_eq!(second, answer, "{line:?} in another form");
    }
}

/// An accepted line with one space between words, and with a checksum. The spaces of an upload stay: its own checksum is over the
/// line as it was sent.
fn in_another_form(line: &str) -> String {
    let (content, _) = line.split_once('*').unwrap_or((line, ""));
    let words: Vec<_> = content.split_ascii_whitespace().collect();
    let content = if words.contains(&"upload") { content.into() } else { words.join(" ") };
    format!("{content}*{:02x}", exclusive_or(content.as_bytes()))
}
