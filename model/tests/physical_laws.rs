//! Physical laws that hold for every contact, checked in `f64`, `f32` and fixed point.

use contact_model::fixed_point::{Celsius, Contact as Fixed, ContactPair, Flux, Log2, Ticks};
use contact_model::material::{
    MATERIALS, Material, REFERENCE_DISPLAY, SKIN, SKIN_MICROHARDNESS_PA, Surface,
};
use contact_model::reference::{Contact, Real, interface_temperature};
use proptest::prelude::*;

/// Largest error of temperatures in fixed point, K.
const FIXED_K: f64 = 2e-6;
/// Largest error of the flux in fixed point, as a fraction of `dT / R`.
const FIXED_FLUX: f64 = 4e-9;
/// Largest error of `f32`, as a fraction of the temperatures.
const F32_RELATIVE: f64 = 2e-6;

/// From far below the pressures of the thesis to far above.
const PRESSURES_PA: std::ops::Range<f64> = 10.0..1e5;

fn contact<F: Real>(skin_c: f64, object: &Material, object_c: f64, pressure_pa: f64) -> Contact<F> {
    let f = F::from_f64;
    Contact::new((&SKIN, f(skin_c)), (object, f(object_c)), &REFERENCE_DISPLAY, f(pressure_pa))
}

fn fixed(skin: &Material, object: &Material, pressure_pa: f64, tick_s: f64) -> Fixed {
    ContactPair::new(skin, object, &REFERENCE_DISPLAY, tick_s)
        .expect("within the domain")
        .at_pressure(Log2::saturating_from_num((pressure_pa / SKIN_MICROHARDNESS_PA).log2()))
}

fn celsius(t_c: f64) -> Celsius {
    Celsius::from_num(t_c)
}

/// Solids between foam and copper, with a wider range of surface finishes.
fn any_material() -> impl Strategy<Value = Material> {
    (0.02..400.0f64, 20.0..9000.0f64, 300.0..4000.0f64, 0.05..20.0f64, 0.01..0.4f64).prop_map(
        |(conductivity_w_mk, density_kg_m3, specific_heat_j_kgk, roughness_um, slope_rad)| {
            Material {
                surface: Surface { conductivity_w_mk, roughness_um, slope_rad },
                density_kg_m3,
                specific_heat_j_kgk,
            }
        },
    )
}

