//! Numbers as SPICE writes them.

/// Scale suffixes, the longer ones first. Letters after the suffix are a unit and are ignored.
const SUFFIXES: [(&str, f64); 9] = [
    ("meg", 1e6),
    ("t", 1e12),
    ("g", 1e9),
    ("k", 1e3),
    ("m", 1e-3),
    ("u", 1e-6),
    ("n", 1e-9),
    ("p", 1e-12),
    ("f", 1e-15),
];

/// Value of a number such as `4.7k`, `100n`, `2.2meg` or `-1e-3`; `None` if it is no number.
pub fn parse(text: &str) -> Option<f64> {
    let text = text.trim().to_ascii_lowercase();
    // The longest beginning that is a number; the rest is suffix and unit.
    let end = (1..=text.len())
        .rev()
        .filter(|&end| text.is_char_boundary(end))
        .find(|&end| text[..end].parse::<f64>().is_ok())?;
    let (number, rest) = text.split_at(end);
    if !rest.chars().all(|c| c.is_ascii_alphabetic()) {
        return None;
    }
    let scale = SUFFIXES
        .iter()
        .find(|(suffix, _)| rest.starts_with(suffix))
        .map_or(1.0, |(_, scale)| *scale);
    number.parse::<f64>().ok().map(|number| number * scale).filter(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn scale_suffixes_are_those_of_spice() {
        for (text, expected) in [
            ("10k", 10e3),
            ("4.7u", 4.7e-6),
            ("2.2meg", 2.2e6),
            ("1M", 1e-3),
            ("100nF", 100e-9),
            ("-3.5m", -3.5e-3),
            ("1.5e-3", 1.5e-3),
            ("3", 3.0),
        ] {
            let value = parse(text).unwrap_or(f64::NAN);
            assert!((value / expected - 1.0).abs() < 1e-12, "{text}: {value}");
        }
    }

    #[test]
    fn other_text_is_no_number() {
        for text in ["", "k", "{r_in}", "4k7", "1 2", "nan", "inf"] {
            assert_eq!(parse(text), None, "{text}");
        }
    }
}
