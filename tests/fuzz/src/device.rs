//! A device on simulated tiles, whose outputs, states and answers are checked on every tick and
//! after every line.
//!
//! The limits are written out here as the documentation states them, and temperatures are computed
//! from the samples by the thermistor class's nominal curve. A wrong constant or conversion of the
//! firmware therefore cannot confirm itself.

use std::fmt::Display;

use thermal_display::device::command::{self, Command, Status, WithSourceFinger};
use thermal_display::device::drive::{BoardOutputs, ComparatorTest, Drive};
use thermal_display::device::events::UnsolicitedReport;
use thermal_display::device::safety::Fault;
use thermal_display::device::sense::Samples;
use thermal_display::device::{Device, FingerIndex, StateName, TriggerEdge};
use thermal_display::protocol::{
    CommandHandler, Error, LineError, LineReader, OutgoingLine, UnsolicitedLine,
};
use thermal_display::settings::Settings;
use thermal_learner::{Learner, LearnerOutput};

use crate::tile::{FULL_SCALE, Tile, sum_at};

/// Longest answer and telemetry line, bytes: the text, and `@n ` before it.
const ANSWER_MAX: usize = thermal_display::protocol::ANSWER_MAX_BYTES + 3;
const TELEMETRY_MAX: usize = 160 + 3;
/// Largest error of a display's reading, whatever settings lines have set, K: 2.52 of its
/// correction, 0.18 of the converter's steps, 0.04 of its self-heating.
pub const READING_ERROR_MAX_K: f64 = 2.8;
/// Beyond these true temperatures the bridge must be off: the trip limits, widened by the largest
/// error of a reading.
const SURELY_COLD_C: f64 = 13.5 - READING_ERROR_MAX_K;
const SURELY_HOT_C: f64 = 43.0 + READING_ERROR_MAX_K;

/// Codes of the heat-flux sensor.
#[derive(Clone, Copy, Debug)]
pub enum FluxCodes {
    /// Some flux under a force, with the noise of another channel.
    OfForce,
    /// These two in turn; a converter has 12 bits.
    InTurn([u16; 2]),
}

/// What answers the inputs of the learner.
#[derive(Clone, Copy, Debug)]
pub enum Answers {
    /// The learner.
    Learner,
    /// Nothing.
    None,
    /// This, with the number of the input.
    Always(LearnerOutput),
}

/// A device and its command handler, on one tile for each finger.
#[derive(Clone, Debug)]
pub struct CheckedDevice<const FINGERS: usize> {
    device: Device<FINGERS>,
    handler: CommandHandler<FINGERS>,
    tiles: [Tile; FINGERS],
    learners: [Learner; FINGERS],
    flux_codes: FluxCodes,
    answers: Answers,
    ticks: u32,
}

impl<const FINGERS: usize> CheckedDevice<FINGERS> {
    /// A device that has just been switched on.
    pub fn new() -> Self {
        let settings = Settings::default();
        Self {
            device: Device::new(&settings),
            handler: CommandHandler::new(settings),
            tiles: [Tile::default(); FINGERS],
            learners: [const { Learner::new() }; FINGERS],
            flux_codes: FluxCodes::OfForce,
            answers: Answers::Learner,
            ticks: 0,
        }
    }

    /// Has the heat-flux sensors read these codes from now on.
    pub fn set_flux_codes(&mut self, codes: FluxCodes) {
        self.flux_codes = codes;
    }

    /// Has this answer the learner's inputs from now on.
    pub fn set_answers(&mut self, answers: Answers) {
        self.answers = answers;
    }

    /// An answer that nobody has asked for, or to this input.
    pub fn answer_unasked(&mut self, finger: FingerIndex<FINGERS>, output: &LearnerOutput) {
        self.device.put_learner_output(finger, output);
    }

    /// The tile of a finger.
    pub fn tile(&mut self, finger: FingerIndex<FINGERS>) -> &mut Tile {
        &mut self.tiles[finger.index()]
    }

    /// Presses all fingers with this force.
    pub fn press_all(&mut self, force_n: f64) {
        self.tiles.iter_mut().for_each(|tile| tile.press(force_n));
    }

    /// State of a finger's station.
    pub fn state(&mut self, finger: FingerIndex<FINGERS>) -> StateName {
        self.status(finger).state
    }

    fn status(&mut self, finger: FingerIndex<FINGERS>) -> Status {
        match self.device.execute(Some(finger), Command::Status) {
            Ok(WithSourceFinger { content: command::Reply::Status(status), .. }) => status,
            other => panic!("the status query is answered by {other:?}"),
        }
    }

    fn states(&mut self) -> Vec<(FingerIndex<FINGERS>, StateName)> {
        FingerIndex::all().map(|finger| (finger, self.state(finger))).collect()
    }

    /// Display temperature of the first finger, °C, if it streams telemetry and has a reading.
    pub fn display_c(&self) -> Option<f64> {
        let telemetry = self.device.finger_telemetry_if_due(FingerIndex::FIRST)?.content;
        telemetry.display.map(|celsius| celsius.to_num())
    }

