//! A trial with two intervals: the finger stays on the display, which departs from its base temperature in one or both.

use thermal_client::client::StationRequest;
use thermal_client::link::Link;
use thermal_device::stimulus::PlayOrder;

use super::{Executor, TrialEnd};
use crate::schedule::Next;
use crate::{Cue, Departure, Phase, Presented, Update};

/// Departures below this are none, K: a course has steps of 1 ms.
const DEPARTURE_MIN_K: f64 = 0.002;

/// Force above which a finger is on the display, N.
const ON_DISPLAY_N: f64 = 0.05;

impl<L: Link> Executor<'_, L> {
    /// The trial from the first interval to the answer.
    pub(super) fn intervals(
        &mut self,
        next: &Next<'_>,
        interval_s: f64,
        gap_s: f64,
    ) -> Result<(), TrialEnd> {
        let Some(&Presented::Pulses { device_finger, base_c, departures_k, rate_k_s }) = next
            .trial
            .presented
            .iter()
            .find(|presented| matches!(presented, Presented::Pulses { .. }))
        else {
            return Err(TrialEnd::Void("no station presents pulses".into()));
        };
        self.phase(Phase::Contact);
        self.wait_for_finger(device_finger)?;
        for (index, departure) in (0u8..).zip(departures_k) {
            if index > 0 {
                let gap_end_s = self.now_s() + gap_s;
                self.wait_on_display(device_finger, gap_end_s)?;
            }
            let begin_s = self.now_s();
            self.trial.touch_cue_s.get_or_insert(begin_s);
            self.inform(Update::Cue(Cue::Interval(index)));
            let departure_k = match departure {
                Departure::Fixed(departure_k) => departure_k,
                Departure::Staircase { standard_k, sign } => {
                    standard_k + sign * next.level_k.unwrap_or(0.0)
                }
            };
            if departure_k.abs() >= DEPARTURE_MIN_K {
                let ramps_s = 2.0 * departure_k.abs() / rate_k_s;
                let pulse = StationRequest::Pulse {
                    base_c: base_c.into(),
                    target_c: (base_c + departure_k).into(),
                    rise_k_s: rate_k_s.into(),
                    hold_s: (interval_s - ramps_s).max(0.001).into(),
                    return_k_s: rate_k_s.into(),
                    order: Some(PlayOrder::ONCE_NOW),
                };
                self.command(Some(device_finger), &pulse)?;
            }
            self.wait_on_display(device_finger, begin_s + interval_s)?;
        }
        let now_s = self.now_s();
        self.trial.contact_end_s = Some(now_s);
        self.respond(next.trial)
    }

    /// Lets time pass until a time of the session, s, while the finger must stay on the display.
    fn wait_on_display(&mut self, finger: u8, until_s: f64) -> Result<(), TrialEnd> {
        let has_lifted = |executor: &mut Self| {
            executor.check_force(&[finger]);
            !executor.presses(finger)
        };
        if self.wait_for(until_s, has_lifted)? {
            return Err(TrialEnd::Void("the finger has left the display".into()));
        }
        Ok(())
    }

    /// Whether a finger is on its display.
    fn presses(&self, finger: u8) -> bool {
        let line = self.trial.last_line(finger);
        line.and_then(|line| line.force_n).is_some_and(|force_n| force_n > ON_DISPLAY_N)
    }

    /// Waits for the finger on the display, where it stays from trial to trial.
    fn wait_for_finger(&mut self, finger: u8) -> Result<(), TrialEnd> {
        if !self.presses(finger) {
            self.inform(Update::Instruction("Rest your finger on the display.".into()));
        }
        let land_s = self.session.trial.land_s;
        let until_s = self.now_s() + land_s;
        if self.wait_for(until_s, |executor| executor.presses(finger))? {
            Ok(())
        } else {
            Err(TrialEnd::Void(format!("no finger on the display within {land_s} s")))
        }
    }
}
