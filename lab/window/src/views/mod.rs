//! What the windows show, drawn into any user interface of egui, with a display or without.

mod force;
mod keys;
mod operator;
mod participant;
mod plots;
mod session_panel;
mod theme;

pub use keys::pressed;
pub use operator::{OperatorState, operator};
pub use participant::participant;
pub use theme::{apply, participant_style};
