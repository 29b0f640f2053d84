//! How the properties of bismuth telluride, the material of the module's legs, change with temperature.

use contact_model::fixed_point::Celsius;

/// Temperature, °C, for which a Peltier module's data sheet states its resistance and its Seebeck coefficient.
pub const DATA_SHEET_TEMPERATURE: Celsius = Celsius::lit("27");
/// Rise of the resistivity per kelvin above [`DATA_SHEET_TEMPERATURE`], as a part of its value there, 1/K.
pub const RESISTIVITY_RISE_PER_K: f64 = 0.0049;
/// Rise of the Seebeck coefficient per kelvin above [`DATA_SHEET_TEMPERATURE`], as a part of its value there, 1/K.
pub const SEEBECK_RISE_PER_K: f64 = 0.0016;
