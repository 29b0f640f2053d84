//! The bench: participant, samples and device in virtual time, as the executor of a session meets them.

mod trial;

use std::cell::RefCell;
use std::collections::VecDeque;
use std::convert::Infallible;
use std::rc::Rc;
use std::time::Duration;

use contact_model::material::Material;
use serde::Serialize;
use thermal_client::link::{Link, LinkError, ReceivedLine};
use thermal_device::command::AssumedFinger;
use thermal_plant::finger::FingerParams;
use thermal_plant::parameters::stream_seed;
use thermal_plant::sensors::FluxParams;
use thermal_plant::{ConfigError, Params};
use thermal_session::{
    AnswerKind, ContactRule, Decision, Departure, People, Phase, Plan, PlannedTrial, Presented,
    Procedure, Response, Session, Update,
};
use thermal_sim::simulated_link::VirtualLine;

use crate::device::{FingerInput, PreparedDevice, RunningDevice};
use crate::falls::{TouchSetup, mean_fall_k};
use crate::observer::{Sensation, Task};
use crate::operator::{Happening, Operator, SimulatedEvent};
use crate::participant::{Participant, SkinParams};
use crate::{HandParams, ObserverParams};

use trial::RunningTrial;

/// Why there is no bench for a session, or why it stopped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BenchError {
    /// A value that the simulated plant does not accept.
    #[error(transparent)]
    Plant(#[from] ConfigError),
    /// The simulated device cannot be commissioned.
    #[error("the simulated device cannot be commissioned: {0}")]
    Commissioning(String),
    /// The simulated device refuses a command, or does not do what it should.
    #[error("the simulated device: {0}")]
    Device(String),
    /// A material whose properties are not known.
    #[error("material {0} is not known")]
    Material(String),
    /// The simulated observer does not know what these answers mean.
    #[error(
        "the simulated observer does not understand the answers {0:?}: they must be names of stations, names of materials, \
         'same' and 'different', or two intervals"
    )]
    Answers(Vec<String>),
    /// A question whose direction is not known.
    #[error(
        "the simulated observer does not know what {0:?} asks for: allowed is a question of cold (cold, cool) or of warmth (warm, \
         hot), not of both"
    )]
    Question(String),
    /// The simulated finger is too thin.
    #[error("the simulated finger is thinner than the depth of its receptors")]
    NoReceptors,
}

/// Properties of the bench and of the participant.
#[derive(Clone, Debug)]
pub struct BenchOptions {
    /// Noise and decisions; `None` for those of [`ObserverParams::of_session`].
    pub observer: Option<ObserverParams>,
    /// Movements.
    pub hand: HandParams,
    /// Skin temperatures.
    pub skin: SkinParams,
    /// The finger at every station; `None` for the one that the session's displays are told to assume, or the thesis's without
    /// displays.
    pub finger: Option<FingerParams>,
    /// Room temperature, °C; also that of samples.
    pub room_c: f64,
    /// Weight of the skin under the contact in the temperature at the skin thermistor, 0 to 1; `None` for that of the plant,
    /// whose thermistor lies 2 to 3 mm beside the contact.
    pub edge_share: Option<f64>,
    /// Whether the displays have heat-flux sensors.
    pub has_flux_sensor: bool,
    /// Seed of the device's parts.
    pub device_seed: u64,
    /// Whether the device stays as it is from trial to trial, as a real one does, instead of being powered up for each: then what
    /// is measured in a trial depends on those before it.
    pub keeps_device: bool,
    /// What happens on purpose.
    pub events: Vec<SimulatedEvent>,
}

impl Default for BenchOptions {
    fn default() -> Self {
        Self {
            observer: None,
            hand: HandParams::TYPICAL,
            skin: SkinParams::TYPICAL,
            finger: None,
            room_c: 24.0,
            edge_share: None,
            has_flux_sensor: false,
            keeps_device: false,
            device_seed: 1,
            events: Vec::new(),
        }
    }
}

impl BenchOptions {
    /// Share of the fall under the contact that a thermistor at its edge sees: section 4.4 of the thesis has measured 0.26 to
    /// 0.32 of it.
    pub const EDGE_SHARE: f64 = 0.28;

    /// Those of a session: where falls of the skin are what is measured, the thermistor lies at the edge of the contact, as in
    /// section 4.4 of the thesis.
    pub fn of_session(session: &Session) -> Self {
        let measures_falls = session.score.analyses.iter().any(|word| word == "falls");
        Self { edge_share: measures_falls.then_some(Self::EDGE_SHARE), ..Self::default() }
    }

