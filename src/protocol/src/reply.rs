//! Answers to executed requests.

use core::fmt::{self, Display as _};

use contact_model::contact_law::ContactLaw;
use contact_model::decimal::Rounded;
use contact_model::fixed_point::units_to_f64;
use thermal_commissioning::{SessionReply, StorageOrder};
use thermal_device::command::{self, FluxState, Status};
use thermal_device::safety::{SelfTestReport, SideLine, TripCause};
use thermal_device::sense::Samples;
use thermal_device::{Flux, SCANS_PER_SECOND, TICK_HZ};
use thermal_settings::{DisplaySurface, FluxSensor};
use thermal_wire::telemetry::{TUNED_WORD, UNTUNED_WORD};
use thermal_wire::{Argument as _, LineBuffer};

use crate::BoardStatus;
use crate::person::{PersonCodes, PersonReply};

/// Version of the protocol. It rises when a line, an answer or a telemetry field changes its meaning, not when one is added.
const PROTOCOL_VERSION: u32 = 1;
/// What was added to the protocol since version 0.1 of the firmware, for hosts that know several devices.
const CAPABILITIES: &str =
    "upload,checksum,board,self-test,raw,course,flux,contact,surface,person,untuned";

/// Answer to a line that was executed; `Display` writes the answer to the host, `ok` and what is reported, without a
/// line ending and in at most [`ANSWER_MAX_BYTES`](super::ANSWER_MAX_BYTES) bytes.
#[derive(Clone, Debug, PartialEq)]
pub enum Reply {
    /// Answer to the command `id`: name and version of the firmware, number of fingers, control ticks per second, scans of
    /// all sensors per second, version and capabilities of the protocol.
    Identity {
        /// Number of fingers of the device, 1 to 10.
        fingers: u8,
    },
    /// Answer to the command `board`.
    Board(BoardStatus),
    /// Answer to a command that was executed by the station (the control) of one finger, or by the stations of all
    /// fingers.
    Station(command::Reply),
    /// Answer to a request that was executed by the commissioning session of one finger, or by the sessions of all
    /// fingers. The session of a finger is its settings and calibration points.
    Commissioning(SessionReply),
    /// Answer to the commands `person` and `person enrol`.
    Person(PersonReply),
    /// Answer to the command `persons`.
    Persons(PersonCodes),
    /// The line was `save` or `forget`, and may be executed. The caller must now restart the device, which stores the
    /// settings and only then sends the answer, `ok` or an error.
    Restart(StorageOrder),
}

impl Reply {
    /// The line was executed, and there is nothing to report: the answer is `ok`.
    pub const DONE: Self = Self::Station(command::Reply::Done);
}

impl fmt::Display for Reply {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Identity { fingers } => write!(
                f,
                "ok thermal-display {} fingers={fingers} tick_hz={TICK_HZ} scan_hz={SCANS_PER_SECOND} \
                 protocol={PROTOCOL_VERSION} capabilities={CAPABILITIES}",
                env!("CARGO_PKG_VERSION"),
            ),
            Self::Board(status) => status.fmt(f),
            Self::Station(reply) => write_station_reply(f, reply),
            Self::Commissioning(reply) => write_session_reply(f, reply),
            Self::Person(reply) => reply.fmt(f),
            Self::Persons(codes) => write!(f, "ok persons={codes}"),
            Self::Restart(_) => f.write_str("ok"),
        }
    }
}

fn write_station_reply(f: &mut fmt::Formatter<'_>, reply: &command::Reply) -> fmt::Result {
    match reply {
        command::Reply::Status(status) => state_answer_line(status).fmt(f),
        command::Reply::Law(law) => write!(f, "ok law={}", law.name()),
        command::Reply::Cause(cause) => trip_cause_answer_line(cause.as_ref()).fmt(f),
        command::Reply::SelfTest(report) => {
            comparator_test_answer_words(report).fmt(f)?;
            pulse_test_answer_words(report).fmt(f)
        }
        command::Reply::Raw(samples) => raw_answer_line(samples).fmt(f),
        command::Reply::Finger(name) => write!(f, "ok finger={name}"),
        command::Reply::ContactLaw(law) => {
            f.write_str("ok ")?;
            write_contact_law(f, law)
        }
        // No line from the host requests a material's properties.
        command::Reply::Material(_) => f.write_str("ok"),
        // Averages, normal equations and flux are evaluated by commissioning sessions, persons by the handler.
        command::Reply::Done
        | command::Reply::Average(_)
        | command::Reply::Flux(_)
        | command::Reply::Person(_)
        | command::Reply::FluxZero(_)
        | command::Reply::NormalEquation(_) => f.write_str("ok"),
    }
}

