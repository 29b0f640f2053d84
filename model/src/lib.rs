#![doc = include_str!("../README.md")]
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod contact_law;
pub mod decimal;
pub mod finger;
pub mod fixed_point;
pub mod impedance;
pub mod material;
pub mod pressure;
pub mod reference;
pub mod slab;