    /// Runs ticks of every finger on its tile.
    pub fn run(&mut self, ticks: u32) {
        for _ in 0..ticks {
            for finger in FingerIndex::all() {
                self.tick_with(finger, |_| ());
            }
        }
    }

    /// Runs one tick of a finger on its tile, with modified samples.
    pub fn tick_with(&mut self, finger: FingerIndex<FINGERS>, modify: impl FnOnce(&mut Samples)) {
        let mut samples = self.tile(finger).samples();
        modify(&mut samples);
        let outputs = self.step(finger, &samples);
        self.tile(finger).drive(outputs);
    }

    /// Trips all fingers; an earlier fault stays the reported one.
    pub fn trip_all(&mut self, fault: Fault) {
        let before = self.states();
        self.device.trip_all(fault);
        for (finger, before) in before {
            let expected = StateName::Tripped(before.fault().unwrap_or(fault));
            assert_eq!(self.state(finger), expected, "from {before:?}");
        }
    }

    /// An edge at the trigger input, which all fingers are told of; it changes no state's name.
    pub fn trigger(&mut self, edge: TriggerEdge) {
        let before = self.states();
        self.device.note_trigger_edge(edge);
        assert_eq!(self.states(), before, "by {edge:?}");
    }

    /// Restarts the host time-out.
    pub fn note_host_activity(&mut self) {
        self.device.note_host_activity();
    }

    /// Runs one tick and checks the outputs, the change of state and the telemetry.
    pub fn step(&mut self, finger: FingerIndex<FINGERS>, samples: &Samples) -> BoardOutputs {
        let before = self.state(finger);
        if self.device.finger_has_flux_sensor(finger) {
            self.ticks = self.ticks.wrapping_add(1);
            let code = match self.flux_codes {
                FluxCodes::OfForce => 1843 + samples.force / 32 + samples.display % 4,
                FluxCodes::InTurn(codes) => codes[self.ticks as usize % 2] & 0x0fff,
            };
            self.device.note_flux_code(finger, Some(code));
        }
        let outputs = self.device.step_finger(finger, samples);
        if let Some(input) = self.device.take_learner_input(finger) {
            let output = match self.answers {
                Answers::Learner => Some(*self.learners[finger.index()].advance(&input)),
                Answers::None => None,
                Answers::Always(output) => Some(LearnerOutput {
                    sequence: input.sequence,
                    revision: input.sequence,
                    ..output
                }),
            };
            if let Some(output) = output {
                self.device.put_learner_output(finger, &output);
            }
        }
        let Status { state, setpoint, .. } = self.status(finger);
        let allowed = match before {
            StateName::SelfTest => matches!(state, StateName::SelfTest | StateName::Armed),
            StateName::Preset | StateName::Contact => {
                matches!(state, StateName::Preset | StateName::Contact)
            }
            // A course may end on neutral.
            StateName::Stimulus => matches!(state, StateName::Stimulus | StateName::Armed),
            before => state == before,
        };
        let trips = state.fault().is_some() && before.fault().is_none();
        assert!(allowed || trips, "{before:?} to {state:?} by {samples:?}");
        check_outputs(outputs, state, samples);
        if let Some(setpoint) = setpoint {
            let setpoint_c: f64 = setpoint.to_num();
            assert!((15.0..=42.0).contains(&setpoint_c), "set-point {setpoint_c} C");
        }
        while let Some(event) = self.device.take_finger_event(finger) {
            let line = self.unsolicited(event);
            check_text(&self.to_host(&line), TELEMETRY_MAX);
        }
        if let Some(telemetry) = self.device.finger_telemetry_if_due(finger) {
            let demand_a: f64 = telemetry.content.demand.to_num();
            assert!(demand_a.abs() <= 6.0, "demand {demand_a} A");
            let off = outputs.drive == Drive::Off;
            assert!(!off || demand_a == 0.0, "demand {demand_a} A while off");
            let line = self.unsolicited(telemetry.into_report());
            check_text(&self.to_host(&line), TELEMETRY_MAX);
        }
        outputs
    }

    /// Passes a byte from the host through the line reader and checks the answer, if there is one.
    pub fn byte(&mut self, reader: &mut LineReader, byte: u8) {
        match reader.push(byte) {
            None => {}
            Some(Err(error)) => self.refuse(error),
            Some(Ok(line)) => {
                let _ = self.line(&line);
            }
        }
    }

    /// Answers bytes that form no line.
    pub fn refuse(&self, error: LineError) {
        let error = WithSourceFinger::from_whole_device(Error::from(error));
        check_answer(&self.to_host(&error), false);
    }

    /// A line to the host; its checksum is checked and taken away.
    fn unsolicited(
        &mut self,
        report: WithSourceFinger<UnsolicitedReport>,
    ) -> WithSourceFinger<UnsolicitedLine> {
        let device = &mut self.device;
        UnsolicitedLine::of_report(report, |finger, command| device.execute(finger, command))
    }

