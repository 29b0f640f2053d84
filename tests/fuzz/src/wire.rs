//! Bytes from the host.
//!
//! The first byte says where the device is: its low seven bits in which state, its highest whether it has five fingers.
//! After it, bytes below 0x80 are the host's; the others, which no line has, say what happens between:
//!
//! | byte         | meaning                                                   |
//! |--------------|-----------------------------------------------------------|
//! | 0x80 to 0xbf | 1 to 64 ticks                                             |
//! | 0xc0 to 0xcf | all fingers press, in steps of 0.2 N                      |
//! | 0xd0, 0xd1   | a byte was damaged, a line found no room                  |
//! | 0xd2         | the host was heard                                        |
//! | others       | themselves                                                |

use thermal_display::protocol::{LineError, LineReader};

use crate::device::Device;
use crate::start::Starts;

/// Ticks of one input, at most: more of the same finds nothing more.
const TICKS: u32 = 2500;

static ONE: Starts<1> = Starts::new();
static FIVE: Starts<5> = Starts::new();

/// See [the module](self).
pub fn run(input: &[u8]) -> bool {
    match input.split_first() {
        None => false,
        Some((first, bytes)) if first & 0x80 == 0 => play(ONE.get(*first), bytes),
        Some((first, bytes)) => play(FIVE.get(first & 0x7f), bytes),
    }
}

/// What happens, in the host's words.
pub fn show(input: &[u8]) -> String {
    input.escape_ascii().to_string()
}

fn play<const FINGERS: usize>(mut device: Device<FINGERS>, bytes: &[u8]) -> bool {
    let mut reader = LineReader::new();
    let mut left = TICKS / FINGERS as u32;
    for &byte in bytes {
        match byte {
            0x80..=0xbf => {
                let ticks = left.min(u32::from(byte & 0x3f) + 1);
                left -= ticks;
                (0..ticks).for_each(|_| device.tick());
            }
            0xc0..=0xcf => {
                let newton = 0.2 * f64::from(byte & 0x0f);
                (0..FINGERS).for_each(|finger| device.tile(finger).press(newton));
            }
            0xd0 => reader.fail(LineError::Reception),
            0xd1 => reader.fail(LineError::QueueFull),
            0xd2 => device.hear(),
            byte => device.byte(&mut reader, byte),
        }
    }
    // The last line need not end.
    device.byte(&mut reader, b'\n');
    true
}
