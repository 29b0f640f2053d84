//! The stack guard: words with a known value at the end of the stack, which an overflowing stack
//! overwrites.

use core::sync::atomic::{AtomicU32, Ordering};

/// Number of 32-bit words in the guard below the stack.
const GUARD_WORDS: usize = 4;
/// Value of each word of the guard while the stack has not overwritten it.
const UNTOUCHED: u32 = 0x57ac_0bad;

unsafe extern "C" {
    /// The guard: words that `memory.x` places directly below the stack, so that an overflow overwrites them.
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

/// Writes the known value into all words of the guard, at every start.
pub fn init_guard() {
    guard()
        .iter()
        .for_each(|word| word.store(UNTOUCHED, Ordering::Relaxed));
}
