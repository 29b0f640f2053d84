//! Answers to commands that were executed.

use core::fmt;

use contact_model::fixed_point::Celsius;

use super::text::Text;
use crate::commission::{Margins, Order, Row, STEPS_A_LINE};
use crate::control::Law;
use crate::guard::{Cause, State};
use crate::render::Mode;
use crate::sense::Average;
use crate::settings::{Calibration, Correction, Tile};

use crate::{SCANS_PER_SECOND, TICK_HZ};

/// An answer; `Display` writes the line without its end, at most
/// [`ANSWER_MAX`](super::ANSWER_MAX) bytes but for a row, which stays in the device.
#[derive(Clone, Debug, PartialEq)]
pub enum Reply {
    /// It is done.
    Done,
    /// It will be done by a device that starts anew, which then answers so.
    Restart(Order),
    /// Answer to `id`.
    Identity {
        /// Fingers of the device.
        fingers: u8,
    },
    /// Answer to `state`.
    Status(Status),
    /// Answer to `law`.
    Law(Law),
    /// Answer to `cause`.
    Cause(Option<Cause>),
    /// A thermistor's mean.
    Average(Average),
    /// A row of the normal equations of an experiment.
    Row(Row),
    /// Answer to `tune result` and `margins`.
    Tile(Tile, Margins),
    /// Answer to `calibrate`.
    Calibrated {
        /// Points of this thermistor.
        points: usize,
        /// Largest difference of the device from the reference in them, mK.
        worst_mk: f64,
    },
    /// Answer to `settings`: so many lines.
    SettingsLines(usize),
    /// Answer to `settings N`.
    Setting(Setting),
}

/// What the device is doing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// State and, if tripped, why.
    pub state: State,
    /// Chosen material.
    pub material: Option<&'static str>,
    /// Object temperature; that of the room if none was given.
    pub object: Option<Celsius>,
    /// Model.
    pub mode: Mode,
    /// Set-point.
    pub setpoint: Option<Celsius>,
    /// The set-point was limited to the safe range.
    pub limited: bool,
}

impl fmt::Display for Reply {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Done | Self::Restart(_) => f.write_str("ok"),
            Self::Identity { fingers } => write!(
                f,
                "ok {} {} fingers={fingers} tick_hz={TICK_HZ} scan_hz={SCANS_PER_SECOND}",
                env!("CARGO_PKG_NAME"),
                env!("CARGO_PKG_VERSION"),
            ),
            Self::Status(status) => write!(f, "ok {status}"),
            Self::Law(law) => write!(f, "ok law={}", law.name()),
            Self::Cause(cause) => write!(f, "ok {}", Told(cause.as_ref())),
            Self::Average(average) => {
                write!(f, "ok sum={:.3} rise={}", average.sum(), average.rise)
            }
            Self::Row(row) => {
                f.write_str("ok")?;
                row.iter().try_for_each(|sum| write!(f, " {sum}"))
            }
            Self::Tile(tile, margins) => {
                let [gain, joule, leak, lag, dead] = tile.to_array();
                let Margins {
                    phase_deg,
                    gain: times,
                } = margins;
                write!(
                    f,
                    "ok gain={gain:.4} joule={joule:.4} leak={leak:.4} lag_s={lag:.4} dead_s={dead:.4}"
                )?;
                write!(f, " phase_deg={phase_deg:.1} margin={times:.2}")
            }
            Self::Calibrated { points, worst_mk } => {
                write!(f, "ok points={points} worst_mk={worst_mk:.2}")
            }
            Self::SettingsLines(lines) => write!(f, "ok lines={lines}"),
            Self::Setting(setting) => write!(f, "ok {setting}"),
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = Text::new();
        line.word("state=");
        line.word(self.state.name());
        line.word(" fault=");
        line.word(self.state.fault().map_or("-", |fault| fault.name()));
        line.word(" material=");
        line.word(self.material.unwrap_or("-"));
        line.word(" object_c=");
        match self.object {
            Some(_) => line.celsius::<2>(self.object),
            None => line.word("room"),
        }
        line.word(match self.mode {
            Mode::ContactResistance => " mode=contact",
            Mode::SemiInfinite => " mode=semi-infinite",
        });
        line.word(" setpoint_c=");
        line.celsius::<2>(self.setpoint);
        line.word(if self.limited { " limited" } else { "" });
        line.fmt(f)
    }
}

/// A cause as it is told.
struct Told<'a>(Option<&'a Cause>);

impl fmt::Display for Told<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = Text::new();
        line.word("cause=");
        let Some(cause) = self.0 else {
            line.word("-");
            return line.fmt(f);
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
        line.fmt(f)
    }
}

/// A part of the settings; `Display` writes the line that sets it.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// Some of the converter's steps.
    Steps {
        /// The first border.
        first: usize,
        /// Steps from there on, counts.
        counts: heapless::Vec<f64, STEPS_A_LINE>,
    },
    /// A thermistor's correction.
    Correction(&'static str, Correction),
    /// The tile.
    Tile(Tile),
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Steps { first, counts } => {
                write!(f, "set steps {first}")?;
                let decimals = Calibration::STEP_DECIMALS as usize;
                counts
                    .iter()
                    .try_for_each(|count| write!(f, " {count:.decimals$}"))
            }
            Self::Correction(sensor, correction) => {
                let [a, b, c] = Calibration::DECIMALS.map(|decimals| decimals as usize);
                let Correction {
                    offset_k,
                    slope,
                    curvature_1_k,
                } = correction;
                write!(
                    f,
                    "set correction {sensor} {offset_k:.a$} {slope:.b$} {curvature_1_k:.c$}"
                )
            }
            Self::Tile(tile) => {
                f.write_str("set tile")?;
                let decimals = Tile::DECIMALS;
                tile.to_array()
                    .iter()
                    .try_for_each(|value| write!(f, " {value:.decimals$}"))
            }
        }
    }
}
