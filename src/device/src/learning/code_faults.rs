//! Codes of the heat-flux sensor that cannot be right.

use thermal_learner::WINDOW_TICKS;

use super::window_sums::CodeSums;

/// Codes of sound wires. Beyond them the amplifier is at a rail: under more flux than its range, which copper takes from some
/// fingers in the first ticks, or with a broken wire.
const LOWEST: u16 = 64;
const HIGHEST: u16 = 4031;
/// Windows at a rail, 50 ms, after which the flux is not known well enough, or a wire is broken. A flux that was beyond the range
/// for so long is some per cent larger than what was read.
const AT_RAIL_WINDOWS_MAX: u8 = 5;
/// Windows, 100 ms, after which a code that has not changed is that of a converter which does not convert: noise alone changes it
/// in almost every tick.
const UNCHANGED_WINDOWS_MAX: u8 = 10;

/// A code at a rail counts as the nearest one of sound wires.
pub fn within_range(code: u16) -> u16 {
    code.clamp(LOWEST, HIGHEST)
}

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
    at_rail_windows: u8,
    unchanged_windows: u8,
    present: Option<CodeFault>,
}

impl CodeFaults {
    /// Judges the codes of a window.
    pub fn judge(&mut self, codes: &CodeSums) {
        let counted = |count: u8, is_so| if is_so { count.saturating_add(1) } else { 0 };
        let ends = [LOWEST, HIGHEST].map(|end| WINDOW_TICKS * u32::from(end));
        self.at_rail_windows = counted(self.at_rail_windows, ends.contains(&codes.sum()));
        self.unchanged_windows = counted(self.unchanged_windows, codes.changed_bits == 0);
        self.present = if codes.is_one_missing {
            Some(CodeFault::Missing)
        } else if self.at_rail_windows >= AT_RAIL_WINDOWS_MAX
            || self.unchanged_windows >= UNCHANGED_WINDOWS_MAX
        {
            Some(CodeFault::Range)
        } else {
            None
        };
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

    /// Codes of the same window, over and over: after how many windows there is which fault.
    fn first_fault(codes: [u16; 10]) -> Option<(u32, CodeFault)> {
        let mut faults = CodeFaults::default();
        (1..=20).find_map(|window| {
            let mut sums = CodeSums::default();
            for (tick, code) in codes.into_iter().enumerate() {
                sums.add(within_range(code), within_range(codes[(tick + 9) % 10]), tick % 2 == 0);
            }
            faults.judge(&sums);
            faults.present().map(|fault| (window, fault))
        })
    }

    #[test]
    fn codes_that_stay_at_a_rail_or_do_not_change_are_faults() {
        let alternating = |low, high| core::array::from_fn(|tick| if tick % 2 == 0 { low } else { high });
        for (low, high) in [(0, 63), (0, 64), (4031, 4032), (4032, u16::MAX)] {
            assert_eq!(first_fault(alternating(low, high)), Some((5, CodeFault::Range)));
        }
        for (low, high) in [(0, 65), (4030, 4095), (2048, 2049)] {
            assert_eq!(first_fault(alternating(low, high)), None);
        }
        assert_eq!(first_fault([2048; 10]), Some((10, CodeFault::Range)));
    }

    #[test]
    fn a_window_of_right_codes_ends_the_fault() {
        let mut faults = CodeFaults::default();
        for _ in 0..3 {
            for window in 1..=8 {
                let mut sums = CodeSums::default();
                (0..10).for_each(|_| sums.add(HIGHEST, HIGHEST, true));
                faults.judge(&sums);
                assert_eq!(faults.present().is_some(), window >= 5, "{window}");
            }
            let mut sums = CodeSums::default();
            (0..10).for_each(|_| sums.add(2048, 2049, true));
            faults.judge(&sums);
            assert_eq!(faults.present(), None);
            sums.is_one_missing = true;
            faults.judge(&sums);
            assert_eq!(faults.present(), Some(CodeFault::Missing));
        }
    }
}
