//! Everything of the chip that is not the CPU: the peripherals, how they are wired to each other, and the address
//! map. It knows registers and time, not the CPU emulation.
use super::adc::{Adc, Trigger};
use super::dma::{self, Dma, Route, Served};
use super::exti::Exti;
use super::gpio::{Mode, PORTS, Port};
use super::iwdg::Iwdg;
use super::names;
use super::nvic::{Nvic, exception};
use super::ppb::Ppb;
use super::ram::Memory;
use super::rcc::{Clocks, Enr, HSI_HZ, Rcc, ResetCause};
use super::stop::{Answer, Refusal};
use super::tim::{self, Output, Tim};
use super::usart::Usart;
use super::{LegState, Wiring};

const TIMERS: usize = 7;
const ADC_IRQ: usize = 18;
const USART2_IRQ: usize = 38;
/// Bit rate of the host until told otherwise.
const HOST_BAUD: u32 = 1_000_000;
/// Codes of the internal channels at 3.3 V and 25 degC: VREFINT 1.21 V, temperature sensor 0.76 V (DS10693 6.3.22
/// and 6.3.24).
const INTERNAL_REFERENCE: u16 = 1502;
const INTERNAL_TEMPERATURE: u16 = 943;

/// Peripheral behind an address, with its clock enable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Device {
    Gpio(usize),
    Rcc,
    Flash,
    Pwr,
    Dma(usize),
    Tim(usize),
    Adc,
    Usart2,
    Iwdg,
    Syscfg,
    Exti,
}

/// Modelled device at an address, with its clock enable where it has one.
fn device(address: u32) -> Option<(Device, Option<(Enr, u8)>)> {
    let page = address >> 10 & 0xff;
    Some(match address & 0xffff_fc00 {
        0x4002_0000..0x4002_2000 => (Device::Gpio(page as usize & 7), Some((Enr::Ahb1, page as u8 & 7))),
        0x4002_3800 => (Device::Rcc, None),
        0x4002_3c00 => (Device::Flash, None),
        0x4002_6000 => (Device::Dma(0), Some((Enr::Ahb1, 21))),
        0x4002_6400 => (Device::Dma(1), Some((Enr::Ahb1, 22))),
        0x4001_0000 => (Device::Tim(0), Some((Enr::Apb2, 0))),
        0x4000_0000..0x4000_1800 => (Device::Tim(page as usize + 1), Some((Enr::Apb1, page as u8))),
        0x4001_2000 if !(0x100..0x300).contains(&(address & 0x3ff)) => (Device::Adc, Some((Enr::Apb2, 8))),
        0x4000_4400 => (Device::Usart2, Some((Enr::Apb1, 17))),
        0x4000_7000 => (Device::Pwr, Some((Enr::Apb1, 28))),
        0x4000_3000 => (Device::Iwdg, None),
        0x4001_3800 => (Device::Syscfg, Some((Enr::Apb2, 14))),
        0x4001_3c00 => (Device::Exti, None),
        _ => return None,
    })
}

pub(crate) struct Chip<W> {
    pub wiring: W,
    pub nvic: Nvic,
    pub ppb: Ppb,
    rcc: Rcc,
    ports: [Port; PORTS],
    exti: Exti,
    dma: [Dma; 2],
    adc: Adc,
    tims: [Tim; TIMERS],
    usart: Usart,
    iwdg: Iwdg,
    legs: [LegState; 2],
    outputs: [(u32, u32); PORTS],
    /// A store made a DMA request possible; served before the next block.
    kick: bool,
    /// Cycles asleep since power-up.
    pub slept: u64,
    pub reset: Option<ResetCause>,
    /// Cycle of the next event of any device.
    pub next: u64,
}

impl<W: Wiring> Chip<W> {
    pub fn new(wiring: W) -> Self {
        let kinds = [
            tim::ADVANCED,
            tim::WIDE,
            tim::GENERAL,
            tim::GENERAL,
            tim::WIDE,
            tim::BASIC,
            tim::BASIC,
        ];
        Self {
            wiring,
            nvic: Nvic::new(),
            ppb: Ppb::new(),
            rcc: Rcc::new(ResetCause::PowerOn, 0),
            ports: std::array::from_fn(Port::new),
            exti: Exti::default(),
            dma: [Dma::new(1), Dma::new(2)],
            adc: Adc::new(1, HSI_HZ),
            tims: kinds.map(|kind| Tim::new(kind, 1)),
            usart: Usart::new(1, HSI_HZ, HOST_BAUD),
            iwdg: Iwdg::new(),
            legs: [LegState::Off; 2],
            outputs: [(0, 0); PORTS],
            kick: false,
            slept: 0,
            reset: None,
            next: u64::MAX,
        }
    }