pub fn write_contact_law(f: &mut fmt::Formatter<'_>, law: &ContactLaw) -> fmt::Result {
    let exponent = Rounded(law.exponent, 4);
    let (hardness, gap) = (Rounded(law.hardness_pa, 0), Rounded(law.gap_w_m2k, 1));
    write!(f, "exponent={exponent} hardness_pa={hardness} gap_w_m2k={gap}")
}

fn write_session_reply(f: &mut fmt::Formatter<'_>, reply: &SessionReply) -> fmt::Result {
    match reply {
        SessionReply::Done => f.write_str("ok"),
        SessionReply::Tile(tile, margins) => {
            f.write_str("ok")?;
            let names = ["gain", "joule", "leak", "lag_s", "dead_s"];
            write_named_numbers(f, &names, &tile.to_array(), &[4; 5])?;
            let (phase, margin) = (Rounded(margins.phase_deg, 1), Rounded(margins.gain, 2));
            write!(f, " phase_deg={phase} margin={margin}")
        }
        SessionReply::PointAdded { points, worst_mk } => {
            let worst_mk = Rounded(*worst_mk, 2);
            write!(f, "ok points={points} worst_mk={worst_mk}")
        }
        SessionReply::Flux(None) => f.write_str("ok flux=none"),
        SessionReply::Flux(Some((sensor, state))) => write_flux_answer(f, sensor, state),
        SessionReply::DisplaySurface(display) => {
            f.write_str("ok")?;
            let values = display.to_array();
            write_named_numbers(f, &DisplaySurface::NAMES, &values, &DisplaySurface::DECIMALS)
        }
        SessionReply::SettingsLines(lines) => write!(f, "ok lines={lines}"),
        // The host can restore this part later by sending the line that follows `ok`.
        SessionReply::Setting(setting) => {
            f.write_str("ok set")?;
            setting.write(f)
        }
    }
}

fn write_flux_answer(
    f: &mut fmt::Formatter<'_>,
    sensor: &FluxSensor,
    state: &FluxState,
) -> fmt::Result {
    f.write_str("ok flux=fitted")?;
    let values = sensor.to_array();
    write_named_numbers(f, &FluxSensor::NAMES, &values, &FluxSensor::DECIMALS)?;
    match state.flux {
        Some(flux) => {
            let flux_w_m2 = units_to_f64(flux.to_bits().into(), Flux::FRAC_NBITS);
            write!(f, " w_m2={}", Rounded(flux_w_m2, 1))?;
        }
        None => f.write_str(" w_m2=-")?,
    }
    write!(f, " finger={}", state.knowledge.name())
}

/// Writes a word with a name for each of these values.
fn write_named_numbers(
    f: &mut fmt::Formatter<'_>,
    names: &[&str],
    values: &[f64],
    decimals: &[i32],
) -> fmt::Result {
    for ((name, value), decimals) in names.iter().zip(values).zip(decimals) {
        write!(f, " {name}={}", Rounded(*value, *decimals as usize))?;
    }
    Ok(())
}

