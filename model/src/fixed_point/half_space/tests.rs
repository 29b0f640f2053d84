//! The sum of modes against exact solutions of the half-space.

extern crate std;

use std::f64::consts::PI;
use std::vec::Vec;

use documented_figures::assert_figure;
use proptest::prelude::*;

use super::*;
use crate::fixed_point::relaxation_bank::{MATCH_HORIZON_TICKS, WINDOW};
use crate::fixed_point::{Contact, ContactPair, Force, log2_relative_pressure};
use crate::material::{MATERIALS, Material, REFERENCE_DISPLAY, SKIN, find};
use crate::pressure::pressure_pa;
use crate::reference;

const TICK_S: f64 = 1e-3;

/// The same modes in `f64`, all updated in every tick.
struct Exact {
    /// Rate, weight and state of each mode; the integrator has rate 0.
    modes: Vec<(f64, f64, f64)>,
}

impl Exact {
    fn new() -> Self {
        let rate = |k: i32| 2f64.powi(-(2 * k + 1));
        let weight = |r: f64| 4f64.ln() / PI * r.sqrt();
        let slowest = (FAST + SLOW - 1) as i32;
        let mut modes: Vec<_> = (0..slowest).map(|k| (rate(k), weight(rate(k)), 0.0)).collect();
        modes.push((0.0, 2.0 / PI * (rate(slowest - 1) / 2.0).sqrt(), 0.0));
        Self { modes }
    }

    /// `(1 - e^-r) / r` times the weight.
    fn input_gain(&(rate, weight, _): &(f64, f64, f64)) -> f64 {
        weight * if rate > 0.0 { -(-rate).exp_m1() / rate } else { 1.0 }
    }

    fn step(&mut self, scaled_flux: f64) {
        for mode in &mut self.modes {
            mode.2 = mode.2 * (-mode.0).exp() + scaled_flux * Self::input_gain(mode);
        }
    }

    /// Response `ticks` later if no flux flows.
    fn free_response(&self, ticks: f64) -> f64 {
        self.modes.iter().map(|(rate, _, value)| value * (-rate * ticks).exp()).sum()
    }

    /// Response to `ticks` of a constant scaled flux of 1.
    fn gain(ticks: u32) -> f64 {
        let mut body = Self::new();
        (0..ticks).for_each(|_| body.step(1.0));
        2.0 / PI + body.free_response(0.0)
    }
}

#[test]
fn coefficients_are_those_of_the_sum_of_modes() {
    let scaled = |value: f64, bits: i32| (value * 2f64.powi(bits)).round() as i32;
    let window = f64::from(WINDOW);
    let exact = Exact::new();
    let (fast, slow) = exact.modes.split_at(FAST);
    for (mode, exact) in FAST_MODES.iter().zip(fast) {
        assert_eq!(mode.input_gain.to_bits(), scaled(Exact::input_gain(exact), 32));
        assert_eq!(mode.change.to_bits(), scaled((-exact.0).exp_m1(), 32));
        let remaining = f64::from(MATCH_HORIZON_TICKS) - 1.0;
        assert_eq!(mode.horizon_factor.to_bits(), scaled((-remaining * exact.0).exp(), 31));
    }
    for (mode, exact) in SLOW_MODES.iter().zip(slow) {
        let mean = (0..WINDOW).map(|j| (exact.0 * f64::from(j)).exp()).sum::<f64>() / window;
        assert_eq!(mode.input_gain.to_bits(), scaled(Exact::input_gain(exact) * mean, 32));
        assert_eq!(mode.decay.to_bits(), scaled(-(-window * exact.0).exp_m1(), 32));
    }
    let slow_gain = slow.iter().map(|mode| Exact::input_gain(mode) * (-mode.0).exp());
    assert_eq!(RELAXATIONS.slow_input_gain.to_bits(), scaled(slow_gain.sum(), 32));
    assert_eq!(TICK_GAIN.to_bits(), scaled(Exact::gain(1), 20));
    assert_eq!(
        RELAXATIONS.inverse_horizon_gain.to_bits(),
        scaled(1.0 / Exact::gain(MATCH_HORIZON_TICKS), 32)
    );
}

/// Error of the straight line over a window, per kelvin of scaled flux: the fastest slow mode takes up 0.0098 of
/// each flux and then loses 1 / 2048 of that in each of up to 28 pairs of ticks and fluxes, which the line omits.
const LINE_ERROR: f64 = 0.0098 * 28.0 / 2048.0;

