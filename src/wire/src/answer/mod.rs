//! Answers of the device: one row for each value, from which the device's writer and the clients' readers are made.

mod board_status;
mod field;
mod line;
mod person;

use contact_model::contact_law::ContactLaw;
use contact_model::fixed_point::units_to_f64;
use thermal_device::command::{self, AssumedFinger, FluxState, Status as StationStatus};
use thermal_device::control::Law;
use thermal_device::events::TriggerPulse;
use thermal_device::learning::FluxSensorTest;
use thermal_device::reference::ContactModel;
use thermal_device::safety::{Fault, SelfTestReport as StationSelfTest, SideLine, TripCause};
use thermal_device::sense::Samples;
use thermal_device::{Flux, SCANS_PER_SECOND, TICK_HZ};
use thermal_settings::{DisplaySurface, FluxSensor, Tile};

use crate::PersonData;
#[cfg(feature = "host")]
use crate::host::{Answer, AnswerForm, FieldRow, Fields, NamedValues};
use crate::kind::*;
use crate::setting::Setting;
use field::*;

pub use board_status::{BoardStatus, ClockSource, Watchdogs};
pub use line::AnswerLine;
pub use person::{PersonCodes, PersonReply};

/// Version of the protocol. It rises when a line, an answer or a telemetry field changes its meaning, not when one is added.
const PROTOCOL_VERSION: u32 = 1;
/// What was added to the protocol since version 0.1 of the firmware, for hosts that know several devices.
const CAPABILITIES: &str = concat!(
    "upload,checksum,board,self-test,raw,course,flux,contact,surface,person,untuned",
    crate::telemetry::capabilities_of_fields!()
);

/// What the device answers when it has done what was asked.
pub trait DeviceAnswer {
    /// Name of the first value, and the word that stands there for an answer that the device may not have.
    const NONE: (&'static str, &'static str) = ("", "");

    /// Appends the values.
    fn write_values(&self, line: &mut AnswerLine<'_, '_>);
}

impl<A: DeviceAnswer> DeviceAnswer for Option<A> {
    const NONE: (&'static str, &'static str) = A::NONE;

    fn write_values(&self, line: &mut AnswerLine<'_, '_>) {
        match self {
            Some(answer) => answer.write_values(line),
            None => line.name(A::NONE.0).push_str_if_fits(A::NONE.1),
        }
    }
}

/// Answer to `settings N`: the line that restores this part of the settings.
impl DeviceAnswer for Setting {
    fn write_values(&self, line: &mut AnswerLine<'_, '_>) {
        line.word("set");
        line.argument(self);
    }
}

/// What a station replies to a command from the host.
impl DeviceAnswer for command::Reply {
    fn write_values(&self, line: &mut AnswerLine<'_, '_>) {
        match self {
            Self::Status(status) => status.write_values(line),
            Self::Law(law) => law.write_values(line),
            Self::Cause(cause) => cause.write_values(line),
            Self::SelfTest(report) => report.write_values(line),
            Self::Raw(samples) => samples.write_values(line),
            Self::Finger(finger) => finger.write_values(line),
            Self::ContactLaw(law) => law.write_values(line),
            Self::TriggerPulse(pulse) => pulse.write_values(line),
            // No line from the host requests a material's properties. Averages, normal equations and flux are evaluated by commissioning
            // sessions, persons by the handler.
            Self::Done
            | Self::Material(_)
            | Self::Average(_)
            | Self::Flux(_)
            | Self::Person(_)
            | Self::FluxZero(_)
            | Self::NormalEquation(_) => {}
        }
    }
}

