//! The thermal dose that a plan gives, known before the first trial.

use contact_model::fixed_point::Celsius;
use thermal_device::safety::{PredictedDose, ThermalDose};
use thermal_device::stimulus::{Course, CourseError, CoursePoint, TemperatureKind};

use crate::{Departure, Plan, PlannedTrial, Presented, Procedure, Session};

/// The first trial in which a display may reach the dose by which it trips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoseReached {
    /// Number of the trial, from 1.
    pub trial: u32,
    /// Finger of the device, from 0.
    pub device_finger: u8,
    /// Dose of the whole plan on that display, minutes at 43 °C (CEM43).
    pub plan_min: f64,
}

impl DoseReached {
    /// The dose by which a device trips, minutes at 43 °C.
    pub const LIMIT_MIN: f64 = minutes(PredictedDose::LIMIT_MS as u64);

    /// Adds up the doses of a plan whose every trial takes its longest time, as if nothing decayed in between; `None` if no
    /// display reaches the limit. A staircase counts with its first level.
    pub fn in_plan(session: &Session, plan: &Plan) -> Option<Self> {
        session.device_fingers().into_iter().find_map(|finger| {
            let doses_ms = plan.trials.iter().map(|trial| (trial, dose_ms(session, trial, finger)));
            let mut sum_ms = 0;
            let mut reached = None;
            for (trial, dose_ms) in doses_ms {
                sum_ms += dose_ms;
                if sum_ms >= u64::from(PredictedDose::LIMIT_MS) && reached.is_none() {
                    reached = Some(trial.number);
                }
            }
            let trial = reached?;
            Some(Self { trial, device_finger: finger, plan_min: minutes(sum_ms) })
        })
    }
}

/// Minutes of milliseconds.
const fn minutes(ms: u64) -> f64 {
    ms as f64 / 60e3
}

/// How long a display that has tripped by its dose must be off, s, before a trial does not make it trip again.
pub(crate) fn decay_before_s(session: &Session, trial: &PlannedTrial, device_finger: u8) -> f64 {
    let dose_ms = dose_ms(session, trial, device_finger).min(PredictedDose::LIMIT_MS.into());
    dose_ms as f64 / 1e3 * f64::from(ThermalDose::DECAY_TIME_RATIO)
}

/// Dose of a trial on a display, ms at 43 °C.
fn dose_ms(session: &Session, trial: &PlannedTrial, device_finger: u8) -> u64 {
    let there = |presented: &&Presented| presented.device_finger() == Some(device_finger);
    let presented = trial.presented.iter().filter(there);
    presented.flat_map(|presented| spans(session, trial, presented)).map(at_temperature_ms).sum()
}

/// Temperatures, °C, and how long at most a display has them in a trial, s: the device cannot know when a finger is there, and
/// counts from the set-up on.
fn spans(session: &Session, trial: &PlannedTrial, presented: &Presented) -> Vec<(f64, f64)> {
    let touch_s = match session.trial.procedure {
        Procedure::Touch { reach_s, max_s, .. } => reach_s + session.trial.land_s + max_s,
        Procedure::Intervals { .. } => 0.0,
    };
    match presented {
        Presented::Nothing | Presented::Sample { .. } => Vec::new(),
        Presented::Hold { celsius, .. } => vec![(*celsius, touch_s)],
        // The surface of the skin lies between that of the skin before and the object.
        Presented::Material { .. } => {
            let object_c = session.device.as_ref().and_then(|device| device.object_c);
            object_c.map(|celsius| (celsius, touch_s)).into_iter().collect()
        }
        Presented::Pulses { base_c, departures_k, .. } => {
            let Procedure::Intervals { interval_s, gap_s } = session.trial.procedure else {
                return Vec::new();
            };
            let level_k = trial
                .staircase
                .and_then(|index| session.staircases.get(index))
                .map_or(0.0, |staircase| staircase.initial.level());
            let departs = departures_k.map(|departure| match departure {
                Departure::Fixed(departure_k) => departure_k,
                Departure::Staircase { standard_k, sign } => standard_k + sign * level_k,
            });
            let intervals = departs.map(|departure_k| (base_c + departure_k.max(0.0), interval_s));
            [(*base_c, session.trial.land_s + gap_s)].into_iter().chain(intervals).collect()
        }
    }
}

/// Dose of a temperature, °C, that lasts for a time, s; ms at 43 °C, as the device counts it.
fn at_temperature_ms((celsius, time_s): (f64, f64)) -> u64 {
    let (_, warmest) = TemperatureKind::Absolute.range();
    // A display is never told to be warmer.
    let temperature = Celsius::saturating_from_num(celsius).min(warmest);
    let mut course = Course::new(TemperatureKind::Absolute);
    for time_ms in [0, (time_s * 1e3) as u32] {
        if course.push(CoursePoint { time_ms, temperature }).is_err() {
            // Below the range nothing is counted, and without time nothing lasts.
            return 0;
        }
    }
    match course.check_whole() {
        Ok(()) => course.dose(Celsius::ZERO).milliseconds_at_43().into(),
        Err(CourseError::TooHotForTooLong(dose_ms)) => dose_ms.into(),
        Err(_) => 0,
    }
}
