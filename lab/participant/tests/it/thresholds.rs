//! What a threshold session makes of a change: the falls that are behind the expected thresholds of `src/observer/tests.rs`.

use thermal_participant::BenchOptions;

use crate::run::{run, session};

/// Falls per kelvin of the level: in the interval with the change, and in the second one after it. Two seconds between the
/// intervals are too short for the skin to return, so that the second one begins with a rebound.
#[test]
fn the_skin_follows_a_part_of_the_change_and_has_not_returned_after_two_seconds() {
    let ran =
        run("p9-falls", &session("p9-change-threshold.toml", &[]), BenchOptions::default(), 12);
    for (direction, changed, after) in [("cooling", 0.556, -0.118), ("warming", -0.321, 0.112)] {
        let (mut of_change, mut of_rebound) = (Vec::new(), Vec::new());
        for (record, felt) in ran.records.iter().zip(&ran.observations) {
            let (Some(level_k), [Some(first_k), Some(second_k)]) =
                (record.staircase_level_k, &felt.falls_k[..])
            else {
                panic!("both intervals are felt: {felt:?}");
            };
            if record.levels[1] != direction {
                continue;
            }
            if record.levels[0] == "first" {
                of_change.push(first_k / level_k);
                of_rebound.push(second_k / level_k);
            } else {
                of_change.push(second_k / level_k);
            }
        }
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        assert!((mean(&of_change) - changed).abs() < 0.03, "{of_change:?}");
        assert!((mean(&of_rebound) - after).abs() < 0.02, "{of_rebound:?}");
    }
}
