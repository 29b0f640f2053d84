//! Tolerances of parameters, and random draws from them.

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution as _, StandardNormal, StandardUniform};
use serde::Serialize;

/// Distribution of a parameter between its limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Distribution {
    /// Not drawn: the parameter keeps its value.
    Fixed,
    /// Uniform.
    Uniform,
    /// Uniform in the logarithm.
    LogUniform,
    /// Normal around the value, truncated at the limits, which are two standard deviations away.
    Normal,
}

impl std::fmt::Display for Distribution {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Fixed => "fixed",
            Self::Uniform => "uniform",
            Self::LogUniform => "log-uniform",
            Self::Normal => "normal",
        })
    }
}

/// Distance of the limits of a normal distribution from its mean, in standard deviations.
const LIMIT_SIGMAS: f64 = 2.0;

impl Distribution {
    /// Draws a value between limits from the random stream of a seed and key.
    pub(super) fn draw(self, value: f64, (low, high): (f64, f64), seed: u64, key: &str) -> f64 {
        if self == Self::Fixed || low >= high {
            return value;
        }
        let mut random = Xoshiro256PlusPlus::seed_from_u64(stream_seed(seed, key));
        let drawn = match self {
            Self::Normal => {
                let sigmas =
                    std::iter::repeat_with(|| -> f64 { StandardNormal.sample(&mut random) })
                        .find(|sigmas| sigmas.abs() <= LIMIT_SIGMAS)
                        .unwrap_or(0.0);
                value + (high - low) / (2.0 * LIMIT_SIGMAS) * sigmas
            }
            Self::LogUniform => low * (high / low).powf(StandardUniform.sample(&mut random)),
            _ => {
                let part: f64 = StandardUniform.sample(&mut random);
                low + (high - low) * part
            }
        };
        // Rounding may exceed a limit.
        drawn.clamp(low, high)
    }
}

/// Seed of the random stream of a key: FNV-1a hash of seed and key.
pub fn stream_seed(seed: u64, key: &str) -> u64 {
    let bytes = seed.to_le_bytes();
    (bytes.iter().chain(key.as_bytes())).fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Limits around a nominal value.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Limits {
    None,
    /// Deviation as a fraction of the nominal value.
    Relative(f64),
    /// Deviation in the unit of the parameter.
    Absolute(f64),
    /// From the nominal value divided by a factor to the nominal value times this factor.
    Factor(f64),
    /// From a least to a largest value.
    Between(f64, f64),
}

/// Tolerance of a parameter: limits and distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    limits: Limits,
    distribution: Distribution,
}

/// No tolerance: the parameter is not drawn.
pub const FIXED: Tolerance = Tolerance { limits: Limits::None, distribution: Distribution::Fixed };

const fn uniform(limits: Limits) -> Tolerance {
    Tolerance { limits, distribution: Distribution::Uniform }
}

/// Uniform, within a fraction of the nominal value.
pub const fn relative(part: f64) -> Tolerance {
    uniform(Limits::Relative(part))
}

/// Uniform, within a deviation in the unit of the parameter.
pub const fn absolute(most: f64) -> Tolerance {
    uniform(Limits::Absolute(most))
}

/// Uniform, between two values in the unit of the parameter.
pub const fn between(low: f64, high: f64) -> Tolerance {
    uniform(Limits::Between(low, high))
}

/// Log-uniform, within a factor of the nominal value.
pub const fn factor(most: f64) -> Tolerance {
    uniform(Limits::Factor(most)).shaped(Distribution::LogUniform)
}

impl Tolerance {
    /// The same limits with a normal distribution; for symmetric limits.
    #[must_use]
    pub const fn normal(self) -> Self {
        self.shaped(Distribution::Normal)
    }

    /// The same limits, uniform in the logarithm; for limits above 0.
    #[must_use]
    pub const fn logarithmic(self) -> Self {
        self.shaped(Distribution::LogUniform)
    }

    const fn shaped(self, distribution: Distribution) -> Self {
        Self { distribution, ..self }
    }

    pub(super) const fn distribution(&self) -> Distribution {
        self.distribution
    }

    /// Draws a value around a nominal one from the random stream of a seed and key.
    pub fn draw(self, nominal: f64, seed: u64, key: &str) -> f64 {
        (self.distribution).draw(nominal, self.limits(nominal), seed, key)
    }

    /// Least and largest value around a nominal one.
    pub(super) fn limits(&self, nominal: f64) -> (f64, f64) {
        match self.limits {
            Limits::None => (nominal, nominal),
            // A layer of infinite thickness keeps it.
            Limits::Relative(_) | Limits::Factor(_) if nominal.is_infinite() => (nominal, nominal),
            Limits::Relative(part) => {
                let most = part * nominal.abs();
                (nominal - most, nominal + most)
            }
            Limits::Absolute(most) => (nominal - most, nominal + most),
            Limits::Factor(most) => (nominal / most, nominal * most),
            Limits::Between(low, high) => (low, high),
        }
    }
}
