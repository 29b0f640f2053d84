//! The observer: from falls of skin temperature to answers.
//!
//! ```text
//! T_r   skin at 0.16 mm, averaged over 0.2 s
//! T_0   mean of T_r over the last 0.5 s before the first landing
//! x     largest fall T_0 - T_r until the decision, K
//! y     x + g sigma(x) eps, sigma(x) = sqrt(s0^2 + (w x)^2), eps ~ N(0, 1) for each finger and trial
//! ```
//!
//! Cold receptors at this depth encode the fall (sections 2.2 and 3.1 of the thesis). Where the skin gets warmer, the rise at
//! 0.45 mm, the depth of the warm receptors, counts as a negative fall.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::random::Stream;

/// Samples of a millisecond that are averaged.
const AVERAGED: usize = 200;
/// Samples before landing whose mean the fall is relative to.
const BEFORE_LANDING: usize = 500;

/// Noise and decisions of an observer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObserverParams {
    /// Standard deviation of the noise of a fall of zero, K.
    pub s0_k: f64,
    /// Standard deviation of large falls as a fraction of the fall.
    pub w: f64,
    /// Factor on the noise where three fingers of one hand are compared.
    pub three_finger_factor: f64,
    /// Factor on the noise where a material is identified from memory.
    pub identification_factor: f64,
    /// Proportion of trials that are answered without regard to the stimuli.
    pub lapse: f64,
    /// Median of the time from the first landing to the decision, s.
    pub decision_median_s: f64,
    /// Standard deviation of the logarithm of that time.
    pub decision_sigma_ln: f64,
    /// What the last of two stations feels colder by, K.
    pub right_bias_k: f64,
    /// Smallest difference that counts as different, in standard deviations of the difference of two equal falls.
    pub different_from_sd: f64,
}

impl ObserverParams {
    /// Touching materials. Noise, factor of three fingers and lapses are fitted to Tables 3-3 and 3-5 of the thesis together
    /// (35 cells; [`crate::predictions::fit`]); the factor of identification is fitted to both percentages of section 4.2.
    pub const TOUCH: Self = Self {
        s0_k: 0.59,
        w: 0.163,
        three_finger_factor: 1.95,
        identification_factor: 1.62,
        lapse: 0.048,
        decision_median_s: 5.0,
        decision_sigma_ln: 0.3,
        right_bias_k: 0.0,
        different_from_sd: 1.0,
    };

    /// Controlled changes under a fingertip at rest on a thermode: 0.14 K are the threshold (Stevens and Choo in section 3.2.3),
    /// which is 0.954 standard deviations if it is 75 % of a choice between two intervals. The thesis does not say whether it
    /// is, so this is an order of magnitude. The proportion of lapses is assumed.
    pub const THERMODE_FINGERTIP: Self = Self {
        s0_k: 0.147,
        w: 0.0,
        three_finger_factor: 1.0,
        identification_factor: 1.0,
        lapse: 0.02,
        decision_median_s: 1.0,
        ..Self::TOUCH
    };

    /// The same for pulses at the thenar under a large thermode: 0.02 to 0.07 K (section 2.3), of which this is the middle.
    pub const THERMODE_THENAR: Self = Self { s0_k: 0.047, ..Self::THERMODE_FINGERTIP };

    /// No noise and no lapses: whatever differs is told apart.
    pub const NOISE_FREE: Self = Self { s0_k: 0.0, w: 0.0, lapse: 0.0, ..Self::TOUCH };

    /// Every answer is drawn at random.
    pub const RANDOM: Self = Self { lapse: 1.0, ..Self::TOUCH };

    /// Standard deviation of the noise of a fall, K.
    pub fn sigma_k(&self, fall_k: f64) -> f64 {
        libm::hypot(self.s0_k, self.w * fall_k)
    }
}

/// What the observer decides.
#[derive(Clone, Debug, PartialEq)]
pub enum Task {
    /// Which of the stations with these indices feels colder, or warmer; one for each answer.
    Extreme(Sensation, Vec<usize>),
    /// Which of three or more stations differs; one index for each answer.
    Different(Vec<usize>),
    /// Which material it is; the expected fall of each answer, K, from the familiarisation.
    Identify(Vec<f64>),
    /// Whether both stations feel the same: index of the answer `same`, and of `different`.
    Same(usize, usize),
    /// In which of two intervals the change was larger: 1 if it is known to be a fall, -1 if a rise, `None` if it may be either.
    Interval(Option<f64>),
    /// How cold, or warm, each station feels: the numbers of no change and of [`MAGNITUDE_FULL_K`] or more.
    Magnitude(Sensation, f64, f64),
}

