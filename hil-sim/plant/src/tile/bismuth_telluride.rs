//! Temperature dependence of bismuth telluride.

use super::params::ZERO_C_K;

/// Constant, linear and quadratic coefficient of a property over kelvin, up to a common factor. The values are those of
/// the p- and n-type alloys of thermoelectric modules from a manufacturer's handbook (Melcor), 173 to 473 K.
type Shape = [f64; 3];
const SEEBECK: Shape = [22_224.0, 930.6, -0.9905];
const RESISTIVITY: Shape = [5112.0, 163.4, 0.6279];
const CONDUCTIVITY: Shape = [62_605.0, -277.7, 0.4131];

/// Range to which temperatures are limited, K.
const RANGE_K: (f64, f64) = (173.0, 473.0);

/// Polynomial of a property relative to its value at a reference temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Relative {
    constant: f64,
    linear: f64,
    quadratic: f64,
}

impl Relative {
    fn new(shape: Shape, reference_k: f64, variation: f64) -> Self {
        let [c, l, q] = shape;
        let scale = variation / (c + reference_k * (l + reference_k * q));
        Self { constant: 1.0 - variation + scale * c, linear: scale * l, quadratic: scale * q }
    }

    fn at(&self, k: f64) -> f64 {
        self.constant + k * (self.linear + k * self.quadratic)
    }
}

/// Properties of the thermoelectric legs relative to those at a reference temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegProperties {
    seebeck: Relative,
    resistivity: Relative,
    conductivity: Relative,
}

impl LegProperties {
    /// Properties relative to a temperature, deg C, with a fraction of the material's temperature dependence.
    pub fn new(reference_c: f64, variation: f64) -> Self {
        let relative = |shape| Relative::new(shape, reference_c + ZERO_C_K, variation);
        Self {
            seebeck: relative(SEEBECK),
            resistivity: relative(RESISTIVITY),
            conductivity: relative(CONDUCTIVITY),
        }
    }

    /// Relative Seebeck coefficient at a temperature, deg C.
    pub fn seebeck(&self, temperature_c: f64) -> f64 {
        self.seebeck.at(limited_k(temperature_c))
    }

    /// Relative electrical resistivity at a temperature, deg C.
    pub fn resistivity(&self, temperature_c: f64) -> f64 {
        self.resistivity.at(limited_k(temperature_c))
    }

    /// Relative thermal conductivity at a temperature, deg C.
    pub fn conductivity(&self, temperature_c: f64) -> f64 {
        self.conductivity.at(limited_k(temperature_c))
    }
}

fn limited_k(temperature_c: f64) -> f64 {
    (temperature_c + ZERO_C_K).clamp(RANGE_K.0, RANGE_K.1)
}
