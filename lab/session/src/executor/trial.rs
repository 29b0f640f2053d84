//! What is known of the trial that runs, and its record.

use thermal_client::client::{ReceivedTelemetry, Telemetry};

use super::seconds;
use crate::measure::{Sample, measure, skin_fall};
use crate::record::{StationRecord, TrialRecord};
use crate::schedule::Next;
use crate::{AnswerKind, PlannedTrial, Response, Session};

/// Nanoseconds of a tick.
const TICK_NS: i64 = 1_000_000;

/// What is known of the trial that runs.
#[derive(Debug, Default)]
pub struct RunningTrial {
    attempt: u32,
    level_k: Option<f64>,
    begin_s: f64,
    pub reach_cue_s: Option<f64>,
    pub touch_cue_s: Option<f64>,
    /// The answer and its time.
    pub response: Option<(Response, f64)>,
    /// Whether the participant is being asked.
    pub is_asked: bool,
    /// End of the contact by the tone, or by the answer.
    pub contact_end_s: Option<f64>,
    /// Why its data do not count, although it goes on.
    pub void: Option<String>,
    /// Telemetry of each finger of the device.
    telemetry: Vec<Vec<Telemetry>>,
    /// What is added to a tick to give the time of the session, ns: that of the line that came soonest after its tick.
    tick_offset_ns: Option<i64>,
    /// Contacts with each finger's display: ticks of landing and lift.
    contacts: Vec<Vec<(u32, Option<u32>)>>,
}

impl RunningTrial {
    /// A trial that begins on a device with this many fingers.
    pub fn new(next: &Next<'_>, begin_s: f64, fingers: usize) -> Self {
        Self {
            attempt: next.attempt,
            level_k: next.level_k,
            begin_s,
            telemetry: vec![Vec::new(); fingers],
            contacts: vec![Vec::new(); fingers],
            ..Self::default()
        }
    }

    /// When it began, s.
    pub const fn begin_s(&self) -> f64 {
        self.begin_s
    }

    /// Takes note of a line of telemetry, which was received at a time of the session, ns. Returns whether its tick follows
    /// that of the line before; otherwise the device has restarted.
    pub fn received(&mut self, line: &ReceivedTelemetry, at_ns: i64) -> bool {
        let finger = usize::from(line.finger.unwrap_or(0));
        let Some(lines) = self.telemetry.get_mut(finger) else {
            return true;
        };
        let follows = lines.last().is_none_or(|last| last.tick < line.telemetry.tick);
        if !follows {
            // The trial is void; ticks of before the restart have no time any more.
            self.tick_offset_ns = None;
            lines.clear();
            self.contacts.iter_mut().for_each(Vec::clear);
        }
        let offset_ns = at_ns - i64::from(line.telemetry.tick) * TICK_NS;
        let soonest_ns = self.tick_offset_ns.map_or(offset_ns, |soonest| soonest.min(offset_ns));
        self.tick_offset_ns = Some(soonest_ns);
        lines.push(line.telemetry);
        follows
    }

    /// Takes note of a landing.
    pub fn landed(&mut self, finger: u8, tick: u32) {
        if let Some(contacts) = self.contacts.get_mut(usize::from(finger)) {
            contacts.push((tick, None));
        }
    }

    /// Forgets contacts that have ended before the tone to touch.
    pub fn forget_contacts(&mut self) {
        self.contacts.iter_mut().for_each(Vec::clear);
    }

    /// Time for which a finger has touched its display, until now, s.
    pub fn contact_s(&self, finger: u8) -> f64 {
        let contacts = self.contacts.get(usize::from(finger));
        let now = self.last_line(finger).map_or(0, |line| line.tick);
        let ticks = contacts
            .into_iter()
            .flatten()
            .map(|(land, lift)| lift.unwrap_or(now).saturating_sub(*land));
        f64::from(ticks.sum::<u32>()) / 1e3
    }

