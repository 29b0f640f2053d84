//! Lines of words and decimals, without the general formatting of numbers.
//!
//! A streamed line has ten numbers, a thousand times a second: the formatting of the number types costs ten
//! times as much.

use core::fmt;

use contact_model::fixed_point::{Celsius, Force};

use thermal_device::drive::Current;

/// Longest line, bytes.
const LONGEST: usize = 128;

/// A line that is being written; what does not fit is left out.
pub(super) struct Text {
    bytes: [u8; LONGEST],
    length: usize,
}

impl Text {
    pub(super) const fn new() -> Self {
        Self {
            bytes: [0; LONGEST],
            length: 0,
        }
    }

    fn byte(&mut self, byte: u8) {
        if let Some(place) = self.bytes.get_mut(self.length) {
            *place = byte;
            self.length += 1;
        }
    }

    /// Appends ASCII.
    pub(super) fn word(&mut self, word: &str) {
        let end = self.length + word.len();
        if let Some(place) = self.bytes.get_mut(self.length..end) {
            for (place, byte) in place.iter_mut().zip(word.bytes()) {
                *place = byte;
            }
            self.length = end;
        }
    }

    /// Appends a temperature in °C with that many decimals.
    pub(super) fn celsius<const DIGITS: usize>(&mut self, value: Option<Celsius>) {
        match value {
            Some(value) => self.decimal::<22, DIGITS>(value.to_bits().into()),
            None => self.byte(b'-'),
        }
    }

    /// Appends a force in N with three decimals.
    pub(super) fn force(&mut self, value: Option<Force>) {
        match value {
            Some(value) => self.decimal::<24, 3>(value.to_bits().into()),
            None => self.byte(b'-'),
        }
    }

    /// Appends a current in A with three decimals.
    pub(super) fn current(&mut self, value: Current) {
        self.decimal::<24, 3>(value.to_bits().into());
    }

    /// Appends a whole number.
    pub(super) fn count(&mut self, value: u32) {
        self.digits::<0>(value);
    }

    /// Appends `bits / 2^FRACTION` with `DIGITS` decimals, rounded to nearest.
    fn decimal<const FRACTION: u32, const DIGITS: usize>(&mut self, bits: i64) {
        let scale = const { 10u64.pow(DIGITS as u32) };
        let scaled = (bits.unsigned_abs() * scale + (1 << (FRACTION - 1))) >> FRACTION;
        // The number types stay below 2^10, so five decimals fit.
        let scaled = u32::try_from(scaled).unwrap_or(u32::MAX);
        if bits < 0 && scaled != 0 {
            self.byte(b'-');
        }
        self.digits::<DIGITS>(scaled);
    }

    /// Appends `value / 10^DIGITS`.
    fn digits<const DIGITS: usize>(&mut self, mut value: u32) {
        // Digits before the point: at least one, and all in all no more than ten.
        let mut whole = 1;
        let mut bound = const { 10u32.pow(DIGITS as u32 + 1) };
        while value >= bound && whole + DIGITS < 10 {
            whole += 1;
            bound = bound.saturating_mul(10);
        }
        let end = self.length + whole + if DIGITS == 0 { 0 } else { 1 + DIGITS };
        let place = self.bytes.get_mut(self.length..end);
        let Some((whole, rest)) = place.and_then(|place| place.split_at_mut_checked(whole)) else {
            return;
        };
        let mut put = |places: &mut [u8]| {
            for place in places.iter_mut().rev() {
                *place = b'0' + (value % 10) as u8;
                value /= 10;
            }
        };
        if let Some((point, decimals)) = rest.split_first_mut() {
            *point = b'.';
            put(decimals);
        }
        put(whole);
        self.length = end;
    }
}

impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let written = self.bytes.get(..self.length).unwrap_or_default();
        // Only ASCII is ever appended.
        f.write_str(core::str::from_utf8(written).unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::{String, ToString};

    fn text(write: impl Fn(&mut Text)) -> String {
        let mut text = Text::new();
        write(&mut text);
        text.to_string()
    }

    #[test]
    fn decimals_agree_with_exact_arithmetic() {
        for bits in (i32::MIN..=i32::MAX)
            .step_by(9973)
            .chain([i32::MIN, -1, 0, 1, i32::MAX])
        {
            let exact = f64::from(bits) / f64::from(1 << 22);
            let text = text(|text| text.celsius::<5>(Some(Celsius::from_bits(bits))));
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
            assert_ne!(text, "-0.00000");
        }
        assert_eq!(text(|text| text.celsius::<2>(None)), "-");
        assert_eq!(text(|text| text.force(Some(Force::MAX))), "256.000");
        assert_eq!(text(|text| text.current(Current::lit("-1.25"))), "-1.250");
        for count in [0, 9, 10, 12_345, u32::MAX] {
            assert_eq!(text(|text| text.count(count)), count.to_string());
        }
    }

    #[test]
    fn what_does_not_fit_is_left_out() {
        assert_eq!(
            text(|text| (0..100).for_each(|_| text.word("ab "))).len(),
            LONGEST / 3 * 3
        );
        assert_eq!(
            text(|text| (0..100).for_each(|_| text.count(12345))).len(),
            LONGEST / 5 * 5
        );
    }
}
