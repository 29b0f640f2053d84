//! Numbers in a line from the host, each with its range.

use core::fmt;
use core::marker::PhantomData;

use contact_model::fixed_point::{Celsius, rounded_units, saturated, units_to_f64};
use fixed::types::I32F32;
use thermal_settings::Range;

use crate::ReadError;
use crate::argument::Argument;
#[cfg(feature = "host")]
use crate::host::ArgumentForm;
use crate::words::{Words, read_fixed_point_within, read_whole_number_in_range};

/// A quantity that a host sends.
pub trait Quantity {
    /// Its name, unit and range.
    const RANGE: &'static Range;
    /// Its smallest and its largest value.
    const LIMITS: [I32F32; 2];
    /// Decimals with which a host writes it; `None` for as many as it has.
    const DECIMALS: Option<u32>;
}

/// Declares quantities: name in error messages, unit, range, and decimals unless a host writes as many as there are.
macro_rules! quantities {
    ($($(#[$doc:meta])+ $quantity:ident = $name:literal, $unit:literal, $min:expr, $max:expr
        $(, $decimals:literal decimals)?;)+) => {$(
        $(#[$doc])+
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $quantity {}

        impl $crate::number::Quantity for $quantity {
            const RANGE: &'static thermal_settings::Range =
                &thermal_settings::Range { name: $name, unit: $unit, min: $min, max: $max };
            const LIMITS: [fixed::types::I32F32; 2] =
                [$crate::number::nearest($min), $crate::number::nearest($max)];
            const DECIMALS: Option<u32> = [$(Some($decimals),)? None][0];
        }
    )+};
}
pub(crate) use quantities;

/// The nearest number of the fixed-point type, at compile time: the microcontroller takes long for double precision.
pub const fn nearest(value: f64) -> I32F32 {
    let scaled = value * (1u64 << I32F32::FRAC_NBITS) as f64;
    I32F32::from_bits((scaled + if scaled < 0.0 { -0.5 } else { 0.5 }) as i64)
}

/// A number of this quantity. One that was read from a line is within its range; a host may send any, which the device refuses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Number<Q>(I32F32, PhantomData<Q>);

impl<Q: Quantity> Number<Q> {
    /// The value.
    pub const fn fixed(self) -> I32F32 {
        self.0
    }

    /// The value.
    pub fn f64(self) -> f64 {
        units_to_f64(self.0.to_bits(), I32F32::FRAC_NBITS)
    }

    /// A time in s, in ms.
    #[inline(never)]
    pub fn milliseconds(self) -> u32 {
        let milliseconds = self.0.saturating_mul_int(1000).round();
        (milliseconds.to_bits() >> I32F32::FRAC_NBITS) as u32
    }

    /// The next whole number.
    pub fn ceil(self) -> u32 {
        (self.0.saturating_ceil().to_bits() >> I32F32::FRAC_NBITS) as u32
    }

    /// The value in the fixed-point type of temperatures, °C, and of their rates, K/s.
    pub fn celsius(self) -> Celsius {
        saturated(self.0)
    }
}

/// The nearest number that can be sent.
impl<Q: Quantity> From<f64> for Number<Q> {
    fn from(value: f64) -> Self {
        let rounded = Q::DECIMALS.map_or(value, |decimals| {
            let scale = f64::from(10u32.pow(decimals));
            libm::rint(value * scale) / scale
        });
        Self(I32F32::from_bits(rounded_units(rounded, I32F32::FRAC_NBITS)), PhantomData)
    }
}

impl<Q: Quantity> Argument for Number<Q> {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        read_fixed_point_within(words, Q::RANGE, &Q::LIMITS).map(|value| Self(value, PhantomData))
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Number(Q::RANGE)
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match Q::DECIMALS {
            Some(decimals) => write!(f, " {:.*}", decimals as usize, self.0),
            None => write!(f, " {}", self.0),
        }
    }
}

/// A whole number of this quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Whole<Q>(usize, PhantomData<Q>);

impl<Q: Quantity> Whole<Q> {
    /// The value.
    pub const fn get(self) -> usize {
        self.0
    }
}

impl<Q: Quantity> From<usize> for Whole<Q> {
    fn from(value: usize) -> Self {
        Self(value, PhantomData)
    }
}

impl<Q: Quantity> Argument for Whole<Q> {
    fn read(words: &mut Words<'_>) -> Result<Self, ReadError> {
        read_whole_number_in_range(words, Q::RANGE).map(Self::from)
    }

    #[cfg(feature = "host")]
    fn form() -> ArgumentForm {
        ArgumentForm::Whole(Q::RANGE)
    }

    fn write(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, " {}", self.0)
    }
}
