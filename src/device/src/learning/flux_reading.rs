//! Readings of the heat-flux sensor.

use fixed::types::{I20F12, I28F4};
use thermal_learner::Flux;

use super::flux_parameters::FluxParameters;

/// Codes of sound wires. Beyond them the amplifier is at a rail: under more flux than its range, which copper takes from some
/// fingers in the first ticks, or with a broken wire.
const CODES: core::ops::RangeInclusive<u16> = 64..=4031;
/// Ticks at a rail after which the flux is not known well enough, or a wire is broken. A flux that was beyond the range for
/// so long is some per cent larger than what was read.
const AT_RAIL_TICKS_MAX: u8 = 50;
/// Ticks after which a code that has not changed is that of a converter which does not convert: noise alone changes it in
/// almost every tick.
const UNCHANGED_TICKS_MAX: u8 = 100;

/// Converts codes of the sensor to a flux, and finds codes that cannot be right.
#[derive(Clone, Debug)]
pub struct FluxReading {
    /// Code without flux.
    zero: I28F4,
    /// W/m² per count.
    w_m2_per_count: I20F12,
    last_code: u16,
    unchanged_ticks: u8,
    at_rail_ticks: u8,
    is_faulty: bool,
}

impl FluxReading {
    /// Readings of this sensor, none yet.
    #[must_use]
    pub const fn new(parameters: &FluxParameters) -> Self {
        Self {
            zero: parameters.zero,
            w_m2_per_count: parameters.w_m2_per_count,
            last_code: 0,
            unchanged_ticks: 0,
            at_rail_ticks: 0,
            is_faulty: true,
        }
    }

    /// The flux, W/m²; `None` for a code that cannot be right.
    pub fn convert(&mut self, code: u16) -> Option<Flux> {
        let counted = |count: u8, is_so| if is_so { count.saturating_add(1) } else { 0 };
        self.unchanged_ticks = counted(self.unchanged_ticks, code == self.last_code);
        self.at_rail_ticks = counted(self.at_rail_ticks, !CODES.contains(&code));
        self.last_code = code;
        self.is_faulty =
            self.at_rail_ticks >= AT_RAIL_TICKS_MAX || self.unchanged_ticks >= UNCHANGED_TICKS_MAX;
        self.last()
    }

    /// The last flux, W/m²; `None` before the first code, and if the last one cannot be right. A code at a rail counts as the
    /// nearest one of sound wires.
    #[must_use]
    pub fn last(&self) -> Option<Flux> {
        let code = self.last_code.clamp(*CODES.start(), *CODES.end());
        let above_zero = I28F4::from(code).saturating_sub(self.zero);
        let bits = i64::from(above_zero.to_bits()) * i64::from(self.w_m2_per_count.to_bits());
        // A code has 12 bits, so the flux is within ±2^16 counts of at most 2^19 W/m².
        let bits = (bits >> I28F4::FRAC_NBITS).clamp(i32::MIN.into(), i32::MAX.into());
        (!self.is_faulty).then_some(Flux::from_bits(bits as i32))
    }

    /// Whether the last code cannot be right, or there was none yet.
    #[must_use]
    pub const fn is_faulty(&self) -> bool {
        self.is_faulty
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use thermal_settings::FluxSensor;

    use super::*;

    proptest! {
        #[test]
        fn flux_is_the_code_less_the_zero_over_the_gain(
            code in CODES,
            zero in 1500.0..2500.0,
            gain in prop_oneof![Just(0.1192), 0.01..10.0],
        ) {
            let sensor = FluxSensor { counts_per_w_m2: gain, zero_counts: zero, ..FluxSensor::DESIGNED };
            let flux = FluxReading::new(&FluxParameters::new(&sensor)).convert(code).expect("a valid code");
            let exact = (f64::from(code) - zero) / gain;
            // Rounded are the zero, to a sixteenth of a count, and the reciprocal of the gain.
            let error = 0.5 / f64::from(1 << I28F4::FRAC_NBITS) / gain + exact.abs() * gain / 4096.0 + 1e-3;
            prop_assert!((flux.to_num::<f64>() - exact).abs() <= error, "{flux} for {exact}");
        }
    }

    #[test]
    fn codes_that_stay_at_a_rail_or_do_not_change_are_faults() {
        let mut reading = FluxReading::new(&FluxParameters::new(&FluxSensor::DESIGNED));
        let last_good = [64, 4031].map(|code| reading.convert(code));
        for (rail, expected) in [[0, 63], [4032, u16::MAX]].into_iter().zip(last_good) {
            for tick in 0..80 {
                let flux = reading.convert(rail[tick % 2]);
                assert_eq!(flux, expected.filter(|_| tick < 49), "{tick}");
                assert_eq!(reading.is_faulty(), flux.is_none());
            }
            assert!(reading.convert(2000).is_some());
        }
        assert!(reading.convert(2048).is_some());
        for tick in 1..200 {
            assert_eq!(reading.convert(2048).is_some(), tick < 100, "{tick}");
        }
        assert!(reading.convert(2049).is_some());
    }
}
