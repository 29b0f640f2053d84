//! A device on its tiles, and what must hold for it on every tick and after every line.
//!
//! Limits are written out here as the documentation has them, and temperatures are recomputed from the sums by the class's
//! curve, so that a wrong constant or a wrong conversion does not vouch for itself.

use thermal_display::commissioning::Desk;
use thermal_display::device::drive::{Drive, Outputs};
use thermal_display::device::safety::{Fault, State};
use thermal_display::device::sense::Samples;
use thermal_display::device::{Device, Finger};
use thermal_display::protocol::{Addressed, Command, Error, LineReader, Reply, Status};
use thermal_display::settings::Settings;

use crate::tile::{FULL, Tile, sum_at};

/// Longest answer and telemetry line, bytes: what is said, and `@n ` before it.
const ANSWER_MAX: usize = 172 + 3;
const TELEMETRY_MAX: usize = 128 + 3;
/// What a display's reading may be off by, whatever lines have set, K: 2.52 of its correction, 0.18 of the converter's
/// steps, 0.04 of its own warmth.
pub const READING_K: f64 = 2.8;
/// A display is off beyond these by either thermistor: its limits, and what its reading may be off by.
const SURELY_COLD_C: f64 = 13.5 - READING_K;
const SURELY_HOT_C: f64 = 43.0 + READING_K;

/// Hand, desk and tiles, and the sums beyond which a display is too cold or too hot.
#[derive(Clone, Debug)]
pub struct Device<const FINGERS: usize> {
    hand: Hand<FINGERS>,
    desk: Desk<FINGERS>,
    tiles: [Tile; FINGERS],
    cold_above: u16,
    hot_below: u16,
}

impl<const FINGERS: usize> Device<FINGERS> {
    /// Switched on.
    pub fn new() -> Self {
        let settings = Settings::default();
        Self {
            hand: Hand::new(&settings),
            desk: Desk::new(settings),
            tiles: [Tile::default(); FINGERS],
            cold_above: sum_at(SURELY_COLD_C),
            hot_below: sum_at(SURELY_HOT_C),
        }
    }

    /// The tile of a finger, counted modulo `FINGERS`.
    pub fn tile(&mut self, finger: usize) -> &mut Tile {
        &mut self.tiles[finger % FINGERS]
    }

    /// What a finger says of itself.
    pub fn status(&mut self, finger: usize) -> Status {
        let asked = Addressed {
            finger: Some((finger % FINGERS) as u8),
            content: Command::Status,
        };
        match self.hand.execute(asked) {
            Ok(Addressed {
                content: Reply::Status(status),
                ..
            }) => status,
            other => panic!("state is answered by {other:?}"),
        }
    }

    /// What the first finger's display reads, °C, if it streams and there is anything to read.
    pub fn display_c(&self) -> Option<f64> {
        let telemetry = self.hand.telemetry(0)?.content;
        telemetry.display.map(|celsius| celsius.to_num())
    }

    /// A tick of every finger on its tile.
    pub fn tick(&mut self) {
        for finger in 0..FINGERS {
            self.tick_with(finger, |_| ());
        }
    }

    /// A tick of one finger on its tile, whose samples something has changed.
    pub fn tick_with(&mut self, finger: usize, change: impl FnOnce(&mut Samples)) {
        let mut samples = self.tile(finger).samples();
        change(&mut samples);
        let outputs = self.step(finger, &samples);
        self.tile(finger).drive(outputs);
    }

    /// Trips all fingers.
    pub fn trip(&mut self, fault: Fault) {
        let before: [_; FINGERS] = std::array::from_fn(|finger| self.status(finger).state);
        self.hand.trip(fault);
        for (finger, before) in before.into_iter().enumerate() {
            let expected = State::Tripped(before.fault().unwrap_or(fault));
            assert_eq!(self.status(finger).state, expected, "of {before:?}");
        }
    }

    /// The host is there.
    pub fn hear(&mut self) {
        self.hand.hear();
    }

    /// One tick, whose outputs are looked at.
    pub fn step(&mut self, finger: usize, samples: &Samples) -> Outputs {
        let before = self.status(finger).state;
        let outputs = self.hand.step(finger, samples);
        let Status {
            state, setpoint, ..
        } = self.status(finger);
        let allowed = match before {
            State::Off | State::Ready => state == before,
            State::SelfTest => matches!(state, State::SelfTest | State::Armed),
            State::Armed => state == State::Armed,
            State::Preset | State::Contact => state.presents(),
            State::Tripped(_) => state == before,
        };
        let trips = state.fault().is_some() && before.fault().is_none();
        assert!(allowed || trips, "{before:?} to {state:?} by {samples:?}");
        self.look_at_outputs(outputs, state, samples);
        if let Some(setpoint) = setpoint {
            let setpoint_c: f64 = setpoint.to_num();
            assert!(
                (15.0..=42.0).contains(&setpoint_c),
                "set-point {setpoint_c} C"
            );
        }
        if let Some(telemetry) = self.hand.telemetry(finger) {
            let demand_a: f64 = telemetry.content.demand.to_num();
            assert!(demand_a.abs() <= 6.0, "demand {demand_a} A");
            let off = outputs.drive == Drive::Off;
            assert!(!off || demand_a == 0.0, "demand {demand_a} A while off");
            look_at_text(&telemetry.to_string(), TELEMETRY_MAX);
        }
        outputs
    }

