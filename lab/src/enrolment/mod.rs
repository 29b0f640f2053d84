//! Enrolment: a person's finger is learnt from contacts with two or more objects, and stored by a code.

mod screen;

use std::time::Duration;

use contact_model::contact_law::ContactLaw;
use thermal_client::client::{
    Client, ClientError, Command, EnrolPerson, PersonReport, PersonRequest, QueryContactLaw,
    ReceivedTelemetry, SessionRequest, StationRequest,
};
use thermal_client::commissioning::{CommissionError, arm};
use thermal_client::link::{Link, LinkError};
use thermal_device::learning::FingerKnowledge;
use thermal_settings::PersonCode;

/// Length of a contact, s: the device stores what it has learnt from contacts of 8 s or more.
pub const CONTACT_S: f64 = 10.0;
/// Time in still air before each contact, s, in which the skin recovers from the last one.
pub const REST_S: f64 = 10.0;
/// Interval of the telemetry, ms, and its fields.
const STREAM_MS: u32 = 20;
const FIELDS: [&str; 2] = ["force", "finger"];
/// Longest wait for a line of telemetry.
const LINE_TIMEOUT: Duration = Duration::from_millis(500);
/// Longest time in which the finger must land, or lift and stay lifted.
const WAIT_MAX: Duration = Duration::from_secs(120);
/// The device's word about a finger that it has learnt.
const TRUSTED: &str = "trusted";

/// What the finger does next.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Stays in still air: time left, s.
    Rest(f64),
    /// Lands on this object.
    Touch(String),
    /// Rests on it: time left, s, and force, N.
    Press(f64, Option<f64>),
}

/// Who is enrolled, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct EnrolmentOptions {
    /// Stands for the person.
    pub code: PersonCode,
    /// The finger of a device with several.
    pub finger: Option<u8>,
    /// Whether the heat-flux sensor's zero is taken before.
    pub takes_zero: bool,
    /// Materials of the objects, one for each contact.
    pub objects: Vec<String>,
}

/// Why nobody was enrolled. The bridge is off, unless the link is gone.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EnrolmentError {
    /// A command has no reply, or was refused.
    #[error(transparent)]
    Client(#[from] ClientError),
    /// The device is not armed.
    #[error("the display cannot be driven: {0}")]
    NotArmed(#[from] CommissionError),
    /// There is no heat-flux sensor.
    #[error("the device has no heat-flux sensor, or none is set (`flux set`)")]
    NoSensor,
    /// A measured contact law is set.
    #[error(
        "a contact law is set; what is learnt of a person holds with the nominal one only (`contact nominal`)"
    )]
    OtherContactLaw,
    /// Telemetry does not come.
    #[error("no telemetry within {} s", LINE_TIMEOUT.as_secs_f64())]
    Silent,
    /// The device has tripped.
    #[error("the device has tripped: {0}")]
    Tripped(&'static str),
    /// A wait took too long.
    #[error("the finger did not {what} within {} s", WAIT_MAX.as_secs())]
    TooLong {
        /// What it did not do.
        what: &'static str,
    },
    /// The finger has lifted.
    #[error(
        "the finger has lifted after {since_s:.1} s on {object}; a contact takes {CONTACT_S} s"
    )]
    Lifted {
        /// The object.
        object: String,
        /// Time since landing, s.
        since_s: f64,
    },
    /// The device does not trust what it has learnt.
    #[error(
        "the device does not trust what it learnt on {object}: {word}; let the finger rest for some minutes, press with 1 to 3 N, dry, and begin anew"
    )]
    NotTrusted {
        /// The object.
        object: String,
        /// The device's word about the finger.
        word: &'static str,
    },
}

impl From<LinkError> for EnrolmentError {
    fn from(error: LinkError) -> Self {
        Self::Client(error.into())
    }
}

/// Enrols a person, and switches the bridge off. `guide` is called with each step, at least every 20 ms, and tells the finger what
/// to do; it may move a simulated one.
///
/// # Errors
/// The device has no sensor, refuses a line, trips, or does not trust the finger; the finger does not land or lifts too soon.
pub fn enrol<L: Link>(
    client: &mut Client<L>,
    options: &EnrolmentOptions,
    guide: &mut dyn FnMut(&mut Client<L>, &Step),
) -> Result<PersonReport, EnrolmentError> {
    let finger = options.finger;
    let done = Session { client, finger, guide }.enrol(options);
    // Also after a failure: the bridge may be driven.
    let ended = client.abort_and_end_stream(finger);
    let report = done?;
    ended?;
    Ok(report)
}

