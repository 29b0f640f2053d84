//! Codes of the heat-flux sensor that cannot be right.

use thermal_learner::WINDOW_TICKS;

/// Codes of sound wires. Beyond them the amplifier is at a rail: under more flux than its range, which copper takes from some
/// fingers in the first ticks, or with a broken wire.
const LOWEST: u16 = 64;
const HIGHEST: u16 = 4031;
/// Windows at a rail, 50 ms, after which the flux is not known well enough, or a wire is broken. A flux that was beyond the range
/// for so long is some per cent larger than what was read.
const AT_RAIL_WINDOWS_MAX: u8 = 5;
/// The same, 300 ms, while the modelled finger gives so much that another one can be beyond the range: cold copper under a force of
/// some newtons.
const AT_RAIL_WINDOWS_MAX_IF_LIKELY: u8 = 30;
/// Windows with one and the same code, 100 ms, after which the converter does not convert: noise alone changes its code in almost
/// every tick.
const UNCHANGED_WINDOWS_MAX: u8 = 10;

/// Why the codes cannot be right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeFault {
    /// A conversion has not ended.
    Missing,
    /// At a rail, or the same for too long.
    Range,
}

/// Counts the windows whose codes look wrong.
#[derive(Clone, Debug, Default)]
pub struct CodeFaults {
    last_sum: u32,
    at_rail_windows: u8,
    unchanged_windows: u8,
    present: Option<CodeFault>,
}

impl CodeFaults {
    /// Judges the codes of a window: their sum, the last one, and whether one was missing; and whether a flux beyond the range is
    /// likely, which is asked at a rail only. Returns their sum; a mean at a rail counts as the nearest code of sound wires.
    pub fn judge(
        &mut self,
        sum: u32,
        last: u16,
        is_one_missing: bool,
        is_beyond_likely: impl FnOnce() -> bool,
    ) -> u32 {
        let counted = |count: u8, is_so| if is_so { count.saturating_add(1) } else { 0 };
        let is_unchanged = sum == self.last_sum && sum == WINDOW_TICKS * u32::from(last);
        self.last_sum = sum;
        self.unchanged_windows = counted(self.unchanged_windows, is_unchanged);
        let within = sum.clamp(WINDOW_TICKS * u32::from(LOWEST), WINDOW_TICKS * u32::from(HIGHEST));
        self.at_rail_windows = counted(self.at_rail_windows, within != sum);
        let is_at_rail = self.is_saturated()
            && (self.at_rail_windows >= AT_RAIL_WINDOWS_MAX_IF_LIKELY || !is_beyond_likely());
        let is_beyond = is_at_rail || self.unchanged_windows >= UNCHANGED_WINDOWS_MAX;
        self.present = match (is_one_missing, is_beyond) {
            (true, _) => Some(CodeFault::Missing),
            (false, true) => Some(CodeFault::Range),
            (false, false) => None,
        };
        within
    }

    /// Sum of the codes of the last window.
    pub const fn last_sum(&self) -> u32 {
        self.last_sum
    }

    /// Whether the sensor was at a rail for so long that its flux is not known well enough.
    pub const fn is_saturated(&self) -> bool {
        self.at_rail_windows >= AT_RAIL_WINDOWS_MAX
    }

    /// The fault of the last window.
    #[must_use]
    pub const fn present(&self) -> Option<CodeFault> {
        self.present
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_that_stay_at_a_rail_are_faults_and_count_as_the_end_of_the_range() {
        for (sum, within) in [(0, 640), (639, 640), (40_311, 40_310), (40_950, 40_310)] {
            let mut faults = CodeFaults::default();
            for _ in 0..3 {
                for window in 1..=8 {
                    // The last code differs, as with noise.
                    assert_eq!(faults.judge(sum, 1, false, || false), within);
                    let fault = (window >= 5).then_some(CodeFault::Range);
                    assert_eq!(faults.present(), fault, "{sum}, {window}");
                }
                assert_eq!(faults.judge(20_485, 2048, false, || false), 20_485);
                assert_eq!(faults.present(), None);
            }
        }
        let mut faults = CodeFaults::default();
        for _ in 0..20 {
            for sum in [640, 40_310] {
                assert_eq!(faults.judge(sum, 1, false, || false), sum);
                assert_eq!(faults.present(), None);
            }
        }
    }

    #[test]
    fn a_flux_that_is_likely_to_be_beyond_the_range_may_be_there_for_longer() {
        let mut faults = CodeFaults::default();
        for window in 1..=40 {
            faults.judge(40_950, 1, false, || true);
            let fault = (window >= 30).then_some(CodeFault::Range);
            assert_eq!(faults.present(), fault, "{window}");
            assert_eq!(faults.is_saturated(), window >= 5, "{window}");
        }
        faults.judge(20_485, 1, false, || true);
        assert!(!faults.is_saturated() && faults.present().is_none());
    }

    #[test]
    fn a_code_that_does_not_change_is_a_fault() {
        let mut faults = CodeFaults::default();
        for _ in 0..3 {
            for window in 0..20 {
                faults.judge(20_480, 2048, false, || false);
                let fault = (window >= 10).then_some(CodeFault::Range);
                assert_eq!(faults.present(), fault, "{window}");
            }
            faults.judge(20_480, 2047, false, || false);
            assert_eq!(faults.present(), None);
            faults.judge(20_490, 2049, false, || false);
        }
        for window in 0..40 {
            faults.judge(20_480 + window % 2, 2048, false, || false);
            assert_eq!(faults.present(), None);
        }
    }

    #[test]
    fn a_missing_code_is_a_fault_of_its_window() {
        let mut faults = CodeFaults::default();
        for is_missing in [true, true, false, true, false] {
            faults.judge(20_485, 2048, is_missing, || false);
            assert_eq!(faults.present(), is_missing.then_some(CodeFault::Missing));
        }
    }
}
