//! Answers to commands that were executed.

use core::fmt::{self, Display as _};

use thermal_commissioning::{Margins, Setting, StorageOrder};
use thermal_device::command::{self, Status};
use thermal_device::reference::Mode;
use thermal_device::safety::Cause;
use thermal_device::{SCANS_PER_SECOND, TICK_HZ};
use thermal_settings::{Calibration, Correction, Tile};

use crate::text::Text;

/// An answer; `Display` writes the line without its end, at most [`ANSWER_MAX`](super::ANSWER_MAX) bytes.
#[derive(Clone, Debug, PartialEq)]
pub enum Reply {
    /// Answer to `id`.
    Identity {
        /// Fingers of the device.
        fingers: u8,
    },
    /// A station's answer.
    Station(command::Reply),
    /// A commissioning session's answer.
    Commissioning(thermal_commissioning::Reply),
    /// `save` or `forget` is executed by a device that starts anew, which then answers `ok`.
    Restart(StorageOrder),
}

impl Reply {
    /// The command was executed, and there is nothing to report.
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
        // Averages and sums go to the commissioning session only.
        command::Reply::Done | command::Reply::Average(_) | command::Reply::Row(_) => {
            f.write_str("ok")
        }
    }
}

fn commissioning(f: &mut fmt::Formatter<'_>, reply: &thermal_commissioning::Reply) -> fmt::Result {
    use thermal_commissioning::Reply;
    match reply {
        Reply::Done => f.write_str("ok"),
        Reply::Tile(tile, margins) => {
            let [gain, joule, leak, lag, dead] = tile.to_array();
            let Margins {
                phase_deg,
                gain: margin,
            } = margins;
            write!(
                f,
                "ok gain={gain:.4} joule={joule:.4} leak={leak:.4} lag_s={lag:.4} dead_s={dead:.4}"
            )?;
            write!(f, " phase_deg={phase_deg:.1} margin={margin:.2}")
        }
        Reply::Calibrated { points, worst_mk } => {
            write!(f, "ok points={points} worst_mk={worst_mk:.2}")
        }
        Reply::SettingsLines(lines) => write!(f, "ok lines={lines}"),
        Reply::Setting(setting) => write_setting(f, setting),
    }
}

fn status_line(status: &Status) -> Text {
    let mut line = Text::new();
    line.word("ok state=");
    line.word(status.state.name());
    line.word(" fault=");
    line.word(status.state.fault().map_or("-", |fault| fault.name()));
    line.word(" material=");
    line.word(status.material.unwrap_or("-"));
    line.word(" object_c=");
    match status.object {
        Some(_) => line.celsius::<2>(status.object),
        None => line.word("room"),
    }
    line.word(match status.mode {
        Mode::ContactResistance => " mode=contact",
        Mode::SemiInfinite => " mode=semi-infinite",
    });
    line.word(" setpoint_c=");
    line.celsius::<2>(status.setpoint);
    line.word(if status.limited { " limited" } else { "" });
    line
}

fn cause_line(cause: Option<&Cause>) -> Text {
    let mut line = Text::new();
    line.word("ok cause=");
    let Some(cause) = cause else {
        line.word("-");
        return line;
    };
    line.word(cause.fault.name());
    line.word(" tick=");
    line.count(cause.tick);
    for (name, temperature) in [
        (" display_c=", cause.display),
        (" check_c=", cause.check),
        (" sink_c=", cause.sink),
    ] {
        line.word(name);
        line.celsius::<2>(temperature);
    }
    line.word(" current_a=");
    line.current(cause.current);
    line.word(" asked_a=");
    line.current(cause.asked);
    line
}

/// Writes `ok` and the line that sets this part of the settings.
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
            let [a, b, c] = Calibration::DECIMALS.map(|decimals| decimals as usize);
            let Correction {
                offset_k,
                slope,
                curvature_1_k,
            } = correction;
            write!(
                f,
                "correction {sensor} {offset_k:.a$} {slope:.b$} {curvature_1_k:.c$}"
            )
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
