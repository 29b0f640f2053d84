//! The trigger input: the timer TIM3 stores the time of a rising edge, to a microsecond.
//!
//! TIM3 counts the microseconds of two ticks, again and again. The first scan of all starts it, by the trigger output of
//! TIM2, so its count, modulo 1000, is the time since the start of a tick's first scan, and no delay of the program
//! falsifies it.
//!
//! ```text
//! us      0                           WAITS_FROM_US      tick    999 | 0
//! scans   first                                      last            | first
//! edge    reported by the tick ------------------> | by the next tick
//! ```
//!
//! An edge shortly before the tick is left for the next tick. Otherwise it would depend on the tick's
//! delay by some microseconds which of the two reports it. An edge just after the tick may be seen by the next one at the
//! same time of its own millisecond; the second thousand counts tell that it is a millisecond old.

use stm32f4xx_hal::gpio::{Alternate, Input, PB4, Pull};
use stm32f4xx_hal::pac::TIM3;
use stm32f4xx_hal::rcc::{Enable, Rcc, Reset};
use thermal_display::device::TriggerEdge;

use super::wiring::FINGERS;

/// Counts of TIM3 in a second, in a tick, and until it is 0 again.
const COUNT_HZ: u32 = 1_000_000;
const COUNTS_PER_TICK: u16 = 1000;
const COUNTS: u16 = 2 * COUNTS_PER_TICK;
/// Count from which on an edge waits for the next tick of the first finger. That tick reads the timer at 963 with one
/// finger, and with five, whose first block ends earlier, at 200.
const WAITS_FROM_US: u16 = if FINGERS == 1 { 900 } else { 150 };

/// PB4, channel 1 of TIM3: the trigger input.
pub struct TriggerInput {
    timer: TIM3,
    _pin: PB4<Alternate<2>>,
    /// An edge that waits for the next tick.
    waiting: Option<TriggerEdge>,
}

impl TriggerInput {
    /// Sets up pin and timer; the timer starts with the first scan. The weak internal pull-down keeps an input that is not
    /// connected low.
    pub fn new(timer: TIM3, pin: PB4<Input>, rcc: &mut Rcc) -> Self {
        TIM3::enable(rcc);
        TIM3::reset(rcc);
        let clock_hz = rcc.clocks.timclk1().raw();
        timer.psc().write(|w| w.psc().set((clock_hz / COUNT_HZ - 1) as u16));
        timer.arr().write(|w| w.arr().set(COUNTS - 1));
        // The prescaler takes effect at an update event.
        timer.egr().write(|w| w.ug().update());
        timer.ccmr1_input().write(|w| w.cc1s().ti1());
        timer.ccer().write(|w| w.cc1e().set_bit());
        timer.sr().write(|w| w.uif().clear_bit());
        timer.smcr().write(|w| w.ts().itr1().sms().trigger_mode());
        Self { timer, _pin: pin.into_alternate().internal_resistor(Pull::Down), waiting: None }
    }

    /// The last rising edge since the call before, but for one that must wait. Called in each tick of the first finger.
    pub fn take_edge(&mut self) -> Option<TriggerEdge> {
        let is_new = self.timer.sr().read().cc1if().bit_is_set();
        if is_new || self.waiting.is_some() { self.take_new_or_waiting(is_new) } else { None }
    }

    #[cold]
    #[inline(never)]
    fn take_new_or_waiting(&mut self, is_new: bool) -> Option<TriggerEdge> {
        let waited = self.waiting.take();
        if !is_new {
            return waited;
        }
        // Reading the captured count clears the flag.
        let captured = self.timer.ccr1().read().ccr().bits();
        let now = self.timer.cnt().read().cnt().bits();
        let us = captured % COUNTS_PER_TICK;
        let edge = TriggerEdge { us, ticks_ago: u8::from(us >= WAITS_FROM_US) };
        // Times since the edge, and since edges wait for the next tick.
        let age_us = (now + COUNTS - captured) % COUNTS;
        let waits_since_us = (now + COUNTS - WAITS_FROM_US) % COUNTS_PER_TICK;
        if age_us <= waits_since_us {
            self.waiting = Some(edge);
            return waited;
        }
        Some(edge)
    }
}
