//! erfcx to about 100 bits: the truth of the figures, and what the peers' coefficients are fitted to.
use std::ops::{Add, Div, Mul, Sub};

/// An unevaluated sum of two `f64`, the second below half an ulp of the first (T. J. Dekker, *A floating-point
/// technique for extending the available precision*, 1971).
#[derive(Clone, Copy, Debug)]
pub struct Twofold {
    /// The value rounded to `f64`.
    pub high: f64,
    /// The rest.
    pub low: f64,
}

/// `a + b` for `|a| >= |b|`.
fn quick_sum(a: f64, b: f64) -> Twofold {
    let high = a + b;
    Twofold { high, low: b - (high - a) }
}

/// `a + b`, exactly.
fn exact_sum(a: f64, b: f64) -> Twofold {
    let high = a + b;
    let part = high - a;
    Twofold { high, low: (a - (high - part)) + (b - part) }
}

/// `a * b`, exactly.
pub fn exact_product(a: f64, b: f64) -> Twofold {
    let high = a * b;
    Twofold { high, low: a.mul_add(b, -high) }
}

impl From<f64> for Twofold {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Add for Twofold {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let high = exact_sum(self.high, other.high);
        let low = exact_sum(self.low, other.low);
        let sum = quick_sum(high.high, high.low + low.high);
        quick_sum(sum.high, sum.low + low.low)
    }
}

impl Sub for Twofold {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

impl Mul for Twofold {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = exact_product(self.high, other.high);
        quick_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Twofold {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let rest = rest - other * second.into();
        quick_sum(first, second) + (rest.high / other.high).into()
    }
}

impl Twofold {
    /// Square root of a positive number.
    fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        let rest = self - exact_product(root, root);
        quick_sum(root, rest.high / (2.0 * root))
    }
}

const PI: Twofold = Twofold { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };

/// Up to here the power series are used: what they cancel is far below their precision.
const SERIES_UP_TO: f64 = 6.0;
/// Levels of the continued fraction, whose error falls as `exp(-2 z sqrt(2 levels))`.
const LEVELS: u32 = 120;

/// `erfcx(sqrt(u))` for `u > 0`; relative error below 1e-25.
///
/// For small `u` by the power series of `exp(u)` and of `exp(u) erf(sqrt(u))` (Abramowitz and Stegun 7.1.6), else
/// by Laplace's continued fraction (7.1.14).
pub fn erfcx_of_root(u: Twofold) -> Twofold {
    let z = u.sqrt();
    if u.high > SERIES_UP_TO {
        let tail = (1..=LEVELS)
            .rev()
            .fold(z, |tail, level| z + Twofold::from(0.5 * f64::from(level)) / tail);
        return Twofold::from(1.0) / (PI.sqrt() * tail);
    }
    let two = Twofold::from(2.0);
    let mut power = Twofold::from(1.0);
    let mut odd = two * z / PI.sqrt();
    let mut sum = power - odd;
    let mut k = 1.0;
    while odd.high > 1e-34 {
        power = power * u / k.into();
        odd = odd * two * u / (2.0 * k + 1.0).into();
        sum = sum + (power - odd);
        k += 1.0;
    }
    sum
}
