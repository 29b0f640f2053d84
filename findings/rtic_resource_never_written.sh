#!/bin/sh
# Guess: a resource of RTIC holds what `init` returned for it when the first task runs.
#
# Seen, with rtic 2.4.0, cortex-m-rt 0.7.7 and rustc 1.95.0 (LLVM 22): not always, if the only value that the program ever gives it is
# a constant address. RTIC keeps the resource in the section .uninit, which neither the loader nor the start-up code fills. LLVM
# makes the one stored value the initial value of the variable, removes the store, and replaces reads by the constant. A read whose
# address it cannot fold stays (here: the position in a round-robin over an array of one reference), and reads memory that nothing has
# written. At opt-level 0 the address is there; at "s" and 3 it is not, and nothing warns.
#
# As long as the optimiser folds every read, such a program works, so that a change elsewhere can break it. One reference to a
# whole array, `&'static [T; N]`, has no such position to compute.
#
# The programs run in Unicorn 2.1.4 from reset until they idle, in RAM filled with 0xa5, then the task until it reads the resource.
# The target thumbv7em-none-eabihf is added to rustup and stays there.
#
# Fails if the task reads something else.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
rustup --quiet target add thumbv7em-none-eabihf
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check unicorn==2.1.4 pyelftools==0.33
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "one-channel"
version = "0.0.0"
edition = "2024"

[dependencies]
cortex-m-rt = "=0.7.7"
lm3s6965 = "=0.2.0"
rtic = { version = "=2.4.0", features = ["thumbv7-backend"] }
TOML
cat > memory.x <<'LD'
MEMORY
{
  FLASH : ORIGIN = 0x00000000, LENGTH = 256K
  RAM : ORIGIN = 0x20000000, LENGTH = 64K
}
LD
cat > src/main.rs <<'RUST'
#![no_std]
#![no_main]

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}

pub struct Channel(pub AtomicU32);

#[unsafe(no_mangle)]
static CHANNEL: Channel = Channel(AtomicU32::new(7));
#[unsafe(no_mangle)]
static STEPS: AtomicU32 = AtomicU32::new(3);

#[rtic::app(device = lm3s6965)]
mod app {
    use super::{CHANNEL, Channel, Relaxed, STEPS};

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        channels: [&'static Channel; 1],
    }

    #[init]
    fn init(_: init::Context) -> (Shared, Local) {
        (Shared {}, Local { channels: [&CHANNEL] })
    }

    #[idle]
    fn idle(_: idle::Context) -> ! {
        loop {
            STEPS.fetch_add(1, Relaxed);
        }
    }

    /// Serves the channels in turn.
    #[task(binds = GPIOA, local = [channels])]
    fn serve(cx: serve::Context) {
        let steps = STEPS.load(Relaxed) as usize;
        for channel in cx.local.channels.iter().cycle().take(steps) {
            channel.0.fetch_add(1, Relaxed);
        }
    }
}
RUST
cat > state.py <<'PYTHON'
"""Runs the program from reset until it idles, then the task until it reads the resource; says what the resource holds then."""

import struct
import sys

from elftools.elf.elffile import ELFFile
from unicorn import UC_ARCH_ARM, UC_HOOK_MEM_READ, UC_MODE_MCLASS, UC_MODE_THUMB, Uc
from unicorn.arm_const import UC_ARM_REG_SP

_, level, path = sys.argv
elf = ELFFile(open(path, "rb"))
symbols = {symbol.name: symbol["st_value"] for symbol in elf.get_section_by_name(".symtab").iter_symbols()}
resource = next(address for name, address in symbols.items() if "rtic_internal_local_resource_channels" in name)
uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
uc.mem_map(0, 0x40000)
uc.mem_map(0x20000000, 0x10000)
uc.mem_map(0xE0000000, 0x100000)
uc.mem_write(0x20000000, b"\xa5" * 0x10000)
for segment in elf.iter_segments("PT_LOAD"):
    if segment["p_filesz"]:
        uc.mem_write(segment["p_paddr"], segment.data())


def word(address):
    return struct.unpack("<I", uc.mem_read(address, 4))[0]


uc.reg_write(UC_ARM_REG_SP, word(0))
uc.emu_start(word(4) | 1, 0, count=100_000)
assert word(symbols["STEPS"]) > 1000, "the program does not idle"
reads = []


def on_read(uc, access, address, size, value, data):
    reads.append(word(address))
    uc.emu_stop()


uc.hook_add(UC_HOOK_MEM_READ, on_read, begin=resource, end=resource + 3)
uc.emu_start(symbols["GPIOA"] | 1, 0, count=1000)
print(f"opt-level {level}: the task reads {reads[0]:#010x}, the channel is at {symbols['CHANNEL']:#010x}")
assert reads == [symbols["CHANNEL"] if level == "0" else 0xA5A5A5A5], "CHANGED"
PYTHON
export RUSTFLAGS="-C link-arg=-Tlink.x -L $folder"
for level in '0' '"s"' '3'; do
    cargo build --quiet --release --target thumbv7em-none-eabihf --config "profile.release.opt-level=$level"
    env/bin/python state.py "$level" target/thumbv7em-none-eabihf/release/one-channel
done
