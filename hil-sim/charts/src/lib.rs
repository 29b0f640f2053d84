#![doc = include_str!("../README.md")]

mod page;
mod panel;

pub use page::{document, escape, svg_element, write};
pub use panel::{Area, Curve, Legend, Panel, Stroke};
