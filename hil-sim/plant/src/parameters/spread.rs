//! Tolerances, and draws from them.

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution as _, StandardNormal, StandardUniform};
use serde::Serialize;

/// How a parameter is drawn between its limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Distribution {
    /// Not at all: it keeps its value.
    Fixed,
    /// Every value alike.
    Uniform,
    /// Every ratio alike: the logarithm is uniform.
    LogUniform,
    /// Normal around the value, the limits two standard deviations away, drawn again beyond them.
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

/// Standard deviations from a normal distribution's middle to its limits.
const LIMIT_SIGMAS: f64 = 2.0;

impl Distribution {
    /// Draws around a value between limits, from the stream of a seed and key.
    pub(super) fn draw(self, value: f64, (low, high): (f64, f64), seed: u64, key: &str) -> f64 {
        if self == Self::Fixed || low >= high {
            return value;
        }
        let mut random = Xoshiro256PlusPlus::seed_from_u64(stream(seed, key));
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
        // Rounding may step over a limit.
        drawn.clamp(low, high)
    }
}

/// The seed of the stream of random numbers that belongs to a key: FNV-1a of seed and key.
#[must_use]
pub fn stream(seed: u64, key: &str) -> u64 {
    let bytes = seed.to_le_bytes();
    (bytes.iter().chain(key.as_bytes())).fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// How far a value may be from the nominal one.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Limits {
    None,
    /// By this part of it.
    Relative(f64),
    /// By this much.
    Absolute(f64),
    /// Between it over this factor and it times this factor.
    Factor(f64),
    /// Between two values.
    Between(f64, f64),
}

/// What a parameter is drawn from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    limits: Limits,
    distribution: Distribution,
}

/// Not drawn.
pub const FIXED: Tolerance = Tolerance {
    limits: Limits::None,
    distribution: Distribution::Fixed,
};

const fn uniform(limits: Limits) -> Tolerance {
    Tolerance {
        limits,
        distribution: Distribution::Uniform,
    }
}

/// Uniform, within a part of the value.
#[must_use]
pub const fn relative(part: f64) -> Tolerance {
    uniform(Limits::Relative(part))
}

/// Uniform, at most this much away from the nominal value, in the parameter's unit.
#[must_use]
pub const fn absolute(most: f64) -> Tolerance {
    uniform(Limits::Absolute(most))
}

/// Uniform, between two values in the parameter's unit.
#[must_use]
pub const fn between(low: f64, high: f64) -> Tolerance {
    uniform(Limits::Between(low, high))
}

/// Log-uniform, within a factor.
pub const fn factor(most: f64) -> Tolerance {
    uniform(Limits::Factor(most)).shaped(Distribution::LogUniform)
}

impl Tolerance {
    /// The same, normally distributed; for limits on both sides alike.
    #[must_use]
    pub const fn normal(self) -> Self {
        self.shaped(Distribution::Normal)
    }

    /// The same, uniform in the logarithm; for limits above 0.
    #[must_use]
    pub const fn logarithmic(self) -> Self {
        self.shaped(Distribution::LogUniform)
    }

    const fn shaped(self, distribution: Distribution) -> Self {
        Self {
            distribution,
            ..self
        }
    }

    pub(super) const fn distribution(&self) -> Distribution {
        self.distribution
    }

    /// Draws a value around a nominal one, from the stream of a seed and key.
    #[must_use]
    pub fn draw(self, nominal: f64, seed: u64, key: &str) -> f64 {
        (self.distribution).draw(nominal, self.limits(nominal), seed, key)
    }

    /// Least and largest value around a nominal one.
    pub(super) fn limits(&self, nominal: f64) -> (f64, f64) {
        match self.limits {
            Limits::None => (nominal, nominal),
            // Of an endless layer, too.
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
