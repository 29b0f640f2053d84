//! Interpolated set-points against Eq. 6-12 in `f64`, tick by tick.

use contact_model::fixed_point::{
    Celsius, ChordInterpolation, Contact, ContactPair, Force, Fraction, MantissaExponent, Ratio,
    log2_relative_pressure,
};
use contact_model::material::{
    MATERIALS, Material, REFERENCE_DISPLAY, SKIN, THESIS_MATERIALS, find,
};
use contact_model::pressure::THESIS_PRESSURES;
use contact_model::reference;
use documented_figures::{assert_figure, assert_row};
use proptest::prelude::*;

const SKIN_C: f64 = 34.0;
const TOLERANCE_K: f64 = 0.5e-3;

/// An interpolation with the number of its evaluations of `E`.
struct Counted {
    chords: ChordInterpolation,
    evaluations: u32,
}

impl Counted {
    fn new(contact: &Contact, object_c: f64, elapsed: u64, tolerance_k: f64) -> Self {
        let (chords, evaluations) = ChordInterpolation::new(
            contact,
            Celsius::from_num(SKIN_C),
            Celsius::from_num(object_c),
            elapsed,
            Celsius::from_num(tolerance_k),
        );
        Self { chords, evaluations }
    }

    fn setpoint_c(&self) -> f64 {
        self.chords.setpoint().to_num()
    }

    fn next_c(&mut self) -> f64 {
        let setpoint = self.chords.advance();
        assert_eq!(setpoint, self.chords.setpoint());
        self.evaluations += u32::from(self.chords.has_just_evaluated());
        setpoint.to_num()
    }
}

/// Eq. 6-12 at `elapsed` ticks, from the parameters of the fixed-point contact.
fn exact_c(contact: &Contact, object_c: f64, elapsed: f64) -> f64 {
    let e = reference::erfcx((elapsed * contact.rate_per_tick.to_f64()).sqrt());
    let step = SKIN_C - object_c;
    SKIN_C
        - step * contact.weight.to_num::<f64>() * (1.0 - e)
        - step * contact.ratio.to_num::<f64>() * e
}

/// A contact with `b² dt = 2^log2_rate`.
fn contact_with(weight: f64, ratio: f64, log2_rate: f64) -> Contact {
    Contact {
        weight: Fraction::from_num(weight),
        ratio: Ratio::from_num(ratio),
        rate_per_tick: MantissaExponent::from_f64(log2_rate.exp2()).expect("normal"),
        root_rate_per_tick: MantissaExponent::from_f64((0.5 * log2_rate).exp2()).expect("normal"),
        conductance_w_m2k: MantissaExponent::ONE,
    }
}

fn contact_of(material: &Material, force_n: f64) -> Contact {
    ContactPair::new(&SKIN, material, &REFERENCE_DISPLAY, 1e-3)
        .expect("a pair")
        .at_pressure(log2_relative_pressure(Force::from_num(force_n)))
}

/// Largest error in K and number of evaluations over each tick of 10 s.
fn run(material: &Material, (force_n, pressure_pa): (f64, f64), object_c: f64) -> (f64, u32) {
    let exact = reference::Contact::new(
        (&SKIN, SKIN_C),
        (material, object_c),
        &REFERENCE_DISPLAY,
        pressure_pa,
    );
    let display_c = |tick: i32| exact.at(f64::from(tick) * 1e-3).display_c;
    let mut chords = Counted::new(&contact_of(material, force_n), object_c, 0, TOLERANCE_K);
    let mut previous = chords.setpoint_c();
    let mut worst_k = (previous - display_c(0)).abs();
    let rising = display_c(10_000) > display_c(0);
    for tick in 1..=10_000 {
        let setpoint = chords.next_c();
        worst_k = worst_k.max((setpoint - display_c(tick)).abs());
        assert!((setpoint >= previous - 3e-7) == rising || (setpoint - previous).abs() < 3e-7);
        previous = setpoint;
    }
    (worst_k, chords.evaluations)
}

/// Largest error in µK, for every material, force of the thesis, and an object colder or warmer than the skin. The numbers of
/// evaluations are documented for the materials of the thesis.
pub fn thesis_error_uk() -> f64 {
    let mut worst_k = 0.0f64;
    for (name, material) in &MATERIALS {
        let evaluations = THESIS_PRESSURES.map(|point| {
            let (cold_k, cold) = run(material, point, 24.0);
            let (hot_k, hot) = run(material, point, 44.0);
            assert_eq!(cold, hot, "{name}, {point:?}");
            worst_k = worst_k.max(cold_k).max(hot_k);
            f64::from(cold)
        });
        if THESIS_MATERIALS.contains(name) {
            assert_row(&format!("evaluations.{name}"), &evaluations);
        }
    }
    worst_k * 1e6
}

#[test]
fn every_contact_is_within_tolerance_in_the_documented_evaluations() {
    assert_figure("course.error", 1e-3 * thesis_error_uk());
}

