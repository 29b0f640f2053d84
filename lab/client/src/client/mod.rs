//! Typed client of the serial protocol.
//!
//! A [`Command`] writes its line, and its answer is read; [`Client`] sends it, waits for its answer, keeps telemetry apart from
//! answers, and sends the sign of life that a streaming device needs.

mod available_fields;
mod clock;
mod error;
mod event;
mod off;
mod streams;
mod telemetry;

use std::borrow::Cow;
use std::collections::VecDeque;
use std::hash::{BuildHasher, RandomState};
use std::time::Duration;

use thermal_device::TelemetryFields;
use thermal_protocol::{LINE_MAX_BYTES, line_checksum, strip_checksum};
use thermal_wire::host::{Answer as _, Fields};
use thermal_wire::telemetry::{NO_FIELDS, chosen_or_default, place_of_field};

use crate::link::{Link, LinkError, ReceivedLine};
use crate::text::escaped_line;
use streams::{Stream, TelemetryStreams};

pub use available_fields::AvailableFields;
pub use clock::{DeviceClock, TickTime};
pub use error::ClientError;
pub use event::ReceivedEvent;
pub use streams::longest_gap;
pub use telemetry::{ReceivedTelemetry, Telemetry};
pub use thermal_wire::answer::{
    BoardReport, CalibrationFit, Cause, ClockSource, FluxReport, IdentifiedTile, Identity,
    PersonReport, RawReadings, SelfTestReport, Status, Watchdogs,
};
pub use thermal_wire::host::Column as TelemetryColumn;
pub use thermal_wire::host::{Command, SIMULATED_UNIQUE_ID, SettingsLine, upload, upload_course};
pub use thermal_wire::request::{
    Calibrate, CountSettings, DeviceRequest, EnrolPerson, PersonRequest, QueryAssumedFinger,
    QueryBoard, QueryCause, QueryContactLaw, QueryDisplaySurface, QueryFlux, QueryIdentity,
    QueryLaw, QueryMargins, QueryPerson, QueryPersons, QueryRaw, QuerySelfTest, QuerySetting,
    QueryState, QueryTriggerPulse, SessionRequest, StationRequest, TuneResult,
};
pub use thermal_wire::{PersonData, PointOrClear, UploadLine};

/// Timeout of an answer.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(2);
/// Longest silence of the client while the device streams, half of what trips the device.
const SILENCE_MAX: Duration = Duration::from_secs(1);
/// Number of times a line that may be repeated is sent.
const ATTEMPTS: u32 = 3;
/// Bytes that a checksum adds to a line.
const CHECKSUM_BYTES: usize = "*00".len();
/// Time after the answer to a `stream` that changes the fields within which a tick may have been reported with the old ones.
/// The answer overtakes the telemetry that waits, and a line with all fields takes a millisecond longer than it on the way.
const FIELD_CHANGE_TIME: Duration = Duration::from_millis(10);
/// Telemetry lines that are kept until they are fetched; then the oldest is dropped.
const TELEMETRY_KEPT_MAX: usize = 100_000;

/// Numbers of lines that a client did not receive as they were sent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LineCounts {
    /// Telemetry lines that never came, by their ticks.
    pub lost: u64,
    /// Lines that are neither telemetry nor an answer.
    pub damaged: u64,
    /// Telemetry lines that came and were not fetched in time, or that may still have had the fields of before a `stream`
    /// that has changed them.
    pub dropped: u64,
}

/// A client of the device at the other end of a link. It sends and receives only while one of its functions runs; so
/// whoever streams telemetry calls [`wait`](Self::wait) or [`next_telemetry`](Self::next_telemetry) at least once a second.
#[derive(Debug)]
pub struct Client<L> {
    link: L,
    telemetry: VecDeque<ReceivedTelemetry>,
    events: VecDeque<ReceivedEvent>,
    streams: TelemetryStreams,
    clock: DeviceClock,
    counts: LineCounts,
    last_sent: Duration,
    /// Whether checksums are on: both sides end their lines with one.
    checksums: bool,
    /// Whether an answer may still come that nobody waits for.
    out_of_step: bool,
    /// Whether this client has sent `arm`, and since then nothing that has switched all bridges off.
    may_be_driven: bool,
    /// Number in the last line that synchronized answers with lines.
    synchronization: u32,
    /// Time by the link's clock beyond which no answer is waited for.
    deadline: Duration,
}

