//! One trial at the bench: what the hand does, what the fingers feel, and what the participant answers.

use thermal_plant::{Finger, SampleTouch};
use thermal_session::{
    ContactRule, Cue, Phase, PlannedTrial, Presented, Procedure, Response, RestPlace, Update,
};
use thermal_sim::scene::ActiveFault;

use super::{BenchError, Observation, Setting, known_material};
use crate::device::{FingerInput, RunningDevice};
use crate::falls::{both, sample_touch};
use crate::hand::{ForceCourse, Touches};
use crate::observer::{FallMeter, Judgement};
use crate::operator::Happening;
use crate::random::Stream;

/// Time beyond the longest contact for which touches are planned, s.
const BEYOND_S: f64 = 15.0;
/// Time from the begin of a rest on the display to the landing there, ms.
const PLACING_MS: u64 = 1000;

/// A trial that runs.
#[derive(Debug)]
pub struct RunningTrial {
    number: u32,
    attempt: u32,
    skin_c: f64,
    begin_ms: u64,
    happenings: Vec<Happening>,
    stations: Vec<Station>,
    touches: Touches,
    reach_ms: u64,
    decision_s: f64,
    /// Whether the fingers rest on the display before the contact, or instead of it.
    rests_on_display: bool,
    /// Begin and end of that rest.
    rest_ms: Option<(u64, u64)>,
    /// First landing after the tone.
    land_ms: Option<u64>,
    /// Lift for good.
    lift_ms: Option<u64>,
    /// Number of the interval, its begin, and its length.
    interval: Option<(u8, u64, u64)>,
    /// Largest change in each interval that has ended, K.
    intervals_k: Vec<Option<f64>>,
    asked_ms: Option<u64>,
    judged: Option<Judged>,
    is_answered: bool,
}

#[derive(Debug)]
struct Judged {
    at_ms: u64,
    decision_s: f64,
    falls_k: Vec<Option<f64>>,
    judgement: Option<Judgement>,
}

#[derive(Debug)]
struct Station {
    presented: Presented,
    stimulus: Stimulus,
    /// The finger of the device whose skin thermistor is on the finger here, unless that is the display's own.
    skin_sensor: Option<usize>,
    course: ForceCourse,
    /// Force of a finger that rests on the display.
    resting: ForceCourse,
    meter: FallMeter,
    force_n: f64,
}

#[derive(Debug)]
enum Stimulus {
    Nothing,
    Sample(Box<SampleTouch>),
    Display(usize),
}

