//! The peripherals, their connections inside the chip, and their events in order of time. Independent of the CPU emulation;
//! register accesses enter through `chip/bus.rs`.
use super::adc::{self, Adc, Trigger};
use super::crc::Crc;
use super::dac::Dac;
use super::dma::{self, Dma, Route, Served};
use super::exti::{Exti, lines};
use super::flash::Flash;
use super::gpio::{Mode, PORTS, Port};
use super::iwdg::Iwdg;
use super::nvic::{Nvic, exception};
use super::ppb::Ppb;
use super::ram::Memory;
use super::rcc::{Clocks, HSI_HZ, Rcc};
use super::stop::Refusal;
use super::tim::{self, Output, Tim};
use super::timebase::Timebase;
use super::usart::Usart;
use super::wwdg::Wwdg;
use super::{LegState, Wiring};
use thermal_sim::processor::{ChipState, ResetCause};

mod access_width;
mod alternate_outputs;
mod bus;
mod debug_freeze;
mod failures;
#[cfg(test)]
mod register_table;
#[cfg(test)]
mod tests;
mod write_buffer;

use write_buffer::WriteBuffer;

/// Modelled timers, and the indices of those that the chip names; in order TIM1 to TIM7, TIM8, TIM10, TIM11.
const TIMERS: usize = 10;
const TIM1: usize = 0;
const TIM2: usize = 1;
const TIM3: usize = 2;
const TIM4: usize = 3;
const TIM5: usize = 4;
const TIM8: usize = 7;
const TIM10: usize = 8;
const TIM11: usize = 9;
/// Modelled converters.
pub(super) const ADC1: usize = 0;
pub(super) const ADC2: usize = 1;
/// Pins that are outputs of the modelled timers (DS10693, table 11): port, bit, alternate function, timer, channel.
const TIMER_PINS: [(u8, u8, u8, usize, usize); 10] = [
    (0, 8, 1, TIM1, 0),
    (0, 9, 1, TIM1, 1),
    (0, 10, 1, TIM1, 2),
    (0, 11, 1, TIM1, 3),
    (2, 6, 3, TIM8, 0),
    (2, 7, 3, TIM8, 1),
    (2, 8, 3, TIM8, 2),
    (2, 9, 3, TIM8, 3),
    (1, 8, 3, TIM10, 0),
    (1, 9, 3, TIM11, 0),
];
/// Break inputs (same table): timer, port, bit, alternate function.
const BREAK_PINS: [(usize, u8, u8, u8); 3] = [(TIM1, 0, 6, 1), (TIM1, 1, 12, 1), (TIM8, 0, 6, 3)];
/// Capture inputs of which edges can come from outside (same table): timer, channel, port, bit, alternate function.
const CAPTURE_PINS: [(usize, usize, u8, u8, u8); 1] = [(TIM3, 0, 1, 4, 2)];
/// ADC_CR2, which selects the trigger.
const ADC_CR2: u32 = 0x4001_2008;
const WWDG_IRQ: usize = 0;
const ADC_IRQ: usize = 18;
const USART2_IRQ: usize = 38;
/// Initial bit rate of the host, bit/s.
const HOST_BAUD: u32 = 1_000_000;
/// Codes of the internal channels at 3.3 V and 25 degC: VREFINT 1.21 V, temperature sensor 0.76 V (DS10693 6.3.22
/// and 6.3.24).
const INTERNAL_REFERENCE: u16 = 1502;
const INTERNAL_TEMPERATURE: u16 = 943;
/// The DAC drives PA4, which is also this channel of the converter.
const DAC_PIN: u8 = 4;
const DAC_CHANNEL: u8 = 4;
/// Code of a quarter of VBAT, which a NUCLEO connects to the converter's reference.
const QUARTER_OF_VBAT: u16 = 1024;

