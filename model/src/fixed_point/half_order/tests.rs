//! Against the half-space's own solutions.

extern crate std;

use std::f64::consts::PI;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::fixed_point::{Force, Pairing, log2_relative_pressure};
use crate::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};
use crate::pressure::pressure_pa;
use crate::reference;

const TICK_S: f64 = 1e-3;

/// The same sum in `f64`, all of it stepped in every tick.
struct EveryTick {
    /// Rate, weight and value of each relaxation; the integrator has rate 0.
    parts: Vec<(f64, f64, f64)>,
}

impl EveryTick {
    fn at_rest() -> Self {
        let rate = |k: i32| 2f64.powi(-(2 * k + 1));
        let weight = |r: f64| 4f64.ln() / PI * r.sqrt();
        let slowest = (FAST + SLOW - 1) as i32;
        let mut parts: Vec<_> = (0..slowest)
            .map(|k| (rate(k), weight(rate(k)), 0.0))
            .collect();
        parts.push((0.0, 2.0 / PI * (rate(slowest - 1) / 2.0).sqrt(), 0.0));
        Self { parts }
    }

    /// `(1 - e^-r) / r` times the weight.
    fn given(&(rate, weight, _): &(f64, f64, f64)) -> f64 {
        weight
            * if rate > 0.0 {
                -(-rate).exp_m1() / rate
            } else {
                1.0
            }
    }

    fn step(&mut self, drive: f64) {
        for part in &mut self.parts {
            part.2 = part.2 * (-part.0).exp() + drive * Self::given(part);
        }
    }

    /// What there is `ticks` later, if nothing flows.
    fn left(&self, ticks: f64) -> f64 {
        self.parts
            .iter()
            .map(|(rate, _, value)| value * (-rate * ticks).exp())
            .sum()
    }

    /// What a lasting drive of one kelvin gives in `ticks`.
    fn gain(ticks: u32) -> f64 {
        let mut body = Self::at_rest();
        (0..ticks).for_each(|_| body.step(1.0));
        2.0 / PI + body.left(0.0)
    }
}

#[test]
fn constants_are_those_of_the_sum() {
    let scaled = |value: f64, bits: i32| (value * 2f64.powi(bits)).round() as i32;
    let window = f64::from(WINDOW);
    let exact = EveryTick::at_rest();
    let (fast, slow) = exact.parts.split_at(FAST);
    for (part, exact) in FAST_PARTS.iter().zip(fast) {
        assert_eq!(part.given, scaled(EveryTick::given(exact), 32));
        assert_eq!(part.lost, scaled(-(-exact.0).exp_m1(), 32));
        let still = f64::from(AHEAD_TICKS) - 1.0;
        assert_eq!(part.kept_ahead, scaled((-still * exact.0).exp(), 31));
    }
    for (part, exact) in SLOW_PARTS.iter().zip(slow) {
        let mean = (0..WINDOW)
            .map(|j| (exact.0 * f64::from(j)).exp())
            .sum::<f64>()
            / window;
        assert_eq!(part.given, scaled(EveryTick::given(exact) * mean, 32));
        assert_eq!(part.lost, scaled(-(-window * exact.0).exp_m1(), 32));
    }
    let slow_given = slow
        .iter()
        .map(|part| EveryTick::given(part) * (-part.0).exp());
    assert_eq!(SLOW_GIVEN, scaled(slow_given.sum(), 32));
    assert_eq!(GAIN as i32, scaled(EveryTick::gain(1), 20));
    assert_eq!(
        PER_GAIN_AHEAD,
        scaled(1.0 / EveryTick::gain(AHEAD_TICKS), 32)
    );
}

/// Error of a straight line over a window, per kelvin of drive: the fastest of the slow parts takes up 0.0098 of each
/// drive and then loses 1 / 2048 of that in each of up to 28 ticks and drives, which the line leaves out.
const STRAIGHT: f64 = 0.0098 * 28.0 / 2048.0;

