//! Lines to real and simulated devices, and the person at the bench.

mod contact;
mod enrol;
mod person;
mod program;
mod simulated_device;
mod tcp;