struct Session<'a, L> {
    client: &'a mut Client<L>,
    finger: Option<u8>,
    guide: &'a mut dyn FnMut(&mut Client<L>, &Step),
}

impl<L: Link> Session<'_, L> {
    fn send(&mut self, command: &impl Command<Answer = ()>) -> Result<(), EnrolmentError> {
        Ok(self.client.ask_finger(self.finger, command)?)
    }

    fn enrol(&mut self, options: &EnrolmentOptions) -> Result<PersonReport, EnrolmentError> {
        let sensor = self.client.flux_report(self.finger)?;
        sensor.ok_or(EnrolmentError::NoSensor)?;
        if self.client.ask_finger(self.finger, &QueryContactLaw)?.law != ContactLaw::NOMINAL {
            return Err(EnrolmentError::OtherContactLaw);
        }
        self.send(&StationRequest::stream_fields(STREAM_MS, &FIELDS))?;
        self.rest()?;
        if options.takes_zero {
            self.send(&SessionRequest::FluxZero)?;
        }
        self.send(&PersonRequest::ChooseNobody)?;
        for (number, object) in options.objects.iter().enumerate() {
            self.send(&StationRequest::material(object))?;
            if number == 0 {
                arm(self.client, self.finger)?;
                self.send(&StationRequest::Start)?;
            }
            self.touch(object)?;
            self.rest()?;
        }
        Ok((self.client).ask_finger(self.finger, &EnrolPerson { code: options.code })?)
    }

    /// The next line of telemetry, after the guide has been called.
    fn next(&mut self, step: &Step) -> Result<ReceivedTelemetry, EnrolmentError> {
        (self.guide)(self.client, step);
        let line = (self.client).next_telemetry_of(self.finger, LINE_TIMEOUT)?;
        let line = line.ok_or(EnrolmentError::Silent)?;
        match line.telemetry.state.fault() {
            Some(fault) => Err(EnrolmentError::Tripped(fault.name())),
            None => Ok(line),
        }
    }

    /// Waits until the finger has been in still air for [`REST_S`].
    fn rest(&mut self) -> Result<(), EnrolmentError> {
        let begun = self.client.link().now();
        let mut lifted_at = None;
        loop {
            let now = self.client.link().now();
            let rested_s =
                lifted_at.map_or(0.0, |at: Duration| now.saturating_sub(at).as_secs_f64());
            if rested_s >= REST_S {
                return Ok(());
            }
            if now > begun + WAIT_MAX {
                return Err(EnrolmentError::TooLong { what: "stay lifted" });
            }
            let line = self.next(&Step::Rest(REST_S - rested_s))?;
            let is_lifted = line.telemetry.is_lifted() == Some(true);
            lifted_at = lifted_at.or(Some(now)).filter(|_| is_lifted);
        }
    }

    /// Waits for a landing on the object and for the contact's length.
    fn touch(&mut self, object: &str) -> Result<(), EnrolmentError> {
        let begun = self.client.link().now();
        let step = Step::Touch(object.into());
        while self.next(&step)?.telemetry.is_lifted() != Some(false) {
            if self.client.link().now() > begun + WAIT_MAX {
                return Err(EnrolmentError::TooLong { what: "land" });
            }
        }
        let landed = self.client.link().now();
        let mut force_n = None;
        loop {
            let since_s = self.client.link().now().saturating_sub(landed).as_secs_f64();
            let line = self.next(&Step::Press(CONTACT_S - since_s, force_n))?;
            force_n = line.telemetry.force_n;
            if line.telemetry.is_lifted() == Some(true) {
                let object = object.into();
                return Err(EnrolmentError::Lifted { object, since_s });
            }
            if since_s >= CONTACT_S {
                let word = (line.telemetry.known).map_or("not known", FingerKnowledge::name);
                if word == TRUSTED {
                    return Ok(());
                }
                let object = object.into();
                return Err(EnrolmentError::NotTrusted { object, word });
            }
        }
    }
}
