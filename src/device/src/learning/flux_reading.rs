//! Readings of the heat-flux sensor.

use fixed::types::{I20F12, I28F4};
use thermal_learner::Flux;

use super::flux_parameters::FluxParameters;

/// Codes beyond which the amplifier is at a rail, as with a broken wire.
const CODES: core::ops::RangeInclusive<u16> = 64..=4031;
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
            is_faulty: true,
        }
    }

    /// The flux, W/m²; `None` for a code that cannot be right.
    pub fn convert(&mut self, code: u16) -> Option<Flux> {
        self.unchanged_ticks = if code == self.last_code {
            self.unchanged_ticks.saturating_add(1)
        } else {
            0
        };
        self.last_code = code;
        self.is_faulty = !CODES.contains(&code) || self.unchanged_ticks >= UNCHANGED_TICKS_MAX;
        self.last()
    }

    /// The last flux, W/m²; `None` before the first code, and if the last one cannot be right.
    #[must_use]
    pub fn last(&self) -> Option<Flux> {
        let above_zero = I28F4::from(self.last_code).saturating_sub(self.zero);
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
    fn codes_at_the_rails_and_one_that_stays_are_faults() {
        let mut reading = FluxReading::new(&FluxParameters::new(&FluxSensor::DESIGNED));
        for (code, is_valid) in [
            (63, false),
            (64, true),
            (4031, true),
            (4032, false),
            (u16::MAX, false),
        ] {
            assert_eq!(reading.convert(code).is_some(), is_valid, "{code}");
            assert_eq!(reading.is_faulty(), !is_valid, "{code}");
        }
        assert!(reading.convert(2048).is_some());
        for tick in 1..200 {
            assert_eq!(reading.convert(2048).is_some(), tick < 100, "{tick}");
        }
        assert!(reading.convert(2049).is_some());
    }
}
