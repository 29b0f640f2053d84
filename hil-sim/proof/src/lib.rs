//! What can be shown of the release image from its machine code, whatever the sources say: from where it can panic,
//! how deep its stack can grow, what its control path loops on, and that it calculates with integers there.
//!
//! The whole image is decoded, function by function, along all ways through each ([`flow`]), and put together by its
//! calls ([`graph`]). What cannot be followed is a violation, not a gap: an unknown change of the stack pointer, a
//! return with another stack than at entry, a jump into constants or into the middle of another function.
//!
//! The checks are [`panics`], [`stack`], [`loops`] and [`float`]; what they let pass, with reasons, is in [`allowed`].
//! [`measure`] sets the emulated machine's figures beside them.

pub mod allowed;
pub mod compiler;
pub mod float;
pub mod flow;
pub mod graph;
pub mod image;
pub mod levels;
pub mod location;
pub mod loops;
pub mod measure;
pub mod names;
pub mod panics;
mod proof;
mod scenes;
pub mod stack;
pub mod thumb;

pub use proof::{Proof, Section};