    /// System reset: every register to its reset value, reset flags kept; the host goes on sending.
    pub fn system_reset(&mut self, cause: ResetCause, now: u64) {
        let slept = self.ppb.slept;
        self.nvic = Nvic::new();
        self.ppb = Ppb::new();
        self.ppb.slept = slept;
        self.rcc = Rcc::new(cause, self.rcc.flags());
        self.ports = std::array::from_fn(Port::new);
        self.exti = Exti::default();
        self.dma = [Dma::new(1), Dma::new(2)];
        for timer in 0..TIMERS {
            self.reset_device(Device::Tim(timer));
        }
        self.reset_device(Device::Adc);
        self.usart.set_clock(1, HSI_HZ);
        self.usart.reset();
        self.iwdg = Iwdg::new();
        self.reset = None;
        self.clocks_changed(self.rcc.clocks(), now);
        self.after_change(now);
    }

    pub fn clocks(&self) -> Clocks {
        self.rcc.clocks()
    }

    pub fn legs(&mut self, now: u64) -> [LegState; 2] {
        self.tims[0].sync(now);
        [self.leg(0), self.leg(1)]
    }

    pub fn output(&self, port: u8, bit: u8) -> Option<bool> {
        self.ports
            .get(usize::from(port))
            .filter(|_| bit < 16)
            .and_then(|p| p.output(bit))
    }

    pub fn usart(&self) -> &Usart {
        &self.usart
    }

    /// Counts time that the CPU slept.
    pub fn count_sleep(&mut self, cycles: u64) {
        self.slept += cycles;
        if !self.ppb.counts_asleep() {
            self.ppb.slept += cycles;
        }
    }

    pub fn usart_mut(&mut self) -> &mut Usart {
        &mut self.usart
    }

    pub fn refresh_next(&mut self, now: u64) {
        let timers = self.tims.iter().fold(u64::MAX, |least, t| least.min(t.due));
        self.next = timers
            .min(self.ppb.systick_due)
            .min(self.adc.due)
            .min(self.usart.tx_due)
            .min(self.usart.rx_due)
            .min(self.iwdg.due)
            .min(if self.kick { now } else { u64::MAX });
    }

    /// Handles every device event up to `now`, in order of time.
    pub fn service(&mut self, now: u64, memory: &mut impl Memory) {
        while self.next <= now {
            let at = self.next;
            if self.ppb.systick_due <= at && self.ppb.systick_expire() {
                self.nvic.pend(exception::SYSTICK, at);
            }
            for timer in 0..TIMERS {
                if self.tims[timer].due <= at {
                    self.tims[timer].sync(at);
                    self.timer_changed(timer, at);
                }
            }
            if self.adc.due <= at {
                self.end_conversion(at, memory);
            }
            if self.usart.tx_due <= at {
                let connected = self.ports[0].mode(2) == Mode::Alternate(7);
                if let (Some(byte), true) = (self.usart.transmitted(), connected) {
                    self.wiring.uart_tx(byte, at, self.usart.baud());
                }
                self.pump_usart(at, memory);
            }
            if self.usart.rx_due <= at {
                self.usart.receive(self.ports[0].mode(3) == Mode::Alternate(7));
                self.pump_usart(at, memory);
            }
            if self.kick {
                self.kick = false;
                self.pump_adc(at, memory);
                self.pump_usart(at, memory);
            }
            if self.iwdg.due <= at {
                self.iwdg.due = u64::MAX;
                self.reset = Some(ResetCause::IndependentWatchdog);
            }
            self.sample_inputs(at);
            self.refresh_next(at);
        }
    }

    fn end_conversion(&mut self, at: u64, memory: &mut impl Memory) {
        let code = match self.adc.channel() {
            17 => INTERNAL_REFERENCE,
            18 => INTERNAL_TEMPERATURE,
            channel => self.wiring.adc(channel, at),
        };
        self.adc.finish(code);
        self.pump_adc(at, memory);
    }

