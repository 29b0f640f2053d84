//! Pin interrupts: EXTI lines 0 to 15 (RM0390 chapter 10) and their port selection in SYSCFG (8.2).
use super::stop::{Answer, Refusal, only};

/// Interrupt number of each group of lines, and the lines.
const GROUPS: [(usize, u32); 7] =
    [(6, 1), (7, 2), (8, 4), (9, 8), (10, 0x10), (23, 0x3e0), (40, 0xfc00)];

/// Numbers of the bits that are set in a mask of the lines.
pub(crate) fn lines(mut mask: u32) -> impl Iterator<Item = u8> {
    std::iter::from_fn(move || {
        let line = mask.trailing_zeros();
        mask &= mask.wrapping_sub(1);
        (line < 16).then_some(line as u8)
    })
}

#[derive(Default)]
pub(crate) struct Exti {
    imr: u32,
    rtsr: u32,
    ftsr: u32,
    /// SWIER, which a write of 1 to PR clears.
    software: u32,
    pr: u32,
    levels: u32,
    exticr: [u32; 4],
}

impl Exti {
    /// Lines whose pins must be sampled, one bit each.
    pub const fn watched(&self) -> u32 {
        self.imr & (self.rtsr | self.ftsr)
    }

    /// Port whose pin is connected to a line.
    pub const fn port(&self, line: u8) -> usize {
        (self.exticr[line as usize / 4] >> (4 * (line % 4)) & 0xf) as usize
    }

    /// The level of a line whose pin was not watched before: it is where the next edge starts, and no edge itself.
    pub fn start_from_level(&mut self, line: u8, level: bool) {
        self.levels = self.levels & !(1 << line) | u32::from(level) << line;
    }

    /// New level of a line's pin. `true`: it is an edge that is selected, and pends.
    pub fn set_level(&mut self, line: u8, level: bool) -> bool {
        let bit = 1 << line;
        if (self.levels & bit != 0) == level {
            return false;
        }
        self.levels ^= bit;
        let edge = bit & if level { self.rtsr } else { self.ftsr };
        self.pr |= edge;
        edge != 0
    }

    /// Interrupt requests as `(interrupt, level)`.
    pub fn requests(&self) -> impl Iterator<Item = (usize, bool)> {
        let raised = self.pr & self.imr;
        GROUPS.iter().map(move |(irq, lines)| (*irq, raised & lines != 0))
    }

    pub fn read(&self, offset: u32) -> Answer<u32> {
        Ok(match offset {
            0x00 => self.imr,
            0x04 => 0,
            0x08 => self.rtsr,
            0x0c => self.ftsr,
            0x10 => self.software,
            0x14 => self.pr,
            _ => return Err(Refusal::Offset),
        })
    }

    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        only(value, 0xffff, "EXTI lines above 15")?;
        match offset {
            0x00 => self.imr = value,
            0x04 => only(value, 0, "EXTI_EMR")?,
            0x08 => self.rtsr = value,
            0x0c => self.ftsr = value,
            0x10 => {
                self.pr |= value & !self.software & self.imr;
                self.software = value;
            }
            0x14 => {
                self.pr &= !value;
                self.software &= !value;
            }
            _ => return Err(Refusal::Offset),
        }
        Ok(())
    }

    pub fn reset_syscfg(&mut self) {
        self.exticr = [0; 4];
    }

    pub fn read_syscfg(&self, offset: u32) -> Answer<u32> {
        match offset {
            0x00 | 0x04 => Ok(0),
            0x08..=0x14 => Ok(self.exticr[(offset as usize - 8) / 4]),
            _ => Err(Refusal::Offset),
        }
    }

    pub fn write_syscfg(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x00 => only(value, 0, "SYSCFG_MEMRMP"),
            0x08..=0x14 => {
                only(value, 0x7777, "SYSCFG_EXTICR port")?;
                self.exticr[(offset as usize - 8) / 4] = value;
                Ok(())
            }
            _ => Err(Refusal::Offset),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_falling_edge_pends_until_written_one() {
        let mut exti = Exti::default();
        exti.write(0x00, 1 << 5).unwrap();
        exti.write(0x0c, 1 << 5).unwrap();
        exti.set_level(5, true);
        assert!(exti.requests().all(|(_, level)| !level), "a rising edge is not selected");
        exti.set_level(5, false);
        assert_eq!(
            exti.requests().filter(|r| r.1).map(|r| r.0).collect::<Vec<_>>(),
            [23],
            "EXTI9_5"
        );
        exti.write(0x14, 1 << 5).unwrap();
        assert!(exti.requests().all(|(_, level)| !level));
    }

    #[test]
    fn exticr_selects_the_port() {
        let mut exti = Exti::default();
        exti.write(0x00, 1 << 13).unwrap();
        exti.write(0x08, 1 << 13).unwrap();
        exti.write_syscfg(0x14, 2 << 4).unwrap();
        assert_eq!((exti.watched(), exti.port(13)), (1 << 13, 2));
    }

    #[test]
    fn a_software_interrupt_pends_once_until_its_pending_bit_is_cleared() {
        let mut exti = Exti::default();
        exti.write(0x00, 1 << 2).unwrap();
        exti.write(0x10, 1 << 2).unwrap();
        assert_eq!((exti.read(0x10), exti.read(0x14)), (Ok(1 << 2), Ok(1 << 2)));
        exti.write(0x14, 1 << 2).unwrap();
        assert_eq!((exti.read(0x10), exti.read(0x14)), (Ok(0), Ok(0)));
    }
}