impl RunningTrial {
    /// A trial that begins now, with the fingers at rest.
    pub fn new(
        trial: &PlannedTrial,
        attempt: u32,
        of: usize,
        ms: u64,
        setting: &Setting,
    ) -> Result<Self, BenchError> {
        let Setting { session, options, participant, .. } = setting;
        let happenings: Vec<Happening> = (options.events.iter())
            .filter(|event| event.is_in(trial.number, attempt))
            .map(|event| event.what.clone())
            .collect();
        let fraction = f64::from(trial.number - 1) / (of.max(2) - 1) as f64;
        let off_k: f64 = (happenings.iter())
            .filter_map(|what| match what {
                Happening::SkinOff(off_k) => Some(*off_k),
                _ => None,
            })
            .sum();
        let skin_c = participant.skin_c(fraction) + off_k;
        let stream = |purpose: &str| {
            let key = &setting.key;
            let name = format!("{key} trial {} attempt {attempt} {purpose}", trial.number);
            Stream::new(setting.seed, &name)
        };
        let (rule, max_s) = match session.trial.procedure {
            Procedure::Touch { contact, max_s, .. } => (contact, max_s),
            Procedure::Intervals { .. } => (ContactRule::Hold, 0.0),
        };
        let hand = &participant.hand;
        let touches = Touches::new(hand, rule, max_s + BEYOND_S, &mut stream("touches"));
        let at_rest = Touches::new(hand, ContactRule::Hold, 0.0, &mut stream("touches"));
        let stations = trial.presented.iter().enumerate();
        let stations = stations.map(|(index, presented)| {
            let mut meter = FallMeter::default();
            let stimulus = match presented {
                Presented::Nothing => Stimulus::Nothing,
                Presented::Sample { material } => {
                    let material = known_material(session, material)?;
                    let temperatures_c = (skin_c, options.room_c);
                    let touch = sample_touch(&setting.params, temperatures_c, &material)?;
                    // A finger at rest stays as it is until it lands.
                    meter.push(both(touch.receptors_c())?);
                    Stimulus::Sample(Box::new(touch))
                }
                display => Stimulus::Display(display.device_finger().map_or(0, usize::from)),
            };
            let target_n = trial.target_force_n;
            let force = |purpose, touches, target_n| {
                let mut random = stream(&format!("{purpose} {index}"));
                ForceCourse::new(hand, touches, target_n, &mut random)
            };
            let skin_sensor = session.skin_sensor(index, presented);
            let skin_sensor =
                skin_sensor.filter(|sensor| presented.device_finger() != Some(*sensor));
            Ok(Station {
                presented: presented.clone(),
                stimulus,
                skin_sensor: skin_sensor.map(usize::from),
                course: force("force", &touches, target_n),
                resting: force("rest", &at_rest, None),
                meter,
                force_n: 0.0,
            })
        });
        let stations: Result<_, BenchError> = stations.collect();
        let (mean_s, sd_s) = hand.reach_s;
        let reach_s = stream("reach").normal_within(mean_s, sd_s, (0.5 * mean_s, 2.0 * mean_s));
        let observer = &participant.observer;
        let mut times = stream("decision");
        let decision_s = times.log_normal(observer.decision_median_s, observer.decision_sigma_ln);
        let rests_on_display = matches!(session.trial.procedure, Procedure::Intervals { .. })
            || session.rest.is_some_and(|rest| rest.place == RestPlace::Display);
        let lies_on_display = happenings.contains(&Happening::LiesOnDisplay);
        Ok(Self {
            number: trial.number,
            attempt,
            skin_c,
            begin_ms: ms,
            happenings,
            stations: stations?,
            touches,
            reach_ms: milliseconds(reach_s),
            decision_s: if max_s > 0.0 { decision_s.min(max_s) } else { decision_s },
            rests_on_display,
            rest_ms: lies_on_display.then_some((ms, u64::MAX)),
            land_ms: None,
            lift_ms: None,
            interval: None,
            intervals_k: Vec::new(),
            asked_ms: None,
            judged: None,
            is_answered: false,
        })
    }

    /// Skin before contact, °C.
    pub const fn skin_c(&self) -> f64 {
        self.skin_c
    }

    /// What happens in it on purpose.
    pub fn happenings(&self) -> impl Iterator<Item = &Happening> {
        self.happenings.iter()
    }

    fn happens(&self, what: &Happening) -> bool {
        self.happenings.contains(what)
    }

    /// Takes note of what the executor says.
    pub fn inform(&mut self, update: &Update, ms: u64, setting: &Setting) {
        let procedure = setting.session.trial.procedure;
        let stays = matches!(procedure, Procedure::Intervals { .. });
        let reaction_ms = milliseconds(setting.participant.hand.reaction_s);
        match update {
            Update::Phase(Phase::Rest) => self.rest(ms),
            Update::Phase(Phase::Prepare | Phase::Reach) if stays => self.rest(ms),
            Update::Phase(Phase::Prepare) if !self.happens(&Happening::LiesOnDisplay) => {
                self.end_rest(ms + reaction_ms);
            }
            Update::Cue(Cue::Touch) if !self.happens(&Happening::DoesNotTouch) => {
                self.end_rest(ms);
                self.land_ms = self.land_ms.or(Some(ms + self.reach_ms));
            }
            Update::Cue(Cue::Interval(number)) => {
                if let Procedure::Intervals { interval_s, .. } = procedure {
                    self.interval = Some((*number, ms, milliseconds(interval_s)));
                    for station in &mut self.stations {
                        station.meter.begin();
                    }
                }
            }
            Update::Ask(_) => self.asked_ms = Some(ms),
            Update::Cue(Cue::Lift) | Update::Phase(Phase::Return) => self.lift(ms + reaction_ms),
            Update::Phase(Phase::Respond) if !stays => self.lift(ms + reaction_ms),
            _ => {}
        }
    }

    fn rest(&mut self, ms: u64) {
        if self.rests_on_display && !self.happens(&Happening::DoesNotTouch) {
            self.rest_ms = self.rest_ms.or(Some((ms + PLACING_MS, u64::MAX)));
        }
    }

    fn end_rest(&mut self, ms: u64) {
        if let Some((_, until_ms)) = &mut self.rest_ms {
            *until_ms = ms.min(*until_ms);
        }
    }