    /// Parameters of plants with the finger of a session.
    fn params(&self, session: &Session) -> Params {
        let has_displays = !session.device_fingers().is_empty();
        let device = session.device.as_ref().filter(|_| has_displays);
        let assumed = device.map(|device| device.assumed_finger);
        let mut params = Params::nominal();
        params.finger = self.finger.clone().unwrap_or_else(|| match assumed {
            None | Some(AssumedFinger::Thesis) => FingerParams::homogeneous(),
            Some(AssumedFinger::Mean) => FingerParams::layered(),
            // A finger that comes from an insulating pad loses no heat before the contact.
            Some(AssumedFinger::MeanOnPad) => {
                FingerParams { air_w_m2k: 0.0, ..FingerParams::layered() }
            }
        });
        params.flux = self.has_flux_sensor.then_some(FluxParams::NOMINAL);
        if let Some(share) = self.edge_share {
            params.sensors.skin_sees_contact = share;
        }
        params
    }
}

/// What the observer has felt in a trial, and the answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Observation {
    /// Number of the trial.
    pub trial: u32,
    /// Number of the attempt at it.
    pub attempt: u32,
    /// What each station presented, in words.
    pub presented: Vec<String>,
    /// Fall of each station, K, without noise, or of each interval; `None` where nothing was felt.
    pub falls_k: Vec<Option<f64>>,
    /// Time from the first landing, or the end of the last interval, to the decision, s.
    pub decision_s: f64,
    /// Number of touches of the hand until then.
    pub touches: usize,
    /// Skin before contact, °C.
    pub skin_c: f64,
    /// Index of the answer.
    pub choice: Option<usize>,
    /// Magnitudes of the stations.
    pub numbers: Vec<f64>,
}

/// A simulated participant at a simulated bench, for one session.
#[derive(Clone, Debug)]
pub struct Bench(Rc<RefCell<State>>);

/// The line to the device of a bench. A bench of a session that needs no device has a line on which nothing answers, and only
/// time passes.
#[derive(Clone, Debug)]
pub struct BenchLink(Rc<RefCell<State>>);

/// Participant and operator of a bench.
#[derive(Clone, Debug)]
pub struct BenchPeople(Rc<RefCell<State>>);

/// What does not change in a session.
#[derive(Debug)]
struct Setting {
    session: Session,
    /// Names of random streams begin with it.
    key: String,
    seed: u64,
    options: BenchOptions,
    params: Params,
    participant: Participant,
    task: Option<Task>,
    device: Option<PreparedDevice>,
}

#[derive(Debug)]
struct State {
    setting: Setting,
    device: Option<RunningDevice>,
    line: VirtualLine,
    trial: Option<RunningTrial>,
    observations: Vec<Observation>,
    operator: Operator,
    decisions: VecDeque<Decision>,
    failure: Option<BenchError>,
}

impl Bench {
    /// The bench of a session for the participant with a code, drawn from a seed. A device is commissioned if the
    /// session needs one.
    ///
    /// # Errors
    /// The session has something that cannot be simulated.
    pub fn new(
        session: &Session,
        plan: &Plan,
        code: &str,
        seed: u64,
        options: BenchOptions,
    ) -> Result<Self, BenchError> {
        let observer = options.observer.unwrap_or_else(|| ObserverParams::of_session(session));
        let participant =
            Participant::new(session, code, seed, &options.skin, options.hand, observer);
        let params = options.params(session);
        let stations = || plan.trials.iter().flat_map(|trial| &trial.presented);
        for presented in stations() {
            if let Presented::Sample { material } = presented {
                known_material(session, material)?;
            }
        }
        let reporting = (plan.trials.iter()).flat_map(|trial| session.reporting_fingers(trial));
        let last = session.needs_device().then(|| reporting.max().unwrap_or(0));
        let device = match last {
            Some(last) => Some(PreparedDevice::new(
                &params,
                options.room_c,
                options.device_seed,
                usize::from(last) + 1,
            )?),
            None => None,
        };
        let task = task(session, plan, &params, &participant, &options)?;
        let key = format!("{} {code}", session.task);
        let mut state = State {
            setting: Setting {
                session: session.clone(),
                key,
                seed,
                options,
                params,
                participant,
                task,
                device,
            },
            device: None,
            line: VirtualLine::default(),
            trial: None,
            observations: Vec::new(),
            operator: Operator::default(),
            decisions: VecDeque::new(),
            failure: None,
        };
        let skin_c = state.setting.participant.skin_c(0.0);
        state.power_up(skin_c, "before the first trial")?;
        Ok(Self(Rc::new(RefCell::new(state))))
    }

