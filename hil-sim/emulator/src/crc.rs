//! The CRC calculation unit (RM0390 chapter 4): a word at a time, from its most significant bit on.
use super::stop::{Answer, Refusal, only};

const POLYNOMIAL: u32 = 0x04c1_1db7;
const INITIAL: u32 = u32::MAX;

pub(crate) struct Crc {
    remainder: u32,
    /// CRC_IDR, a byte of memory that resetting the calculation leaves alone.
    independent: u32,
}

impl Default for Crc {
    fn default() -> Self {
        Self { remainder: INITIAL, independent: 0 }
    }
}

impl Crc {
    pub fn read(&self, offset: u32) -> Answer<u32> {
        match offset {
            0x0 => Ok(self.remainder),
            0x4 => Ok(self.independent),
            0x8 => Ok(0),
            _ => Err(Refusal::Offset),
        }
    }

    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x0 => {
                self.remainder = (0..32).fold(self.remainder ^ value, |crc, _| {
                    crc << 1 ^ if crc >> 31 != 0 { POLYNOMIAL } else { 0 }
                });
            }
            0x4 => {
                only(value, 0xff, "CRC_IDR reserved bits")?;
                self.independent = value;
            }
            0x8 => {
                only(value, 1, "CRC_CR reserved bits")?;
                if value != 0 {
                    self.remainder = INITIAL;
                }
            }
            _ => return Err(Refusal::Offset),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::crc::CRC_32_MPEG_2;

    #[test]
    fn words_are_taken_from_the_most_significant_bit_on() {
        let mut crc = Crc::default();
        crc.write(0, u32::from_be_bytes(*b"1234")).unwrap();
        crc.write(0, u32::from_be_bytes(*b"5678")).unwrap();
        assert_eq!(crc.read(0), Ok(::crc::Crc::<u32>::new(&CRC_32_MPEG_2).checksum(b"12345678")));
        crc.write(8, 1).unwrap();
        assert_eq!(crc.read(0), Ok(INITIAL));
    }
}
