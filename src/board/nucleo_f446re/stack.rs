//! The end of the stack, which nothing else may reach.

use core::sync::atomic::{AtomicU32, Ordering};

/// Words at the end of the stack that must stay as they are.
const GUARD: usize = 4;
const UNTOUCHED: u32 = 0x57ac_0bad;

unsafe extern "C" {
    /// Lowest address of the stack, by the linker.
    static _stack_end: [AtomicU32; GUARD];
}

/// The guard's words.
fn guard() -> &'static [AtomicU32; GUARD] {
    // SAFETY: the linker puts the end of the stack at the beginning of the RAM, where nothing is but the stack; atomics
    // may be written by whoever overruns it.
    unsafe { &_stack_end }
}

/// Whether the stack has grown into its guard since [`arm`].
pub fn is_overrun() -> bool {
    guard()
        .iter()
        .any(|word| word.load(Ordering::Relaxed) != UNTOUCHED)
}

/// Sets the guard up.
pub fn arm() {
    guard()
        .iter()
        .for_each(|word| word.store(UNTOUCHED, Ordering::Relaxed));
}
