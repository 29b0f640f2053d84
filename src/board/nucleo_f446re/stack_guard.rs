//! The stack guard: words with a known value at the end of the stack, which an overflowing stack
//! overwrites.

use core::sync::atomic::{AtomicU32, Ordering};

/// Number of 32-bit words in the guard below the stack.
const GUARD_WORD_COUNT: usize = 4;
/// Value of each word of the guard while the stack has not overwritten it.
const GUARD_VALUE: u32 = 0x57ac_0bad;

unsafe extern "C" {
    /// The guard: words that `memory.x` places directly below the stack, so that an overflow of the
    /// stack overwrites them.
    static _stack_guard: [AtomicU32; GUARD_WORD_COUNT];
}

fn guard_words() -> &'static [AtomicU32; GUARD_WORD_COUNT] {
    // SAFETY: `memory.x` reserves these words, the first of the RAM, for the guard. They are
    // atomics because code that overruns the stack may write to them.
    unsafe { &_stack_guard }
}

/// Whether the stack has overwritten the guard since [`init_guard`] last wrote it. Every control
/// tick checks this and, if so, trips all fingers by `Fault::Stack`. The next start checks it too,
/// because a reset does not clear the guard.
pub fn stack_is_overrun() -> bool {
    let [first, second, third, fourth] = guard_words();
    // All words without a branch, as they are nearly always intact.
    let difference = |word: &AtomicU32| word.load(Ordering::Relaxed) ^ GUARD_VALUE;
    difference(first) | difference(second) | difference(third) | difference(fourth) != 0
}

/// Writes the expected value into all words of the guard. Called at every start, after the check
/// whether the stack has overwritten the guard before the reset.
pub fn init_guard() {
    guard_words().iter().for_each(|word| word.store(GUARD_VALUE, Ordering::Relaxed));
}