    /// The hand lifts for good, if it has not.
    fn lift(&mut self, ms: u64) {
        self.end_rest(ms);
        if self.land_ms.is_some() {
            self.lift_ms = self.lift_ms.or(Some(ms));
        }
    }

    /// Moves the hand, and advances the samples by a millisecond, which gives what the fingers of the device meet.
    pub fn step_1_ms(
        &mut self,
        ms: u64,
        mut device: Option<&mut RunningDevice>,
        inputs: &mut [FingerInput],
    ) {
        let resting_s = self.rest_ms.filter(|(from_ms, _)| *from_ms <= ms);
        let resting_s = resting_s.map(|(from_ms, until_ms)| {
            (seconds(ms - from_ms), seconds(until_ms.saturating_sub(from_ms)))
        });
        let touching_s = self.land_ms.filter(|land_ms| *land_ms <= ms);
        let touching_s = touching_s.map(|land_ms| {
            let lift_s = self
                .lift_ms
                .map_or(f64::INFINITY, |lift_ms| seconds(lift_ms.saturating_sub(land_ms)));
            (seconds(ms - land_ms), lift_s)
        });
        let is_over = self.judged.is_some();
        for station in &mut self.stations {
            let touched_n =
                touching_s.map_or(0.0, |(t_s, lift_s)| station.course.force_n(t_s, lift_s));
            let is_display = matches!(station.stimulus, Stimulus::Display(_));
            let rested_n = resting_s
                .filter(|_| is_display)
                .map_or(0.0, |(t_s, lift_s)| station.resting.force_n(t_s, lift_s));
            station.force_n = touched_n.max(rested_n);
            if touched_n > 0.0 && !station.meter.has_begun() {
                station.meter.begin();
            }
            let skin_c = match &mut station.stimulus {
                Stimulus::Nothing => None,
                Stimulus::Display(finger) => {
                    if let Some(input) = inputs.get_mut(*finger) {
                        input.force_n = station.force_n;
                    }
                    let device = device.as_mut();
                    device.map(|device| device.plant(*finger).skin_c())
                }
                // A sample that was not touched yet is at rest; after the decision only a thermistor looks at it.
                Stimulus::Sample(touch) => {
                    let is_measured = !is_over || station.skin_sensor.is_some();
                    if station.meter.has_begun() && is_measured {
                        touch.set_force(station.force_n);
                        touch.step();
                    }
                    Some(touch.skin_c())
                }
            };
            if let Some(input) = station.skin_sensor.and_then(|finger| inputs.get_mut(finger)) {
                input.skin_elsewhere_c = skin_c;
            }
        }
    }

    /// Appends the faults that are present.
    pub fn faults(&self, ms: u64, faults: &mut Vec<ActiveFault>) {
        let is_within = |begin_ms: Option<u64>, from_s: f64, for_s: f64| {
            begin_ms.is_some_and(|begin_ms| {
                ms >= begin_ms && (from_s..from_s + for_s).contains(&seconds(ms - begin_ms))
            })
        };
        for what in &self.happenings {
            match what {
                Happening::Fault { fault, from_s, for_s }
                    if is_within(Some(self.begin_ms), *from_s, *for_s) =>
                {
                    faults.push(*fault)
                }
                Happening::FaultAfterLanding { fault, from_s, for_s }
                    if is_within(self.land_ms, *from_s, *for_s) =>
                {
                    faults.push(*fault)
                }
                _ => {}
            }
        }
    }

    /// Feels the stations after a millisecond, and decides when it is time to.
    pub fn feel(
        &mut self,
        ms: u64,
        mut device: Option<&mut RunningDevice>,
        setting: &Setting,
    ) -> Result<(), BenchError> {
        if self.judged.is_some() {
            return Ok(());
        }
        for station in &mut self.stations {
            match &station.stimulus {
                Stimulus::Nothing => {}
                Stimulus::Sample(touch) => {
                    if station.meter.has_begun() {
                        station.meter.push(both(touch.receptors_c())?);
                    }
                }
                Stimulus::Display(finger) => {
                    if let Some(device) = &mut device {
                        let receptors_c = device.plant(*finger).receptors_c(Finger::OnDisplay);
                        station.meter.push(both(receptors_c)?);
                    }
                }
            }
        }
        self.end_interval(ms);
        if self.is_decided(ms, setting) {
            self.judge(ms, setting);
        }
        Ok(())
    }

