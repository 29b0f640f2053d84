//! Boards around the machine: a NUCLEO-F446RE with one finger, and one with five on multiplexers; their engines.

mod five_fingers;
mod meter;
mod one_finger;

pub use five_fingers::ImageHand;
pub use one_finger::{Image, StartError};