impl<L: Link> Client<L> {
    /// A client of a device that has sent nothing that is still on its way, as one that was just switched on.
    pub fn new(link: L) -> Self {
        Self {
            last_sent: link.now(),
            link,
            telemetry: VecDeque::new(),
            events: VecDeque::new(),
            streams: TelemetryStreams::default(),
            clock: DeviceClock::default(),
            counts: LineCounts::default(),
            checksums: false,
            out_of_step: false,
            may_be_driven: false,
            // The standard library's hashers have random keys, others for each client and each process.
            synchronization: RandomState::new().hash_one(()) as u32,
            deadline: Duration::MAX,
        }
    }

    /// A client of a device that may be running: ends a line that another program left unfinished, and discards the
    /// answers to earlier lines.
    ///
    /// # Errors
    /// The device does not answer, or the link is gone.
    pub fn attach(link: L) -> Result<Self, ClientError> {
        let mut client = Self::new(link);
        client.discard_earlier()?;
        Ok(client)
    }

    /// Ends a line that another program left unfinished, and discards the answers to earlier lines.
    ///
    /// # Errors
    /// The device does not answer, or the link is gone.
    pub fn discard_earlier(&mut self) -> Result<(), ClientError> {
        self.transmit("")?;
        self.synchronize()
    }

    /// The link.
    pub const fn link(&mut self) -> &mut L {
        &mut self.link
    }

    /// Gives the link back.
    pub fn into_link(self) -> L {
        self.link
    }

    /// Whether a bridge may be on because this client has armed it: from the sending of `arm`, whatever is answered, to an accepted
    /// `abort` of all fingers or a restart.
    pub const fn may_be_driven(&self) -> bool {
        self.may_be_driven
    }

    /// Whether the device streams telemetry of any finger.
    pub fn is_streaming(&self) -> bool {
        self.streams.is_on()
    }

    /// Lines that were lost, damaged or dropped so far.
    pub const fn counts(&self) -> LineCounts {
        self.counts
    }

    /// Device ticks against the link's clock, from the telemetry so far.
    pub const fn clock(&self) -> &DeviceClock {
        &self.clock
    }

    /// Sends a command to the device and waits for its reply.
    ///
    /// # Errors
    /// The device refuses it, does not answer or answers something else, or the link is gone.
    pub fn ask<C: Command>(&mut self, command: &C) -> Result<C::Answer, ClientError> {
        self.ask_finger(None, command)
    }

    /// Sends a command to one finger of the device, or to all for `None`, and waits for its reply.
    ///
    /// # Errors
    /// As [`ask`](Self::ask).
    pub fn ask_finger<C: Command>(
        &mut self,
        finger: Option<u8>,
        command: &C,
    ) -> Result<C::Answer, ClientError> {
        let line = match finger {
            Some(finger) => format!("@{finger} {command}"),
            None => command.to_string(),
        };
        let mut attempt = 0;
        loop {
            attempt += 1;
            let (answered, reply) = self.accepted(&line)?;
            let understood = finger.is_none() || finger == answered;
            if let Some(read) = C::Answer::read(&Fields::new(&reply)).filter(|_| understood) {
                return Ok(read);
            }
            // It may be that of another line, which came late or twice.
            self.out_of_step = true;
            if attempt == ATTEMPTS || !may_be_repeated(&line) {
                return Err(ClientError::NotUnderstood { line, answer: format!("ok {reply}") });
            }
        }
    }

    /// Sends a line that must be accepted; returns the answer after `ok`.
    ///
    /// # Errors
    /// The device refuses it or does not answer, or the link is gone.
    pub fn command(&mut self, line: &str) -> Result<String, ClientError> {
        Ok(self.accepted(line)?.1)
    }

    /// The finger that has accepted a line, and its answer after `ok`.
    fn accepted(&mut self, line: &str) -> Result<(Option<u8>, String), ClientError> {
        let answer = self.query(line)?;
        let (finger, content) = split_finger(&answer);
        match content.strip_prefix("ok") {
            Some(reply) => Ok((finger, reply.trim().into())),
            None => Err(ClientError::Refused { line: line.into(), answer }),
        }
    }

