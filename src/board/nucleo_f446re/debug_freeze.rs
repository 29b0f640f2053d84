//! Debug freeze: which watchdogs and timers stand still while a debugger halts the core.
//!
//! Some debuggers let both watchdogs stop with the core (OpenOCD writes 0x1800 to DBGMCU_APB1_FZ
//! when it attaches to this chip). A halted core then keeps the last duty of the bridges for as long
//! as it is halted, and only a power-on clears the bits. So the start clears them, and each tick
//! looks at them.
//!
//! The bits of the PWM timers are not allowed either. RM0090 says of its STM32F4 that a timer which
//! stops in debug disables its outputs. For TIM10 and TIM11 the same chapter can be read both ways,
//! and a PWM output that stopped high would drive the tile with the full supply. Without these bits
//! a halted core drives at most until the window watchdog resets the device, 47 ms later.

use stm32f4xx_hal::pac::DBGMCU;

/// Lets watchdogs and timers run on while a debugger halts the core.
pub fn clear_freeze_bits(dbgmcu: &DBGMCU) {
    dbgmcu.apb1_fz().reset();
    dbgmcu.apb2_fz().reset();
}

/// Whether a watchdog or a PWM timer would stand still while a debugger halts the core.
pub fn watchdogs_or_pwm_may_freeze() -> bool {
    // SAFETY: loads without side effects.
    let dbgmcu = unsafe { &*DBGMCU::ptr() };
    let watchdogs = dbgmcu.apb1_fz().read();
    let timers = dbgmcu.apb2_fz().read();
    watchdogs.dbg_wwdg_stop().bit()
        | watchdogs.dbg_iwdg_stop().bit()
        | timers.dbg_tim1_stop().bit()
        | timers.dbg_tim8_stop().bit()
        | timers.dbg_tim10_stop().bit()
        | timers.dbg_tim11_stop().bit()
}