/// Contacts of 1 K of scaled flux begin and end at any tick of a window.
#[test]
fn updates_once_per_window_agree_with_updates_every_tick() {
    let mut worst_k = 0f64;
    for delay in 0..WINDOW {
        let (mut body, mut exact) = (HalfSpace::default(), Exact::new());
        for _ in 0..delay {
            body.step(Celsius::ZERO);
        }
        for tick in 0..20_000u32 {
            // The flux of a contact decays, ends, and is followed by that of a contact with a warm object.
            let (since, size) = if tick < 9_001 { (tick, 1.0) } else { (tick - 9_001, -0.5) };
            let scaled_flux =
                if since < 6_003 { size / (1.0 + f64::from(since) / 30.0).sqrt() } else { 0.0 };
            if tick == 7_000 {
                body = body.staggered();
            }
            body.step(Celsius::from_num(scaled_flux));
            exact.step(Celsius::from_num(scaled_flux).to_num());
            worst_k = worst_k
                .max((body.free_response().to_num::<f64>() - exact.free_response(1.0)).abs());
        }
    }
    assert_figure("half_space.windows", 1e3 * worst_k);
    assert!(worst_k < LINE_ERROR, "{worst_k}");
}

#[test]
fn scaled_flux_to_match_makes_two_surfaces_meet_at_the_horizon() {
    for ticks in [1, 3, 30, 1000, 30_000] {
        let (mut from, mut to) = (HalfSpace::default(), HalfSpace::default().staggered());
        let (front, back) = (Celsius::lit("0.2"), Celsius::lit("0.12"));
        for _ in 0..ticks {
            from.step(back);
            to.step(front);
        }
        let (more, mut difference_k) = (from.scaled_flux_to_match(&to), 0.0);
        for _ in 0..MATCH_HORIZON_TICKS {
            difference_k = (to.response_to(back) - from.response_to(back + more)).to_num::<f64>();
            from.step(back + more);
            to.step(back);
        }
        let end_k = (to.free_response() - from.free_response()).to_num::<f64>();
        assert!(difference_k.abs() < 0.2e-3, "{ticks}: {difference_k} K, {end_k} K after it");
    }
}

#[test]
fn staggered_copy_ends_its_windows_half_a_window_apart_and_responds_the_same() {
    for ticks in 0..3 * WINDOW {
        let mut body = HalfSpace::default();
        for _ in 0..ticks {
            body.step(Celsius::lit("0.3"));
        }
        let mut other = body.staggered();
        for _ in 0..100 {
            assert_eq!(body.0.ticks_left.abs_diff(other.0.ticks_left), WINDOW / 2);
            body.step(Celsius::lit("0.1"));
            other.step(Celsius::lit("0.1"));
            let difference = body.free_response().abs_diff(other.free_response());
            assert!(difference.to_num::<f64>() < 0.3 * LINE_ERROR, "{difference}");
        }
    }
}

/// A constant flux changes the surface by `2 q sqrt(t / pi) / e`; after its end, the change is the difference of
/// two such terms.
#[test]
fn pulse_of_flux_gives_the_response_of_a_half_space() {
    let exact = |ticks: f64| 2.0 * (ticks.max(0.0) / core::f64::consts::PI).sqrt();
    let mut body = HalfSpace::default();
    let mut worst = 0f64;
    for tick in 1..=60_000u32 {
        let after = body.response_to(Celsius::ONE).to_num::<f64>();
        body.step(Celsius::ONE);
        let error = after / exact(tick.into()) - 1.0;
        if tick >= 10 {
            worst = worst.max(error.abs());
        }
        let allowed = match tick {
            1 => 0.05,
            2..10 => 0.012,
            _ => 0.004,
        };
        assert!(error.abs() < allowed, "tick {tick}: {error:e}");
    }
    std::println!("from tick 10 on: relative error {worst:.4}");
    worst = 0.0;
    for tick in 1..=60_000u32 {
        let response = body.free_response().to_num::<f64>();
        body.step(Celsius::ZERO);
        let now = f64::from(60_000 + tick);
        let error = response - (exact(now) - exact(f64::from(tick)));
        worst = worst.max(error.abs() / exact(60_000.0));
    }
    std::println!("after the pulse: {worst:.4} of its peak");
    assert!(worst < 0.0009, "{worst}");
}

fn contact(material: &Material, force_n: f64) -> Contact {
    ContactPair::new(&SKIN, material, &REFERENCE_DISPLAY, TICK_S)
        .expect("valid properties")
        .at_pressure(log2_relative_pressure(Force::from_num(force_n)))
}

