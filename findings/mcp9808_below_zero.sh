#!/bin/sh
# Guess: the crate mcp9808 reads, and writes as a limit, a temperature below zero, the sensor having 13 bits of two's complement.
#
# Seen, with mcp9808 0.4.0 and rustc 1.95.0: neither. It reads the magnitude, with the fraction added on the wrong side: -10 C reads
# 10.0 C, -5.5 C reads 6.5 C, -0.25 C reads 1.75 C. A lower limit of -10 C is written as the register 0x1000, which is -256 C, by
# `set_celsius`, and as 0x1060, which is -250 C, by `set_milli_celsius`, so that the alert never comes. Above zero all are right.
#
# A cold plate passes zero: decode `get_raw_value`, whose upper three bits are alerts.
#
# Fails if one of the temperatures is read or written otherwise.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cat > "$folder/Cargo.toml" <<'TOML'
[package]
name = "below-zero"
version = "0.0.0"
edition = "2024"

[dependencies]
mcp9808 = "=0.4.0"
TOML
cat > "$folder/src/main.rs" <<'RUST'
use mcp9808::reg_res::ResolutionVal;
use mcp9808::reg_temp_generic::{ReadableTempRegister, WritableTempRegister};
use mcp9808::{reg_temp, reg_temp_alert_lower};

/// The 13 bits of a temperature in sixteenths of a degree.
fn bits(celsius: f32) -> u16 {
    (16.0 * celsius) as i16 as u16 & 0x1fff
}

fn main() {
    // Temperature, what is read of it, and the registers of a limit there by degrees and by millidegrees.
    let expected = [
        (25.25, 25.25, 0x0194, 0x0194),
        (-0.25, 1.75, 0x1000, 0x100c),
        (-5.5, 6.5, 0x1000, 0x10b8),
        (-10.0, 10.0, 0x1000, 0x1060),
    ];
    for (celsius, read, by_degrees, by_millidegrees) in expected {
        let mut temperature = reg_temp::new();
        temperature.set_buf(bits(celsius).to_be_bytes());
        let seen = temperature.get_celsius(ResolutionVal::Deg_0_0625C);
        let mut degrees = reg_temp_alert_lower::new();
        degrees.set_celsius(celsius);
        let mut millidegrees = reg_temp_alert_lower::new();
        millidegrees.set_milli_celsius((1000.0 * celsius) as i32);
        let written = (degrees.get_raw_value(), millidegrees.get_raw_value());
        println!("{celsius} C, bits {:#06x}: reads {seen} C, limit {:#06x}, {:#06x}", bits(celsius), written.0, written.1);
        assert_eq!((seen, written), (read, (by_degrees, by_millidegrees)), "CHANGED");
    }
}
RUST
cd "$folder"
cargo run --quiet
