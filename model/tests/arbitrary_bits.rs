//! Nothing panics or overflows for any bits whatever: run with overflow checks, `cargo test -p contact-model`.

use contact_model::fixed_point::{
    Celsius, ChordInterpolation, Contact, ContactPair, Depth, ErfArgument, Flux, Force, Fraction,
    HalfSpace, Log2, MantissaExponent, Ratio, SemiInfinite, Ticks, erf, erfcx, exp2,
    fourier_number, log2, log2_relative_pressure,
};
use contact_model::material::{Material, Surface};
use proptest::num::f64::ANY;
use proptest::prelude::*;

/// Bits of which the extreme ones are as likely as the others.
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

/// Mostly what set-up accepts.
fn property() -> impl Strategy<Value = f64> {
    prop_oneof![30 => 1e-3..1e3f64, 1 => ANY]
}

fn surface() -> impl Strategy<Value = Surface> {
    (property(), property(), property()).prop_map(|(conductivity_w_mk, roughness_um, slope_rad)| {
        Surface {
            conductivity_w_mk,
            roughness_um,
            slope_rad,
        }
    })
}

fn material() -> impl Strategy<Value = Material> {
    (surface(), property(), property()).prop_map(|(surface, density_kg_m3, specific_heat_j_kgk)| {
        Material {
            surface,
            density_kg_m3,
            specific_heat_j_kgk,
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4096, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn functions_of_numbers_are_total(a in word(), b in rate(), c in rate(), n in ticks(), times in any::<i16>()) {
        let _ = (exp2(a), erfcx(n, b), fourier_number(b, n), b.to_f64());
        prop_assert!(log2(a) >= -1 && log2(a) < 32);
        prop_assert!(log2_relative_pressure(Force::from_bits(a)).abs() < 64);
        let product = b.times(c).times_power_of_2(times);
        prop_assert!(product.exponent().unsigned_abs() <= 1 << 14);
        // Anything beyond 4.5 has the same error function, and nothing has a larger one.
        prop_assert!(erf(ErfArgument::from_bits(a)) <= erf(ErfArgument::MAX));
    }

    #[test]
    fn response_is_total_and_saturates(
        contact in contact(),
        elapsed in word(), skin in celsius(), object in celsius(),
    ) {
        let at = contact.at(elapsed, skin, object);
        // Between the temperatures before, the display on the side that its ratio says, the flux downhill.
        let (low, high) = (skin.min(object), skin.max(object));
        for t in [at.skin(), at.object()] {
            prop_assert!(low <= t && t <= high);
        }
        let (display, flux) = (at.display(), at.flux_w_m2());
        prop_assert!((skin >= object && display <= skin && flux >= 0)
            || (skin <= object && display >= skin && flux <= 0));
    }

    /// Whatever the contact, a course neither panics nor leaves ±255 °C.
    #[test]
    fn course_is_total(
        contact in contact(),
        (skin, object, tolerance) in (celsius(), celsius(), celsius()),
        elapsed: u64,
    ) {
        let (mut course, evaluations) = ChordInterpolation::new(&contact, skin, object, elapsed, tolerance);
        prop_assert!(evaluations <= 2);
        for _ in 0..100 {
            let setpoint = course.advance();
            prop_assert_eq!(setpoint, course.setpoint());
            prop_assert!(setpoint.abs() <= 255, "{}", setpoint);
        }
    }

    /// Whatever the contact and whatever flows, no half-space panics; what flows on through a resistance heats or
    /// cools no body beyond what is in front of it and what it was.
    #[test]
    fn half_space_is_total(
        contact in contact(),
        drives in prop::collection::vec((celsius(), 1u32..300), 1..8), front in celsius(),
    ) {
        let (mut body, mut other) = (HalfSpace::default(), HalfSpace::default());
        for (drive, ticks) in drives {
            for _ in 0..ticks {
                body.step(drive);
                other.step(body.scaled_flux_to_match(&other));
            }
            for link in [contact.object_conductance(), contact.display_conductance()] {
                let flow = link.scaled_flux(drive, &body);
                prop_assert!(flow.abs() <= drive.saturating_sub(body.free_response()).saturating_abs());
                let _ = (link.temperature_drop(flow), body.response_to(flow), other.response_to(drive));
            }
            other = body.staggered();
        }
        let mut body = HalfSpace::default();
        let (low, high) = (front.min(Celsius::ZERO), front.max(Celsius::ZERO));
        let rounding = Celsius::DELTA * 64;
        for link in [contact.object_conductance(), contact.display_conductance()] {
            for _ in 0..100 {
                body.step(link.scaled_flux(front, &body));
                let at = body.free_response();
                prop_assert!(low.saturating_sub(rounding) <= at && at <= high.saturating_add(rounding), "{at} of {front}");
            }
        }
    }

    #[test]
    fn set_up_refuses_or_is_total(
        (skin, object, display) in (material(), material(), surface()), tick_s in property(),
        (high, low) in (word(), word()), (a, b) in (celsius(), celsius()), depth in word(), n in ticks(),
    ) {
        if let Ok(pairing) = ContactPair::new(&skin, &object, &display, tick_s) {
            let pressure = Log2::from_bits(i64::from(high.cast_signed()) << 32 | i64::from(low));
            let at = pairing.at_pressure(pressure).at(n.get(), a, b);
            let _ = (at.display(), at.flux_w_m2(), pairing.preset(a, b), pairing.interface_temperature(a, b));
        }
        if let Ok(perfect) = SemiInfinite::new(&skin, &object, tick_s) {
            let t = perfect.skin_at_depth(Depth::from_bits(depth), n, a, b);
            prop_assert!(a.min(b) <= t && t <= a.max(b));
            prop_assert!(perfect.flux_w_m2(n, a, b).abs() <= Flux::MAX);
        }
    }
}
