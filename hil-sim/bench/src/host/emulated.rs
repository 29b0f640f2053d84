//! Instructions and cycles on the emulated microcontroller.
use anyhow::{Context, bail, ensure};
use model_bench::job::{Checksum, Job};
use model_bench::kernels::{Call, KERNELS, ONLY_RETURN};
use serde::Serialize;
use stm32_emulator::{FLASH_BASE, Firmware, Machine, Stats, Wiring};

use super::image::{Image, build};

/// Time limit of a job, cycles; far more than any job needs.
const LIMIT: u64 = 20_000_000_000;
/// Cycles between two checks whether a job is done.
const STRIDE: u64 = 10_000_000;
/// Values of the image's `DONE`.
const RUNNING: u32 = 0;
/// Value of the image's `DONE` after success.
const DONE_WELL: u32 = 1;

/// Symbol in which the image reports its progress.
const DONE: &str = "image::DONE";
/// Symbol in which the image reports the checksum.
const CHECKSUM: &str = "image::CHECKSUM";

/// Prefix of the paths of the firmware's kernel and its tables.
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

/// Port C, whose levels select the job; nothing else is connected.
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

/// The image, and the overhead of a call in it.
pub struct Emulated {
    firmware: Firmware,
    image: Image,
    /// Overheads for the types of [`Call`] in their order, then for scenes.
    overheads: Vec<Overhead>,
}

/// Cost of the handler that makes a call, without the call.
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
            image: Image::new(&elf).with_context(|| path.display().to_string())?,
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
                whole.instructions_min == whole.instructions_max
                    && whole.cycles_min == whole.cycles_max,
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
        self.image.data_bytes(KERNEL_MODULE)
    }

    /// Compiler of the image.
    pub fn compiler(&self) -> &str {
        self.image.compiler()
    }

    /// Cost of a kernel by its index, and the checksum of its results.
    ///
    /// # Errors
    /// The run stopped.
    pub fn kernel(&self, index: usize) -> anyhow::Result<(Cost, Checksum)> {
        self.net(Job::kernel_pins(index), type_of(KERNELS[index].call))
    }

    /// Cost of a tick of a scene by its index, and the checksum of the set-points.
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
        let (done, checksum) = (self.image.address(DONE)?, self.image.address(CHECKSUM)?);
        let word = |machine: &Machine<Pins>, address: u32| {
            let bytes = machine.memory(address, 4).and_then(|bytes| bytes.try_into().ok());
            bytes
                .map(u32::from_le_bytes)
                .with_context(|| format!("the machine has no memory at {address:#x}"))
        };
        // The first check comes after the start-up code has cleared the RAM.
        loop {
            machine.run_until(machine.now() + STRIDE)?;
            match word(&machine, done)? {
                RUNNING if machine.now() < LIMIT => {}
                DONE_WELL => break,
                state => bail!(
                    "job {pins:#x} of the image ended in state {state} after {} cycles",
                    machine.now()
                ),
            }
        }
        let low = word(&machine, checksum)?;
        let high = word(&machine, checksum + 4)?;
        let cost = cost_of_handler(&machine.stats()).context("the image made no calls")?;
        Ok((cost, Checksum(u64::from(high) << 32 | u64::from(low))))
    }

    /// Instructions, and cycles as the emulator estimates them, of the call of a function that only returns; they depend
    /// on whether its code has a stack frame.
    fn call_and_return(&self, name: &str) -> anyhow::Result<(u64, u64)> {
        let address = self.image.address(name)? & !1;
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

/// Index in [`Emulated::overheads`].
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
