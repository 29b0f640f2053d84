//! The address map: the device at an address, whether its clock runs, and the effects of a store on other devices.
use super::{
    ADC_IRQ, ADC1, ADC2, Chip, INTERNAL_REFERENCE, TIM1, TIM8, TIM10, TIM11, TIMERS, USART2_IRQ,
    WWDG_IRQ, WriteBuffer,
};
use crate::adc::Adc;
use crate::crc::Crc;
use crate::dac::Dac;
use crate::dma::Dma;
use crate::exti::lines;
use crate::gpio::{INPUT_DATA, Port};
use crate::iwdg::Iwdg;
use crate::nvic::exception;
use crate::rcc::{Clocks, Enr, HSI_HZ};
use crate::stop::{Answer, Refusal};
use crate::{Wiring, names};
use crate::{exti::Exti, nvic::Nvic, wwdg::Wwdg};
use thermal_sim::processor::ResetCause;

/// A modelled peripheral.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Device {
    Gpio(usize),
    Crc,
    Rcc,
    Flash,
    Pwr,
    Dma(usize),
    Tim(usize),
    /// ADC1 or ADC2.
    Adc(usize),
    /// Registers that all converters share.
    AdcCommon,
    Dac,
    Usart2,
    Iwdg,
    Wwdg,
    Syscfg,
    Exti,
}

/// Offsets of the registers that the converters share, in the 1 KiB of all of them.
const ADC_CSR: u32 = 0x300;
const ADC_CCR: u32 = 0x304;

/// First address of the 1 KiB of a peripheral, the peripheral, and its clock enable where it has one; the reset bit has the same
/// place in the reset register of that bus.
type Peripheral = (u32, Device, Option<(Enr, u8)>);

const PERIPHERALS: [Peripheral; 31] = [
    (0x4000_0000, Device::Tim(1), Some((Enr::Apb1, 0))),
    (0x4000_0400, Device::Tim(2), Some((Enr::Apb1, 1))),
    (0x4000_0800, Device::Tim(3), Some((Enr::Apb1, 2))),
    (0x4000_0c00, Device::Tim(4), Some((Enr::Apb1, 3))),
    (0x4000_1000, Device::Tim(5), Some((Enr::Apb1, 4))),
    (0x4000_1400, Device::Tim(6), Some((Enr::Apb1, 5))),
    (0x4000_2c00, Device::Wwdg, Some((Enr::Apb1, 11))),
    (0x4000_3000, Device::Iwdg, None),
    (0x4000_4400, Device::Usart2, Some((Enr::Apb1, 17))),
    (0x4000_7000, Device::Pwr, Some((Enr::Apb1, 28))),
    (0x4000_7400, Device::Dac, Some((Enr::Apb1, 29))),
    (0x4001_0000, Device::Tim(TIM1), Some((Enr::Apb2, 0))),
    (0x4001_0400, Device::Tim(TIM8), Some((Enr::Apb2, 1))),
    (0x4001_2000, Device::Adc(ADC1), Some((Enr::Apb2, 8))),
    (0x4001_3800, Device::Syscfg, Some((Enr::Apb2, 14))),
    (0x4001_3c00, Device::Exti, None),
    (0x4001_4400, Device::Tim(TIM10), Some((Enr::Apb2, 17))),
    (0x4001_4800, Device::Tim(TIM11), Some((Enr::Apb2, 18))),
    (0x4002_0000, Device::Gpio(0), Some((Enr::Ahb1, 0))),
    (0x4002_0400, Device::Gpio(1), Some((Enr::Ahb1, 1))),
    (0x4002_0800, Device::Gpio(2), Some((Enr::Ahb1, 2))),
    (0x4002_0c00, Device::Gpio(3), Some((Enr::Ahb1, 3))),
    (0x4002_1000, Device::Gpio(4), Some((Enr::Ahb1, 4))),
    (0x4002_1400, Device::Gpio(5), Some((Enr::Ahb1, 5))),
    (0x4002_1800, Device::Gpio(6), Some((Enr::Ahb1, 6))),
    (0x4002_1c00, Device::Gpio(7), Some((Enr::Ahb1, 7))),
    (0x4002_3000, Device::Crc, Some((Enr::Ahb1, 12))),
    (0x4002_3800, Device::Rcc, None),
    (0x4002_3c00, Device::Flash, None),
    (0x4002_6000, Device::Dma(0), Some((Enr::Ahb1, 21))),
    (0x4002_6400, Device::Dma(1), Some((Enr::Ahb1, 22))),
];

