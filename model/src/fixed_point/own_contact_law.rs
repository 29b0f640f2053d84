//! Contact law of one finger in fixed point.

use fixed::types::{U2F30, U8F24, U16F16};

use super::half_space::inverse;
use super::pressure::LOG2_MICROHARDNESS;
use super::{Log2, log2, to_fixed};
use crate::contact_law::ContactLaw;
use crate::material::SKIN;

/// Binary places of a microhardness in Pa, such that the largest one that a [`ContactLaw`] accepts fits.
const HARDNESS_BITS: u32 = 5;
/// Logarithms of pressures beyond this are those of no contact; their products with an exponent fit in 64 bits.
const LOG2_MAX: Log2 = Log2::lit("1024");

/// A [`ContactLaw`] that is not that of Eq. 6-8, for the control path. Against the law in `f64` its conductance has a relative
/// error below 1e-4 for the accepted values and forces from 3 mN to 20 N.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OwnContactLaw {
    exponent: U2F30,
    /// `log2` of the microhardness over that of Eq. 6-8.
    log2_hardness_ratio: Log2,
    /// Scaled flux through the gap per kelvin.
    gap: U8F24,
}

impl OwnContactLaw {
    /// The law in ticks of `tick_s` seconds; values beyond those that are accepted saturate. `None` for the nominal law, which
    /// is that of every contact without one of its own, and for one that differs from it by less than the resolution.
    pub fn new(law: &ContactLaw, tick_s: f64) -> Option<Self> {
        let own = Self::rounded(law, tick_s);
        (own != Self::rounded(&ContactLaw::NOMINAL, tick_s)).then_some(own)
    }

    fn rounded(law: &ContactLaw, tick_s: f64) -> Self {
        let hardness: fixed::FixedU32<fixed::types::extra::U5> = to_fixed(law.hardness_pa);
        let log2_hardness = log2(hardness.to_bits()) - Log2::from_num(HARDNESS_BITS);
        let root_tick_per_effusivity = libm::sqrt(tick_s) / SKIN.effusivity();
        Self {
            exponent: to_fixed(law.exponent),
            log2_hardness_ratio: log2_hardness - LOG2_MICROHARDNESS,
            gap: to_fixed(law.gap_w_m2k * root_tick_per_effusivity),
        }
    }

    /// `log2` of the power of the relative pressure, from `log2(P / H)` with the microhardness of Eq. 6-8; saturates beyond
    /// +-1024.
    pub(super) fn power(&self, log2_relative_pressure: Log2) -> Log2 {
        let relative = log2_relative_pressure.saturating_sub(self.log2_hardness_ratio);
        let bits = relative.clamp(-LOG2_MAX, LOG2_MAX).to_bits();
        let exponent = i64::from(self.exponent.to_bits());
        let high = (bits >> 32) * exponent;
        let low = i64::from(bits as u32) * exponent;
        const PLACES: u32 = U2F30::FRAC_NBITS;
        Log2::from_bits((high << (32 - PLACES)) + (low >> PLACES))
    }

    /// Whether it has a gap.
    pub(super) fn has_gap(&self) -> bool {
        self.gap != U8F24::ZERO
    }

    /// A resistance with the gap parallel to it, both as temperature difference per scaled flux.
    pub(super) fn with_gap(&self, resistance: U16F16) -> U16F16 {
        const PLACES: u32 = U16F16::FRAC_NBITS + U8F24::FRAC_NBITS;
        let product = u64::from(resistance.to_bits()) * u64::from(self.gap.to_bits());
        // From 2^40 to 2^64.
        let more = product.saturating_add(1 << PLACES);
        let zeros = more.leading_zeros();
        let inverse = inverse((more << zeros >> 32) as u32);
        let bits = u64::from(resistance.to_bits()) * u64::from(inverse);
        U16F16::from_bits((bits >> (62 + 32 - PLACES - zeros)) as u32)
    }
}

#[cfg(test)]
mod tests {
    use fixed::types::I4F28;
    use proptest::prelude::*;

    use super::*;
    use crate::fixed_point::{
        ContactPair, Force, MantissaExponent, OwnResistances, Ratio, log2_relative_pressure,
    };
    use crate::material::{MATERIALS, REFERENCE_DISPLAY, find};
    use crate::pressure::pressure_pa;
    use crate::reference::conductance_at_hardness;

    const TICK_S: f64 = 1e-3;
    /// Resolution of a resistance, m² K/W.
    const RESOLUTION_M2K_W: f64 = 4.2e-10;

    /// Half of the resolution of a gap's conductance, W/(m² K).
    const GAP_ROUNDING_W_M2K: f64 = 1.2e-3;
    /// Largest resistance, m² K/W, before the gap is added.
    const RESISTANCE_MAX_M2K_W: f64 = 1.77;

