//! Comparison of a measured number with the documented one.

use std::fmt;

use crate::{Demand, Figure, HEADROOM};

/// What comes of a comparison.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The documentation is right.
    Holds,
    /// It is not, and this is why.
    Differs(String),
}

impl Figure {
    /// Whether it was recorded with a compiler, by the name that an ELF file has of it, or depends on none.
    pub fn holds_for(&self, compiler: &str) -> bool {
        let name = compiler.replace(" version ", " ");
        let recorded = self.recorded_with.as_deref().unwrap_or_default();
        name.strip_prefix(recorded)
            .is_some_and(|rest| recorded.is_empty() || rest.is_empty() || rest.starts_with(' '))
    }

    /// A line that says what was measured beside what is documented.
    pub(crate) fn print(&self, measured: f64) {
        println!("{}: measured {measured:?} {}, {self}", self.key, self.unit);
    }

    /// What is wrong with a measured number that is not within what is demanded.
    pub(crate) fn beyond(&self, measured: f64) -> Option<&'static str> {
        match self.demand {
            _ if measured.is_nan() => Some("is no number"),
            Demand::AtMost(bound) | Demand::Between(_, bound) if measured > bound.get() => {
                Some("is too large")
            }
            Demand::AtLeast(least) | Demand::Between(least, _) if measured < least.get() => {
                Some("is too small")
            }
            Demand::Exactly if measured != self.value() => Some("is another number"),
            _ => None,
        }
    }

    /// Compares a measured number.
    pub fn judge(&self, measured: f64) -> Verdict {
        let value = self.value();
        // What leaves its bound far from its value varies.
        let tight = self.why.is_none();
        let problem = match (self.beyond(measured), &self.demand) {
            (Some(problem), _) => problem,
            (_, Demand::AtMost(_)) if tight && measured * HEADROOM < value => {
                "is smaller: state less"
            }
            (_, Demand::AtLeast(_)) if tight && measured > value * HEADROOM => {
                "is larger: state more"
            }
            _ => return Verdict::Holds,
        };
        let Self { key, unit, .. } = self;
        Verdict::Differs(format!("{key}: {measured:?} {unit} {problem}; {self}"))
    }
}

/// What the documentation states, and what is demanded.
impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "documented {}, ", self.shown())?;
        match &self.demand {
            Demand::AtMost(bound) => write!(f, "at most {bound}"),
            Demand::AtLeast(bound) => write!(f, "at least {bound}"),
            Demand::Between(least, bound) => write!(f, "{least} to {bound}"),
            Demand::Exactly => write!(f, "exactly"),
            Demand::Recorded(commit) => write!(f, "recorded at {commit}"),
        }?;
        match &self.recorded_with {
            Some(compiler) => write!(f, " with {compiler}"),
            None => Ok(()),
        }
    }
}
