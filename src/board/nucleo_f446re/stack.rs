//! The stack guard: words with a known value at the end of the stack, which an overflowing stack
//! overwrites.

use core::sync::atomic::{AtomicU32, Ordering};

/// Words of the guard.
const GUARD_WORDS: usize = 4;
/// Value of each word while the stack has not reached it.
const UNTOUCHED: u32 = 0x57ac_0bad;

unsafe extern "C" {
    /// Placed below the stack by `memory.x`.
    static _stack_guard: [AtomicU32; GUARD_WORDS];
}

fn guard() -> &'static [AtomicU32; GUARD_WORDS] {
    // SAFETY: `memory.x` reserves these words, the first of the RAM, for the guard. They are
    // atomics because code that overruns the stack may write to them.
    unsafe { &_stack_guard }
}

/// Whether the stack has overwritten the guard since it was last [initialised](init_guard).
pub fn stack_is_overrun() -> bool {
    guard()
        .iter()
        .any(|word| word.load(Ordering::Relaxed) != UNTOUCHED)
}

/// Writes the known value into the guard.
pub fn init_guard() {
    guard()
        .iter()
        .for_each(|word| word.store(UNTOUCHED, Ordering::Relaxed));
}
