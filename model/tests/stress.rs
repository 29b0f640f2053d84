//! The contact model at its limits and against laws that hold for any contact, in `f64`, `f32` and integers.

use contact_model::fixed_point::{Celsius, Contact as Fixed, ContactPair, Flux, Log2, Ticks};
use contact_model::material::{
    MATERIALS, Material, REFERENCE_DISPLAY, SKIN, SKIN_MICROHARDNESS_PA, Surface,
};
use contact_model::reference::{Contact, Real, interface_temperature};
use proptest::prelude::*;

/// What the integers may be off, K.
const FIXED_K: f64 = 2e-6;
/// What the integer flux may be off as a part of `dT / R`.
const FIXED_FLUX_PART: f64 = 4e-9;
/// What `f32` may be off as a part of the temperatures: some roundings.
const F32_PART: f64 = 2e-6;

/// Pressures from a touch far below the thesis's to a press far above.
const PRESSURES_PA: std::ops::Range<f64> = 10.0..1e5;

fn contact<F: Real>(skin_c: f64, object: &Material, object_c: f64, pressure_pa: f64) -> Contact<F> {
    let f = F::from_f64;
    Contact::new(
        (&SKIN, f(skin_c)),
        (object, f(object_c)),
        &REFERENCE_DISPLAY,
        f(pressure_pa),
    )
}

/// One tick of `tick_s`.
fn fixed(skin: &Material, object: &Material, pressure_pa: f64, tick_s: f64) -> Fixed {
    ContactPair::new(skin, object, &REFERENCE_DISPLAY, tick_s)
        .expect("within the domain")
        .at_pressure(Log2::saturating_from_num(
            (pressure_pa / SKIN_MICROHARDNESS_PA).log2(),
        ))
}

fn celsius(t_c: f64) -> Celsius {
    Celsius::from_num(t_c)
}

/// Any solid between foam and copper, and rougher or smoother than both.
fn any_material() -> impl Strategy<Value = Material> {
    (
        0.02..400.0f64,
        20.0..9000.0f64,
        300.0..4000.0f64,
        0.05..20.0f64,
        0.01..0.4f64,
    )
        .prop_map(
            |(conductivity_w_mk, density_kg_m3, specific_heat_j_kgk, roughness_um, slope_rad)| {
                Material {
                    surface: Surface {
                        conductivity_w_mk,
                        roughness_um,
                        slope_rad,
                    },
                    density_kg_m3,
                    specific_heat_j_kgk,
                }
            },
        )
}

