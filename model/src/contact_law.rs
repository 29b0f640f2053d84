//! Contact law of one finger: Eq. 6-8 with its own exponent and microhardness, and a gap.

use core::ops::RangeInclusive;

use crate::material::SKIN_MICROHARDNESS_PA;
use crate::reference::Real;

/// Thermal contact conductance of one finger's skin under pressure: that of the spots in contact by Eq. 6-8, with an exponent
/// and a microhardness of its own, and parallel to it that of the gap between them, which the thesis does not model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// Exponent of the relative pressure.
    pub exponent: f64,
    /// Microhardness of the skin, Pa.
    pub hardness_pa: f64,
    /// Conductance of the gap, W/(m² K).
    pub gap_w_m2k: f64,
}

impl ContactLaw {
    /// Eq. 6-8 as the thesis has it.
    pub const NOMINAL: Self =
        Self { exponent: 0.95, hardness_pa: SKIN_MICROHARDNESS_PA, gap_w_m2k: 0.0 };
    /// Exponents that are accepted.
    pub const EXPONENTS: RangeInclusive<f64> = 0.3..=1.5;
    /// Microhardnesses that are accepted, Pa.
    pub const HARDNESSES_PA: RangeInclusive<f64> = 1e3..=1e8;
    /// Conductances of a gap that are accepted, W/(m² K).
    pub const GAPS_W_M2K: RangeInclusive<f64> = 0.0..=1e5;

    /// Conductance under a pressure, W/(m² K), where that of the spots at a pressure equal to the microhardness is
    /// `at_hardness_w_m2k` ([`crate::reference::conductance_at_hardness`]).
    pub fn conductance_w_m2k(&self, at_hardness_w_m2k: f64, pressure_pa: f64) -> f64 {
        at_hardness_w_m2k * Real::powf(pressure_pa / self.hardness_pa, self.exponent)
            + self.gap_w_m2k
    }
}