fn state_answer_line(status: &Status) -> LineBuffer {
    let mut line = LineBuffer::new();
    line.push_str_if_fits("ok state=");
    line.push_str_if_fits(status.state.name());
    line.push_str_if_fits(" fault=");
    line.push_str_if_fits(status.state.fault().map_or("-", |fault| fault.name()));
    line.push_str_if_fits(" material=");
    line.push_str_if_fits(status.material.unwrap_or("-"));
    line.push_str_if_fits(" object_c=");
    match status.object {
        Some(_) => line.push_celsius_or_dash(2, status.object),
        None => line.push_str_if_fits("room"),
    }
    line.push_str_if_fits(" mode=");
    line.push_str_if_fits(status.mode.name());
    line.push_str_if_fits(" setpoint_c=");
    line.push_celsius_or_dash(2, status.setpoint);
    line.push_str_if_fits(if status.limited { " limited" } else { "" });
    line.push_str_if_fits(" body=");
    line.push_str_if_fits(status.body);
    line.push_str_if_fits(" tile=");
    line.push_str_if_fits(if status.is_tuned { TUNED_WORD } else { UNTUNED_WORD });
    line
}

fn trip_cause_answer_line(cause: Option<&TripCause>) -> LineBuffer {
    let mut line = LineBuffer::new();
    line.push_str_if_fits("ok cause=");
    let Some(cause) = cause else {
        line.push_str_if_fits("-");
        return line;
    };
    line.push_str_if_fits(cause.fault.name());
    line.push_str_if_fits(" tick=");
    line.push_integer(cause.tick);
    for (name, temperature) in
        [(" display_c=", cause.display), (" check_c=", cause.check), (" sink_c=", cause.sink)]
    {
        line.push_str_if_fits(name);
        line.push_celsius_or_dash(2, temperature);
    }
    line.push_str_if_fits(" current_a=");
    line.push_current(cause.current);
    line.push_str_if_fits(" asked_a=");
    line.push_current(cause.demanded);
    line
}

/// First words of the answer to `self-test`, which is too long for one buffer.
fn comparator_test_answer_words(report: &SelfTestReport) -> LineBuffer {
    let mut line = LineBuffer::new();
    line.push_str_if_fits("ok");
    for (cut, supply, release, side) in [
        (" hot_cut_ms=", " hot_supply_v=", " hot_release_ms=", &report.hot),
        (" cold_cut_ms=", " cold_supply_v=", " cold_release_ms=", &report.cold),
    ] {
        line.push_str_if_fits(cut);
        line.push_integer_or_dash(side.cut_ms);
        line.push_str_if_fits(supply);
        line.push_supply_or_dash(side.cut_supply);
        line.push_str_if_fits(release);
        line.push_integer_or_dash(side.release_ms);
    }
    line.push_str_if_fits(" side=");
    line.push_str_if_fits(report.side_line.map_or("-", SideLine::name));
    line
}

/// Last words of the answer to `self-test`.
fn pulse_test_answer_words(report: &SelfTestReport) -> LineBuffer {
    let mut line = LineBuffer::new();
    line.push_str_if_fits(" supply_v=");
    line.push_supply_or_dash(report.supply);
    for (name, current) in
        [(" cool_a=", report.cooling_current), (" warm_a=", report.warming_current)]
    {
        line.push_str_if_fits(name);
        line.push_current_or_dash(current);
    }
    for (name, response) in [" display_k=", " check_k="].into_iter().zip(report.responses) {
        line.push_str_if_fits(name);
        line.push_celsius_or_dash(2, response);
    }
    line.push_str_if_fits(" result=");
    line.push_str_if_fits(report.result.name());
    if let Some(test) = report.flux_sensor {
        line.push_str_if_fits(" flux=");
        line.push_str_if_fits(test.name());
    }
    line
}

fn raw_answer_line(samples: &Samples) -> LineBuffer {
    let mut line = LineBuffer::new();
    line.push_str_if_fits("ok");
    for (name, sum) in [
        (" display=", samples.display),
        (" check=", samples.display_check),
        (" sink=", samples.sink),
        (" skin=", samples.skin),
        (" room=", samples.room),
        (" force=", samples.force),
        (" current=", samples.current),
        (" supply=", samples.supply),
    ] {
        line.push_str_if_fits(name);
        line.push_mean_of_16(sum);
    }
    for (name, level) in
        [(" stop=", samples.emergency_stop), (" fault_line=", samples.bridge_fault)]
    {
        line.push_str_if_fits(name);
        line.push_str_if_fits(if level { "1" } else { "0" });
    }
    line
}
