//! Fast formatting of lines to the host with words and decimal numbers.
//!
//! A telemetry line has ten numbers and is written up to a thousand times a second; the `Display` of the fixed-point
//! types takes ten times as long. What telemetry calls is `#[inline]`: it is then compiled in the package that sends it, whose code is
//! not for the smallest size.

use core::fmt;

use contact_model::decimal::Rounded;
use contact_model::fixed_point::{Celsius, Force};

use thermal_device::Flux;
use thermal_device::drive::Current;
use thermal_device::sense::SupplyVoltage;
use thermal_settings::PersonCode;

/// Capacity of a [`LineBuffer`], bytes: enough for the longest telemetry and the longest answer to `state`.
const LINE_CAPACITY_BYTES: usize = 160;

/// A line to the host that is being written, of at most 160 ASCII characters. A word or number that does not fit is
/// left out as a whole.
pub struct LineBuffer {
    bytes: [u8; LINE_CAPACITY_BYTES],
    length: usize,
}

impl Default for LineBuffer {
    fn default() -> Self {
        Self::new()
    }
}

impl LineBuffer {
    /// An empty line.
    #[inline]
    pub const fn new() -> Self {
        Self { bytes: [0; LINE_CAPACITY_BYTES], length: 0 }
    }

    /// Removes all characters.
    pub const fn clear(&mut self) {
        self.length = 0;
    }

    /// Appends a text of ASCII characters.
    #[inline]
    pub fn push_str_if_fits(&mut self, ascii: &str) {
        self.push_if_fits(ascii.as_bytes());
    }

    /// Appends a number with so many decimals, nine at most.
    #[inline(never)]
    pub fn push_decimal(&mut self, value: f64, digits: usize) {
        let (whole, fraction) = Rounded(value, digits).whole_and_fraction();
        if value.is_sign_negative() {
            self.push_str_if_fits("-");
        }
        self.push_integer(whole);
        let mut decimals = [b'.'; 10];
        if let Some(places) = decimals.get_mut(..=digits).filter(|_| digits > 0) {
            put_digits(fraction, places.get_mut(1..).unwrap_or_default());
            self.push_if_fits(places);
        }
    }

    /// Appends a byte as two hexadecimal digits, `A` or `a` being the first letter.
    #[inline(never)]
    pub fn push_hexadecimal(&mut self, byte: u8, first_letter: u8) {
        let digits = [byte >> 4, byte & 0x0f];
        self.push_if_fits(&digits.map(|digit| {
            let first = if digit < 10 { b'0' } else { first_letter - 10 };
            first + digit
        }));
    }

    /// Appends a person's code.
    #[inline(never)]
    pub fn push_person_code(&mut self, code: PersonCode) {
        for byte in code.to_bytes() {
            if byte != 0 {
                self.push_if_fits(&[byte]);
            }
        }
    }

    #[inline]
    fn push_if_fits(&mut self, ascii: &[u8]) {
        let end = self.length + ascii.len();
        if let Some(place) = self.bytes.get_mut(self.length..end) {
            // A call of `memcpy` would take longer than a word.
            for (place, byte) in place.iter_mut().zip(ascii) {
                *place = *byte;
            }
            self.length = end;
        }
    }

    /// Appends a temperature in °C with so many decimals, or `-` for `None`.
    #[inline]
    pub fn push_celsius_or_dash(&mut self, digits: usize, value: Option<Celsius>) {
        self.push_fixed_point_or_dash(
            value.map(|value| value.to_bits().into()),
            Celsius::FRAC_NBITS,
            digits,
        );
    }

    /// Appends a force in N with three decimals, or `-` for `None`.
    #[inline]
    pub fn push_force_or_dash(&mut self, value: Option<Force>) {
        self.push_fixed_point_or_dash(
            value.map(|value| value.to_bits().into()),
            Force::FRAC_NBITS,
            3,
        );
    }

    /// Appends a heat flux in W/m² with one decimal, or `-` for `None`.
    #[inline]
    pub fn push_flux_or_dash(&mut self, value: Option<Flux>) {
        self.push_fixed_point_or_dash(
            value.map(|value| value.to_bits().into()),
            Flux::FRAC_NBITS,
            1,
        );
    }

    /// Appends a current in A with so many decimals, after a `-` if it is negative.
    #[inline]
    pub fn push_current(&mut self, digits: usize, value: Current) {
        self.push_fixed_point_or_dash(Some(value.to_bits().into()), Current::FRAC_NBITS, digits);
    }

    /// Appends the bridge's supply in V with one decimal.
    #[inline]
    pub fn push_supply(&mut self, value: SupplyVoltage) {
        self.push_scaled_integer(value.decivolts(), 1);
    }

    /// Appends a sum of 16 conversions as their mean with two decimals, 0.00 to 4095.94.
    #[inline]
    pub fn push_mean_of_16(&mut self, sum: u16) {
        self.push_fixed_point_or_dash(Some(sum.into()), 4, 2);
    }