    /// Sends a line and waits for its answer, `ok …` or `err …`, perhaps with the finger before it. Questions and the rows of
    /// an upload, which have numbers, are sent again if the line or its answer is lost or damaged; another line might then be
    /// executed twice.
    ///
    /// # Errors
    /// The line cannot be sent, the device does not answer, or the link is gone.
    pub fn query(&mut self, line: &str) -> Result<String, ClientError> {
        let mut answer = self.query_once(line);
        for _ in 1..ATTEMPTS {
            let lost = match &answer {
                Ok(answer) => split_finger(answer).1.starts_with("err checksum "),
                Err(error) => matches!(
                    error,
                    ClientError::TimedOut { .. } | ClientError::NotUnderstood { .. }
                ),
            };
            let is_over = self.link.now() >= self.deadline;
            if !self.checksums || !lost || !may_be_repeated(line) || is_over {
                break;
            }
            answer = self.query_once(line);
        }
        answer
    }

    fn query_once(&mut self, line: &str) -> Result<String, ClientError> {
        let sendable = |byte: u8| matches!(byte, b' '..=b'~');
        let max = LINE_MAX_BYTES - if self.checksums { CHECKSUM_BYTES } else { 0 };
        if line.trim().is_empty() || line.len() > max || !line.bytes().all(sendable) {
            return Err(ClientError::Unsendable { line: line.into() });
        }
        if self.out_of_step {
            if split_finger(line).1.trim() == "abort" {
                // The bridge is switched off even if no answer comes through.
                self.transmit(line)?;
            }
            self.synchronize()?;
        }
        self.transmit(line)?;
        let before = self.checksums;
        if ["checksum off", "save", "forget"].contains(&line) {
            // The answer has no checksum, unless the line is refused.
            self.checksums = false;
        }
        let answer = self.answer(line)?;
        if is_ok(&answer) {
            self.note_accepted(line);
        } else {
            self.checksums = before;
        }
        Ok(answer)
    }

    /// Waits, and receives what comes.
    ///
    /// # Errors
    /// The link is gone, or the wait was interrupted.
    pub fn wait(&mut self, time: Duration) -> Result<(), LinkError> {
        let end = self.link.now() + time;
        while let Some(line) = self.receive_until(end)? {
            self.sort_line(line);
        }
        Ok(())
    }

    /// The heat-flux sensor that is set for the finger, its flux and what is known of the finger by it; `None` without one, and from
    /// firmware from before there was one.
    ///
    /// # Errors
    /// As [`ask`](Self::ask), but for a refusal.
    pub fn flux_report(&mut self, finger: Option<u8>) -> Result<Option<FluxReport>, ClientError> {
        match self.ask_finger(finger, &QueryFlux) {
            Err(error) if error.refusal().is_some() => Ok(None),
            report => report,
        }
    }

    /// Switches the finger's bridge off and ends its telemetry: each also if the device refuses the other.
    ///
    /// # Errors
    /// As [`ask`](Self::ask).
    pub fn abort_and_end_stream(&mut self, finger: Option<u8>) -> Result<(), ClientError> {
        let off = self.ask_finger(finger, &StationRequest::Abort);
        let no_stream = self.ask_finger(finger, &StationRequest::stream(0));
        off.and(no_stream)
    }

    /// The next telemetry line of this finger, or of any for `None`; waits for each line at most `timeout`. A device with one finger
    /// sends lines without one, which are taken.
    ///
    /// # Errors
    /// As [`next_telemetry`](Self::next_telemetry).
    pub fn next_telemetry_of(
        &mut self,
        finger: Option<u8>,
        timeout: Duration,
    ) -> Result<Option<ReceivedTelemetry>, LinkError> {
        loop {
            let line = self.next_telemetry(timeout)?;
            let is_other = |line: &ReceivedTelemetry| {
                finger.is_some() && line.finger.is_some() && line.finger != finger
            };
            if !line.as_ref().is_some_and(is_other) {
                return Ok(line);
            }
        }
    }

    /// The next telemetry line; waits for it at most `timeout`.
    ///
    /// # Errors
    /// The link is gone, or the wait was interrupted.
    pub fn next_telemetry(
        &mut self,
        timeout: Duration,
    ) -> Result<Option<ReceivedTelemetry>, LinkError> {
        let end = self.link.now() + timeout;
        while self.telemetry.is_empty() {
            match self.receive_until(end)? {
                Some(line) => self.sort_line(line),
                None => break,
            };
        }
        Ok(self.telemetry.pop_front())
    }

    /// The oldest event that was received and not fetched yet. Events are received while any of the client's functions waits.
    pub fn take_event(&mut self) -> Option<ReceivedEvent> {
        self.events.pop_front()
    }

