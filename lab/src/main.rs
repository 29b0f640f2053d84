//! The command `thermal-lab`.

mod cli;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use cli::{
    Failure, Target, analyse, bring_up, commission, contact, enrol, info, log, monitor,
    participants, play, ports, predict, replay, run, send,
};

/// The operator's side of a thermal display.
#[derive(Parser)]
#[command(name = "thermal-lab", version, max_term_width = 100)]
struct Cli {
    #[command(flatten)]
    target: Target,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// List the serial ports of this computer
    Ports(ports::Arguments),
    /// Say what the device is, its state, and what it measured of itself
    Info(info::Arguments),
    /// Send lines to the device and print its answers
    Send(send::Arguments),
    /// Play a course of temperature from a CSV file on the armed device
    Play(play::Arguments),
    /// Write telemetry as CSV, until Ctrl-C or for some time
    Log(log::Arguments),
    /// Watch a device: temperatures, force, current, state; with a stop
    Monitor(monitor::Arguments),
    /// Run the session of an experiment with a participant, or with a simulated one
    Run(run::Arguments),
    /// Score a data set, and write a page, JSON and CSV
    Analyse(analyse::Arguments),
    /// Give a participant of a data set another code
    Rename(participants::Rename),
    /// Leave the data of a participant out of the analyses, and record why
    Exclude(participants::Exclude),
    /// Print what simulated participants give for the experiments of the thesis, beside what was published
    Predict(predict::Arguments),
    /// Show a recorded session once more
    Replay(replay::Arguments),
    /// Calibrate and tune a new device, step by step, and store the result
    Commission(commission::Arguments),
    /// Measure the contact law of a person's finger with the heat-flux sensor
    Contact(contact::Arguments),
    /// Learn a person's finger with the heat-flux sensor, and store it by a code
    Enrol(enrol::Arguments),
    /// Bring up a board, from the bare board to sign-off
    BringUp(bring_up::Arguments),
}

fn main() -> ExitCode {
    let Cli { target, command } = Cli::parse();
    let done = match command {
        Command::Ports(arguments) => ports::run(&arguments),
        Command::Info(arguments) => info::run(&target, &arguments),
        Command::Send(arguments) => send::run(&target, &arguments),
        Command::Play(arguments) => play::run(&target, &arguments),
        Command::Log(arguments) => log::run(&target, &arguments),
        Command::Monitor(arguments) => monitor::run(&target, &arguments),
        Command::Run(arguments) => run::run(&target, &arguments),
        Command::Analyse(arguments) => analyse::run(&arguments),
        Command::Rename(arguments) => participants::run_rename(&arguments),
        Command::Exclude(arguments) => participants::run_exclude(&arguments),
        Command::Predict(arguments) => predict::run(&arguments),
        Command::Replay(arguments) => replay::run(&arguments),
        Command::Commission(arguments) => commission::run(&target, &arguments),
        Command::Contact(arguments) => contact::run(&target, &arguments),
        Command::Enrol(arguments) => enrol::run(&target, &arguments),
        Command::BringUp(arguments) => bring_up::run(&target, &arguments),
    };
    Failure::exit_code("thermal-lab", done)
}
