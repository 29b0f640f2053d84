//! `cargo xtask`: set-up, build, demo, tests and measurements of the thermal display.
//!
//! Headings and the output of tools go to standard error, results to standard output. Exit status 1 is a failure or a missing
//! tool, 2 a wrong command line.
mod auxiliary_image;
mod bench;
mod bring_up;
mod demo;
mod docs;
mod firmware;
mod fuzz;
mod hardware;
mod lab;
mod memory_usage;
mod mutations;
mod on_target;
mod process;
mod program_digest;
mod proof;
mod report;
mod setup;
mod soak;
mod step;
mod suite;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use process::Invocation;
use setup::{Choice, Permission};

/// Set-up, build, demo, test and benchmark of the thermal display.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Build the image and run it in the emulator: a finger lands on "copper"
    Demo(SetUp),
    /// Run the test suite: formatting, lints, documentation and its figures, units, fuzzers, the image on the simulated plant
    Test {
        #[command(flatten)]
        set_up: SetUp,
        /// Only what takes less than a minute: formatting, documented figures, lints and units of the small packages, the native device
        #[arg(long)]
        quick: bool,
    },
    /// Run long jobs (campaigns, fuzzing, mutations, every input of the kernel) and print a table of their results
    Soak {
        #[command(flatten)]
        set_up: SetUp,
        /// Run the job of this name only, may be repeated
        #[arg(long, value_name = "NAME")]
        only: Vec<String>,
        /// Print names and commands of the jobs and run nothing
        #[arg(long)]
        list: bool,
    },
    /// Build the image exactly as it is flashed; print its path, flash and RAM use
    Firmware {
        #[command(flatten)]
        set_up: SetUp,
        /// Number of fingers
        #[arg(long, value_enum, default_value_t)]
        fingers: firmware::Fingers,
        /// Print the path of the ELF file on standard output and nothing else there
        #[arg(long)]
        print_path: bool,
    },
    /// Print and plot run time against error of the contact model and alternatives, or of the simulated plant or of both engines; writes to
    /// target/bench unless --out names a folder
    Bench {
        #[command(flatten)]
        set_up: SetUp,
        /// What to measure
        #[arg(value_enum, default_value = "model")]
        job: bench::Job,
        #[command(flatten)]
        report: report::Options,
    },
    /// Print how close the skin on the display comes to the skin on the real material, law by law
    Fidelity {
        #[command(flatten)]
        set_up: SetUp,
        #[command(flatten)]
        report: report::Options,
        /// Options of `hil-sim fidelity`: --scenario, --law, --box and others, see its --help
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        rest: Vec<OsString>,
    },
    /// Inject every single fault into the emulated microcontroller and the plant; print the device's response
    Faults {
        #[command(flatten)]
        set_up: SetUp,
        #[command(flatten)]
        report: report::Options,
        /// Disable each fault detector in turn in a copy of the sources; the fault matrix must reveal it; takes an hour. With
        /// names, only detectors whose name contains one
        #[arg(long, exclusive = true, num_args = 0.., value_name = "NAME")]
        mutations: Option<Vec<String>>,
        /// Options of `hil-sim faults`: --only, --scene, --moments and others, see its --help
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        rest: Vec<OsString>,
    },
    /// Simulate the circuits of hardware/ with ngspice and compare them with what the firmware assumes
    Hardware {
        #[command(flatten)]
        set_up: SetUp,
        /// Print one JSON object instead of the tables
        #[arg(long)]
        json: bool,
        /// Options of `hardware-benches`: --only, --out and --schematic, see its --help
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        rest: Vec<OsString>,
    },
    /// Bring up a board, step by step, from the bare board to sign-off; --emulated does it unattended on an emulated one
    BringUp {
        #[command(flatten)]
        set_up: SetUp,
        #[command(flatten)]
        options: bring_up::Options,
    },
    /// Run an experiment on a simulated device with a simulated participant, and analyse it; writes to target/lab
    Lab,
    /// Run the tests that run on the microcontroller itself, on a bare board by its probe; writes what they measure to
    /// docs/on-target.md. --emulated runs them on the emulated one
    OnTarget {
        #[command(flatten)]
        set_up: SetUp,
        #[command(flatten)]
        options: on_target::Options,
    },
    /// Check the image's machine code (panics, stack, loops, floating point) and measure its ticks in the emulator
    Proof {
        #[command(flatten)]
        set_up: SetUp,
        /// Number of fingers
        #[arg(long, value_enum, default_value_t)]
        fingers: firmware::Fingers,
        /// Leave out the measurements in the emulator
        #[arg(long)]
        code_only: bool,
    },
    /// Fuzz every interface that takes external bytes, text or samples, guided by coverage
    Fuzz {
        #[command(flatten)]
        set_up: SetUp,
        #[command(flatten)]
        options: fuzz::Options,
    },
    /// Write the figures of docs/figures.toml into the pages; fail at results in prose that no test asserts and no commit dates
    Docs {
        /// Write nothing; fail if a document differs, or if no test asserts a figure
        #[arg(long)]
        check: bool,
    },
    /// Write tables of the code, such as that of materials, into documents, the package for Python and dictionaries of fuzzers
    Tables {
        /// Write nothing; fail if a file differs
        #[arg(long)]
        check: bool,
    },
    /// Build the image that the benchmark runs in the emulator and print its path; called by the benchmark
    BenchImage(SetUp),
    /// Build the image for the emulator's own tests and print its path; called by those tests
    Probe(SetUp),
    /// Build a program of others for the emulator's own tests and print its folder; called by those tests
    Foreign {
        #[command(flatten)]
        set_up: SetUp,
        /// All such programs, which takes minutes
        #[arg(long)]
        all: bool,
    },
}

