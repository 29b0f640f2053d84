#![doc = include_str!("../README.md")]

mod case;
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
mod statement;
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
        (2, "Thermal sensation"),
        (3, "Thermal cues in discrimination and localization"),
        (4, "Thermal display"),
        (5, "Infrared thermal measurement"),
        (6, "Contact resistance"),
    ]
    .map(|(number, title)| Chapter {
        number,
        title,
        rows: statement::rows(number),
    })
    .into()
}
