//! Contact model in fixed point, for the control path of the microcontroller.
//!
//! No input causes a panic or an overflow; values out of range saturate. The control path uses no
//! floating-point arithmetic. Set-up ([`ContactPair::new`]) uses `f64`, once per material.

mod body;
mod chord_interpolation;
mod contact;
mod contact_pair;
mod half_space;
pub mod kernel;
mod kernel_table;
mod log_table;
mod logarithm;
mod mantissa_exponent;
mod own_contact_law;
mod pressure;
mod product;
mod properties;
mod relaxation_bank;
mod ticks;

pub use body::{
    Body, BodyError, BodyState, FAST_MAX, FingerBody, SLOW_MAX, ScaledBody, TissueState,
    TissueStateFactors, TissueWeights, WEIGHTS,
};
pub use chord_interpolation::ChordInterpolation;
pub use contact::{Contact, Response, preset};
pub use contact_pair::ContactPair;
pub use half_space::{ContactConductance, HalfSpace, OwnResistances};
pub use kernel::erfcx;
pub use logarithm::{Log2, exp2, log2};
pub use mantissa_exponent::MantissaExponent;
pub use own_contact_law::OwnContactLaw;
pub use pressure::{Area, Force, contact_area, log2_relative_pressure};
pub use product::{
    Word, product, rounded_units, saturated, saturating_product, to_fixed, truncated_units,
    units_to_f64,
};
pub use properties::ContactPairError;
pub use relaxation_bank::{
    FastRelaxation, MATCH_HORIZON_TICKS, RelaxationBank, Relaxations, SlowRelaxation, StateFactors,
};
pub use ticks::Ticks;

use fixed::types::{I10F22, I40F24, U0F32, U4F28};

/// Temperature, °C, or temperature difference, K: ±512, resolution 0.24 µK.
pub type Celsius = I10F22;
/// Heat flux, W/m²: ±5e11, resolution 6e-8.
pub type Flux = I40F24;
/// Fraction, dimensionless: 0 to 1 - 2^-32, resolution 2^-32. The maximum stands for 1.
pub type Fraction = U0F32;
/// Ratio of contact resistances `R_display / R_object`, dimensionless: 0 to 16, resolution 2^-28.
pub type Ratio = U4F28;

/// Range of temperatures in which the stated error bounds hold, °C.
pub const TEMPERATURE_RANGE_C: core::ops::RangeInclusive<i16> = -40..=125;
