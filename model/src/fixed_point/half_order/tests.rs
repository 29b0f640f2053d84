//! Against the half-space's own solutions.

use proptest::prelude::*;

use super::*;
use crate::fixed_point::{Force, Pairing, log2_relative_pressure};
use crate::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};
use crate::pressure::pressure_pa;
use crate::reference;

const TICK_S: f64 = 1e-3;

/// A constant flux moves a half-space by `2 q sqrt(t / pi) / e`; after it ends, by the difference of two such.
#[test]
fn pulse_of_flux_moves_the_surface_as_a_half_space() {
    let exact = |ticks: f64| 2.0 * (ticks.max(0.0) / core::f64::consts::PI).sqrt();
    let mut body = HalfOrder::at_rest();
    for tick in 1..=60_000u32 {
        let after = body.after(Celsius::ONE).to_num::<f64>();
        body.step(Celsius::ONE);
        let error = after / exact(tick.into()) - 1.0;
        let allowed = match tick {
            1 => 0.05,
            2..10 => 0.012,
            _ => 0.004,
        };
        assert!(error.abs() < allowed, "tick {tick}: {error:e}");
    }
    for tick in 1..=60_000u32 {
        let left = body.left().to_num::<f64>();
        body.step(Celsius::ZERO);
        let now = f64::from(60_000 + tick);
        let error = left - (exact(now) - exact(f64::from(tick)));
        assert!(error.abs() < 0.006 * exact(60_000.0), "{tick} after: {error}");
    }
}

/// The skin on each material under each stated force, by Eq. 6-5.
#[test]
fn contact_follows_equation_6_5() {
    let (mut worst_k, mut early_k) = (0f64, 0f64);
    for (name, material) in MATERIALS {
        let pairing = Pairing::new(&SKIN, &material, &REFERENCE_DISPLAY, TICK_S).expect("a material");
        for (force_n, _) in crate::pressure::STATED {
            let contact = pairing.under(log2_relative_pressure(Force::from_num(force_n)));
            let exact = reference::Contact::<f64>::new(
                (&SKIN, 34.0),
                (&material, 24.0),
                &REFERENCE_DISPLAY,
                pressure_pa(force_n),
            );
            let weight = pairing.weight().to_num::<f64>();
            let (link, mut body) = (contact.on_object(), HalfOrder::at_rest());
            for tick in 1..=10_000u32 {
                let drive = link.drive(Celsius::from_num(weight * 10.0), &body);
                let skin_c = 34.0 - body.after(drive).to_num::<f64>();
                body.step(drive);
                let error_k = (skin_c - exact.at(f64::from(tick) * TICK_S).skin_c).abs();
                if tick >= 20 {
                    worst_k = worst_k.max(error_k);
                } else {
                    early_k = early_k.max(error_k);
                }
                assert!(error_k < 0.05, "{name}, {force_n} N, {tick} ms: {error_k} K");
            }
        }
    }
    std::println!(
        "skin within {:.1} mK in 20 ms, {:.1} mK then, of 10 K",
        early_k * 1e3,
        worst_k * 1e3
    );
    assert!(worst_k < 0.02, "{worst_k}");
}

proptest! {
    /// A body behind a resistance stays between where it was and what is in front of it.
    #[test]
    fn nothing_leaves_the_range_of_its_inputs(
        fronts in prop::collection::vec((-170i32..170, 1u32..500), 1..20),
        force in 0.001..20.0,
    ) {
        let pairing = Pairing::new(&SKIN, &MATERIALS[0].1, &REFERENCE_DISPLAY, TICK_S).expect("copper");
        let contact = pairing.under(log2_relative_pressure(Force::from_num(force)));
        let link = contact.on_display();
        let mut body = HalfOrder::at_rest();
        let (mut low, mut high) = (0i32, 0i32);
        for (front, ticks) in fronts {
            (low, high) = (low.min(front), high.max(front));
            for _ in 0..ticks {
                let drive = link.drive(Celsius::from_num(front), &body);
                body.step(drive);
                let at = body.left();
                prop_assert!(at >= Celsius::from_num(low) - Celsius::DELTA * 64 && at <= Celsius::from_num(high) + Celsius::DELTA * 64);
            }
        }
    }

    #[test]
    fn no_drive_overflows(drives in prop::collection::vec(any::<i32>(), 1..50)) {
        let mut body = HalfOrder::at_rest();
        for bits in drives {
            for _ in 0..200 {
                body.step(Celsius::from_bits(bits));
            }
        }
    }
}
