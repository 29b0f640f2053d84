//! Stores of a byte or of a half-word to the registers of peripherals.
//!
//! Ports, RCC and flash interface take them (RM0390 7.4, 6.3, 3.8). The bridges to APB1 and APB2 make a word of them by
//! repeating the byte or half-word (2.1), so on these buses only the half-word to a register without upper half does what
//! the program means; for each peripheral its chapter says what is allowed. Everything else ends the run.
use super::bus::Device;
use super::{Chip, TIM2, TIM5};
use crate::Wiring;
use crate::stop::{Answer, Refusal};

/// Data register of the USART.
const USART_DR: u32 = 0x04;

impl<W: Wiring> Chip<W> {
    /// The store of a word that has the same effect, as offset and value.
    pub(super) fn widened(
        &self,
        device: Device,
        offset: u32,
        bytes: u8,
        value: u32,
        now: u64,
    ) -> Answer<(u32, u32)> {
        let (register, lane) = (offset & !3, offset & 3);
        match (device, bytes) {
            (Device::Gpio(_) | Device::Rcc | Device::Flash, _) => {
                let rest = self.untouched_bytes(device, register, now)?;
                let mask = (1 << (8 * u32::from(bytes))) - 1;
                let shift = 8 * lane;
                Ok((register, rest & !(mask << shift) | (value & mask) << shift))
            }
            (Device::Tim(timer), 2) if lane == 0 && !is_32_bit(timer, register) => {
                Ok((register, value & 0xffff))
            }
            (Device::Usart2 | Device::Iwdg | Device::Wwdg | Device::Syscfg, 2) if lane == 0 => {
                Ok((register, value & 0xffff))
            }
            // The repeated byte changes bit 8 too, which a frame of eight bits does not send.
            (Device::Usart2, 1) if offset == USART_DR => Ok((register, value & 0xff)),
            _ => Err(Refusal::Width),
        }
    }

    /// What a store to some bytes of a register writes to the others: their value, or nothing where writing 1 acts.
    fn untouched_bytes(&self, device: Device, register: u32, now: u64) -> Answer<u32> {
        match (device, register) {
            // BSRR, RCC_CIR, FLASH_SR
            (Device::Gpio(_), 0x18) | (Device::Rcc, 0x0c) | (Device::Flash, 0x0c) => Ok(0),
            (Device::Gpio(port), _) => self.ports[port].read(register, |_| None),
            (Device::Rcc, _) => self.rcc.read(register, now),
            // The keys are words (3.8.2, 3.8.3).
            (Device::Flash, 0x04 | 0x08) => Err(Refusal::Width),
            (Device::Flash, 0x00) => Ok(self.rcc.acr()),
            _ => self.flash.read(register, now),
        }
    }
}

/// Whether a register of a timer has 32 bits: counter, auto-reload and compare values of TIM2 and TIM5.
fn is_32_bit(timer: usize, register: u32) -> bool {
    matches!(timer, TIM2 | TIM5) && matches!(register, 0x24 | 0x2c | 0x34..=0x40)
}
