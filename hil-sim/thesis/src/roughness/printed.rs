//! Numbers as an instrument prints them, and the last digit to which a column is printed.

/// A finite number of a file, and its digits.
#[derive(Clone, Copy)]
pub(super) struct Printed {
    pub(super) value: f64,
    /// Power of ten of the last digit.
    last: i32,
    /// Number of digits from the first one that is not 0.
    significant: i32,
}

impl Printed {
    /// Reads a cell; none if it is not a finite number.
    pub(super) fn parse(cell: &str) -> Option<Self> {
        let value = cell.parse().ok().filter(|value: &f64| value.is_finite())?;
        let (mantissa, exponent) = cell.split_once(['e', 'E']).unwrap_or((cell, "0"));
        // The exponent of a finite number overflows for zero only.
        let exponent: i32 = exponent.parse().unwrap_or(0);
        let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let digits = mantissa.chars().filter(char::is_ascii_digit);
        let significant = digits.skip_while(|digit| *digit == '0').count();
        let last = exponent.saturating_sub(decimals as i32);
        Some(Self { value, last, significant: significant as i32 })
    }
}

/// Unit of the last digit of each number of a column.
///
/// An instrument prints a fixed number of decimals or of significant digits, and may omit zeros at the end. The finest unit
/// of the column and its largest number of significant digits therefore hold for every number, whichever is coarser. A unit
/// is at least the resolution of an `f64`.
pub(super) fn units(column: &[Printed]) -> Vec<f64> {
    let finest = column.iter().map(|number| number.last).min().unwrap_or(0);
    let most = column.iter().map(|number| number.significant).max().unwrap_or(0);
    let unit = |number: &Printed| {
        let by_significant_digits = number.last.saturating_add(number.significant - most);
        let power = match number.significant {
            0 => finest,
            _ => finest.max(by_significant_digits),
        };
        10_f64.powi(power).max(f64::EPSILON * number.value.abs())
    };
    column.iter().map(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_that_of_the_columns_decimals_or_significant_digits() {
        for (column, expected) in [
            // Fixed decimals, with and without zeros at the end.
            (["0.000", "0.010", "10.020"], [1e-3, 1e-3, 1e-3]),
            (["0", "0.01", "10.025"], [1e-3, 1e-3, 1e-3]),
            // Three significant digits; zeros at the end omitted.
            (["1.56e-07", "3.1e-07", "1.25E-06"], [1e-9, 1e-9, 1e-8]),
            (["-0.0156", "+.2", "3."], [1e-4, 1e-3, 1e-2]),
            (["2e-07", "1e-06", "1.1e-06"], [1e-7, 1e-7, 1e-7]),
            (["0e-99999999999", "20", "3"], [1.0, 1.0, 1.0]),
        ] {
            let printed = column.map(|cell| Printed::parse(cell).expect("a number"));
            for (unit, expected) in units(&printed).into_iter().zip(expected) {
                assert!((unit / expected - 1.0).abs() < 1e-12, "{column:?}: {unit:e}");
            }
        }
    }

    #[test]
    fn a_unit_is_at_least_the_resolution_of_f64() {
        let printed = ["1.00000000000000000000", "0.5"].map(|cell| Printed::parse(cell).unwrap());
        assert_eq!(units(&printed), [f64::EPSILON, 0.5 * f64::EPSILON]);
    }

    #[test]
    fn other_text_is_not_a_finite_number() {
        for cell in ["", "high", "nan", "inf", "1e400", "1,5"] {
            assert!(Printed::parse(cell).is_none(), "{cell}");
        }
    }
}
