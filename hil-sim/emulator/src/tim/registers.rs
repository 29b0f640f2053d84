//! Register access of the timers (RM0390 16.4, 17.4, 19.4).
use super::{AOE, BIF, BKE, BKP, LOCK, MOE, OSSI, OSSR, STARTED_BY_TIM2, Tim, UIF};
use crate::stop::{Answer, Refusal, only};

impl Tim {
    /// Whether this kind of timer has a register (register maps 16.4.21, 17.4.21, 18.5.12, 19.4.9).
    fn has(&self, offset: u32) -> bool {
        match offset {
            // CR2 and SMCR: a trigger out, and one in
            0x04 => self.kind.channels != 1,
            0x08 => self.kind.channels > 1,
            // CCMR2 and CCR2 to CCR4
            0x1c | 0x38..=0x40 => self.kind.channels > 1,
            0x18 | 0x20 | 0x34 => self.kind.channels > 0,
            _ => true,
        }
    }

    pub fn read(&mut self, offset: u32, now: u64) -> Answer<u32> {
        self.sync(now);
        if !self.has(offset) {
            return Err(Refusal::Offset);
        }
        Ok(match offset {
            0x00 => self.cr1,
            0x04 => self.cr2,
            0x08 => self.smcr,
            0x0c => self.dier,
            0x10 => self.sr,
            0x14 => 0,
            0x18 | 0x1c => self.ccmr[(offset as usize - 0x18) / 4],
            0x20 => self.ccer,
            0x24 => self.count(now),
            0x28 => self.psc,
            0x2c => self.arr,
            0x30 if self.kind.advanced => self.rcr,
            0x34..=0x40 => {
                let channel = (offset as usize - 0x34) / 4;
                if self.is_capturing(channel) {
                    self.sr &= !(2 << channel); // 17.4.5: read out, a captured count clears its flag
                    self.schedule();
                }
                self.ccr[channel]
            }
            0x44 if self.kind.advanced => self.bdtr,
            0x50 if self.kind.counter_max == u32::MAX => 0,
            _ => return Err(Refusal::Offset),
        })
    }

    pub fn write(&mut self, offset: u32, value: u32, now: u64) -> Answer<()> {
        self.sync(now);
        let result = self.write_synced(offset, value, now);
        self.schedule();
        result
    }

    fn write_synced(&mut self, offset: u32, value: u32, now: u64) -> Answer<()> {
        if !self.has(offset) {
            return Err(Refusal::Offset);
        }
        match offset {
            0x00 => {
                let dividing = if self.kind.channels > 0 { 0x0300 } else { 0 };
                let one_pulse = if self.kind.channels == 1 { 0 } else { 8 };
                only(
                    value,
                    0x87 | dividing | one_pulse,
                    "TIM CR1.DIR or CMS (down- or centre-aligned counting), or reserved bits",
                )?;
                let count = self.count(now);
                // 17.4.2: MMS = 001 makes a trigger output of the counter's enable
                self.trigger |= value & !self.cr1 & 1 != 0 && self.cr2 >> 4 & 7 == 1;
                self.cr1 = value;
                if self.cr1 & 0x80 == 0 {
                    self.arr_now = self.arr;
                }
                self.set_count(count, now);
            }
            0x04 => {
                let allowed = if self.kind.advanced { 0x7f70 } else { 0x70 };
                only(value, allowed, "TIM CR2.CCPC, CCUS, CCDS or TI1S")?;
                if value >> 4 & 7 > 2 {
                    return Err(Refusal::NotModelled(
                        "TIM CR2.MMS (trigger output from a compare match)",
                    ));
                }
                let protected = if self.lock() >= 1 { 0x7f00 } else { 0 };
                self.cr2 = value & !protected | self.cr2 & protected;
            }
            0x08 => {
                let is_tim3_or_tim4 = !self.kind.advanced && self.kind.counter_max == 0xffff;
                let allowed = is_tim3_or_tim4 && value == STARTED_BY_TIM2;
                only(if allowed { 0 } else { value }, 0, "TIM SMCR (slave modes)")?;
                self.smcr = value;
            }
            0x0c => {
                let channels = ((1u32 << self.kind.channels) - 1) << 1;
                let advanced = if self.kind.advanced { 0xa0 } else { 0 };
                let trigger = if self.kind.channels > 1 { 0x40 } else { 0 };
                only(
                    value,
                    UIF | channels | trigger | advanced,
                    "TIM DIER (DMA requests), or reserved bits",
                )?;
                self.dier = value;
            }
            0x10 => self.sr &= value,
            0x14 => {
                let channels = ((1u32 << self.kind.channels) - 1) << 1;
                only(
                    value,
                    UIF | channels | if self.kind.advanced { BIF } else { 0 },
                    "TIM EGR.TG or COMG",
                )?;
                let captures =
                    (0..self.kind.channels).filter(|channel| self.is_capturing(*channel));
                let captured: u32 = captures.map(|channel| 2 << channel).sum();
                only(value & captured, 0, "TIM EGR.CCxG of an input")?;
                if value & BIF != 0 {
                    self.bdtr &= !MOE;
                }
                self.sr |= value & (channels | BIF);
                if value & UIF != 0 {
                    self.set_count(0, now);
                    self.update(false);
                    self.set_count(0, now);
                    self.trigger |= self.cr2 >> 4 & 7 == 0;
                }
            }
            0x18 | 0x1c => self.write_ccmr((offset as usize - 0x18) / 4, value)?,
            0x20 => {
                let mut allowed = if self.kind.channels > 1 { 0x3333 } else { 0x3 };
                if self.kind.advanced {
                    only(value & 0x0444, 0, "TIM CCER.CCxNE (complementary outputs)")?;
                    allowed |= 0x0888;
                }
                only(value, allowed, "TIM CCER.CCxNP (capture), or reserved bits")?;
                let protected = if self.lock() >= 2 { 0x2aaa } else { 0 };
                self.ccer = value & !protected | self.ccer & protected;
            }
            0x24 => self.set_count(value & self.kind.counter_max, now),
            0x28 => {
                only(value, 0xffff, "TIM PSC reserved bits")?;
                self.psc = value;
            }
            0x2c => {
                self.arr = value & self.kind.counter_max;
                if self.cr1 & 0x80 == 0 {
                    let count = self.count(now);
                    self.arr_now = self.arr;
                    self.set_count(count, now);
                }
            }
            0x30 if self.kind.advanced => {
                only(value, 0xff, "TIM RCR reserved bits")?;
                self.rcr = value;
            }
            0x34..=0x40 => {
                let channel = (offset as usize - 0x34) / 4;
                if self.is_capturing(channel) {
                    return Ok(()); // 17.4.13: read-only
                }
                self.ccr[channel] = value & self.kind.counter_max;
                if self.ccmr[channel / 2] >> (8 * (channel % 2) + 3) & 1 == 0 {
                    self.ccr_now[channel] = self.ccr[channel];
                }
            }
            0x44 if self.kind.advanced => self.write_bdtr(value)?,
            0x50 if self.kind.counter_max == u32::MAX => only(value, 0, "TIM OR (trigger remap)")?,
            _ => return Err(Refusal::Offset),
        }
        Ok(())
    }

