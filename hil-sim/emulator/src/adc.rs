//! ADC1 and ADC2 (RM0390 chapter 13): regular scan sequence, software or timer trigger, sample times, end-of-conversion,
//! overrun, DMA requests. Injected channels, analog watchdog and multi-ADC modes are refused, of ADC2 timer triggers and
//! DMA requests, too.
use super::stop::{Answer, Refusal, only};

const EOC: u32 = 1 << 1;
const STRT: u32 = 1 << 4;
const OVR: u32 = 1 << 5;
const ADON: u32 = 1;
const CONT: u32 = 1 << 1;
const DMA: u32 = 1 << 8;
const DDS: u32 = 1 << 9;
const EOCS: u32 = 1 << 10;
const ALIGN: u32 = 1 << 11;
const SWSTART: u32 = 1 << 30;
/// Sample times in ADC clock cycles (13.13.4).
const SAMPLE: [u64; 8] = [3, 15, 28, 56, 84, 112, 144, 480];
/// CCR: power of the temperature sensor and of the internal reference.
const TSVREFE: u32 = 1 << 23;
const VBATE: u32 = 1 << 22;
/// Time from ADON until conversions are accurate, at most (DS10693, t_STAB).
const STABILISATION_US: u64 = 3;
/// Highest ADC clock at 2.4 to 3.6 V (DS10693, ADC characteristics).
const ADCCLK_MAX_HZ: u32 = 36_000_000;

/// Trigger outputs that can start a sequence (13.13.3, EXTSEL): timer number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Trigger {
    Tim2,
    Tim3,
}

/// Which of the chip's converters; the third is not modelled.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Unit {
    /// The one with the internal channels.
    #[default]
    Adc1,
    Adc2,
}

#[derive(Default)]
pub(crate) struct Adc {
    unit: Unit,
    sr: u32,
    cr1: u32,
    cr2: u32,
    smpr: [u32; 2],
    sqr: [u32; 3],
    dr: u32,
    /// Common to all converters, which the chip tells of every change.
    ccr: u32,
    limits: [u32; 2],
    /// CPU cycles per APB2 clock.
    bus_divider: u64,
    pclk2_hz: u32,
    /// Cycle from which conversions are accurate.
    stable_at: u64,
    /// Why the sequence may not be converted.
    bad_channel: Option<Refusal>,
    /// Position in the running sequence.
    position: u32,
    dma_ended: bool,
    dma_waiting: bool,
    /// Conversions start and never end (injected fault).
    stuck: bool,
    /// End of the running conversion.
    pub due: u64,
}

impl Adc {
    pub fn new(unit: Unit, bus_divider: u64, pclk2_hz: u32) -> Self {
        Self { unit, limits: [0xfff, 0], bus_divider, pclk2_hz, due: u64::MAX, ..Self::default() }
    }

    pub fn set_clock(&mut self, bus_divider: u64, pclk2_hz: u32) {
        (self.bus_divider, self.pclk2_hz) = (bus_divider, pclk2_hz);
    }

    /// Back to the reset values; the bus clock stays.
    pub fn reset(&mut self) {
        *self = Self::new(self.unit, self.bus_divider, self.pclk2_hz);
    }

    /// CPU cycles per ADC clock.
    fn adc_clock(&self) -> u64 {
        self.bus_divider * u64::from(2 * ((self.ccr >> 16 & 3) + 1))
    }

    /// Channel at a position of the sequence.
    fn channel_at(&self, position: u32) -> u8 {
        let (register, slot) = (2 - (position / 6) as usize, position % 6);
        (self.sqr[register] >> (5 * slot) & 0x1f) as u8
    }

    /// Channel of the conversion that runs.
    pub fn channel(&self) -> u8 {
        self.channel_at(self.position)
    }

    fn length(&self) -> u32 {
        if self.cr1 >> 8 & 1 != 0 { (self.sqr[0] >> 20 & 0xf) + 1 } else { 1 }
    }

    /// Conversion time: sample time plus one ADC clock per bit (13.5).
    fn conversion_cycles(&self, channel: u8) -> u64 {
        let (register, slot) = (usize::from(channel < 10), u32::from(channel % 10));
        let sample = SAMPLE[(self.smpr[register] >> (3 * slot) & 7) as usize];
        let bits = 12 - 2 * u64::from(self.cr1 >> 24 & 3);
        (sample + bits) * self.adc_clock()
    }

