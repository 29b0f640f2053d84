//! The model in integers: the control path of the microcontroller.
//!
//! No float, no panic and no overflow for any input; out-of-range values saturate. Set-up
//! ([`Pairing::new`]) is in `f64` and happens once per material, not per tick.

mod contact;
mod course;
mod erf;
mod erf_table;
mod half_order;
pub mod kernel;
mod kernel_table;
mod log_table;
mod logarithm;
mod pairing;
mod piecewise;
mod pressure;
mod properties;
mod rate;
mod semi_infinite;
mod ticks;

pub use contact::{Contact, Response};
pub use course::Course;
pub use erf::{ErfArgument, erf};
pub use half_order::{AHEAD_TICKS, HalfOrder, Link};
pub use kernel::erfcx;
pub use logarithm::{Log2, exp2, log2};
pub use pairing::Pairing;
pub use pressure::{Area, Force, contact_area, log2_relative_pressure};
pub use properties::PairingError;
pub use rate::Rate;
pub use semi_infinite::{Depth, FourierNumber, SemiInfinite, fourier_number};
pub use ticks::Ticks;

use fixed::types::{I10F22, I40F24, U0F32, U4F28};

/// Temperature in °C or temperature difference in K: ±512 at a resolution of 0.24 µK.
pub type Celsius = I10F22;
/// Heat flux in W/m², resolution 6e-8.
pub type Flux = I40F24;
/// A part of the whole, 0 to 1 - 2^-32.
pub type Fraction = U0F32;
/// `R_display / R_object`, 0 to 16.
pub type Ratio = U4F28;

/// Temperature range over which the outputs keep their stated error, °C.
pub const TEMPERATURE_RANGE_C: core::ops::RangeInclusive<i16> = -40..=125;
