//! What a test tells the runner, by semihosting. A call halts the core for up to a tenth of a second, in which watchdogs would
//! reset the chip; so from the first call on they stand still while the core is halted.

use core::fmt::{self, Write};
use core::panic::PanicInfo;

use heapless::String;
use semihosting::sys::arm_compat::sys_write0;

use crate::board::nucleo_f446re::debug_freeze::clear_freeze_bits;
use crate::board::pac::DBGMCU;

/// Longest line; the rest is cut off.
const LINE_BYTES: usize = 256;

/// Prints `figure KEY VALUE UNIT`, which `cargo xtask on-target` writes into the documentation.
pub fn figure(key: &str, value: impl fmt::Display, unit: &str) {
    line(format_args!("figure {key} {value} {unit}"));
}

/// Prints a line.
pub fn line(content: fmt::Arguments<'_>) {
    let mut text = String::<LINE_BYTES>::new();
    // What fits is printed.
    let _ = text.write_fmt(content);
    let mut line = heapless::Vec::<u8, { LINE_BYTES + 2 }>::new();
    let _ = line.extend_from_slice(text.as_bytes());
    let _ = line.extend_from_slice(b"\n\0");
    if let Ok(line) = core::ffi::CStr::from_bytes_until_nul(&line) {
        hold_watchdogs_while_halted();
        sys_write0(line);
    }
}

/// Ends the test that has gone on after a reset.
pub fn succeed() -> ! {
    hold_watchdogs_while_halted();
    semihosting::process::exit(0)
}

/// Lets both watchdogs stand still while the probe has halted the core.
pub fn hold_watchdogs_while_halted() {
    debug_module().apb1_fz().modify(|_, w| {
        w.dbg_iwdg_stop().set_bit();
        w.dbg_wwdg_stop().set_bit()
    });
}

/// As the firmware sets them.
pub fn let_watchdogs_run_while_halted() {
    clear_freeze_bits(&debug_module());
}

fn debug_module() -> DBGMCU {
    // SAFETY: its registers take effect only while the core is halted.
    unsafe { DBGMCU::steal() }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    line(format_args!("{info}"));
    semihosting::process::abort()
}