    /// Trigger whose rising edge starts a sequence.
    pub fn trigger(&self) -> Option<Trigger> {
        match (self.cr2 >> 28 & 3, self.cr2 >> 24 & 0xf) {
            (0, _) => None,
            (_, 6) => Some(Trigger::Tim2),
            _ => Some(Trigger::Tim3),
        }
    }

    /// Why the selected sequence may not be converted. Checked when its registers change, not at each of many starts.
    fn check_channels(&self) -> Answer<()> {
        for channel in (0..self.length()).map(|position| self.channel_at(position)) {
            match channel {
                0..=15 => {}
                _ if self.unit == Unit::Adc2 => {
                    return Err(Refusal::NotModelled(
                        "channels above 15 of ADC2, which has no internal ones",
                    ));
                }
                17 | 18 if self.ccr & TSVREFE != 0 => {}
                18 if self.ccr & VBATE != 0 => {}
                17 | 18 => {
                    return Err(Refusal::Misuse(
                        "channel 17 is converted while ADC_CCR.TSVREFE is 0, or 18 while VBATE is, too (RM0390 13.10, 13.11)",
                    ));
                }
                _ => return Err(Refusal::NotModelled("ADC channel 16, or above 18")),
            }
        }
        Ok(())
    }

    /// Starts a sequence, at an edge of the selected trigger or by SWSTART. Ignored during a sequence, when off, and after an
    /// overrun with DMA until OVR is cleared (13.8.1).
    pub fn start(&mut self, now: u64) -> Answer<()> {
        let overrun = self.sr & OVR != 0 && self.cr2 & DMA != 0;
        if self.cr2 & ADON != 0 && self.due == u64::MAX && !overrun {
            if now < self.stable_at {
                return Err(Refusal::Misuse(
                    "a conversion starts less than 3 us after ADON was set (DS10693, t_STAB)",
                ));
            }
            if let Some(refusal) = self.bad_channel {
                return Err(refusal);
            }
            self.position = 0;
            self.sr |= STRT;
            if !self.stuck {
                self.due = now + self.conversion_cycles(self.channel());
            }
        }
        Ok(())
    }

    /// No conversion ends until the converter is reset.
    pub fn stop_converting(&mut self) {
        self.stuck = true;
        self.due = u64::MAX;
    }

    /// Whether an item waits for its DMA transfer.
    pub fn wants_dma(&self) -> bool {
        self.dma_waiting
    }

    /// Ends the running conversion with this 12-bit code.
    pub fn finish(&mut self, code: u16) {
        let bits = 12 - 2 * (self.cr1 >> 24 & 3);
        let code = u32::from(code & 0xfff) >> (12 - bits);
        let at = self.due;
        let last = self.position + 1 >= self.length();
        let uses_dma = self.cr2 & DMA != 0;
        let overruns = self.sr & EOC != 0 && (uses_dma || self.cr2 & EOCS != 0);
        if overruns {
            self.sr |= OVR;
            if uses_dma {
                self.due = u64::MAX;
                self.dma_waiting = false;
                return;
            }
        } else {
            self.dr = if self.cr2 & ALIGN != 0 {
                code << (if bits == 6 { 2 } else { 16 - bits })
            } else {
                code
            };
        }
        // With DMA each item raises EOC, so that a missed transfer is detected as an overrun.
        if last || self.cr2 & EOCS != 0 || uses_dma {
            self.sr |= EOC;
        }
        self.position = if last { 0 } else { self.position + 1 };
        self.due = if !last || self.cr2 & CONT != 0 {
            at + self.conversion_cycles(self.channel())
        } else {
            u64::MAX
        };
        self.dma_waiting = uses_dma && !self.dma_ended;
    }

    /// A DMA transfer has read the data register; `last` if it was the last of its stream.
    pub fn dma_read(&mut self, last: bool) {
        self.sr &= !EOC;
        self.dma_waiting = false;
        self.dma_ended |= last && self.cr2 & DDS == 0;
    }

    /// Value that a DMA request offers.
    pub fn data(&self) -> u32 {
        self.dr
    }

    /// Interrupt request.
    pub fn request(&self) -> bool {
        self.sr & EOC != 0 && self.cr1 >> 5 & 1 != 0
            || self.sr & OVR != 0 && self.cr1 >> 26 & 1 != 0
    }

