//! Fixed-point numbers as decimals.
//!
//! A streamed line has ten of them, a thousand times a second: the general formatting of the number types costs
//! ten times as much.

use core::fmt;

use contact_model::fixed_point::{Celsius, Force};

use crate::drive::Current;

/// `bits / 2^FRACTION`, written with `DIGITS` decimals, rounded to nearest; `-` if unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Decimal<const FRACTION: u32, const DIGITS: usize>(Option<i64>);

/// Binary places of the number types of the protocol.
pub(super) const CELSIUS: u32 = 22;
pub(super) const FORCE: u32 = 24;
pub(super) const CURRENT: u32 = 24;

impl<const DIGITS: usize> From<Option<Celsius>> for Decimal<CELSIUS, DIGITS> {
    fn from(value: Option<Celsius>) -> Self {
        Self(value.map(|value| value.to_bits().into()))
    }
}

impl<const DIGITS: usize> Decimal<FORCE, DIGITS> {
    pub(super) fn force(value: Option<Force>) -> Self {
        Self(value.map(|value| value.to_bits().into()))
    }
}

impl<const DIGITS: usize> Decimal<CURRENT, DIGITS> {
    pub(super) fn current(value: Current) -> Self {
        Self(Some(value.to_bits().into()))
    }
}

impl<const FRACTION: u32, const DIGITS: usize> fmt::Display for Decimal<FRACTION, DIGITS> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(bits) = self.0 else {
            return f.write_str("-");
        };
        let scaled = (bits.unsigned_abs() * 10u64.pow(DIGITS as u32) + (1 << (FRACTION - 1))) >> FRACTION;
        // At most 2^10 with 5 decimals: fits, and the division by ten stays in one register.
        let mut rest = u32::try_from(scaled).unwrap_or(u32::MAX);
        let negative = bits < 0 && rest != 0;
        let mut text = [b'0'; 12];
        let mut at = text.len();
        let mut written = 0;
        while rest != 0 || written <= DIGITS {
            let digit = (rest % 10) as u8;
            rest /= 10;
            if written == DIGITS && DIGITS != 0 {
                at = put(&mut text, at, b'.');
            }
            at = put(&mut text, at, b'0' + digit);
            written += 1;
        }
        if negative {
            at = put(&mut text, at, b'-');
        }
        f.write_str(
            text.get(at..)
                .and_then(|text| core::str::from_utf8(text).ok())
                .unwrap_or("-"),
        )
    }
}

/// Puts a byte in front of what stands at `at`; gives where it stands now.
fn put(text: &mut [u8; 12], at: usize, byte: u8) -> usize {
    let at = at.saturating_sub(1);
    if let Some(place) = text.get_mut(at) {
        *place = byte;
    }
    at
}

/// A count, by the same digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Count(pub(super) u32);

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Decimal::<1, 0>(Some(i64::from(self.0) << 1)).fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    #[test]
    fn decimals_agree_with_exact_arithmetic() {
        for bits in (i32::MIN..=i32::MAX)
            .step_by(9973)
            .chain([i32::MIN, -1, 0, 1, i32::MAX])
        {
            let exact = i64::from(bits) as f64 / f64::from(1 << CELSIUS);
            let text = Decimal::<CELSIUS, 5>::from(Some(Celsius::from_bits(bits))).to_string();
            let value: f64 = text.parse().expect("a number");
            assert!(
                (value - exact).abs() <= 0.5e-5 + 1e-12,
                "{bits}: {text}, exactly {exact}"
            );
            assert_eq!(
                text.split_once('.').map(|(_, decimals)| decimals.len()),
                Some(5),
                "{text}"
            );
            assert!(text != "-0.00000");
        }
        assert_eq!(Decimal::<CELSIUS, 2>::from(None).to_string(), "-");
        assert_eq!(
            Decimal::<FORCE, 3>::force(Some(Force::MAX)).to_string(),
            "256.000"
        );
        assert_eq!(
            Decimal::<CURRENT, 3>::current(Current::lit("-1.25")).to_string(),
            "-1.250"
        );
        for count in [0, 9, 10, 12_345, u32::MAX] {
            assert_eq!(Count(count).to_string(), count.to_string());
        }
    }
}