    fn end_interval(&mut self, ms: u64) {
        let Some((number, begin_ms, length_ms)) = self.interval else {
            return;
        };
        if ms >= begin_ms + length_ms && self.intervals_k.len() <= usize::from(number) {
            let felt = self.stations.iter().find_map(|station| station.meter.fall_k());
            self.intervals_k.push(felt);
        }
    }

    fn is_decided(&self, ms: u64, setting: &Setting) -> bool {
        let decision_ms = milliseconds(self.decision_s);
        if let Procedure::Intervals { .. } = setting.session.trial.procedure {
            return self.interval.is_some_and(|(number, begin_ms, length_ms)| {
                number > 0 && ms >= begin_ms + length_ms + decision_ms
            });
        }
        let is_lifted = self.lift_ms.is_some_and(|lift_ms| ms >= lift_ms);
        let waits = setting.task.is_some();
        is_lifted || (waits && self.land_ms.is_some_and(|land_ms| ms >= land_ms + decision_ms))
    }

    fn judge(&mut self, ms: u64, setting: &Setting) {
        let falls_k: Vec<Option<f64>> = match setting.session.trial.procedure {
            Procedure::Intervals { .. } => self.intervals_k.clone(),
            Procedure::Touch { .. } => {
                let stations = self.stations.iter();
                stations.map(|station| station.meter.fall_k()).collect()
            }
        };
        let stream = |purpose: &str| {
            let (key, number, attempt) = (&setting.key, self.number, self.attempt);
            Stream::new(setting.seed, &format!("{key} trial {number} attempt {attempt} {purpose}"))
        };
        let observer = &setting.participant.observer;
        let judgement = setting.task.as_ref().and_then(|task| {
            task.judge(&falls_k, observer, &mut stream("noise"), &mut stream("lapse"))
        });
        let since_ms = match self.interval {
            Some((_, begin_ms, length_ms)) => Some(begin_ms + length_ms),
            None => self.land_ms,
        };
        self.judged = Some(Judged {
            at_ms: ms,
            decision_s: since_ms.map_or(0.0, |since_ms| seconds(ms.saturating_sub(since_ms))),
            falls_k,
            judgement,
        });
    }

    /// The answer, once, when it has been decided and asked for. With it a hand that explores freely lifts.
    pub fn response(&mut self, ms: u64, setting: &Setting) -> Option<Response> {
        let judged = self.judged.as_ref()?;
        let reaction_ms = milliseconds(setting.participant.hand.reaction_s);
        let due_ms = judged.at_ms.max(self.asked_ms?) + reaction_ms;
        if self.is_answered || ms < due_ms || self.happens(&Happening::DoesNotAnswer) {
            return None;
        }
        let response = match judged.judgement.as_ref()? {
            Judgement::Choice(index) => Response::Choice(*index),
            Judgement::Numbers(numbers) => Response::Numbers(numbers.clone()),
        };
        self.is_answered = true;
        if let Procedure::Touch { contact: ContactRule::Free, .. } = setting.session.trial.procedure
        {
            self.lift(ms + reaction_ms);
        }
        Some(response)
    }

    /// What was felt until now.
    pub fn observation(&mut self, ms: u64, setting: &Setting) -> Observation {
        if self.judged.is_none() {
            self.judge(ms, setting);
        }
        let answered = self.judged.as_ref().filter(|_| self.is_answered);
        let judgement = answered.and_then(|judged| judged.judgement.as_ref());
        let (decision_s, falls_k) = match &self.judged {
            Some(judged) => (judged.decision_s, judged.falls_k.clone()),
            None => (0.0, Vec::new()),
        };
        Observation {
            trial: self.number,
            attempt: self.attempt,
            presented: (self.stations.iter())
                .map(|station| station.presented.to_string())
                .collect(),
            falls_k,
            decision_s,
            touches: self.land_ms.map_or(0, |_| self.touches.count_until(decision_s)),
            skin_c: self.skin_c,
            choice: match judgement {
                Some(Judgement::Choice(index)) => Some(*index),
                _ => None,
            },
            numbers: match judgement {
                Some(Judgement::Numbers(numbers)) => numbers.clone(),
                _ => Vec::new(),
            },
        }
    }
}

fn milliseconds(s: f64) -> u64 {
    (1e3 * s).round() as u64
}

fn seconds(ms: u64) -> f64 {
    ms as f64 * 1e-3
}