/// Modelled device at an address, with its clock enable where it has one.
fn device(address: u32) -> Option<(Device, Option<(Enr, u8)>)> {
    let first = address & 0xffff_fc00;
    let at = PERIPHERALS.binary_search_by_key(&first, |peripheral| peripheral.0);
    let (_, device, enable) = *PERIPHERALS.get(at.ok()?)?;
    // A quarter each: ADC1, ADC2, ADC3 without a model, common registers.
    match (device, address >> 8 & 3) {
        (Device::Adc(_), 1) => Some((Device::Adc(ADC2), Some((Enr::Apb2, 9)))),
        (Device::Adc(_), 2) => None,
        (Device::Adc(_), 3) => Some((Device::AdcCommon, enable)),
        _ => Some((device, enable)),
    }
}

/// Factory words of the system memory (RM0390 chapter 34, DS10693): unique identifier, flash size in KiB,
/// calibration codes of the internal reference and of the temperature sensor at 30 and 110 degC, all nominal.
fn signature(address: u32, unique_id: [u32; 3]) -> Option<u32> {
    let [first, second, third] = unique_id;
    Some(match address {
        0x1fff_7a10 => first,
        0x1fff_7a14 => second,
        0x1fff_7a18 => third,
        0x1fff_7a20 => 512 << 16,
        0x1fff_7a28 => u32::from(INTERNAL_REFERENCE) << 16,
        0x1fff_7a2c => 1207 << 16 | 959,
        _ => return None,
    })
}

impl<W: Wiring> Chip<W> {
    /// System reset: every register takes its reset value but for the reset flags; the host continues to send.
    pub fn system_reset(&mut self, cause: ResetCause, now: u64) {
        self.nvic = Nvic::new();
        self.ppb = self.ppb.after_reset(cause == ResetCause::PowerOn);
        self.halted_by_debugger = false;
        self.write_buffer = WriteBuffer::default();
        if cause == ResetCause::PowerOn {
            self.flash.cells.power_up();
        }
        self.rcc = self.rcc.after_reset(cause);
        self.flash.reset();
        self.ports = std::array::from_fn(Port::new);
        self.exti = Exti::default();
        self.dma = [Dma::new(1), Dma::new(2)];
        for timer in 0..TIMERS {
            self.reset_device(Device::Tim(timer), now);
        }
        self.reset_device(Device::AdcCommon, now);
        self.reset_device(Device::Dac, now);
        self.reset_device(Device::Crc, now);
        self.usart.set_clock(1, HSI_HZ);
        self.usart.reset();
        self.iwdg = Iwdg::new(self.lsi_hz);
        self.wwdg = Wwdg::new();
        self.stopped_at = None;
        self.reset = None;
        self.misuse = None;
        self.clocks_changed(self.rcc.clocks(), now);
        self.after_change(now);
    }

    /// Reads a peripheral or core register; `ipsr` is the running exception.
    pub fn read(&mut self, address: u32, now: u64, ipsr: u32) -> Answer<u32> {
        if address >= 0xe000_0000 {
            if names::peripheral(address).is_none() {
                return Err(Refusal::BusError);
            }
            return self.ppb.read(&self.nvic, address, now, ipsr);
        }
        if let Some(word) = signature(address, self.unique_id) {
            return Ok(word);
        }
        let device = self.clocked(address)?;
        let offset = address & 0x3ff;
        match device {
            Device::Gpio(port) => {
                let (driven, levels) = match offset {
                    INPUT_DATA => self.alternate_levels(port, now),
                    _ => (0, 0),
                };
                let wiring = &self.wiring;
                self.ports[port].read(offset, |bit| match driven >> bit & 1 {
                    0 => wiring.pin(port as u8, bit),
                    _ => Some(levels >> bit & 1 != 0),
                })
            }
            Device::Crc => self.crc.read(offset),
            Device::Rcc => self.rcc.read(offset, now),
            Device::Flash if offset == 0 => Ok(self.rcc.acr()),
            Device::Flash => self.flash.read(offset, now),
            Device::Pwr => self.rcc.read_pwr(offset, now),
            Device::Dma(i) => self.dma[i].read(offset),
            Device::Tim(i) => {
                let value = self.tims[i].read(offset, now)?;
                self.timer_changed(i, now);
                self.refresh_next(now);
                Ok(value)
            }
            Device::Adc(i) => {
                let value = self.adcs[i].read(offset & 0xff)?;
                self.nvic.set_line(ADC_IRQ, self.converters_request(), now);
                Ok(value)
            }
            Device::AdcCommon => match offset {
                ADC_CSR => Ok(self.adcs[ADC1].status() | self.adcs[ADC2].status() << 8),
                ADC_CCR => Ok(self.adcs[ADC1].common_control()),
                _ => Err(Refusal::Offset),
            },
            Device::Dac => self.dac.read(offset),
            Device::Usart2 => {
                let value = self.usart.read(offset)?;
                self.nvic.set_line(USART2_IRQ, self.usart.request(), now);
                Ok(value)
            }
            Device::Iwdg => self.iwdg.read(offset, now),
            Device::Wwdg => self.wwdg.read(offset, now),
            Device::Syscfg => self.exti.read_syscfg(offset),
            Device::Exti => self.exti.read(offset),
        }
    }

