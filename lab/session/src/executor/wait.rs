//! Waiting: while time passes, telemetry and events come in, and participant and operator press keys.

use std::time::Duration;

use thermal_client::client::{
    ClientError, Command, ReceivedTelemetry, StationRequest, longest_gap,
};
use thermal_client::link::{Link, LinkError};
use thermal_device::StateName;
use thermal_device::events::DeviceEventKind;

use super::{CLOCK_STEP_S, Executor, SessionEnd, TrialEnd, seconds, trial_end_of};
use crate::{Decision, OperatorQuestion, Update};

/// Longest time between two looks at the keys.
const KEY_POLL_INTERVAL: Duration = Duration::from_millis(10);
/// Time by which a wait is longer than it should be if this program did not run, s: a device that is driven has tripped by then.
const STOOD_STILL_S: f64 = 2.0;

impl<L: Link> Executor<'_, L> {
    /// Lets time pass until a time of the session, s.
    pub(super) fn wait_until(&mut self, until_s: f64) -> Result<(), TrialEnd> {
        self.wait_for(until_s, |_| false).map(|_| ())
    }

    /// Waits until a time of the session, s. A trip or missing telemetry voids nothing, because nothing is presented between trials.
    pub(super) fn wait_between_trials(&mut self, until_s: f64) -> Result<(), SessionEnd> {
        loop {
            match self.wait_until(until_s) {
                Ok(()) => return Ok(()),
                Err(TrialEnd::Session(end)) => return Err(end),
                Err(TrialEnd::Void(_) | TrialEnd::Tripped(_)) => {}
            }
        }
    }

    /// Lets time pass until a condition holds, at most until a time of the session, s. Returns whether it holds.
    pub(super) fn wait_for(
        &mut self,
        until_s: f64,
        mut holds: impl FnMut(&mut Self) -> bool,
    ) -> Result<bool, TrialEnd> {
        loop {
            if holds(self) {
                return Ok(true);
            }
            let rest_s = until_s - self.now_s();
            if rest_s < CLOCK_STEP_S / 2.0 {
                return Ok(false);
            }
            let rest = Duration::from_secs_f64(rest_s);
            self.step(rest.min(KEY_POLL_INTERVAL))?;
        }
    }

    /// Lets time pass until the next line of telemetry, at most for `longest`, and takes note of what has come and of what was
    /// pressed.
    fn step(&mut self, longest: Duration) -> Result<(), TrialEnd> {
        match self.people.decision() {
            Some(Decision::Stop) => return Err(SessionEnd::Stopped.into()),
            Some(Decision::Void) if !self.operator_is_asked => {
                return Err(TrialEnd::Void("by the operator".into()));
            }
            Some(decision) => self.decision = Some(decision),
            None => {}
        }
        if let Some(response) = self.people.response()
            && self.trial.is_asked
            && self.trial.response.is_none()
        {
            let now_s = self.now_s();
            self.trial.response = Some((response.clone(), now_s));
            self.trial.is_asked = false;
            self.inform(Update::Answered(Some(response)));
        }
        let begin_s = self.now_s();
        let line = (self.client.next_telemetry(longest)).map_err(SessionEnd::from)?;
        self.take_events();
        let stood_still_s = self.now_s() - begin_s - longest.as_secs_f64();
        if stood_still_s > STOOD_STILL_S {
            if let Some(line) = line {
                self.received(&line);
            }
            return Err(TrialEnd::Void(format!(
                "the computer stood still for {stood_still_s:.1} s"
            )));
        }
        let Some(line) = line else {
            return self.check_silence();
        };
        let follows = self.received(&line);
        if let StateName::Tripped(fault) = line.telemetry.state {
            return Err(TrialEnd::Tripped(fault.name()));
        }
        if !follows {
            return Err(TrialEnd::Void("the device has restarted".into()));
        }
        Ok(())
    }

    /// A device that was asked to stream and does not has restarted or failed.
    fn check_silence(&mut self) -> Result<(), TrialEnd> {
        let (Some(since_s), Some(device)) = (self.streaming_since_s, &self.session.device) else {
            return Ok(());
        };
        let silent_s = self.now_s() - since_s;
        if silent_s > longest_gap(device.stream_ms).as_secs_f64() {
            return Err(TrialEnd::Void(format!("no telemetry for {silent_s:.1} s")));
        }
        Ok(())
    }

    /// Takes note of a line of telemetry; returns whether its tick follows that of the one before.
    fn received(&mut self, line: &ReceivedTelemetry) -> bool {
        self.people.inform(&Update::Telemetry(*line));
        let finger = usize::from(line.finger.unwrap_or(0));
        self.fingers.received(finger, &line.telemetry);
        let at_ns = line.at.as_nanos() as i64 + self.clock_offset_ns;
        self.streaming_since_s = Some(seconds(at_ns));
        self.trial.received(line, at_ns)
    }

    /// Takes note of what has come before the end of the trial and was not looked at yet.
    pub(super) fn take_late_lines(&mut self) -> Result<(), SessionEnd> {
        while let Some(line) = self.client.next_telemetry(Duration::ZERO)? {
            self.received(&line);
        }
        self.take_events();
        Ok(())
    }

    /// Forgets what has come since the last trial ended: lines of a break belong to no trial.
    pub(super) fn drop_late_lines(&mut self) -> Result<(), SessionEnd> {
        while self.client.next_telemetry(Duration::ZERO)?.is_some() {}
        while self.client.take_event().is_some() {}
        Ok(())
    }

    fn take_events(&mut self) {
        while let Some(received) = self.client.take_event() {
            let (finger, event) = (received.finger.unwrap_or(0), received.event);
            match event.kind {
                DeviceEventKind::Land => self.trial.landed(finger, event.tick),
                DeviceEventKind::Lift => self.trial.lifted(finger, event.tick),
                DeviceEventKind::CourseStarted
                | DeviceEventKind::CourseEnded
                | DeviceEventKind::Trigger
                | DeviceEventKind::FingerKnowledge => {}
            }
            self.inform(Update::Event(received));
        }
    }

    /// Asks the operator, and waits for a decision. Trips and restarts meanwhile are found when the device is used next.
    pub(super) fn operator(&mut self, question: OperatorQuestion) -> Result<Decision, SessionEnd> {
        self.decision = None;
        self.operator_is_asked = true;
        self.inform(Update::Decide(question));
        let decided = loop {
            if let Some(decision) = self.decision.take() {
                break Ok(decision);
            }
            match self.step(KEY_POLL_INTERVAL) {
                Err(TrialEnd::Session(end)) => break Err(end),
                Ok(()) | Err(TrialEnd::Void(_) | TrialEnd::Tripped(_)) => {}
            }
        };
        self.operator_is_asked = false;
        if let Ok(decision) = &decided {
            self.inform(Update::Decided(*decision));
        }
        decided
    }

    /// Sends a command to one finger, or to all for `None`.
    pub(super) fn command(
        &mut self,
        finger: Option<u8>,
        command: &impl Command<Answer = ()>,
    ) -> Result<(), TrialEnd> {
        let address = finger.and_then(|finger| self.fingers.address(finger));
        (self.client.ask_finger(address, command)).map_err(trial_end_of)
    }

    /// Switches the bridge off, and then telemetry: a device that streams to nobody switches it off by itself.
    pub(super) fn switch_off(&mut self) -> Result<(), SessionEnd> {
        if !self.session.needs_device() {
            return Ok(());
        }
        self.client.switch_off().map_err(|error| match error {
            ClientError::Link(LinkError::Gone(why)) => SessionEnd::Gone(why),
            error => SessionEnd::NotOff(error),
        })?;
        // The bridge is off; that telemetry goes on for a while harms nobody.
        let _ignored = self.client.ask(&StationRequest::stream(0));
        self.streaming_since_s = None;
        Ok(())
    }
}
