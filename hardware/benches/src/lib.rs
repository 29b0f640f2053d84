#![doc = include_str!("../README.md")]

pub mod benches;
pub mod measure;
pub mod netlist;
pub mod ngspice;
pub mod number;
pub mod picture;
pub mod quantity;
pub mod schematic;
