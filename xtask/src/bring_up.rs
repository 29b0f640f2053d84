//! `cargo xtask bring-up`: starts `thermal-lab bring-up`, and for an emulated board `hil-sim serve` beside it.

use std::ffi::OsString;

use anyhow::{Context, Result, bail};
use clap::Args;

use crate::firmware::{self, Fingers};
use crate::process::{Background, Invocation};
use crate::setup::{self, Needs, Permission};

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Unattended, with the release image on an emulated board; without it a person is led, and --port or --tcp says where
    #[arg(long)]
    emulated: bool,
    /// The emulated board has this error of assembly
    #[arg(long, value_name = "NAME", requires = "emulated")]
    broken: Option<String>,
    /// Draw the emulated board's parts from their tolerances
    #[arg(long, value_name = "SEED", requires = "emulated")]
    draw: Option<u64>,
    /// Print the names for --broken, one a line
    #[arg(long, exclusive = true)]
    list_broken: bool,
    /// Print one JSON object: passed, findings
    #[arg(long)]
    json: bool,
    /// Options of `thermal-lab bring-up`: --port, --from, --out and others, see its --help
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    rest: Vec<OsString>,
}

/// What `hil-sim serve` prints before the addresses.
const LISTENING: &str = "listening on ";
const SURROUNDINGS: &str = "surroundings on ";

pub fn run(permission: Permission, options: Options) -> Result<()> {
    let lab = |first: &[&str]| Invocation::run_package("thermal-lab", first.iter().copied());
    if options.list_broken {
        return lab(&["bring-up", "--list-broken"]).run();
    }
    let mut line = lab(&["bring-up"]);
    if options.json {
        line = line.args(["--json"]);
    }
    if !options.emulated {
        return line.args(options.rest).run();
    }
    let toolchain = setup::prepare(Needs::EMULATOR, permission)?;
    firmware::build(&toolchain, Fingers::One)?;
    let image = firmware::elf(&toolchain, Fingers::One).into_os_string();
    Invocation::cargo(["build", "--release", "-p", "hil-sim", "-p", "thermal-lab"])
        .run_to_stderr()?;
    let board = options.broken.unwrap_or_else(|| "sound".into());
    let mut serve = Invocation::run_package("hil-sim", ["serve", "--engine", "image"])
        .args(["--elf".into(), image.clone()])
        .args(["--speed", "max", "--tcp", "127.0.0.1:0"])
        .args(["--surroundings", "127.0.0.1:0", "--board", &board]);
    if let Some(seed) = options.draw {
        serve = serve.args(["--draw".into(), seed.to_string()]);
    }
    let mut server = Background::start(&serve)?;
    let device = address(&mut server, LISTENING)?;
    let surroundings = address(&mut server, SURROUNDINGS)?;
    let chooses_folder =
        options.rest.iter().any(|word| word.to_string_lossy().starts_with("--out"));
    if !chooses_folder {
        // Nothing that was measured.
        line = line.args(["--force", "--out", "target/bring-up"]);
    }
    line.args(["--tcp", &device, "--surroundings", &surroundings])
        .args(["--image".into(), image])
        .args(options.rest)
        .run()
}

/// The address in the next line of the server.
fn address(server: &mut Background, before: &str) -> Result<String> {
    let line = server.line().context("hil-sim serve has ended")?;
    match line.strip_prefix(before) {
        Some(address) => Ok(address.into()),
        None => bail!("hil-sim serve printed '{line}'; expected '{before}…'"),
    }
}