#[derive(Args, Clone, Copy)]
struct SetUp {
    /// Install missing system packages (as root) without asking; implied where CI is set
    #[arg(long, short)]
    yes: bool,
    /// The compiler for the microcontroller
    #[arg(long, value_enum, default_value_t, env = setup::CHOICE_VARIABLE)]
    toolchain: Choice,
}

impl SetUp {
    fn permission(self) -> Permission {
        Permission { yes: self.yes || setup::in_ci(), choice: self.toolchain }
    }
}

/// Runs the program that has the tables. In the suite's profile, whose tests need the same packages.
fn tables(check: bool) -> anyhow::Result<()> {
    let line =
        ["run", "--profile", process::SUITE, "--quiet", "--package", "generated-tables", "--"];
    Invocation::cargo(line).args(check.then_some("--check")).run()
}

fn main() -> ExitCode {
    if let Some(status) = fuzz::compile_if_called_as_compiler() {
        return status;
    }
    let result = match Cli::parse().command {
        Task::Demo(set_up) => demo::run(set_up.permission()),
        Task::Test { set_up, quick } => suite::run(set_up.permission(), quick),
        Task::Soak { list: true, .. } => {
            soak::list();
            Ok(())
        }
        Task::Soak { set_up, only, .. } => soak::run(set_up.permission(), &only),
        Task::Firmware { set_up, fingers, print_path } => {
            firmware::run(set_up.permission(), fingers, print_path)
        }
        Task::Bench { set_up, job, report } => bench::run(set_up.permission(), job, report),
        Task::Fidelity { set_up, report, rest } => report::run(
            set_up.permission(),
            Invocation::run_package("hil-sim", ["fidelity"]),
            report,
            rest,
        ),
        Task::Faults { mutations: Some(names), .. } => mutations::run(&names),
        Task::Faults { set_up, report, rest, .. } => report::run(
            set_up.permission(),
            Invocation::run_package("hil-sim", ["faults"]),
            report,
            rest,
        ),
        Task::Hardware { set_up, json, rest } => hardware::run(set_up.permission(), json, rest),
        Task::BringUp { set_up, options } => bring_up::run(set_up.permission(), options),
        Task::Lab => lab::run(),
        Task::OnTarget { set_up, options } => on_target::run(set_up.permission(), &options),
        Task::Proof { set_up, fingers, code_only } => {
            proof::run(set_up.permission(), fingers, code_only)
        }
        Task::Fuzz { set_up, options } => fuzz::run(set_up.permission(), &options),
        Task::Docs { check } => docs::run(check),
        Task::Tables { check } => tables(check),
        Task::BenchImage(set_up) => auxiliary_image::benchmark(set_up.permission()),
        Task::Probe(set_up) => auxiliary_image::probe(set_up.permission()),
        Task::Foreign { set_up, all } => auxiliary_image::foreign(set_up.permission(), all),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("\nerror: {error:#}");
            ExitCode::FAILURE
        }
    }
}