    /// The line to the device.
    pub fn link(&self) -> BenchLink {
        BenchLink(Rc::clone(&self.0))
    }

    /// Participant and operator.
    pub fn people(&self) -> BenchPeople {
        BenchPeople(Rc::clone(&self.0))
    }

    /// The participant.
    pub fn participant(&self) -> Participant {
        self.0.borrow().setting.participant
    }

    /// What the observer has felt in each trial until its end, and the answers.
    pub fn observations(&self) -> Vec<Observation> {
        self.0.borrow().observations.clone()
    }
}

impl Link for BenchLink {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        let mut state = self.0.borrow_mut();
        if state.device.is_some() {
            state.line.send(bytes);
        }
        Ok(())
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        let mut state = self.0.borrow_mut();
        let end = state.line.now() + timeout;
        while !state.line.has_line() && state.line.now() < end {
            state.step_1_ms();
            if let Some(failure) = &state.failure {
                return Err(LinkError::Gone(failure.to_string()));
            }
        }
        Ok(state.line.next_line())
    }

    fn now(&self) -> Duration {
        self.0.borrow().line.now()
    }
}

impl People for BenchPeople {
    fn inform(&mut self, update: &Update) {
        self.0.borrow_mut().inform(update);
    }

    fn response(&mut self) -> Option<Response> {
        let mut state = self.0.borrow_mut();
        let State { trial, setting, line, .. } = &mut *state;
        trial.as_mut()?.response(line.ms(), setting)
    }

    fn decision(&mut self) -> Option<Decision> {
        self.0.borrow_mut().decisions.pop_front()
    }
}

impl State {
    /// The device as it is after power-up, if the bench has one, but with the doses that it has counted: the skin has taken them.
    /// What is on the line is lost.
    fn power_up(&mut self, skin_c: f64, purpose: &str) -> Result<(), BenchError> {
        let setting = &self.setting;
        let noise_seed = stream_seed(setting.seed, &format!("{} {purpose} device", setting.key));
        let before = self.device.take();
        self.device = match &setting.device {
            Some(device) => {
                let device = device.power_up(skin_c, noise_seed)?;
                Some(match &before {
                    Some(before) => device.with_doses_of(before),
                    None => device,
                })
            }
            None => None,
        };
        self.line.clear();
        Ok(())
    }

    fn inform(&mut self, update: &Update) {
        let ms = self.line.ms();
        match update {
            Update::Trial { trial, attempt, of } => {
                if let Err(error) = self.begin_trial(trial, *attempt, *of) {
                    self.failure = Some(error);
                }
            }
            Update::Decide(question) => {
                let decision = self.operator.decide(question);
                self.decisions.push_back(decision);
            }
            Update::Phase(phase) => self.begin_phase(*phase),
            Update::TrialEnded { .. } => self.end_trial(),
            _ => {}
        }
        if let Some(trial) = &mut self.trial {
            trial.inform(update, ms, &self.setting);
        }
    }

    fn begin_trial(
        &mut self,
        trial: &PlannedTrial,
        attempt: u32,
        of: usize,
    ) -> Result<(), BenchError> {
        self.end_trial();
        self.operator.begin_trial();
        self.decisions.clear();
        let running = RunningTrial::new(trial, attempt, of, self.line.ms(), &self.setting)?;
        let purpose = format!("trial {} attempt {attempt}", trial.number);
        if !self.setting.options.keeps_device {
            self.power_up(running.skin_c(), &purpose)?;
        }
        self.trial = Some(running);
        Ok(())
    }

    /// What the operator decides on purpose when a phase begins replaces other decisions.
    fn begin_phase(&mut self, phase: Phase) {
        let Some(trial) = &self.trial else {
            return;
        };
        let decided = trial.happenings().find_map(|what| match what {
            Happening::Decides(of, decision) if *of == phase => Some(*decision),
            _ => None,
        });
        if let Some(decision) = decided {
            self.decisions.clear();
            self.decisions.push_back(decision);
        }
    }

    /// Records what was felt. The fingers are at rest until the next trial.
    fn end_trial(&mut self) {
        if let Some(mut trial) = self.trial.take() {
            self.observations.push(trial.observation(self.line.ms(), &self.setting));
        }
    }

