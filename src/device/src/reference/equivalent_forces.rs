//! The range in which a force may change until Eq. 6-12 is evaluated again.

use core::ops::RangeInclusive;

use contact_model::fixed_point::{Celsius, Force};

/// Largest difference of the set-points of two forces, K, up to which they count as equivalent: 0.1 mK. Eq. 6-12 is
/// evaluated again only for a mean force that changes the set-point by more.
const EQUIVALENT_SETPOINT_TOLERANCE: Celsius = Celsius::lit("0.0001");

/// Forces, N, for which the set-point is within 0.1 mK of that for `force`, N, so that Eq. 6-12 need not be evaluated
/// again. `amplitude`, K, is by how much the set-point changes during the whole contact. In Eq. 6-12 it is the factor
/// of `E`, a function of time and contact resistance that falls from 1 to 0.
///
/// A relative change of the force changes the contact resistance by 0.95 times as much (Eq. 6-8), which changes `E` by
/// at most 0.277 times the relative change of the resistance. So the set-point changes by at most `amplitude` times
/// 0.264 times the relative change of the force; 0.264 is rounded up to 17/64.
pub fn equivalent_forces(force: Force, amplitude: Celsius) -> RangeInclusive<Force> {
    // Allowed relative change of the force, in 2^-29, times the amplitude in 2^-14 K, which is rounded up. In these
    // units one division of 32 bits is enough.
    const RELATIVE_FORCE_CHANGE_TIMES_AMPLITUDE: u32 =
        (((EQUIVALENT_SETPOINT_TOLERANCE.to_bits() as u64 * 64) << (29 - AMPLITUDE_SHIFT)) / 17)
            as u32;
    const AMPLITUDE_SHIFT: u32 = 8;
    let amplitude = amplitude.to_bits().unsigned_abs().div_ceil(1 << AMPLITUDE_SHIFT);
    let allowed = RELATIVE_FORCE_CHANGE_TIMES_AMPLITUDE
        .checked_div(amplitude)
        .and_then(|relative| {
            u32::try_from((u64::from(force.to_bits()) * u64::from(relative)) >> 29).ok()
        })
        .map_or(Force::MAX, Force::from_bits);
    force.saturating_sub(allowed)..=force.saturating_add(allowed)
}

#[cfg(test)]
mod tests {
    use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};
    use contact_model::pressure;
    use contact_model::reference::Contact;

    use super::*;

    /// By Eq. 6-12 in `f64`: the smallest change that matters moves the set-point by 0.1 mK, at the worst time.
    #[test]
    fn equivalent_forces_change_the_set_point_by_a_tenth_of_a_millikelvin() {
        for (name, material) in MATERIALS {
            for force_n in [0.1, 0.5, 2.0] {
                let contact = |force_n| {
                    let pressure_pa = pressure::pressure_pa(2.0) * force_n / 2.0;
                    Contact::<f64>::new(
                        (&SKIN, 34.0),
                        (&material, 24.0),
                        &REFERENCE_DISPLAY,
                        pressure_pa,
                    )
                };
                let gain = Celsius::from_num(10.0 * (contact(1.0).weight - contact(1.0).ratio));
                let before = Force::from_num(force_n);
                let same = equivalent_forces(before, gain.abs());
                let relative = (1..4000).find(|&i| {
                    let now = Force::from_num(force_n * (1.0 + f64::from(i) / 65536.0));
                    !same.contains(&now)
                });
                let relative = f64::from(relative.expect("some change matters")) / 65536.0;
                let (old, new) = (contact(force_n), contact(force_n * (1.0 + relative)));
                let moved_k = (-200..200)
                    .map(|i| (f64::from(i) / 10.0).exp2())
                    .map(|t_s| (old.at(t_s).display_c - new.at(t_s).display_c).abs())
                    .fold(0.0, f64::max);
                // The grid of changes is 0.25 K per 65536.
                let grid_k = gain.abs().to_num::<f64>() / 65536.0;
                assert!(
                    moved_k < 0.1e-3 + grid_k && moved_k > 0.09e-3,
                    "{name}, {force_n} N: {moved_k} K"
                );
            }
        }
    }
}
