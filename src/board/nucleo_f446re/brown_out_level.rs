//! The brown-out level of the option bytes: below which supply voltage the chip is held in reset.

use stm32f4xx_hal::pac::FLASH;

/// The level at which the flash, with five wait states at 180 MHz, is always within its supply range
/// (data sheet: from 2.7 V on).
pub const REQUIRED_LEVEL: u8 = 3;

/// The brown-out level: 3 resets below some 2.8 V, 2 below 2.5 V, 1 below 2.2 V; 0 is off, as
/// delivered, and resets below some 1.7 V only.
pub fn brown_out_level(flash: &FLASH) -> u8 {
    // The code 00 is level 3, and 11 is off (RM0390, 3.8.6).
    3 - flash.optcr().read().bor_lev().bits()
}