    fn step_1_ms(&mut self) {
        let mut inputs = [FingerInput::default(); thermal_sim::five_fingers::FINGERS];
        let mut faults = Vec::new();
        if let Some(trial) = &mut self.trial {
            trial.step_1_ms(self.line.ms(), self.device.as_mut(), &mut inputs);
            trial.faults(self.line.ms(), &mut faults);
        }
        let device = &mut self.device;
        let Ok(()) = self.line.pass_1_ms(|bytes, received| -> Result<(), Infallible> {
            if let Some(device) = device {
                device.run_1_ms(bytes, &inputs, &faults);
                device.receive(received);
            }
            Ok(())
        });
        if let Some(trial) = &mut self.trial {
            let felt = trial.feel(self.line.ms(), self.device.as_mut(), &self.setting);
            if let Err(error) = felt {
                self.failure = Some(error);
            }
        }
    }
}

/// What the observer decides in a session; `None` if it is asked nothing.
fn task(
    session: &Session,
    plan: &Plan,
    params: &Params,
    participant: &Participant,
    options: &BenchOptions,
) -> Result<Option<Task>, BenchError> {
    let Some(answer) = &session.answer else {
        return Ok(None);
    };
    let named = match Sensation::named(&answer.ask)[..] {
        [] => None,
        [sensation] => Some(sensation),
        _ => return Err(BenchError::Question(answer.ask.clone())),
    };
    // Who is not told compares what the thesis's participants did.
    let sensation = named.unwrap_or(Sensation::Cold);
    let words = match &answer.kind {
        AnswerKind::NumberPerStation(none, full) => {
            return Ok(Some(Task::Magnitude(sensation, *none, *full)));
        }
        AnswerKind::OneOf(words) => words,
    };
    let position = |wanted: &str| words.iter().position(|word| word == wanted);
    let not_understood = || BenchError::Answers(words.clone());
    if let Procedure::Intervals { .. } = session.trial.procedure {
        return match words.len() {
            2 => {
                let sign = named.map(|sensation| sensation.of_fall(1.0));
                Ok(Some(Task::Interval(sign.or_else(|| interval_sign(plan)))))
            }
            _ => Err(not_understood()),
        };
    }
    if let (Some(same), Some(different)) = (position("same"), position("different")) {
        return Ok(Some(Task::Same(same, different)));
    }
    let stations: Option<Vec<usize>> = words
        .iter()
        .map(|word| session.stations.iter().position(|station| station.name == *word))
        .collect();
    if let Some(stations) = stations {
        return Ok(Some(match stations.len() {
            0..=2 => Task::Extreme(sensation, stations),
            _ => Task::Different(stations),
        }));
    }
    // Familiarisation: the observer has touched a sample of each material.
    let setup = TouchSetup {
        params: params.clone(),
        skin_c: participant.rest_c,
        room_c: options.room_c,
        hand: participant.hand,
        contact: ContactRule::Free,
        assumed_finger: AssumedFinger::default(),
        decision_median_s: participant.observer.decision_median_s,
        decision_sigma_ln: participant.observer.decision_sigma_ln,
    };
    let expected_k: Result<Vec<f64>, BenchError> = words
        .iter()
        .map(|word| {
            let material = known_material(session, word).map_err(|_| not_understood())?;
            mean_fall_k(&setup, &material)
        })
        .collect();
    Ok(Some(Task::Identify(expected_k?)))
}

/// The material of a name in a session.
fn known_material(session: &Session, name: &str) -> Result<Material, BenchError> {
    (session.material(name)).ok_or_else(|| BenchError::Material(name.into()))
}

/// The direction that the participant knows: 1 if all intervals of the plan depart to the cold, -1 if all to the warm.
fn interval_sign(plan: &Plan) -> Option<f64> {
    let stations = plan.trials.iter().flat_map(|trial| &trial.presented);
    let pulses = stations.filter_map(|presented| match presented {
        Presented::Pulses { departures_k, .. } => Some(departures_k),
        _ => None,
    });
    let mut directions = pulses.flatten().filter_map(|departure| {
        let towards_k = match departure {
            Departure::Fixed(k) => *k,
            Departure::Staircase { standard_k, sign } => standard_k + sign,
        };
        (towards_k != 0.0).then_some(-towards_k.signum())
    });
    let first = directions.next()?;
    directions.all(|sign| sign == first).then_some(first)
}
