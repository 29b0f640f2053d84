//! The temperatures, currents and times that keep a finger safe, in one place.

use contact_model::fixed_point::Celsius;

use crate::drive::Current;

/// Converts a temperature limit, °C, to fixed point while compiling. What is below the resolution of 2^-22 K is cut
/// off.
const fn fixed_celsius(limit: f64) -> Celsius {
    Celsius::from_bits((limit * (1u32 << Celsius::FRAC_NBITS) as f64) as i32)
}

/// Coldest set-point that a command or a model can give, °C: lasting contact with a colder surface is painful.
pub const SETPOINT_MIN_C: f64 = 15.0;
/// Hottest set-point that a command or a model can give, °C: 1 K below the display temperature at which the station
/// trips.
pub const SETPOINT_MAX_C: f64 = 42.0;
/// Coldest set-point in fixed point, 15 °C, to which [`Setpoint`](super::Setpoint) clamps.
pub const SETPOINT_MIN: Celsius = fixed_celsius(SETPOINT_MIN_C);
/// Hottest set-point in fixed point, 42 °C, to which [`Setpoint`](super::Setpoint) clamps.
pub const SETPOINT_MAX: Celsius = fixed_celsius(SETPOINT_MAX_C);
/// Reading of either display thermistor, °C, below which the station trips by
/// [`Fault::DisplayCold`](super::Fault::DisplayCold); cold pain begins at 13 °C.
pub const DISPLAY_MIN: Celsius = fixed_celsius(13.5);
/// Reading of either display thermistor, °C, above which the station trips by
/// [`Fault::DisplayHot`](super::Fault::DisplayHot); heat pain begins at 45 °C.
pub const DISPLAY_MAX: Celsius = fixed_celsius(43.0);
/// Skin temperature at which heat pain begins, °C. No fault refers to it: the display's limit is checked to be below it
/// while compiling.
pub const HEAT_PAIN_FROM: Celsius = fixed_celsius(45.0);
/// Sink temperature, °C, above which the station trips by [`Fault::SinkHot`](super::Fault::SinkHot). With the bridge
/// off, the plate and the finger on it drift to the sink's temperature: at 42 °C four minutes make one minute of
/// thermal dose, and the sink cools meanwhile.
pub const SINK_MAX: Celsius = fixed_celsius(42.0);
/// Sink temperature, °C, above which an identification of the tile is aborted, so that its pulses do not trip the
/// station by the sink.
pub const SINK_MAX_IDENTIFICATION: Celsius = fixed_celsius(41.5);
/// Sink temperature, °C, above which the law `model` reduces the largest cooling current, to zero 2 K above it, because
/// more current would warm the sink, up to its trip at 42 °C, more than cool the display.
pub const COOLING_REDUCED_FROM: Celsius = fixed_celsius(39.5);
/// Display temperature, °C, from which on thermal dose is counted. Below it the dose decays.
pub const DOSE_COUNTED_FROM: Celsius = fixed_celsius(39.0);
/// Temperature of the unit of thermal dose, °C: a minute at this temperature is a dose of one minute.
pub const DOSE_REFERENCE_TEMPERATURE: Celsius = fixed_celsius(43.0);
/// Excess of the measured current over the controller's limit of 6 A, A, above which the station trips by
/// [`Fault::OverCurrent`](super::Fault::OverCurrent). Tolerances of supply, module and current mirror can show an
/// excess of 1.8 A on a tile that was never identified.
pub const OVER_CURRENT_MARGIN: Current = Current::lit("3");

const _: () = assert!(DISPLAY_MIN.to_bits() < SETPOINT_MIN.to_bits());
const _: () = assert!(SETPOINT_MIN.to_bits() < SETPOINT_MAX.to_bits());
const _: () = assert!(DOSE_COUNTED_FROM.to_bits() < COOLING_REDUCED_FROM.to_bits());
const _: () = assert!(COOLING_REDUCED_FROM.to_bits() < SINK_MAX_IDENTIFICATION.to_bits());
const _: () = assert!(SINK_MAX_IDENTIFICATION.to_bits() < SINK_MAX.to_bits());
const _: () = assert!(SINK_MAX.to_bits() < DISPLAY_MAX.to_bits());
const _: () = assert!(SETPOINT_MAX.to_bits() < DISPLAY_MAX.to_bits());
const _: () = assert!(DISPLAY_MAX.to_bits() < HEAT_PAIN_FROM.to_bits());