    /// Takes note of a lift.
    pub fn lifted(&mut self, finger: u8, tick: u32) {
        let contacts = self.contacts.get_mut(usize::from(finger));
        if let Some((_, lift)) = contacts.and_then(|contacts| contacts.last_mut()) {
            *lift = Some(tick);
        }
    }

    /// Time of a tick by the session's clock, s.
    fn time_s(&self, tick: u32) -> f64 {
        seconds(i64::from(tick) * TICK_NS + self.tick_offset_ns.unwrap_or(0))
    }

    /// First landing on a finger's display, s.
    pub fn land_s(&self, finger: u8) -> Option<f64> {
        let (tick, _) = *self.contacts.get(usize::from(finger))?.first()?;
        Some(self.time_s(tick))
    }

    /// Whether a finger touches its display now.
    pub fn is_touching(&self, finger: u8) -> bool {
        let contacts = self.contacts.get(usize::from(finger));
        contacts.is_some_and(|contacts| contacts.last().is_some_and(|(_, lift)| lift.is_none()))
    }

    /// The lines of a finger since a time before its last one, ms.
    pub fn last_lines(&self, finger: u8, ms: u32) -> &[Telemetry] {
        let lines = self.lines(finger);
        let Some(last) = lines.last() else {
            return &[];
        };
        let from = lines.partition_point(|line| line.tick + ms <= last.tick);
        lines.get(from..).unwrap_or_default()
    }

    /// The last line of a finger.
    pub fn last_line(&self, finger: u8) -> Option<&Telemetry> {
        self.telemetry.get(usize::from(finger))?.last()
    }

    /// All lines with the time of the session, s, and the finger of the device.
    pub fn telemetry(&self) -> impl Iterator<Item = (f64, u8, &Telemetry)> {
        let fingers = (0u8..).zip(&self.telemetry);
        fingers.flat_map(move |(finger, lines)| {
            lines.iter().map(move |line| (self.time_s(line.tick), finger, line))
        })
    }

    /// The answer in words.
    fn answer(&self, session: &Session) -> Option<String> {
        let (response, _) = self.response.as_ref()?;
        Some(answer_text(session, response))
    }

    /// Whether the answer is the correct one, if one is.
    pub fn is_correct(&self, session: &Session, planned: &PlannedTrial) -> Option<bool> {
        Some(self.answer(session)? == *planned.correct.as_ref()?)
    }

    /// The record of the trial, which has ended at this time, and is void for a reason.
    pub fn record(
        &self,
        session: &Session,
        planned: &PlannedTrial,
        void: Option<String>,
        end_s: f64,
    ) -> TrialRecord {
        let displays = || planned.presented.iter().filter_map(crate::Presented::device_finger);
        let contacts =
            |finger: u8| self.contacts.get(usize::from(finger)).map_or(&[][..], Vec::as_slice);
        let first_land_s = displays().filter_map(|finger| self.land_s(finger)).reduce(f64::min);
        let land_s = match displays().next() {
            Some(_) => first_land_s,
            None => self.touch_cue_s,
        };
        let lifts = displays().filter_map(|finger| contacts(finger).last()?.1);
        let lift_s = lifts.map(|tick| self.time_s(tick)).reduce(f64::max);
        let contact_s = displays().map(|finger| self.contact_s(finger)).reduce(f64::max);
        let room_c = land_s.and_then(|land_s| {
            let mut fingers = self.telemetry.iter();
            let lines = fingers.find(|lines| !lines.is_empty())?;
            lines.iter().find(|line| self.time_s(line.tick) >= land_s)?.room_c
        });
        TrialRecord {
            trial: planned.number,
            attempt: self.attempt,
            void,
            part: planned.part.clone(),
            block: planned.block,
            levels: planned.levels.clone(),
            staircase_level_k: self.level_k,
            begin_s: self.begin_s,
            reach_cue_s: self.reach_cue_s,
            touch_cue_s: self.touch_cue_s,
            land_s,
            lift_s: lift_s.or(self.contact_end_s),
            answer_s: self.response.as_ref().map(|(_, at_s)| *at_s),
            end_s,
            touches: displays().map(|finger| contacts(finger).len() as u32).max().unwrap_or(0),
            contact_s,
            target_force_n: planned.target_force_n,
            answer: self.answer(session),
            expected: planned.correct.clone(),
            is_correct: self.is_correct(session, planned),
            room_c,
            stations: (planned.presented.iter().enumerate())
                .map(|(station, presented)| {
                    let skin_sensor = session.skin_sensor(station, presented);
                    let target_force_n = planned.target_force_n;
                    self.station(presented, skin_sensor, target_force_n, end_s)
                })
                .collect(),
        }
    }

