//! Mean code of the heat-flux sensor without contact, from which its zero is taken.

/// Ticks of 1 ms over which the mean is taken: half a second, in which the converter's noise of a count becomes 0.04 counts.
const TICKS: u32 = 512;

/// Total of the sensor's codes over half a second without contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RestingCode(u32);

impl RestingCode {
    /// Mean code, counts.
    #[must_use]
    pub fn mean_counts(self) -> f64 {
        f64::from(self.0) / f64::from(TICKS)
    }
}

/// Adds up the codes of ticks without contact.
#[derive(Clone, Debug, Default)]
pub struct RestingCodes {
    total: u32,
    ticks: u32,
    last: Option<RestingCode>,
}

impl RestingCodes {
    /// Adds the code of a tick; `None` in contact or for one that is not valid, after which nothing counts that was before.
    pub fn add(&mut self, code: Option<u16>) {
        let Some(code) = code else {
            *self = Self::default();
            return;
        };
        self.total += u32::from(code);
        self.ticks += 1;
        if self.ticks == TICKS {
            *self = Self {
                last: Some(RestingCode(self.total)),
                ..Self::default()
            };
        }
    }

    /// The last complete half second; `None` if there was none since the last contact.
    #[must_use]
    pub const fn last(&self) -> Option<RestingCode> {
        self.last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resting_code_is_the_mean_of_half_a_second_since_the_last_contact() {
        let mut codes = RestingCodes::default();
        let mut add = |code| {
            codes.add(code);
            codes.last().map(RestingCode::mean_counts)
        };
        for tick in 1..=1500 {
            let mean = add(Some(2048 + (tick % 2)));
            assert_eq!(mean, (tick >= 512).then_some(2048.5), "{tick}");
        }
        assert_eq!(add(None), None);
        for tick in 1..=512 {
            assert_eq!(add(Some(4095)), (tick == 512).then_some(4095.0), "{tick}");
        }
    }
}
