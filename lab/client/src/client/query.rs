//! Commands whose answer reports something.

use std::fmt;

use contact_model::contact_law::ContactLaw;
use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::safety::ThermistorId;
use thermal_settings::{DisplaySurface, PersonCode, Vocabulary as _};
use thermal_wire::PointOrClear;
use thermal_wire::request::{DeviceRequest, PersonRequest, SessionRequest, StationRequest};

use super::person::{PersonReport, read_codes};
use super::reply::{
    BoardReport, CalibrationFit, Cause, FluxReport, IdentifiedTile, Identity, RawReadings,
    SelfTestReport, SettingsLine, Status,
};
use super::{Command, Fields};

/// Declares the queries without arguments: type, request, type of the reply, and how it is read.
macro_rules! queries {
    ($($(#[$doc:meta])+ $query:ident = $request:expr => $reply:ty, $read:expr;)+) => {$(
        $(#[$doc])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $query;

        impl fmt::Display for $query {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                $request.fmt(f)
            }
        }

        impl Command for $query {
            type Reply = $reply;

            fn read_reply(&self, reply: &Fields<'_>) -> Option<$reply> {
                $read(reply)
            }
        }
    )+};
}

queries! {
    /// Name, version, fingers, rates, protocol and capabilities.
    QueryIdentity = DeviceRequest::Identify => Identity, Identity::read;
    /// State, object and set-point.
    QueryState = StationRequest::State => Status, Status::read;
    /// Why the device tripped; `None` if it has not.
    QueryCause = StationRequest::Cause => Option<Cause>, Cause::read;
    /// The control law in use.
    QueryLaw = StationRequest::QueryLaw => Law,
        |reply: &Fields<'_>| Law::of_word(reply.word("law")?);
    /// The finger that the device assumes.
    QueryAssumedFinger = StationRequest::QueryFinger => AssumedFinger,
        |reply: &Fields<'_>| AssumedFinger::of_word(reply.word("finger")?);
    /// The contact law that is set.
    QueryContactLaw = StationRequest::QueryContactLaw => ContactLaw, |reply: &Fields<'_>| Some(ContactLaw {
        exponent: reply.number("exponent")?,
        hardness_pa: reply.number("hardness_pa")?,
        gap_w_m2k: reply.number("gap_w_m2k")?,
    });
    /// Result of the last identification of the tile, which is in use from then on.
    TuneResult = SessionRequest::TuneResult => IdentifiedTile, IdentifiedTile::read;
    /// The tile in use.
    QueryMargins = SessionRequest::Margins => IdentifiedTile, IdentifiedTile::read;
    /// Number of lines of the settings.
    CountSettings = SessionRequest::CountSettings => usize, |reply: &Fields<'_>| reply.number("lines");
    /// What the last self-test measured.
    QuerySelfTest = StationRequest::SelfTest => SelfTestReport, SelfTestReport::read;
    /// The converter's counts and the fault inputs.
    QueryRaw = StationRequest::Raw => RawReadings, RawReadings::read;
    /// Heat-flux sensor, its flux, and what is known of the finger by it; `None` without one.
    QueryFlux = SessionRequest::QueryFlux => Option<FluxReport>, FluxReport::read;
    /// The chosen person.
    QueryPerson = PersonRequest::QueryPerson => PersonReport, PersonReport::read;
    /// Codes of the stored persons.
    QueryPersons = PersonRequest::List => Vec<PersonCode>, read_codes;
    /// Surface of the display.
    QueryDisplaySurface = SessionRequest::QueryDisplaySurface => DisplaySurface, |reply: &Fields<'_>| {
        (reply.numbers(DisplaySurface::NAMES)).map(DisplaySurface::from_array_rounded)
    };
    /// State of the board.
    QueryBoard = DeviceRequest::Board => BoardReport, BoardReport::read;
}

/// A line of the settings, by its number from 1 on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QuerySettings(pub usize);

impl fmt::Display for QuerySettings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        SessionRequest::QuerySetting { number: self.0.into() }.fmt(f)
    }
}

impl Command for QuerySettings {
    type Reply = SettingsLine;

    fn read_reply(&self, reply: &Fields<'_>) -> Option<SettingsLine> {
        reply.text().parse().ok()
    }
}

/// A calibration point: what the reference thermometer shows at a thermistor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibrate {
    /// The thermistor.
    pub thermistor: ThermistorId,
    /// Reading of the reference thermometer, °C.
    pub reference_c: f64,
}

impl fmt::Display for Calibrate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let point = PointOrClear::Point(self.reference_c.into());
        SessionRequest::Calibrate { thermistor: self.thermistor, point }.fmt(f)
    }
}

impl Command for Calibrate {
    type Reply = CalibrationFit;

    fn read_reply(&self, reply: &Fields<'_>) -> Option<CalibrationFit> {
        Some(CalibrationFit {
            points: reply.number("points")?,
            worst_mk: reply.number("worst_mk")?,
        })
    }
}
