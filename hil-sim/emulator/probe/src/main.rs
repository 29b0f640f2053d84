//! Test image for the emulated microcontroller. The level of port C's pins selects the case, which writes its observations
//! to [`LOG`].
#![no_std]
#![no_main]

mod core_cases;
mod device_cases;
mod published_cycles;
mod watchdog_cases;

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use cortex_m_rt::{entry, exception};

/// Entries of the log.
const ENTRIES: usize = 256;

/// Observations in order. The first word is the number of entries.
#[unsafe(no_mangle)]
pub static LOG: [AtomicU32; ENTRIES + 1] = [const { AtomicU32::new(0) }; ENTRIES + 1];

/// Appends a word to the log.
pub fn log(word: u32) {
    cortex_m::interrupt::free(|_| {
        let used = LOG[0].load(Relaxed) as usize;
        if let Some(entry) = LOG.get(used + 1) {
            entry.store(word, Relaxed);
            LOG[0].store(used as u32 + 1, Relaxed);
        }
    });
}

/// Reads a register.
pub fn read(address: usize) -> u32 {
    // SAFETY: the address is that of a register, or has no memory where a fault is intended; no Rust object is there.
    unsafe { (address as *const u32).read_volatile() }
}

/// Writes a register.
pub fn write(address: usize, value: u32) {
    // SAFETY: as in `read`.
    unsafe { (address as *mut u32).write_volatile(value) }
}

/// Sets bits of a register.
pub fn set(address: usize, bits: u32) {
    write(address, read(address) | bits);
}

const AHB1ENR: usize = 0x4002_3830;
const GPIOC_IDR: usize = 0x4002_0810;

#[entry]
fn main() -> ! {
    set(AHB1ENR, 1 << 2);
    match read(GPIOC_IDR) {
        0 => core_cases::exceptions(),
        1 => core_cases::float_context(),
        2 => core_cases::bad_load(),
        3 => core_cases::undefined(),
        4 => core_cases::lockup(),
        5 => core_cases::software_reset(),
        6 => core_cases::sleep_by_events(),
        7 => device_cases::clock_off_read(),
        8 => device_cases::unmodelled_register(),
        9 => device_cases::clock_off(),
        10 => device_cases::too_few_wait_states(),
        11 => device_cases::encoder_mode(),
        12 => device_cases::watchdog(),
        13 => device_cases::product_load(),
        14 => device_cases::baud_mismatch(),
        15 => device_cases::external_memory(),
        16 => device_cases::encoder_mode_then_sleep(),
        17 => core_cases::condition_ends_with_its_block(),
        18 => core_cases::condition_survives_interrupts(),
        19 => watchdog_cases::window_watchdog(),
        20 => watchdog_cases::refresh_outside_the_window(),
        21 => watchdog_cases::lockup_under_watchdog(),
        22 => watchdog_cases::load_under_window_watchdog(),
        23 => watchdog_cases::clock_security(),
        24 => watchdog_cases::load_without_clock_security(),
        25 => watchdog_cases::lockup_with_clock_security(),
        26 => core_cases::waits_for_flips(),
        27 => core_cases::semihosting_call(),
        28 => core_cases::float_state_behind_an_exception(),
        29 => core_cases::special_registers(),
        30 => core_cases::flipped_float_state(),
        31 => core_cases::dual_multiplication(),
        60 => device_cases::narrow_stores(),
        61 => device_cases::half_word_of_a_word_register(),
        62 => device_cases::stream_enabled_with_flags(),
        63 => device_cases::trigger_before_the_converter_is_stable(),
        64 => device_cases::edge_before_its_selection(),
        70 => published_cycles::elliptic_curve(),
        _ => {}
    }
    done()
}

/// Sleeps between interrupts.
pub fn sleep_forever() -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}

/// End of a case.
pub fn done() -> ! {
    log(0xd0e);
    sleep_forever()
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    log(0xbad);
    sleep_forever()
}

#[exception]
unsafe fn DefaultHandler(interrupt: i16) {
    match interrupt {
        0 => watchdog_cases::early_wakeup(),
        6..=8 => core_cases::software_interrupt(interrupt),
        38 => device_cases::usart2(),
        _ => log(0x0bad_0000 | interrupt as u32),
    }
}

#[exception]
unsafe fn NonMaskableInt() {
    watchdog_cases::clock_failed();
}

#[exception]
fn SysTick() {
    watchdog_cases::refresh();
    core_cases::tick();
}

#[exception]
fn SVCall() {
    core_cases::supervisor_call();
}

#[exception]
fn PendSV() {
    log(0x1000 | core_cases::ipsr());
}

#[exception]
unsafe fn HardFault(frame: &cortex_m_rt::ExceptionFrame) -> ! {
    core_cases::hard_fault(frame.pc())
}
