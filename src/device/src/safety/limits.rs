//! The temperatures, currents and times that keep a finger safe, in one place.

use contact_model::fixed_point::Celsius;

use crate::drive::Current;

/// Converts a limit, °C or K, that has at most 22 binary places.
const fn celsius(limit: f64) -> Celsius {
    Celsius::from_bits((limit * (1u32 << Celsius::FRAC_NBITS) as f64) as i32)
}

/// Coldest set-point, °C: lasting contact with a colder surface is painful.
pub const SETPOINT_MIN_C: f64 = 15.0;
/// Hottest set-point, °C: one kelvin below the temperature at which the station trips.
pub const SETPOINT_MAX_C: f64 = 42.0;
/// [`SETPOINT_MIN_C`] in fixed point.
pub const SETPOINT_MIN: Celsius = celsius(SETPOINT_MIN_C);
/// [`SETPOINT_MAX_C`] in fixed point.
pub const SETPOINT_MAX: Celsius = celsius(SETPOINT_MAX_C);
/// Display temperature below which the station trips; cold pain begins at 13 °C.
pub const DISPLAY_MIN: Celsius = celsius(13.5);
/// Display temperature above which the station trips; heat pain begins at [`HEAT_PAIN`].
pub const DISPLAY_MAX: Celsius = celsius(43.0);
/// Skin temperature at which heat pain begins.
pub const HEAT_PAIN: Celsius = celsius(45.0);
/// Sink temperature above which the station trips. With the bridge off, the plate and the finger on it drift to the sink's
/// temperature: at 42 °C four minutes make one minute of thermal dose, and the sink cools meanwhile.
pub const SINK_MAX: Celsius = celsius(42.0);
/// Sink temperature above which an identification of the tile ends.
pub const SINK_MAX_IDENTIFICATION: Celsius = celsius(41.5);
/// Sink temperature above which the law `model` reduces cooling, before the station trips.
pub const COOLING_REDUCED_FROM: Celsius = celsius(39.5);
/// Display temperature below which no thermal dose is counted, and dose is forgotten.
pub const DOSE_MIN: Celsius = celsius(39.0);
/// Temperature whose minutes are the unit of thermal dose.
pub const DOSE_REFERENCE: Celsius = celsius(43.0);
/// Current above the controller's limit at which the station trips. Before the tile is identified, tolerances of supply,
/// module and mirror can show 1.8 A more than 6 A.
pub const OVER_CURRENT_MARGIN: Current = Current::lit("3");

const _: () = assert!(DISPLAY_MIN.to_bits() < SETPOINT_MIN.to_bits());
const _: () = assert!(SETPOINT_MIN.to_bits() < SETPOINT_MAX.to_bits());
const _: () = assert!(DOSE_MIN.to_bits() < COOLING_REDUCED_FROM.to_bits());
const _: () = assert!(COOLING_REDUCED_FROM.to_bits() < SINK_MAX_IDENTIFICATION.to_bits());
const _: () = assert!(SINK_MAX_IDENTIFICATION.to_bits() < SINK_MAX.to_bits());
const _: () = assert!(SINK_MAX.to_bits() < DISPLAY_MAX.to_bits());
const _: () = assert!(SETPOINT_MAX.to_bits() < DISPLAY_MAX.to_bits());
const _: () = assert!(DISPLAY_MAX.to_bits() < HEAT_PAIN.to_bits());