    /// The device at an address, if its clock runs.
    fn clocked(&self, address: u32) -> Answer<Device> {
        let Some((device, enable)) = device(address) else {
            return Err(if names::peripheral(address).is_some() {
                Refusal::Offset
            } else {
                Refusal::BusError
            });
        };
        if let Some((enr, bit)) = enable {
            self.rcc.check_clock(enr, bit)?;
            if self.strict {
                self.rcc.check_clock_runs(enr, bit)?;
            }
        }
        Ok(device)
    }

    /// Writes a peripheral or core register.
    pub fn write(&mut self, address: u32, bytes: u8, value: u32, now: u64) -> Answer<()> {
        if address >= 0xe000_0000 {
            if names::peripheral(address).is_none() {
                return Err(Refusal::BusError);
            }
            let nvic = &mut self.nvic;
            if self.ppb.write(nvic, address, bytes, value, now)? {
                self.reset = Some(ResetCause::Software);
            }
            if self.halted_by_debugger {
                self.apply_debug_freeze(now);
            }
            self.refresh_next(now);
            return Ok(());
        }
        let device = self.clocked(address)?;
        self.write_buffer.store(address & !3);
        let (offset, value) = match bytes {
            4 => (address & 0x3ff, value),
            _ => self.widened(device, address & 0x3ff, bytes, value, now)?,
        };
        self.write_device(device, offset, value, now)?;
        self.refresh_next(now);
        Ok(())
    }

    fn write_device(&mut self, device: Device, offset: u32, value: u32, now: u64) -> Answer<()> {
        match device {
            Device::Gpio(port) => {
                self.ports[port].write(offset, value)?;
                self.outputs_changed(port, now);
                self.bridge_changed(now);
                self.sample_inputs(now);
            }
            Device::Crc => self.crc.write(offset, value)?,
            Device::Rcc => {
                let old = self.rcc.clocks();
                if self.rcc.write(offset, value, now)? {
                    self.clocks_changed(old, now);
                }
                self.clock_wwdg(now);
                self.apply_resets(now);
                let security = self.rcc.clock_failure_interrupt();
                self.nvic.set_exception_line(exception::NMI, security, now);
            }
            Device::Flash if offset == 0 => {
                self.rcc.write_acr(value)?;
                self.flash.control_data_cache(value);
            }
            Device::Flash => {
                self.flash.write(offset, value, now, self.rcc.clocks().hclk_hz)?;
                self.power_may_fail();
            }
            Device::Pwr => self.rcc.write_pwr(offset, value, now)?,
            Device::Dma(i) => {
                self.dma[i].write(offset, value)?;
                for stream in 0..8 {
                    let (irq, level) = self.dma[i].request_line(stream);
                    self.nvic.set_line(irq, level, now);
                }
                self.dma_request_possible = true;
            }
            Device::Tim(TIM10 | TIM11) if offset == 0x0c && value != 0 => {
                return Err(Refusal::NotModelled(
                    "TIM10 or TIM11 DIER (interrupts shared with TIM1)",
                ));
            }
            Device::Tim(i) => {
                self.tims[i].write(offset, value, now)?;
                self.connect_triggers(now);
                self.timer_changed(i, now);
            }
            Device::Adc(i) => {
                self.adcs[i].write(offset & 0xff, value, now)?;
                self.connect_triggers(now);
                self.nvic.set_line(ADC_IRQ, self.converters_request(), now);
                self.dma_request_possible = true;
            }
            Device::AdcCommon if offset == ADC_CCR => {
                for adc in &mut self.adcs {
                    adc.write_common_control(value)?;
                }
            }
            Device::AdcCommon => return Err(Refusal::Offset),
            Device::Dac => self.dac.write(offset, value)?,
            Device::Usart2 => {
                self.usart.write(offset, value, now)?;
                self.nvic.set_line(USART2_IRQ, self.usart.request(), now);
                self.dma_request_possible = true;
            }
            Device::Iwdg => self.iwdg.write(offset, value, now, self.rcc.clocks().hclk_hz)?,
            Device::Wwdg => {
                if self.wwdg.write(offset, value, now)? {
                    self.reset = Some(ResetCause::WindowWatchdog);
                }
                self.nvic.set_line(WWDG_IRQ, self.wwdg.request(), now);
            }
            Device::Syscfg => {
                self.exti.write_syscfg(offset, value)?;
                self.sample_exti(now);
            }
            Device::Exti => {
                let watched = self.exti.watched();
                self.exti.write(offset, value)?;
                for line in lines(self.exti.watched() & !watched) {
                    let level = self.pin(self.exti.port(line), line);
                    self.exti.start_from_level(line, level);
                }
                self.exti_changed(now);
            }
        }
        Ok(())
    }