/// What a question asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensation {
    /// Falls of the skin's temperature.
    Cold,
    /// Rises.
    Warm,
}

impl Sensation {
    /// The sensations that a question in English names, by words that begin with cold, cool, warm or hot.
    pub fn named(question: &str) -> Vec<Self> {
        let question = question.to_lowercase();
        let words: Vec<_> = question.split(|letter: char| !letter.is_alphabetic()).collect();
        let names = |(_, beginnings): &(Self, [&str; 2])| {
            words.iter().any(|word| beginnings.iter().any(|begin| word.starts_with(begin)))
        };
        let known = [(Self::Cold, ["cold", "cool"]), (Self::Warm, ["warm", "hot"])];
        known.into_iter().filter(names).map(|(sensation, _)| sensation).collect()
    }

    /// A fall as this sensation: positive where it is felt.
    pub const fn of_fall(self, fall_k: f64) -> f64 {
        match self {
            Self::Cold => fall_k,
            Self::Warm => -fall_k,
        }
    }
}

/// Change of the largest magnitude, K: magnitudes are proportional to the change. The rule is an assumption; summation over
/// fingers and referral between them are not modelled.
pub const MAGNITUDE_FULL_K: f64 = 8.0;

/// An answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Judgement {
    /// Index of the answer.
    Choice(usize),
    /// Magnitude of each station.
    Numbers(Vec<f64>),
}

impl Task {
    /// Factor on the noise.
    fn factor(&self, params: &ObserverParams) -> f64 {
        match self {
            Self::Different(_) => params.three_finger_factor,
            Self::Identify(_) => params.identification_factor,
            _ => 1.0,
        }
    }

    /// The judgement of the falls of all stations, or intervals, K; `None` if there is nothing to judge.
    pub fn judge(
        &self,
        falls_k: &[Option<f64>],
        params: &ObserverParams,
        noise: &mut Stream,
        lapses: &mut Stream,
    ) -> Option<Judgement> {
        let factor = self.factor(params);
        let felt_k: Vec<Option<f64>> = falls_k
            .iter()
            .map(|fall_k| {
                let eps = noise.normal();
                fall_k.map(|x| x + factor * params.sigma_k(x) * eps)
            })
            .collect();
        let is_lapse = lapses.between((0.0, 1.0)) < params.lapse;
        let random = lapses.index(self.answers());
        let felt = |station: usize| felt_k.get(station).copied().flatten();
        if let Self::Magnitude(sensation, none, full) = *self {
            let number = |felt_k: Option<f64>| {
                let share = if is_lapse {
                    lapses.between((0.0, 1.0))
                } else {
                    (sensation.of_fall(felt_k.unwrap_or(0.0)) / MAGNITUDE_FULL_K).clamp(0.0, 1.0)
                };
                none + (full - none) * share
            };
            return Some(Judgement::Numbers(felt_k.iter().copied().map(number).collect()));
        }
        if is_lapse {
            return felt_k.iter().any(Option::is_some).then_some(Judgement::Choice(random));
        }
        let choice = match self {
            Self::Extreme(sensation, stations) => {
                let last = stations.iter().max().copied();
                argmax(stations.iter().map(|&station| {
                    let bias_k = if Some(station) == last { params.right_bias_k } else { 0.0 };
                    Some(sensation.of_fall(felt(station)? + bias_k))
                }))
            }
            Self::Different(stations) => {
                let all: Vec<f64> =
                    stations.iter().map(|&station| felt(station)).collect::<Option<_>>()?;
                let mean = all.iter().sum::<f64>() / all.len() as f64;
                argmax(all.iter().map(|felt_k| Some((felt_k - mean).abs())))
            }
            Self::Identify(expected_k) => {
                let felt_k = felt_k.iter().copied().flatten().next()?;
                argmax(expected_k.iter().map(|mean_k| {
                    let sigma_k = factor * params.sigma_k(*mean_k);
                    let off_k = felt_k - mean_k;
                    // Without noise the nearest is the most likely one.
                    Some(if sigma_k > 0.0 {
                        -off_k * off_k / (2.0 * sigma_k * sigma_k) - libm::log(sigma_k)
                    } else {
                        -off_k.abs()
                    })
                }))
            }
            Self::Same(same, different) => {
                let mut both = felt_k.iter().copied().flatten();
                let mut true_k = falls_k.iter().copied().flatten();
                let off_k = (both.next()? - both.next()?).abs();
                let noise_k =
                    libm::hypot(params.sigma_k(true_k.next()?), params.sigma_k(true_k.next()?));
                let is_different = off_k > params.different_from_sd * factor * noise_k;
                Some(if is_different { *different } else { *same })
            }
            Self::Interval(sign) => argmax(felt_k.iter().map(|felt_k| {
                let felt_k = (*felt_k)?;
                Some(sign.map_or(felt_k.abs(), |sign| sign * felt_k))
            })),
            Self::Magnitude(..) => None,
        };
        choice.map(Judgement::Choice)
    }

