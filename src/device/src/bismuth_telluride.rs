//! How the properties of bismuth telluride, the material of the module's legs, change with temperature.

use contact_model::fixed_point::Celsius;

/// Temperature for which a module's data sheet states resistance and Seebeck coefficient.
pub const DATA_SHEET_TEMPERATURE: Celsius = Celsius::lit("27");
/// Relative rise of the resistivity above that temperature, 1/K.
pub const RESISTIVITY_RISE_PER_K: f64 = 0.0049;
/// Relative rise of the Seebeck coefficient above that temperature, 1/K.
pub const SEEBECK_RISE_PER_K: f64 = 0.0016;
