//! General-purpose I/O ports A to H (RM0390 chapter 7).
use super::stop::{Answer, Refusal, only};

/// Ports of the chip.
pub(crate) const PORTS: usize = 8;

/// Offset of the input data register.
pub(crate) const INPUT_DATA: u32 = 0x10;

/// One port of 16 pins.
#[derive(Default)]
pub(crate) struct Port {
    moder: u32,
    otyper: u32,
    ospeedr: u32,
    pupdr: u32,
    odr: u32,
    afr: [u32; 2],
}

/// Mode of a pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mode {
    Input,
    Output,
    Alternate(u8),
    Analog,
}

impl Port {
    /// Port 0 is A. Reset values: 7.4.1 to 7.4.4; the debug pins start as alternate functions.
    pub fn new(port: usize) -> Self {
        let (moder, ospeedr, pupdr) = match port {
            0 => (0xa800_0000, 0x0c00_0000, 0x6400_0000),
            1 => (0x0000_0280, 0x0000_00c0, 0x0000_0100),
            _ => (0, 0, 0),
        };
        Self { moder, ospeedr, pupdr, ..Self::default() }
    }

    pub fn mode(&self, bit: u8) -> Mode {
        match self.moder >> (2 * bit) & 3 {
            0 => Mode::Input,
            1 => Mode::Output,
            2 => Mode::Alternate((self.afr[usize::from(bit / 8)] >> (4 * (bit % 8)) & 0xf) as u8),
            _ => Mode::Analog,
        }
    }

    /// Pins whose drivers only pull low, one bit each.
    pub const fn open_drain(&self) -> u32 {
        self.otyper
    }

    /// Level that the pin drives as a general-purpose output; `None` if it is not an output, or open-drain and high.
    pub fn output(&self, bit: u8) -> Option<bool> {
        let is_output = self.moder >> (2 * bit) & 3 == 1;
        let high = self.odr >> bit & 1 != 0;
        let floats = high && self.otyper >> bit & 1 != 0;
        (is_output && !floats).then_some(high)
    }

    /// Masks of the bits driven as general-purpose outputs, and of their levels.
    pub fn outputs(&self) -> (u32, u32) {
        let is_output =
            (0..16).fold(0, |mask, bit| mask | u32::from(self.moder >> (2 * bit) & 3 == 1) << bit);
        let driven = is_output & !(self.odr & self.otyper);
        (driven, self.odr & driven)
    }

    /// Input level of a pin that the outside drives to `external`, also against an output: it is then shorted, or its output
    /// is damaged. A floating pin reads low.
    pub fn level(&self, bit: u8, external: Option<bool>) -> bool {
        let pulled_up = self.pupdr >> (2 * bit) & 3 == 1;
        let is_analog = self.moder >> (2 * bit) & 3 == 3;
        external.or(self.output(bit)).unwrap_or(pulled_up) && !is_analog
    }

    /// Reads a register; `external` gives the levels at the pins.
    pub fn read(&self, offset: u32, external: impl Fn(u8) -> Option<bool>) -> Answer<u32> {
        Ok(match offset {
            0x00 => self.moder,
            0x04 => self.otyper,
            0x08 => self.ospeedr,
            0x0c => self.pupdr,
            INPUT_DATA => (0..16).filter(|b| self.level(*b, external(*b))).map(|b| 1 << b).sum(),
            0x14 => self.odr,
            0x18 => 0,
            0x20 | 0x24 => self.afr[(offset as usize - 0x20) / 4],
            _ => return Err(Refusal::Offset),
        })
    }

    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x00 => self.moder = value,
            0x04 => {
                only(value, 0xffff, "GPIO_OTYPER reserved bits")?;
                self.otyper = value;
            }
            0x08 => self.ospeedr = value,
            0x0c => self.pupdr = value,
            0x14 => {
                only(value, 0xffff, "GPIO_ODR reserved bits")?;
                self.odr = value;
            }
            0x18 => self.odr = self.odr & !(value >> 16) | value & 0xffff, // a set wins over a reset (7.4.7)
            0x20 | 0x24 => self.afr[(offset as usize - 0x20) / 4] = value,
            _ => return Err(Refusal::Offset),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn set_wins_over_reset_in_one_write() {
        let mut port = Port::new(2);
        port.write(0x00, 0b01).unwrap();
        port.write(0x18, 1 << 16 | 1).unwrap();
        assert_eq!(port.output(0), Some(true));
        port.write(0x18, 1 << 16).unwrap();
        assert_eq!(port.output(0), Some(false));
    }

    #[test]
    fn an_open_drain_output_does_not_drive_high() {
        let mut port = Port::new(2);
        port.write(0x00, 0b01).unwrap();
        port.write(0x04, 1).unwrap();
        port.write(0x14, 1).unwrap();
        assert_eq!(port.output(0), None);
        assert_eq!(port.read(0x10, |_| Some(false)).unwrap() & 1, 0, "the outside pulls it low");
    }

    #[test]
    fn an_output_reads_its_own_level_unless_it_is_shorted() {
        let mut port = Port::new(2);
        port.write(0x00, 0b01).unwrap();
        for level in [0, 1] {
            port.write(0x14, level).unwrap();
            assert_eq!(port.read(0x10, |_| None).unwrap(), level);
            let shorted = port.read(0x10, |_| Some(level == 0)).unwrap();
            assert_eq!(shorted & 1, 1 - level);
        }
    }

    #[test]
    fn an_undriven_input_follows_its_pull_up() {
        let mut port = Port::new(2);
        assert_eq!(port.read(0x10, |_| None).unwrap(), 0);
        port.write(0x0c, 0b01 << 10).unwrap();
        assert_eq!(port.read(0x10, |_| None).unwrap(), 1 << 5);
        assert_eq!(port.read(0x10, |_| Some(false)).unwrap(), 0, "a driver is stronger");
    }
}
