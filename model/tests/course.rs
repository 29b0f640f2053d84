//! Chords between evaluations against Eq. 6-12 in `f64`, tick by tick.

use contact_model::fixed_point::{
    Celsius, Contact, Course, Force, Fraction, Pairing, Rate, Ratio, log2_relative_pressure,
};
use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};
use contact_model::{pressure, reference};
use proptest::prelude::*;

const SKIN_C: f64 = 34.0;
const TOLERANCE_K: f64 = 0.5e-3;

/// A course, and how often it evaluated `E`.
struct Watched {
    course: Course,
    evaluations: u32,
}

impl Watched {
    fn new(contact: &Contact, object_c: f64, elapsed: u64, tolerance_k: f64) -> Self {
        let (course, evaluations) = Course::new(
            contact,
            Celsius::from_num(SKIN_C),
            Celsius::from_num(object_c),
            elapsed,
            Celsius::from_num(tolerance_k),
        );
        Self {
            course,
            evaluations,
        }
    }

    fn setpoint_c(&self) -> f64 {
        self.course.setpoint().to_num()
    }

    fn next_c(&mut self) -> f64 {
        let setpoint = self.course.advance();
        assert_eq!(setpoint, self.course.setpoint());
        self.evaluations += u32::from(self.course.is_at_knot());
        setpoint.to_num()
    }
}

/// Eq. 6-12 at `elapsed` ticks, of the contact's own numbers.
fn exact_c(contact: &Contact, object_c: f64, elapsed: f64) -> f64 {
    let e = reference::erfcx((elapsed * contact.per_tick.to_f64()).sqrt());
    let step = SKIN_C - object_c;
    SKIN_C
        - step * contact.weight.to_num::<f64>() * (1.0 - e)
        - step * contact.ratio.to_num::<f64>() * e
}

/// A contact with `b² dt` of two to the power of `log2_rate`.
fn contact_with(weight: f64, ratio: f64, log2_rate: f64) -> Contact {
    Contact {
        weight: Fraction::from_num(weight),
        ratio: Ratio::from_num(ratio),
        per_tick: Rate::from_f64(log2_rate.exp2()).expect("normal"),
        per_root_tick: Rate::from_f64((0.5 * log2_rate).exp2()).expect("normal"),
        conductance_w_m2k: Rate::ONE,
    }
}

fn contact_of(material: usize, force_n: f64) -> Contact {
    Pairing::new(&SKIN, &MATERIALS[material].1, &REFERENCE_DISPLAY, 1e-3)
        .expect("pairing")
        .under(log2_relative_pressure(Force::from_num(force_n)))
}

/// Every material at every force of the thesis, hot and cold, each tick of 10 s.
#[test]
fn every_contact_of_the_thesis_is_within_tolerance_in_at_most_100_evaluations() {
    for (material, (name, properties)) in MATERIALS.iter().enumerate() {
        let mut line = format!("{name:16}");
        for (force_n, pressure_pa) in pressure::STATED {
            let contact = contact_of(material, force_n);
            for object_c in [24.0, 44.0] {
                let thesis = reference::Contact::new(
                    (&SKIN, SKIN_C),
                    (properties, object_c),
                    &REFERENCE_DISPLAY,
                    pressure_pa,
                );
                let mut watched = Watched::new(&contact, object_c, 0, TOLERANCE_K);
                let mut worst_k = (watched.setpoint_c() - thesis.at(0.0).display_c).abs();
                let mut before = watched.setpoint_c();
                let rising = thesis.at(10.0).display_c > thesis.at(0.0).display_c;
                for tick in 1..=10_000 {
                    let now = watched.next_c();
                    worst_k =
                        worst_k.max((now - thesis.at(f64::from(tick) * 1e-3).display_c).abs());
                    assert!((now >= before - 3e-7) == rising || (now - before).abs() < 3e-7);
                    before = now;
                }
                line += &format!("  {:3} {:.3} mK", watched.evaluations, worst_k * 1e3);
                assert!(worst_k <= TOLERANCE_K, "{name}, {force_n} N: {worst_k} K");
                assert!(watched.evaluations <= 100, "{name}, {force_n} N");
            }
        }
        println!("{line}");
    }
}

/// `u² E''(u) <= 0.1495`, which the chords rest on: `u^1.5 E''` falls, so on each interval the bend is at most that at
/// its lower end times the root of its width.
#[test]
fn bend_of_e_is_bounded() {
    // u² E'' = sqrt(u) / pi * integral of exp(-s) s^1.5 / (u + s), with s = x².
    let bend = |u: f64| {
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
        highest = highest.max(bend(u) * (0.5 / 256.0f64).exp2());
    }
    println!("bend of E: at most {highest}");
    assert!(highest < 0.1495 && highest > 0.148);
    // Beyond, by the leading terms at either end, which bound it: sqrt(u / pi) / 2 and 3 / (4 sqrt(pi u)).
    assert!((2f64.powi(-40) / core::f64::consts::PI).sqrt() < 0.1495);
}

