//! Thermal contact of a fingertip with an object: contact resistance, transient surface temperatures and
//! the set-point of a thermal display, after H.-N. Ho, *Development and Evaluation of a Thermal Model for
//! Haptic Interfaces*, PhD thesis, MIT 2006. Equation numbers in this crate are the thesis's.
//!
//! # One function serves every output
//! Skin and object are half-spaces of effusivity `e = sqrt(k rho c)`, joined at time zero through a
//! contact resistance `R`. With
//!
//! ```text
//! b = (1/e_skin + 1/e_object) / R      E(t) = exp(b² t) erfc(b sqrt(t)) = erfcx(b sqrt(t))
//! w = e_object / (e_object + e_skin)   dT = T_skin,i - T_object,i        r = R_display / R_object
//! ```
//!
//! equations 6-5, 6-6, 6-7 and 6-12 become
//!
//! ```text
//! T_skin   = T_skin,i   - dT w (1 - E)          q = dT E / R   (positive out of the skin)
//! T_object = T_object,i + dT (1 - w) (1 - E)    T_display = T_skin - r dT E
//! ```
//!
//! so one evaluation of `E` is shared by all of them. `R`, and hence `b²`, follow the contact pressure by
//! equations 6-8 to 6-11; `r` does not depend on pressure. The limit of no resistance is perfect contact of
//! two half-spaces, equations 3-1 to 3-4; in that of infinite resistance nothing is exchanged.
//!
//! # Two implementations
//! - [`mod@reference`]: the same formulas in `f64` (or `f32`), for tests, tools and set-up.
//! - [`fixed_point`]: integers only, for the control path of a microcontroller: no float, no panic, no
//!   overflow for any input. Its parameters are derived once per material, in `f64`, by
//!   [`fixed_point::ContactPair::new`]; a force that streams in becomes resistance and rate by
//!   [`fixed_point::log2_relative_pressure`] and [`fixed_point::ContactPair::at_pressure`], without division or float.
//!   `tests/budgets.rs` measures each stated error (`cargo test --release -p contact-model --test budgets --
//!   --nocapture`).
//!
//! The fixed path is for resistances from 1e-7 to 10 m² K/W, ticks from 10 µs to 100 ms, every force above zero
//! that [`fixed_point::Force`] holds (to 256 N) and temperatures from -40 to 125 °C; beyond, it saturates.
//!
//! Equation 6-8 is quoted by the thesis as valid from 35 to 350 kPa and used by it from 0.7 to 15 kPa: an
//! extrapolation, which the thesis itself finds to underestimate the cooling at low pressure.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod fixed_point;
pub mod material;
pub mod pressure;
pub mod reference;