    /// Moves a waiting ADC item if a stream listens.
    fn pump_adc(&mut self, at: u64, memory: &mut impl Memory) {
        if self.adc.wants_dma() {
            for route in &dma::ADC1 {
                if let Served::Item { last, .. } = self.serve(route, self.adc.data(), at, memory) {
                    self.adc.dma_read(last);
                    break;
                }
            }
        }
        self.nvic.set_line(ADC_IRQ, self.adc.request(), at);
    }

    fn pump_usart(&mut self, at: u64, memory: &mut impl Memory) {
        while self.usart.wants_tx() {
            let Served::Item { value, .. } = self.serve(&dma::USART2_TX[0], 0, at, memory) else {
                break;
            };
            self.usart.write_data(value, at);
        }
        if self.usart.offers_rx() && self.dma[0].listens(&dma::USART2_RX[0]) {
            let value = self.usart.read_data();
            self.serve(&dma::USART2_RX[0], value, at, memory);
        }
        self.nvic.set_line(USART2_IRQ, self.usart.request(), at);
    }

    fn serve(&mut self, route: &Route, value: u32, at: u64, memory: &mut impl Memory) -> Served {
        let controller = &mut self.dma[route.controller - 1];
        let served = controller.serve(route, value, memory);
        let (irq, level) = controller.request_line(route.stream);
        self.nvic.set_line(irq, level, at);
        served
    }

    fn timer_changed(&mut self, timer: usize, at: u64) {
        let [brk, update, trigger, compare] = self.tims[timer].requests();
        match timer {
            0 => {
                for (irq, level) in [(24, brk), (25, update), (26, trigger), (27, compare)] {
                    self.nvic.set_line(irq, level, at);
                }
                self.bridge_changed(at);
            }
            _ => {
                let irq = [28, 29, 30, 50, 54, 55][timer - 1];
                self.nvic.set_line(irq, update || trigger || compare, at);
            }
        }
        if std::mem::take(&mut self.tims[timer].trigger) {
            let source = match timer {
                1 => Some(Trigger::Tim2),
                2 => Some(Trigger::Tim3),
                _ => None,
            };
            if source.is_some() && source == self.adc.trigger() {
                self.adc.start(at);
            }
        }
    }

    /// Tells the wiring when the state of a bridge leg has changed.
    fn bridge_changed(&mut self, at: u64) {
        let legs = [self.leg(0), self.leg(1)];
        if legs != self.legs {
            self.legs = legs;
            self.wiring.bridge(legs, at);
        }
    }

    fn leg(&self, channel: usize) -> LegState {
        match (
            self.ports[0].mode(8 + channel as u8),
            self.tims[0].output(channel),
        ) {
            (Mode::Alternate(1), Output::High { high, period }) => LegState::Duty { high, period },
            (Mode::Output, _) => match self.ports[0].output(8 + channel as u8) {
                Some(level) => LegState::Duty {
                    high: u32::from(level),
                    period: 1,
                },
                None => LegState::Off,
            },
            _ => LegState::Off,
        }
    }

    fn pin(&self, port: usize, bit: u8) -> bool {
        self.ports[port].level(bit, self.wiring.pin(port as u8, bit))
    }

    /// Inputs that act without a register access: the break input and enabled EXTI lines.
    pub fn sample_inputs(&mut self, at: u64) {
        if self.tims[0].watches_break() {
            // TIM1_BKIN is AF1 of PA6 and PB12
            for (port, bit) in [(0, 6), (1, 12)] {
                if self.ports[port].mode(bit) == Mode::Alternate(1) {
                    let level = self.pin(port, bit);
                    self.tims[0].set_break(level);
                    self.timer_changed(0, at);
                }
            }
        }
        if !self.exti.is_idle() {
            self.sample_exti(at);
        }
    }

    fn sample_exti(&mut self, at: u64) {
        let mut levels = [None; 16];
        for (line, port) in self.exti.watched() {
            levels[usize::from(line)] = Some(self.pin(port, line));
        }
        for (line, level) in levels.iter().enumerate() {
            if let Some(level) = level {
                self.exti.set_level(line as u8, *level);
            }
        }
        self.exti_changed(at);
    }

