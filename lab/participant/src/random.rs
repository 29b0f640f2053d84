//! Random streams, each named by its purpose, so that a draw more or less of one purpose changes no other.

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution, StandardNormal, Uniform};
use thermal_plant::parameters::stream_seed;

/// A random stream.
#[derive(Clone, Debug)]
pub struct Stream(Xoshiro256PlusPlus);

impl Stream {
    /// The stream of a seed for a purpose.
    pub fn new(seed: u64, purpose: &str) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(stream_seed(seed, purpose)))
    }

    /// A draw from the standard normal distribution.
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// A draw from a normal distribution, drawn again until it is between two limits.
    pub fn normal_within(&mut self, mean: f64, sd: f64, (least, most): (f64, f64)) -> f64 {
        const DRAWS_MAX: u32 = 1000;
        for _ in 0..DRAWS_MAX {
            let drawn = mean + sd * self.normal();
            if (least..=most).contains(&drawn) {
                return drawn;
            }
        }
        mean.clamp(least, most)
    }

    /// A draw whose logarithm is normally distributed.
    pub fn log_normal(&mut self, median: f64, sigma_ln: f64) -> f64 {
        median * libm::exp(sigma_ln * self.normal())
    }

    /// A draw between two limits.
    pub fn between(&mut self, (least, most): (f64, f64)) -> f64 {
        // Empty and infinite ranges, which no caller has, are the only ones that are refused.
        Uniform::new(least, most).map_or(least, |range| range.sample(&mut self.0))
    }

    /// A whole number from 0 to `count - 1`.
    pub fn index(&mut self, count: usize) -> usize {
        let drawn = self.between((0.0, count as f64)) as usize;
        drawn.min(count.saturating_sub(1))
    }
}
