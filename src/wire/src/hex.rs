//! Hexadecimal digits.

use core::fmt::{self, Write as _};

/// A byte, written with two upper-case digits. `{:02X}` would add 0.9 KB to the image.
#[derive(Clone, Copy, Debug)]
pub struct TwoHexDigits(pub u8);

impl fmt::Display for TwoHexDigits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        [self.0 >> 4, self.0 & 0x0f].into_iter().try_for_each(|digit| {
            let first = if digit < 10 { b'0' } else { b'A' - 10 };
            f.write_char(char::from(first + digit))
        })
    }
}
