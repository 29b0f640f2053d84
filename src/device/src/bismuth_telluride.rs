//! How the properties of bismuth telluride, the material of the module's legs, change with temperature.

use contact_model::fixed_point::Celsius;

/// Temperature at which the data sheet of a Peltier module states its resistance and its Seebeck coefficient, °C.
pub const DATA_SHEET_TEMPERATURE: Celsius = Celsius::lit("27");
/// Relative rise of the resistivity of bismuth telluride for each kelvin above [`DATA_SHEET_TEMPERATURE`], 1/K; the
/// resistivity at that temperature counts as 1.
pub const RESISTIVITY_RISE_PER_K: f64 = 0.0049;
/// Relative rise of the Seebeck coefficient of bismuth telluride for each kelvin above [`DATA_SHEET_TEMPERATURE`], 1/K;
/// the coefficient at that temperature counts as 1.
pub const SEEBECK_RISE_PER_K: f64 = 0.0016;
