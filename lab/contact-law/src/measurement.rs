//! The measurement at a device: a finger follows the ramps on a display that is held.

use std::cell::Cell;
use std::collections::VecDeque;
use std::time::Duration;

use thermal_client::client::{
    Client, ClientError, QueryDisplaySurface, QueryState, ReceivedTelemetry, SessionRequest,
    StationRequest,
};
use thermal_client::commissioning::{CommissionError, arm};
use thermal_client::link::{Link, LinkError};
use thermal_device::StateName;
use thermal_device::events::DeviceEventKind;
use thermal_device::learning::FingerKnowledge;

use crate::force_tracking::{ForceTracking, ForceTrackingError};
use crate::ramps::{TOTAL_S, force_n};
use crate::recording::{Recording, RecordingError, STEP_S, Sample};

/// Temperature at which the display is held, °C.
pub const HELD_C: f64 = 24.0;
/// Interval of the telemetry, ms.
const STREAM_MS: u32 = (1e3 * STEP_S) as u32;
/// Its fields.
const FIELDS: [&str; 6] = ["skin", "room", "force", "flux", "surface", "finger"];
/// Longest wait for a line of telemetry.
const LINE_TIMEOUT: Duration = Duration::from_millis(500);
/// Longest time in which the finger must be lifted, and the display reach its temperature.
const WAIT_MAX: Duration = Duration::from_secs(120);
/// For how many lines the finger must be lifted.
const LIFTED_LINES: u32 = 100;
/// Distance of the display's surface from the held temperature within which it is there, K, and for how many lines.
const SETTLED_K: f64 = 0.1;
const SETTLED_LINES: u32 = 100;
/// Longest time until the finger must land. It is long because the skin may have to recover for minutes first.
const REST_MAX: Duration = Duration::from_secs(900);
/// Lines that are kept until the landing: the skin's and the room's temperature are means over those before it.
const RECENT_LINES: usize = 100;

/// What the finger does next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Touches nothing.
    Lift,
    /// Stays in still air while the display goes to its temperature: estimate of its surface, °C.
    Wait(Option<f64>),
    /// Rests in still air until the skin has recovered from whatever it touched before, and lands on the display.
    Land,
    /// Follows the ramps.
    Follow {
        /// Time since landing, s.
        since_s: f64,
        /// Force, N.
        force_n: Option<f64>,
    },
    /// Lifts; the recording is complete.
    End,
}

impl Step {
    /// Force to press with, N.
    pub fn target_n(&self) -> f64 {
        match self {
            Self::Lift | Self::Wait(_) | Self::End => 0.0,
            Self::Land => force_n(0.0).unwrap_or(0.0),
            Self::Follow { since_s, .. } => force_n(since_s.min(TOTAL_S)).unwrap_or(0.0),
        }
    }
}

/// How a contact law is measured.
#[derive(Clone, Copy, Debug)]
pub struct MeasurementOptions {
    /// The finger of a device with several.
    pub finger: Option<u8>,
    /// Whether the heat-flux sensor's zero is taken before.
    pub takes_zero: bool,
}

/// A recording, and how well the force followed the ramps.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// The recording.
    pub recording: Recording,
    /// How well the force followed.
    pub force_tracking: ForceTracking,
}

