//! Instructions and cycles on the emulated microcontroller.
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, bail, ensure};
use hil_sim::machine::{FLASH_BASE, Firmware, Machine, Stats, Wiring};
use model_bench::job::{Checksum, Job};
use model_bench::kernels::{Call, KERNELS, ONLY_RETURN};
use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};
use serde::Serialize;

/// Cycles after which a job is given up: far more than any needs.
const LIMIT: u64 = 20_000_000_000;
/// Cycles between two looks at whether a job is done.
const STRIDE: u64 = 10_000_000;
/// Words of the image's `DONE`.
const RUNNING: u32 = 0;
/// See [`RUNNING`].
const DONE_WELL: u32 = 1;

/// Where the module of the firmware's kernel keeps its tables, as the image's symbols name it.
const KERNEL_MODULE: &str = "contact_model::fixed_point::kernel";

/// Instructions (exact) and cycles (estimated) of a call, call and return included, over all inputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Fewest instructions.
    pub instructions_min: u64,
    /// Mean instructions.
    pub instructions_mean: f64,
    /// Most instructions.
    pub instructions_max: u64,
    /// Fewest cycles.
    pub cycles_min: u64,
    /// Mean cycles.
    pub cycles_mean: f64,
    /// Most cycles.
    pub cycles_max: u64,
}

/// Port C with the job's number; nothing else is connected.
struct Pins(u32);

impl Wiring for Pins {
    fn adc(&mut self, _: u8, _: u64) -> u16 {
        0
    }

    fn pin(&self, port: u8, bit: u8) -> Option<bool> {
        (port == 2).then_some(self.0 >> bit & 1 != 0)
    }

    fn uart_tx(&mut self, _: u8, _: u64, _: u32) {}
}

/// The image and what a call costs in it without the callee's work.
pub struct Emulated {
    firmware: Firmware,
    kernel_table_bytes: usize,
    compiler: String,
    /// Of the types of [`Call`] in their order, then of scenes.
    overheads: Vec<Overhead>,
}

/// What the handler that makes a call costs beyond the call.
#[derive(Clone, Copy)]
struct Overhead {
    instructions: u64,
    cycles: u64,
}

impl Emulated {
    /// Builds the image of the current sources and measures empty calls.
    ///
    /// # Errors
    /// It cannot be built or does not run.
    pub fn new() -> anyhow::Result<Self> {
        let path = build()?;
        let elf = std::fs::read(&path).with_context(|| path.display().to_string())?;
        let firmware = Firmware::from_elf(&elf).with_context(|| path.display().to_string())?;
        let mut new = Self {
            kernel_table_bytes: table_bytes(&elf)?,
            compiler: compiler(&elf)?,
            firmware,
            overheads: Vec::new(),
        };
        let mut pins = Vec::new();
        for place in 0..3 {
            let index = KERNELS.iter().position(|kernel| type_of(kernel.call) == place);
            pins.push(Job::kernel_pins(index.context("no kernel of a type")?));
        }
        pins.push(Job::scene_pins(0));
        for (pins, name) in pins.into_iter().zip(ONLY_RETURN) {
            let (whole, _) = new.run(Job::only_return(pins))?;
            ensure!(
                whole.instructions_min == whole.instructions_max && whole.cycles_min == whole.cycles_max,
                "calls of {name} do not all cost the same: {whole:?}"
            );
            let (instructions, cycles) = new.call_and_return(name)?;
            new.overheads.push(Overhead {
                instructions: whole.instructions_max - instructions,
                cycles: whole.cycles_max - cycles,
            });
        }
        Ok(new)
    }

    /// Bytes of static data of the firmware's kernel in the image.
    pub fn kernel_table_bytes(&self) -> usize {
        self.kernel_table_bytes
    }

    /// What compiled the image.
    pub fn compiler(&self) -> &str {
        &self.compiler
    }

    /// Cost of the kernel of that place, and the checksum of what it returned.
    ///
    /// # Errors
    /// The run stopped.
    pub fn kernel(&self, index: usize) -> anyhow::Result<(Cost, Checksum)> {
        self.net(Job::kernel_pins(index), type_of(KERNELS[index].call))
    }

    /// Cost of a tick of the scene of that place, and the checksum of the set-points.
    ///
    /// # Errors
    /// The run stopped.
    pub fn scene(&self, index: usize) -> anyhow::Result<(Cost, Checksum)> {
        self.net(Job::scene_pins(index), 3)
    }

    fn net(&self, pins: u32, overhead: usize) -> anyhow::Result<(Cost, Checksum)> {
        let (whole, checksum) = self.run(pins)?;
        let Overhead { instructions, cycles } = self.overheads[overhead];
        let cost = Cost {
            instructions_min: whole.instructions_min - instructions,
            instructions_mean: whole.instructions_mean - instructions as f64,
            instructions_max: whole.instructions_max - instructions,
            cycles_min: whole.cycles_min - cycles,
            cycles_mean: whole.cycles_mean - cycles as f64,
            cycles_max: whole.cycles_max - cycles,
        };
        Ok((cost, checksum))
    }

