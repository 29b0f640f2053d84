//! Replies of a commissioning session, and its errors.

use contact_model::fixed_point::ContactPairError;
use thermal_device::command::Refused;
use thermal_settings::DisplaySurface;
use thermal_wire::answer::{
    AnswerLine, DeviceAnswer, PointsAndWorst, SensorWithState, SettingLines, TileWithMargins,
};
#[cfg(doc)]
use thermal_wire::request::SessionRequest;
use thermal_wire::setting::Setting;

use crate::{IdentificationError, PointError};

/// What a commissioning session replies to a request that it has executed; [`SessionError`] is the reply to the others.
#[derive(Clone, Debug, PartialEq)]
pub enum SessionReply {
    /// The request was executed, and there is nothing to report: reply to all that change something but
    /// the two below.
    Done,
    /// The present parameters of the tile, and with them the stability margins of the temperature loop that the law
    /// `pi` closes: reply to [`SessionRequest::TuneResult`] and [`SessionRequest::Margins`].
    Tile(TileWithMargins),
    /// The calibration point was added, and the calibration fitted again is in use: reply to
    /// [`SessionRequest::Calibrate`].
    PointAdded(PointsAndWorst),
    /// The heat-flux sensor with what its station knows by it; `None` if it is not fitted: reply to [`SessionRequest::QueryFlux`].
    Flux(Option<SensorWithState>),
    /// The surface of the display: reply to [`SessionRequest::QueryDisplaySurface`].
    DisplaySurface(DisplaySurface),
    /// Number of lines that hold the settings: reply to [`SessionRequest::CountSettings`].
    SettingsLines(SettingLines),
    /// One line of the settings: reply to [`SessionRequest::QuerySetting`].
    Setting(Setting),
}

impl DeviceAnswer for SessionReply {
    fn write_values(&self, line: &mut AnswerLine<'_, '_>) {
        match self {
            Self::Done => {}
            Self::Tile(tile) => tile.write_values(line),
            Self::PointAdded(fit) => fit.write_values(line),
            Self::Flux(flux) => flux.write_values(line),
            Self::DisplaySurface(surface) => surface.write_values(line),
            Self::SettingsLines(count) => count.write_values(line),
            // The host can restore this part later by sending the line that follows `ok`.
            Self::Setting(setting) => setting.write_values(line),
        }
    }
}

/// Why a commissioning session rejects a request. The settings are unchanged then.
#[derive(Clone, Debug, PartialEq)]
pub enum SessionError {
    /// The finger's station refuses a command that the request needs; the value says why it refuses.
    Refused(Refused),
    /// No tile can be computed from the response that the station has recorded during `tune`; the value is the reason.
    Identification(IdentificationError),
    /// The calibration point is rejected; the value is the reason.
    Point(PointError),
    /// The contact model cannot represent the chosen material on this surface of the display; the value is the reason.
    ContactPair(ContactPairError),
}

impl From<Refused> for SessionError {
    fn from(refused: Refused) -> Self {
        Self::Refused(refused)
    }
}
