//! What tuning finds over the box of plants, against the plants' parameters.

use thermal_campaigns::{QUANTITIES, Surveyed, survey, survey_table};

/// Devices.
const DRAWS: std::ops::Range<u64> = 1..11;
/// The largest deviation of each quantity in any of them. Which part of what delays the reading is lag and which dead
/// time is known less well than what counts for the loop: gain and phase at its crossover.
const ALLOWED: [(usize, f64); 7] = [
    (0, 4.0),
    (1, 25.0),
    (2, 20.0),
    (4, 20.0),
    (5, 8.0),
    (6, 15.0),
    (9, 2.5),
];

#[test]
fn tile_is_identified_over_the_box() {
    let all: Vec<Surveyed> = DRAWS.map(|draw| survey(draw).expect("a tile")).collect();
    println!("{}", survey_table(&all));
    for surveyed in &all {
        for (place, allowed) in ALLOWED {
            let (value, (name, unit)) = (surveyed.values[place], QUANTITIES[place]);
            assert!(
                value.abs() < allowed,
                "draw {}: {name} is off by {value:.2} {unit}; {:?}",
                surveyed.draw,
                surveyed.tile
            );
        }
    }
    // They do differ: knowing the class alone would not do.
    let gains = || all.iter().map(|surveyed| surveyed.tile.gain_k_s_a);
    let (low, high) = (
        gains().fold(f64::MAX, f64::min),
        gains().fold(0.0, f64::max),
    );
    assert!(high > 1.3 * low, "{low} to {high}");
}