/// Change of the surface temperature of a half-space of effusivity `e` that loses `flux`, by Duhamel's integral
/// `1 / (e sqrt(pi)) * integral of q(s) / sqrt(t - s) ds`; the substitution `s = t cos²θ` gives the
/// smooth integrand `2 sqrt(t) q cosθ`.
fn duhamel(e: f64, t_s: f64, flux: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 20_000;
    let h = std::f64::consts::FRAC_PI_2 / f64::from(STEPS);
    let sum: f64 = (0..=STEPS)
        .map(|i| {
            let cos = (h * f64::from(i)).cos();
            let simpson = if i == 0 || i == STEPS { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
            simpson * flux(t_s * cos * cos) * cos
        })
        .sum();
    2.0 * t_s.sqrt() / (e * std::f64::consts::PI.sqrt()) * sum * h / 3.0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn energy_is_conserved_the_integrated_flux_gives_both_surface_temperatures(
        object in any_material(),
        skin_c in 15.0..42.0f64,
        object_c in -40.0..125.0f64,
        pressure_pa in PRESSURES_PA,
        z in 0.01..30.0f64,
    ) {
        let contact = contact::<f64>(skin_c, &object, object_c, pressure_pa);
        let t_s = z * z / contact.rate_per_s;
        let at = contact.at(t_s);
        let drop = duhamel(SKIN.effusivity(), t_s, |s| contact.at(s).flux_w_m2);
        let rise = duhamel(object.effusivity(), t_s, |s| contact.at(s).flux_w_m2);
        let bound = 1e-10 * (1.0 + (skin_c - object_c).abs());
        prop_assert!((skin_c - at.skin_c - drop).abs() < bound, "{} {drop}", skin_c - at.skin_c);
        prop_assert!((at.object_c - object_c - rise).abs() < bound, "{} {rise}", at.object_c - object_c);
    }

    #[test]
    fn energy_is_conserved_in_fixed_point(
        index in 0..MATERIALS.len(),
        skin_c in 28.0..36.0f64,
        object_c in 0.0..60.0f64,
        pressure_pa in PRESSURES_PA,
        t_s in 0.01..10.0f64,
    ) {
        const TICKS: u32 = 1 << 30;
        let object = &MATERIALS[index].1;
        let (skin, start) = (celsius(skin_c), celsius(object_c));
        let contact = fixed(&SKIN, object, pressure_pa, t_s / f64::from(TICKS));
        let at = |s: f64| contact.at((s / t_s * f64::from(TICKS)).round() as u32, skin, start);
        let drop = duhamel(SKIN.effusivity(), t_s, |s| at(s).flux_w_m2().to_num());
        let error = skin_c - at(t_s).skin().to_num::<f64>() - drop;
        prop_assert!(error.abs() < 4.0 * FIXED_K, "{error}");
    }

    #[test]
    fn exchange_of_skin_and_object_exchanges_temperatures_and_reverses_the_flux(
        object in any_material(),
        skin_c in -40.0..125.0f64,
        object_c in -40.0..125.0f64,
        pressure_pa in PRESSURES_PA,
        t_s in 1e-4..100.0f64,
    ) {
        let original = fixed(&SKIN, &object, pressure_pa, t_s).at(1, celsius(skin_c), celsius(object_c));
        let exchanged = fixed(&object, &SKIN, pressure_pa, t_s).at(1, celsius(object_c), celsius(skin_c));
        let same = |a: Celsius, b: Celsius| (a.to_num::<f64>() - b.to_num::<f64>()).abs() < FIXED_K;
        prop_assert!(same(original.skin(), exchanged.object()), "{} {}", original.skin(), exchanged.object());
        prop_assert!(same(original.object(), exchanged.skin()), "{} {}", original.object(), exchanged.skin());
        let (out, back) = (original.flux_w_m2().to_num::<f64>(), exchanged.flux_w_m2().to_num::<f64>());
        let contact = contact::<f64>(skin_c, &object, object_c, pressure_pa);
        // The temperatures are rounded, and so is the flux.
        let bound_k = (skin_c - object_c).abs() * FIXED_FLUX + 2.0 * Celsius::DELTA.to_num::<f64>();
        let bound = 2.0 * (bound_k / contact.resistance_m2k_w + Flux::DELTA.to_num::<f64>());
        prop_assert!((out + back).abs() <= bound, "{out} {back} {bound}");
    }

    #[test]
    fn equal_effusivities_keep_the_mean_temperature(
        skin_c in -40.0..125.0f64,
        object_c in -40.0..125.0f64,
        pressure_pa in PRESSURES_PA,
        t_s in 1e-4..1e4f64,
    ) {
        let at = fixed(&SKIN, &SKIN, pressure_pa, t_s).at(1, celsius(skin_c), celsius(object_c));
        let sum = at.skin().to_num::<f64>() + at.object().to_num::<f64>();
        prop_assert!((sum - skin_c - object_c).abs() < 2.0 * FIXED_K, "{sum}");
    }

    #[test]
    fn equal_temperatures_stay_exactly_constant_without_flux(
        object in any_material(),
        bits in -(40 << 22)..125i32 << 22,
        pressure_pa in PRESSURES_PA,
        elapsed: u32,
    ) {
        let t = Celsius::from_bits(bits);
        let at = fixed(&SKIN, &object, pressure_pa, 1e-3).at(elapsed, t, t);
        prop_assert_eq!([at.skin(), at.object(), at.display()], [t; 3]);
        prop_assert_eq!(at.flux_w_m2(), 0);
    }

    #[test]
    fn fixed_point_single_and_double_precision_agree(
        object in any_material(),
        skin_c in -40.0..125.0f64,
        object_c in -40.0..125.0f64,
        pressure_pa in PRESSURES_PA,
        log_t_s in -4.0..6.0f64,
    ) {
        let t_s = 10f64.powf(log_t_s);
        let exact = contact::<f64>(skin_c, &object, object_c, pressure_pa).at(t_s);
        let single = contact::<f32>(skin_c, &object, object_c, pressure_pa).at(t_s as f32);
        let integer = fixed(&SKIN, &object, pressure_pa, t_s).at(1, celsius(skin_c), celsius(object_c));
        // The set-point scales with r times the temperature difference.
        let ratio = contact::<f64>(skin_c, &object, object_c, pressure_pa).ratio;
        let scale = 125.0 + 60.0 + ratio * (skin_c - object_c).abs();
        let bound_k = (skin_c - object_c).abs().max(60.0) / 60.0 * ratio.max(1.0);
        for (exact, single, integer) in [
            (exact.skin_c, single.skin_c, integer.skin()),
            (exact.object_c, single.object_c, integer.object()),
            (exact.display_c, single.display_c, integer.display()),
        ] {
            prop_assert!((f64::from(single) - exact).abs() < F32_RELATIVE * scale, "{single} {exact}");
            // Beyond the range of the type the fixed-point path saturates.
            if exact.abs() < 500.0 {
                prop_assert!((integer.to_num::<f64>() - exact).abs() < FIXED_K * bound_k, "{integer} {exact}");
            }
        }
    }
}

#[test]
fn temperatures_approach_equation_3_1_after_a_long_time() {
    for (name, object) in &MATERIALS {
        for (skin_c, object_c) in [(34.0, 24.0), (28.0, 60.0), (-40.0, 125.0), (36.0, -24.0)] {
            let exact = contact::<f64>(skin_c, object, object_c, 10_980.0);
            // So long that 1 / (z sqrt(pi)) of the temperature difference is below a microkelvin.
            let t_s = 1e16 / exact.rate_per_s;
            let late =
                fixed(&SKIN, object, 10_980.0, t_s).at(1, celsius(skin_c), celsius(object_c));
            let interface_c = interface_temperature(&SKIN, skin_c, object, object_c);
            for t in [late.skin(), late.object(), late.display()] {
                let error_k = t.to_num::<f64>() - interface_c;
                assert!(error_k.abs() < FIXED_K, "{name}: {t} {interface_c}");
            }
        }
    }
}

/// Every hour of 24 days at 1 kHz. The product of tick count and rate is exact, so no error accumulates.
#[test]
fn error_does_not_grow_over_days_of_contact() {
    for (name, object) in &MATERIALS {
        let exact = contact::<f64>(34.0, object, 24.0, 10_980.0);
        let integer = fixed(&SKIN, object, 10_980.0, 1e-3);
        for hour in 1..=Ticks::MAX.get() / 3_600_000 {
            let ticks = hour * 3_600_000;
            let expected = exact.at(f64::from(ticks) * 1e-3).display_c;
            let display_c: f64 = integer.at(ticks, celsius(34.0), celsius(24.0)).display().to_num();
            assert!(
                (display_c - expected).abs() < FIXED_K,
                "{name}, hour {hour}: {display_c} {expected}"
            );
        }
    }
}
