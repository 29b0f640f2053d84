//! Lead of the target over the set-point, by which the law `model` follows a set-point that rises or falls steadily.
//!
//! The law chooses the current that reaches the present target in 12 ms, so on a ramp the plate stays 12 ms behind. The error of
//! the plate model under the finger adds up to 9 ms (measured on 0.5 mm of ZnS). The set-points of thin plates change by 2 to
//! 12 K/s (27 K/s for 0.1 mm of copper on foam). Of the leads tried, 12, 20, 24 and 30 ms, 24 ms was the best for the 234
//! objects of scenario `E` (`docs/fidelity.md`).

use contact_model::fixed_point::Celsius;

/// Time constant of the low-pass filter behind which the slope is measured: 2^6 = 64 ticks of 1 ms. A shorter one lets noise
/// of the force through to the current; with a longer one the lead comes late after a landing.
const TIME_CONSTANT_TICKS_LOG2: u32 = 6;

/// Ahead of a set-point by its slope times 24 ticks, once it has had this slope for longer than the filter's 64 ticks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SetpointLead {
    /// The set-point behind the filter, °C; `None` before the first one, which has no lead.
    filtered: Option<Celsius>,
}

impl SetpointLead {
    /// The lead, K, to be added to the target of a tick with this `setpoint`, °C.
    pub fn next_lead(&mut self, setpoint: Celsius) -> Celsius {
        let filtered = self.filtered.get_or_insert(setpoint);
        // On a ramp the filter is 64 ticks behind, of which 3/8 are 24.
        let behind = setpoint.saturating_sub(*filtered);
        *filtered = filtered.saturating_add(behind >> TIME_CONSTANT_TICKS_LOG2);
        (behind >> 2u32).saturating_add(behind >> 3u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slope of the ramps, K per tick: 5 K/s.
    const SLOPE_K: f64 = 0.005;

    fn leads(setpoints_c: impl IntoIterator<Item = f64>) -> impl Iterator<Item = f64> {
        let mut lead = SetpointLead::default();
        (setpoints_c.into_iter())
            .map(move |setpoint_c| lead.next_lead(Celsius::from_num(setpoint_c)).to_num())
    }

    /// A first-order lag of 64 ms is behind a ramp by `slope 64 ms (1 - e^(-t / 64 ms))`.
    #[test]
    fn a_ramp_is_led_by_24_ticks_with_a_lag_of_64() {
        for slope_k in [SLOPE_K, -SLOPE_K] {
            let ramp = (0..1000).map(|tick| 20.0 + slope_k * f64::from(tick));
            for (tick, lead_k) in (0..).zip(leads(ramp)) {
                let exact_k = 24.0 * slope_k * (1.0 - libm::exp(-f64::from(tick) / 64.0));
                let error_k = (lead_k - exact_k).abs();
                assert!(error_k < 0.01 * 24.0 * SLOPE_K, "{tick}: {lead_k}, {exact_k}");
            }
        }
    }

    #[test]
    fn a_constant_setpoint_and_the_first_one_have_no_lead() {
        assert!(leads([31.0; 500]).all(|lead_k| lead_k == 0.0));
        assert_eq!(leads([15.0, 16.0]).next(), Some(0.0));
    }

    /// Noise of the set-point reaches the target 1 + 3/8 times as large, no more.
    #[test]
    fn noise_is_amplified_by_three_eighths() {
        let noise = (0..1000).map(|tick| 30.0 + if tick % 2 == 0 { 0.001 } else { -0.001 });
        let largest_k = leads(noise).skip(500).fold(0.0, |a: f64, b| a.max(b.abs()));
        assert!((0.000_37..0.000_38).contains(&largest_k), "{largest_k}");
    }
}
