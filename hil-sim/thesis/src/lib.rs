#![doc = include_str!("../README.md")]

mod case;
mod chapter2;
mod chapter3;
mod chapter4;
mod chapter5;
mod chapter6;
pub mod figure;
mod json;
mod page;
mod root;
pub mod roughness;
pub mod row;
mod sensitivity;
mod stated;
mod table;
mod volumes;

pub use case::{Case, ClosedForm, Source, Surfaces};
pub use json::{Json, json};
pub use page::{CSV, HTML, write};
pub use sensitivity::d_prime;
pub use stated::Stated;
pub use table::{Counts, table};
pub use volumes::FiniteVolumes;

use row::Row;

/// The rows of one chapter.
#[derive(Clone, Debug, PartialEq)]
pub struct Chapter {
    /// Its number.
    pub number: u8,
    /// What it is about.
    pub title: &'static str,
    /// Its numbers, in the order of the thesis.
    pub rows: Vec<Row>,
}

/// Every number of the thesis that a program can recompute.
#[must_use]
pub fn chapters() -> Vec<Chapter> {
    [
        (2, "Thermal sensation", chapter2::rows as fn() -> Vec<Row>),
        (
            3,
            "Thermal cues in discrimination and localization",
            chapter3::rows,
        ),
        (4, "Thermal display", chapter4::rows),
        (5, "Infrared thermal measurement", chapter5::rows),
        (6, "Contact resistance", chapter6::rows),
    ]
    .map(|(number, title, rows)| Chapter {
        number,
        title,
        rows: rows(),
    })
    .into()
}
