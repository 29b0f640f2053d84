//! The numbers stated in the thesis, read from `data/statements.csv`, in the order of the thesis.

use std::sync::LazyLock;

use anyhow::Context;
use contact_model::material::Material;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::contact_case::{material, tabulated_effusivity};
use super::row::{Correction, Remark, Row};
use super::stated_value::Stated;
use super::{chapter3, chapter4, chapter5, chapter6, experiments};

/// A line of the file.
#[derive(Deserialize)]
pub(super) struct Statement {
    chapter: u8,
    /// Table, figure, equation or section.
    pub place: String,
    /// Material of the number, or two with a slash between them; empty if the quantity names it.
    pub of: String,
    /// Name of the quantity, in which `{}` is replaced by `given`.
    pub quantity: String,
    /// Input number of the computation, as it is printed in the report.
    given: String,
    /// Empty for a dimensionless number.
    unit: String,
    stated: Stated,
    remark: Option<Kind>,
    why: String,
    /// What the thesis should say.
    reads: Option<Stated>,
    /// The quantity whose value the stated number actually is.
    is: String,
}

/// Kind of a [`Remark`].
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    Note,
    Cut,
    Damaged,
    Wrong,
}

pub(super) static STATEMENTS: LazyLock<Vec<Statement>> = LazyLock::new(|| {
    read("statements.csv", include_str!("../data/statements.csv")).expect("a table of the program")
});

/// What the thesis states on its experiments.
pub(super) static EXPERIMENTS: LazyLock<Vec<Statement>> = LazyLock::new(|| {
    let text = include_str!("../data/experiments.csv");
    read("experiments.csv", text).expect("a table of the program")
});

/// The lines of a table.
///
/// # Errors
/// A line cannot be read as `T`; the error names file, line and column.
pub(super) fn read<T: DeserializeOwned>(file: &'static str, text: &str) -> anyhow::Result<Vec<T>> {
    let rows = csv::Reader::from_reader(text.as_bytes()).into_deserialize();
    rows.collect::<Result<_, _>>().context(file)
}

/// The rows of a chapter in a table of statements.
pub(super) fn rows(statements: &'static [Statement], chapter: u8) -> Vec<Row> {
    let statements = statements.iter().filter(|row| row.chapter == chapter);
    statements.map(Statement::row).collect()
}

impl Statement {
    /// Material of the statement.
    pub(super) fn material(&self) -> Material {
        material(&self.of)
    }

    /// Input number of the computation.
    pub(super) fn given(&self) -> f64 {
        let given = self.given.parse();
        given.unwrap_or_else(|_| panic!("{self}: given is no number"))
    }

    fn row(&'static self) -> Row {
        let correction = || match &self.reads {
            Some(stated) => Correction::Reads(stated.clone()),
            None => Correction::Is(self.computed(&self.is)),
        };
        let why = || self.why.clone();
        let quantity = self.quantity.replace("{}", &self.given);
        Row {
            place: &self.place,
            quantity: match self.of.as_str() {
                "" => quantity,
                of => format!("{of}, {quantity}"),
            },
            unit: &self.unit,
            stated: self.stated.clone(),
            computed: self.computed(&self.quantity),
            remark: self.remark.map(|kind| match kind {
                Kind::Note => Remark::Note(why()),
                Kind::Cut => Remark::Cut,
                Kind::Damaged => Remark::Damaged(why(), correction()),
                Kind::Wrong => Remark::Wrong(why(), correction()),
            }),
        }
    }

    /// A quantity under the conditions of the statement's chapter.
    fn computed(&self, quantity: &str) -> f64 {
        let of_chapter = match self.chapter {
            3 => chapter3::compute(self, quantity),
            4 => chapter4::compute(self, quantity),
            5 => chapter5::compute(self, quantity),
            6 => chapter6::compute(self, quantity),
            _ => None,
        };
        of_chapter
            .or_else(|| experiments::compute(self, quantity))
            .unwrap_or_else(|| self.in_any_chapter(quantity))
    }

    /// Properties of a material, and quantities that several chapters state.
    fn in_any_chapter(&self, quantity: &str) -> f64 {
        let ellipse = |a: f64, b: f64| std::f64::consts::PI * a * b;
        let material = || self.material();
        match quantity {
            "conductivity" => material().surface.conductivity_w_mk,
            // In 1e-7 m²/s.
            "diffusivity" => material().diffusivity_m2_s() * 1e7,
            "density" => material().density_kg_m3,
            "specific heat" => material().specific_heat_j_kgk,
            "contact coefficient" => material().effusivity(),
            "contact coefficient, cut" => tabulated_effusivity(&material()),
            "Rq" => material().surface.roughness_um,
            "asperity slope" => material().surface.slope_rad,
            "ellipse with axes of {} and 10 mm" => ellipse(self.given() / 2.0, 10.0 / 2.0),
            "ellipse with semi-axes of {} and 10 mm" => ellipse(self.given(), 10.0),
            other => panic!("{self}: nothing computes {other:?}"),
        }
    }
}

impl std::fmt::Display for Statement {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { place, of, .. } = self;
        write!(f, "{place}, {of}, {}", self.quantity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_statement_is_computed() {
        for (statements, count) in [(&STATEMENTS, 293), (&EXPERIMENTS, 74)] {
            let rows = statements.iter().map(Statement::row);
            assert_eq!(rows.filter(|row| row.computed.is_finite()).count(), count);
        }
    }

    #[test]
    fn a_bad_line_is_named_with_its_file() {
        let text = include_str!("../data/statements.csv").replacen(",8954,", ",8 954,", 1);
        let error = read::<Statement>("statements.csv", &text).map(|_| ());
        let error = format!("{:#}", error.expect_err("no number"));
        assert_eq!(
            error,
            "statements.csv: CSV deserialize error: record 4 (line: 5, byte: 212): \"8 954\" is no number"
        );
    }
}
