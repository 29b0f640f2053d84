//! Brings the device from any state to the one that a trial needs.

use thermal_client::client::{QueryState, StationRequest, Telemetry};
use thermal_client::link::Link;
use thermal_device::StateName;

use super::{Executor, TrialEnd, trial_end_of};
use crate::{DeviceSetup, OperatorQuestion, Phase, PlannedTrial, Presented, Procedure, RestPlace};

/// Longest time from `arm` until the device is armed, s; a self-test under a finger takes 1.8 s.
const ARM_S: f64 = 5.0;
/// Distance of the display from its set-point at which it waits, K, for how long, s, and the longest time until then, s.
const AT_SETPOINT_K: f64 = 0.1;
const AT_SETPOINT_MS: u32 = 300;
const PREPARE_S: f64 = 20.0;
/// Distance of a set-point from the temperature that is to be held at which it has arrived, K.
const ARRIVED_K: f64 = 0.01;
/// Least time from the begin of the trial until an object is presented, s: ten time constants of the device's filter of the skin,
/// which begins when it is armed.
const SKIN_FILTER_SETTLE_S: f64 = 2.6;

impl<L: Link> Executor<'_, L> {
    /// Sets the device up for a trial, and arms its displays; then tells the operator what goes where, and waits for the skin.
    pub(super) fn set_up_device(&mut self, trial: &PlannedTrial) -> Result<(), TrialEnd> {
        let session = self.session;
        let displays: Vec<u8> = device_fingers(trial).collect();
        let skin_sensors = session.skin_sensors(trial);
        // A finger that only measures the skin is not armed: it reports with its bridge off.
        let reporting = session.reporting_fingers(trial);
        for finger in 0..self.fingers.count() as u8 {
            if !displays.contains(&finger) {
                self.command(Some(finger), &StationRequest::Abort)?;
            }
            if !reporting.contains(&finger) {
                self.command(Some(finger), &StationRequest::stream(0))?;
            }
        }
        if let Some(device) = &session.device
            && !reporting.is_empty()
        {
            self.command(None, &StationRequest::events(true))?;
            if !displays.is_empty() {
                self.choose_rendering(device)?;
            }
            for finger in &reporting {
                let stream = self.fingers.fields(*finger).stream(device.stream_ms);
                self.command(Some(*finger), &stream)?;
            }
            let now_s = self.now_s();
            self.streaming_since_s = Some(now_s);
            self.choose_materials(trial)?;
        } else {
            self.streaming_since_s = None;
        }
        // A finger that stays on the display from trial to trial is not disturbed.
        if !self.finger_stays_on_display(&displays)? {
            self.arm(&displays)?;
            self.wait_for_free_displays(&displays)?;
            self.hold_rest_temperature(&displays)?;
            self.phase(Phase::Rest);
            self.place_samples(trial)?;
            self.wait_for_skin(&skin_sensors)?;
        }
        self.phase(Phase::Prepare);
        self.present(trial, &displays)
    }

    /// Whether the fingers stay on displays that have presented intervals in the trial before.
    fn finger_stays_on_display(&mut self, displays: &[u8]) -> Result<bool, TrialEnd> {
        if !matches!(self.session.trial.procedure, Procedure::Intervals { .. }) {
            return Ok(false);
        }
        for finger in displays {
            let address = self.fingers.address(*finger);
            let status = self.client.ask_finger(address, &QueryState).map_err(trial_end_of)?;
            if status.state != StateName::Stimulus {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Brings displays on which the fingers rest to the temperature of the rest, before a finger is put on them.
    fn hold_rest_temperature(&mut self, displays: &[u8]) -> Result<(), TrialEnd> {
        let Some(rest) = self.session.rest.filter(|rest| rest.place == RestPlace::Display) else {
            return Ok(());
        };
        self.fingers.forget_states();
        for finger in displays {
            self.command(Some(*finger), &StationRequest::hold(rest.skin_c, None))?;
        }
        self.wait_for_setpoints(displays, |_| Some(rest.skin_c))
    }

    /// How all displays render.
    fn choose_rendering(&mut self, device: &DeviceSetup) -> Result<(), TrialEnd> {
        for command in [
            StationRequest::Law { law: device.law },
            StationRequest::Mode { model: device.mode },
            StationRequest::Finger { finger: device.assumed_finger },
            StationRequest::skin(device.assumed_skin_c),
            StationRequest::object_temperature(device.object_c),
        ] {
            self.command(None, &command)?;
        }
        Ok(())
    }

    fn choose_materials(&mut self, trial: &PlannedTrial) -> Result<(), TrialEnd> {
        for presented in &trial.presented {
            if let Presented::Material { device_finger, material } = presented {
                let mut own = self.session.materials.iter();
                let command = match own.find(|(name, _)| name == material) {
                    Some((_, properties)) => StationRequest::custom_material(properties),
                    None => StationRequest::material(material),
                };
                self.command(Some(*device_finger), &command)?;
            }
        }
        Ok(())
    }

    /// Arms the displays and waits until they are driven to skin temperature.
    pub(super) fn arm(&mut self, displays: &[u8]) -> Result<(), TrialEnd> {
        self.fingers.forget_states();
        for finger in displays {
            self.command(Some(*finger), &StationRequest::Arm)?;
        }
        let until_s = self.now_s() + ARM_S;
        let is_armed = |executor: &mut Self| {
            let mut all = displays.iter();
            all.all(|finger| executor.fingers.state(*finger) == Some(StateName::Armed))
        };
        if self.wait_for(until_s, is_armed)? {
            Ok(())
        } else {
            Err(TrialEnd::Void(format!("the device is not armed {ARM_S} s after `arm`")))
        }
    }

    /// Tells the operator which samples go where.
    fn place_samples(&mut self, trial: &PlannedTrial) -> Result<(), TrialEnd> {
        let stations = self.session.stations.iter().zip(&trial.presented);
        let samples: Vec<_> = stations
            .filter(|(_, presented)| matches!(presented, Presented::Sample { .. }))
            .map(|(station, presented)| format!("{}: {presented}", station.name))
            .collect();
        if !samples.is_empty() {
            self.operator(OperatorQuestion::Ready(samples.join("; ")))?;
        }
        Ok(())
    }

    /// Lets the displays present their stimuli, and waits until they are ready for the finger.
    fn present(&mut self, trial: &PlannedTrial, displays: &[u8]) -> Result<(), TrialEnd> {
        if displays.is_empty() {
            return Ok(());
        }
        let since_s = self.trial.begin_s();
        self.wait_until(since_s + SKIN_FILTER_SETTLE_S)?;
        self.fingers.forget_states();
        for presented in &trial.presented {
            match *presented {
                Presented::Nothing | Presented::Sample { .. } => {}
                Presented::Material { device_finger, .. } => {
                    self.command(Some(device_finger), &StationRequest::Start)?;
                }
                Presented::Hold { device_finger, celsius } => {
                    self.command(Some(device_finger), &StationRequest::hold(celsius, None))?
                }
                Presented::Pulses { device_finger, base_c, .. } => {
                    self.command(Some(device_finger), &StationRequest::hold(base_c, None))?
                }
            }
        }
        self.wait_for_setpoints(displays, |finger| {
            let mut all = trial.presented.iter();
            all.find_map(|presented| match *presented {
                Presented::Hold { device_finger, celsius } if device_finger == finger => {
                    Some(celsius)
                }
                Presented::Pulses { device_finger, base_c, .. } if device_finger == finger => {
                    Some(base_c)
                }
                _ => None,
            })
        })
    }

    /// Waits until all displays are at their set-points, which for a finger of whom `held_c` says so has this temperature, °C.
    fn wait_for_setpoints(
        &mut self,
        displays: &[u8],
        held_c: impl Fn(u8) -> Option<f64>,
    ) -> Result<(), TrialEnd> {
        let until_s = self.now_s() + PREPARE_S;
        let is_ready = |executor: &mut Self| {
            let mut all = displays.iter();
            all.all(|finger| executor.is_at_setpoint(*finger, held_c(*finger)))
        };
        if self.wait_for(until_s, is_ready)? {
            Ok(())
        } else {
            let why = format!("the display is not at its set-point after {PREPARE_S} s");
            Err(TrialEnd::Void(why))
        }
    }

    /// Whether a display presents its stimulus and has been at its set-point for some time. The set-point of a `hold` moves until
    /// it is at `held_c`, °C.
    fn is_at_setpoint(&self, finger: u8, held_c: Option<f64>) -> bool {
        let presents = matches!(
            self.fingers.state(finger),
            Some(StateName::Preset | StateName::Contact | StateName::Stimulus)
        );
        let lines = self.trial.last_lines(finger, AT_SETPOINT_MS);
        let span_ms = (lines.first().zip(lines.last()))
            .map_or(0, |(first, last)| last.tick.saturating_sub(first.tick));
        let stream_ms = self.session.device.as_ref().map_or(0, |device| device.stream_ms);
        let near = |line: &Telemetry| {
            let off = line
                .display_c
                .zip(line.setpoint_c)
                .map(|(display, setpoint)| (display - setpoint).abs());
            let arrived = match held_c {
                Some(held_c) => {
                    line.state == StateName::Stimulus
                        && (line.setpoint_c)
                            .is_some_and(|setpoint| (setpoint - held_c).abs() <= ARRIVED_K)
                }
                None => matches!(line.state, StateName::Preset | StateName::Contact),
            };
            arrived && off.is_some_and(|off_k| off_k <= AT_SETPOINT_K)
        };
        presents && span_ms + stream_ms >= AT_SETPOINT_MS && lines.iter().all(near)
    }
}

/// The fingers of the device whose displays a trial uses.
pub(super) fn device_fingers(trial: &PlannedTrial) -> impl Iterator<Item = u8> {
    trial.presented.iter().filter_map(Presented::device_finger)
}
