//! What the device reports.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};
use thermal_device::StateName;
use thermal_device::learning::{FingerKnowledge, FluxSensorTest};
use thermal_device::reference::ContactModel;
use thermal_device::safety::{Fault, SelfTestResult, SideLine};
use thermal_settings::{FluxSensor, Vocabulary as _};
use thermal_wire::Request;
use thermal_wire::host::{fault, finite, knowledge, state};
use thermal_wire::request::SessionRequest;
use thermal_wire::setting::Setting;
use thermal_wire::telemetry::{TUNED_WORD, UNTUNED_WORD};

use super::Fields;
use super::fields::{fault_word, flux_sensor_numbers, knowledge_word, state_word};

/// Largest number of fingers that a device can have. The answer to `id` may be damaged before checksums are on, and a client loops over
/// the number in it.
const FINGERS_MAX: u8 = 5;

/// Answer to `id`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Identity {
    /// Name of the firmware.
    pub name: String,
    /// Its version.
    pub version: String,
    /// Number of fingers, 1 to 5.
    pub fingers: u8,
    /// Control ticks per second.
    pub tick_hz: u32,
    /// Scans of all sensors per second.
    pub scan_hz: u32,
    /// Version of the protocol; `None` from firmware that does not report it.
    pub protocol: Option<u32>,
    /// What this firmware can do beyond the first version of the protocol.
    pub capabilities: Vec<String>,
}

impl Identity {
    pub(super) fn read(reply: &Fields<'_>) -> Option<Self> {
        let mut words = reply.words();
        let capabilities = reply.word("capabilities").unwrap_or_default();
        let capabilities = capabilities.split(',').filter(|word| !word.is_empty());
        Some(Self {
            name: words.next()?.into(),
            version: words.next()?.into(),
            fingers: reply
                .number("fingers")
                .filter(|fingers| (1..=FINGERS_MAX).contains(fingers))?,
            tick_hz: reply.number("tick_hz")?,
            scan_hz: reply.number("scan_hz")?,
            protocol: reply.number("protocol"),
            capabilities: capabilities.map(Into::into).collect(),
        })
    }

    /// Whether the firmware has this capability.
    pub fn can(&self, capability: &str) -> bool {
        self.capabilities.iter().any(|known| known == capability)
    }
}

/// Answer to `state`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Status {
    /// State, with the fault if it is tripped.
    #[serde(serialize_with = "state_word")]
    pub state: StateName,
    /// Material of the object; `None` before one is chosen.
    pub material: Option<String>,
    /// Temperature of the object before contact, °C; `None` for that of the room.
    pub object_c: Option<f64>,
    /// Contact model.
    #[serde(serialize_with = "mode_word")]
    pub mode: ContactModel,
    /// Set-point, °C.
    pub setpoint_c: Option<f64>,
    /// Whether the set-point is limited to its safe range.
    pub limited: bool,
    /// Word for the body of the object.
    pub body: String,
    /// Whether the tile was identified; if not, set-points are limited to a small range and slow. `None` from firmware without
    /// the capability `untuned`.
    pub is_tuned: Option<bool>,
}

fn mode_word<S: Serializer>(mode: &ContactModel, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(mode.name())
}

impl Status {
    pub(super) fn read(reply: &Fields<'_>) -> Option<Self> {
        let material = reply.word("material")?;
        Some(Self {
            state: state(reply.word("state")?, reply.word("fault")?)?,
            material: (material != "-").then(|| material.into()),
            object_c: match reply.word("object_c")? {
                "room" => None,
                word => Some(finite(word)?),
            },
            mode: ContactModel::of_word(reply.word("mode")?)?,
            setpoint_c: reply.number_or_unknown("setpoint_c")?,
            limited: reply.words().any(|word| word == "limited"),
            body: reply.word("body")?.into(),
            is_tuned: match reply.word("tile") {
                None => None,
                Some(TUNED_WORD) => Some(true),
                Some(UNTUNED_WORD) => Some(false),
                Some(_) => return None,
            },
        })
    }
}

