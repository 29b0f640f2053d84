//! The settings of the PWM timers TIM1 and TIM8 that protect the bridges: break, idle level and
//! their lock.
//!
//! The lock (LOCK in the register BDTR) prevents faulty code from changing break, idle level,
//! polarity and PWM mode before the next reset. It can be written once after a reset: the first
//! write of BDTR freezes it, whatever that write puts into it (RM0390, 17.4.18). `pwm_hz` of
//! `stm32f4xx-hal` writes BDTR, so the settings are written whole before. The lock also protects the
//! PWM mode, which therefore comes even earlier; what `pwm_hz` and the channels write to protected
//! bits afterwards has no effect.

use stm32f4xx_hal::pac::tim1::RegisterBlock;
use stm32f4xx_hal::pac::tim1::bdtr::BKP;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::time::Hertz;
use thermal_display::device::PWM_STEPS_PER_SECOND;

/// The PWM frequency whose period has this many steps.
pub fn frequency_of_period(steps: u16) -> Hertz {
    // Rounded down; `pwm_hz` rounds the period down, which gives the same number of steps.
    (PWM_STEPS_PER_SECOND / u32::from(steps)).Hz()
}

/// Sets all channels of a timer, which must just have been reset, to PWM with preload, enables its
/// break at this level of the break input, and locks these settings until the next reset. The
/// outputs stay disabled. Disabled outputs are driven to their idle level, low.
pub fn set_and_lock(timer: &RegisterBlock, break_level: BKP) {
    timer.ccmr1_output().write(|w| {
        w.oc1m().pwm_mode1().oc1pe().enabled();
        w.oc2m().pwm_mode1().oc2pe().enabled()
    });
    timer.ccmr2_output().write(|w| {
        w.oc3m().pwm_mode1().oc3pe().enabled();
        w.oc4m().pwm_mode1().oc4pe().enabled()
    });
    timer.bdtr().write(|w| {
        w.bke().enabled();
        w.bkp().variant(break_level);
        w.ossi().idle_level();
        w.aoe().manual();
        w.moe().disabled_idle();
        w.lock().level3()
    });
}

/// Whether a timer still has the settings that [`set_and_lock`] has written, whether its outputs are
/// enabled or not.
pub fn are_set_and_locked(timer: &RegisterBlock, break_level: BKP) -> bool {
    let settings = timer.bdtr().read();
    settings.bke().is_enabled()
        & (settings.bkp() == break_level)
        & settings.ossi().is_idle_level()
        & settings.aoe().is_manual()
        & settings.lock().is_level3()
}

/// The level of a timer's lock, 0 (off) to 3.
pub fn lock_level(timer: &RegisterBlock) -> u8 {
    timer.bdtr().read().lock().bits()
}
