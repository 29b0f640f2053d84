//! Tests of the contact model through its public interface, as one program.

mod arbitrary_bits;
mod budgets;
mod chord_interpolation;
mod fit;
mod golden;
mod kernel;
mod limits;
mod physical_laws;
mod reference;
mod set_up;
mod tables;
mod verify;
