#![doc = include_str!("../README.md")]

mod adc;
mod board;
mod build;
mod chip;
mod cost;
mod dma;
mod elf;
mod exceptions;
mod exti;
mod faults;
mod flash;
mod gpio;
mod inject;
mod iwdg;
mod mcu;
mod names;
mod nvic;
mod path;
mod ppb;
mod profile;
mod ram;
mod rcc;
mod run;
mod setup;
mod stalls;
mod standstill;
mod state;
mod stop;
mod tim;
mod timebase;
mod usart;
mod wwdg;

pub use board::{Image, ImageHand, StartError};
pub use build::build;
pub use elf::{FLASH_BASE, FLASH_SIZE, Firmware, ImageError, RAM_BASE, RAM_SIZE};
pub use inject::InjectError;
pub use mcu::{Machine, Reset};
pub use path::{Path, Ran};
pub use profile::{InterruptStats, Stats};
pub use rcc::{Clocks, HSE_HZ, HSI_HZ, LSI_HZ};
pub use stalls::cold_fetch_stalls;
pub use stop::{Access, Place, Stop};

/// What is soldered to the pins. Times are CPU cycles since power-up and never go back.
pub trait Wiring {
    /// 12-bit code that ADC `channel` (0 to 15) converts at `now`, the end of the conversion.
    fn adc(&mut self, channel: u8, now: u64) -> u16;

    /// Level that the outside puts on a pin (port 0 is A). `None`: nothing drives it; then the port's pull-up or
    /// pull-down decides, and a floating pin reads low. Pins that act without being read (break input, EXTI) are
    /// sampled at every device event, so at least once a conversion.
    fn pin(&self, port: u8, bit: u8) -> Option<bool>;

    /// A byte left USART2's transmitter: its stop bit ended at `at`, the rate was `baud` bits a second.
    fn uart_tx(&mut self, byte: u8, at: u64, baud: u32);

    /// The bridge legs (TIM1 CH1 on PA8, CH2 on PA9) are driven differently from `at` on.
    fn bridge(&mut self, _legs: [LegState; 2], _at: u64) {}

    /// A general-purpose output changed at `at`; `None`: the pin is no longer driven.
    fn output(&mut self, _port: u8, _bit: u8, _level: Option<bool>, _at: u64) {}
}

/// How a timer drives one input of a bridge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LegState {
    /// Nothing drives the pin: main output off, channel off, or the pin is not the timer's.
    Off,
    /// High for `high` of every `period` timer ticks; a constant level has period 1.
    Duty {
        /// Ticks high.
        high: u32,
        /// Ticks of a PWM period, ARR + 1.
        period: u32,
    },
}

impl LegState {
    /// Share of the time that the pin is high, 0 to 1; `None` when nothing drives it.
    pub fn duty(self) -> Option<f64> {
        match self {
            LegState::Off => None,
            LegState::Duty { high, period } => Some(f64::from(high) / f64::from(period)),
        }
    }
}
