//! The comparator that watches the display without the microcontroller, and cuts the bridge supply.
//!
//! ```text
//! second display thermistor's divider -> window 10 to 45 C --+
//!                                  test line (high) ---------+-> set    latch -> high-side switch of the supply open,
//!                     test line's falling edge, if inside -----> clear           nFAULT low
//! ```
//!
//! The window is a ladder of resistors on the supply of the dividers, so it does not depend on that supply's voltage; nor
//! does it know of the device's calibration: the thermistor's own tolerance adds to the ladder's. It answers within
//! microseconds, which counts as at the end of the plant's step. Not modelled: hysteresis, noise, the supply's decay.

use super::sensors::ThermistorParams;

/// Where the window ends, in temperatures of a nominal thermistor behind a nominal divider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparatorParams {
    /// Below this the display counts as too cold, deg C.
    pub cold_c: f64,
    /// Above this it counts as too hot, deg C.
    pub hot_c: f64,
}

impl ComparatorParams {
    /// The reference design's.
    pub const NOMINAL: Self = Self {
        cold_c: 10.0,
        hot_c: 45.0,
    };
}

/// What can be broken in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ComparatorDefect {
    /// Nothing.
    #[default]
    Sound,
    /// Its latch never sets: neither the window nor the test line cuts the supply.
    Dead,
    /// Its latch never clears, and is set.
    Stuck,
}

/// The comparator and its latch, cleared at power-on.
#[derive(Clone, Copy, Debug)]
pub struct Comparator {
    /// Ends of the window, in fractions of the dividers' supply: falling as it warms.
    cold_ratio: f64,
    hot_ratio: f64,
    /// What it last saw, likewise.
    seen_ratio: f64,
    /// Level of the test line.
    test: bool,
    latched: bool,
    defect: ComparatorDefect,
}

impl Comparator {
    /// Powered on in front of a divider's ratio, with the window's ends as a nominal thermistor has them.
    #[must_use]
    pub fn new(params: &ComparatorParams, nominal: &ThermistorParams, ratio: f64) -> Self {
        let mut comparator = Self {
            cold_ratio: nominal.ratio(params.cold_c),
            hot_ratio: nominal.ratio(params.hot_c),
            seen_ratio: ratio,
            test: false,
            latched: false,
            defect: ComparatorDefect::Sound,
        };
        comparator.watch(ratio);
        comparator
    }

    /// Sees the divider's ratio, 0 to 1: an open thermistor has 1 and reads cold, a shorted one 0 and reads hot.
    pub fn watch(&mut self, ratio: f64) {
        self.seen_ratio = ratio;
        self.latched |= self.outside();
    }

    /// Sets the level of the test line. High sets the latch; its falling edge clears the latch inside of the window.
    pub fn test(&mut self, level: bool) {
        let fell = self.test && !level;
        self.test = level;
        self.latched = level || self.outside() || (self.latched && !fell);
    }

    /// Breaks or mends it.
    pub const fn set_defect(&mut self, defect: ComparatorDefect) {
        self.defect = defect;
    }

    /// The supply is cut and nFAULT is pulled low.
    #[must_use]
    pub const fn tripped(&self) -> bool {
        match self.defect {
            ComparatorDefect::Sound => self.latched,
            ComparatorDefect::Dead => false,
            ComparatorDefect::Stuck => true,
        }
    }

    fn outside(&self) -> bool {
        !(self.hot_ratio..=self.cold_ratio).contains(&self.seen_ratio)
    }
}

#[cfg(test)]
mod tests;
