//! One number of the thesis beside the computed one.

use std::fmt;

use super::stated::Stated;

/// A number of the thesis, recomputed.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Table, figure, equation or section.
    pub place: &'static str,
    /// What the number is, and of what.
    pub quantity: String,
    /// Its unit, empty for a pure number.
    pub unit: &'static str,
    /// What the thesis says.
    pub stated: Stated,
    /// What the program computes.
    pub computed: f64,
    /// What is known of this number.
    pub remark: Option<Remark>,
}

/// What is known of a number of the thesis.
#[derive(Clone, Debug, PartialEq)]
pub enum Remark {
    /// How to read it; explains no difference.
    Note(String),
    /// Its column is cut, not rounded, to the digits printed.
    Cut,
    /// Its characters have suffered.
    Damaged(String, Correction),
    /// The thesis says it so, and is wrong or contradicts itself.
    Wrong(String, Correction),
}

/// What would make statement and computation agree.
#[derive(Clone, Debug, PartialEq)]
pub enum Correction {
    /// The thesis should say this.
    Reads(Stated),
    /// The thesis says this other computed value.
    Is(f64),
}

/// How a row comes out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The computed number is the stated one, as far as that is printed.
    Agrees,
    /// The same digits, cut where they should be rounded.
    Cut,
    /// Computed minus stated, if a number is stated; no explanation that holds.
    Differs(Option<f64>),
    /// Damaged characters; the correction holds.
    Damaged,
    /// A mistake of the thesis; the correction holds.
    Wrong,
}

impl Row {
    /// Lays stated and computed beside each other. A remark changes the verdict only if the numbers differ and
    /// what it says makes them agree.
    #[must_use]
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

    /// The computed number with as many digits as can be laid beside the stated one.
    pub(super) fn computed_text(&self) -> String {
        format!("{:.*}", self.stated.decimals_beside(), self.computed)
    }

    /// The remark in words; empty without one, and where nothing has to be explained.
    pub(super) fn remark_text(&self) -> String {
        let corrected = |why: &str, correction: &Correction| match correction {
            Correction::Reads(stated) => format!("{why}; should read {stated}"),
            Correction::Is(value) => {
                format!("{why}; that is {value:.*}", self.stated.decimals_beside())
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
    /// One word for counts, classes and the machine's eye.
    #[must_use]
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
            Self::Differs(Some(by)) => write!(f, "differs by {}", short(*by)),
            Self::Differs(None) => f.write_str("differs"),
            Self::Damaged => f.write_str("damaged in the text"),
            Self::Wrong => f.write_str("wrong in the thesis"),
        }
    }
}

/// Three significant digits with sign.
fn short(value: f64) -> String {
    let magnitude = value.abs().log10().floor();
    let decimals = (2.0 - magnitude).clamp(0.0, 9.0) as usize;
    format!("{value:+.decimals$}")
}
