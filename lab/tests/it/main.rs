//! Lines to real and simulated devices, and the person at the bench.

mod bench_operator;
mod command;
mod contact;
mod enrol;
mod program;
mod serial_port;
mod simulated_device;
mod tcp;