    fn to_host(&self, content: &dyn Display) -> String {
        let mut line = OutgoingLine::new();
        self.handler.write_line(&mut line, content);
        let mut line = String::from_utf8_lossy(&line).into_owned();
        assert_eq!(line.pop(), Some('\n'));
        let Some((text, digits)) = split_checksum(&line) else {
            return line;
        };
        let checksum = text.bytes().fold(0, |checksum, byte| checksum ^ byte);
        assert_eq!(digits, format!("{checksum:02X}"), "{line}");
        text.into()
    }

    /// Answers a line, and checks the answer and the changes of state.
    pub fn line(&mut self, line: &str) -> Result<String, String> {
        let before = self.states();
        // A line with a wrong checksum may do less than one without.
        let content = split_checksum(line).map_or(line, |(content, _)| content);
        let device = &mut self.device;
        let answer = self.handler.answer(line, |finger, command| device.execute(finger, command));
        let answer = answer.map(|reply| self.to_host(&reply)).map_err(|error| self.to_host(&error));
        let (Ok(text) | Err(text)) = &answer;
        check_answer(text, answer.is_ok());
        for (finger, before) in before {
            let state = self.state(finger);
            assert!(
                state == before || may_change_state(content, before, state),
                "{line:?}, answered {text:?}, changes the state from {before:?} to {state:?}"
            );
        }
        answer
    }
}

fn check_outputs(outputs: BoardOutputs, state: StateName, samples: &Samples) {
    if outputs.comparator_test != ComparatorTest::None {
        assert_eq!((state, outputs.drive), (StateName::SelfTest, Drive::Off), "comparator tested");
    }
    let Drive::On(duty) = outputs.drive else {
        return;
    };
    let may_drive = matches!(
        state,
        StateName::SelfTest
            | StateName::Armed
            | StateName::Preset
            | StateName::Contact
            | StateName::Stimulus
    );
    assert!(may_drive, "driven while {state:?}");
    let fraction: f64 = duty.fraction().to_num();
    assert!(fraction.abs() <= 0.9, "duty {fraction}");
    assert!(
        !samples.bridge_fault && !samples.emergency_stop,
        "driven while the bridge reports a fault or the emergency stop is pressed: {samples:?}"
    );
    let at_rail = samples.thermistor_sums().map(|sum| sum == 0 || sum >= FULL_SCALE);
    assert_eq!(at_rail, [false; 5], "driven without a thermistor: {samples:?}");
    // The hotter, the smaller the sum.
    let allowed = sum_at(SURELY_HOT_C)..=sum_at(SURELY_COLD_C);
    for sum in [samples.display, samples.display_check] {
        assert!(
            allowed.contains(&sum),
            "driven with a display at sum {sum}, allowed is {allowed:?}"
        );
    }
}

/// Whether a line may change a state in this way.
fn may_change_state(line: &str, from: StateName, to: StateName) -> bool {
    use StateName::{Armed, Contact, Off, Preset, Ready, SelfTest, Stimulus, Tripped};
    let mut words = line.split_ascii_whitespace().skip_while(|word| word.starts_with('@'));
    match (words.next().unwrap_or_default(), from) {
        // A second fault, still present, is reported next.
        ("clear", Tripped(_)) => matches!(to, Off | Tripped(_)),
        ("arm", Off) => to == SelfTest,
        ("arm", Ready | Preset | Contact | Stimulus) => to == Armed,
        ("tune", Stimulus) => to == Armed,
        ("start", Armed | Stimulus) => to == Preset,
        ("hold" | "play" | "pulse", Armed | Preset | Contact) => to == Stimulus,
        ("abort", SelfTest) => to == Off,
        ("abort", Armed | Preset | Contact | Stimulus) => to == Ready,
        _ => false,
    }
}

fn check_answer(answer: &str, ok: bool) {
    check_text(answer, ANSWER_MAX);
    let text = answer.strip_prefix('@').and_then(|rest| rest.get(2..)).unwrap_or(answer);
    let word = text.split(' ').next();
    assert_eq!(word, Some(if ok { "ok" } else { "err" }), "{answer:?}");
    // An error may quote the host's own words.
    let not_finite = |word: &str| word.ends_with("NaN") || word.ends_with("inf");
    assert!(!ok || !answer.split([' ', '=']).any(not_finite), "{answer:?}");
}

/// A line to the host is short and printable.
fn check_text(line: &str, bytes_max: usize) {
    assert!(line.len() <= bytes_max, "{} bytes: {line:?}", line.len());
    assert!(line.bytes().all(|byte| matches!(byte, b' '..=b'~')), "{line:?}");
}

/// A line, and the two digits of its checksum after it, if it ends like one.
fn split_checksum(line: &str) -> Option<(&str, &str)> {
    let end = line.len().checked_sub("*00".len())?;
    let (content, end) = line.split_at_checked(end)?;
    Some((content, end.strip_prefix('*')?))
}
