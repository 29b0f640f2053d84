//! One finger's device, without its hardware: the states and arrows of [the guard](crate::safety), and what happens in them.
//!
//! Armed, the display is neutral: at skin temperature, touched or not, or where it is held for calibration.

use contact_model::fixed_point::{Celsius, ContactPair, Force};
use contact_model::material::{MATERIALS, SKIN};

use crate::TICK_HZ;
use crate::command::{Command, Refused, Reply, Status};
use crate::control::{Control, Law, Legs, Tuned, Voltage, Watt};
use crate::drive::{Current, Drive, Outputs, SafeCurrent};
use crate::hold::Hold;
use crate::identification::{Aborted, Experiment};
use crate::reference::{Mode, Render, Scene, Wanted};
use crate::safety::{
    self, Before, Cause, Dose, Fault, Progress, SelfTest, Setpoint, Sound, State, Watch,
};
use crate::sense::{Averages, Calibrated, Readings, Samples, Sensors, Touch};
use crate::telemetry::Telemetry;
use thermal_settings::Settings;

/// One finger's display: samples in, bridge command out, once per tick.
#[derive(Clone, Debug)]
pub struct Station {
    sensors: Sensors,
    voltage: Voltage,
    control: Control,

    state: State,
    /// Fault present in the last tick.
    fault: Option<Fault>,
    watch: Watch,
    self_test: SelfTest,
    /// What the bridge was told last.
    before: Before,
    cause: Option<Cause>,
    /// When it tripped for that; 0 if it was before the start.
    tripped_at: u32,
    /// What tripped while it was tripped, and no sample shows.
    also: Option<Fault>,
    /// What was told since the last tick, and no sample shows.
    told: Option<Fault>,
    touch: Touch,
    render: Render,
    material: Option<(&'static str, ContactPair)>,
    /// Of any material: how skin and display touch.
    any: Option<ContactPair>,
    object: Option<Celsius>,
    mode: Mode,
    /// Where the display is held while armed, instead of neutral.
    held: Option<Hold>,
    averages: Averages,
    /// Running while armed, or the last one's outcome.
    experiment: Option<Experiment>,

    tick: u32,
    stream_ticks: u32,
    telemetry: Telemetry,
}

/// What one tick makes of finger and scene.
#[derive(Clone, Copy, Debug)]
struct Followed {
    setpoint: Setpoint,
    limited: bool,
    target: Setpoint,
}

/// Neither driven nor tested.
const OFF: Outputs = Outputs {
    drive: Drive::Off,
    comparator_test: false,
};

impl Station {
    /// A station that is off.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        Self {
            sensors: Sensors::new(settings),
            voltage: Voltage::new(&settings.module),
            control: Control::new(settings),
            state: State::Off,
            fault: None,
            watch: Watch::default(),
            self_test: SelfTest::default(),
            before: Before::default(),
            cause: None,
            tripped_at: 0,
            also: None,
            told: None,
            touch: Touch::default(),
            render: Render::default(),
            material: None,
            any: ContactPair::new(
                &SKIN,
                &MATERIALS[0].1,
                &settings.display,
                1.0 / f64::from(TICK_HZ),
            )
            .ok(),
            object: None,
            mode: Mode::default(),
            held: None,
            averages: Averages::default(),
            experiment: None,
            tick: 0,
            stream_ticks: 0,
            telemetry: Telemetry::before_first_tick(),
        }
    }

    /// Reads and controls by other settings of the same class.
    pub(crate) fn restore(&mut self, settings: &Settings) {
        self.sensors.recalibrate(&Calibrated::new(settings));
        self.control.retune(&Tuned::new(settings));
    }

    /// One control tick: sense, render, control, guard.
    pub fn step(&mut self, samples: &Samples) -> Outputs {
        self.tick = self.tick.wrapping_add(1);
        // Nobody calibrates under a finger that feels an object.
        if !self.state.presents() {
            self.averages.take(&samples.thermistors());
        }
        let readings = self.sensors.read(samples);
        let checked = self.check(samples, &readings);
        let (followed, mut told) = match checked {
            Ok(sound) => {
                let finger = self.feel(samples, &sound);
                let followed = self.follow(&sound);
                let legs = self.control.legs(sound.display, sound.sink);
                self.control.observe(sound.display, sound.sink, finger);
                (
                    followed,
                    self.act(&sound, &readings, &legs, followed.as_ref()),
                )
            }
            Err(fault) => {
                // What finger and tile do meanwhile is not known.
                self.render.lose_sight();
                self.control.lose_sight();
                (None, Err(fault))
            }
        };
        self.fault = told.err().or(self.told.take());
        if let Err(fault) = told {
            self.latch(Cause::new(fault, self.tick, &readings, self.before.asked));
            told = Ok(self.rest(false));
        }
        let (outputs, current) = told.unwrap_or((OFF, Current::ZERO));
        self.before = Before {
            asked: current,
            setpoint: followed.map(|followed| followed.setpoint),
        };
        let setpoint = followed.map(|followed| (followed.setpoint, followed.limited));
        self.report(&readings, setpoint, current);
        outputs
    }

    /// Every detector looks at every tick; what a tick shows at once is named first.
    fn check(&mut self, samples: &Samples, readings: &Readings) -> Result<Sound, Fault> {
        let still = self.watch.samples(samples);
        let heat = self.watch.heat(readings);
        let level = safety::check(readings, self.control.limit());
        let streams = self.stream_ticks != 0;
        let watched = match &level {
            Ok(sound) => {
                let unlike_model = self.before.setpoint.is_some() && self.control.strays();
                self.watch
                    .check(sound, readings.current, &self.before, unlike_model, streams)
            }
            Err(fault) => {
                self.watch.forget_motion();
                Err(*fault)
            }
        };
        // The comparator keeps its line until the next self-test, and is expected to pull it at its beginning.
        let pulled = match self.state {
            State::Off | State::Tripped(_) => false,
            State::SelfTest => readings.bridge_fault && !self.self_test.expects_cut(),
            _ => readings.bridge_fault,
        };
        let bridge = if pulled { Err(Fault::Bridge) } else { Ok(()) };
        let sound = level?;
        bridge.and(watched).and(heat).and(still)?;
        Ok(sound)
    }

    /// Trips for a reason that samples do not show. If it is tripped, that comes to light when it is cleared.
    pub fn trip(&mut self, fault: Fault) {
        self.told = Some(fault);
        match self.state {
            State::Tripped(first) if first != fault => self.also = self.also.or(Some(fault)),
            State::Tripped(_) => {}
            _ => self.latch_alone(fault),
        }
    }

    fn latch_alone(&mut self, fault: Fault) {
        let cause = Cause {
            tick: self.tick,
            ..Cause::alone(fault)
        };
        self.latch(cause);
    }

    /// The first cause stays.
    pub fn latch(&mut self, cause: Cause) {
        if !self.is_tripped() {
            self.state = State::Tripped(cause.fault);
            self.cause = Some(cause);
            self.tripped_at = self.tick;
        }
    }

    /// What the station is doing.
    #[must_use]
    pub const fn state(&self) -> State {
        self.state
    }

    /// A fault is latched.
    #[must_use]
    pub const fn is_tripped(&self) -> bool {
        matches!(self.state, State::Tripped(_))
    }

    /// Tick of this start in which it tripped, 0 if that was before it.
    #[must_use]
    pub const fn tripped_at(&self) -> u32 {
        self.tripped_at
    }

    /// Why it tripped, now or the last time.
    #[must_use]
    pub const fn cause(&self) -> Option<&Cause> {
        self.cause.as_ref()
    }

    /// The dose so far.
    #[must_use]
    pub const fn dose(&self) -> &Dose {
        self.watch.dose()
    }

    /// Goes on from the dose before the start.
    pub const fn resume(&mut self, dose: Dose) {
        self.watch.resume(dose);
    }

    /// The host is there.
    pub const fn hear(&mut self) {
        self.watch.hear();
    }

    /// What the bridge is told in a tick without a fault, and the current that is asked for.
    ///
    /// # Errors
    /// The self-test's.
    fn act(
        &mut self,
        sound: &Sound,
        readings: &Readings,
        legs: &Legs,
        followed: Option<&Followed>,
    ) -> Result<(Outputs, Current), Fault> {
        if self.state == State::SelfTest {
            let touched = self.touch.lands() || self.touch.touching();
            return Ok(
                match self.self_test.step(
                    sound,
                    readings.current,
                    readings.bridge_fault,
                    touched,
                )? {
                    Progress::Off { comparator_test } => self.rest(comparator_test),
                    Progress::Drive(current) => {
                        self.control.follow(current);
                        self.drive(current, legs)
                    }
                    Progress::Passed => {
                        self.state = State::Armed;
                        self.rest(false)
                    }
                },
            );
        }
        let Some(followed) = followed else {
            return Ok(self.rest(false));
        };
        let tuning = self.tuning(sound, readings.current);
        let current =
            tuning.unwrap_or_else(|| self.control.update(followed.setpoint, followed.target));
        Ok(self.drive(current, legs))
    }

    fn drive(&self, current: Current, legs: &Legs) -> (Outputs, Current) {
        let current = SafeCurrent::saturating(current);
        let outputs = Outputs {
            drive: Drive::On(self.voltage.duty(current, legs)),
            comparator_test: false,
        };
        (outputs, current.ampere())
    }

    /// The bridge off.
    fn rest(&mut self, comparator_test: bool) -> (Outputs, Current) {
        self.end_experiment();
        self.control.follow(Current::ZERO);
        let outputs = Outputs {
            comparator_test,
            ..OFF
        };
        (outputs, Current::ZERO)
    }

    /// Follows the finger; the heat that it gives.
    fn feel(&mut self, samples: &Samples, sound: &Sound) -> Watt {
        let before = self.touch.touching();
        self.touch.update(sound.force);
        self.sensors.follow_zero(samples, &self.touch);
        let touching = self.touch.touching();
        let landed = if before { 0 } else { self.touch.landed_ticks() };
        let touch: Option<Force> = touching.then_some(sound.force);
        self.render.observe(sound.skin, sound.room, touch, landed);
        let display = self.control.surface(sound.display);
        let pair = self.material.as_ref().map(|(_, pair)| pair);
        // The skin is followed whatever the law, which may change under a finger.
        match pair.or(self.any.as_ref()) {
            Some(pair) => self.render.load(pair, display),
            None => Watt::ZERO,
        }
    }

    /// Follows the scene: where the display is to be, if anywhere.
    fn follow(&mut self, sound: &Sound) -> Option<Followed> {
        let only = |setpoint| Wanted {
            setpoint,
            target: setpoint,
        };
        let wanted = match self.state {
            State::Off | State::SelfTest | State::Ready | State::Tripped(_) => return None,
            State::Armed => only(match (&self.experiment, &mut self.held) {
                (Some(experiment), _) if experiment.drives() => experiment.rest().celsius(),
                (_, Some(held)) => held.step().celsius(),
                (_, None) => self.render.neutral()?,
            }),
            State::Preset | State::Contact => {
                self.state = if self.touch.touching() {
                    State::Contact
                } else {
                    State::Preset
                };
                let (_, pair) = self.material.as_ref()?;
                let scene = Scene {
                    pair,
                    object: self.object,
                    mode: self.mode,
                };
                let display = self.control.surface(sound.display);
                let live = self.control.law() == Law::Model;
                self.render.present(&scene, display, live)?
            }
        };
        let (setpoint, limited) = Setpoint::limited(wanted.setpoint);
        Some(Followed {
            setpoint,
            limited,
            target: Setpoint::limited(wanted.target).0,
        })
    }

    /// Current of the experiment, if one goes on.
    fn tuning(&mut self, sound: &Sound, measured: Current) -> Option<Current> {
        let experiment = self.experiment.as_mut()?;
        // Whatever its outcome, it has no say once an object is presented.
        if self.state != State::Armed {
            experiment.abort(Aborted::Ended);
            return None;
        }
        if !experiment.drives() {
            return None;
        }
        let current = experiment.update(sound, measured, self.touch.touching());
        if let Some(current) = current {
            self.control.follow(current);
        }
        current
    }

    fn end_experiment(&mut self) {
        if let Some(experiment) = &mut self.experiment {
            experiment.abort(Aborted::Ended);
        }
    }

    fn report(
        &mut self,
        readings: &Readings,
        setpoint: Option<(Setpoint, bool)>,
        current: Current,
    ) {
        self.telemetry = Telemetry {
            tick: self.tick,
            state: self.state,
            setpoint: setpoint.map(|(setpoint, _)| setpoint.celsius()),
            limited: setpoint.is_some_and(|(_, limited)| limited),
            display: readings.display.ok(),
            sink: readings.sink.ok(),
            skin: readings.skin.ok(),
            room: readings.room.ok(),
            force: readings.force,
            demand: current,
            current: readings.current,
            evaluations: self.render.evaluations(),
        };
    }

    /// Telemetry of the last tick, if it is due.
    #[must_use]
    pub fn telemetry(&self) -> Option<Telemetry> {
        let due = self.stream_ticks != 0 && self.tick.is_multiple_of(self.stream_ticks);
        due.then_some(self.telemetry)
    }

    fn status(&self) -> Status {
        Status {
            state: self.state,
            material: self.material.map(|(name, _)| name),
            object: self.object,
            mode: self.mode,
            setpoint: self.telemetry.setpoint,
            limited: self.telemetry.limited,
        }
    }

    /// Executes a command of the host, in bounded and short time.
    ///
    /// # Errors
    /// The command does not fit the state; nothing has changed.
    pub fn execute(&mut self, command: Command) -> Result<Reply, Refused> {
        match command {
            // Nothing that a finger feels is moved by a line.
            Command::Calibrate(_) | Command::Average(_) | Command::Retune(_)
                if self.state.presents() =>
            {
                return Err(Refused::Presenting);
            }
            // A reading that steps would be taken for the display's answer.
            Command::Calibrate(_) | Command::Average(_) if self.state == State::SelfTest => {
                return Err(Refused::Testing);
            }
            Command::Status => return Ok(Reply::Status(self.status())),
            Command::Stream { interval_ms } => self.stream_ticks = interval_ms * (TICK_HZ / 1000),
            // Another object, under whatever finger rests there: a new contact.
            Command::Material { name, pair } => {
                self.material = Some((name, pair));
                self.render.forget_contact();
            }
            Command::Object(object) => {
                self.object = object;
                self.render.forget_contact();
            }
            Command::Mode(mode) => {
                if mode != self.mode {
                    self.render.forget_contact();
                }
                self.mode = mode;
            }
            Command::Law(None) => return Ok(Reply::Law(self.control.law())),
            Command::Law(Some(law)) => self.control.select(law),
            Command::Arm => match self.state {
                State::Tripped(fault) => return Err(Refused::Tripped(fault)),
                State::SelfTest => {}
                State::Off => {
                    self.experiment = None;
                    self.held = None;
                    self.self_test = SelfTest::default();
                    // What the display was long ago says nothing.
                    self.control.lose_sight();
                    self.state = State::SelfTest;
                }
                _ => {
                    self.experiment = None;
                    self.held = None;
                    self.state = State::Armed;
                }
            },
            Command::Hold(setpoint) => match self.state {
                State::Tripped(fault) => return Err(Refused::Tripped(fault)),
                State::Armed => {
                    self.experiment = None;
                    self.held = self.telemetry.display.map(|from| Hold::new(setpoint, from));
                }
                _ => return Err(Refused::NeedsArmed("hold")),
            },
            Command::Start => match (self.state, self.material) {
                (State::Tripped(fault), _) => return Err(Refused::Tripped(fault)),
                (State::Off | State::Ready, _) => return Err(Refused::NotArmed),
                (State::SelfTest, _) => return Err(Refused::Testing),
                (_, None) => return Err(Refused::NoMaterial),
                (State::Armed, Some(_)) => {
                    self.render.forget_contact();
                    self.held = None;
                    self.averages = Averages::default();
                    self.state = State::Preset;
                }
                (State::Preset | State::Contact, Some(_)) => return Err(Refused::AlreadyStarted),
            },
            // Never refused: off is what it asks for, and tripped is off.
            Command::Abort => match self.state {
                State::Tripped(_) | State::Ready => {}
                State::Off | State::SelfTest => self.state = State::Off,
                State::Armed | State::Preset | State::Contact => self.state = State::Ready,
            },
            Command::Cause => return Ok(Reply::Cause(self.cause)),
            Command::Clear => match (self.state, self.fault) {
                (State::Tripped(_), None) => {
                    self.state = State::Off;
                    if let Some(fault) = self.also.take() {
                        self.latch_alone(fault);
                        return Err(Refused::StillFaulty(fault));
                    }
                }
                (State::Tripped(_), Some(fault)) => return Err(Refused::StillFaulty(fault)),
                _ => return Err(Refused::NothingToClear),
            },
            Command::Average(thermistor) => {
                let average = self.averages.of(thermistor);
                return average.map(Reply::Average).ok_or(Refused::TooEarly);
            }
            Command::Tune => match (self.state, self.telemetry.sink) {
                (State::Tripped(fault), _) => return Err(Refused::Tripped(fault)),
                (State::Armed, _) if self.touch.touching() => return Err(Refused::Touched),
                (State::Armed, Some(sink)) => {
                    self.held = None;
                    self.experiment = Some(Experiment::new(sink));
                }
                _ => return Err(Refused::NeedsArmed("tune")),
            },
            Command::Experiment(row) => {
                if let State::Tripped(fault) = self.state {
                    return Err(Refused::Tripped(fault));
                }
                let experiment = self.experiment.as_ref().ok_or(Refused::NotTuned)?;
                let rows = experiment.outcome().ok_or(Refused::Tuning)?;
                let row = rows.map_err(Refused::TuneAborted)?.get(row);
                return row.map(|row| Reply::Row(*row)).ok_or(Refused::NotTuned);
            }
            Command::Calibrate(calibrated) => {
                // A reading that jumps would be taken for the tile's.
                self.end_experiment();
                self.sensors.recalibrate(&calibrated);
                self.control.rescale();
                self.watch.forget_motion();
            }
            Command::Retune(tuned) => {
                self.control.retune(&tuned);
                if let Some(experiment) = &mut self.experiment {
                    experiment.release();
                }
            }
        }
        Ok(Reply::Done)
    }
}