    /// Resistance and ratio with those of the law, as far as the resistance without the gap fits.
    fn assert_resistances(law: &ContactLaw, force_n: f64) -> Result<(), TestCaseError> {
        let pressure = log2_relative_pressure(Force::from_num(force_n));
        let own = OwnResistances {
            law: OwnContactLaw::new(law, TICK_S),
            skin_factor: I4F28::lit("0.5"),
            ..OwnResistances::NONE
        };
        for (_, material) in &MATERIALS {
            let pair =
                ContactPair::new(&SKIN, material, &REFERENCE_DISPLAY, TICK_S).expect("a pair");
            let contact = own.contact(&pair, pressure);
            let exact = |surface| {
                let mean = conductance_at_hardness::<f64>(&SKIN.surface, surface);
                let with_gap = law.conductance_w_m2k(mean, pressure_pa(force_n));
                let fits = with_gap - law.gap_w_m2k > 1.0 / RESISTANCE_MAX_M2K_W;
                fits.then_some(1.0 / with_gap)
            };
            let both = exact(&REFERENCE_DISPLAY).zip(exact(&material.surface));
            let Some(exact) = both.map(<[f64; 2]>::from) else {
                continue;
            };
            let gap_rounding = |resistance: f64| GAP_ROUNDING_W_M2K * resistance;
            let scale = SKIN.effusivity() / TICK_S.sqrt();
            let display = contact.expected_display_resistance(&own).to_num::<f64>() / scale;
            let allowed = 3e-5 + 2.0 * RESOLUTION_M2K_W / exact[0] + gap_rounding(exact[0]);
            prop_assert!((display / exact[0] - 1.0).abs() < allowed, "{display} of {}", exact[0]);
            let ratio = exact[0] / exact[1];
            if ratio < Ratio::MAX.to_num::<f64>() {
                let found = contact.ratio_of(&own).to_num::<f64>();
                let resolution = RESOLUTION_M2K_W * (1.0 / exact[0] + 1.0 / exact[1]);
                let roundings = gap_rounding(exact[0]) + gap_rounding(exact[1]);
                let allowed = 3e-5 + 4.0 * resolution + roundings;
                prop_assert!((found / ratio - 1.0).abs() < allowed, "{found} of {ratio}");
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn resistances_are_those_of_the_law_in_f64(
            exponent in 0.85..1.0,
            hardness_pa in 5e4..3e5,
            gap_w_m2k in prop_oneof![Just(0.0), 0.0..2000.0],
            log_force in 0.01f64.ln()..10f64.ln(),
        ) {
            let law = ContactLaw { exponent, hardness_pa, gap_w_m2k };
            assert_resistances(&law, log_force.exp())?;
        }

        /// As long as the resistance fits.
        #[test]
        fn so_are_those_of_all_accepted_laws(
            exponent in ContactLaw::EXPONENTS,
            log_hardness in 1e3f64.ln()..1e8f64.ln(),
            gap_w_m2k in 1.0..1e5,
            log_force in 0.01f64.ln()..10f64.ln(),
        ) {
            let law = ContactLaw { exponent, hardness_pa: log_hardness.exp(), gap_w_m2k };
            assert_resistances(&law, log_force.exp())?;
        }

        #[test]
        fn any_pressure_and_resistance_saturate(
            exponent in ContactLaw::EXPONENTS,
            hardness_pa in ContactLaw::HARDNESSES_PA,
            gap_w_m2k in ContactLaw::GAPS_W_M2K,
            pressure: i64,
            resistance: u32,
        ) {
            let law = ContactLaw { exponent, hardness_pa, gap_w_m2k };
            let law = OwnContactLaw::rounded(&law, TICK_S);
            let _ = MantissaExponent::from_log2(law.power(Log2::from_bits(pressure)));
            let resistance = U16F16::from_bits(resistance);
            prop_assert!(law.with_gap(resistance) <= resistance.saturating_add(U16F16::DELTA));
        }
    }

    #[test]
    fn the_nominal_law_is_none_and_one_beside_it_has_its_resistance() {
        assert_eq!(OwnContactLaw::new(&ContactLaw::NOMINAL, TICK_S), None);
        let granite = find("granite").expect("granite");
        let pair = ContactPair::new(&SKIN, granite, &REFERENCE_DISPLAY, TICK_S).expect("a pair");
        let beside = OwnResistances {
            law: OwnContactLaw::new(
                &ContactLaw { exponent: 0.95 + 1e-8, ..ContactLaw::NOMINAL },
                TICK_S,
            ),
            ..OwnResistances::NONE
        };
        for force_n in [0.01, 0.1, 1.0, 10.0] {
            let pressure = log2_relative_pressure(Force::from_num(force_n));
            let of = |own: &OwnResistances| {
                let resistance = own.contact(&pair, pressure).expected_display_resistance(own);
                resistance.to_num::<f64>()
            };
            let relative = of(&beside) / of(&OwnResistances::NONE) - 1.0;
            assert!(relative.abs() < 2e-5, "{force_n} N: {relative}");
        }
    }
}