/// Answer to `cause`: why the device tripped.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cause {
    /// The fault.
    #[serde(serialize_with = "fault_word")]
    pub fault: Fault,
    /// Tick of the trip.
    pub tick: u32,
    /// First display thermistor, °C.
    pub display_c: Option<f64>,
    /// Second display thermistor, °C.
    pub check_c: Option<f64>,
    /// Thermistor of the sink, °C.
    pub sink_c: Option<f64>,
    /// Magnitude of the measured current, A.
    pub current_a: f64,
    /// Demanded current, A; positive cools.
    pub asked_a: f64,
}

impl Cause {
    pub(super) fn read(reply: &Fields<'_>) -> Option<Option<Self>> {
        let word = reply.word("cause")?;
        if word == "-" {
            return Some(None);
        }
        Some(Some(Self {
            fault: fault(word)?,
            tick: reply.number("tick")?,
            display_c: reply.number_or_unknown("display_c")?,
            check_c: reply.number_or_unknown("check_c")?,
            sink_c: reply.number_or_unknown("sink_c")?,
            current_a: reply.number("current_a")?,
            asked_a: reply.number("asked_a")?,
        }))
    }
}

/// Answer to a calibration point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CalibrationFit {
    /// Number of points of this thermistor so far.
    pub points: u32,
    /// Largest difference between device and reference at these points, mK.
    pub worst_mk: f64,
}

/// The tile as identified by the device, and the stability margins of its control loop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct IdentifiedTile {
    /// Rate of change of the plate temperature per demanded current, K/s per A.
    pub gain_k_s_a: f64,
    /// Relative loss of this gain by Joule heat per current, 1/A.
    pub joule_per_a: f64,
    /// Rate at which the plate relaxes, 1/s.
    pub leak_1_s: f64,
    /// Lag of the display's thermistor, s.
    pub lag_s: f64,
    /// Dead time from the demanded current to the surface of the plate, s.
    pub dead_s: f64,
    /// Phase margin, degrees.
    pub phase_deg: f64,
    /// Gain margin, as a factor.
    pub gain_margin: f64,
}

impl fmt::Display for IdentifiedTile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "gain {:.3} K/s/A, Joule {:.4} 1/A, leak {:.3} 1/s, lag {:.1} ms, dead time {:.1} ms; margins {:.1} deg, {:.2} times",
            self.gain_k_s_a,
            self.joule_per_a,
            self.leak_1_s,
            1e3 * self.lag_s,
            1e3 * self.dead_s,
            self.phase_deg,
            self.gain_margin
        )
    }
}

impl IdentifiedTile {
    pub(super) fn read(reply: &Fields<'_>) -> Option<Self> {
        Some(Self {
            gain_k_s_a: reply.number("gain")?,
            joule_per_a: reply.number("joule")?,
            leak_1_s: reply.number("leak")?,
            lag_s: reply.number("lag_s")?,
            dead_s: reply.number("dead_s")?,
            phase_deg: reply.number("phase_deg")?,
            gain_margin: reply.number("margin")?,
        })
    }
}

/// A line of settings, `set …`, as the device reports it; sent back, it restores them.
#[derive(Clone, Debug, PartialEq)]
pub struct SettingsLine {
    text: String,
    setting: Setting,
}

impl SettingsLine {
    /// What the line sets.
    pub const fn setting(&self) -> &Setting {
        &self.setting
    }
}

impl FromStr for SettingsLine {
    type Err = String;

    /// Reads a line as the device would.
    fn from_str(line: &str) -> Result<Self, String> {
        match Request::read(line) {
            Ok(Request::Session(SessionRequest::Set { setting })) => {
                Ok(Self { text: line.into(), setting })
            }
            Ok(_) => Err(format!("'{line}'; lines of settings begin with 'set'")),
            Err(error) => Err(format!("'{line}': {error}")),
        }
    }
}