    /// Whether channel 18 is a quarter of VBAT, which takes precedence over the temperature sensor (13.11).
    pub fn measures_vbat(&self) -> bool {
        self.ccr & VBATE != 0
    }

    /// Status as the common status register repeats it.
    pub fn status(&self) -> u32 {
        self.sr & 0x3f
    }

    pub fn common_control(&self) -> u32 {
        self.ccr
    }

    /// Writes the common control register, of which each converter has the value.
    pub fn write_common_control(&mut self, value: u32) -> Answer<()> {
        only(value, 0x0003_0000 | TSVREFE | VBATE, "ADC_CCR multi-ADC modes")?;
        self.ccr = value;
        self.bad_channel = self.check_channels().err();
        Ok(())
    }

    /// Reads one of the converter's own registers.
    pub fn read(&mut self, offset: u32) -> Answer<u32> {
        Ok(match offset {
            0x00 => self.sr,
            0x04 => self.cr1,
            0x08 => self.cr2,
            0x0c | 0x10 => self.smpr[(offset as usize - 0x0c) / 4],
            0x24 | 0x28 => self.limits[(offset as usize - 0x24) / 4],
            0x2c..=0x34 => self.sqr[(offset as usize - 0x2c) / 4],
            0x38 => 0,
            0x4c => {
                self.sr &= !EOC;
                self.dr
            }
            _ => return Err(Refusal::Offset),
        })
    }

    /// Writes one of them.
    pub fn write(&mut self, offset: u32, value: u32, now: u64) -> Answer<()> {
        match offset {
            0x00 => self.sr &= value,
            0x04 => {
                only(value, 0x0700_0120, "ADC_CR1 beyond RES, SCAN, EOCIE and OVRIE")?;
                self.cr1 = value;
            }
            0x08 => self.write_cr2(value, now)?,
            0x0c | 0x10 => {
                // ten channels in SMPR2, nine above them in SMPR1
                let allowed = if offset == 0x0c { 0x07ff_ffff } else { 0x3fff_ffff };
                only(value, allowed, "ADC_SMPR reserved bits")?;
                self.smpr[(offset as usize - 0x0c) / 4] = value;
            }
            0x24 | 0x28 => {
                only(value, 0xfff, "ADC_HTR or ADC_LTR reserved bits")?;
                self.limits[(offset as usize - 0x24) / 4] = value;
            }
            0x2c..=0x34 => {
                let allowed = if offset == 0x2c { 0x00ff_ffff } else { 0x3fff_ffff };
                only(value, allowed, "ADC_SQR reserved bits")?;
                self.sqr[(offset as usize - 0x2c) / 4] = value;
            }
            0x38 => only(value, 0, "ADC_JSQR (injected channels)")?,
            _ => return Err(Refusal::Offset),
        }
        self.bad_channel = self.check_channels().err();
        Ok(())
    }