/// Declares answers from their rows: the name of a host's type, the device's type, the first word of an answer that may not be
/// there, and the values.
macro_rules! answers {
    ($(
        $(#[doc = $doc:literal])+
        $answer:ident from $device:ty as $from:ident
        $(, or $first:literal = $none:literal $(, else $some:literal)?)? {$(
            $name:literal $column:ident: $kind:ty, $what:literal = $value:expr;
        )+}
    )+) => {
        $(
            impl DeviceAnswer for $device {
                const NONE: (&'static str, &'static str) = [$(($first, $none),)? ("", "")][0];

                fn write_values(&self, line: &mut AnswerLine<'_, '_>) {
                    let $from = self;
                    line.begin_values(concat!($($name, " "),+));
                    $($(line.name($first).push_str_if_fits($some);)?)?
                    $(<$kind as Field>::write(line, $value);)+
                }
            }

            #[cfg(feature = "host")]
            $(#[doc = $doc])+
            #[derive(Clone, Debug, PartialEq)]
            pub struct $answer {$(
                #[doc = concat!($what, ".")]
                pub $column: <$kind as Field>::Host,
            )+}

            #[cfg(feature = "host")]
            impl Answer for $answer {
                const NONE: Option<(&'static str, &'static str)> =
                    [$(Some(($first, $none)),)? None][0];

                fn read(fields: &Fields<'_>) -> Option<Self> {
                    Some(Self { $($column: <$kind as Field>::read(fields, $name)?,)+ })
                }
            }

            #[cfg(feature = "host")]
            impl serde::Serialize for $answer {
                fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    let mut values = NamedValues::new();
                    $(<$kind as Field>::add(&mut values, stringify!($column), &self.$column);)+
                    serializer.collect_map(values)
                }
            }
        )+

        /// All answers with values, in the order of the table.
        #[cfg(feature = "host")]
        pub const ANSWERS: &[AnswerForm] = &[$(AnswerForm {
            name: stringify!($answer),
            what: &[$($doc),+],
            none: <$answer as Answer>::NONE,
            rows: &[$(FieldRow {
                name: $name,
                column: stringify!($column),
                what: $what,
                form: <$kind as Field>::FORM,
            },)+],
        },)+];
    };
}

/// The device as a whole, with so many fingers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceIdentity {
    /// Number of fingers, 1 to 5.
    pub fingers: u8,
}

/// A heat-flux sensor, and what a station knows by it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorWithState {
    /// The sensor.
    pub sensor: FluxSensor,
    /// What the station knows.
    pub state: FluxState,
}

/// A tile, and the margins of the loop that the law `pi` closes with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileWithMargins {
    /// The tile.
    pub tile: Tile,
    /// Phase margin, degrees.
    pub phase_margin_deg: f64,
    /// Gain margin, as a factor.
    pub gain_margin: f64,
}

/// How well the calibration of a thermistor fits its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointsAndWorst {
    /// Number of points, the new one included.
    pub points: u32,
    /// Largest difference in magnitude between reading and reference at any of them, mK.
    pub worst_mk: f64,
}

/// Number of lines that hold the settings of a finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SettingLines(pub u32);

