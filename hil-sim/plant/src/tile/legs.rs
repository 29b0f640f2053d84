//! How bismuth telluride changes with temperature.

use super::params::ZERO_C_K;

/// A property's polynomial over kelvin, of which only the shape counts: constant, linear, quadratic. Those of the
/// p- and n-type alloys that modules are made of, from a manufacturer's handbook (Melcor), 173 to 473 K; a literature
/// value.
type Shape = [f64; 3];
const SEEBECK: Shape = [22_224.0, 930.6, -0.9905];
const RESISTIVITY: Shape = [5112.0, 163.4, 0.6279];
const CONDUCTIVITY: Shape = [62_605.0, -277.7, 0.4131];

/// Temperatures outside of which the polynomials are held, K.
const RANGE_K: (f64, f64) = (173.0, 473.0);

/// A property relative to its value at a reference temperature.
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
        Self {
            constant: 1.0 - variation + scale * c,
            linear: scale * l,
            quadratic: scale * q,
        }
    }

    fn at(&self, k: f64) -> f64 {
        self.constant + k * (self.linear + k * self.quadratic)
    }
}

/// Properties of the legs relative to those at a reference temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Legs {
    seebeck: Relative,
    resistivity: Relative,
    conductivity: Relative,
}

impl Legs {
    /// Relative to a temperature, deg C, with a share of the material's variation.
    #[must_use]
    pub fn new(reference_c: f64, variation: f64) -> Self {
        let relative = |shape| Relative::new(shape, reference_c + ZERO_C_K, variation);
        Self {
            seebeck: relative(SEEBECK),
            resistivity: relative(RESISTIVITY),
            conductivity: relative(CONDUCTIVITY),
        }
    }

    /// Seebeck coefficient at a temperature, deg C.
    #[must_use]
    pub fn seebeck(&self, temperature_c: f64) -> f64 {
        self.seebeck.at(held_k(temperature_c))
    }

    /// Electrical resistivity at a temperature, deg C.
    #[must_use]
    pub fn resistivity(&self, temperature_c: f64) -> f64 {
        self.resistivity.at(held_k(temperature_c))
    }

    /// Thermal conductivity at a temperature, deg C.
    #[must_use]
    pub fn conductivity(&self, temperature_c: f64) -> f64 {
        self.conductivity.at(held_k(temperature_c))
    }
}

fn held_k(temperature_c: f64) -> f64 {
    (temperature_c + ZERO_C_K).clamp(RANGE_K.0, RANGE_K.1)
}
