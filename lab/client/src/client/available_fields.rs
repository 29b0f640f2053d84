//! Which fields of telemetry a device has.

use thermal_device::TelemetryFields;
use thermal_protocol::LINE_MAX_BYTES;
use thermal_wire::answer::Identity;
use thermal_wire::host::{COLUMNS, Column, Need};
use thermal_wire::request::StationRequest;
use thermal_wire::telemetry::{DEFAULT_FIELDS, NO_FIELDS, place_of_field};

/// The field that is left out first of a request that is too long: it says nothing of the finger.
const LEAST_NEEDED: &str = "evaluations";

/// Fields of telemetry that a device, or a finger of it, has: those of every line and further ones. Whoever records telemetry asks for
/// them and has their columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AvailableFields(TelemetryFields);

impl AvailableFields {
    /// The fields of every line, without any further field.
    pub const OF_EVERY_LINE: Self = Self(DEFAULT_FIELDS);

    /// The fields that a device with this firmware has, with a heat-flux sensor or without.
    pub fn of(identity: &Identity, has_flux_sensor: bool) -> Self {
        Self::further(|column| match column.need {
            Need::Nothing => true,
            Need::FluxSensor => has_flux_sensor,
            Need::Capability(word) => identity.can(word),
        })
    }

    /// The fields whose columns a recorded table has, by the names in its header.
    pub fn of_table<'a>(names: impl Iterator<Item = &'a str> + Clone) -> Self {
        Self::further(|column| names.clone().any(|name| name == column.name))
    }

    /// The fields of every line, and the fields whose columns are chosen.
    fn further(are: impl Fn(&Column) -> bool) -> Self {
        let places = (0..).zip(COLUMNS).filter(|(_, column)| are(column)).map(|(place, _)| place);
        Self(places.fold(DEFAULT_FIELDS, TelemetryFields::with))
    }

    /// The columns of those that not every line has, in their order. They stand at the end of a table.
    pub fn further_columns(self) -> impl Iterator<Item = &'static Column> + Clone {
        let further = self.0.without(DEFAULT_FIELDS);
        (0..)
            .zip(COLUMNS)
            .filter(move |(place, _)| further.contains(*place))
            .map(|(_, column)| column)
    }

    /// Telemetry at this interval, ms, with these fields. If the line would be too long with the address of a finger and a
    /// checksum, the count of evaluations is left out, then the newest fields. At 1 ms those that need a capability are left out, too: the
    /// serial line carries 100 bytes in a millisecond, and the fields of every line take up to 95.
    pub fn stream(self, interval_ms: u32) -> StationRequest {
        let of =
            |fields| StationRequest::Stream { interval_ms: f64::from(interval_ms).into(), fields };
        let mut fields = self.0;
        if interval_ms == 1 {
            let needs_capability = |column: &Column| matches!(column.need, Need::Capability(_));
            let newer = (0..).zip(COLUMNS).filter(|(_, column)| needs_capability(column));
            fields = newer.fold(fields, |fields, (place, _)| fields.without(NO_FIELDS.with(place)));
        }
        for place in place_of_field(LEAST_NEEDED).into_iter().chain((0..COLUMNS.len()).rev()) {
            if format!("@4 {}*00", of(fields)).len() <= LINE_MAX_BYTES {
                break;
            }
            fields = fields.without(NO_FIELDS.with(place));
        }
        of(fields)
    }
}
