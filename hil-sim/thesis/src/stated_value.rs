//! Values stated in the thesis, and whether a computed value agrees.

use std::fmt;

use serde::Deserialize;

/// Tolerance for the binary representation of an exact half, in units of the last printed digit.
const HALF_SLACK: f64 = 1e-9;

/// A value stated in the thesis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "String")]
pub enum Stated {
    /// A printed number with its decimals; negative if trailing zeros before the point are not significant
    /// (-1: tens).
    Printed {
        /// The number.
        value: f64,
        /// Digits after the point.
        decimals: i32,
    },
    /// An approximate number ("about", "around", "steady").
    About {
        /// The number.
        value: f64,
        /// Tolerance with which the words are interpreted.
        within: f64,
    },
    /// A range, limits included.
    Between {
        /// Least value.
        low: f64,
        /// Largest value.
        high: f64,
    },
    /// Less than this.
    Below(f64),
    /// More than this.
    Above(f64),
    /// Damaged characters that are not a number.
    Garbled(String),
}

/// `value` truncated after a number of decimals, as in the thesis's tables of contact coefficients.
pub(super) fn cut(value: f64, decimals: i32) -> f64 {
    let unit = 10f64.powi(-decimals);
    (value / unit).trunc() * unit
}

impl Stated {
    /// Whether `computed` agrees. A printed number agrees with all values that round to it; an exact half
    /// may be rounded either way.
    pub fn agrees(&self, computed: f64) -> bool {
        match *self {
            Self::Printed { value, decimals } => {
                let unit = 10f64.powi(-decimals);
                (computed - value).abs() <= (0.5 + HALF_SLACK) * unit
            }
            Self::About { value, within } => (computed - value).abs() <= within,
            Self::Between { low, high } => (low..=high).contains(&computed),
            Self::Below(limit) => computed < limit,
            Self::Above(limit) => computed > limit,
            Self::Garbled(_) => false,
        }
    }

    /// Whether the printed number is `computed` truncated to the printed digits.
    pub fn is_cut(&self, computed: f64) -> bool {
        match *self {
            Self::Printed { decimals, .. } => self.agrees(cut(computed, decimals)),
            _ => false,
        }
    }

    /// `computed` minus the stated number or the nearest limit; none if no number is stated.
    pub fn difference(&self, computed: f64) -> Option<f64> {
        match *self {
            Self::Printed { value, .. } | Self::About { value, .. } => Some(computed - value),
            Self::Between { low, high } => Some(computed - computed.clamp(low, high)),
            Self::Below(limit) | Self::Above(limit) => Some(computed - limit),
            Self::Garbled(_) => None,
        }
    }

    /// Decimals with which a computed value is printed beside it.
    pub(super) fn decimals_for_computed(&self) -> usize {
        let digits =
            |value: f64| usize::from(value.abs() < 10.0) + 2 * usize::from(value.abs() < 0.1);
        match *self {
            Self::Printed { decimals, .. } => usize::try_from(decimals + 2).unwrap_or(0).min(6),
            Self::About { value, .. } | Self::Below(value) | Self::Above(value) => {
                2 + digits(value)
            }
            Self::Between { high, .. } => 2 + digits(high),
            Self::Garbled(_) => 2,
        }
    }
}

impl TryFrom<String> for Stated {
    type Error = String;

    /// Reads what is displayed, but for zeros that are not digits: of "24e1" the last digit stands for tens.
    fn try_from(text: String) -> Result<Self, String> {
        let wrong = || format!("{text:?} is no number");
        let number = |text: &str| text.trim().parse().map_err(|_| wrong());
        let quoted = text.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
        Ok(if let Some(text) = quoted {
            Self::Garbled(text.into())
        } else if let Some(limit) = text.strip_prefix('<') {
            Self::Below(number(limit)?)
        } else if let Some(limit) = text.strip_prefix('>') {
            Self::Above(number(limit)?)
        } else if let Some((low, high)) = text.split_once(" to ") {
            let (low, high) = (number(low)?, number(high)?);
            Self::Between { low, high }
        } else if let Some((value, within)) = text.split_once('±') {
            let (value, within) = (number(value)?, number(within)?);
            Self::About { value, within }
        } else {
            let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
            let power: i32 = power.parse().map_err(|_| wrong())?;
            let fraction = digits.split_once('.').map_or("", |(_, fraction)| fraction);
            let value = number(&text)?;
            Self::Printed { value, decimals: fraction.len() as i32 - power }
        })
    }
}

impl fmt::Display for Stated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Printed { value, decimals } => {
                write!(f, "{value:.*}", usize::try_from(decimals).unwrap_or(0))
            }
            Self::About { value, within } => write!(f, "{value} ± {within}"),
            Self::Between { low, high } => write!(f, "{low} to {high}"),
            Self::Below(limit) => write!(f, "< {limit}"),
            Self::Above(limit) => write!(f, "> {limit}"),
            Self::Garbled(ref text) => write!(f, "\"{text}\""),
        }
    }
}