#[test]
fn equal_temperatures_and_what_is_below_the_tolerance_need_no_evaluation() {
    let contact = contact_of(3, 2.0);
    for (object_c, tolerance_k) in [
        (SKIN_C, 0.5e-3),
        (SKIN_C + 0.001, 0.5e-3),
        (24.0, 2.0),
        (44.0, 2.0),
    ] {
        let mut watched = Watched::new(&contact, object_c, 0, tolerance_k);
        for tick in 1..1000 {
            let error_k = watched.next_c() - exact_c(&contact, object_c, f64::from(tick));
            assert!(error_k.abs() <= tolerance_k, "{object_c} °C: {error_k} K");
        }
        assert_eq!(watched.evaluations, 0, "{object_c} °C");
    }
}

/// Perfect contact holds the temperature of Eq. 3-1, absent contact the preset.
#[test]
fn limits_of_resistance_need_no_evaluation() {
    for (log2_rate, expected_c) in [(60.0, 34.0 - 10.0 * 0.6), (-90.0, 34.0 - 10.0 * 0.9)] {
        let contact = contact_with(0.6, 0.9, log2_rate);
        let mut watched = Watched::new(&contact, 24.0, 0, TOLERANCE_K);
        for _ in 0..10_000 {
            let error_k = watched.next_c() - expected_c;
            assert!(error_k.abs() <= TOLERANCE_K, "2^{log2_rate}: {error_k} K");
        }
        assert_eq!(watched.evaluations, 0, "2^{log2_rate}");
    }
}

/// The last of the years is as near Eq. 6-12 as the first second, and as rarely evaluated.
#[test]
fn years_of_contact_are_within_tolerance() {
    let contact = contact_with(0.9, 0.1, -34.0);
    for log2_elapsed in 0..57 {
        for elapsed in [
            1u64 << log2_elapsed,
            (3 << log2_elapsed) - 1,
            0x5555_5555_5555 >> (56 - log2_elapsed) | 1,
        ] {
            let mut watched = Watched::new(&contact, 24.0, elapsed, TOLERANCE_K);
            for tick in 0..200 {
                let error_k =
                    watched.setpoint_c() - exact_c(&contact, 24.0, (elapsed + tick) as f64);
                assert!(
                    error_k.abs() <= TOLERANCE_K,
                    "{elapsed} + {tick}: {error_k} K"
                );
                watched.next_c();
            }
        }
    }
}

/// Chords far longer than a test can wait for, seen at once by starting close to their ends.
#[test]
fn the_longest_chords_follow_one_another() {
    let contact = contact_with(0.9, 0.1, -44.0);
    for elapsed in (31..50).flat_map(|octave| [(1u64 << octave) - 5, (1 << octave) + (1 << 31) - 5])
    {
        let mut watched = Watched::new(&contact, 24.0, elapsed, TOLERANCE_K);
        let mut before_c = watched.setpoint_c();
        for tick in 1..10 {
            let now_c = watched.next_c();
            let error_k = now_c - exact_c(&contact, 24.0, (elapsed + tick) as f64);
            assert!(
                error_k.abs() <= TOLERANCE_K,
                "{elapsed} + {tick}: {error_k} K"
            );
            assert!(
                (now_c - before_c).abs() < 1e-6,
                "{elapsed} + {tick}: a jump"
            );
            before_c = now_c;
        }
        assert!(watched.evaluations <= 4);
    }
}

proptest! {
    /// Any resistance and tick (together the rate), either sign of `dT`, any tolerance, from any tick on.
    #[test]
    fn any_course_stays_within_its_tolerance(
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
        let mut watched = Watched::new(&contact, object_c, elapsed, tolerance_k);
        for tick in 0..3000 {
            let setpoint_c = if tick == 0 { watched.setpoint_c() } else { watched.next_c() };
            // Perfect contact takes no time, so the moment of landing is left out.
            if elapsed + tick == 0 {
                continue;
            }
            let error_k = setpoint_c - exact_c(&contact, object_c, (elapsed + tick) as f64);
            // The temperatures given have been rounded, too.
            prop_assert!(error_k.abs() <= tolerance_k + 5e-7, "{} ticks: {} K", tick, error_k);
        }
    }
}
