//! Hardware window comparator that cuts the bridge supply independently of the microcontroller.
//!
//! ```text
//! second display thermistor's divider --+
//! test level, 48 or 5 C ----------------+- test switch -- hot side, cold side --> set    latch -> supply switch open,
//!                     test line's falling edge, filtered, if inside ------------> clear           nFAULT low
//! ```
//!
//! A resistor ladder on the supply of the dividers sets the thresholds, so they are independent of that voltage. The
//! comparator does not use the device's calibration: the tolerance of the thermistor adds to that of the ladder. The
//! latch is set at power-on. An excursion sets it within 1 to 3 ms, modelled as the end of the plant's step. Not
//! modelled: hysteresis, noise.

use super::sensors::ThermistorParams;

/// Thresholds, as temperatures of a nominal thermistor in a nominal divider, test levels and delay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparatorParams {
    /// Lower threshold, deg C.
    pub cold_c: f64,
    /// Upper threshold, deg C.
    pub hot_c: f64,
    /// Input in the test of the cold side, deg C.
    pub cold_test_c: f64,
    /// Input in the test of the hot side, deg C.
    pub hot_test_c: f64,
    /// Time from the falling edge of the test line until the latch is cleared, s.
    pub release_s: f64,
}

impl ComparatorParams {
    /// Values of the circuit in `hardware/`.
    pub const NOMINAL: Self =
        Self { cold_c: 10.0, hot_c: 45.0, cold_test_c: 5.0, hot_test_c: 48.0, release_s: 4.2e-3 };
}

/// What the microcontroller connects the comparator's input to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ComparatorTest {
    /// The thermistor.
    #[default]
    None,
    /// The level above the window.
    Hot,
    /// The level below the window.
    Cold,
}

/// Defect of the latch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LatchDefect {
    /// No defect.
    #[default]
    None,
    /// Never set: neither the window nor a test cuts the supply.
    StuckClear,
    /// Set and never cleared.
    StuckSet,
}

/// Defects of the comparator; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ComparatorDefects {
    /// The hot side never sets the latch.
    pub hot_dead: bool,
    /// The cold side never sets the latch.
    pub cold_dead: bool,
    /// Shift of both thresholds by a wrong resistor of the ladder, K. The test levels have resistors of their own.
    pub ladder_shift_k: f64,
    /// The latch.
    pub latch: LatchDefect,
    /// Stuck level of the line by which the device selects the side of a test; true is high. `None`: the line follows the
    /// device. While it is stuck high every test is of the cold side, while it is stuck low every test is of the hot side.
    pub side_stuck: Option<bool>,
}

/// The comparator and its latch.
#[derive(Clone, Copy, Debug)]
pub struct Comparator {
    params: ComparatorParams,
    /// The thermistor that thresholds and levels assume.
    nominal: ThermistorParams,
    /// Thresholds as divider ratios, which fall with temperature.
    cold_ratio: f64,
    hot_ratio: f64,
    /// Last divider ratio of the thermistor.
    input_ratio: f64,
    test: ComparatorTest,
    /// Time until the end of the last test clears the latch, s.
    clear_in_s: Option<f64>,
    latched: bool,
    defects: ComparatorDefects,
}

/// A remaining time below this is rounding, s.
const TIME_TOLERANCE_S: f64 = 1e-9;

impl Comparator {
    /// State after power-on with a divider ratio at the input; `nominal` is the thermistor that the thresholds assume.
    pub fn new(params: &ComparatorParams, nominal: &ThermistorParams, ratio: f64) -> Self {
        Self {
            params: *params,
            nominal: *nominal,
            cold_ratio: nominal.ratio(params.cold_c),
            hot_ratio: nominal.ratio(params.hot_c),
            input_ratio: ratio,
            test: ComparatorTest::None,
            clear_in_s: None,
            latched: true,
            defects: ComparatorDefects::default(),
        }
    }

    /// Advances by a step, s, to the thermistor's divider ratio at its end, 0 (shorted, reads hot) to 1 (open, reads
    /// cold).
    pub fn step(&mut self, step_s: f64, ratio: f64) {
        self.input_ratio = ratio;
        self.latched |= self.is_outside();
        if let Some(clear_in_s) = &mut self.clear_in_s {
            *clear_in_s -= step_s;
            if *clear_in_s <= TIME_TOLERANCE_S {
                self.clear();
            }
        }
    }

    /// Sets the test. Its end clears the latch, with a delay, if the thermistor is in the window. If the select line of
    /// the side is stuck, the test is of the side that its level selects, whichever side was requested.
    pub fn set_test(&mut self, test: ComparatorTest) {
        let test = match (test, self.defects.side_stuck) {
            (ComparatorTest::None, _) | (_, None) => test,
            (_, Some(false)) => ComparatorTest::Hot,
            (_, Some(true)) => ComparatorTest::Cold,
        };
        let ended = self.test != ComparatorTest::None && test == ComparatorTest::None;
        self.test = test;
        self.latched |= self.is_outside();
        if ended {
            self.clear_in_s = Some(self.params.release_s);
        } else if test != ComparatorTest::None {
            self.clear_in_s = None;
        }
    }

    /// Clears the latch if the input is in the window.
    pub fn clear(&mut self) {
        self.clear_in_s = None;
        self.latched = self.is_outside();
    }

    /// Sets the latch, as the microcontroller's reset line does.
    pub fn set_latch(&mut self) {
        (self.latched, self.clear_in_s) = (true, None);
    }

    /// Sets the defects.
    pub fn set_defects(&mut self, defects: &ComparatorDefects) {
        self.defects = *defects;
        let ratio = |threshold_c: f64| self.nominal.ratio(threshold_c + defects.ladder_shift_k);
        (self.cold_ratio, self.hot_ratio) = (ratio(self.params.cold_c), ratio(self.params.hot_c));
    }

    /// Whether the supply is cut and nFAULT pulled low.
    pub const fn tripped(&self) -> bool {
        match self.defects.latch {
            LatchDefect::None => self.latched,
            LatchDefect::StuckClear => false,
            LatchDefect::StuckSet => true,
        }
    }

    fn is_outside(&self) -> bool {
        let ratio = match self.test {
            ComparatorTest::None => self.input_ratio,
            ComparatorTest::Hot => self.nominal.ratio(self.params.hot_test_c),
            ComparatorTest::Cold => self.nominal.ratio(self.params.cold_test_c),
        };
        (ratio < self.hot_ratio && !self.defects.hot_dead)
            || (ratio > self.cold_ratio && !self.defects.cold_dead)
    }
}

#[cfg(test)]
mod tests;