/// The bound of the chords' error, `u² E''(u) <= 0.1495`. `u^1.5 E''` decreases, so on an interval it is at most the value
/// at the lower end times the root of the interval's ratio.
#[test]
fn curvature_of_e_has_the_bound_that_the_chord_lengths_assume() {
    // u² E'' = sqrt(u) / pi * integral of exp(-s) s^1.5 / (u + s), with s = x².
    let curvature = |u: f64| {
        let (steps, end) = (2000, 8.0);
        let term = |i: i32| {
            let s = (end * f64::from(i) / f64::from(steps)).powi(2);
            (-s).exp() * 2.0 * s * s / (u + s)
        };
        u.sqrt() / core::f64::consts::PI * (1..steps).map(term).sum::<f64>() * end
            / f64::from(steps)
    };
    let mut highest = 0.0f64;
    for i in -40 * 256..40 * 256 {
        let u = (f64::from(i) / 256.0).exp2();
        highest = highest.max(curvature(u) * (0.5 / 256.0f64).exp2());
    }
    println!("curvature of E: at most {highest}");
    assert!(highest < 0.1495 && highest > 0.148);
    // Outside this range it is bounded by the leading terms sqrt(u / pi) / 2 and 3 / (4 sqrt(pi u)).
    assert!((2f64.powi(-40) / core::f64::consts::PI).sqrt() < 0.1495);
}

#[test]
fn transients_below_the_tolerance_need_no_evaluation() {
    let contact = contact_of(find("granite").expect("granite"), 2.0);
    for (object_c, tolerance_k) in
        [(SKIN_C, 0.5e-3), (SKIN_C + 0.001, 0.5e-3), (24.0, 2.0), (44.0, 2.0)]
    {
        let mut chords = Counted::new(&contact, object_c, 0, tolerance_k);
        for tick in 1..1000 {
            let error_k = chords.next_c() - exact_c(&contact, object_c, f64::from(tick));
            assert!(error_k.abs() <= tolerance_k, "{object_c} °C: {error_k} K");
        }
        assert_eq!(chords.evaluations, 0, "{object_c} °C");
    }
}

/// The set-point is the temperature of Eq. 3-1, or the preset.
#[test]
fn perfect_contact_and_no_contact_need_no_evaluation() {
    for (log2_rate, expected_c) in [(60.0, 34.0 - 10.0 * 0.6), (-90.0, 34.0 - 10.0 * 0.9)] {
        let contact = contact_with(0.6, 0.9, log2_rate);
        let mut chords = Counted::new(&contact, 24.0, 0, TOLERANCE_K);
        for _ in 0..10_000 {
            let error_k = chords.next_c() - expected_c;
            assert!(error_k.abs() <= TOLERANCE_K, "2^{log2_rate}: {error_k} K");
        }
        assert_eq!(chords.evaluations, 0, "2^{log2_rate}");
    }
}

#[test]
fn set_points_are_within_tolerance_after_years_of_contact() {
    let contact = contact_with(0.9, 0.1, -34.0);
    for log2_elapsed in 0..57 {
        for elapsed in [
            1u64 << log2_elapsed,
            (3 << log2_elapsed) - 1,
            0x5555_5555_5555 >> (56 - log2_elapsed) | 1,
        ] {
            let mut chords = Counted::new(&contact, 24.0, elapsed, TOLERANCE_K);
            for tick in 0..200 {
                let error_k =
                    chords.setpoint_c() - exact_c(&contact, 24.0, (elapsed + tick) as f64);
                assert!(error_k.abs() <= TOLERANCE_K, "{elapsed} + {tick}: {error_k} K");
                chords.next_c();
            }
        }
    }
}

/// Starts five ticks before the end of chords that are too long to be run through.
#[test]
fn set_point_is_continuous_between_the_longest_chords() {
    let contact = contact_with(0.9, 0.1, -44.0);
    for elapsed in (31..50).flat_map(|octave| [(1u64 << octave) - 5, (1 << octave) + (1 << 31) - 5])
    {
        let mut chords = Counted::new(&contact, 24.0, elapsed, TOLERANCE_K);
        let mut previous_c = chords.setpoint_c();
        for tick in 1..10 {
            let now_c = chords.next_c();
            let error_k = now_c - exact_c(&contact, 24.0, (elapsed + tick) as f64);
            assert!(error_k.abs() <= TOLERANCE_K, "{elapsed} + {tick}: {error_k} K");
            assert!((now_c - previous_c).abs() < 1e-6, "{elapsed} + {tick}: a jump");
            previous_c = now_c;
        }
        assert!(chords.evaluations <= 4);
    }
}

proptest! {
    /// Resistance and tick vary together, as the rate.
    #[test]
    fn set_points_are_within_any_tolerance_for_any_contact_from_any_tick_on(
        log2_rate in -110.0..64.0f64,
        weight in 0.001..0.999f64,
        ratio in 0.0..1.5f64,
        step_k in -60.0..60.0f64,
        log2_tolerance in -17.0..0.0f64,
        log2_elapsed in 0.0..56.0f64,
        landing in any::<bool>(),
    ) {
        let contact = contact_with(weight, ratio, log2_rate);
        let (object_c, tolerance_k) = (SKIN_C - step_k, log2_tolerance.exp2());
        let elapsed = if landing { 0 } else { log2_elapsed.exp2() as u64 };
        let mut chords = Counted::new(&contact, object_c, elapsed, tolerance_k);
        for tick in 0..3000 {
            let setpoint_c = if tick == 0 { chords.setpoint_c() } else { chords.next_c() };
            // In perfect contact the temperature changes at once, so landing itself is left out.
            if elapsed + tick == 0 {
                continue;
            }
            let error_k = setpoint_c - exact_c(&contact, object_c, (elapsed + tick) as f64);
            // 5e-7 K for the rounding of the input temperatures.
            prop_assert!(error_k.abs() <= tolerance_k + 5e-7, "{} ticks: {} K", tick, error_k);
        }
    }
}
