//! The learner against recursive least squares in `f64`, on contacts that are simulated independently:
//! `tests/data/generate.py`.

use std::string::String;

use contact_model::fixed_point::Celsius;
use documented_figures::run_generator;

use super::contacts::new_learner;
use crate::{ContactInput, Flux, LearnerInput, PlaceBeforeContact, Resistance, Trust};

/// Largest difference, in prior deviations and prior variances: rounding of `f32`.
const TOLERANCE: f64 = 5e-4;

#[test]
fn committed_golden_values_are_those_that_the_generator_writes() {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/generate.py");
    run_generator(script, &["--check"]);
}

#[test]
fn learner_follows_the_independent_estimator() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/contacts.csv");
    let mut rows = csv::Reader::from_path(path).expect("golden table");
    let (mut finger, mut learner) = (String::new(), new_learner(PlaceBeforeContact::Air));
    let (mut worst, mut windows) = (0.0f64, 0);
    for row in rows.records() {
        let row = row.expect("golden row");
        let number = |column: usize| row[column].parse::<f64>().expect("a number");
        let place =
            if &row[1] == "air" { PlaceBeforeContact::Air } else { PlaceBeforeContact::Pad };
        if finger != row[0] {
            finger = row[0].into();
            learner = new_learner(place);
        }
        let contact = (number(3) > 0.0).then(|| ContactInput {
            touching_ticks: number(3) as u8,
            skin_above_display_k: Celsius::from_bits(number(4) as i32),
            air_flux_w_m2: Flux::from_bits(number(5) as i32),
            resistance_mm2k_w: Resistance::from_bits(number(6) as u32),
            ticks_since_landing: number(7) as u32,
            is_steady: true,
        });
        let input = LearnerInput {
            sequence: windows,
            restart: None,
            flux_w_m2: Some(Flux::from_bits(number(2) as i32)),
            contact,
        };
        let output = learner.advance(&input);
        assert_eq!(output.sequence, windows);
        assert!(!matches!(output.trust, Trust::Mean(_)), "{row:?}: {output:?}");
        let parameters = output.parameters.map(|one| one.to_num::<f64>());
        let variances = output.variances.map(|one| one.to_num::<f64>());
        for (column, ours) in parameters.into_iter().chain(variances).enumerate() {
            let error = (ours - number(8 + column)).abs();
            worst = worst.max(error);
            assert!(error < TOLERANCE, "{row:?}, column {column}: {ours}");
        }
        windows += 1;
    }
    assert_eq!(windows, 460);
    std::println!("largest difference {worst:.1e}");
}
