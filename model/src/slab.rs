//! Surface impedance of a slab of one material in closed form, as a short list of relaxations.
//!
//! The modes of a slab of depth `L`, diffusivity `a` and heat capacity `c` per volume have the rates `x_n² a / L²`. A back
//! that is insulated gives `x_n = n pi`, one that is held `(n + 1/2) pi`, and a film `h` behind it `x tan x = h L / k`.
//! The first three modes are exact; the others join in groups that keep their sum and their static impedance, each up to a
//! mode of 1.5 times the number; those faster than the device's tick become part of the direct term.

use core::f64::consts::PI;

use crate::impedance::{Impedance, Relaxation};

/// Most relaxations of a slab.
pub const COUNT_MAX: usize = 20;
/// Fastest rate, 1/s, of relaxations that stand for a body: the device's tick of 1 ms follows no faster one, and what is
/// faster becomes part of the direct term.
pub const RATE_MAX_1_S: f64 = 600.0;
/// Modes that are not joined.
const EXACT_MODES: u32 = 3;

/// What is behind a slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Back {
    /// No heat passes.
    Insulated,
    /// The temperature before contact is kept.
    Held,
    /// The temperature before contact is behind a film of this coefficient, W/(m² K).
    Film(f64),
}

/// A slab of one material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// Depth, m.
    pub thickness_m: f64,
    /// Conductivity, W/(m K).
    pub conductivity_w_mk: f64,
    /// Heat capacity per volume, J/(m³ K).
    pub capacity_j_m3k: f64,
    /// What is behind it.
    pub back: Back,
}

/// Relaxations of a slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlabRelaxations {
    direct_m2k_w: f64,
    relaxations: [Relaxation; COUNT_MAX],
    count: usize,
}

impl SlabRelaxations {
    /// The impedance that they add up to.
    #[must_use]
    pub fn impedance(&self) -> Impedance<'_> {
        Impedance {
            direct_m2k_w: self.direct_m2k_w,
            relaxations: &self.relaxations[..self.count.min(COUNT_MAX)],
        }
    }
}

impl Slab {
    /// Root `x_n` of mode `n`, from 0.
    #[inline(never)]
    fn root(&self, n: u32) -> f64 {
        let whole = PI * f64::from(n);
        match self.back {
            Back::Insulated => whole,
            Back::Held => whole + PI / 2.0,
            Back::Film(film_w_m2k) => {
                let biot = film_w_m2k * self.thickness_m / self.conductivity_w_mk;
                // Half of the way to the next estimate converges by a factor of two or more for any Biot number.
                (0..50).fold(whole + libm::sqrt(biot).min(PI / 2.0), |x, _| {
                    (x + whole + libm::atan(biot / x)) / 2.0
                })
            }
        }
    }

    /// Rate, 1/s, and gain, m² K/J, of mode `n`. Not inlined: `f64` takes much code on a microcontroller.
    #[inline(never)]
    fn mode(&self, n: u32) -> Relaxation {
        let x = self.root(n);
        let unit = 1.0 / (self.capacity_j_m3k * self.thickness_m);
        let gain_m2k_j = match self.back {
            Back::Insulated if n == 0 => unit,
            Back::Insulated | Back::Held => 2.0 * unit,
            // sin 2x / 2x, by x tan x = B.
            Back::Film(film_w_m2k) => {
                let biot = film_w_m2k * self.thickness_m / self.conductivity_w_mk;
                2.0 * unit / (1.0 + biot / (x * x + biot * biot))
            }
        };
        let diffusion_1_s =
            self.conductivity_w_mk / (self.capacity_j_m3k * self.thickness_m * self.thickness_m);
        Relaxation {
            rate_1_s: x * x * diffusion_1_s,
            gain_m2k_j,
        }
    }

    /// The relaxations: at most [`COUNT_MAX`]; a thicker slab of more than that is one of which the slowest modes are
    /// exact and the fastest missing.
    #[must_use]
    #[inline(never)]
    pub fn relaxations(&self) -> SlabRelaxations {
        let mut all = SlabRelaxations {
            direct_m2k_w: 0.0,
            relaxations: [Relaxation {
                rate_1_s: 0.0,
                gain_m2k_j: 0.0,
            }; COUNT_MAX],
            count: 0,
        };
        let mut first = 0;
        let mut reached_m2k_w = 0.0;
        while all.count < COUNT_MAX {
            let end = if first < EXACT_MODES {
                first + 1
            } else {
                first + first.div_ceil(2)
            };
            let (mut gain_m2k_j, mut static_m2k_w) = (0.0, 0.0);
            for n in first..end {
                let mode = self.mode(n);
                gain_m2k_j += mode.gain_m2k_j;
                static_m2k_w += if mode.rate_1_s > 0.0 {
                    mode.gain_m2k_j / mode.rate_1_s
                } else {
                    0.0
                };
            }
            let rate_1_s = if static_m2k_w > 0.0 {
                gain_m2k_j / static_m2k_w
            } else {
                0.0
            };
            if rate_1_s > RATE_MAX_1_S {
                break;
            }
            reached_m2k_w += static_m2k_w;
            all.relaxations[all.count] = Relaxation {
                rate_1_s,
                gain_m2k_j,
            };
            all.count += 1;
            first = end;
        }
        // What all modes add up to without the integrator: a third of L/k behind an insulated back.
        let resistance_m2k_w = self.thickness_m / self.conductivity_w_mk;
        let whole_m2k_w = match self.back {
            Back::Insulated => resistance_m2k_w / 3.0,
            Back::Held => resistance_m2k_w,
            Back::Film(film_w_m2k) => resistance_m2k_w + 1.0 / film_w_m2k,
        };
        all.direct_m2k_w = (whole_m2k_w - reached_m2k_w).max(0.0);
        all
    }
}
