//! Answers to executed requests.

use core::fmt::{self, Display as _};

use thermal_commissioning::{SENSOR_WORDS, SessionReply, Setting, StabilityMargins, StorageOrder};
use thermal_device::command::{self, Status};
use thermal_device::safety::TripCause;
use thermal_device::{SCANS_PER_SECOND, TICK_HZ};
use thermal_settings::{Calibration, Tile};

use crate::command::MODES;
use crate::line_buffer::LineBuffer;

/// An answer; `Display` writes it without its line ending, at most [`ANSWER_MAX_BYTES`](super::ANSWER_MAX_BYTES) bytes.
#[derive(Clone, Debug, PartialEq)]
pub enum Reply {
    /// Answer to `id`: name and version of the firmware, number of fingers and rates.
    Identity {
        /// Number of fingers of the device.
        fingers: u8,
    },
    /// Reply of the station that has executed the command.
    Station(command::Reply),
    /// Reply of the commissioning session that has executed the request.
    Commissioning(SessionReply),
    /// `save` or `forget`: the device restarts to execute the order, and answers `ok` afterwards.
    Restart(StorageOrder),
}

impl Reply {
    /// The request was executed, and has no other result.
    pub const DONE: Self = Self::Station(command::Reply::Done);
}

impl fmt::Display for Reply {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Identity { fingers } => write!(
                f,
                "ok thermal-display {} fingers={fingers} tick_hz={TICK_HZ} scan_hz={SCANS_PER_SECOND}",
                env!("CARGO_PKG_VERSION"),
            ),
            Self::Station(reply) => station(f, reply),
            Self::Commissioning(reply) => commissioning(f, reply),
            Self::Restart(_) => f.write_str("ok"),
        }
    }
}

fn station(f: &mut fmt::Formatter<'_>, reply: &command::Reply) -> fmt::Result {
    match reply {
        command::Reply::Status(status) => status_line(status).fmt(f),
        command::Reply::Law(law) => write!(f, "ok law={}", law.name()),
        command::Reply::Cause(cause) => cause_line(cause.as_ref()).fmt(f),
        // A commissioning session evaluates averages and normal equations; no line requests them.
        command::Reply::Done | command::Reply::Average(_) | command::Reply::NormalEquation(_) => {
            f.write_str("ok")
        }
    }
}

fn commissioning(f: &mut fmt::Formatter<'_>, reply: &SessionReply) -> fmt::Result {
    match reply {
        SessionReply::Done => f.write_str("ok"),
        SessionReply::Tile(tile, margins) => {
            let [gain, joule, leak, lag, dead] = tile.to_array();
            let StabilityMargins {
                phase_deg,
                gain: margin,
            } = margins;
            write!(
                f,
                "ok gain={gain:.4} joule={joule:.4} leak={leak:.4} lag_s={lag:.4} dead_s={dead:.4}"
            )?;
            write!(f, " phase_deg={phase_deg:.1} margin={margin:.2}")
        }
        SessionReply::PointAdded { points, worst_mk } => {
            write!(f, "ok points={points} worst_mk={worst_mk:.2}")
        }
        SessionReply::SettingsLines(lines) => write!(f, "ok lines={lines}"),
        SessionReply::Setting(setting) => write_setting(f, setting),
    }
}

fn status_line(status: &Status) -> LineBuffer {
    let mut line = LineBuffer::new();
    line.push_str("ok state=");
    line.push_str(status.state.name());
    line.push_str(" fault=");
    line.push_str(status.state.fault().map_or("-", |fault| fault.name()));
    line.push_str(" material=");
    line.push_str(status.material.unwrap_or("-"));
    line.push_str(" object_c=");
    match status.object {
        Some(_) => line.push_celsius::<2>(status.object),
        None => line.push_str("room"),
    }
    line.push_str(" mode=");
    let mode = MODES.iter().find(|(_, mode)| *mode == status.mode);
    line.push_str(mode.map_or("-", |(name, _)| name));
    line.push_str(" setpoint_c=");
    line.push_celsius::<2>(status.setpoint);
    line.push_str(if status.limited { " limited" } else { "" });
    line
}

fn cause_line(cause: Option<&TripCause>) -> LineBuffer {
    let mut line = LineBuffer::new();
    line.push_str("ok cause=");
    let Some(cause) = cause else {
        line.push_str("-");
        return line;
    };
    line.push_str(cause.fault.name());
    line.push_str(" tick=");
    line.push_integer(cause.tick);
    for (name, temperature) in [
        (" display_c=", cause.display),
        (" check_c=", cause.check),
        (" sink_c=", cause.sink),
    ] {
        line.push_str(name);
        line.push_celsius::<2>(temperature);
    }
    line.push_str(" current_a=");
    line.push_current(cause.current);
    line.push_str(" asked_a=");
    line.push_current(cause.demanded);
    line
}

/// Writes `ok` and the `set` line that restores this part of the settings.
fn write_setting(f: &mut fmt::Formatter<'_>, setting: &Setting) -> fmt::Result {
    f.write_str("ok set ")?;
    match setting {
        Setting::Steps { first, counts } => {
            write!(f, "steps {first}")?;
            let decimals = Calibration::STEP_DECIMALS as usize;
            counts
                .iter()
                .try_for_each(|count| write!(f, " {count:.decimals$}"))
        }
        Setting::Correction(sensor, correction) => {
            write!(
                f,
                "correction {}",
                SENSOR_WORDS[sensor % SENSOR_WORDS.len()]
            )?;
            let values = correction.to_array().into_iter();
            values
                .zip(Calibration::CORRECTION_DECIMALS.map(|decimals| decimals as usize))
                .try_for_each(|(value, decimals)| write!(f, " {value:.decimals$}"))
        }
        Setting::Tile(tile) => {
            f.write_str("tile")?;
            let decimals = Tile::DECIMALS;
            tile.to_array()
                .iter()
                .try_for_each(|value| write!(f, " {value:.decimals$}"))
        }
    }
}
