//! The client against a scripted device, in virtual time.

mod answers;
mod clock;
mod fake_device;
mod telemetry;
