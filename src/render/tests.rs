//! Set-points against Eq. 6-12 in `f64`, for forces as they come: steady, with noise, in steps, drifting.

extern crate std;

use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};
use contact_model::pressure::pressure_pa;
use contact_model::reference::Contact;
use std::f64::consts::TAU;
use std::println;

use super::*;

const TICK_S: f64 = 1e-3;
const SKIN_C: f64 = 34.0;
const OBJECT_C: f64 = 24.0;
/// The largest noise that the force sensor shows, N.
const NOISE_N: f64 = 0.6e-3;

/// What a contact of some seconds has shown.
struct Seen {
    /// Largest error of the set-point, K, from the time on that was asked for.
    worst_k: f64,
    /// Largest change from tick to tick since then, K.
    step_k: f64,
    evaluations: u32,
}

/// Lets a finger rest on a material under `force_n(t_s)`, for `ticks`; judges from `from_s` on.
fn contact(material: usize, ticks: u32, from_s: f64, force_n: impl Fn(f64) -> f64) -> Seen {
    let object = &MATERIALS[material].1;
    let pairing = Pairing::new(&SKIN, object, &REFERENCE_DISPLAY, TICK_S).expect("pairing");
    let object_c = Celsius::from_num(OBJECT_C);
    let scene = Scene {
        pairing: &pairing,
        object: Some(object_c),
        mode: Mode::ContactResistance,
    };
    let mut render = Render::default();
    render.observe(Celsius::from_num(SKIN_C), object_c, None, 0);
    let (mut worst_k, mut step_k, mut before) = (0.0f64, 0.0f64, None);
    for tick in 0..ticks {
        let t_s = f64::from(tick) * TICK_S;
        let noise_n =
            NOISE_N * (f64::from(tick.wrapping_mul(2_654_435_761) >> 8) / 2f64.powi(23) - 1.0);
        let force = Force::from_num(force_n(t_s) + noise_n);
        render.observe(Celsius::from_num(SKIN_C), object_c, Some(force), 0);
        let wanted = render
            .present(&scene, Celsius::ZERO, false)
            .expect("observed");
        let setpoint_c = wanted.setpoint.to_num::<f64>();
        let finger = (&SKIN, SKIN_C);
        let exact = Contact::new(
            finger,
            (object, OBJECT_C),
            &REFERENCE_DISPLAY,
            pressure_pa(force_n(t_s)),
        );
        if t_s >= from_s {
            worst_k = worst_k.max((setpoint_c - exact.at(t_s).display_c).abs());
            step_k = step_k.max(before.map_or(0.0, |before: f64| (setpoint_c - before).abs()));
        }
        before = Some(setpoint_c);
    }
    Seen {
        worst_k,
        step_k,
        evaluations: render.evaluations(),
    }
}

/// From 0.1 s on: before, the mean has not seen enough of the noise.
#[test]
fn steady_force_is_within_half_a_millikelvin_in_at_most_100_evaluations() {
    for (material, (name, _)) in MATERIALS.iter().enumerate() {
        for force_n in [0.1, 0.25, 0.5, 1.0, 2.0] {
            let seen = contact(material, 10_000, 0.1, |_| force_n);
            println!(
                "{name} {force_n} N: {:.3} mK, {}",
                seen.worst_k * 1e3,
                seen.evaluations
            );
            assert!(
                seen.worst_k <= 0.5e-3,
                "{name}, {force_n} N: {} K",
                seen.worst_k
            );
            assert!(
                seen.evaluations <= 100,
                "{name}, {force_n} N: {}",
                seen.evaluations
            );
        }
    }
}

/// A step too small to be told from noise at once is followed as fast as the mean of the last ticks is.
#[test]
fn small_steps_are_followed_within_half_a_second() {
    const GRANITE: usize = 3;
    for step_s in [1.0, 17.0] {
        let after = |t_s: f64| if t_s < step_s { 2.0 } else { 1.9 };
        let ticks = (step_s / TICK_S) as u32 + 5000;
        let seen = contact(GRANITE, ticks, step_s + 0.4, after);
        println!("step at {step_s} s: {:.3} mK later", seen.worst_k * 1e3);
        assert!(seen.worst_k <= 1e-3, "{step_s} s: {} K", seen.worst_k);
    }
}

/// Ramps and waves: the set-point lags by half the recent mean, and takes small steps.
#[test]
fn changing_force_is_followed_without_jumps() {
    const GRANITE: usize = 3;
    let ramp = |length_s: f64| move |t_s: f64| 1.0 + ((t_s - 20.0) / length_s).clamp(0.0, 1.0);
    let wave = |t_s: f64| 1.5 * (1.0 + 0.05 * (TAU * 0.1 * t_s).sin());
    for (name, seen, allowed_k) in [
        (
            "ramp of 20 s",
            contact(GRANITE, 40_000, 19.0, ramp(20.0)),
            1.5e-3,
        ),
        (
            "ramp of 5 s",
            contact(GRANITE, 27_000, 19.0, ramp(5.0)),
            4e-3,
        ),
        ("wave of 0.1 Hz", contact(GRANITE, 30_000, 1.0, wave), 2e-3),
    ] {
        println!(
            "{name}: {:.3} mK, steps of {:.3} mK, {}",
            seen.worst_k * 1e3,
            seen.step_k * 1e3,
            seen.evaluations
        );
        assert!(seen.worst_k <= allowed_k, "{name}: {} K", seen.worst_k);
        assert!(seen.step_k <= 1e-3, "{name}: {} K", seen.step_k);
    }
}
