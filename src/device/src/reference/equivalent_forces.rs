//! How far a force may move until Eq. 6-12 is evaluated again.

use core::ops::RangeInclusive;

use contact_model::fixed_point::{Celsius, Force};

/// Largest change of the set-point, K, that a new mean force may cause before Eq. 6-12 is evaluated again for it.
const EQUIVALENT_FORCE_TOLERANCE: Celsius = Celsius::lit("0.0001");

/// Forces, N, around `force` for which the set-point stays within 0.1 mK ([`EQUIVALENT_FORCE_TOLERANCE`]), so that Eq.
/// 6-12 need not be evaluated again. `amplitude` is the factor of `E` in Eq. 6-12, K: by how much the set-point changes
/// during the whole contact.
///
/// R changes by 0.95 of the force's relative change (Eq. 6-8), `E` by at most 0.277 of R's, and the set-point by
/// `amplitude` times as much: 0.264 in all, rounded up to 17/64.
pub fn equivalent_forces(force: Force, amplitude: Celsius) -> RangeInclusive<Force> {
    // Relative change of the force in 2^-29, for an amplitude in 2^-14 K that is rounded up, so that one division of 32 bits
    // is enough.
    const RELATIVE_TOLERANCE: u32 = (((EQUIVALENT_FORCE_TOLERANCE.to_bits() as u64 * 64)
        << (29 - AMPLITUDE_SHIFT))
        / 17) as u32;
    const AMPLITUDE_SHIFT: u32 = 8;
    let amplitude = amplitude
        .to_bits()
        .unsigned_abs()
        .div_ceil(1 << AMPLITUDE_SHIFT);
    let allowed = RELATIVE_TOLERANCE
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