    /// Makes sure that the next answer is that of the next line. A line is sent whose answer, an error, repeats a word that
    /// no other answer has, not even to an earlier client of the device; everything before that answer is discarded. The word
    /// has always the same length, so that a simulated device answers after the same time, and is as long as an error repeats.
    fn synchronize(&mut self) -> Result<(), ClientError> {
        self.out_of_step = true;
        self.transmit(if self.checksums {
            // A device that has restarted meanwhile has forgotten it.
            "checksum on"
        } else {
            // An earlier client may have left it on, or the answer to this one's `checksum on` was lost. With a checksum the device
            // takes the line in any case.
            "checksum off*42"
        })?;
        self.synchronization = self.synchronization.wrapping_add(1);
        let line = format!("synchronize-{:08x}", self.synchronization);
        self.transmit(&line)?;
        // One deadline for all answers: other machines may go on saying `ok` for ever.
        let end = self.link.now() + ANSWER_TIMEOUT;
        let mut other = None;
        loop {
            match self.answer_until(&line, end) {
                Ok(answer) if answer.contains(&format!("'{line}'")) => break,
                Ok(answer) => other = Some(answer),
                Err(ClientError::TimedOut { .. }) if other.is_some() => {
                    return Err(ClientError::NoDisplay { answer: other.unwrap_or_default() });
                }
                Err(error) => return Err(error),
            }
        }
        self.out_of_step = false;
        Ok(())
    }

    fn transmit(&mut self, line: &str) -> Result<(), LinkError> {
        self.may_be_driven |= split_finger(line).1.trim() == "arm";
        let line = if self.checksums && !line.is_empty() {
            format!("{line}*{:02X}\n", line_checksum(line.as_bytes()))
        } else {
            format!("{line}\n")
        };
        self.link.send(line.as_bytes())?;
        self.last_sent = self.link.now();
        Ok(())
    }

    /// The next answer.
    fn answer(&mut self, line: &str) -> Result<String, ClientError> {
        let end = self.link.now() + ANSWER_TIMEOUT;
        loop {
            let answer = self.answer_until(line, end)?;
            // On a line that doubles, the word by which answers were synchronized has another answer.
            if !answer.contains("'synchronize-") || line.starts_with("synchronize-") {
                return Ok(answer);
            }
        }
    }

    /// The next answer until a time by the link's clock.
    fn answer_until(&mut self, line: &str, end: Duration) -> Result<String, ClientError> {
        let end = end.min(self.deadline);
        let timeout = end.saturating_sub(self.link.now());
        let mut damaged = None;
        loop {
            let mut received = self.receive_until(end).inspect_err(|_| self.out_of_step = true)?;
            if received.is_none() {
                // It may wait behind telemetry that has come while this program did not run.
                received = self.link.receive(Duration::ZERO)?;
            }
            let Some(received) = received else {
                self.out_of_step = true;
                let line = line.into();
                return Err(match damaged {
                    Some(answer) => ClientError::NotUnderstood { line, answer },
                    None => ClientError::TimedOut { line, timeout },
                });
            };
            match self.sort_line(received) {
                Some(Sorted::Answer(answer)) => return Ok(answer),
                Some(Sorted::Damaged(text)) => damaged = Some(text),
                None => {}
            }
        }
    }

    /// The next line until a time, with signs of life meanwhile.
    fn receive_until(&mut self, end: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        loop {
            let now = self.link.now();
            if now >= end {
                return Ok(None);
            }
            let mut wait = end - now;
            if self.streams.is_on() {
                let silence = now.saturating_sub(self.last_sent);
                if silence >= SILENCE_MAX {
                    self.transmit("")?;
                }
                wait = wait.min(SILENCE_MAX.saturating_sub(silence).max(Duration::from_millis(1)));
            }
            if let Some(line) = self.link.receive(wait)? {
                return Ok(Some(line));
            }
        }
    }

