//! The first channel of the DAC (RM0390 chapter 14), whose pin is PA4, without its output buffer and without triggers.
use super::stop::{Answer, Refusal, only};

const EN1: u32 = 1;
const BOFF1: u32 = 1 << 1;

#[derive(Default)]
pub(crate) struct Dac {
    cr: u32,
    /// Holding and output register, which follows it within a bus clock.
    code: u32,
}

impl Dac {
    /// Code of the voltage at the pin in units of 1/4096 of the reference, while the channel drives it.
    pub fn output(&self) -> Option<u16> {
        (self.cr & EN1 != 0).then_some(self.code as u16)
    }

    pub fn read(&self, offset: u32) -> Answer<u32> {
        match offset {
            0x00 => Ok(self.cr),
            0x08 | 0x2c => Ok(self.code),
            _ => Err(Refusal::Offset),
        }
    }

    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x00 => {
                only(value, EN1 | BOFF1, "DAC_CR beyond EN1 and BOFF1")?;
                if value & (EN1 | BOFF1) == EN1 {
                    return Err(Refusal::NotModelled("the buffer of the DAC's output"));
                }
                self.cr = value;
            }
            0x08 => {
                only(value, 0xfff, "DAC_DHR12R1 reserved bits")?;
                self.code = value;
            }
            _ => return Err(Refusal::Offset),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_output_follows_its_register_while_enabled_without_buffer() {
        let mut dac = Dac::default();
        dac.write(0x08, 1234).unwrap();
        assert_eq!(dac.output(), None);
        assert!(dac.write(0x00, EN1).is_err(), "with the buffer");
        dac.write(0x00, EN1 | BOFF1).unwrap();
        assert_eq!(dac.output(), Some(1234));
        assert_eq!(dac.read(0x2c), Ok(1234));
    }
}
