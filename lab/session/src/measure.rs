//! Measures of a contact from telemetry: of the display that was touched, and of the skin thermistor on the finger.

use crate::record::StationRecord;

/// A line of telemetry of a display at a time of the session.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time of its tick by the session's clock, s.
    pub t_s: f64,
    /// Set-point, °C.
    pub setpoint_c: Option<f64>,
    /// Display thermistor, °C.
    pub display_c: Option<f64>,
    /// Force, N.
    pub force_n: Option<f64>,
    /// Whether the set-point is limited.
    pub is_limited: bool,
}

/// Length of the means before the landing and at the end of the contact, s.
const MEAN_S: f64 = 0.5;
/// Length of the means of the force at the end of the contact, and time before its error counts, s.
const FORCE_S: f64 = 2.0;
/// Relative distance from the target within which a force has settled.
const SETTLED: f64 = 0.1;

/// Mean of a skin thermistor just before `land_s`, °C, and its fall until just before `lift_s`, K. `samples` are times, s, and
/// temperatures, °C.
pub fn skin_fall(samples: &[(f64, f64)], land_s: f64, lift_s: f64) -> (Option<f64>, Option<f64>) {
    let mean_before = |end_s: f64| {
        let inside = samples.iter().filter(|(t_s, _)| (end_s - MEAN_S..end_s).contains(t_s));
        mean(inside.map(|(_, skin_c)| *skin_c))
    };
    let before_c = mean_before(land_s);
    // A contact that is shorter than the mean has no end of its own.
    let after_c = (lift_s - MEAN_S >= land_s).then(|| mean_before(lift_s)).flatten();
    let fall_k = before_c.zip(after_c).map(|(before, after)| before - after);
    (before_c, fall_k)
}

/// What `samples` of a display in the order of their times say of a contact from `land_s` to `lift_s`: everything but the skin.
pub fn measure(
    samples: &[Sample],
    presented: String,
    land_s: Option<f64>,
    lift_s: f64,
    target_force_n: Option<f64>,
) -> StationRecord {
    let Some(land_s) = land_s else {
        return StationRecord { presented, ..StationRecord::default() };
    };
    let within = |from_s: f64, to_s: f64| {
        let inside = move |sample: &&Sample| sample.t_s >= from_s && sample.t_s < to_s;
        samples.iter().filter(inside)
    };
    let contact = || within(land_s, lift_s);
    let force = mean_and_sd(contact().filter_map(|sample| sample.force_n));
    let force_end = mean_and_sd(
        within((lift_s - FORCE_S).max(land_s), lift_s).filter_map(|sample| sample.force_n),
    );
    let at_landing = contact().next();
    let followed = target_force_n.map(|target_n| {
        let late = within(land_s + FORCE_S, lift_s).filter_map(|sample| sample.force_n);
        let error_rms_n = mean(late.map(|force_n| (force_n - target_n).powi(2))).map(f64::sqrt);
        let is_off = |sample: &&Sample| {
            sample.force_n.is_none_or(|force_n| (force_n - target_n).abs() > SETTLED * target_n)
        };
        let last_off = contact().rfind(is_off).copied();
        let settled = match last_off {
            None => Some(0.0),
            // Off at the very end means that it never settled.
            Some(off) => {
                contact().find(|sample| sample.t_s > off.t_s).map(|sample| sample.t_s - land_s)
            }
        };
        // A small force that is near its target only at the very end, between two tremors, has not settled.
        let settled = settled.filter(|settled_s| land_s + settled_s <= lift_s - FORCE_S);
        (error_rms_n, settled)
    });
    StationRecord {
        presented,
        land_s: Some(land_s),
        skin_before_c: None,
        skin_fall_k: None,
        setpoint_c: at_landing.and_then(|sample| sample.setpoint_c),
        display_c: at_landing.and_then(|sample| sample.display_c),
        force_mean_n: force.map(|(mean, _)| mean),
        force_sd_n: force.map(|(_, sd)| sd),
        force_end_mean_n: force_end.map(|(mean, _)| mean),
        force_end_sd_n: force_end.map(|(_, sd)| sd),
        force_error_rms_n: followed.and_then(|(error, _)| error),
        force_settled_s: followed.and_then(|(_, settled)| settled),
        is_limited: at_landing.map(|_| contact().any(|sample| sample.is_limited)),
    }
}

