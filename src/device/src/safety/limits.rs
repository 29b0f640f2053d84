//! Limits of temperature and current that keep a finger safe, in one place.

use contact_model::fixed_point::Celsius;

use crate::drive::Current;
use crate::sense::SupplyVoltage;

/// Converts a temperature limit, °C, to fixed point at compile time. Fractions below the resolution of 2^-22 °C are
/// truncated.
const fn fixed_celsius(limit: f64) -> Celsius {
    Celsius::from_bits((limit * (1u32 << Celsius::FRAC_NBITS) as f64) as i32)
}

/// Coldest set-point that a command or a model can give, °C: lasting contact with a colder surface is painful.
pub const SETPOINT_MIN_C: f64 = 15.0;
/// Hottest set-point that a command or a model can give, °C: 1 K below the display temperature of 43 °C at which the
/// station trips.
pub const SETPOINT_MAX_C: f64 = 42.0;
/// Coldest set-point in fixed point, 15 °C, to which [`Setpoint`](super::Setpoint) clamps.
pub const SETPOINT_MIN: Celsius = fixed_celsius(SETPOINT_MIN_C);
/// Hottest set-point in fixed point, 42 °C, to which [`Setpoint`](super::Setpoint) clamps.
pub const SETPOINT_MAX: Celsius = fixed_celsius(SETPOINT_MAX_C);
/// Coldest set-point of a tile that was never identified, °C. In campaigns without a fault, with thermistors that lag by up to 0.5 s
/// and fingers of up to 10 N, the surface passed it by 1.5 K at most.
pub const UNTUNED_SETPOINT_MIN: Celsius = Celsius::lit("20");
/// Hottest set-point of a tile that was never identified, °C.
pub const UNTUNED_SETPOINT_MAX: Celsius = Celsius::lit("38");
/// Largest rate, K/s, at which the set-point of such a tile moves: what a thermistor that lags by 0.5 s hides is then 0.5 K.
pub const UNTUNED_RATE_MAX_K_S: Celsius = Celsius::lit("1");
/// Coldest true surface of the display that the control may cause while no fault is present, °C.
pub const SURFACE_MIN_WITHOUT_FAULT: Celsius = fixed_celsius(14.0);
/// Warmest true surface of the display that the control may cause while no fault is present, °C.
pub const SURFACE_MAX_WITHOUT_FAULT: Celsius = fixed_celsius(43.0);
/// Reading of either display thermistor, °C, below which the station trips by
/// [`Fault::DisplayCold`](super::Fault::DisplayCold). Cold pain begins at 13 °C.
pub const DISPLAY_TRIP_BELOW: Celsius = fixed_celsius(13.5);
/// Reading of either display thermistor, °C, above which the station trips by
/// [`Fault::DisplayHot`](super::Fault::DisplayHot). Heat pain begins at 45 °C.
pub const DISPLAY_TRIP_ABOVE: Celsius = fixed_celsius(43.0);
/// Skin temperature at which heat pain begins, °C. No detector uses it; an assertion at compile time checks that the
/// display's trip limit [`DISPLAY_TRIP_ABOVE`] is below it.
pub const HEAT_PAIN_FROM: Celsius = fixed_celsius(45.0);
/// Sink temperature, °C, above which the station trips by [`Fault::SinkHot`](super::Fault::SinkHot). With the bridge
/// off, the display and the finger on it drift to the sink's temperature. At 42 °C four minutes add one minute of
/// thermal dose, and meanwhile the sink cools.
pub const SINK_TRIP_ABOVE: Celsius = fixed_celsius(42.0);
/// Sink temperature, °C, above which an identification of the tile (current pulses that measure its thermal parameters)
/// ends early, so that its pulses do not warm the sink to the trip limit of 42 °C.
pub const SINK_MAX_IDENTIFICATION: Celsius = fixed_celsius(41.5);
/// Sink temperature, °C, above which the control law `model` reduces its largest cooling current, linearly to zero at
/// 2 K above. More current would warm the sink towards its trip limit of 42 °C more than it cools the display.
pub const COOLING_DERATING_SINK_TEMPERATURE: Celsius = fixed_celsius(39.5);
/// Display temperature, °C, from which on the thermal dose grows. Below it the dose decays.
pub const DOSE_COUNTED_FROM: Celsius = fixed_celsius(39.0);
/// Reference temperature of the thermal dose CEM43, °C: each minute at this temperature adds one minute to the dose.
pub const DOSE_REFERENCE_TEMPERATURE: Celsius = fixed_celsius(43.0);
/// Amount by which the measured current may exceed the controller's limit of 6 A, A; more trips the station by
/// [`Fault::OverCurrent`](super::Fault::OverCurrent). On a tile that was never identified, tolerances of supply, module
/// and current mirror can cause an excess of 1.8 A.
pub const OVER_CURRENT_MARGIN: Current = Current::lit("3");
/// Least voltage of the bridge's supply while the comparator lets it through; less trips the station by
/// [`Fault::Supply`](super::Fault::Supply). A supply of 12 V less 5 % that gives 6 A still reads 10.9 V with the
/// tolerances of its divider and of the reference.
pub const SUPPLY_MIN: SupplyVoltage = SupplyVoltage::from_volts(10.8);
/// Largest voltage of the bridge's supply; more trips the station by [`Fault::Supply`](super::Fault::Supply).
pub const SUPPLY_MAX: SupplyVoltage = SupplyVoltage::from_volts(13.2);
/// Largest voltage of the bridge's supply 19 ms after the comparator was told to cut it, in the self-test; more trips
/// the station by [`Fault::SupplySwitch`](super::Fault::SupplySwitch). The bleeder discharges it to 4 V by then.
pub const SUPPLY_CUT_MAX: SupplyVoltage = SupplyVoltage::from_volts(6.0);

const _: () = assert!(DISPLAY_TRIP_BELOW.to_bits() < SETPOINT_MIN.to_bits());
const _: () = assert!(SETPOINT_MIN.to_bits() < SETPOINT_MAX.to_bits());
const _: () = assert!(DOSE_COUNTED_FROM.to_bits() < COOLING_DERATING_SINK_TEMPERATURE.to_bits());
const _: () =
    assert!(COOLING_DERATING_SINK_TEMPERATURE.to_bits() < SINK_MAX_IDENTIFICATION.to_bits());
const _: () = assert!(SINK_MAX_IDENTIFICATION.to_bits() < SINK_TRIP_ABOVE.to_bits());
const _: () = assert!(SINK_TRIP_ABOVE.to_bits() < DISPLAY_TRIP_ABOVE.to_bits());
const _: () = assert!(SETPOINT_MAX.to_bits() < DISPLAY_TRIP_ABOVE.to_bits());
const _: () = assert!(DISPLAY_TRIP_ABOVE.to_bits() < HEAT_PAIN_FROM.to_bits());
