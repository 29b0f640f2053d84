//! What tuning finds over the box of plants, against the plants' parameters.

use thermal_campaigns::{IdentificationResult, QUANTITIES, survey_device, survey_table};

/// Devices.
const DRAWS: std::ops::Range<u64> = 1..11;
/// The largest deviation of each quantity in any of them. Which part of what delays the reading is lag and which dead
/// time is known less well than what counts for the loop: gain and phase at its crossover.
const ALLOWED: [(usize, f64); 7] =
    [(0, 4.0), (1, 25.0), (2, 20.0), (4, 20.0), (5, 8.0), (6, 15.0), (9, 2.5)];

#[test]
fn tile_is_identified_over_the_box() {
    let all: Vec<IdentificationResult> =
        DRAWS.map(|draw| survey_device(draw).expect("a tile")).collect();
    println!("{}", survey_table(&all));
    for result in &all {
        for (place, allowed) in ALLOWED {
            let (value, (name, unit)) = (result.values[place], QUANTITIES[place]);
            assert!(
                value.abs() < allowed,
                "draw {}: {name} is off by {value:.2} {unit}; {:?}",
                result.draw,
                result.tile
            );
        }
    }
    // They do differ: knowing the class alone would not do.
    let gains = || all.iter().map(|result| result.tile.gain_k_s_a);
    let (low, high) = (gains().fold(f64::MAX, f64::min), gains().fold(0.0, f64::max));
    assert!(high > 1.3 * low, "{low} to {high}");
}
