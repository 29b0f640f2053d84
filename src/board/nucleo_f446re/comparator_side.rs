//! The line that selects the side of the comparators' tests.

use stm32f4xx_hal::gpio::{Input, Output, PB2};
use stm32f4xx_hal::pac::GPIOB;
use thermal_display::device::drive::ComparatorTest;

/// PB2, common to all fingers: low connects the input of a comparator under test to a level above its window (hot), high
/// to one below it (cold).
pub struct ComparatorSide(PB2<Output>);

impl ComparatorSide {
    /// Sets up the line, for tests of the hot side.
    pub fn new(pin: PB2<Input>) -> Self {
        Self(pin.into_push_pull_output())
    }

    /// Selects the side of a test; without a test the line stays. To be called before the finger's test line is set.
    pub fn select(&mut self, test: ComparatorTest) {
        match test {
            ComparatorTest::None => {}
            ComparatorTest::Hot => self.0.set_low(),
            ComparatorTest::Cold => self.0.set_high(),
        }
    }

    /// Whether the pin does not have the level that it drives: it is shorted, or its output is
    /// damaged. To be called in the next tick, when the level has settled.
    pub fn differs_from_selected(&self) -> bool {
        // SAFETY: a load without side effects.
        let level_is_high = unsafe { &*GPIOB::ptr() }.idr().read().idr2().is_high();
        level_is_high != self.0.is_set_high()
    }
}