    fn write_ccmr(&mut self, half: usize, value: u32) -> Answer<()> {
        only(
            value & 0x0202,
            0,
            "TIM CCMR.CCxS (capture from another channel's input, or from TRC)",
        )?;
        for channel in 0..2 {
            if value >> (8 * channel) & 1 != 0 {
                only(
                    value >> (8 * channel) & 0xff,
                    1,
                    "TIM CCMR.ICxF or ICxPSC (filter or prescaler of an input)",
                )?;
            }
        }
        only(value & 0x8080, 0, "TIM CCMR.OCxCE (clear by ETRF)")?;
        let allowed = if self.kind.channels > 1 { 0x7d7d } else { 0x7d };
        only(value, allowed, "TIM CCMR reserved bits")?;
        for channel in 0..2 {
            let mode = value >> (8 * channel + 4) & 7;
            if matches!(mode, 1..=3) {
                return Err(Refusal::NotModelled(
                    "TIM CCMR.OCxM = active, inactive or toggle on match",
                ));
            }
        }
        let protected = if self.lock() >= 3 { 0x7878 } else { 0 };
        self.ccmr[half] = value & !protected | self.ccmr[half] & protected;
        for channel in 2 * half..2 * half + 2 {
            if self.ccmr[half] >> (8 * (channel % 2) + 3) & 1 == 0 {
                self.ccr_now[channel] = self.ccr[channel];
            }
        }
        Ok(())
    }

    /// Dead time concerns complementary outputs only, which are refused. LOCK can be written once after a reset: its content
    /// is frozen once BDTR has been written, whatever that write has put into it (17.4.18).
    fn write_bdtr(&mut self, value: u32) -> Answer<()> {
        only(value, 0xffff, "TIM BDTR reserved bits")?;
        let protected = match self.lock() {
            0 => 0,
            1 => BKE | BKP | AOE | 0xff,
            _ => BKE | BKP | AOE | 0xff | OSSR | OSSI,
        };
        let kept = protected | if self.bdtr_written { LOCK } else { 0 };
        self.bdtr = value & !kept | self.bdtr & kept;
        self.bdtr_written = true;
        Ok(())
    }

    /// Flips stored bits of BDTR, which LOCK does not protect from radiation.
    pub fn flip_bdtr(&mut self, mask: u32, now: u64) {
        self.sync(now);
        self.bdtr ^= mask;
        self.schedule();
    }
}