/// Windows lose nothing that a contact shows: contacts of 1 K of drive begin and end at any time.
#[test]
fn windows_differ_little_from_every_tick() {
    let mut worst_k = 0f64;
    for late in 0..WINDOW {
        let (mut body, mut exact) = (HalfOrder::at_rest(), EveryTick::at_rest());
        for _ in 0..late {
            body.step(Celsius::ZERO);
        }
        for tick in 0..20_000u32 {
            // A contact falls like its flux, ends, and is followed by one with a warm object.
            let (since, size) = if tick < 9_001 {
                (tick, 1.0)
            } else {
                (tick - 9_001, -0.5)
            };
            let drive = if since < 6_003 {
                size / (1.0 + f64::from(since) / 30.0).sqrt()
            } else {
                0.0
            };
            if tick == 7_000 {
                body = body.out_of_step();
            }
            body.step(Celsius::from_num(drive));
            exact.step(Celsius::from_num(drive).to_num());
            worst_k = worst_k.max((body.left().to_num::<f64>() - exact.left(1.0)).abs());
        }
    }
    std::println!("windows: {:.3} mK", worst_k * 1e3);
    assert!(worst_k < STRAIGHT, "{worst_k}");
}

/// Two bodies that are apart come together in [`AHEAD_TICKS`] under the drive that is said to bring them there.
#[test]
fn drive_to_brings_one_body_to_the_other() {
    for ticks in [1, 3, 30, 1000, 30_000] {
        let (mut from, mut to) = (HalfOrder::at_rest(), HalfOrder::at_rest().out_of_step());
        let (front, back) = (Celsius::lit("0.2"), Celsius::lit("0.12"));
        for _ in 0..ticks {
            from.step(back);
            to.step(front);
        }
        let (more, mut apart) = (from.drive_to(&to), 0.0);
        for _ in 0..AHEAD_TICKS {
            apart = (to.after(back) - from.after(back + more)).to_num::<f64>();
            from.step(back + more);
            to.step(back);
        }
        let were = (to.left() - from.left()).to_num::<f64>();
        assert!(apart.abs() < 0.2e-3, "{ticks}: {apart} K left, {were}");
    }
}

/// Bodies out of step end their windows at different times, and stay as they are otherwise.
#[test]
fn out_of_step_is_half_a_window_away() {
    for ticks in 0..3 * WINDOW {
        let mut body = HalfOrder::at_rest();
        for _ in 0..ticks {
            body.step(Celsius::lit("0.3"));
        }
        let mut other = body.out_of_step();
        for _ in 0..100 {
            assert_eq!(body.to_come.abs_diff(other.to_come), WINDOW / 2);
            body.step(Celsius::lit("0.1"));
            other.step(Celsius::lit("0.1"));
            let apart = body.left().abs_diff(other.left());
            assert!(apart.to_num::<f64>() < 0.3 * STRAIGHT, "{apart}");
        }
    }
}

/// A constant flux moves a half-space by `2 q sqrt(t / pi) / e`; after it ends, by the difference of two such.
#[test]
fn pulse_of_flux_moves_the_surface_as_a_half_space() {
    let exact = |ticks: f64| 2.0 * (ticks.max(0.0) / core::f64::consts::PI).sqrt();
    let mut body = HalfOrder::at_rest();
    let mut worst = 0f64;
    for tick in 1..=60_000u32 {
        let after = body.after(Celsius::ONE).to_num::<f64>();
        body.step(Celsius::ONE);
        let error = after / exact(tick.into()) - 1.0;
        if tick >= 10 {
            worst = worst.max(error.abs());
        } else {
            std::println!("{tick} {error}");
        }
        let allowed = match tick {
            1 => 0.05,
            2..10 => 0.012,
            _ => 0.004,
        };
        assert!(error.abs() < allowed, "tick {tick}: {error:e}");
    }
    std::println!("late {worst}");
    worst = 0.0;
    for tick in 1..=60_000u32 {
        let left = body.left().to_num::<f64>();
        body.step(Celsius::ZERO);
        let now = f64::from(60_000 + tick);
        let error = left - (exact(now) - exact(f64::from(tick)));
        worst = worst.max(error.abs() / exact(60_000.0));
        assert!(
            error.abs() < 0.006 * exact(60_000.0),
            "{tick} after: {error}"
        );
    }
    std::println!("after {worst}");
}

