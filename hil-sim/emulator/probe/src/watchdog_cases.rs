//! Cases of the watchdogs, and of states that only a watchdog ends.
use crate::device_cases::{GPIOA, RCC, clock_180_mhz, product_load, pwm, start_watchdog};
use crate::{core_cases, log, read, set, write};
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

const WWDG: usize = 0x4000_2c00;
const ISER0: usize = 0xe000_e100;
const RCC_CIR: usize = RCC + 0x0c;
const IWDGRSTF: u32 = 0x20;
const WWDGRSTF: u32 = 0x40;

/// Two words that start-up does not initialise.
#[unsafe(link_section = ".uninit.KEPT")]
#[unsafe(no_mangle)]
static KEPT: MaybeUninit<[AtomicU32; 2]> = MaybeUninit::uninit();
static REFRESHES: AtomicBool = AtomicBool::new(false);

fn kept(index: usize) -> usize {
    KEPT.as_ptr() as usize + 4 * index
}

/// Logs the reset flags, and after a reset by the watchdog of `flag` the kept words. `true`: there was one.
fn was_reset_by(flag: u32) -> bool {
    let flags = read(RCC + 0x74) >> 24;
    log(flags);
    let reset = flags & flag != 0;
    if reset {
        log(read(kept(0)));
        log(read(kept(1)));
    }
    reset
}

/// The window opens 31 of 64 periods after a refresh.
fn start_window_watchdog() {
    write(kept(0), 0x00fe_ed00);
    write(kept(1), 0);
    set(RCC + 0x40, 1 << 11);
    write(WWDG + 4, 1 << 9 | 0x60);
    write(WWDG, 0xff);
}

/// Refreshes three times inside the window, then no more; the early interrupt counts its activations. PA5 changes with each
/// refresh.
pub fn window_watchdog() {
    if was_reset_by(WWDGRSTF) {
        return;
    }
    set(RCC + 0x30, 1);
    write(GPIOA, read(GPIOA) | 1 << 10);
    write(ISER0, 1);
    start_window_watchdog();
    for refresh in 0..3 {
        cortex_m::asm::delay(50_000); // about 10 ms at 16 MHz
        write(GPIOA + 0x14, (refresh + 1) << 5);
        write(WWDG, 0xff);
    }
    crate::sleep_forever()
}

pub fn early_wakeup() {
    write(kept(1), read(kept(1)) + 1);
    write(WWDG + 8, 0);
}

pub fn refresh_outside_the_window() {
    if was_reset_by(WWDGRSTF) {
        return;
    }
    start_window_watchdog();
    write(WWDG, 0xff);
    loop {
        cortex_m::asm::nop();
    }
}

pub fn lockup_under_watchdog() {
    if was_reset_by(IWDGRSTF) {
        return;
    }
    write(kept(0), 0x0010_cced);
    start_watchdog();
    core_cases::lockup();
}

/// The product's load; the tick refreshes the window watchdog, 64 periods of 4096 * 8 / 45 MHz.
pub fn load_under_window_watchdog() {
    if was_reset_by(WWDGRSTF) {
        return;
    }
    product_load();
    set(RCC + 0x40, 1 << 11);
    write(WWDG + 4, 3 << 7 | 0x7f);
    write(WWDG, 0xff);
    REFRESHES.store(true, Relaxed);
}

pub fn refresh() {
    if REFRESHES.load(Relaxed) {
        write(WWDG, 0xff);
    }
}

/// Drives the bridge with the clock security system on.
pub fn clock_security() {
    clock_180_mhz(5);
    set(RCC, 1 << 19);
    set(RCC + 0x30, 1);
    set(RCC + 0x44, 1);
    pwm();
}

/// Logs the pending clock interrupts and the source of the system clock, then clears the request.
pub fn clock_failed() {
    log(0x4000 | core_cases::ipsr());
    log(read(RCC_CIR));
    log(read(RCC + 8) >> 2 & 3);
    write(RCC_CIR, 1 << 23);
}

/// The product's load under an independent watchdog that is never fed.
pub fn load_without_clock_security() {
    if was_reset_by(IWDGRSTF) {
        return;
    }
    start_watchdog();
    product_load();
}

pub fn lockup_with_clock_security() {
    if was_reset_by(IWDGRSTF) {
        return;
    }
    clock_180_mhz(5);
    set(RCC, 1 << 19);
    start_watchdog();
    core_cases::lockup();
}