impl fmt::Display for SettingsLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// Answer to `self-test`: what the last self-test measured; `None` for what it did not reach.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SelfTestReport {
    /// Time from the comparator's test at its hot side to nFAULT, ms.
    pub hot_cut_ms: Option<f64>,
    /// Sensed supply at the end of that test, V.
    pub hot_supply_v: Option<f64>,
    /// Time from the end of that test to the release of nFAULT, ms.
    pub hot_release_ms: Option<f64>,
    /// The same at the cold side.
    pub cold_cut_ms: Option<f64>,
    /// The same at the cold side.
    pub cold_supply_v: Option<f64>,
    /// The same at the cold side.
    pub cold_release_ms: Option<f64>,
    /// What both have shown of the line that selects the side; `None` also from firmware that does not read it back.
    #[serde(serialize_with = "side_line_word")]
    pub side: Option<SideLine>,
    /// Sensed supply after both, V.
    pub supply_v: Option<f64>,
    /// Current of the cooling pulse, A.
    pub cool_a: Option<f64>,
    /// Current of the warming pulse, A.
    pub warm_a: Option<f64>,
    /// Change of the first display thermistor by the cooling pulse, K.
    pub display_k: Option<f64>,
    /// Change of the second one, K.
    pub check_k: Option<f64>,
    /// The result.
    #[serde(serialize_with = "result_word")]
    pub result: SelfTestResult,
    /// Heat-flux sensor; `None` without one, and before a self-test has passed.
    #[serde(serialize_with = "flux_sensor_word")]
    pub flux_sensor: Option<FluxSensorTest>,
}

fn self_test_result(word: &str) -> Option<SelfTestResult> {
    let known = [SelfTestResult::None, SelfTestResult::Running, SelfTestResult::Passed];
    let known = known.into_iter().find(|known| known.name() == word);
    known.or_else(|| fault(word).map(SelfTestResult::Failed))
}

/// What the answer says of the line that selects the side of the comparator's tests.
fn side_line(word: Option<&str>) -> Option<Option<SideLine>> {
    let Some(word) = word.filter(|word| *word != "-") else {
        return Some(None);
    };
    SideLine::of_word(word).map(Some)
}

fn side_line_word<S: Serializer>(
    side: &Option<SideLine>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    side.map(SideLine::name).serialize(serializer)
}

/// What the answer says of the heat-flux sensor.
fn flux_sensor_test(word: Option<&str>) -> Option<Option<FluxSensorTest>> {
    let Some(word) = word else {
        return Some(None);
    };
    FluxSensorTest::of_word(word).map(Some)
}

fn flux_sensor_word<S: Serializer>(
    test: &Option<FluxSensorTest>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    test.map(FluxSensorTest::name).serialize(serializer)
}

fn result_word<S: Serializer>(result: &SelfTestResult, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(result.name())
}

impl SelfTestReport {
    pub(super) fn read(reply: &Fields<'_>) -> Option<Self> {
        Some(Self {
            hot_cut_ms: reply.number_or_unknown("hot_cut_ms")?,
            hot_supply_v: reply.number_or_unknown("hot_supply_v")?,
            hot_release_ms: reply.number_or_unknown("hot_release_ms")?,
            cold_cut_ms: reply.number_or_unknown("cold_cut_ms")?,
            cold_supply_v: reply.number_or_unknown("cold_supply_v")?,
            cold_release_ms: reply.number_or_unknown("cold_release_ms")?,
            side: side_line(reply.word("side"))?,
            supply_v: reply.number_or_unknown("supply_v")?,
            cool_a: reply.number_or_unknown("cool_a")?,
            warm_a: reply.number_or_unknown("warm_a")?,
            display_k: reply.number_or_unknown("display_k")?,
            check_k: reply.number_or_unknown("check_k")?,
            result: self_test_result(reply.word("result")?)?,
            flux_sensor: flux_sensor_test(reply.word("flux"))?,
        })
    }
}

/// Answer to `raw`: means of the converter's counts (of 4096) in the last tick, and the fault inputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RawReadings {
    /// First display thermistor, counts.
    pub display: f64,
    /// Second display thermistor, counts.
    pub check: f64,
    /// Thermistor of the sink, counts.
    pub sink: f64,
    /// Thermistor of the skin, counts.
    pub skin: f64,
    /// Thermistor of the room, counts.
    pub room: f64,
    /// Force sensor, counts.
    pub force: f64,
    /// Current mirror, counts.
    pub current: f64,
    /// Bridge supply, counts.
    pub supply: f64,
    /// Whether the emergency stop is pressed.
    pub stop: bool,
    /// Whether the bridge's fault line is pulled.
    pub fault_line: bool,
}

