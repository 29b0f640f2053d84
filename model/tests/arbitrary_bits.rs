//! No bit pattern of the inputs causes a panic or an overflow. Overflow checks are on in
//! `cargo test -p contact-model`, without `--release`.

use contact_model::fixed_point::{
    Celsius, ChordInterpolation, Contact, ContactPair, Force, Fraction, HalfSpace, Log2,
    MantissaExponent, Ratio, Ticks, erfcx, exp2, log2, log2_relative_pressure,
};
use contact_model::material::{Material, Surface};
use proptest::num::f64::ANY;
use proptest::prelude::*;

/// 32 bits, in which extreme values are as likely as others.
fn word() -> impl Strategy<Value = u32> {
    prop_oneof![
        any::<u32>(),
        (0u32..32, 0u32..3).prop_map(|(bit, below)| (1u32 << bit).wrapping_sub(below)),
        Just(0),
        Just(u32::MAX)
    ]
}

fn celsius() -> impl Strategy<Value = Celsius> {
    word().prop_map(|bits| Celsius::from_bits(bits.cast_signed()))
}

fn rate() -> impl Strategy<Value = MantissaExponent> {
    (word(), word()).prop_map(|(high, low)| {
        MantissaExponent::from_log2(Log2::from_bits(
            (i64::from(high) << 32 | i64::from(low)) >> (high % 32),
        ))
    })
}

fn contact() -> impl Strategy<Value = Contact> {
    (word(), word(), rate(), rate(), rate()).prop_map(
        |(weight, ratio, rate_per_tick, root_rate_per_tick, conductance_w_m2k)| Contact {
            weight: Fraction::from_bits(weight),
            ratio: Ratio::from_bits(ratio),
            rate_per_tick,
            root_rate_per_tick,
            conductance_w_m2k,
        },
    )
}

fn ticks() -> impl Strategy<Value = Ticks> {
    word().prop_map(|bits| Ticks::new(bits).unwrap_or(Ticks::MAX))
}

/// A property, in most cases valid.
fn property() -> impl Strategy<Value = f64> {
    prop_oneof![30 => 1e-3..1e3f64, 1 => ANY]
}

fn surface() -> impl Strategy<Value = Surface> {
    (property(), property(), property()).prop_map(|(conductivity_w_mk, roughness_um, slope_rad)| {
        Surface { conductivity_w_mk, roughness_um, slope_rad }
    })
}

fn material() -> impl Strategy<Value = Material> {
    (surface(), property(), property()).prop_map(|(surface, density_kg_m3, specific_heat_j_kgk)| {
        Material { surface, density_kg_m3, specific_heat_j_kgk }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4096, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn elementary_functions_accept_any_bits(a in word(), b in rate(), c in rate(), n in ticks(), times in any::<i16>()) {
        let _ = (exp2(a), erfcx(n, b), b.to_f64());
        prop_assert!(log2(a) >= -1 && log2(a) < 32);
        prop_assert!(log2_relative_pressure(Force::from_bits(a)).abs() < 64);
        let product = b.times(c).times_power_of_2(times);
        prop_assert!(product.exponent().unsigned_abs() <= 1 << 14);
    }

    #[test]
    fn response_accepts_any_bits_and_stays_between_the_temperatures(
        contact in contact(),
        elapsed in word(), skin in celsius(), object in celsius(),
    ) {
        let response = contact.at(elapsed, skin, object);
        // Skin and object lie between their initial temperatures; the flux is from warm to cold.
        let (low, high) = (skin.min(object), skin.max(object));
        for t in [response.skin(), response.object()] {
            prop_assert!(low <= t && t <= high);
        }
        let (display, flux) = (response.display(), response.flux_w_m2());
        prop_assert!((skin >= object && display <= skin && flux >= 0)
            || (skin <= object && display >= skin && flux <= 0));
    }

    #[test]
    fn chord_interpolation_accepts_any_bits_and_stays_within_255_c(
        contact in contact(),
        (skin, object, tolerance) in (celsius(), celsius(), celsius()),
        elapsed: u64,
    ) {
        let (mut chords, evaluations) = ChordInterpolation::new(&contact, skin, object, elapsed, tolerance);
        prop_assert!(evaluations <= 2);
        for _ in 0..100 {
            let setpoint = chords.advance();
            prop_assert_eq!(setpoint, chords.setpoint());
            prop_assert!(setpoint.abs() <= 255, "{}", setpoint);
        }
    }

    /// Through a resistance, a half-space stays between its initial temperature and its target.
    #[test]
    fn half_space_accepts_any_bits_and_stays_between_start_and_target(
        contact in contact(),
        fluxes in prop::collection::vec((celsius(), 1u32..300), 1..8), target in celsius(),
    ) {
        let (mut body, mut other) = (HalfSpace::default(), HalfSpace::default());
        for (flux, ticks) in fluxes {
            for _ in 0..ticks {
                body.step(flux);
                other.step(body.scaled_flux_to_match(&other));
            }
            for conductance in [contact.object_conductance(), contact.display_conductance()] {
                let limited = conductance.scaled_flux(flux, &body);
                prop_assert!(limited.abs() <= flux.saturating_sub(body.free_response()).saturating_abs());
                let _ = (conductance.temperature_drop(limited), body.response_to(limited), other.response_to(flux));
            }
            other = body.staggered();
        }
        let mut body = HalfSpace::default();
        let (low, high) = (target.min(Celsius::ZERO), target.max(Celsius::ZERO));
        let rounding = Celsius::DELTA * 64;
        for conductance in [contact.object_conductance(), contact.display_conductance()] {
            for _ in 0..100 {
                body.step(conductance.scaled_flux(target, &body));
                let response = body.free_response();
                prop_assert!(low.saturating_sub(rounding) <= response, "{response} of {target}");
                prop_assert!(response <= high.saturating_add(rounding), "{response} of {target}");
            }
        }
    }

    #[test]
    fn set_up_refuses_properties_or_gives_parameters_for_any_input(
        (skin, object, display) in (material(), material(), surface()), tick_s in property(),
        (high, low) in (word(), word()), (a, b) in (celsius(), celsius()), n in ticks(),
    ) {
        if let Ok(pair) = ContactPair::new(&skin, &object, &display, tick_s) {
            let pressure = Log2::from_bits(i64::from(high.cast_signed()) << 32 | i64::from(low));
            let response = pair.at_pressure(pressure).at(n.get(), a, b);
            let _ = (response.display(), response.flux_w_m2(), pair.preset(a, b), pair.interface_temperature(a, b));
        }
    }
}
