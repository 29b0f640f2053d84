//! Fast formatting of lines to the host with words and decimal numbers.
//!
//! A telemetry line has ten numbers and is written up to a thousand times a second; the `Display` of the fixed-point
//! types takes ten times as long.

use core::fmt;

use contact_model::fixed_point::{Celsius, Force};

use thermal_device::Flux;
use thermal_device::drive::Current;
use thermal_device::sense::SupplyVoltage;

/// Capacity of a [`LineBuffer`], bytes: enough for the longest telemetry and the longest answer to `state`.
const LINE_CAPACITY_BYTES: usize = 160;

/// A line to the host that is being written, of at most 160 ASCII characters. A word or number that does not fit is
/// left out as a whole.
pub(super) struct LineBuffer {
    bytes: [u8; LINE_CAPACITY_BYTES],
    length: usize,
}

impl LineBuffer {
    pub(super) const fn new() -> Self {
        Self {
            bytes: [0; LINE_CAPACITY_BYTES],
            length: 0,
        }
    }

    fn push_byte_if_fits(&mut self, byte: u8) {
        if let Some(place) = self.bytes.get_mut(self.length) {
            *place = byte;
            self.length += 1;
        }
    }

    pub(super) fn push_str_if_fits(&mut self, ascii: &str) {
        let end = self.length + ascii.len();
        if let Some(place) = self.bytes.get_mut(self.length..end) {
            for (place, byte) in place.iter_mut().zip(ascii.bytes()) {
                *place = byte;
            }
            self.length = end;
        }
    }

    /// Appends a temperature in °C with `DIGITS` decimals, or `-` for `None`.
    pub(super) fn push_celsius_or_dash<const DIGITS: usize>(&mut self, value: Option<Celsius>) {
        match value {
            Some(value) => self.push_fixed_point_bits::<22, DIGITS>(value.to_bits().into()),
            None => self.push_byte_if_fits(b'-'),
        }
    }

    /// Appends a force in N with three decimals, or `-` for `None`.
    pub(super) fn push_force_or_dash(&mut self, value: Option<Force>) {
        match value {
            Some(value) => self.push_fixed_point_bits::<24, 3>(value.to_bits().into()),
            None => self.push_byte_if_fits(b'-'),
        }
    }

    /// Appends a heat flux in W/m² with one decimal, or `-` for `None`.
    pub(super) fn push_flux_or_dash(&mut self, value: Option<Flux>) {
        match value {
            Some(value) => self.push_fixed_point_bits::<12, 1>(value.to_bits().into()),
            None => self.push_byte_if_fits(b'-'),
        }
    }

    /// Appends a current in A with three decimals, after a `-` if it is negative.
    pub(super) fn push_current(&mut self, value: Current) {
        self.push_fixed_point_bits::<24, 3>(value.to_bits().into());
    }

    /// Appends a current in A with two decimals, or `-` for `None`.
    pub(super) fn push_current_or_dash(&mut self, value: Option<Current>) {
        match value {
            Some(value) => self.push_fixed_point_bits::<24, 2>(value.to_bits().into()),
            None => self.push_byte_if_fits(b'-'),
        }
    }

    /// Appends the bridge's supply in V with one decimal, or `-` for `None`.
    pub(super) fn push_supply_or_dash(&mut self, value: Option<SupplyVoltage>) {
        match value {
            Some(value) => self.push_scaled_integer::<1>(value.decivolts()),
            None => self.push_byte_if_fits(b'-'),
        }
    }

    /// Appends a number, or `-` for `None`.
    pub(super) fn push_integer_or_dash(&mut self, value: Option<u8>) {
        match value {
            Some(value) => self.push_integer(value.into()),
            None => self.push_byte_if_fits(b'-'),
        }
    }

    /// Appends a sum of 16 conversions as their mean with two decimals, 0.00 to 4095.94.
    pub(super) fn push_mean_of_16(&mut self, sum: u16) {
        self.push_fixed_point_bits::<4, 2>(sum.into());
    }

    pub(super) fn push_integer(&mut self, value: u32) {
        self.push_scaled_integer::<0>(value);
    }

    /// Appends the fixed-point number `bits / 2^FRACTION` as a decimal number with `DIGITS` decimals, rounded to the
    /// nearest.
    fn push_fixed_point_bits<const FRACTION: u32, const DIGITS: usize>(&mut self, bits: i64) {
        let scale = const { 10u64.pow(DIGITS as u32) };
        let scaled = (bits.unsigned_abs() * scale + (1 << (FRACTION - 1))) >> FRACTION;
        // Fixed-point types are below 2^10, so a `u32` holds five decimals; a flux is below 2^19 and has one.
        let scaled = u32::try_from(scaled).unwrap_or(u32::MAX);
        if bits < 0 && scaled != 0 {
            self.push_byte_if_fits(b'-');
        }
        self.push_scaled_integer::<DIGITS>(scaled);
    }

    /// Appends the number `value / 10^DIGITS` with a decimal point and `DIGITS` decimals, or without a point if
    /// `DIGITS` is 0.
    fn push_scaled_integer<const DIGITS: usize>(&mut self, mut value: u32) {
        // Digits before the decimal point: at least one, and at most ten digits altogether, those of a `u32`.
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

impl fmt::Display for LineBuffer {
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
        for bits in (i32::MIN..=i32::MAX)
            .step_by(9973)
            .chain([i32::MIN, -1, 0, 1, i32::MAX])
        {
            let exact = f64::from(bits) / f64::from(1 << 22);
            let text = text(|text| text.push_celsius_or_dash::<5>(Some(Celsius::from_bits(bits))));
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
        assert_eq!(text(|text| text.push_celsius_or_dash::<2>(None)), "-");
        assert_eq!(
            text(|text| text.push_force_or_dash(Some(Force::MAX))),
            "256.000"
        );
        assert_eq!(
            text(|text| text.push_current(Current::lit("-1.25"))),
            "-1.250"
        );
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
