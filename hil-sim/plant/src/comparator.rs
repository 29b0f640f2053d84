//! Hardware window comparator that cuts the bridge supply independently of the microcontroller.
//!
//! ```text
//! second display thermistor's divider -> window 10 to 45 C --+
//!                                  test line (high) ---------+-> set    latch -> high-side switch of the supply open,
//!                     test line's falling edge, if inside -----> clear           nFAULT low
//! ```
//!
//! A resistor ladder on the supply of the dividers sets the thresholds, so they are independent of that voltage. The
//! comparator does not use the device's calibration: the tolerance of the thermistor adds to that of the ladder. It
//! responds within microseconds, modelled as the end of the plant's step. Not modelled: hysteresis, noise, decay of the
//! supply.

use super::sensors::ThermistorParams;

/// Thresholds, as temperatures of a nominal thermistor in a nominal divider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparatorParams {
    /// Lower threshold, deg C.
    pub cold_c: f64,
    /// Upper threshold, deg C.
    pub hot_c: f64,
}

impl ComparatorParams {
    /// Values of the reference design.
    pub const NOMINAL: Self = Self {
        cold_c: 10.0,
        hot_c: 45.0,
    };
}

/// Defect of the comparator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ComparatorDefect {
    /// No defect.
    #[default]
    None,
    /// The latch is never set: neither the window nor the test line cuts the supply.
    NeverTrips,
    /// The latch is set and never cleared.
    AlwaysTripped,
}

/// The comparator and its latch, cleared at power-on.
#[derive(Clone, Copy, Debug)]
pub struct Comparator {
    /// Thresholds as divider ratios, which fall with temperature.
    cold_ratio: f64,
    hot_ratio: f64,
    /// Last divider ratio of the thermistor.
    input_ratio: f64,
    /// Level of the test line.
    test: bool,
    latched: bool,
    defect: ComparatorDefect,
}

impl Comparator {
    /// State after power-on with a divider ratio at the input; `nominal` is the thermistor that the thresholds assume.
    #[must_use]
    pub fn new(params: &ComparatorParams, nominal: &ThermistorParams, ratio: f64) -> Self {
        let mut comparator = Self {
            cold_ratio: nominal.ratio(params.cold_c),
            hot_ratio: nominal.ratio(params.hot_c),
            input_ratio: ratio,
            test: false,
            latched: false,
            defect: ComparatorDefect::None,
        };
        comparator.set_input(ratio);
        comparator
    }

    /// Sets the divider ratio at the input, 0 (shorted thermistor, reads hot) to 1 (open thermistor, reads cold).
    pub fn set_input(&mut self, ratio: f64) {
        self.input_ratio = ratio;
        self.latched |= self.outside();
    }

    /// Sets the level of the test line. High sets the latch; the falling edge clears it if the input is in the window.
    pub fn set_test_line(&mut self, level: bool) {
        let fell = self.test && !level;
        self.test = level;
        self.latched = level || self.outside() || (self.latched && !fell);
    }

    /// Sets the defect.
    pub const fn set_defect(&mut self, defect: ComparatorDefect) {
        self.defect = defect;
    }

    /// Whether the supply is cut and nFAULT pulled low.
    #[must_use]
    pub const fn tripped(&self) -> bool {
        match self.defect {
            ComparatorDefect::None => self.latched,
            ComparatorDefect::NeverTrips => false,
            ComparatorDefect::AlwaysTripped => true,
        }
    }

    fn outside(&self) -> bool {
        !(self.hot_ratio..=self.cold_ratio).contains(&self.input_ratio)
    }
}

#[cfg(test)]
mod tests;
