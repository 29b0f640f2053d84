//! Codes of the heat-flux sensor without contact, from which its zero is taken.

use thermal_learner::WINDOW_TICKS;

/// Windows over which the mean is taken: half a second, in which the converter's noise of a count becomes 0.04 counts.
const WINDOWS: u32 = 50;

/// Sum of the sensor's codes over half a second without contact, from which its zero is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoContactCodeSum(u32);

impl NoContactCodeSum {
    /// Mean code, counts.
    pub fn mean_counts(self) -> f64 {
        f64::from(self.0) / f64::from(WINDOWS * WINDOW_TICKS)
    }
}

/// Adds up the codes of windows without contact.
#[derive(Clone, Debug, Default)]
pub struct NoContactCodes {
    total: u32,
    windows: u32,
    last: Option<NoContactCodeSum>,
}

impl NoContactCodes {
    /// Adds the sum of a window's codes; `None` in contact or if one is not valid, after which nothing counts that was before.
    pub fn add(&mut self, codes: Option<u32>) {
        let Some(codes) = codes else {
            *self = Self::default();
            return;
        };
        self.total += codes;
        self.windows += 1;
        if self.windows == WINDOWS {
            self.last = Some(NoContactCodeSum(self.total));
            (self.total, self.windows) = (0, 0);
        }
    }

    /// The last complete half second; `None` if there was none since the last contact.
    pub const fn last(&self) -> Option<NoContactCodeSum> {
        self.last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_contact_code_is_the_mean_of_half_a_second_since_the_last_contact() {
        let mut codes = NoContactCodes::default();
        let mut add = |codes_of_window| {
            codes.add(codes_of_window);
            codes.last().map(NoContactCodeSum::mean_counts)
        };
        for window in 1..=150 {
            let mean = add(Some(20_480 + 10 * (window % 2)));
            assert_eq!(mean, (window >= 50).then_some(2048.5), "{window}");
        }
        assert_eq!(add(None), None);
        for window in 1..=50 {
            let mean = add(Some(40_310));
            assert_eq!(mean, (window == 50).then_some(4031.0), "{window}");
        }
    }
}
