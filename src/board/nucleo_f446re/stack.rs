//! The end of the stack, which nothing else may reach.

use core::sync::atomic::{AtomicU32, Ordering};

/// Words at the end of the stack that must stay as they are.
const GUARD: usize = 4;
const UNTOUCHED: u32 = 0x57ac_0bad;

unsafe extern "C" {
    /// Below the stack, by `memory.x`.
    static _stack_guard: [AtomicU32; GUARD];
}

/// The guard's words.
fn guard() -> &'static [AtomicU32; GUARD] {
    // SAFETY: `memory.x` keeps these words, the first of the RAM, for nothing else; atomics may be written by whoever
    // overruns the stack.
    unsafe { &_stack_guard }
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