pub(crate) struct Chip<W> {
    pub wiring: W,
    pub nvic: Nvic,
    pub ppb: Ppb,
    rcc: Rcc,
    pub flash: Flash,
    ports: [Port; PORTS],
    exti: Exti,
    dma: [Dma; 2],
    adcs: [Adc; 2],
    dac: Dac,
    crc: Crc,
    tims: [Tim; TIMERS],
    usart: Usart,
    /// Rate of the internal low-speed oscillator, which differs from chip to chip.
    lsi_hz: u32,
    /// Words that the factory gives each chip.
    unique_id: [u32; 3],
    iwdg: Iwdg,
    wwdg: Wwdg,
    /// A debugger has halted the core.
    halted_by_debugger: bool,
    /// Whether the chip checks what software must respect of its errata.
    strict: bool,
    /// Up to date where instructions are noted, on a strict chip.
    write_buffer: WriteBuffer,
    pub time: Timebase,
    /// Cycle at which the last clock of the chip stopped; timers and pins keep the state of that cycle.
    stopped_at: Option<u64>,
    legs: [LegState; 2],
    outputs: [(u32, u32); PORTS],
    /// A store may have made a DMA request possible; it is served before the next block.
    dma_request_possible: bool,
    /// Cycles asleep since power-up.
    pub slept: u64,
    pub reset: Option<ResetCause>,
    /// The first use of a device between register accesses that a manual forbids, and the register that set it up.
    pub misuse: Option<(u32, Refusal)>,
    /// Cycle of the next event of any device.
    pub next: u64,
    /// As `next`, without the events of converters and serial line, which are nearly all and change no other device's next event.
    next_of_others: u64,
}

impl<W: Wiring> Chip<W> {
    pub fn new(wiring: W, flash: Vec<u8>, state: &ChipState) -> Self {
        let kinds = [
            tim::ADVANCED,
            tim::WIDE,
            tim::GENERAL,
            tim::GENERAL,
            tim::WIDE,
            tim::BASIC,
            tim::BASIC,
            tim::ADVANCED,
            tim::SINGLE,
            tim::SINGLE,
        ];
        Self {
            wiring,
            nvic: Nvic::new(),
            ppb: Ppb::new(),
            rcc: Rcc::powered_up(state),
            flash: Flash::new(flash, state),
            ports: std::array::from_fn(Port::new),
            exti: Exti::default(),
            dma: [Dma::new(1), Dma::new(2)],
            adcs: [adc::Unit::Adc1, adc::Unit::Adc2].map(|unit| Adc::new(unit, 1, HSI_HZ)),
            dac: Dac::default(),
            crc: Crc::default(),
            tims: kinds.map(|kind| Tim::new(kind, 1)),
            usart: Usart::new(1, HSI_HZ, HOST_BAUD),
            lsi_hz: state.lsi_hz,
            unique_id: state.unique_id,
            iwdg: Iwdg::new(state.lsi_hz),
            wwdg: Wwdg::new(),
            halted_by_debugger: false,
            strict: state.strict,
            write_buffer: WriteBuffer::default(),
            time: Timebase::new(HSI_HZ),
            stopped_at: None,
            legs: [LegState::Off; 2],
            outputs: [(0, 0); PORTS],
            dma_request_possible: false,
            slept: 0,
            reset: None,
            misuse: None,
            next: u64::MAX,
            next_of_others: u64::MAX,
        }
    }

    pub fn clocks(&self) -> Clocks {
        self.rcc.clocks()
    }

    /// Whether instructions must be [noted](Self::note_instruction).
    #[inline]
    pub fn counts_instructions(&self) -> bool {
        self.rcc.has_fresh_clocks() || self.write_buffer.register().is_some()
    }

    /// Takes note of an instruction, in half-words, before it runs.
    pub fn note_instruction(&mut self, (first, second): (u32, u32)) {
        let is_dsb = first == 0xf3bf && second & 0xfff0 == 0x8f40;
        self.rcc.note_instruction(is_dsb);
        self.write_buffer.note_instruction(is_dsb);
    }

    /// Takes note of the return of a handler.
    pub fn note_exception_return(&mut self) {
        if let (true, Some(register), None) =
            (self.strict, self.write_buffer.register(), self.misuse)
        {
            let rule =
                "a handler returns right behind a store to it, without a DSB (Cortex-M4, 838869)";
            self.misuse = Some((register, Refusal::Misuse(rule)));
        }
    }

    /// Brings the timers up to `now`; how a pin is driven, by a timer or as an output.
    pub fn pwm(&mut self, port: u8, bit: u8, now: u64) -> LegState {
        if self.stopped_at.is_none() {
            for timer in [TIM1, TIM8, TIM10, TIM11] {
                self.tims[timer].sync(now);
            }
        }
        self.pin_drive(port, bit)
    }

    pub fn output(&self, port: u8, bit: u8) -> Option<bool> {
        self.ports.get(usize::from(port)).filter(|_| bit < 16).and_then(|p| p.output(bit))
    }