    fn look_at_outputs(&self, outputs: Outputs, state: State, samples: &Samples) {
        let drives = matches!(
            state,
            State::SelfTest | State::Armed | State::Preset | State::Contact
        );
        if outputs.comparator_test {
            assert_eq!(
                (state, outputs.drive),
                (State::SelfTest, Drive::Off),
                "comparator tested"
            );
        }
        let Drive::On(duty) = outputs.drive else {
            return;
        };
        assert!(drives, "driven while {state:?}");
        let fraction: f64 = duty.fraction().to_num();
        assert!(fraction.abs() <= 0.9, "duty {fraction}");
        assert!(
            !samples.bridge_fault,
            "driven against the bridge's fault: {samples:?}"
        );
        let ends = samples.thermistors().map(|sum| sum == 0 || sum >= FULL);
        assert_eq!(ends, [false; 5], "driven without a thermistor: {samples:?}");
        for sum in [samples.display, samples.display_check] {
            let sound = self.hot_below..=self.cold_above;
            assert!(
                sound.contains(&sum),
                "driven with a display at sum {sum}, allowed is {sound:?}"
            );
        }
    }

    /// Bytes from the host, through its reader; answers are looked at.
    pub fn byte(&mut self, reader: &mut LineReader, byte: u8) {
        match reader.push(byte) {
            None => {}
            Some(Err(error)) => {
                let refused = Addressed::device(Error::from(error));
                look_at_answer(&refused.to_string(), false);
            }
            Some(Ok(line)) => {
                let _ = self.line(&line);
            }
        }
    }

    /// Answers a line; the states change by no other line than those that may change them.
    pub fn line(&mut self, line: &str) -> Result<String, String> {
        let before: [_; FINGERS] = std::array::from_fn(|finger| self.status(finger).state);
        let hand = &mut self.hand;
        let answer = self.desk.answer(line, |request| hand.execute(request));
        let (answer, done) = match answer {
            Ok(reply) => (reply.to_string(), true),
            Err(error) => (error.to_string(), false),
        };
        look_at_answer(&answer, done);
        for (finger, before) in before.into_iter().enumerate() {
            let state = self.status(finger).state;
            assert!(
                state == before || may_lead(line, before, state),
                "{line:?}, answered {answer:?}, leads from {before:?} to {state:?}"
            );
        }
        if done { Ok(answer) } else { Err(answer) }
    }
}

/// Whether a line may change a state so.
fn may_lead(line: &str, from: State, to: State) -> bool {
    let mut words = line
        .split_ascii_whitespace()
        .skip_while(|word| word.starts_with('@'));
    match (words.next().unwrap_or_default(), from) {
        // What tripped second comes to light.
        ("clear", State::Tripped(_)) => matches!(to, State::Off | State::Tripped(_)),
        (_, State::Tripped(_)) => false,
        ("arm", State::Off) => to == State::SelfTest,
        ("arm", State::Ready | State::Preset | State::Contact) => to == State::Armed,
        ("start", State::Armed) => to == State::Preset,
        ("abort", State::SelfTest) => to == State::Off,
        ("abort", State::Armed | State::Preset | State::Contact) => to == State::Ready,
        _ => false,
    }
}

fn look_at_answer(answer: &str, done: bool) {
    look_at_text(answer, ANSWER_MAX);
    let said = answer
        .strip_prefix('@')
        .and_then(|rest| rest.get(2..))
        .unwrap_or(answer);
    let word = said.split(' ').next();
    assert_eq!(word, Some(if done { "ok" } else { "err" }), "{answer:?}");
    // What is refused may quote the host.
    let number = |word: &str| word.ends_with("NaN") || word.ends_with("inf");
    assert!(!done || !answer.split([' ', '=']).any(number), "{answer:?}");
}

/// A line to the host is short and printable.
fn look_at_text(line: &str, longest: usize) {
    assert!(line.len() <= longest, "{} bytes: {line:?}", line.len());
    assert!(
        line.bytes().all(|byte| matches!(byte, b' '..=b'~')),
        "{line:?}"
    );
}
