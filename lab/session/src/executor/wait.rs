//! Waiting: while time passes, telemetry and events come in, and participant and operator press keys.

use std::time::Duration;

use thermal_client::client::{PlainCommand, ReceivedTelemetry};
use thermal_client::link::Link;
use thermal_device::StateName;
use thermal_device::events::DeviceEventKind;

use super::{Executor, SessionEnd, TrialEnd, unanswered};
use crate::{Decision, OperatorQuestion, Update};

/// Longest time between two looks at the keys.
const SLICE: Duration = Duration::from_millis(10);

impl<L: Link> Executor<'_, L> {
    /// Lets time pass until a time of the session, s.
    pub(super) fn wait_until(&mut self, until_s: f64) -> Result<(), TrialEnd> {
        while self.now_s() < until_s {
            self.step()?;
        }
        Ok(())
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
            if self.now_s() >= until_s {
                return Ok(false);
            }
            self.step()?;
        }
    }

    /// Lets time pass until the next line of telemetry, at most 10 ms, and takes note of what has come.
    pub(super) fn step(&mut self) -> Result<(), TrialEnd> {
        match self.people.decision() {
            Some(Decision::Stop) => return Err(SessionEnd::Stopped.into()),
            Some(Decision::Void) => return Err(TrialEnd::Void("by the operator".into())),
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
        let line = self
            .client
            .next_telemetry(SLICE)
            .map_err(SessionEnd::from)?;
        self.take_events();
        let Some(line) = line else {
            return Ok(());
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

    /// Takes note of a line of telemetry; returns whether its tick follows that of the one before.
    fn received(&mut self, line: &ReceivedTelemetry) -> bool {
        self.people.inform(&Update::Telemetry(*line));
        let finger = usize::from(line.finger.unwrap_or(0));
        self.fingers.received(finger, &line.telemetry);
        let at_ns = line.at.as_nanos() as i64 + self.clock_offset_ns;
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
                | DeviceEventKind::Trigger => {}
            }
            self.inform(Update::Event(received));
        }
    }

    /// Asks the operator, and waits for a decision.
    pub(super) fn operator(&mut self, question: OperatorQuestion) -> Result<Decision, SessionEnd> {
        self.decision = None;
        self.inform(Update::Decide(question));
        self.outside_of_trials(|executor| {
            loop {
                if let Some(decision) = executor.decision.take() {
                    return Ok(decision);
                }
                executor.step()?;
            }
        })
    }

    /// Does something during which trips and restarts of the device do not matter, and a decision for a void trial neither.
    pub(super) fn outside_of_trials<T>(
        &mut self,
        mut work: impl FnMut(&mut Self) -> Result<T, TrialEnd>,
    ) -> Result<T, SessionEnd> {
        loop {
            match work(self) {
                Ok(done) => return Ok(done),
                Err(TrialEnd::Session(end)) => return Err(end),
                Err(TrialEnd::Void(_) | TrialEnd::Tripped(_)) => {}
            }
        }
    }

    /// Sends a command to one finger, or to all for `None`.
    pub(super) fn command(
        &mut self,
        finger: Option<u8>,
        command: &PlainCommand,
    ) -> Result<(), TrialEnd> {
        let address = finger.and_then(|finger| self.fingers.address(finger));
        (self.client.ask_finger(address, command)).map_err(unanswered)
    }

    /// Switches the bridge off and telemetry too, if there is a device.
    pub(super) fn switch_off(&mut self) -> Result<(), SessionEnd> {
        if self.fingers.count() == 0 {
            return Ok(());
        }
        let off = [PlainCommand::Abort, PlainCommand::stream(0)];
        match off
            .iter()
            .try_for_each(|command| self.command(None, command))
        {
            Err(TrialEnd::Session(end)) => Err(end),
            // A device that refuses has its bridge off.
            _ => Ok(()),
        }
    }
}
