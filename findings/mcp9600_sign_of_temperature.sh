#!/bin/sh
# Guess: a driver of the thermocouple amplifier MCP9600 takes the sign of a temperature from the top of its two's complement register,
# sixteenths of a degree.
#
# Seen, with the crate mcp9600 0.1.1, rustc 1.95.0, and the package mcp9600 0.0.4 on Python 3.11:
# - The crate takes it from the lowest bit of the upper byte, the one worth 16 K, and the wrong way round. 20 C and 50 C are right,
#   skin at 33 C reads -4063 C, 10 C reads -4086 C, and -1 C reads 4095 C.
# - The package drops the three upper bits of the cold junction, which repeat its sign: -1 C reads 511 C. Its hot junction is right.
#
# Compare a reading with the range of the sensor before it is used.
#
# The drivers read registers from memory here; the bytes are those of the datasheet's format.
#
# Fails if one of the temperatures is read otherwise.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cat > "$folder/Cargo.toml" <<'TOML'
[package]
name = "sign"
version = "0.0.0"
edition = "2024"

[dependencies]
embedded-hal = "=0.2.7"
mcp9600 = "=0.1.1"
TOML
cat > "$folder/src/main.rs" <<'RUST'
use embedded_hal::blocking::i2c::{Write, WriteRead};
use mcp9600::{DeviceAddr, MCP9600};
use std::convert::Infallible;

/// A device whose registers all hold this temperature in sixteenths of a degree.
struct Registers(i16);

impl Write for Registers {
    type Error = Infallible;

    fn write(&mut self, _: u8, _: &[u8]) -> Result<(), Infallible> {
        Ok(())
    }
}

impl WriteRead for Registers {
    type Error = Infallible;

    fn write_read(&mut self, _: u8, _: &[u8], read: &mut [u8]) -> Result<(), Infallible> {
        read.copy_from_slice(&self.0.to_be_bytes());
        Ok(())
    }
}

fn main() {
    for (celsius, expected) in [(-1, 4095.0), (10, -4086.0), (20, 20.0), (33, -4063.0), (50, 50.0)] {
        let mut driver = MCP9600::new(Registers(16 * celsius), DeviceAddr::AD0).expect("infallible");
        let seen = driver.read_hot_junction().expect("infallible");
        println!("crate, hot junction at {celsius} C: {seen} C");
        assert_eq!(seen, expected, "CHANGED");
    }
}
RUST
cd "$folder"
cargo run --quiet
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check mcp9600==0.0.4 i2cdevice==1.0.0
"$folder/env/bin/python" - <<'PYTHON'
from mcp9600 import MCP9600

CHIP_ID = 0x20


class Bus:
    """A device whose registers, except for the one that identifies it, hold one temperature in sixteenths of a degree."""

    def __init__(self, celsius):
        self.bytes = list((16 * celsius).to_bytes(2, "big", signed=True))

    def read_i2c_block_data(self, address, register, length):
        return [0x40, 0x10] if register == CHIP_ID else self.bytes[:length]


for celsius, expected in ((-1, (-1.0, 511.0)), (10, (10.0, 10.0)), (33, (33.0, 33.0))):
    driver = MCP9600(i2c_dev=Bus(celsius))
    seen = (driver.get_hot_junction_temperature(), driver.get_cold_junction_temperature())
    print(f"package, both junctions at {celsius} C: hot {seen[0]} C, cold {seen[1]} C")
    assert seen == expected, "CHANGED"
PYTHON