    /// Adds cycles that the CPU slept.
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
        if self.stopped_at.is_some() {
            self.next_of_others = self.iwdg.due;
            self.next = self.iwdg.due;
            return;
        }
        let timers = self.tims.iter().fold(u64::MAX, |least, t| least.min(t.due));
        self.next_of_others = timers
            .min(self.ppb.systick_due)
            .min(self.iwdg.due)
            .min(self.wwdg.due)
            .min(if self.dma_request_possible { now } else { u64::MAX });
        self.refresh_next_of_streams();
    }

    /// As [`Self::refresh_next`], after events of the converters or the serial line only.
    fn refresh_next_of_streams(&mut self) {
        self.next = (self.next_of_others)
            .min(self.adcs[ADC1].due)
            .min(self.adcs[ADC2].due)
            .min(self.usart.tx_due)
            .min(self.usart.rx_due);
    }

    /// Handles every device event up to `now`, in order of time.
    pub fn service(&mut self, now: u64, memory: &mut impl Memory) {
        while self.next <= now {
            if self.stopped_at.is_some() {
                self.service_without_clock(now);
                break;
            }
            let at = self.next;
            if at < self.next_of_others {
                // Conversions and bytes change no pin.
                self.service_streams(at, memory);
                self.refresh_next_of_streams();
                continue;
            }
            if self.ppb.systick_due <= at && self.ppb.systick_expire() {
                self.nvic.pend(exception::SYSTICK, at);
            }
            for timer in 0..TIMERS {
                if self.tims[timer].due <= at {
                    self.tims[timer].sync(at);
                    self.timer_changed(timer, at);
                }
            }
            self.service_streams(at, memory);
            if self.dma_request_possible {
                self.dma_request_possible = false;
                self.serve_adc_dma(at, memory);
                self.serve_usart_dma(at, memory);
            }
            if self.iwdg.due <= at {
                self.iwdg.due = u64::MAX;
                self.reset = Some(ResetCause::IndependentWatchdog);
            }
            if self.wwdg.due <= at {
                if self.wwdg.sync(at) {
                    self.reset = Some(ResetCause::WindowWatchdog);
                }
                self.nvic.set_line(WWDG_IRQ, self.wwdg.request(), at);
            }
            self.sample_inputs(at);
            self.refresh_next(at);
        }
    }

    /// Handles the events of the converters and of the serial line up to `at`.
    fn service_streams(&mut self, at: u64, memory: &mut impl Memory) {
        for converter in [ADC1, ADC2] {
            if self.adcs[converter].due <= at {
                self.end_conversion(converter, at, memory);
            }
        }
        if self.usart.tx_due <= at {
            let connected = self.ports[0].mode(2) == Mode::Alternate(7);
            if let Some(byte) = self.usart.transmitted() {
                self.usart.hear_own(byte, at);
                if connected {
                    self.wiring.uart_tx(byte, at, self.usart.baud());
                }
            }
            self.serve_usart_dma(at, memory);
        }
        if self.usart.rx_due <= at {
            self.usart.receive(self.ports[0].mode(3) == Mode::Alternate(7));
            self.serve_usart_dma(at, memory);
        }
    }

    fn end_conversion(&mut self, converter: usize, at: u64, memory: &mut impl Memory) {
        let adc = &self.adcs[converter];
        let code = match adc.channel() {
            17 => INTERNAL_REFERENCE,
            18 if adc.measures_vbat() => QUARTER_OF_VBAT,
            18 => INTERNAL_TEMPERATURE,
            DAC_CHANNEL if self.ports[0].mode(DAC_PIN) == Mode::Analog => {
                (self.dac.output()).unwrap_or_else(|| self.wiring.adc(DAC_CHANNEL, at))
            }
            channel => self.wiring.adc(channel, at),
        };
        self.adcs[converter].finish(code);
        self.serve_adc_dma(at, memory);
    }

    /// Transfers a waiting item of ADC1 if a stream is enabled for it.
    fn serve_adc_dma(&mut self, at: u64, memory: &mut impl Memory) {
        if self.adcs[ADC1].wants_dma() {
            for route in &dma::ADC1 {
                let item = self.adcs[ADC1].data();
                if let Served::Item { last, .. } = self.serve(route, item, at, memory) {
                    self.adcs[ADC1].dma_read(last);
                    break;
                }
            }
        }
        self.nvic.set_line(ADC_IRQ, self.converters_request(), at);
    }

    /// The interrupt that all converters share.
    fn converters_request(&self) -> bool {
        self.adcs.iter().any(Adc::request)
    }

    fn serve_usart_dma(&mut self, at: u64, memory: &mut impl Memory) {
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
        let mut advanced = |first: usize| {
            for (irq, level) in [brk, update, trigger, compare].into_iter().enumerate() {
                self.nvic.set_line(first + irq, level, at);
            }
        };
        match timer {
            TIM1 => advanced(24),
            TIM8 => advanced(43),
            // Their interrupts are shared with TIM1 and cannot be enabled.
            TIM10 | TIM11 => {}
            _ => {
                let irq = [28, 29, 30, 50, 54, 55][timer - 1];
                self.nvic.set_line(irq, update || trigger || compare, at);
            }
        }
        if timer == TIM1 {
            self.bridge_changed(at);
        }
        if std::mem::take(&mut self.tims[timer].trigger) {
            let source = match timer {
                1 => Some(Trigger::Tim2),
                2 => Some(Trigger::Tim3),
                _ => None,
            };
            if timer == TIM2 {
                for slave in [TIM3, TIM4] {
                    if self.tims[slave].is_started_by_tim2() {
                        self.tims[slave].start(at);
                    }
                }
            }
            if source.is_some() && source == self.adcs[ADC1].trigger() {
                let result = self.adcs[ADC1].start(at);
                if let (Err(refusal), None) = (result, self.misuse) {
                    self.misuse = Some((ADC_CR2, refusal));
                }
            }
        }
    }

    /// Tells the timers whether ADC1 or another timer uses their trigger outputs.
    fn connect_triggers(&mut self, now: u64) {
        let of_adc = self.adcs[ADC1].trigger();
        let starts_timers = [TIM3, TIM4].iter().any(|slave| self.tims[*slave].is_started_by_tim2());
        self.tims[TIM2].use_trigger(of_adc == Some(Trigger::Tim2) || starts_timers, now);
        self.tims[TIM3].use_trigger(of_adc == Some(Trigger::Tim3), now);
    }

    /// Reports a changed bridge leg to the wiring.
    fn bridge_changed(&mut self, at: u64) {
        let legs = [self.pin_drive(0, 8), self.pin_drive(0, 9)];
        if legs != self.legs {
            self.legs = legs;
            self.wiring.bridge(legs, at);
        }
    }

    fn pin_drive(&self, port: u8, bit: u8) -> LegState {
        let Some(pins) = self.ports.get(usize::from(port)).filter(|_| bit < 16) else {
            return LegState::Off;
        };
        let constant = |high: bool| LegState::Duty { high: high.into(), period: 1 };
        match pins.mode(bit) {
            Mode::Alternate(function) => {
                let of_pin = |pin: &&(u8, u8, u8, usize, usize)| {
                    (pin.0, pin.1, pin.2) == (port, bit, function)
                };
                let Some(&(.., timer, channel)) = TIMER_PINS.iter().find(of_pin) else {
                    return LegState::Off;
                };
                match (self.tims[timer].output(channel), self.stopped_at) {
                    (Output::Released, _) => LegState::Off,
                    (Output::High { .. }, None) if self.tims[timer].is_halted() => {
                        constant(self.tims[timer].is_high(channel, 0))
                    }
                    (Output::High { high, period }, None) => LegState::Duty { high, period },
                    (_, Some(at)) => constant(self.tims[timer].is_high(channel, at)),
                }
            }
            Mode::Output => pins.output(bit).map_or(LegState::Off, constant),
            Mode::Input | Mode::Analog => LegState::Off,
        }
    }

    fn pin(&self, port: usize, bit: u8) -> bool {
        self.ports[port].level(bit, self.wiring.pin(port as u8, bit))
    }

    /// Samples the inputs that act without a register access: break inputs, captured inputs and enabled EXTI lines.
    pub fn sample_inputs(&mut self, at: u64) {
        for (timer, port, bit, function) in BREAK_PINS {
            let watched = self.tims[timer].watches_break();
            if watched && self.ports[usize::from(port)].mode(bit) == Mode::Alternate(function) {
                let level = self.pin(usize::from(port), bit);
                if self.tims[timer].set_break(level) {
                    self.timer_changed(timer, at);
                }
            }
        }
        for (timer, channel, port, bit, function) in CAPTURE_PINS {
            if self.ports[usize::from(port)].mode(bit) == Mode::Alternate(function) {
                let level = self.pin(usize::from(port), bit);
                if self.tims[timer].set_input(channel, level, at) {
                    self.timer_changed(timer, at);
                }
            }
        }
        if self.exti.watched() != 0 {
            self.sample_exti(at);
        }
    }

    fn sample_exti(&mut self, at: u64) {
        for line in lines(self.exti.watched()) {
            let level = self.pin(self.exti.port(line), line);
            if self.exti.set_level(line, level) {
                self.exti_changed(at);
            }
        }
    }

    fn exti_changed(&mut self, at: u64) {
        for (irq, level) in self.exti.requests() {
            self.nvic.set_line(irq, level, at);
        }
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
}