    /// Keeps telemetry; returns everything else but blank lines.
    fn sort_line(&mut self, mut line: ReceivedLine) -> Option<Sorted> {
        match strip_checksum(&line.text) {
            Ok(content) if content.len() < line.text.len() => line.text.truncate(content.len()),
            _ if self.checksums && !line.text.is_empty() => {
                self.counts.damaged += 1;
                return Some(Sorted::Damaged(escaped_line(&line.text).into_owned()));
            }
            // A star that is no checksum's may be in a word that an error repeats.
            _ => {}
        }
        // Only now, because the checksum is that of the line as it was sent. Whoever shows the line shows no control characters.
        if let Cow::Owned(escaped) = escaped_line(&line.text) {
            line.text = escaped;
        }
        let (finger, content) = split_finger(&line.text);
        if content.is_empty() {
            return None;
        }
        if is_answer(content) {
            return Some(Sorted::Answer(line.text));
        }
        if let Some((event, tick)) = ReceivedEvent::parse(finger, content, line.at) {
            self.clock.observe(tick, line.at);
            if self.events.len() == TELEMETRY_KEPT_MAX {
                self.events.pop_front();
                self.counts.dropped += 1;
            }
            self.events.push_back(event);
            return None;
        }
        if self.may_have_old_fields(finger, content, line.at) {
            self.counts.dropped += 1;
            return None;
        }
        let fields = self.streams.fields(finger);
        let Some(telemetry) = Telemetry::parse_fields(content, fields) else {
            self.counts.damaged += 1;
            return Some(Sorted::Damaged(line.text));
        };
        self.clock.observe(telemetry.tick, line.at);
        let lost_before = self.streams.lost_before(finger, telemetry.tick);
        self.counts.lost += u64::from(lost_before);
        if self.telemetry.len() == TELEMETRY_KEPT_MAX {
            self.telemetry.pop_front();
            self.counts.dropped += 1;
        }
        self.telemetry.push_back(ReceivedTelemetry { finger, telemetry, at: line.at, lost_before });
        None
    }

    /// Whether a line is telemetry of a tick before a change of its fields, or so soon after it that this is not certain.
    /// When it arrived does not tell, because lines wait while nobody receives them.
    fn may_have_old_fields(&mut self, finger: Option<u8>, content: &str, at: Duration) -> bool {
        let Some(changed_at) = self.streams.fields_changed_at(finger) else {
            return false;
        };
        let Some(tick) = Telemetry::tick_of(content) else {
            return false;
        };
        self.clock.observe(tick, at);
        let new_from_s = (changed_at + FIELD_CHANGE_TIME).as_secs_f64();
        let time = self.clock.time_of(tick);
        time.is_some_and(|time| time.at_s - time.error_s <= new_from_s)
    }

    /// Takes note of what an accepted line has changed that the client must know.
    fn note_accepted(&mut self, line: &str) {
        let (finger, line) = split_finger(line);
        let mut words = line.split_ascii_whitespace();
        match (words.next(), words.next()) {
            (Some("stream"), Some(interval)) => {
                let interval_ms = interval.parse().map_or(0.0, f64::ceil);
                let named = words.filter_map(place_of_field);
                let fields = chosen_or_default(named.fold(NO_FIELDS, TelemetryFields::with));
                let since = self.link.now();
                self.streams.set(finger, Stream { interval_ms: interval_ms as u32, fields, since });
            }
            (Some("checksum"), Some(switch)) => self.checksums = switch == "on",
            (Some("abort"), None) if finger.is_none() => self.may_be_driven = false,
            (Some("save" | "forget"), None) => {
                self.may_be_driven = false;
                self.streams = TelemetryStreams::default();
                self.clock.restart();
            }
            _ => {}
        }
    }
}

/// A line that is no telemetry.
enum Sorted {
    Answer(String),
    Damaged(String),
}

/// Whether a line may be executed twice: a question, or a row of an upload.
fn may_be_repeated(line: &str) -> bool {
    let words: Vec<_> = split_finger(line).1.split_ascii_whitespace().collect();
    matches!(
        words.as_slice(),
        ["id"
            | "state"
            | "cause"
            | "board"
            | "raw"
            | "self-test"
            | "law"
            | "finger"
            | "contact"
            | "margins"
            | "flux"
            | "surface"
            | "person"
            | "persons"]
            | ["settings", ..]
            | ["upload", "row", ..]
    )
}

/// Whether an answer is that of an accepted line.
fn is_ok(answer: &str) -> bool {
    split_finger(answer).1.split(' ').next() == Some("ok")
}

fn is_answer(content: &str) -> bool {
    matches!(content.split(' ').next(), Some("ok" | "err"))
}

/// The finger at the beginning of a line, and the rest.
fn split_finger(line: &str) -> (Option<u8>, &str) {
    let line = line.trim_start();
    let address = line.strip_prefix('@').and_then(|line| line.split_once(' '));
    match address.and_then(|(finger, rest)| Some((finger.parse().ok()?, rest))) {
        Some((finger, rest)) => (Some(finger), rest),
        None => (None, line),
    }
}
