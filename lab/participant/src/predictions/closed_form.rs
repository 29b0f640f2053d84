//! Proportions of correct answers in closed form, for falls without differences between touches.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use experiment_statistics::distribution::{normal_cdf, normal_density};

use crate::ObserverParams;

/// Answers of an observer who sometimes answers at random among `answers`.
fn with_lapses(observer: &ObserverParams, answers: f64, proportion: f64) -> f64 {
    observer.lapse / answers + (1.0 - observer.lapse) * proportion
}

/// Proportion of trials in which the first of two falls, K, is said to be the larger.
pub fn colder(observer: &ObserverParams, [first_k, second_k]: [f64; 2]) -> f64 {
    let noise_k = libm::hypot(observer.sigma_k(first_k), observer.sigma_k(second_k));
    let off_k = first_k - second_k;
    let proportion = if noise_k > 0.0 {
        normal_cdf(off_k / noise_k)
    } else if off_k == 0.0 {
        0.5
    } else {
        f64::from(off_k > 0.0)
    };
    with_lapses(observer, 2.0, proportion)
}

/// Proportion of trials in which the target among two equal distractors is found, whose direction is not known.
///
/// The farthest from the mean of all is chosen. With `u` the distance of the target from the middle of the distractors and
/// `d` their difference, which are independent, this is the target if `|u| > 1.5 |d|`.
pub fn different(observer: &ObserverParams, target_k: f64, distractor_k: f64) -> f64 {
    /// Steps of the trapezoidal rule up to 8 standard deviations.
    const STEPS: u32 = 400;
    const END: f64 = 8.0;
    let factor = observer.three_finger_factor;
    let target_sd_k = factor * observer.sigma_k(target_k);
    let distractor_sd_k = factor * observer.sigma_k(distractor_k);
    let off_k = target_k - distractor_k;
    let u_sd_k = libm::hypot(target_sd_k, distractor_sd_k * FRAC_1_SQRT_2);
    let d_sd_k = distractor_sd_k * SQRT_2;
    if u_sd_k == 0.0 {
        let proportion = if off_k == 0.0 { 1.0 / 3.0 } else { 1.0 };
        return with_lapses(observer, 3.0, proportion);
    }
    let step = END / f64::from(STEPS);
    let sum: f64 = (0..=STEPS)
        .map(|index| {
            let z = f64::from(index) * step;
            let least_k = 1.5 * d_sd_k * z;
            let beyond =
                normal_cdf((off_k - least_k) / u_sd_k) + normal_cdf((-off_k - least_k) / u_sd_k);
            let weight = if index == 0 || index == STEPS { 0.5 } else { 1.0 };
            weight * normal_density(z) * beyond
        })
        .sum();
    with_lapses(observer, 3.0, 2.0 * step * sum)
}

/// Proportions of the answers to a fall, K, among materials with these expected falls, K.
pub fn identified(observer: &ObserverParams, fall_k: f64, expected_k: &[f64]) -> Vec<f64> {
    /// Steps of the midpoint rule over 16 standard deviations.
    const STEPS: u32 = 4000;
    const END: f64 = 8.0;
    let factor = observer.identification_factor;
    let sd_k = factor * observer.sigma_k(fall_k);
    let mut proportions = vec![0.0; expected_k.len()];
    let step = 2.0 * END / f64::from(STEPS);
    for index in 0..STEPS {
        let z = (f64::from(index) + 0.5) * step - END;
        let felt_k = fall_k + sd_k * z;
        let likelihood = |mean_k: f64| {
            let sd_k = factor * observer.sigma_k(mean_k);
            let off = (felt_k - mean_k) / sd_k;
            -0.5 * off * off - libm::log(sd_k)
        };
        let mut best: Option<(usize, f64)> = None;
        for (answer, mean_k) in expected_k.iter().enumerate() {
            let value = likelihood(*mean_k);
            if best.is_none_or(|(_, most)| value > most) {
                best = Some((answer, value));
            }
        }
        if let Some((answer, _)) = best {
            proportions[answer] += normal_density(z) * step;
        }
    }
    let answers = expected_k.len() as f64;
    proportions.into_iter().map(|proportion| with_lapses(observer, answers, proportion)).collect()
}

#[cfg(test)]
mod tests {
    use experiment_statistics::sensitivity::proportion_correct_oddity;

    use super::*;

    #[test]
    fn proportions_of_the_different_one_are_those_of_the_triangular_method() {
        let observer = ObserverParams {
            s0_k: 1.0,
            w: 0.0,
            three_finger_factor: 1.0,
            lapse: 0.0,
            ..ObserverParams::TOUCH
        };
        for d in [0.0, 0.5, 1.0, 1.83, 3.0] {
            let predicted = different(&observer, d, 0.0);
            let exact = proportion_correct_oddity(d).expect("a sensitivity");
            assert!((predicted - exact).abs() < 1e-4, "{d}: {predicted}, {exact}");
        }
    }

    #[test]
    fn answers_of_an_identification_add_up_to_one() {
        let proportions = identified(&ObserverParams::TOUCH, 3.0, &[0.1, 1.0, 3.0, 4.0]);
        assert!((proportions.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn an_observer_without_noise_makes_no_errors() {
        let observer = ObserverParams::NOISE_FREE;
        assert_eq!(colder(&observer, [1.0, 0.9]), 1.0);
        assert_eq!(colder(&observer, [0.9, 1.0]), 0.0);
        assert_eq!(different(&observer, 1.0, 0.9), 1.0);
    }
}