/// The skin on each material under each stated force, by Eq. 6-5.
#[test]
fn contact_follows_equation_6_5() {
    let (mut worst_k, mut early_k) = (0f64, 0f64);
    for (name, material) in MATERIALS {
        let pairing =
            Pairing::new(&SKIN, &material, &REFERENCE_DISPLAY, TICK_S).expect("a material");
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
                assert!(
                    error_k < 0.05,
                    "{name}, {force_n} N, {tick} ms: {error_k} K"
                );
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

/// A drive of one tick through a resistance is `in_front / (resistance + gain)`, and what is across it its share.
#[test]
fn links_are_the_contacts_they_stand_for() {
    let mut worst = 0f64;
    for (name, material) in MATERIALS {
        let pairing =
            Pairing::new(&SKIN, &material, &REFERENCE_DISPLAY, TICK_S).expect("a material");
        for force_n in [0.005, 0.02, 0.1, 0.3, 1.0, 3.0, 20.0, 250.0] {
            let contact = pairing.under(log2_relative_pressure(Force::from_num(force_n)));
            let on_object = 1.0 / contact.per_root_tick.to_f64();
            let on_display =
                on_object * contact.ratio.to_num::<f64>() / contact.weight.to_num::<f64>();
            let gain = EveryTick::gain(1);
            for (link, resistance) in [
                (contact.on_object(), on_object),
                (contact.on_display(), on_display),
            ] {
                let (body, front) = (HalfOrder::at_rest(), Celsius::lit("20"));
                let drive = link.drive(front, &body).to_num::<f64>();
                let across = link.across(Celsius::lit("0.0078125")).to_num::<f64>();
                let errors = [
                    (drive - 20.0 / (resistance + gain)).abs() / drive - 2f64.powi(-21) / drive,
                    (across - resistance / 128.0).abs() / across - 2f64.powi(-21) / across,
                ];
                worst = errors.into_iter().fold(worst, f64::max);
                assert!(
                    errors.iter().all(|&e| e < 1e-5),
                    "{name}, {force_n} N: {errors:?}"
                );
            }
        }
    }
    std::println!("links: {worst:e}");
}

proptest! {
    #[test]
    fn inverse_is_that_of_a_long_division(n in 1u32 << 31..) {
        let exact = 2f64.powi(62) / f64::from(n);
        let inverse = f64::from(link::inverse(n));
        prop_assert!(inverse < 2f64.powi(31) && (inverse / exact - 1.0).abs() < 2f64.powi(-28));
    }

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

/// Five minutes of a constant drive move the surface by `2 sqrt(n / pi)`, and an hour later what is left of that is
/// `sqrt(n + m) - sqrt(m)` over `sqrt(n)`.
#[test]
fn a_long_contact_is_forgotten_as_a_half_space_does() {
    let (contact, rest) = (300_000u32, 3_600_000u32);
    let mut body = HalfOrder::at_rest();
    (0..contact).for_each(|_| body.step(Celsius::lit("0.01")));
    let root = |ticks: u32| f64::from(ticks).sqrt();
    let moved: f64 = body.left().to_num();
    let expected = 0.01 * 2.0 / PI.sqrt() * root(contact);
    assert!(
        (moved / expected - 1.0).abs() < 0.005,
        "{moved}, not {expected}"
    );
    (0..rest).for_each(|_| body.step(Celsius::ZERO));
    let left = body.left().to_num::<f64>() / expected;
    let expected = (root(contact + rest) - root(rest)) / root(contact);
    assert!(
        (left / expected - 1.0).abs() < 0.02,
        "{left}, not {expected}"
    );
}
