//! Bytes from the host.
//!
//! The first byte selects the device: its low seven bits the state, its highest bit five fingers instead of one. Of the
//! bytes after it, those below 0x80 are sent to the device; the others, which no line contains, are events between them:
//!
//! | byte         | meaning                                                   |
//! |--------------|-----------------------------------------------------------|
//! | 0x80 to 0xbf | 1 to 64 ticks                                             |
//! | 0xc0 to 0xcf | all fingers press, in steps of 0.2 N                      |
//! | 0xd0, 0xd1   | a reception error, a full queue of lines                  |
//! | 0xd2         | activity of the host                                      |
//! | 0xd3         | the checksum of the line so far                           |
//! | 0xd4         | a line that commits the upload, with its checksum         |
//! | 0xd5, 0xd6   | an edge at the trigger input in the coming tick, or in the one before |
//! | others       | sent to the device, as bytes that no line may contain     |

use thermal_display::device::TriggerEdge;
use thermal_display::protocol::{LineError, LineReader};

use crate::device::CheckedDevice;
use crate::start::StartDevices;

/// Largest number of ticks of one input; longer runs find nothing more.
const TICKS: u32 = 2500;

static ONE: StartDevices<1> = StartDevices::new();
static FIVE: StartDevices<5> = StartDevices::new();

/// See [the module](self).
pub fn run(input: &[u8]) -> bool {
    match input.split_first() {
        None => false,
        Some((first, bytes)) if first & 0x80 == 0 => play(ONE.get(*first), bytes),
        Some((first, bytes)) => play(FIVE.get(first & 0x7f), bytes),
    }
}

/// The input, with bytes that are not printable escaped.
pub fn show(input: &[u8]) -> String {
    input.escape_ascii().to_string()
}

fn play<const FINGERS: usize>(mut device: CheckedDevice<FINGERS>, bytes: &[u8]) -> bool {
    let mut reader = LineReader::new();
    let mut remaining = TICKS / FINGERS as u32;
    let mut line = Vec::new();
    let mut uploaded = Vec::new();
    for &byte in bytes {
        match byte {
            0x80..=0xbf => {
                let ticks = remaining.min(u32::from(byte & 0x3f) + 1);
                remaining -= ticks;
                device.run(ticks);
            }
            0xc0..=0xcf => device.press_all(0.2 * f64::from(byte & 0x0f)),
            0xd0 => reader.mark_invalid(LineError::Reception),
            0xd1 => reader.mark_invalid(LineError::QueueFull),
            0xd2 => device.note_host_activity(),
            0xd3 => {
                let checksum = format!("*{:02X}", line.iter().fold(0, |xor, byte| xor ^ byte));
                for byte in checksum.bytes() {
                    device.byte(&mut reader, byte);
                }
            }
            0xd4 => {
                let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&uploaded);
                for byte in format!("\nupload commit {checksum:08x}\n").bytes() {
                    device.byte(&mut reader, byte);
                }
                line.clear();
            }
            0xd5 | 0xd6 => device.trigger(TriggerEdge { us: 437, ticks_ago: byte & 1 ^ 1 }),
            byte => {
                device.byte(&mut reader, byte);
                if LineReader::is_line_end(byte) {
                    if line.starts_with(b"upload begin ") {
                        uploaded.clear();
                    }
                    uploaded.extend(line.iter().chain(b"\n"));
                    line.clear();
                } else {
                    line.push(byte);
                }
            }
        }
    }
    // Ends the last line.
    device.byte(&mut reader, b'\n');
    true
}