    /// The window watchdog counts PCLK1 while its own clock is enabled.
    pub(super) fn clock_wwdg(&mut self, now: u64) {
        let Clocks { hclk_hz, pclk1_hz, .. } = self.rcc.clocks();
        let on = self.rcc.check_clock(Enr::Apb1, 11).is_ok() && !self.window_watchdog_is_halted();
        self.wwdg.set_clock(on.then(|| u64::from(hclk_hz / pclk1_hz)), now);
    }

    /// Stores to the flash of the settings.
    pub fn store_flash(&mut self, address: u32, bytes: u8, value: u32, now: u64) -> Answer<()> {
        let hclk_hz = self.rcc.clocks().hclk_hz;
        self.flash.store(address, bytes, value, now, hclk_hz)?;
        self.power_may_fail();
        Ok(())
    }

    fn power_may_fail(&mut self) {
        if !self.flash.cells.is_powered() {
            self.reset = Some(ResetCause::PowerOn);
        }
    }

    pub(super) fn clocks_changed(&mut self, old: Clocks, now: u64) {
        let clocks = self.rcc.clocks();
        self.time.set_clock(clocks.hclk_hz, now);
        self.clock_wwdg(now);
        let ratio = |hz: u32| u64::from(clocks.hclk_hz / hz.max(1)).max(1);
        for (i, timer) in self.tims.iter_mut().enumerate() {
            timer.set_divider(
                ratio(if matches!(i, TIM1 | TIM8 | TIM10 | TIM11) {
                    clocks.timclk2_hz
                } else {
                    clocks.timclk1_hz
                }),
                now,
            );
        }
        for adc in &mut self.adcs {
            adc.set_clock(ratio(clocks.pclk2_hz), clocks.pclk2_hz);
        }
        self.usart.set_clock(ratio(clocks.pclk1_hz), clocks.hclk_hz);
        self.iwdg.rescale(now, old.hclk_hz, clocks.hclk_hz);
    }

    /// Resets the peripherals whose reset bit is set.
    fn apply_resets(&mut self, now: u64) {
        for (_, device, enable) in PERIPHERALS {
            let Some((enr, bit)) = enable else { continue };
            if self.rcc.in_reset(enr, bit) {
                self.reset_device(device, now);
                self.after_change(now);
            }
        }
    }

    fn reset_device(&mut self, device: Device, now: u64) {
        match device {
            Device::Gpio(port) => self.ports[port] = Port::new(port),
            Device::Dma(i) => self.dma[i] = Dma::new(i + 1),
            Device::Tim(i) => self.tims[i].reset(),
            // One bit resets all converters (6.3.10).
            Device::Adc(_) | Device::AdcCommon => self.adcs.iter_mut().for_each(Adc::reset),
            Device::Dac => self.dac = Dac::default(),
            Device::Crc => self.crc = Crc::default(),
            Device::Usart2 => self.usart.reset(),
            Device::Wwdg => self.wwdg.reset(now),
            Device::Syscfg => self.exti.reset_syscfg(),
            Device::Rcc | Device::Flash | Device::Pwr | Device::Iwdg | Device::Exti => {}
        }
    }
}
