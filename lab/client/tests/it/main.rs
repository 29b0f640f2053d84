//! The client against a scripted device, in virtual time.

mod answers;
mod clock;
mod course;
mod fake_device;
mod telemetry;
