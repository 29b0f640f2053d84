//! The gate before a trial: the skin is at its temperature and does not move.

use thermal_client::link::Link;

use super::{Executor, TrialEnd};
use crate::{Decision, OperatorQuestion, Rest, RestPlace, Update};

/// Span of the mean and of the slope, ms.
const SPAN_MS: u32 = 1000;
/// Interval at which the skin is looked at, s.
const POLL_S: f64 = 0.01;
/// Largest slope, K/s.
const SLOPE_MAX_K_S: f64 = 0.02;

impl<L: Link> Executor<'_, L> {
    /// Waits until the skin that all these fingers of the device measure is as the session wants it. Without any only the time
    /// counts.
    pub(super) fn wait_for_skin(&mut self, skin_sensors: &[u8]) -> Result<(), TrialEnd> {
        let Some(rest) = self.session.rest else {
            return Ok(());
        };
        self.inform(Update::Instruction(match rest.place {
            RestPlace::Pad => "Rest your fingers on the pad.".into(),
            RestPlace::Display => "Rest your finger on the display.".into(),
            RestPlace::Air => "Keep your fingers in the air.".into(),
        }));
        let mut holds_since_s = None;
        let mut until_s = self.now_s() + rest.timeout_s;
        loop {
            let now_s = self.now_s();
            let all = (skin_sensors.iter()).all(|finger| self.is_rested(*finger, &rest));
            let since_s = *holds_since_s.get_or_insert(now_s);
            if !all {
                holds_since_s = None;
            } else if now_s - since_s >= rest.for_s {
                return Ok(());
            }
            if now_s >= until_s {
                let skin_c = (skin_sensors.iter())
                    .find(|finger| !self.is_rested(**finger, &rest))
                    .and_then(|finger| self.skin(*finger));
                let decision = self.operator(OperatorQuestion::SkinNotReady {
                    skin_c: skin_c.map(|(mean_c, _)| mean_c),
                    wanted_c: rest.skin_c,
                })?;
                match decision {
                    Decision::Continue => return Ok(()),
                    Decision::Void => return Err(TrialEnd::Void("the skin was not ready".into())),
                    Decision::Wait | Decision::Stop => until_s = self.now_s() + rest.timeout_s,
                }
            }
            self.wait_until(now_s + POLL_S)?;
        }
    }

    fn is_rested(&self, finger: u8, rest: &Rest) -> bool {
        self.skin(finger).is_some_and(|(mean_c, slope_k_s)| {
            (mean_c - rest.skin_c).abs() <= rest.within_k && slope_k_s.abs() <= SLOPE_MAX_K_S
        })
    }

    /// Mean, °C, and slope, K/s, of the skin of a finger over the last second; `None` before it has lasted.
    fn skin(&self, finger: u8) -> Option<(f64, f64)> {
        let lines = self.trial.last_lines(finger, SPAN_MS);
        let (first, last) = lines.first().zip(lines.last())?;
        let stream_ms = self.session.device.as_ref()?.stream_ms;
        if last.tick.saturating_sub(first.tick) + stream_ms < SPAN_MS {
            return None;
        }
        let half = lines.len() / 2;
        let mean = |lines: &[thermal_client::client::Telemetry]| {
            let skins: Option<Vec<f64>> = lines.iter().map(|line| line.skin_c).collect();
            let skins = skins.filter(|skins| !skins.is_empty())?;
            Some(skins.iter().sum::<f64>() / skins.len() as f64)
        };
        let (early_c, late_c) = (mean(&lines[..half])?, mean(&lines[half..])?);
        let half_s = f64::from(SPAN_MS) / 2e3;
        Some((f64::midpoint(early_c, late_c), (late_c - early_c) / half_s))
    }
}