    /// Cost of the handler's activations in a job.
    fn run(&self, pins: u32) -> anyhow::Result<(Cost, Checksum)> {
        let mut machine = Machine::new(&self.firmware, Pins(pins))?;
        let word = |machine: &Machine<Pins>, name: &str, index: u32| {
            let address = self.firmware.symbol(name)?;
            let bytes = machine.memory(address + 4 * index, 4)?;
            Some(u32::from_le_bytes(bytes.try_into().ok()?))
        };
        let read = |machine: &Machine<Pins>, name: &str, index| {
            word(machine, name, index).with_context(|| format!("the image has no {name}"))
        };
        // The first look comes after the start-up code has cleared the RAM.
        loop {
            machine.run_until(machine.now() + STRIDE)?;
            match read(&machine, "DONE", 0)? {
                RUNNING if machine.now() < LIMIT => {}
                DONE_WELL => break,
                state => bail!(
                    "job {pins:#x} of the image ended in state {state} after {} cycles",
                    machine.now()
                ),
            }
        }
        let low = read(&machine, "CHECKSUM", 0)?;
        let high = read(&machine, "CHECKSUM", 1)?;
        let cost = cost_of_handler(&machine.stats()).context("the image made no calls")?;
        Ok((cost, Checksum(u64::from(high) << 32 | u64::from(low))))
    }

    /// Instructions and cycles of calling and returning from a function that only returns, by its code: with or
    /// without a frame. Cycles as the machine estimates them.
    fn call_and_return(&self, name: &str) -> anyhow::Result<(u64, u64)> {
        let address = self
            .firmware
            .symbol(name)
            .with_context(|| format!("the image has no {name}"))?
            & !1;
        let start = (address - FLASH_BASE) as usize;
        let halves: Vec<u16> = self.firmware.flash()[start..start + 8]
            .chunks_exact(2)
            .map(|half| u16::from_le_bytes([half[0], half[1]]))
            .collect();
        const BLX: (u64, u64) = (1, 3);
        let (instructions, cycles) = match halves[..] {
            // push {r7, lr}; mov r7, sp; pop {r7, pc}
            [0xb580, 0x466f, 0xbd80, _] => (3, 3 + 1 + 5),
            // the same with movs r0, #0 within
            [0xb580, 0x466f, 0x2000, 0xbd80] => (4, 3 + 1 + 1 + 5),
            // bx lr
            [0x4770, ..] => (1, 3),
            _ => bail!("{name} does more than return: {halves:04x?}"),
        };
        Ok((BLX.0 + instructions, BLX.1 + cycles))
    }
}

/// Place among [`Emulated::overheads`].
fn type_of(call: Call) -> usize {
    match call {
        Call::Fixed(_) => 0,
        Call::Single(_) => 1,
        Call::Double(_) => 2,
    }
}

fn cost_of_handler(stats: &Stats) -> Option<Cost> {
    let handler = stats.interrupts.iter().find(|handler| handler.name == "PendSV")?;
    Some(Cost {
        instructions_min: handler.instructions_min,
        instructions_mean: handler.instructions_mean,
        instructions_max: handler.instructions_max,
        cycles_min: handler.cycles_min,
        cycles_mean: handler.cycles_mean,
        cycles_max: handler.cycles_max,
    })
}

/// Bytes of the data of the kernel's module.
fn table_bytes(elf: &[u8]) -> anyhow::Result<usize> {
    let file = object::File::parse(elf)?;
    let sizes = file
        .symbols()
        .filter(|symbol| symbol.kind() == SymbolKind::Data)
        .filter(|symbol| {
            symbol
                .name()
                .is_ok_and(|name| format!("{:#}", rustc_demangle::demangle(name)).starts_with(KERNEL_MODULE))
        })
        .map(|symbol| symbol.size() as usize);
    Ok(sizes.sum())
}

/// Name and version of the compiler, as it leaves them in the image.
fn compiler(elf: &[u8]) -> anyhow::Result<String> {
    let file = object::File::parse(elf)?;
    let section = file
        .section_by_name(".comment")
        .context("the image names no compiler")?;
    let comments = String::from_utf8_lossy(section.data()?);
    let name = comments.split('\0').find(|comment| comment.starts_with("rustc"));
    Ok(name.context("the image was not compiled by rustc")?.into())
}

/// Builds the image; cargo decides what is stale.
fn build() -> anyhow::Result<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .context("the benchmark has no workspace")?;
    let built = Command::new("cargo")
        .args(["xtask", "bench-image"])
        .current_dir(root)
        .stderr(Stdio::inherit())
        .output()
        .context("cargo cannot be started to build the image")?;
    ensure!(
        built.status.success(),
        "the image could not be built: `cargo xtask bench-image` ended with {}",
        built.status
    );
    Ok(PathBuf::from(String::from_utf8_lossy(&built.stdout).trim()))
}