    fn exti_changed(&mut self, at: u64) {
        for (irq, level) in self.exti.requests() {
            self.nvic.set_line(irq, level, at);
        }
    }

    /// Loads from a peripheral or core register. `ipsr`: the running exception.
    pub fn read(&mut self, address: u32, now: u64, ipsr: u32) -> Answer<u32> {
        if address >= 0xe000_0000 {
            if names::peripheral(address).is_none() {
                return Err(Refusal::BusError);
            }
            return self.ppb.read(&self.nvic, address, now, ipsr);
        }
        let Some((device, enable)) = device(address) else {
            return Err(if names::peripheral(address).is_some() {
                Refusal::Offset
            } else {
                Refusal::BusError
            });
        };
        if let Some((enr, bit)) = enable {
            self.rcc.check_clock(enr, bit)?;
        }
        let offset = address & 0x3ff;
        match device {
            Device::Gpio(port) => {
                let wiring = &self.wiring;
                self.ports[port].read(offset, |bit| wiring.pin(port as u8, bit))
            }
            Device::Rcc => self.rcc.read(offset, now),
            Device::Flash => self.rcc.read_flash(offset),
            Device::Pwr => self.rcc.read_pwr(offset, now),
            Device::Dma(i) => self.dma[i].read(offset),
            Device::Tim(i) => {
                let value = self.tims[i].read(offset, now)?;
                self.timer_changed(i, now);
                self.refresh_next(now);
                Ok(value)
            }
            Device::Adc => {
                let value = self.adc.read(offset)?;
                self.nvic.set_line(ADC_IRQ, self.adc.request(), now);
                Ok(value)
            }
            Device::Usart2 => {
                let value = self.usart.read(offset)?;
                self.nvic.set_line(USART2_IRQ, self.usart.request(), now);
                Ok(value)
            }
            Device::Iwdg => self.iwdg.read(offset, now),
            Device::Syscfg => self.exti.read_syscfg(offset),
            Device::Exti => self.exti.read(offset),
        }
    }

