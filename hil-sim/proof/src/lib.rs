//! Static analysis of the release image's machine code: which functions can panic, how deep the stack can grow, which
//! loops the control path has, and that it has no floating-point arithmetic.
//!
//! Every function of the image is decoded along all its paths ([`flow`]); the functions form a call graph ([`graph`]).
//! Code that cannot be analysed is a violation: an unknown change of the stack pointer, a return with another stack
//! pointer than at entry, a jump into constants or into the middle of another function.
//!
//! The checks are [`panics`], [`stack`], [`loops`] and [`float`]; [`allowed`] lists the exemptions with their reasons.
//! [`measure`] adds figures that are measured in the emulator.

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
