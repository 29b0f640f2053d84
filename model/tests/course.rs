//! Chords between evaluations against Eq. 6-12 in `f64`, tick by tick.

use contact_model::fixed_point::{Celsius, Contact, Course, Force, Pairing, log2_relative_pressure};
use contact_model::material::{MATERIALS, REFERENCE_DISPLAY, SKIN};
use contact_model::{pressure, reference};

const SKIN_C: f64 = 34.0;
const TOLERANCE_K: f64 = 0.5e-3;

/// A course, the set-point that it follows, and how often it evaluated `E`.
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
        Self { course, evaluations }
    }

    fn setpoint_c(&self) -> f64 {
        self.course.setpoint().to_num()
    }

    fn next_c(&mut self) -> f64 {
        let setpoint = self.course.advance();
        assert_eq!(setpoint, self.course.setpoint());
        self.evaluations += u32::from(self.course.has_turned());
        setpoint.to_num()
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
                    worst_k = worst_k.max((now - thesis.at(f64::from(tick) * 1e-3).display_c).abs());
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