    /// Appends a number.
    #[inline]
    pub fn push_integer(&mut self, value: u32) {
        self.push_scaled_integer(value, 0);
    }

    /// Appends the fixed-point number `bits / 2^fraction` as a decimal number with so many decimals, five at most, rounded to the
    /// nearest, or `-` for `None`. The bits are those of an `i32` or `u32`, and the fraction has 1 to 31 of them.
    #[inline]
    fn push_fixed_point_or_dash(&mut self, bits: Option<i64>, fraction: u32, digits: usize) {
        let (Some(bits), Some(scale)) = (bits, POWERS_OF_TEN.get(digits)) else {
            return self.push_str_if_fits("-");
        };
        let product = u64::from(bits.unsigned_abs() as u32) * u64::from(*scale);
        let rounded = product + u64::from(1u32 << (fraction - 1));
        // A shift of 64 bits by a variable would be a call. Fixed-point types are below 2^10, so a `u32` holds five decimals; a
        // flux is below 2^19 and has one.
        let (high, low) = ((rounded >> 32) as u32, rounded as u32);
        let scaled = (high << (32 - fraction)) | (low >> fraction);
        if bits < 0 && scaled != 0 {
            self.push_str_if_fits("-");
        }
        self.push_scaled_integer(scaled, digits);
    }

    /// Appends the number `value / 10^digits` with a decimal point and so many decimals, or without a point if there are none.
    #[inline]
    fn push_scaled_integer(&mut self, value: u32, digits: usize) {
        // At least one digit stands before the point.
        let larger = POWERS_OF_TEN.iter().skip(digits + 1);
        let whole = 1 + larger.take_while(|power| value >= **power).count();
        let end = self.length + whole + if digits == 0 { 0 } else { 1 + digits };
        let place = self.bytes.get_mut(self.length..end);
        let Some((whole, rest)) = place.and_then(|place| place.split_at_mut_checked(whole)) else {
            return;
        };
        let mut value = value;
        if let Some((point, decimals)) = rest.split_first_mut() {
            *point = b'.';
            value = put_digits(value, decimals);
        }
        put_digits(value, whole);
        self.length = end;
    }
}

/// Powers of ten that a `u32` holds.
const POWERS_OF_TEN: [u32; 10] = {
    let mut powers = [1; 10];
    let mut k = 1;
    while k < powers.len() {
        powers[k] = 10 * powers[k - 1];
        k += 1;
    }
    powers
};

/// Writes the last digits of a number, and returns the others.
#[inline]
fn put_digits(mut value: u32, places: &mut [u8]) -> u32 {
    for place in places.iter_mut().rev() {
        // A tenth, exact for each `u32`: code that is optimised for size would divide.
        let tenth = ((u64::from(value) * 0xcccc_cccd) >> 35) as u32;
        *place = b'0' + (value - 10 * tenth) as u8;
        value = tenth;
    }
    value
}

impl fmt::Display for LineBuffer {
    #[inline]
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

    fn text(write: impl Fn(&mut LineBuffer)) -> String {
        let mut text = LineBuffer::new();
        write(&mut text);
        text.to_string()
    }

    #[test]
    fn decimals_are_the_exact_value_rounded() {
        for bits in (i32::MIN..=i32::MAX).step_by(9973).chain([i32::MIN, -1, 0, 1, i32::MAX]) {
            let exact = f64::from(bits) / f64::from(1 << 22);
            let text = text(|text| text.push_celsius_or_dash(5, Some(Celsius::from_bits(bits))));
            let value: f64 = text.parse().expect("a number");
            assert!((value - exact).abs() <= 0.5e-5 + 1e-12, "{bits}: {text}, exactly {exact}");
            assert_eq!(text.split_once('.').map(|(_, decimals)| decimals.len()), Some(5), "{text}");
            assert_ne!(text, "-0.00000");
        }
        assert_eq!(text(|text| text.push_celsius_or_dash(2, None)), "-");
        assert_eq!(text(|text| text.push_force_or_dash(Some(Force::MAX))), "256.000");
        assert_eq!(text(|text| text.push_current(3, Current::lit("-1.25"))), "-1.250");
        for count in [0, 9, 10, 12_345, u32::MAX] {
            assert_eq!(text(|text| text.push_integer(count)), count.to_string());
        }
    }

    #[test]
    fn a_word_or_number_that_does_not_fit_is_left_out() {
        assert_eq!(
            text(|text| (0..100).for_each(|_| text.push_str_if_fits("ab "))).len(),
            LINE_CAPACITY_BYTES / 3 * 3
        );
        assert_eq!(
            text(|text| (0..100).for_each(|_| text.push_integer(12345))).len(),
            LINE_CAPACITY_BYTES / 5 * 5
        );
    }
}