    /// Number of answers to choose from.
    fn answers(&self) -> usize {
        match self {
            Self::Extreme(_, stations) | Self::Different(stations) => stations.len(),
            Self::Identify(expected_k) => expected_k.len(),
            Self::Same(..) | Self::Interval(_) => 2,
            Self::Magnitude(..) => 1,
        }
    }
}

/// Index of the largest value, the first of equal ones; `None` if one is missing.
fn argmax(values: impl Iterator<Item = Option<f64>>) -> Option<usize> {
    let values: Vec<f64> = values.collect::<Option<_>>()?;
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    values.iter().position(|value| *value == largest)
}

/// Measures the fall of one finger, a sample each millisecond.
#[derive(Clone, Debug, Default)]
pub struct FallMeter {
    /// The last temperatures at the depths of the cold and warm receptors, °C.
    last: VecDeque<[f64; 2]>,
    /// Sums over the averaged ones.
    sums: [f64; 2],
    /// Means before the landing.
    before_c: Option<[f64; 2]>,
    /// Largest fall at the cold receptors and largest rise at the warm ones since the landing, K.
    extremes_k: [f64; 2],
}

impl FallMeter {
    /// Takes the temperatures at the depths of the cold and warm receptors, °C, of another millisecond.
    pub fn push(&mut self, receptors_c: [f64; 2]) {
        self.last.push_back(receptors_c);
        for (sum, c) in self.sums.iter_mut().zip(receptors_c) {
            *sum += c;
        }
        if self.last.len() > AVERAGED {
            let leaving = self.last[self.last.len() - 1 - AVERAGED];
            for (sum, c) in self.sums.iter_mut().zip(leaving) {
                *sum -= c;
            }
        }
        if self.last.len() > BEFORE_LANDING + AVERAGED {
            self.last.pop_front();
        }
        let Some([cold_c, warm_c]) = self.before_c else {
            return;
        };
        let averaged = self.last.len().min(AVERAGED) as f64;
        let [fall_k, rise_k] = &mut self.extremes_k;
        *fall_k = fall_k.max(cold_c - self.sums[0] / averaged);
        *rise_k = rise_k.max(self.sums[1] / averaged - warm_c);
    }

    /// The finger lands now, or an interval begins: falls are relative to the last half second.
    pub fn begin(&mut self) {
        let count = self.last.len().min(BEFORE_LANDING);
        let mut sums = [0.0; 2];
        for receptors_c in self.last.iter().rev().take(count) {
            for (sum, c) in sums.iter_mut().zip(receptors_c) {
                *sum += c;
            }
        }
        self.before_c = (count > 0).then(|| sums.map(|sum| sum / count as f64));
        self.extremes_k = [0.0; 2];
    }

    /// Whether the finger has landed, or an interval has begun.
    pub const fn has_begun(&self) -> bool {
        self.before_c.is_some()
    }

    /// The fall so far, K; negative if the skin got warmer by more. `None` before the landing.
    pub fn fall_k(&self) -> Option<f64> {
        self.before_c?;
        let [fall_k, rise_k] = self.extremes_k;
        Some(if rise_k > fall_k { -rise_k } else { fall_k })
    }
}

#[cfg(test)]
mod tests;