    /// Stores to a peripheral or core register. Byte and half-word stores reach the registers that take them:
    /// priorities, GPIO BSRR, USART DR; any register takes a half-word at its lower half, the rest written 0.
    pub fn write(&mut self, address: u32, bytes: u8, value: u32, now: u64) -> Answer<()> {
        if address >= 0xe000_0000 {
            if names::peripheral(address).is_none() {
                return Err(Refusal::BusError);
            }
            if self
                .ppb
                .write(&mut self.nvic, address, bytes, value, now)?
                .is_some()
            {
                self.reset = Some(ResetCause::Software);
            }
            self.refresh_next(now);
            return Ok(());
        }
        let Some((device, enable)) = device(address) else {
            return Err(if names::peripheral(address).is_some() {
                Refusal::Offset
            } else {
                Refusal::BusError
            });
        };
        if let Some((enr, bit)) = enable {
            self.rcc.check_clock(enr, bit)?;
        }
        let (mut offset, mut value) = (address & 0x3ff, value);
        match (device, bytes) {
            (Device::Gpio(_), 2) if offset == 0x1a => (offset, value) = (0x18, value << 16),
            (Device::Usart2, 1) if offset == 4 => {}
            (_, 2) if offset & 3 == 0 => {}
            (_, 4) => {}
            _ => return Err(Refusal::Width),
        }
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
            }
            Device::Rcc => {
                let old = self.rcc.clocks();
                if self.rcc.write(offset, value, now)? {
                    self.clocks_changed(old, now);
                }
                self.apply_resets(now);
            }
            Device::Flash => self.rcc.write_flash(offset, value)?,
            Device::Pwr => self.rcc.write_pwr(offset, value, now)?,
            Device::Dma(i) => {
                self.dma[i].write(offset, value)?;
                for stream in 0..8 {
                    let (irq, level) = self.dma[i].request_line(stream);
                    self.nvic.set_line(irq, level, now);
                }
                self.kick = true;
            }
            Device::Tim(i) => {
                self.tims[i].write(offset, value, now)?;
                self.timer_changed(i, now);
            }
            Device::Adc => {
                self.adc.write(offset, value, now)?;
                self.tims[1].listen(self.adc.trigger() == Some(Trigger::Tim2), now);
                self.tims[2].listen(self.adc.trigger() == Some(Trigger::Tim3), now);
                self.nvic.set_line(ADC_IRQ, self.adc.request(), now);
                self.kick = true;
            }
            Device::Usart2 => {
                self.usart.write(offset, value, now)?;
                self.nvic.set_line(USART2_IRQ, self.usart.request(), now);
                self.kick = true;
            }
            Device::Iwdg => self.iwdg.write(offset, value, now, self.rcc.clocks().hclk_hz)?,
            Device::Syscfg => self.exti.write_syscfg(offset, value)?,
            Device::Exti => {
                self.exti.write(offset, value)?;
                self.sample_exti(now);
                self.exti_changed(now);
            }
        }
        Ok(())
    }

    fn outputs_changed(&mut self, port: usize, now: u64) {
        let (old_driven, old_levels) = self.outputs[port];
        let (driven, levels) = self.ports[port].outputs();
        self.outputs[port] = (driven, levels);
        let changed = (old_driven ^ driven) | (old_levels ^ levels);
        for bit in (0..16).filter(|b| changed >> b & 1 != 0) {
            let level = (driven >> bit & 1 != 0).then_some(levels >> bit & 1 != 0);
            self.wiring.output(port as u8, bit, level, now);
        }
    }

    fn after_change(&mut self, now: u64) {
        for port in 0..PORTS {
            self.outputs_changed(port, now);
        }
        self.bridge_changed(now);
        self.refresh_next(now);
    }

    fn clocks_changed(&mut self, old: Clocks, now: u64) {
        let clocks = self.rcc.clocks();
        let ratio = |hz: u32| u64::from(clocks.hclk_hz / hz.max(1)).max(1);
        for (i, timer) in self.tims.iter_mut().enumerate() {
            timer.set_divider(
                ratio(if i == 0 {
                    clocks.timclk2_hz
                } else {
                    clocks.timclk1_hz
                }),
                now,
            );
        }
        self.adc.set_clock(ratio(clocks.pclk2_hz), clocks.pclk2_hz);
        self.usart.set_clock(ratio(clocks.pclk1_hz), clocks.hclk_hz);
        self.iwdg.rescale(now, old.hclk_hz, clocks.hclk_hz);
    }

    /// Peripherals whose reset bit is set go back to their reset values.
    fn apply_resets(&mut self, now: u64) {
        const RESETS: [(Enr, u8, Device); 18] = [
            (Enr::Apb2, 0, Device::Tim(0)),
            (Enr::Apb1, 0, Device::Tim(1)),
            (Enr::Apb1, 1, Device::Tim(2)),
            (Enr::Apb1, 2, Device::Tim(3)),
            (Enr::Apb1, 3, Device::Tim(4)),
            (Enr::Apb1, 4, Device::Tim(5)),
            (Enr::Apb1, 5, Device::Tim(6)),
            (Enr::Apb2, 8, Device::Adc),
            (Enr::Apb1, 17, Device::Usart2),
            (Enr::Apb2, 14, Device::Syscfg),
            (Enr::Ahb1, 21, Device::Dma(0)),
            (Enr::Ahb1, 22, Device::Dma(1)),
            (Enr::Ahb1, 0, Device::Gpio(0)),
            (Enr::Ahb1, 1, Device::Gpio(1)),
            (Enr::Ahb1, 2, Device::Gpio(2)),
            (Enr::Ahb1, 3, Device::Gpio(3)),
            (Enr::Ahb1, 4, Device::Gpio(4)),
            (Enr::Ahb1, 7, Device::Gpio(7)),
        ];
        for (enr, bit, device) in RESETS {
            if self.rcc.in_reset(enr, bit) {
                self.reset_device(device);
                self.after_change(now);
            }
        }
    }

    fn reset_device(&mut self, device: Device) {
        match device {
            Device::Gpio(port) => self.ports[port] = Port::new(port),
            Device::Dma(i) => self.dma[i] = Dma::new(i + 1),
            Device::Tim(i) => self.tims[i].reset(),
            Device::Adc => self.adc.reset(),
            Device::Usart2 => self.usart.reset(),
            Device::Syscfg => self.exti.reset_syscfg(),
            Device::Rcc | Device::Flash | Device::Pwr | Device::Iwdg | Device::Exti => {}
        }
    }
}