    fn write_cr2(&mut self, value: u32, now: u64) -> Answer<()> {
        match self.unit {
            Unit::Adc1 => only(value, 0x7f00_0f03, "ADC_CR2 injected channels")?,
            Unit::Adc2 => only(value, 0x4000_0c03, "ADC2_CR2 injected channels, triggers and DMA")?,
        }
        if value >> 28 & 3 > 1 {
            return Err(Refusal::NotModelled("ADC_CR2.EXTEN = falling edge"));
        }
        if value >> 28 & 3 == 1 && !matches!(value >> 24 & 0xf, 6 | 8) {
            return Err(Refusal::NotModelled("ADC_CR2.EXTSEL other than TIM2_TRGO and TIM3_TRGO"));
        }
        if value & ADON != 0 {
            let hz = self.pclk2_hz / (2 * ((self.ccr >> 16 & 3) + 1));
            if hz > ADCCLK_MAX_HZ {
                return Err(Refusal::ClockRange {
                    clock: "ADCCLK",
                    hz,
                    min_hz: 600_000,
                    max_hz: ADCCLK_MAX_HZ,
                });
            }
            if self.cr2 & ADON == 0 {
                let hclk_hz = self.bus_divider * u64::from(self.pclk2_hz);
                self.stable_at = now + (STABILISATION_US * hclk_hz).div_ceil(1_000_000);
            }
        } else {
            self.due = u64::MAX;
        }
        if value & DMA == 0 {
            self.dma_ended = false;
            self.dma_waiting = false;
        }
        self.cr2 = value & !SWSTART;
        if value & SWSTART != 0 {
            self.start(now)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// PCLK2 = 90 MHz at HCLK = 180 MHz, ADCCLK = PCLK2/4 = 22.5 MHz: 8 CPU cycles per ADC clock; on for long enough.
    fn adc(cr1: u32, cr2: u32) -> Adc {
        let mut adc = Adc::new(Unit::Adc1, 2, 90_000_000);
        adc.write_common_control(1 << 16).unwrap();
        adc.write(0x04, cr1, 0).unwrap();
        adc.write(0x08, cr2 | ADON, 0).unwrap();
        adc.stable_at = 0;
        adc
    }

    #[test]
    fn a_conversion_in_the_first_3_us_is_misuse() {
        for (after_cycles, allowed) in [(0, false), (539, false), (540, true)] {
            let mut adc = Adc::new(Unit::Adc1, 2, 90_000_000);
            adc.write_common_control(1 << 16).unwrap();
            adc.write(0x08, ADON, 1000).unwrap();
            let by_software = adc.write(0x08, ADON | SWSTART, 1000 + after_cycles);
            assert_eq!(by_software.is_ok(), allowed, "{after_cycles}");
        }
    }

    #[test]
    fn internal_channels_need_their_power() {
        for channel in [17, 18] {
            let mut adc = adc(0, 0);
            adc.write(0x34, channel, 0).unwrap();
            assert!(matches!(adc.start(0), Err(Refusal::Misuse(_))));
            adc.write_common_control(TSVREFE | 1 << 16).unwrap();
            assert_eq!(adc.start(0), Ok(()));
        }
    }

    #[test]
    fn conversion_takes_sample_time_plus_12_adc_clocks() {
        for (smp, sample) in [(0, 3), (3, 56), (7, 480)] {
            let mut adc = adc(0, 0);
            adc.write(0x10, smp << 12, 0).unwrap();
            adc.write(0x34, 4, 0).unwrap();
            adc.start(1000).unwrap();
            assert_eq!(adc.due, 1000 + (sample + 12) * 8);
        }
    }

    #[test]
    fn a_scan_converts_in_order_and_raises_eoc_at_its_end() {
        let mut adc = adc(1 << 8, 0);
        adc.write(0x34, 7 | 11 << 5, 0).unwrap();
        adc.write(0x2c, 1 << 20, 0).unwrap();
        adc.start(0).unwrap();
        assert_eq!((adc.channel(), adc.due), (7, 120));
        adc.finish(1);
        assert_eq!((adc.read(0).unwrap() & EOC, adc.channel(), adc.due), (0, 11, 240));
        adc.start(200).unwrap();
        assert_eq!(adc.due, 240, "a trigger during a sequence is lost");
        adc.finish(2);
        assert_eq!((adc.read(0).unwrap() & EOC, adc.due), (EOC, u64::MAX));
        assert_eq!((adc.read(0x4c).unwrap(), adc.read(0).unwrap() & EOC), (2, 0));
    }

    #[test]
    fn an_unread_item_overruns_and_stops_dma_requests() {
        let mut adc = adc(0, DMA | DDS | CONT);
        adc.start(0).unwrap();
        adc.finish(1);
        assert!(adc.wants_dma());
        adc.finish(2);
        assert!(!adc.wants_dma(), "the first was not read");
        assert_eq!(adc.read(0).unwrap() & OVR, OVR);
        assert_eq!(adc.data(), 1, "the old item stays");
        adc.start(5000).unwrap();
        assert_eq!(adc.due, u64::MAX, "until OVR is cleared");
    }

    #[test]
    fn without_dds_requests_end_with_the_stream() {
        let mut adc = adc(0, DMA | CONT);
        adc.start(0).unwrap();
        adc.finish(1);
        assert!(adc.wants_dma());
        adc.dma_read(true);
        adc.finish(2);
        assert!(!adc.wants_dma());
    }

    #[test]
    fn the_converter_has_a_clock_limit() {
        let mut adc = Adc::new(Unit::Adc1, 2, 90_000_000);
        assert!(matches!(
            adc.write(0x08, ADON, 0),
            Err(Refusal::ClockRange { hz: 45_000_000, .. })
        ));
    }
}