impl RawReadings {
    pub(super) fn read(reply: &Fields<'_>) -> Option<Self> {
        Some(Self {
            display: reply.number("display")?,
            check: reply.number("check")?,
            sink: reply.number("sink")?,
            skin: reply.number("skin")?,
            room: reply.number("room")?,
            force: reply.number("force")?,
            current: reply.number("current")?,
            supply: reply.number("supply")?,
            stop: reply.flag("stop")?,
            fault_line: reply.flag("fault_line")?,
        })
    }
}

/// Answer to `flux`: the heat-flux sensor, and what the device knows by it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FluxReport {
    /// The sensor.
    #[serde(flatten, serialize_with = "flux_sensor_numbers")]
    pub sensor: FluxSensor,
    /// Flux out of the finger in the last tick, W/m²; `None` if the sensor's code cannot be right.
    pub w_m2: Option<f64>,
    /// What is known of the finger.
    #[serde(serialize_with = "knowledge_word")]
    pub finger: FingerKnowledge,
}

impl FluxReport {
    /// `None` without a sensor.
    pub(super) fn read(reply: &Fields<'_>) -> Option<Option<Self>> {
        if reply.word("flux")? == "none" {
            return Some(None);
        }
        Some(Some(Self {
            sensor: FluxSensor::from_array_rounded(reply.numbers(FluxSensor::NAMES)?),
            w_m2: reply.number_or_unknown("w_m2")?,
            finger: knowledge(reply.word("finger")?)?,
        }))
    }
}

/// Answer to `board`: option bytes, clocks, locks and counters of the serial line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BoardReport {
    /// Brown-out level of the option bytes, 0 (off) to 3.
    pub bor: u8,
    /// Whether a debugger has selected that watchdogs or PWM timers stand still while it halts the core.
    pub watchdogs_frozen: bool,
    /// Whether the clock is the external one.
    pub clock_external: bool,
    /// Level of the lock of the PWM timers' settings, 0 (off) to 3.
    pub pwm_lock: u8,
    /// Cause of the last reset.
    pub reset: String,
    /// Bytes lost because they were not fetched in time.
    pub rx_overruns: u32,
    /// Bytes without a valid stop bit.
    pub rx_framing: u32,
    /// Bytes with noise.
    pub rx_noise: u32,
    /// Lines to the host that were dropped.
    pub tx_dropped: u32,
    /// Unique identifier of the microcontroller, 24 hexadecimal digits; `None` from firmware that does not report it.
    pub uid: Option<String>,
    /// Digest of the program in its flash, which tells one build from another, in hexadecimal digits; `None` from firmware that
    /// does not report it, and from a simulated device without a flash.
    pub program: Option<String>,
}

/// First word of the unique identifier of a simulated microcontroller: a real one has its place on the wafer there.
pub const SIMULATED_UNIQUE_ID: u32 = u32::from_be_bytes(*b"SIMU");

impl BoardReport {
    /// Whether the microcontroller is a simulated one, as its unique identifier says, whatever line leads to it.
    pub fn is_simulated(&self) -> bool {
        let word = self.uid.as_deref().and_then(|uid| uid.get(..8));
        word.is_some_and(|word| u32::from_str_radix(word, 16) == Ok(SIMULATED_UNIQUE_ID))
    }

    pub(super) fn read(reply: &Fields<'_>) -> Option<Self> {
        Some(Self {
            bor: reply.number("bor")?,
            watchdogs_frozen: match reply.word("watchdogs")? {
                "running" => false,
                "frozen" => true,
                _ => return None,
            },
            clock_external: match reply.word("clock")? {
                "hse" => true,
                "hsi" => false,
                _ => return None,
            },
            pwm_lock: reply.number("pwm_lock")?,
            reset: reply.word("reset")?.into(),
            rx_overruns: reply.number("rx_overruns")?,
            rx_framing: reply.number("rx_framing")?,
            rx_noise: reply.number("rx_noise")?,
            tx_dropped: reply.number("tx_dropped")?,
            uid: reply.word("uid").map(Into::into),
            program: reply.word("program").map(Into::into),
        })
    }
}
