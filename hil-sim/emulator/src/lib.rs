#![doc = include_str!("../README.md")]

mod adc;
mod alignment;
mod board;
mod build;
mod chip;
mod corrections;
mod cost;
mod cpu_setup;
mod crc;
mod dac;
mod debugger;
mod dma;
mod elf;
mod embedded_tests;
mod exceptions;
mod execution_path;
mod exti;
mod faults;
mod flash;
mod flash_waiting;
mod gpio;
mod halt;
mod inject;
mod instruction;
mod iwdg;
mod mcu;
mod names;
mod nvic;
mod ppb;
mod profile;
mod ram;
mod rcc;
mod run;
mod state;
mod stop;
mod strict;
mod tim;
mod timebase;
mod usart;
mod wwdg;

pub use board::{FiveFingerBoard, OneFingerBoard, StartError};
pub use build::build;
pub use debugger::Halted;
pub use elf::{FLASH_BASE, FLASH_SIZE, Firmware, ImageError, RAM_BASE, RAM_SIZE};
pub use embedded_tests::{EmbeddedTest, EmbeddedTests, NotATestImage};
pub use execution_path::{ExecutedBlock, ExecutionPath};
pub use inject::InjectError;
pub use mcu::{Machine, Reset};
pub use profile::{InterruptStats, Stats};
pub use rcc::{Clocks, HSE_HZ, HSI_HZ, LSI_HZ};
pub use stop::{Access, Place, Stop};

/// The circuit at the pins. Times are CPU cycles since power-up, in ascending order.
pub trait Wiring {
    /// 12-bit code that ADC `channel` (0 to 15) converts at `now`, the end of the conversion.
    fn adc(&mut self, channel: u8, now: u64) -> u16;

    /// Level that the circuit drives on a pin (port 0 is A); on an output that is a short. `None`: not driven; the pin has the level of its pull-up or
    /// pull-down, and a floating pin reads low. Break inputs and EXTI lines are sampled at every device event, so at least
    /// once per conversion.
    fn pin(&self, port: u8, bit: u8) -> Option<bool>;

    /// USART2 has sent a byte, at `baud` bit/s; its stop bit ended at `at`.
    fn uart_tx(&mut self, byte: u8, at: u64, baud: u32);

    /// The drive of the bridge legs (TIM1 CH1 on PA8, CH2 on PA9) changed at `at`.
    fn bridge(&mut self, _legs: [LegState; 2], _at: u64) {}

    /// A general-purpose output changed at `at`; `None`: no longer driven.
    fn output(&mut self, _port: u8, _bit: u8, _level: Option<bool>, _at: u64) {}
}

/// How a timer drives one input of a bridge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LegState {
    /// Not driven: main output off, channel off, or not a pin of a timer.
    Off,
    /// High for `high` ticks of every `period` timer ticks; a constant level has period 1.
    Duty {
        /// Ticks high.
        high: u32,
        /// Ticks of a PWM period, ARR + 1.
        period: u32,
    },
}

impl LegState {
    /// Duty cycle, 0 to 1; `None` if not driven.
    pub fn duty(self) -> Option<f64> {
        match self {
            LegState::Off => None,
            LegState::Duty { high, period } => Some(f64::from(high) / f64::from(period)),
        }
    }
}
