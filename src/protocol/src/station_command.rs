//! What a station executes for a request.

use contact_model::contact_law::ContactLaw;
use contact_model::material::{Material, Surface};
use contact_model::slab::Back;
use thermal_device::command::{ChosenContactLaw, ChosenMaterial, Command, ObjectBody};
use thermal_device::events::TriggerPulse;
use thermal_device::safety::Setpoint;
use thermal_device::stimulus::{Hold, PlayOrder};
use thermal_settings::DisplaySurface;
use thermal_wire::request::StationRequest;
use thermal_wire::{Number, Request};

use crate::Error;
use crate::pulse::Pulse;

/// Name of a material that is given by its properties.
const CUSTOM_MATERIAL_NAME: &str = "custom";

/// What a request leads to.
#[expect(clippy::large_enum_variant, reason = "no heap to box the larger one in")]
pub enum StationWork {
    /// A command that the stations execute.
    Command(Command<'static>),
    /// The object is a slab of the chosen material: thickness, mm, and what is behind it.
    Slab(f64, Back),
    /// Load the course of a pulse, and play it.
    Pulse(Pulse, PlayOrder),
}

/// The work of a request. The floating-point constants of a contact, which depend on the `display`, take long to compute, so they
/// are computed here and not when the command is executed, while the control tick is locked out.
///
/// # Errors
/// The contact model cannot represent the material.
#[inline(never)]
pub fn station_work(request: &StationRequest, display: &Surface) -> Result<StationWork, Error> {
    let chosen = |name, properties: &Material| {
        ChosenMaterial::new(name, properties, display).map_err(Error::ContactPair)
    };
    Ok(StationWork::Command(match *request {
        StationRequest::State => Command::Status,
        // Rounds a fraction of a millisecond up, so that only 0 ends the stream.
        StationRequest::Stream { interval_ms, fields } => {
            Command::Stream { interval_ms: interval_ms.ceil(), fields }
        }
        StationRequest::Events { switch } => Command::ReportEvents(switch.is_on()),
        StationRequest::TriggerOutput { kinds } => Command::TriggerOutput(kinds),
        StationRequest::QueryTriggerPulse => Command::TriggerPulse(None),
        StationRequest::TriggerPulse { pulse_ms } => {
            Command::TriggerPulse(Some(TriggerPulse { ms: pulse_ms.get() as u8 }))
        }
        StationRequest::CustomMaterial {
            conductivity_w_mk,
            density_kg_m3,
            specific_heat_j_kgk,
            roughness_um,
            slope_rad,
        } => {
            let surface = Surface {
                conductivity_w_mk: conductivity_w_mk.f64(),
                roughness_um: roughness_um.f64(),
                slope_rad: slope_rad.f64(),
            };
            let properties = Material {
                surface,
                density_kg_m3: density_kg_m3.f64(),
                specific_heat_j_kgk: specific_heat_j_kgk.f64(),
            };
            Command::Material(chosen(CUSTOM_MATERIAL_NAME, &properties)?)
        }
        StationRequest::Material { ref name } => {
            let (name, properties) = name.find()?;
            Command::Material(chosen(name, properties)?)
        }
        StationRequest::ObjectAtRoomTemperature => Command::Object(None),
        StationRequest::HalfSpace => Command::Body(ObjectBody::HalfSpace),
        StationRequest::Slab { thickness_mm, back } => {
            return Ok(StationWork::Slab(thickness_mm.0.f64(), back));
        }
        StationRequest::ObjectAtTemperature { celsius } => Command::Object(Some(celsius.celsius())),
        StationRequest::QueryFinger => Command::Finger(None),
        StationRequest::Finger { finger } => Command::Finger(Some(finger)),
        StationRequest::QueryContactLaw => Command::ContactLaw(None),
        StationRequest::NominalContactLaw => Command::ContactLaw(Some(ChosenContactLaw::NOMINAL)),
        StationRequest::ContactLaw { exponent, hardness_pa, gap_w_m2k } => {
            let law = ContactLaw {
                exponent: exponent.f64(),
                hardness_pa: hardness_pa.f64(),
                gap_w_m2k: gap_w_m2k.f64(),
            };
            Command::ContactLaw(Some(ChosenContactLaw::new(law)))
        }
        StationRequest::Mode { model } => Command::Mode(model),
        StationRequest::QueryLaw => Command::Law(None),
        StationRequest::Law { law } => Command::Law(Some(law)),
        StationRequest::Arm => Command::Arm,
        StationRequest::Hold { celsius, rate_k_s } => Command::Hold {
            target: Setpoint::clamp_celsius_with_flag(celsius.celsius()).0,
            rate_k_s: rate_k_s.map_or(Hold::DEFAULT_RATE_K_S, Number::celsius),
        },
        StationRequest::Play { order } => Command::Play(order),
        StationRequest::Pulse { base_c, target_c, rise_k_s, hold_s, return_k_s, order } => {
            let pulse = Pulse { base_c, target_c, rise_k_s, hold_s, return_k_s };
            return Ok(StationWork::Pulse(pulse, order.unwrap_or(PlayOrder::ONCE_NOW)));
        }
        StationRequest::SkinOfSensor => Command::AssumeSkin(None),
        StationRequest::AssumedSkin { celsius } => Command::AssumeSkin(Some(celsius.celsius())),
        StationRequest::Start => Command::Start,
        StationRequest::Abort => Command::Abort,
        StationRequest::Clear => Command::Clear,
        StationRequest::Cause => Command::Cause,
        StationRequest::SelfTest => Command::SelfTest,
        StationRequest::Raw => Command::Raw,
        StationRequest::Tune => Command::Tune,
    }))
}

/// Reads a line without its address as a device with the nominal display does, without executing it.
///
/// # Errors
/// The line is no request, or the contact model cannot represent its material.
pub fn check_line(line: &str) -> Result<(), Error> {
    match Request::read(line)? {
        Request::Station(request) => {
            station_work(&request, DisplaySurface::NOMINAL.surface()).map(drop)
        }
        _ => Ok(()),
    }
}
