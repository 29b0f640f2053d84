#![doc = include_str!("../README.md")]

mod cli;

use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;

use cli::{
    Failure, commission, display, erfcx, faults, fidelity, five_fingers, infrared, model, object,
    parameters, play, roughness, run, serve, thesis, tracking,
};
#[cfg(feature = "emulator")]
use cli::{embedded_tests, profile};

/// Simulated plant and emulated microcontroller of the thermal display.
#[derive(Parser)]
#[command(name = "hil-sim", version, max_term_width = 100)]
enum Cli {
    /// Run a scene
    Run(run::Arguments),
    /// Play a course of temperature from a CSV file under a finger
    Play(play::Arguments),
    /// What earlier displays would have shown of an object, on the device and on an ideal tile
    Display(display::Arguments),
    /// Be a device on a serial line or a TCP port, for other programs
    Serve(serve::Arguments),
    /// Measure how soon a client of a served device is told of a landing, in real time
    #[cfg(unix)]
    ServeLatency(serve::latency::Arguments),
    /// Calibrate and tune a simulated device as an operator does, and print its settings as lines
    Commission(commission::Arguments),
    /// Run five scenes side by side, on the five fingers of one device
    Hand(five_fingers::Arguments),
    /// Run a scene on the image; say which functions a control tick spends its time in
    #[cfg(feature = "emulator")]
    Profile(profile::Arguments),
    /// Run the tests of an image on an emulated board without wiring; `cargo xtask on-target --emulated` calls it
    #[cfg(feature = "emulator")]
    EmbeddedTests(embedded_tests::Arguments),
    /// Evaluate the contact model (Eq. 6-5 to 6-12) and print CSV
    Model(model::Arguments),
    /// Evaluate the fixed-point kernel: one z a line on standard input, prints z and the bits of E
    Erfcx,
    /// Print the lines that describe the object of a scene to a device
    Object(object::Arguments),
    /// What the thesis's infrared camera shows of a target, and the way back (Eq. 5-3 and 5-4), as CSV
    Infrared(infrared::Arguments),
    /// Roughness, slopes and spacing of a measured profile (Appendix A), as CSV
    Roughness(roughness::Arguments),
    /// The plant's parameters with their tolerances and sources, or a draw of them, as CSV
    Parameters(parameters::Arguments),
    /// How close the skin on the display comes to the skin on the real material, law by law
    Fidelity(fidelity::Arguments),
    /// How closely the display follows steps, ramps, pulses and a recorded course, and how fast the tile is
    Tracking(tracking::Arguments),
    /// The fault-injection matrix: every single fault, at moments of many scenes
    Faults(faults::Arguments),
    /// Recompute the thesis's tables and model figures and lay them beside what it states
    Thesis(thesis::Arguments),
}

fn main() -> ExitCode {
    let began = Instant::now();
    let done = match Cli::parse() {
        Cli::Run(arguments) => run::run(&arguments, began),
        Cli::Play(arguments) => play::run(&arguments, began),
        Cli::Display(arguments) => display::run(&arguments),
        Cli::Serve(arguments) => serve::run(&arguments),
        #[cfg(unix)]
        Cli::ServeLatency(arguments) => serve::latency::run(&arguments),
        Cli::Commission(arguments) => commission::run(&arguments),
        Cli::Hand(arguments) => five_fingers::run(&arguments, began),
        #[cfg(feature = "emulator")]
        Cli::Profile(arguments) => profile::run(&arguments),
        #[cfg(feature = "emulator")]
        Cli::EmbeddedTests(arguments) => embedded_tests::run(&arguments),
        Cli::Model(arguments) => model::run(&arguments),
        Cli::Erfcx => erfcx::run(),
        Cli::Object(arguments) => object::run(&arguments),
        Cli::Infrared(arguments) => infrared::run(&arguments),
        Cli::Roughness(arguments) => roughness::run(&arguments),
        Cli::Parameters(arguments) => parameters::run(&arguments),
        Cli::Fidelity(arguments) => fidelity::run(&arguments),
        Cli::Tracking(arguments) => tracking::run(&arguments),
        Cli::Faults(arguments) => faults::run(&arguments),
        Cli::Thesis(arguments) => thesis::run(&arguments),
    };
    Failure::exit_code("hil-sim", done)
}