/// Why there is no recording. The bridge is off, unless the link is gone.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeasurementError {
    /// A command has no reply.
    #[error(transparent)]
    Client(#[from] ClientError),
    /// The device is not armed.
    #[error("the display cannot be driven: {0}")]
    NotArmed(#[from] CommissionError),
    /// There is no heat-flux sensor.
    #[error("the device has no heat-flux sensor, or none is set (`flux set`)")]
    NoSensor,
    /// The sensor cannot be right.
    #[error(
        "the heat-flux sensor's code is at a rail or does not change{}: look at its wires",
        .0.map_or(String::new(), |since_s| format!(" {since_s:.2} s after landing"))
    )]
    SensorFault(Option<f64>),
    /// Telemetry does not come.
    #[error("no telemetry within {} s", LINE_TIMEOUT.as_secs_f64())]
    Silent,
    /// A wait took too long.
    #[error("{what} within {} s", time.as_secs())]
    TooLong {
        /// What did not happen.
        what: &'static str,
        /// How long was waited.
        time: Duration,
    },
    /// The device has tripped.
    #[error("the device has tripped: {0}")]
    Tripped(&'static str),
    /// The device does not hold the display any more.
    #[error(
        "the device is in the state {0} and does not hold the display; another program has commanded it"
    )]
    NotHeld(&'static str),
    /// Lines of telemetry are missing.
    #[error("{lost} lines of telemetry are missing {since_s:.2} s after landing")]
    Lost {
        /// How many.
        lost: u32,
        /// Time since landing, s.
        since_s: f64,
    },
    /// The finger has lifted.
    #[error("the finger has lifted {since_s:.2} s after landing; the ramps take {TOTAL_S} s")]
    Lifted {
        /// Time since landing, s.
        since_s: f64,
    },
    /// A reading is not known.
    #[error("{what} is not known {since_s:.2} s after landing")]
    Unknown {
        /// The reading.
        what: &'static str,
        /// Time since landing, s; 0 also before it.
        since_s: f64,
    },
    /// The force did not follow the ramps.
    #[error(transparent)]
    NotFollowed(#[from] ForceTrackingError),
    /// The recording does not pass its check.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

impl From<LinkError> for MeasurementError {
    fn from(error: LinkError) -> Self {
        Self::Client(error.into())
    }
}

/// Records a finger that follows the ramps, and switches the bridge off. `guide` is called with each step, at least every 10 ms, and
/// tells the finger what to do; it may move a simulated one.
///
/// # Errors
/// The device has no sound heat-flux sensor, refuses a line or trips; the finger does not land or lifts too soon; samples are missing;
/// the force did not follow.
pub fn measure<L: Link>(
    client: &mut Client<L>,
    options: &MeasurementOptions,
    guide: &mut dyn FnMut(&mut Client<L>, &Step),
) -> Result<Measurement, MeasurementError> {
    let recorded =
        Session { client, finger: options.finger, guide, recent: VecDeque::new() }.record(options);
    // Also after a failure: the bridge may be driven.
    let ended = client.abort_and_end_stream(options.finger);
    let no_events = client.ask_finger(options.finger, &StationRequest::events(false));
    let recording = recorded?;
    ended.and(no_events)?;
    recording.check()?;
    let force_tracking = ForceTracking::of(&recording)?;
    Ok(Measurement { recording, force_tracking })
}

struct Session<'a, L> {
    client: &'a mut Client<L>,
    finger: Option<u8>,
    guide: &'a mut dyn FnMut(&mut Client<L>, &Step),
    /// The last lines: a landing is reported after the force rose.
    recent: VecDeque<ReceivedTelemetry>,
}

impl<L: Link> Session<'_, L> {
    fn record(&mut self, options: &MeasurementOptions) -> Result<Recording, MeasurementError> {
        let finger = self.finger;
        let report = self.client.flux_report(finger)?;
        let sensor = report.ok_or(MeasurementError::NoSensor)?.sensor;
        let display = self.client.ask_finger(finger, &QueryDisplaySurface)?.surface;
        let state = self.client.ask_finger(finger, &QueryState)?.state;
        if let Some(fault) = state.fault() {
            return Err(MeasurementError::Tripped(fault.name()));
        }
        self.client.ask_finger(finger, &StationRequest::stream_fields(STREAM_MS, &FIELDS))?;
        self.client.ask_finger(finger, &StationRequest::events(true))?;
        self.wait_for_lifting()?;
        if options.takes_zero {
            self.client.ask_finger(finger, &SessionRequest::FluxZero)?;
        }
        arm(self.client, finger)?;
        self.client.ask_finger(finger, &StationRequest::hold(HELD_C, None))?;
        self.settle()?;
        let ([skin_c, room_c], samples) = self.follow()?;
        Ok(Recording {
            skin_c,
            room_c,
            display: *display.surface(),
            layer_m2k_w: 1e-6 * sensor.resistance_mm2k_w,
            samples,
        })
    }

    /// The next line of telemetry, after the guide has been called.
    fn next(&mut self, step: &Step) -> Result<ReceivedTelemetry, MeasurementError> {
        (self.guide)(self.client, step);
        let line = (self.client).next_telemetry_of(self.finger, LINE_TIMEOUT)?;
        let line = line.ok_or(MeasurementError::Silent)?;
        if let Some(fault) = line.telemetry.state.fault() {
            return Err(MeasurementError::Tripped(fault.name()));
        }
        self.recent.push_back(line);
        if self.recent.len() > RECENT_LINES {
            self.recent.pop_front();
        }
        Ok(line)
    }

    /// Calls `is_done` with lines until it says so, for so long at most.
    fn wait(
        &mut self,
        (what, time): (&'static str, Duration),
        mut step: impl FnMut() -> Step,
        mut is_done: impl FnMut(&mut Self, &ReceivedTelemetry) -> Result<bool, MeasurementError>,
    ) -> Result<(), MeasurementError> {
        let end = self.client.link().now() + time;
        loop {
            let line = self.next(&step())?;
            if is_done(self, &line)? {
                return Ok(());
            }
            if self.client.link().now() > end {
                return Err(MeasurementError::TooLong { what, time });
            }
        }
    }

    fn wait_for_lifting(&mut self) -> Result<(), MeasurementError> {
        let mut lifted = 0;
        self.wait(
            ("the finger was not lifted", WAIT_MAX),
            || Step::Lift,
            |_, line| {
                if line.telemetry.known == Some(FingerKnowledge::SensorFault) {
                    return Err(MeasurementError::SensorFault(None));
                }
                let is_lifted = line.telemetry.is_lifted() == Some(true);
                lifted = if is_lifted { lifted + 1 } else { 0 };
                Ok(lifted >= LIFTED_LINES)
            },
        )
    }

    /// Waits until the display has its temperature.
    fn settle(&mut self) -> Result<(), MeasurementError> {
        let (mut settled, surface_c) = (0, Cell::new(None));
        self.wait(
            ("the display did not reach its temperature without a finger on it", WAIT_MAX),
            || Step::Wait(surface_c.get()),
            |_, line| {
                surface_c.set(line.telemetry.surface_c);
                let is_there = (surface_c.get()).is_some_and(|c| (c - HELD_C).abs() < SETTLED_K);
                let is_lifted = line.telemetry.is_lifted() == Some(true);
                settled = if is_there && is_lifted { settled + 1 } else { 0 };
                Ok(settled >= SETTLED_LINES)
            },
        )
    }

    /// Waits for the landing; returns its tick.
    fn land(&mut self) -> Result<u32, MeasurementError> {
        while self.client.take_event().is_some() {}
        let mut landed = None;
        self.wait(
            ("the finger did not land", REST_MAX),
            || Step::Land,
            |session, _| {
                landed = session.event(DeviceEventKind::Land);
                Ok(landed.is_some())
            },
        )?;
        Ok(landed.unwrap_or_default())
    }

    /// Records the ramps from the landing on: temperatures of skin and room before it, °C, and the samples.
    fn follow(&mut self) -> Result<([f64; 2], Vec<Sample>), MeasurementError> {
        let landed = self.land()?;
        let mut lines = std::mem::take(&mut self.recent);
        let since_s = |line: &ReceivedTelemetry| {
            f64::from(line.telemetry.tick.wrapping_sub(landed) as i32) * 1e-3
        };
        let before: Vec<_> = lines.iter().filter(|line| since_s(line) <= 0.0).collect();
        let mean_c = |what, of: fn(&ReceivedTelemetry) -> Option<f64>| {
            let known: Vec<f64> = before.iter().filter_map(|line| of(line)).collect();
            let unknown = MeasurementError::Unknown { what, since_s: 0.0 };
            let mean_c = known.iter().sum::<f64>() / known.len() as f64;
            if known.is_empty() { Err(unknown) } else { Ok(mean_c) }
        };
        let temperatures_c = [
            mean_c("the skin", |line| line.telemetry.skin_c)?,
            mean_c("the room", |line| line.telemetry.room_c)?,
        ];
        let mut samples: Vec<Sample> = Vec::new();
        loop {
            let line = match lines.pop_front() {
                Some(line) => line,
                None => {
                    let last = samples.last();
                    self.next(&Step::Follow {
                        since_s: last.map_or(0.0, |sample| sample.since_s) + STEP_S,
                        force_n: last.map(|sample| sample.force_n),
                    })?
                }
            };
            let since_s = since_s(&line);
            if since_s <= 0.0 {
                continue;
            }
            if since_s > TOTAL_S {
                (self.guide)(self.client, &Step::End);
                return Ok((temperatures_c, samples));
            }
            samples.push(sample(&line, since_s)?);
            if self.event(DeviceEventKind::Lift).is_some() {
                return Err(MeasurementError::Lifted { since_s });
            }
        }
    }

    /// The tick of an event of the finger.
    fn event(&mut self, kind: DeviceEventKind) -> Option<u32> {
        while let Some(received) = self.client.take_event() {
            let is_ours =
                self.finger.is_none() || received.finger.is_none_or(|of| Some(of) == self.finger);
            if is_ours && received.event.kind == kind {
                return Some(received.event.tick);
            }
        }
        None
    }
}

/// The sample of a line.
fn sample(line: &ReceivedTelemetry, since_s: f64) -> Result<Sample, MeasurementError> {
    let telemetry = &line.telemetry;
    if telemetry.state != StateName::Stimulus {
        return Err(MeasurementError::NotHeld(telemetry.state.name()));
    }
    let lost = line.lost_before;
    if lost > 0 {
        return Err(MeasurementError::Lost { lost, since_s });
    }
    let flux_w_m2 = telemetry.flux_w_m2.ok_or(MeasurementError::SensorFault(Some(since_s)))?;
    let known = |value: Option<f64>, what| value.ok_or(MeasurementError::Unknown { what, since_s });
    Ok(Sample {
        since_s,
        flux_w_m2,
        surface_c: known(telemetry.surface_c, "the display's surface")?,
        force_n: known(telemetry.force_n, "the force")?,
    })
}