#[test]
fn skin_on_each_material_agrees_with_equation_6_5() {
    let (mut worst_k, mut early_k) = (0f64, 0f64);
    for (_, material) in MATERIALS {
        for (force_n, _) in crate::pressure::THESIS_PRESSURES {
            let contact = contact(&material, force_n);
            let exact = reference::Contact::<f64>::new(
                (&SKIN, 34.0),
                (&material, 24.0),
                &REFERENCE_DISPLAY,
                pressure_pa(force_n),
            );
            let weight = contact.weight.to_num::<f64>();
            let (conductance, mut body) = (contact.object_conductance(), HalfSpace::default());
            for tick in 1..=10_000u32 {
                let flux = conductance.scaled_flux(Celsius::from_num(weight * 10.0), &body);
                let skin_c = 34.0 - body.response_to(flux).to_num::<f64>();
                body.step(flux);
                let error_k = (skin_c - exact.at(f64::from(tick) * TICK_S).skin_c).abs();
                if tick >= 20 {
                    worst_k = worst_k.max(error_k);
                } else {
                    early_k = early_k.max(error_k);
                }
            }
        }
    }
    assert_figure("half_space.skin_first_20_ms", 1e3 * early_k);
    assert_figure("half_space.skin_later", 1e3 * worst_k);
}

/// The scaled flux of one tick is `target / (resistance + gain)`, and the temperature drop `flux resistance`.
#[test]
fn conductances_are_those_of_their_contact() {
    let mut worst = 0f64;
    for (name, material) in MATERIALS {
        for force_n in [0.005, 0.02, 0.1, 0.3, 1.0, 3.0, 20.0, 250.0] {
            let contact = contact(&material, force_n);
            let on_object = 1.0 / contact.root_rate_per_tick.to_f64();
            let on_display =
                on_object * contact.ratio.to_num::<f64>() / contact.weight.to_num::<f64>();
            let gain = Exact::gain(1);
            for (conductance, resistance) in [
                (contact.object_conductance(), on_object),
                (contact.display_conductance(), on_display),
            ] {
                let (body, target) = (HalfSpace::default(), Celsius::lit("20"));
                let flux = conductance.scaled_flux(target, &body).to_num::<f64>();
                let drop = conductance.temperature_drop(Celsius::lit("0.0078125")).to_num::<f64>();
                let errors = [
                    (flux - 20.0 / (resistance + gain)).abs() / flux - 2f64.powi(-21) / flux,
                    (drop - resistance / 128.0).abs() / drop - 2f64.powi(-21) / drop,
                ];
                worst = errors.into_iter().fold(worst, f64::max);
                assert!(errors.iter().all(|&e| e < 1e-5), "{name}, {force_n} N: {errors:?}");
            }
        }
    }
    std::println!("conductances: relative error {worst:e}");
}

proptest! {
    #[test]
    fn inverse_agrees_with_a_64_bit_division(n in 1u32 << 31..) {
        let exact = 2f64.powi(62) / f64::from(n);
        let inverse = f64::from(conductance::inverse(n));
        prop_assert!(inverse < 2f64.powi(31) && (inverse / exact - 1.0).abs() < 2f64.powi(-28));
    }

    #[test]
    fn surface_behind_a_resistance_stays_within_the_range_of_its_targets(
        targets in prop::collection::vec((-170i32..170, 1u32..500), 1..20),
        force in 0.001..20.0,
    ) {
        let conductance = contact(find("copper").expect("copper"), force).display_conductance();
        let mut body = HalfSpace::default();
        let (mut low, mut high) = (0i32, 0i32);
        for (target, ticks) in targets {
            (low, high) = (low.min(target), high.max(target));
            for _ in 0..ticks {
                body.step(conductance.scaled_flux(Celsius::from_num(target), &body));
                let (response, rounding) = (body.free_response(), Celsius::DELTA * 64);
                prop_assert!(response >= Celsius::from_num(low) - rounding);
                prop_assert!(response <= Celsius::from_num(high) + rounding);
            }
        }
    }

    #[test]
    fn no_scaled_flux_overflows(fluxes in prop::collection::vec(any::<i32>(), 1..50)) {
        let mut body = HalfSpace::default();
        for bits in fluxes {
            for _ in 0..200 {
                body.step(Celsius::from_bits(bits));
            }
        }
    }
}

/// Five minutes of a constant flux change the surface by `2 sqrt(n / pi)`; an hour later the fraction
/// `(sqrt(n + m) - sqrt(m)) / sqrt(n)` of that remains.
#[test]
fn response_to_a_long_contact_decays_as_in_a_half_space() {
    let (contact, pause) = (300_000u32, 3_600_000u32);
    let mut body = HalfSpace::default();
    (0..contact).for_each(|_| body.step(Celsius::lit("0.01")));
    let root = |ticks: u32| f64::from(ticks).sqrt();
    let change: f64 = body.free_response().to_num();
    let expected = 0.01 * 2.0 / PI.sqrt() * root(contact);
    assert!((change / expected - 1.0).abs() < 0.005, "{change}, not {expected}");
    (0..pause).for_each(|_| body.step(Celsius::ZERO));
    let remaining = body.free_response().to_num::<f64>() / expected;
    let expected = (root(contact + pause) - root(pause)) / root(contact);
    assert!((remaining / expected - 1.0).abs() < 0.02, "{remaining}, not {expected}");
}
