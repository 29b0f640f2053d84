//! `hil-sim profile`: instructions and cycles of a control tick by function.

use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;

use addr2line::Loader;
use anyhow::{Context, anyhow};
use clap::Args;
use stm32_emulator::{ExecutedBlock, OneFingerBoard};
use thermal_sim::run::run as run_scene;

use super::{Failure, engine, image, output};

#[derive(Args)]
pub struct Arguments {
    /// The scene, TOML
    scene: PathBuf,
    /// Image to run instead of the one of the current sources; it must have its symbols
    #[arg(long)]
    elf: Option<PathBuf>,
}

/// Functions with fewer cycles in the mean and in the longest tick are shown together.
const SMALL: u64 = 20;

/// Instructions and cycles of all ticks, and of the longest.
#[derive(Clone, Copy, Default)]
struct FunctionCost {
    all: (u64, u64),
    longest: (u64, u64),
}

/// Runs the scene and prints a line for each function.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (scene, world) = engine::scene(&arguments.scene)?;
    let (firmware, path) = image::firmware(arguments.elf.as_deref(), 1)?;
    let symbols = Loader::new(&path)
        .map_err(|error| Failure::input(anyhow!("{}: {error}", path.display())))?;
    let mut engine = OneFingerBoard::new(&firmware, world).map_err(Failure::run)?;
    engine.watch_tick();
    run_scene(&scene, &mut engine, |_| ()).map_err(Failure::run)?;
    let machine = engine.machine();
    let watched = machine.path().context("the image ran no tick").map_err(Failure::run)?;
    let mut shares = BTreeMap::<String, FunctionCost>::new();
    let mut names = HashMap::new();
    let mut charge = |block: ExecutedBlock, add: &dyn Fn(&mut FunctionCost, u64)| {
        for (address, cycles) in machine.instructions(block) {
            let name = names.entry(address).or_insert_with(|| owner(&symbols, address));
            add(shares.entry(name.clone()).or_default(), u64::from(cycles));
        }
    };
    for (&block, &times) in &watched.all {
        charge(block, &|share, cycles| {
            share.all.0 += times;
            share.all.1 += times * cycles;
        });
    }
    for &block in &watched.worst {
        charge(block, &|share, cycles| {
            share.longest.0 += 1;
            share.longest.1 += cycles;
        });
    }
    output::print(&table(shares, watched.activations))
}

/// The function of the firmware or of the contact model that an instruction belongs to, including code inlined from other
/// libraries; otherwise the function of the library.
fn owner(symbols: &Loader, address: u32) -> String {
    let mut innermost = None;
    if let Ok(mut frames) = symbols.find_frames(u64::from(address)) {
        while let Ok(Some(frame)) = frames.next() {
            let Some(name) = frame.function.as_ref().and_then(|function| function.raw_name().ok())
            else {
                continue;
            };
            let name = format!("{:#}", rustc_demangle::demangle(&name));
            if name.contains("thermal_") || name.contains("contact_model::") {
                return name;
            }
            innermost.get_or_insert(name);
        }
    }
    innermost.unwrap_or_else(|| symbols.find_symbol(u64::from(address)).unwrap_or("?").into())
}

fn table(shares: BTreeMap<String, FunctionCost>, ticks: u64) -> String {
    let mut rows: Vec<_> = shares.into_iter().collect();
    rows.sort_by_key(|(_, share)| {
        std::cmp::Reverse(share.longest.1.max(share.all.1 / ticks.max(1)))
    });
    let mut text = format!(
        "{:>12}{:>12}{:>14}{:>14}  function, with what is compiled into it\n{:>12}{:>12}{:>14}{:>14}  ({ticks} ticks; cycles are estimated)\n",
        "instructions",
        "cycles",
        "instructions",
        "cycles",
        "mean",
        "mean",
        "longest tick",
        "longest tick"
    );
    let mut sum = FunctionCost::default();
    let mut line = |share: &FunctionCost, name: &str| {
        let mean = |total: u64| total as f64 / ticks as f64;
        text += &format!(
            "{:>12.1}{:>12.1}{:>14}{:>14}  {name}\n",
            mean(share.all.0),
            mean(share.all.1),
            share.longest.0,
            share.longest.1
        );
    };
    let mut rest = FunctionCost::default();
    for (name, share) in &rows {
        if share.longest.1 < SMALL && share.all.1 < SMALL * ticks {
            rest.all = (rest.all.0 + share.all.0, rest.all.1 + share.all.1);
            rest.longest = (rest.longest.0 + share.longest.0, rest.longest.1 + share.longest.1);
        } else {
            line(share, name);
        }
        sum.all = (sum.all.0 + share.all.0, sum.all.1 + share.all.1);
        sum.longest = (sum.longest.0 + share.longest.0, sum.longest.1 + share.longest.1);
    }
    line(&rest, "others");
    line(&sum, "all, without the interrupt's entry and return");
    text
}
