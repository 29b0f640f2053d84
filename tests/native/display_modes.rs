//! The display of chapter 4 (constant temperature of Eq. 3-1) beside that of chapter 6 (Eq. 6-12).

use documented_figures::assert_figure;
use system_tests::{between, forces, mean, natively, scene};
use thermal_sim::run::Outcome;

const LANDED_S: f64 = 1.0;

fn run(material: &str, mode: &str) -> Outcome {
    let mode = format!("mode = \"{mode}\"");
    natively(&scene(material, 5.0, &mode, &forces(&[(LANDED_S, 2.0)])))
}

/// How much warmer than the real object's surface the display is in the first second of contact, K.
fn too_warm_k(outcome: &Outcome) -> f64 {
    mean(between(outcome, LANDED_S, LANDED_S + 1.0), |row| row.display_c - row.object_real_c)
}

/// Root mean square of the skin's error in the first four seconds, K.
fn skin_error_k(outcome: &Outcome) -> f64 {
    let rows = between(outcome, LANDED_S + 0.05, LANDED_S + 4.0);
    mean(rows, |row| (row.skin_c - row.skin_real_c).powi(2)).sqrt()
}

/// Section 6.3: real granite and ABS felt colder than chapter 4's, copper did not.
#[test]
fn a_semi_infinite_display_is_warmer_than_an_object_of_low_effusivity() {
    for material in ["copper", "granite", "abs"] {
        let warmer_k = too_warm_k(&run(material, "semi-infinite"));
        assert_figure(&format!("semi_infinite.{material}_too_warm"), warmer_k);
    }
}

#[test]
fn contact_mode_brings_the_skin_closer_to_the_real_contact() {
    for (material, part) in [("granite", 0.02), ("abs", 0.2)] {
        let [semi_infinite, contact] = ["semi-infinite", "contact"].map(|mode| run(material, mode));
        println!(
            "{material}: skin error {:.4} and {:.4} K RMS",
            skin_error_k(&semi_infinite),
            skin_error_k(&contact)
        );
        // The error that remains is the controller's; it is below what people can feel.
        assert!(skin_error_k(&contact) < part * skin_error_k(&semi_infinite), "{material}");
        assert!(skin_error_k(&contact) < 5e-3, "{material}");
        let warmer = mean(between(&semi_infinite, LANDED_S + 0.05, LANDED_S + 1.0), |row| {
            row.skin_c - row.skin_real_c
        });
        assert!(warmer > 0.0, "{material}: {warmer} K");
    }
}
