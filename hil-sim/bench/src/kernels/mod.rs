//! Kernels that compute `E = erfcx(sqrt(u))` for `u = n K`. All take the firmware's arguments, the ticks `n` since contact
//! and `K`, so that forming `z = sqrt(u)` is part of their cost.

mod chebyshev;
mod coefficients;
mod library;
mod one_polynomial;
mod root;
mod tables;

use contact_model::fixed_point::{Fraction, MantissaExponent, Ticks, erfcx};

use crate::inputs::Input;

pub(crate) use chebyshev::shepherd_laframboise;
pub(crate) use library::{libm_f32, libm_f64};

/// A kernel that computes `E`.
#[derive(Clone, Copy)]
pub struct Kernel {
    /// Short name, unique.
    pub id: &'static str,
    /// Description.
    pub title: &'static str,
    /// Size of coefficients and tables.
    pub table: Table,
    /// The function.
    pub call: Call,
}

/// The firmware's kernel, not inlined.
fn firmware(elapsed: Ticks, per_tick: MantissaExponent) -> Fraction {
    erfcx(elapsed, per_tick)
}

/// Size of coefficients and tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// Number of bytes.
    Bytes(usize),
    /// Tables of the firmware's kernel, whose size is read from the image.
    Firmware,
    /// Unknown: constants in the code of a library.
    Library,
}

/// A kernel's function, in its own number types.
#[derive(Clone, Copy)]
pub enum Call {
    /// Integers.
    Fixed(fn(Ticks, MantissaExponent) -> Fraction),
    /// Single precision, the width of the FPU.
    Single(fn(u32, f32) -> f32),
    /// Double precision, in software on this microcontroller.
    Double(fn(u32, f64) -> f64),
}

/// Result of a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Of [`Call::Fixed`].
    Fixed(Fraction),
    /// Of [`Call::Single`].
    Single(f32),
    /// Of [`Call::Double`].
    Double(f64),
}

impl Call {
    /// Calls the function.
    #[inline]
    pub fn on(self, input: &Input) -> Value {
        match self {
            Self::Fixed(f) => Value::Fixed(f(input.elapsed, input.rate)),
            Self::Single(f) => Value::Single(f(input.elapsed.get(), input.single)),
            Self::Double(f) => Value::Double(f(input.elapsed.get(), input.double)),
        }
    }

    /// A function of the same type that only returns, which costs the overhead of a call.
    pub fn only_return(self) -> Self {
        match self {
            Self::Fixed(_) => Self::Fixed(only_return_fixed),
            Self::Single(_) => Self::Single(only_return_single),
            Self::Double(_) => Self::Double(only_return_double),
        }
    }
}

/// Paths of the functions that only return, as the image's symbols name them.
pub const ONLY_RETURN: [&str; 4] = [
    "model_bench::kernels::only_return_fixed",
    "model_bench::kernels::only_return_single",
    "model_bench::kernels::only_return_double",
    "model_bench::scenes::only_return_scene",
];

#[inline(never)]
fn only_return_fixed(elapsed: Ticks, _: MantissaExponent) -> Fraction {
    Fraction::from_bits(elapsed.get())
}

#[inline(never)]
fn only_return_single(_: u32, per_tick: f32) -> f32 {
    per_tick
}

#[inline(never)]
fn only_return_double(_: u32, per_tick: f64) -> f64 {
    per_tick
}

impl Value {
    /// The number, exactly.
    pub fn to_f64(self) -> f64 {
        match self {
            Self::Fixed(value) => value.to_num(),
            Self::Single(value) => f64::from(value),
            Self::Double(value) => value,
        }
    }

    /// The value as 64 bits; the same for every NaN, whose sign differs between processors.
    pub fn to_bits(self) -> u64 {
        match self {
            Self::Single(value) if value.is_nan() => u64::MAX,
            Self::Double(value) if value.is_nan() => u64::MAX,
            Self::Fixed(value) => u64::from(value.to_bits()),
            Self::Single(value) => u64::from(value.to_bits()),
            Self::Double(value) => value.to_bits(),
        }
    }
}

/// The firmware's kernel; its table is found in the image by its module's name.
pub const OURS: &str = "firmware";

const fn kernel(id: &'static str, title: &'static str, table: Table, call: Call) -> Kernel {
    Kernel { id, title, table, call }
}

/// All kernels, the firmware's first.
pub static KERNELS: [Kernel; 15] = [
    kernel(OURS, "the firmware's kernel, integers", Table::Firmware, Call::Fixed(firmware)),
    kernel("libm-f64", "libm f64: exp(u) erfc(z)", Table::Library, Call::Double(libm_f64)),
    kernel("libm-f32", "libm f32: exp(u) erfc(z)", Table::Library, Call::Single(libm_f32)),
    kernel(
        "micromath-erfc",
        "micromath exp(u), libm f32 erfc(z)",
        Table::Library,
        Call::Single(library::micromath_erfc),
    ),
    kernel(
        "micromath-as",
        "micromath exp(u), A&S 7.1.26 erfc(z)",
        Table::Bytes(24),
        Call::Single(library::micromath_as),
    ),
    kernel(
        "as",
        "A&S 7.1.26 without the exp",
        Table::Bytes(24),
        Call::Single(library::abramowitz_stegun),
    ),
    kernel(
        "shepherd",
        "Shepherd-Laframboise f32",
        Table::Bytes(48),
        Call::Single(shepherd_laframboise),
    ),
    kernel(
        "faddeeva",
        "Faddeeva structure f64",
        Table::Bytes(5600),
        Call::Double(chebyshev::faddeeva),
    ),
    kernel(
        "one-polynomial",
        "one polynomial in 1/(1 + z/2), integers",
        Table::Bytes(60),
        Call::Fixed(one_polynomial::one_polynomial),
    ),
    kernel(
        "linear-4",
        "table in z, linear, 4 KiB",
        Table::Bytes(4 << 10),
        Call::Single(tables::linear_4),
    ),
    kernel(
        "linear-16",
        "table in z, linear, 16 KiB",
        Table::Bytes(16 << 10),
        Call::Single(tables::linear_16),
    ),
    kernel(
        "linear-64",
        "table in z, linear, 64 KiB",
        Table::Bytes(64 << 10),
        Call::Single(tables::linear_64),
    ),
    kernel(
        "quadratic-4",
        "table in z, quadratic, 4 KiB",
        Table::Bytes(4 << 10),
        Call::Single(tables::quadratic_4),
    ),
    kernel(
        "quadratic-16",
        "table in z, quadratic, 16 KiB",
        Table::Bytes(16 << 10),
        Call::Single(tables::quadratic_16),
    ),
    kernel(
        "quadratic-64",
        "table in z, quadratic, 64 KiB",
        Table::Bytes(64 << 10),
        Call::Single(tables::quadratic_64),
    ),
];
