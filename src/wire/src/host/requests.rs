//! Requests as a host makes them, of the values that it has.

use contact_model::contact_law::ContactLaw;
use contact_model::impedance::{Impedance, Relaxation};
use contact_model::material::Material;
use contact_model::slab::Back;
use std::format;
use std::string::String;
use std::vec;
use std::vec::Vec;
use thermal_device::TelemetryFields;
use thermal_device::stimulus::TemperatureKind;
use thermal_settings::{CRC_32, DisplaySurface, FluxSensor, Person};

use crate::request::{PersonRequest, SessionRequest, StationRequest};
use crate::telemetry::{DEFAULT_FIELDS, NO_FIELDS, place_of_field};
use crate::{Millimetres, PersonData, UploadLine};

/// Square millimetres, in which the protocol counts areas, per square metre.
const MM2_PER_M2: f64 = 1e6;

impl StationRequest {
    /// Telemetry at this interval, ms, with the default fields; 0 ends it.
    pub fn stream(interval_ms: u32) -> Self {
        Self::Stream { interval_ms: f64::from(interval_ms).into(), fields: DEFAULT_FIELDS }
    }

    /// Telemetry at this interval, ms, with the fields of these names ([`NAMES`](crate::telemetry::NAMES)).
    pub fn stream_fields(interval_ms: u32, names: &[&str]) -> Self {
        let places = names.iter().filter_map(|name| place_of_field(name));
        let fields = places.fold(NO_FIELDS, TelemetryFields::with);
        Self::Stream { interval_ms: f64::from(interval_ms).into(), fields }
    }

    /// The object's material by its name.
    pub fn material(name: &str) -> Self {
        Self::Material { name: name.into() }
    }

    /// The object's material by its properties.
    pub fn custom_material(material: &Material) -> Self {
        Self::CustomMaterial {
            conductivity_w_mk: material.surface.conductivity_w_mk.into(),
            density_kg_m3: material.density_kg_m3.into(),
            specific_heat_j_kgk: material.specific_heat_j_kgk.into(),
            roughness_um: material.surface.roughness_um.into(),
            slope_rad: material.surface.slope_rad.into(),
        }
    }

    /// The object's temperature before contact, °C; `None` for that of the room.
    pub fn object_temperature(celsius: Option<f64>) -> Self {
        celsius.map_or(Self::ObjectAtRoomTemperature, |celsius| Self::ObjectAtTemperature {
            celsius: celsius.into(),
        })
    }

    /// The object is a slab of its material.
    pub fn slab(thickness_mm: f64, back: Back) -> Self {
        Self::Slab { thickness_mm: Millimetres(thickness_mm.into()), back }
    }

    /// Take this for the finger's contact law: `contact nominal` if it is that of Eq. 6-8.
    pub fn contact_law(law: ContactLaw) -> Self {
        if law == ContactLaw::NOMINAL {
            return Self::NominalContactLaw;
        }
        Self::ContactLaw {
            exponent: law.exponent.into(),
            hardness_pa: law.hardness_pa.into(),
            gap_w_m2k: law.gap_w_m2k.into(),
        }
    }

    /// Move the set-point to this temperature, °C, at this rate, K/s, or without one at the device's own, and hold it.
    pub fn hold(celsius: f64, rate_k_s: Option<f64>) -> Self {
        Self::Hold { celsius: celsius.into(), rate_k_s: rate_k_s.map(Into::into) }
    }

    /// Assume this temperature of the skin, °C, or that of the sensor.
    pub fn skin(celsius: Option<f64>) -> Self {
        celsius.map_or(Self::SkinOfSensor, |celsius| Self::AssumedSkin { celsius: celsius.into() })
    }

    /// Report events, or none.
    pub fn events(on: bool) -> Self {
        Self::Events { switch: on.into() }
    }
}

impl SessionRequest {
    /// Use this heat-flux sensor, or none.
    pub fn flux_sensor(sensor: Option<FluxSensor>) -> Self {
        sensor.map_or(Self::NoFluxSensor, |sensor| Self::SetFluxSensor { sensor })
    }

    /// The display has this surface.
    pub fn display_surface(surface: DisplaySurface) -> Self {
        match surface {
            DisplaySurface::NOMINAL => Self::NominalDisplaySurface,
            surface => Self::SetDisplaySurface { surface },
        }
    }
}

impl PersonRequest {
    /// Store a person.
    pub const fn store(person: &Person) -> Self {
        Self::Person { code: person.code, data: Some(PersonData(person.finger)) }
    }
}

/// The lines that upload an object: begin, one row for each relaxation, and commit.
pub fn upload(object: &Impedance<'_>) -> Vec<UploadLine> {
    let direct_mm2k_w = MM2_PER_M2 * object.direct_m2k_w;
    let begin = UploadLine::BeginObject(object.relaxations.len().into(), direct_mm2k_w.into());
    let row = |(index, row): (usize, &Relaxation)| {
        let gain_mm2k_j = MM2_PER_M2 * row.gain_m2k_j;
        UploadLine::Relaxation(index.into(), row.rate_1_s.into(), gain_mm2k_j.into())
    };
    with_commit(begin, object.relaxations.iter().enumerate().map(row))
}

/// The lines that upload a course of points, s and °C (or K above the skin): begin, one row for each point, and commit.
pub fn upload_course(temperatures: TemperatureKind, points: &[(f64, f64)]) -> Vec<UploadLine> {
    let begin = UploadLine::BeginCourse(points.len().into(), temperatures);
    let row = |(index, (t_s, celsius)): (usize, &(f64, f64))| {
        UploadLine::Point(index.into(), (*t_s).into(), (*celsius).into())
    };
    with_commit(begin, points.iter().enumerate().map(row))
}

fn with_commit(begin: UploadLine, rows: impl Iterator<Item = UploadLine>) -> Vec<UploadLine> {
    let mut lines = vec![begin];
    lines.extend(rows);
    let sent: String = lines.iter().map(|line| format!("{line}\n")).collect();
    lines.push(UploadLine::Commit(CRC_32.checksum(sent.as_bytes())));
    lines
}
