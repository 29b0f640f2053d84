//! Units of the values that instruments show, and values as a person types them.

use std::fmt;

use serde::Deserialize;

/// Unit of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Unit {
    /// Resistance, Ω. An open circuit is an infinite one.
    #[serde(rename = "ohm")]
    Ohm,
    /// Voltage, V.
    #[serde(rename = "V")]
    Volt,
    /// Current, A.
    #[serde(rename = "A")]
    Ampere,
    /// Temperature, °C.
    #[serde(rename = "C")]
    Celsius,
    /// Difference of temperatures, K.
    #[serde(rename = "K")]
    Kelvin,
    /// Time, ms.
    #[serde(rename = "ms")]
    Millisecond,
    /// Counts of the converter, of 4096.
    #[serde(rename = "counts")]
    Count,
    /// Gain of the force sensor, counts/N.
    #[serde(rename = "counts/N")]
    CountPerNewton,
    /// Number of lines or bytes.
    #[serde(rename = "pieces")]
    Piece,
    /// Ratio of two values.
    #[serde(rename = "ratio")]
    Ratio,
}

/// Prefixes of a unit and their factors.
const PREFIXES: [(char, f64); 6] =
    [('u', 1e-6), ('µ', 1e-6), ('m', 1e-3), ('k', 1e3), ('M', 1e6), ('G', 1e9)];

/// Why a typed value is not accepted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TypedValueError {
    /// It does not begin with a number.
    #[error("'{typed}' is no number; type one with its unit, such as '{example}'")]
    NoNumber {
        /// What was typed.
        typed: String,
        /// A value of the right unit.
        example: &'static str,
    },
    /// It has another unit.
    #[error("'{typed}' has the unit '{found}'; needed is {needed}, such as '{example}'")]
    OtherUnit {
        /// What was typed.
        typed: String,
        /// The unit that it has.
        found: String,
        /// The unit that is needed.
        needed: Unit,
        /// A value of the right unit.
        example: &'static str,
    },
}

