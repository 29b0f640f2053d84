//! One number of the thesis and its recomputation.

use std::fmt;

use super::stated_value::Stated;

/// A number of the thesis and its recomputation.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Table, figure, equation or section of the thesis.
    pub place: &'static str,
    /// Quantity and its object.
    pub quantity: String,
    /// Unit, empty for a dimensionless number.
    pub unit: &'static str,
    /// Value stated in the thesis.
    pub stated: Stated,
    /// Recomputed value.
    pub computed: f64,
    /// Remark on the stated value.
    pub remark: Option<Remark>,
}

/// Remark on a number of the thesis.
#[derive(Clone, Debug, PartialEq)]
pub enum Remark {
    /// An explanation that does not affect the verdict.
    Note(String),
    /// The column is truncated, not rounded, to the printed digits.
    Cut,
    /// The characters of the text are damaged.
    Damaged(String, Correction),
    /// The thesis is wrong or contradicts itself.
    Wrong(String, Correction),
}

/// Correction that makes the stated and the computed value agree.
#[derive(Clone, Debug, PartialEq)]
pub enum Correction {
    /// The thesis should state this value.
    Reads(Stated),
    /// The stated value is in fact this other computed value.
    Is(f64),
}

/// Result of the comparison of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The computed value agrees with the printed digits.
    Agrees,
    /// The printed digits are truncated instead of rounded.
    Cut,
    /// Computed minus stated value, if a number is stated; no correction explains the difference.
    Differs(Option<f64>),
    /// The characters are damaged, and the correction makes the values agree.
    Damaged,
    /// The thesis is wrong, and the correction makes the values agree.
    Wrong,
}

impl Row {
    /// Compares the stated and the computed value. A remark changes the verdict only if the values differ and its
    /// correction makes them agree.
    pub fn verdict(&self) -> Verdict {
        if self.stated.agrees(self.computed) {
            return Verdict::Agrees;
        }
        let holds = |correction: &Correction| match correction {
            Correction::Reads(stated) => stated.agrees(self.computed),
            Correction::Is(value) => self.stated.agrees(*value),
        };
        match &self.remark {
            Some(Remark::Cut) if self.stated.is_cut(self.computed) => Verdict::Cut,
            Some(Remark::Damaged(_, correction)) if holds(correction) => Verdict::Damaged,
            Some(Remark::Wrong(_, correction)) if holds(correction) => Verdict::Wrong,
            _ => Verdict::Differs(self.stated.difference(self.computed)),
        }
    }

    /// The computed value with two digits more than the stated one.
    pub(super) fn computed_text(&self) -> String {
        format!("{:.*}", self.stated.decimals_for_computed(), self.computed)
    }

    /// Text of the remark; empty without a remark, and if the values agree without it.
    pub(super) fn remark_text(&self) -> String {
        let corrected = |why: &str, correction: &Correction| match correction {
            Correction::Reads(stated) => format!("{why}; should read {stated}"),
            Correction::Is(value) => {
                format!("{why}; that is {value:.*}", self.stated.decimals_for_computed())
            }
        };
        match &self.remark {
            Some(Remark::Note(text)) => text.clone(),
            None | Some(Remark::Cut) => String::new(),
            Some(_) if self.verdict() == Verdict::Agrees => String::new(),
            Some(Remark::Damaged(why, correction) | Remark::Wrong(why, correction)) => {
                corrected(why, correction)
            }
        }
    }
}

impl Verdict {
    /// One word for counts, CSS classes and JSON.
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Cut => "cut",
            Self::Differs(_) => "differs",
            Self::Damaged => "damaged",
            Self::Wrong => "wrong",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Agrees => f.write_str("agrees"),
            Self::Cut => f.write_str("cut, not rounded"),
            Self::Differs(Some(by)) => write!(f, "differs by {}", three_digits(*by)),
            Self::Differs(None) => f.write_str("differs"),
            Self::Damaged => f.write_str("damaged in the text"),
            Self::Wrong => f.write_str("wrong in the thesis"),
        }
    }
}

/// A value with sign and three significant digits.
fn three_digits(value: f64) -> String {
    let magnitude = value.abs().log10().floor();
    let decimals = (2.0 - magnitude).clamp(0.0, 9.0) as usize;
    format!("{value:+.decimals$}")
}
