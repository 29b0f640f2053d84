//! Section 4.2: which material is it?

use experiment_statistics::correlation::pearson;

use super::closed_form::identified;
use super::condition::{Condition, DisplayMode, falls_on_samples_and_displays};
use super::published::{
    SECTION_4_2, SECTION_4_2_C, SECTION_4_2_CORRELATION, SECTION_4_2_MATERIALS,
};
use super::report::{CellResult, Check, Identification};
use super::{PredictionError, mean};
use crate::ObserverParams;

/// Section 4.2, whose factor is fitted to both overall percentages.
pub(super) fn identification(observer: &ObserverParams) -> Result<Identification, PredictionError> {
    let falls_k = falls_on_samples_and_displays(
        Condition::of_thesis(SECTION_4_2_C),
        &SECTION_4_2_MATERIALS,
        &[DisplayMode::SemiInfinitePi10Hz],
    )?;
    let of = |column: usize| -> Vec<f64> { falls_k.iter().map(|row| row[column]).collect() };
    let (real_k, simulated_k) = (of(0), of(1));
    let confusions = |factor: f64| {
        let observer = ObserverParams { identification_factor: factor, ..*observer };
        [&real_k, &simulated_k].map(|presented_k| -> Vec<Vec<f64>> {
            presented_k.iter().map(|fall_k| identified(&observer, *fall_k, &real_k)).collect()
        })
    };
    let overall = |rows: &[Vec<f64>]| mean(rows.iter().enumerate().map(|(index, row)| row[index]));
    let log_likelihood = |factor: f64| -> f64 {
        let both = confusions(factor);
        let parts = SECTION_4_2.iter().zip(&both);
        parts
            .map(|((percent, trials), rows)| {
                let (observed, expected) = (percent / 100.0, overall(rows));
                let correct = observed * libm::log(expected);
                f64::from(*trials) * (correct + (1.0 - observed) * libm::log(1.0 - expected))
            })
            .sum()
    };
    // One parameter in a known range: every value to two decimals is tried.
    let factors = (50..=400).map(|hundredths| f64::from(hundredths) / 100.0);
    let likely = factors.map(|factor| (factor, log_likelihood(factor)));
    let (factor, _) = likely
        .fold((1.0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best });
    let confusions = confusions(factor);
    let correct = confusions.each_ref().map(|rows| -> Vec<f64> {
        let diagonal = rows.iter().enumerate().map(|(index, row)| 100.0 * row[index]);
        diagonal.collect()
    });
    let [real, simulated] = &confusions;
    let correlation = pearson(&real.concat(), &simulated.concat())?.r;
    let overall: Vec<f64> = confusions.iter().map(|rows| 100.0 * overall(rows)).collect();
    let cell = |label: &str, index: usize| CellResult {
        label: label.into(),
        published: SECTION_4_2[index].0,
        predicted: overall[index],
    };
    let best_is_foam = correct.iter().all(|rates| {
        let foam = rates.last().copied().unwrap_or(0.0);
        rates.iter().all(|rate| *rate <= foam)
    });
    let checks = vec![
        Check::within("real materials", overall[0], 45.0, 60.0),
        Check::within("simulated materials", overall[1], 45.0, 60.0),
        Check {
            what: "best identified".into(),
            value: if best_is_foam { "foam" } else { "another" }.into(),
            allowed: "foam".into(),
            met: best_is_foam,
        },
        Check {
            what: "correlation of the confusion matrices".into(),
            value: format!("{correlation:.2}"),
            allowed: format!("at least 0.7 (published: {SECTION_4_2_CORRELATION})"),
            met: correlation >= 0.7,
        },
    ];
    Ok(Identification {
        factor,
        materials: SECTION_4_2_MATERIALS.map(str::to_owned).to_vec(),
        overall: [cell("real", 0), cell("simulated", 1)],
        falls_k: [real_k, simulated_k],
        correct,
        confusions,
        correlation,
        checks,
    })
}
