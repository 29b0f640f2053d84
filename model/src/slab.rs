//! Surface impedance of a slab of one material in closed form, as a short list of relaxations.
//!
//! The modes of a slab of depth `L`, diffusivity `a` and heat capacity `c` per volume have the rates `x_n² a / L²`. A back
//! that is insulated gives `x_n = n pi`, one that is held `(n + 1/2) pi`, and a film `h` behind it `x tan x = h L / k`.
//! The first three modes are kept as they are. The others are merged in groups, each from mode `n` to mode `1.5 n`, into
//! one relaxation with the sum of their gains and their static impedance. Groups faster than [`RATE_MAX_1_S`] become part
//! of the direct term.

use core::f64::consts::PI;

use crate::impedance::{Impedance, Relaxation};

/// Most relaxations of a slab.
pub const RELAXATIONS_MAX: usize = 20;
/// Fastest rate, 1/s, of the relaxations of slabs and of fitted bodies; faster ones become part of the direct term. It is
/// below the largest rate that the device accepts in its tick of 1 ms, 690 1/s.
pub const RATE_MAX_1_S: f64 = 600.0;
/// Number of modes that are not merged.
const EXACT_MODES: u32 = 3;

/// Boundary condition at the back of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Back {
    /// No heat passes.
    Insulated,
    /// The back keeps its temperature from before the contact.
    Held,
    /// Behind a film of this coefficient, W/(m² K), there is the temperature from before the contact.
    Film(f64),
}

/// A slab of one material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// Thickness, m.
    pub thickness_m: f64,
    /// Conductivity, W/(m K).
    pub conductivity_w_mk: f64,
    /// Heat capacity per volume, J/(m³ K).
    pub capacity_j_m3k: f64,
    /// Boundary condition at the back.
    pub back: Back,
}

/// Relaxations of a slab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlabRelaxations {
    direct_m2k_w: f64,
    relaxations: [Relaxation; RELAXATIONS_MAX],
    count: usize,
}

impl SlabRelaxations {
    /// The impedance that they add up to.
    pub fn impedance(&self) -> Impedance<'_> {
        Impedance {
            direct_m2k_w: self.direct_m2k_w,
            relaxations: &self.relaxations[..self.count.min(RELAXATIONS_MAX)],
        }
    }
}

impl Slab {
    /// Root `x_n` of mode `n`, from 0.
    #[inline(never)]
    fn root(&self, n: u32) -> f64 {
        let multiple_of_pi = PI * f64::from(n);
        match self.back {
            Back::Insulated => multiple_of_pi,
            Back::Held => multiple_of_pi + PI / 2.0,
            Back::Film(film_w_m2k) => {
                let biot = film_w_m2k * self.thickness_m / self.conductivity_w_mk;
                // Fixed-point iteration with a relaxation factor of 1/2: each step at least halves the error, for any Biot
                // number.
                (0..50).fold(multiple_of_pi + libm::sqrt(biot).min(PI / 2.0), |x, _| {
                    (x + multiple_of_pi + libm::atan(biot / x)) / 2.0
                })
            }
        }
    }

    /// Mode `n`. Not inlined, because `f64` arithmetic takes much code on a microcontroller.
    #[inline(never)]
    fn mode(&self, n: u32) -> Relaxation {
        let x = self.root(n);
        let unit = 1.0 / (self.capacity_j_m3k * self.thickness_m);
        let gain_m2k_j = match self.back {
            Back::Insulated if n == 0 => unit,
            Back::Insulated | Back::Held => 2.0 * unit,
            // The mode's norm contains sin(2x) / (2x), which is B / (x² + B²) because x tan x = B.
            Back::Film(film_w_m2k) => {
                let biot = film_w_m2k * self.thickness_m / self.conductivity_w_mk;
                2.0 * unit / (1.0 + biot / (x * x + biot * biot))
            }
        };
        let diffusion_1_s =
            self.conductivity_w_mk / (self.capacity_j_m3k * self.thickness_m * self.thickness_m);
        Relaxation { rate_1_s: x * x * diffusion_1_s, gain_m2k_j }
    }

    /// The relaxations of the slab, the slowest first. If there are more than [`RELAXATIONS_MAX`], the static impedance of the
    /// fastest is added to the direct term.
    #[inline]
    pub fn relaxations(&self) -> SlabRelaxations {
        let mut all = SlabRelaxations {
            direct_m2k_w: 0.0,
            relaxations: [Relaxation { rate_1_s: 0.0, gain_m2k_j: 0.0 }; RELAXATIONS_MAX],
            count: 0,
        };
        let mut first = 0;
        let mut kept_m2k_w = 0.0;
        while all.count < RELAXATIONS_MAX {
            let end = if first < EXACT_MODES { first + 1 } else { first + first.div_ceil(2) };
            let (mut gain_m2k_j, mut static_m2k_w) = (0.0, 0.0);
            for n in first..end {
                let mode = self.mode(n);
                gain_m2k_j += mode.gain_m2k_j;
                static_m2k_w +=
                    if mode.rate_1_s > 0.0 { mode.gain_m2k_j / mode.rate_1_s } else { 0.0 };
            }
            let rate_1_s = if static_m2k_w > 0.0 { gain_m2k_j / static_m2k_w } else { 0.0 };
            if rate_1_s > RATE_MAX_1_S {
                break;
            }
            kept_m2k_w += static_m2k_w;
            all.relaxations[all.count] = Relaxation { rate_1_s, gain_m2k_j };
            all.count += 1;
            first = end;
        }
        // Static impedance of all modes but the integrator; with an insulated back, a third of L / k.
        let resistance_m2k_w = self.thickness_m / self.conductivity_w_mk;
        let static_total_m2k_w = match self.back {
            Back::Insulated => resistance_m2k_w / 3.0,
            Back::Held => resistance_m2k_w,
            Back::Film(film_w_m2k) => resistance_m2k_w + 1.0 / film_w_m2k,
        };
        all.direct_m2k_w = (static_total_m2k_w - kept_m2k_w).max(0.0);
        all
    }
}
