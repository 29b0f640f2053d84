//! Section 4.3: a real material against a simulated one.

use super::closed_form::colder;
use super::condition::{Condition, DisplayMode, falls_on_samples_and_displays};
use super::published::{SECTION_4_3_BELOW, SECTION_4_3_MATERIALS, THRESHOLD_PERCENT};
use super::report::{Check, IdenticalResult, PairResult, RealAgainstSimulated};
use super::{PredictionError, mean};
use crate::ObserverParams;

/// Section 4.3 in a condition, with both displays.
///
/// # Errors
/// The simulated device cannot present something.
pub fn real_against_simulated(
    observer: &ObserverParams,
    condition: Condition,
) -> Result<RealAgainstSimulated, PredictionError> {
    let falls_k =
        falls_on_samples_and_displays(condition, &SECTION_4_3_MATERIALS, &DisplayMode::ALL)?;
    let named = || SECTION_4_3_MATERIALS.iter().zip(&falls_k).enumerate();
    let (mut pairs, mut identical) = (Vec::new(), Vec::new());
    for (of_real, (real, real_row)) in named() {
        for (of_simulated, (simulated, simulated_row)) in named() {
            let real_colder = [1, 2]
                .map(|display| 100.0 * colder(observer, [real_row[0], simulated_row[display]]));
            if of_real == of_simulated {
                identical.push(IdenticalResult {
                    material: (*real).into(),
                    real_k: real_row[0],
                    simulated_k: [simulated_row[1], simulated_row[2]],
                    real_colder,
                });
                continue;
            }
            // Materials are listed from the coldest on.
            let is_real_colder = of_real < of_simulated;
            pairs.push(PairResult {
                real: (*real).into(),
                simulated: (*simulated).into(),
                published_below: SECTION_4_3_BELOW.contains(&(*real, *simulated)),
                correct: real_colder.map(
                    |percent| {
                        if is_real_colder { percent } else { 100.0 - percent }
                    },
                ),
            });
        }
    }
    let means = [0, 1].map(|display| mean(pairs.iter().map(|pair| pair.correct[display])));
    let differences = pairs.iter().map(|pair| (pair.correct[1] - pair.correct[0]).abs());
    Ok(RealAgainstSimulated {
        condition,
        means,
        largest_difference: differences.fold(0.0, f64::max),
        checks: check_section_4_3(&pairs, &identical),
        pairs,
        identical,
    })
}

fn check_section_4_3(pairs: &[PairResult], identical: &[IdenticalResult]) -> Vec<Check> {
    let rank = |name: &str| SECTION_4_3_MATERIALS.iter().position(|known| *known == name);
    let correct = |of: &dyn Fn(&PairResult) -> bool| -> Vec<f64> {
        let wanted = pairs.iter().filter(|pair| of(pair));
        wanted.map(|pair| pair.correct[0]).collect()
    };
    let is = |pair: &PairResult, a: &str, b: &str| {
        (pair.real == a && pair.simulated == b) || (pair.real == b && pair.simulated == a)
    };
    let real_colder = correct(&|pair| rank(&pair.real) < rank(&pair.simulated));
    let simulated_colder = correct(&|pair| rank(&pair.real) > rank(&pair.simulated));
    let (above, below) = (mean(real_colder.into_iter()), mean(simulated_colder.into_iter()));
    let copper_steel = correct(&|pair| is(pair, "copper", "stainless-steel"));
    let with_abs = correct(&|pair| is(pair, "copper", "abs") || is(pair, "stainless-steel", "abs"));
    let of_identical = |name: &str| {
        let found = identical.iter().find(|row| row.material == name);
        found.map_or(0.0, |row| row.real_colder[0])
    };
    let published: Vec<String> = (pairs.iter())
        .filter(|pair| pair.published_below != (pair.correct[0] < THRESHOLD_PERCENT))
        .map(|pair| format!("{} / {}", pair.real, pair.simulated))
        .collect();
    vec![
        Check {
            what: "mean with the real one colder against the simulated one colder".into(),
            value: format!("{above:.1} and {below:.1} %"),
            allowed: "5 % apart at most".into(),
            met: (above - below).abs() <= 5.0,
        },
        Check {
            what: "copper with stainless steel".into(),
            value: percentages(&copper_steel),
            allowed: "below 72 %".into(),
            met: copper_steel.iter().all(|percent| *percent < THRESHOLD_PERCENT),
        },
        Check {
            what: "ABS with copper and stainless steel".into(),
            value: percentages(&with_abs),
            allowed: "above 72 %".into(),
            met: with_abs.iter().all(|percent| *percent > THRESHOLD_PERCENT),
        },
        Check::within(
            "identical copper, real said to be colder",
            of_identical("copper"),
            40.0,
            60.0,
        ),
        Check::within("identical stainless steel", of_identical("stainless-steel"), 40.0, 60.0),
        Check {
            what: "identical granite".into(),
            value: format!("{:.1} %", of_identical("granite")),
            allowed: "above 50 %".into(),
            met: of_identical("granite") > 50.0,
        },
        Check {
            what: "identical ABS (published: real felt colder)".into(),
            value: format!("{:.1} %", of_identical("abs")),
            allowed: "above 50 %".into(),
            met: of_identical("abs") > 50.0,
        },
        Check {
            what: "pairs on the other side of 72 % than published".into(),
            value: published.join(", "),
            allowed: "none".into(),
            met: published.is_empty(),
        },
    ]
}

fn percentages(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|value| format!("{value:.1} %")).collect();
    texts.join(", ")
}