    fn station(
        &self,
        presented: &crate::Presented,
        skin_sensor: Option<u8>,
        target_force_n: Option<f64>,
        end_s: f64,
    ) -> StationRecord {
        let (record, lift_s) = match presented.device_finger() {
            Some(finger) => self.on_display(finger, presented, target_force_n, end_s),
            // Nothing tells when the finger lands on a sample; the tone to touch comes before, and the skin is at rest until then.
            None => {
                let record = StationRecord {
                    presented: presented.to_string(),
                    land_s: skin_sensor.and(self.touch_cue_s),
                    ..StationRecord::default()
                };
                (record, self.contact_end_s.unwrap_or(end_s))
            }
        };
        let Some((sensor, land_s)) = skin_sensor.zip(record.land_s) else {
            return record;
        };
        let skins = self.lines(sensor).iter();
        let skins: Vec<(f64, f64)> =
            skins.filter_map(|line| Some((self.time_s(line.tick), line.skin_c?))).collect();
        let (skin_before_c, skin_fall_k) = skin_fall(&skins, land_s, lift_s);
        StationRecord { skin_before_c, skin_fall_k, ..record }
    }

    /// The lines of a finger.
    fn lines(&self, finger: u8) -> &[Telemetry] {
        let lines = self.telemetry.get(usize::from(finger));
        lines.map_or(&[][..], Vec::as_slice)
    }

    /// What a display has measured of the finger on it, and the end of that contact, s.
    fn on_display(
        &self,
        finger: u8,
        presented: &crate::Presented,
        target_force_n: Option<f64>,
        end_s: f64,
    ) -> (StationRecord, f64) {
        let text = presented.to_string();
        let samples: Vec<Sample> = (self.lines(finger).iter())
            .map(|line| Sample {
                t_s: self.time_s(line.tick),
                setpoint_c: line.setpoint_c,
                display_c: line.display_c,
                force_n: line.force_n,
                is_limited: line.limited,
            })
            .collect();
        let last = (self.contacts.get(usize::from(finger))).and_then(|contacts| contacts.last());
        let lift_s = last.and_then(|(_, lift)| *lift).map_or(end_s, |tick| self.time_s(tick));
        // The tone ends the contact; what the finger does on its way up is no part of it.
        let lift_s = lift_s.min(self.contact_end_s.unwrap_or(lift_s));
        let land_s = self.land_s(finger);
        let record = measure(&samples, text, land_s, lift_s, target_force_n);
        (record, lift_s)
    }
}

/// An answer in words.
fn answer_text(session: &Session, response: &Response) -> String {
    match response {
        Response::Choice(index) => {
            let kind = session.answer.as_ref().map(|answer| &answer.kind);
            match kind {
                Some(AnswerKind::OneOf(words)) => words.get(*index).cloned().unwrap_or_default(),
                _ => index.to_string(),
            }
        }
        Response::Numbers(numbers) => {
            let numbers: Vec<_> = numbers.iter().map(ToString::to_string).collect();
            numbers.join(";")
        }
    }
}
