#![doc = include_str!("../README.md")]

mod chapter3;
mod chapter4;
mod chapter5;
mod chapter6;
mod contact_case;
mod experiments;
pub mod figure;
mod finite_volumes;
mod json;
pub mod measured;
mod page;
pub mod published;
pub mod roughness;
pub mod row;
mod stated_value;
mod statement;
mod table;

pub use contact_case::{Case, ClosedForm, ContactSolver, Surfaces};
pub use finite_volumes::FiniteVolumes;
pub use json::{Json, json};
pub use measured::measurements;
pub use page::{CSV, HTML, write};
pub use stated_value::Stated;
pub use table::{Counts, table};

use row::Row;
use statement::{EXPERIMENTS, STATEMENTS, Statement};

/// The rows of one chapter.
#[derive(Clone, Debug, PartialEq)]
pub struct Chapter {
    /// Number of the chapter.
    pub number: u8,
    /// Title of the chapter.
    pub title: &'static str,
    /// Recomputed numbers in the order of the thesis.
    pub rows: Vec<Row>,
}

/// All numbers of the thesis that can be recomputed: first tables, model and instruments, then the experiments.
pub fn chapters() -> Vec<Chapter> {
    let of = |statements: &'static [Statement], chapters: &[(u8, &'static str)]| -> Vec<_> {
        let chapter = |&(number, title): &(u8, &'static str)| Chapter {
            number,
            title,
            rows: statement::rows(statements, number),
        };
        chapters.iter().map(chapter).collect()
    };
    let mut chapters = of(
        &STATEMENTS,
        &[
            (2, "Thermal sensation"),
            (3, "Thermal cues in discrimination and localization"),
            (4, "Thermal display"),
            (5, "Infrared thermal measurement"),
            (6, "Contact resistance"),
        ],
    );
    chapters.extend(of(
        &EXPERIMENTS,
        &[(2, "Thickness of the skin"), (3, "Experiments"), (4, "Experiments"), (6, "Experiments")],
    ));
    chapters
}
