//! Simulated plant and emulated microcontroller for the thermal display.
pub mod machine;