// An answer: name of a host's type, what the device answers with, then a row for each value: name on the line, name on a host, kind,
// what it is, and its value. New values are appended, with `IfReported` around their kind: older firmware does not report them.
answers! {
    /// Answer to `id`: firmware, fingers, rates, version and capabilities of the protocol.
    Identity from DeviceIdentity as identity {
        "name" name: WordAt<0>, "Name of the firmware" = "thermal-display";
        "version" version: WordAt<1>, "Its version" = env!("CARGO_PKG_VERSION");
        "fingers" fingers: FingerCount, "Number of fingers, 1 to 5" = identity.fingers;
        "tick_hz" tick_hz: Count, "Control ticks per second" = TICK_HZ;
        "scan_hz" scan_hz: Count, "Scans of all sensors per second" = SCANS_PER_SECOND;
        "protocol" protocol: IfReported<Count>, "Version of the protocol" = Some(PROTOCOL_VERSION);
        "capabilities" capabilities: ListIfReported, "What this firmware can do beyond the first version of the protocol" = CAPABILITIES;
    }
    /// Answer to `board`: option bytes, clocks, locks and counters of the serial line.
    BoardReport from BoardStatus as board {
        "bor" bor: SmallCount, "Brown-out level of the option bytes, 0 (off, as delivered) to 3; other than 3 trips" = board.brown_out_level;
        "watchdogs" watchdogs: Word<Watchdogs>, "Whether watchdogs run, or a debugger can halt them" = if board.watchdogs_may_freeze { Watchdogs::Frozen } else { Watchdogs::Running };
        "clock" clock: Word<ClockSource>, "Source of the clocks: external, or the internal oscillator while the device waits for the external one" = if board.clock_is_external { ClockSource::External } else { ClockSource::Internal };
        "pwm_lock" pwm_lock: SmallCount, "Level of the lock of the PWM timers' settings, 0 (off) to 3; other than 3 trips" = board.pwm_lock_level;
        "reset" reset: Text, "Cause of the last reset" = board.reset;
        "rx_overruns" rx_overruns: Count, "Received bytes that were lost because they were fetched too late" = board.receive_overruns;
        "rx_framing" rx_framing: Count, "Received bytes without a valid stop bit" = board.receive_framing_errors;
        "rx_noise" rx_noise: Count, "Received bytes with noise" = board.receive_noise;
        "tx_dropped" tx_dropped: Count, "Lines of telemetry that were dropped because the line to the host was too slow" = board.telemetry_dropped;
        "uid" uid: IfReported<UniqueId>, "Unique identifier of the microcontroller, 24 hexadecimal digits" = Some(board.unique_id);
        "program" program: IfReported<Digest>, "Digest of the program in its flash, which tells one build from another, eight hexadecimal digits; none of a simulated device without a flash" = board.program_digest;
    }
    /// Answer to `state`: state, object and set-point.
    Status from StationStatus as status {
        "state" state: StateAndFault, "State, with the fault if it is tripped" = status.state;
        "material" material: OrUnknown<Text>, "Material of the object; unknown before one is chosen" = status.material;
        "object_c" object_c: ObjectTemperature, "Temperature of the object before contact, °C, or that of the room" = status.object;
        "mode" mode: Word<ContactModel>, "Contact model" = status.mode;
        "setpoint_c" setpoint_c: OrUnknown<Temperature<2>>, "Set-point, °C; unknown in a state without one" = status.setpoint;
        "limited" limited: NameAlone, "Whether the set-point is not the one that was asked for, because that is out of its range or moves too fast" = status.limited;
        "body" body: Text, "Body of the object" = status.body;
        "tile" is_tuned: IfReported<Tuned>, "Whether the tile was identified or set; if not, set-points are limited to 20 to 38 °C and 1 K/s" = Some(status.is_tuned);
    }
    /// Answer to `law`.
    LawReport from Law as law {
        "law" law: Word<Law>, "Control law in use" = *law;
    }
    /// Answer to `finger`.
    FingerReport from AssumedFinger as finger {
        "finger" finger: Word<AssumedFinger>, "Finger that is assumed for the one that touches" = *finger;
    }
    /// Answer to `contact`.
    ContactLawReport from ContactLaw as law {
        "law" law: ContactLawNumbers, "Contact law in use" = *law;
    }
    /// Answer to `trigger-out pulse`.
    TriggerPulseReport from TriggerPulse as pulse {
        "pulse_ms" pulse_ms: SmallCount, "Length of a pulse at the trigger output, ms" = pulse.ms;
    }
    /// Answer to `cause`: why the device tripped, now or the last time.
    Cause from TripCause as cause, or "cause" = "-" {
        "cause" fault: Word<Fault>, "Fault" = cause.fault;
        "tick" tick: Count, "Tick of the trip, ms since reset" = cause.tick;
        "display_c" display_c: OrUnknown<Temperature<2>>, "First display thermistor, °C" = cause.display;
        "check_c" check_c: OrUnknown<Temperature<2>>, "Second display thermistor, °C" = cause.check;
        "sink_c" sink_c: OrUnknown<Temperature<2>>, "Thermistor of the heat sink, °C" = cause.sink;
        "current_a" current_a: Amperes<3>, "Magnitude of the measured current, A" = cause.current;
        "asked_a" asked_a: Amperes<3>, "Demanded current, A; positive cools" = cause.demanded;
    }
    /// Answer to `self-test`: what the last self-test measured; what it did not reach is unknown.
    SelfTestReport from StationSelfTest as report {
        "hot_cut_ms" hot_cut_ms: OrUnknown<SmallCount>, "Time from the comparator's test at its hot side to nFAULT low, ms" = report.hot.cut_ms;
        "hot_supply_v" hot_supply_v: OrUnknown<Volts>, "Supply at the end of that test, V" = report.hot.cut_supply;
        "hot_release_ms" hot_release_ms: OrUnknown<SmallCount>, "Time from the end of that test to nFAULT high, ms" = report.hot.release_ms;
        "cold_cut_ms" cold_cut_ms: OrUnknown<SmallCount>, "Time from the comparator's test at its cold side to nFAULT low, ms" = report.cold.cut_ms;
        "cold_supply_v" cold_supply_v: OrUnknown<Volts>, "Supply at the end of that test, V" = report.cold.cut_supply;
        "cold_release_ms" cold_release_ms: OrUnknown<SmallCount>, "Time from the end of that test to nFAULT high, ms" = report.cold.release_ms;
        "side" side: UnknownIfNotReported<Word<SideLine>>, "Line that selects the side of these tests, or the level at which it is stuck" = report.side_line;
        "supply_v" supply_v: OrUnknown<Volts>, "Supply after both tests, V" = report.supply;
        "cool_a" cool_a: OrUnknown<Amperes<2>>, "Mean current of the cooling pulse, A" = report.cooling_current;
        "warm_a" warm_a: OrUnknown<Amperes<2>>, "Mean current of the warming pulse, A" = report.warming_current;
        "display_k" display_k: OrUnknown<Temperature<2>>, "Fall of the first display thermistor by the cooling pulse, K" = report.responses[0];
        "check_k" check_k: OrUnknown<Temperature<2>>, "Fall of the second display thermistor by the cooling pulse, K" = report.responses[1];
        "result" result: TestResult, "Result: passed, running, none, or the fault" = report.result;
        "flux" flux: IfReported<Word<FluxSensorTest>>, "Heat-flux sensor; not reported without one, and before a self-test has passed" = report.flux_sensor;
    }
    /// Answer to `raw`: means of 16 conversions in the last tick, counts of 4096, and the fault inputs.
    RawReadings from Samples as samples {
        "display" display: MeanOf16, "First display thermistor, counts" = samples.display;
        "check" check: MeanOf16, "Second display thermistor, counts" = samples.display_check;
        "sink" sink: MeanOf16, "Thermistor of the heat sink, counts" = samples.sink;
        "skin" skin: MeanOf16, "Thermistor of the skin, counts" = samples.skin;
        "room" room: MeanOf16, "Thermistor of the room, counts" = samples.room;
        "force" force: MeanOf16, "Force sensor, counts" = samples.force;
        "current" current: MeanOf16, "Current mirror of the bridge, counts" = samples.current;
        "supply" supply: MeanOf16, "Supply of the bridge, counts" = samples.supply;
        "stop" stop: Bit, "Whether the emergency stop is pressed" = samples.emergency_stop;
        "fault_line" fault_line: Bit, "Whether nFAULT is low" = samples.bridge_fault;
    }
    /// Answer to `margins` and `tune result`: the tile in use, and the stability margins of its loop.
    IdentifiedTile from TileWithMargins as tile {
        "gain" gain_k_s_a: Decimal<4>, "Rate of change of the plate per demanded current, K/s per A" = tile.tile.gain_k_s_a;
        "joule" joule_per_a: Decimal<4>, "Relative loss of this gain by Joule heat, 1/A" = tile.tile.joule_per_a;
        "leak" leak_1_s: Decimal<4>, "Rate at which the plate relaxes, 1/s" = tile.tile.leak_1_s;
        "lag_s" lag_s: Decimal<4>, "Lag of the display's thermistor, s" = tile.tile.sensor_lag_s;
        "dead_s" dead_s: Decimal<4>, "Dead time from the demanded current to the surface of the plate, s" = tile.tile.dead_time_s;
        "phase_deg" phase_deg: Decimal<1>, "Phase margin, degrees" = tile.phase_margin_deg;
        "margin" gain_margin: Decimal<2>, "Gain margin, as a factor" = tile.gain_margin;
    }
    /// Answer to a calibration point.
    CalibrationFit from PointsAndWorst as fit {
        "points" points: Count, "Points of this thermistor so far" = fit.points;
        "worst_mk" worst_mk: Decimal<2>, "Largest difference between device and reference at these points, mK" = fit.worst_mk;
    }
    /// Answer to `settings`.
    SettingsCount from SettingLines as count {
        "lines" lines: Count, "Number of lines that hold the settings" = count.0;
    }
    /// Answer to `flux`: the heat-flux sensor, and what is known by it.
    FluxReport from SensorWithState as flux, or "flux" = "none", else "fitted" {
        "sensor" sensor: FluxSensorNumbers, "The sensor" = flux.sensor;
        "w_m2" w_m2: OrUnknown<Decimal<1>>, "Flux out of the finger in the last tick, W/m²; unknown if the sensor's code cannot be right" = flux.state.flux.map(|flux| units_to_f64(flux.to_bits().into(), Flux::FRAC_NBITS));
        "finger" finger: Knowledge, "What is known of the finger" = flux.state.knowledge;
    }
    /// Answer to `surface`.
    SurfaceReport from DisplaySurface as surface {
        "surface" surface: DisplaySurfaceNumbers, "Surface of the display" = *surface;
    }
    /// Answer to `person` and `person enrol`: who touches, and what is known of the finger.
    PersonReport from PersonReply as reply {
        "person" code: Person, "Code of the chosen or enrolled person, or none for an unknown one" = reply.person.map(|person| person.code);
        "contacts" contacts: SmallCount, "Contacts of 8 s or more, trusted to their end, since learning began or was last distrusted" = reply.contacts;
        "data" data: IfReported<LearntFinger>, "What is stored of the finger, 40 hexadecimal digits; none of an unknown person" = reply.person.map(|person| PersonData(person.finger));
    }
    /// Answer to `persons`.
    StoredPersons from PersonCodes as codes {
        "persons" codes: Codes, "Codes of the stored persons" = codes.clone();
    }
}