/// The mean; `None` of nothing.
fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    mean_and_sd(values).map(|(mean, _)| mean)
}

/// Mean and standard deviation (of the sample itself); `None` of nothing.
fn mean_and_sd(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let values: Vec<f64> = values.collect();
    if values.is_empty() {
        return None;
    }
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    Some((mean, square.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A finger that lands at 1 s, and whose force rises by 1 N/s to 2 N.
    fn samples() -> Vec<Sample> {
        let sample = |ms: u32| {
            let t_s = f64::from(ms) / 1e3;
            let since_s = (t_s - 1.0).max(0.0);
            Sample {
                t_s,
                setpoint_c: Some(28.0),
                display_c: Some(28.1),
                force_n: Some(since_s.min(2.0)),
                is_limited: (4000..4010).contains(&ms),
            }
        };
        (0..12_000).step_by(10).map(sample).collect()
    }

    fn near(value: Option<f64>, expected: f64) {
        let value = value.expect("measured");
        // A line of telemetry comes every 10 ms.
        assert!((value - expected).abs() < 1.5e-2, "{value} is not {expected}");
    }

    #[test]
    fn means_are_those_of_the_course() {
        let record = measure(&samples(), "copper".into(), Some(1.0), 11.0, Some(2.0));
        near(record.force_mean_n, (2.0 + 2.0 * 8.0) / 10.0);
        near(record.force_end_mean_n, 2.0);
        near(record.force_end_sd_n, 0.0);
        near(record.force_error_rms_n, 0.0);
        // 90 % of 2 N is reached at 1.8 s.
        near(record.force_settled_s, 1.8);
        assert_eq!(record.setpoint_c, Some(28.0));
        assert_eq!(record.is_limited, Some(true));
    }

    #[test]
    fn the_fall_of_the_skin_is_that_of_half_second_means() {
        // From 1 s on the skin falls by 0.5 K/s.
        let samples: Vec<(f64, f64)> = samples()
            .iter()
            .map(|sample| (sample.t_s, 34.0 - 0.5 * (sample.t_s - 1.0).max(0.0)))
            .collect();
        let (before_c, fall_k) = skin_fall(&samples, 1.0, 11.0);
        near(before_c, 34.0);
        // The mean of the last half second is that of 9.75 s after the landing.
        near(fall_k, 0.5 * 9.75);
        assert_eq!(skin_fall(&samples[100..], 1.0, 11.0), (None, None));
    }

    #[test]
    fn a_contact_shorter_than_the_mean_has_no_fall() {
        let samples: Vec<(f64, f64)> = (0..200).map(|i| (f64::from(i) / 1e2, 34.0)).collect();
        let (before_c, fall_k) = skin_fall(&samples, 1.0, 1.4);
        near(before_c, 34.0);
        assert_eq!(fall_k, None);
        assert_eq!(skin_fall(&samples, 1.0, 1.5).1, Some(0.0));
    }

    #[test]
    fn a_force_has_settled_if_it_stays_through_the_last_two_seconds_before_the_tone() {
        // It is within 10 % from 1.8 s after the landing on, at 2.8 s, and the finger lifts at 12 s.
        let settled = |tone_s: f64| {
            measure(&samples(), "copper".into(), Some(1.0), tone_s, Some(2.0)).force_settled_s
        };
        near(settled(4.9), 1.8);
        assert_eq!(settled(4.7), None);
        assert_eq!(settled(3.5), None);
    }

    #[test]
    fn a_force_that_is_off_at_the_end_has_not_settled() {
        let record = measure(&samples(), "copper".into(), Some(1.0), 11.0, Some(3.0));
        assert_eq!(record.force_settled_s, None);
        near(record.force_error_rms_n, 1.0);
    }

    #[test]
    fn nothing_is_known_without_a_landing() {
        let record = measure(&samples(), "copper".into(), None, 11.0, Some(2.0));
        let nothing = StationRecord { presented: "copper".into(), ..StationRecord::default() };
        assert_eq!(record, nothing);
    }
}
