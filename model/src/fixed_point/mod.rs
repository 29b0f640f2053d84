//! The model in integers: the control path of the microcontroller.
//!
//! No float, no panic and no overflow for any input; out-of-range values saturate. Set-up
//! ([`ContactPair::new`]) is in `f64` and happens once per material, not per tick.

mod chord_interpolation;
mod contact;
mod contact_pair;
mod erf;
mod erf_table;
mod half_space;
pub mod kernel;
mod kernel_table;
mod log_table;
mod logarithm;
mod mantissa_exponent;
mod piecewise;
mod pressure;
mod product;
mod properties;
mod semi_infinite;
mod ticks;

pub use chord_interpolation::ChordInterpolation;
pub use contact::{Contact, Response};
pub use contact_pair::ContactPair;
pub use erf::{ErfArgument, erf};
pub use half_space::{ContactConductance, HalfSpace, MATCH_HORIZON_TICKS};
pub use kernel::erfcx;
pub use logarithm::{Log2, exp2, log2};
pub use mantissa_exponent::MantissaExponent;
pub use pressure::{Area, Force, contact_area, log2_relative_pressure};
pub use product::{Word, product, saturated, saturating_product, to_fixed};
pub use properties::ContactPairError;
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