impl Unit {
    /// The unit as it is printed.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Ohm => "Ω",
            Self::Volt => "V",
            Self::Ampere => "A",
            Self::Celsius => "°C",
            Self::Kelvin => "K",
            Self::Millisecond => "ms",
            Self::Count => "counts",
            Self::CountPerNewton => "counts/N",
            Self::Piece | Self::Ratio => "",
        }
    }

    /// Words for it that a person may type, in small letters.
    const fn words(self) -> &'static [&'static str] {
        match self {
            Self::Ohm => &["ω", "ohm", "ohms", "r"],
            Self::Volt => &["v", "volt"],
            Self::Ampere => &["a", "amp", "ampere"],
            Self::Celsius => &["°c", "c", "celsius"],
            Self::Kelvin => &["k", "kelvin"],
            Self::Millisecond => &["ms"],
            Self::Count => &["counts"],
            Self::CountPerNewton => &["counts/n"],
            Self::Piece | Self::Ratio => &[],
        }
    }

    const fn example(self) -> &'static str {
        match self {
            Self::Ohm => "4.68 kohm",
            Self::Volt => "3.31 V",
            Self::Ampere => "0.95 A",
            Self::Celsius => "24.3 C",
            _ => "1.2",
        }
    }

    /// Whether small and large values are printed with a prefix.
    const fn has_prefixes(self) -> bool {
        matches!(self, Self::Ohm | Self::Volt | Self::Ampere)
    }

    /// Reads a typed value: a number, and behind it its unit with a prefix. Without a unit the number is in the unit itself.
    /// An open circuit is `open`.
    ///
    /// # Errors
    /// It is no number, or has another unit.
    pub fn parse(self, typed: &str) -> Result<f64, TypedValueError> {
        let typed = typed.trim();
        if self == Self::Ohm && ["open", "ol", "inf"].contains(&typed.to_lowercase().as_str()) {
            return Ok(f64::INFINITY);
        }
        let end = typed
            .find(|c: char| !(c.is_ascii_digit() || "+-.,".contains(c)))
            .unwrap_or(typed.len());
        let (number, unit) = typed.split_at(end);
        let number: f64 = number.replace(',', ".").parse().map_err(|_| {
            TypedValueError::NoNumber { typed: typed.into(), example: self.example() }
        })?;
        let unit = unit.trim();
        match self.factor(unit) {
            Some(factor) => Ok(number * factor),
            None => Err(TypedValueError::OtherUnit {
                typed: typed.into(),
                found: unit.into(),
                needed: self,
                example: self.example(),
            }),
        }
    }

    /// The factor of a typed unit; `None` if it is another one.
    fn factor(self, typed: &str) -> Option<f64> {
        let is_unit = |word: &str| {
            let word = word.trim().to_lowercase();
            self.words().contains(&word.as_str())
        };
        if typed.is_empty() || is_unit(typed) {
            return Some(1.0);
        }
        let prefix = typed.chars().next()?;
        let (_, factor) = PREFIXES.iter().find(|(known, _)| *known == prefix)?;
        let rest = &typed[prefix.len_utf8()..];
        (self.has_prefixes() && (rest.is_empty() || is_unit(rest))).then_some(*factor)
    }

    /// A value as text with its unit, to four digits.
    pub fn text(self, value: f64) -> String {
        if value.is_infinite() && self == Self::Ohm {
            return "open".into();
        }
        let (scaled, prefix) = self.scaled(value);
        let decimals = match scaled.abs() {
            _ if self == Self::Piece => 0,
            size if size >= 1000.0 => 0,
            size if size >= 100.0 => 1,
            size if size >= 10.0 => 2,
            _ => 3,
        };
        let mut number = format!("{scaled:.decimals$}");
        if number.contains('.') {
            number.truncate(number.trim_end_matches('0').trim_end_matches('.').len());
        }
        if number == "-0" {
            number = "0".into();
        }
        format!("{number} {prefix}{}", self.symbol()).trim_end().into()
    }

    fn scaled(self, value: f64) -> (f64, &'static str) {
        if !self.has_prefixes() {
            return (value, "");
        }
        match value.abs() {
            size if size >= 1e9 => (value / 1e9, "G"),
            size if size >= 1e6 => (value / 1e6, "M"),
            size if size >= 1e3 => (value / 1e3, "k"),
            size if size < 1.0 && size > 0.0 => (value * 1e3, "m"),
            _ => (value, ""),
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_typed_value_may_have_its_unit_and_a_prefix() {
        for (typed, ohm) in [
            ("4700", 4700.0),
            ("4.7k", 4700.0),
            ("4,7 kOhm", 4700.0),
            ("4.7 kΩ", 4700.0),
            ("0.3 ohm", 0.3),
            ("1.2 M", 1.2e6),
            ("open", f64::INFINITY),
            ("OL", f64::INFINITY),
        ] {
            assert_eq!(Unit::Ohm.parse(typed), Ok(ohm), "{typed}");
        }
        assert_eq!(Unit::Volt.parse("250 mV"), Ok(0.25));
        assert_eq!(Unit::Celsius.parse("24.3 °C"), Ok(24.3));
        assert_eq!(Unit::Celsius.parse("24.3"), Ok(24.3));
    }

    #[test]
    fn another_unit_or_no_number_is_refused_with_an_example() {
        let other = Unit::Volt.parse("4.7 kohm").unwrap_err().to_string();
        assert_eq!(other, "'4.7 kohm' has the unit 'kohm'; needed is V, such as '3.31 V'");
        let none = Unit::Ohm.parse("about 5").unwrap_err().to_string();
        assert_eq!(none, "'about 5' is no number; type one with its unit, such as '4.68 kohm'");
        for (unit, typed) in [
            (Unit::Ohm, ""),
            (Unit::Ohm, "1..2"),
            (Unit::Celsius, "24 k"),
            (Unit::Volt, "open"),
            (Unit::Ampere, "1 mV"),
        ] {
            assert!(unit.parse(typed).is_err(), "{typed}");
        }
    }

    #[test]
    fn values_are_printed_with_four_digits_and_a_prefix() {
        for (unit, value, text) in [
            (Unit::Ohm, 4700.0, "4.7 kΩ"),
            (Unit::Ohm, f64::INFINITY, "open"),
            (Unit::Ohm, 0.012, "12 mΩ"),
            (Unit::Volt, 12.0, "12 V"),
            (Unit::Volt, 0.0, "0 V"),
            (Unit::Count, 2048.25, "2048 counts"),
            (Unit::Celsius, -0.0001, "0 °C"),
            (Unit::Piece, 3.0, "3"),
        ] {
            assert_eq!(unit.text(value), text);
        }
    }
}