/// Surface temperature change of a half-space of effusivity `e` from which `flux` is drawn, by Duhamel's integral
/// `1 / (e sqrt(pi)) * integral of q(s) / sqrt(t - s) ds`; with `s = t cos²θ` that is `2 sqrt(t) cosθ dθ`, and
/// smooth.
fn duhamel(e: f64, t_s: f64, flux: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 20_000;
    let h = std::f64::consts::FRAC_PI_2 / f64::from(STEPS);
    let sum: f64 = (0..=STEPS)
        .map(|i| {
            let cos = (h * f64::from(i)).cos();
            let simpson = if i == 0 || i == STEPS {
                1.0
            } else {
                f64::from(2 + 2 * (i % 2))
            };
            simpson * flux(t_s * cos * cos) * cos
        })
        .sum();
    2.0 * t_s.sqrt() / (e * std::f64::consts::PI.sqrt()) * sum * h / 3.0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The flux, integrated, gives back both surface temperatures: energy is neither lost nor made.
    #[test]
    fn flux_integrates_to_the_surface_temperatures(
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

    /// The same for the integers.
    #[test]
    fn integer_flux_integrates_to_the_integer_temperatures(
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

    /// What the object is to the skin, the skin is to the object.
    #[test]
    fn exchange_of_skin_and_object_mirrors_everything(
        object in any_material(),
        skin_c in -40.0..125.0f64,
        object_c in -40.0..125.0f64,
        pressure_pa in PRESSURES_PA,
        t_s in 1e-4..100.0f64,
    ) {
        let here = fixed(&SKIN, &object, pressure_pa, t_s).at(1, celsius(skin_c), celsius(object_c));
        let there = fixed(&object, &SKIN, pressure_pa, t_s).at(1, celsius(object_c), celsius(skin_c));
        let same = |a: Celsius, b: Celsius| (a.to_num::<f64>() - b.to_num::<f64>()).abs() < FIXED_K;
        prop_assert!(same(here.skin(), there.object()), "{} {}", here.skin(), there.object());
        prop_assert!(same(here.object(), there.skin()), "{} {}", here.object(), there.skin());
        let (out, back) = (here.flux_w_m2().to_num::<f64>(), there.flux_w_m2().to_num::<f64>());
        let contact = contact::<f64>(skin_c, &object, object_c, pressure_pa);
        // The temperatures are rounded, and so is the flux.
        let step_k = (skin_c - object_c).abs() * FIXED_FLUX_PART + 2.0 * Celsius::DELTA.to_num::<f64>();
        let bound = 2.0 * (step_k / contact.resistance_m2k_w + Flux::DELTA.to_num::<f64>());
        prop_assert!((out + back).abs() <= bound, "{out} {back} {bound}");
    }

    /// Two of a kind share the difference.
    #[test]
    fn equal_effusivities_meet_in_the_middle(
        skin_c in -40.0..125.0f64,
        object_c in -40.0..125.0f64,
        pressure_pa in PRESSURES_PA,
        t_s in 1e-4..1e4f64,
    ) {
        let at = fixed(&SKIN, &SKIN, pressure_pa, t_s).at(1, celsius(skin_c), celsius(object_c));
        let sum = at.skin().to_num::<f64>() + at.object().to_num::<f64>();
        prop_assert!((sum - skin_c - object_c).abs() < 2.0 * FIXED_K, "{sum}");
    }

    /// Nothing happens between equals, at any time and force: exactly.
    #[test]
    fn equal_temperatures_stay_as_they_are(
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

    /// Integers, single and double precision tell the same story.
    #[test]
    fn the_three_paths_agree(
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
        // The set-point is on the scale of r times the step.
        let ratio = contact::<f64>(skin_c, &object, object_c, pressure_pa).ratio;
        let scale = 125.0 + 60.0 + ratio * (skin_c - object_c).abs();
        let step_k = (skin_c - object_c).abs().max(60.0) / 60.0 * ratio.max(1.0);
        for (exact, single, integer) in [
            (exact.skin_c, single.skin_c, integer.skin()),
            (exact.object_c, single.object_c, integer.object()),
            (exact.display_c, single.display_c, integer.display()),
        ] {
            prop_assert!((f64::from(single) - exact).abs() < F32_PART * scale, "{single} {exact}");
            // Beyond the range of the type it saturates.
            if exact.abs() < 500.0 {
                prop_assert!((integer.to_num::<f64>() - exact).abs() < FIXED_K * step_k, "{integer} {exact}");
            }
        }
    }
}

/// After ages Eq. 3-1 holds.
#[test]
fn time_runs_to_equation_3_1() {
    for (name, object) in &MATERIALS {
        for (skin_c, object_c) in [(34.0, 24.0), (28.0, 60.0), (-40.0, 125.0), (36.0, -24.0)] {
            let exact = contact::<f64>(skin_c, object, object_c, 10_980.0);
            // So long that 1 / (z sqrt(pi)) of the step is below a microkelvin.
            let t_s = 1e16 / exact.rate_per_s;
            let ages =
                fixed(&SKIN, object, 10_980.0, t_s).at(1, celsius(skin_c), celsius(object_c));
            let meeting_c = interface_temperature(&SKIN, skin_c, object, object_c);
            for t in [ages.skin(), ages.object(), ages.display()] {
                let error_k = t.to_num::<f64>() - meeting_c;
                assert!(error_k.abs() < FIXED_K, "{name}: {t} {meeting_c}");
            }
        }
    }
}

/// Every hour of 24 days at 1 kHz: the count of ticks times the rate is exact, nothing accumulates.
#[test]
fn days_of_contact_do_not_drift() {
    for (name, object) in &MATERIALS {
        let exact = contact::<f64>(34.0, object, 24.0, 10_980.0);
        let integer = fixed(&SKIN, object, 10_980.0, 1e-3);
        for hour in 1..=Ticks::MAX.get() / 3_600_000 {
            let ticks = hour * 3_600_000;
            let wanted = exact.at(f64::from(ticks) * 1e-3).display_c;
            let got: f64 = integer
                .at(ticks, celsius(34.0), celsius(24.0))
                .display()
                .to_num();
            assert!(
                (got - wanted).abs() < FIXED_K,
                "{name}, hour {hour}: {got} {wanted}"
            );
        }
    }
}
