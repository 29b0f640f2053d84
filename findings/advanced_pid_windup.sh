#!/bin/sh
# Guess: a PID controller that is given limits for its output also stops its integral there.
#
# Seen, with advanced-pid 0.2.3 and rustc 1.95.0: of its four controllers only the velocity form (VelPid) does. Pid, PiD and Ipd limit what
# they return, and add up the error behind it. With kp = 1, ki = 0.1 and an output of -1 to 1, one minute at an error of 1 is followed
# by 489 s at the limit while the error is -0.1; VelPid leaves the limit in the first step.
#
# A Peltier tile that was held at its current limit would go on at full current far beyond its set-point.
#
# Fails if the number of steps changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cat > "$folder/Cargo.toml" <<'TOML'
[package]
name = "windup"
version = "0.0.0"
edition = "2024"

[dependencies]
advanced-pid = { version = "=0.2.3", features = ["f64"] }
TOML
cat > "$folder/src/main.rs" <<'RUST'
use advanced_pid::{Ipd, Pid, PiD, PidConfig, PidController, VelPid};

/// Seconds at the upper limit while the error is -0.1, after a minute with an error of 1.
fn seconds_at_limit(mut controller: impl PidController) -> u32 {
    for _ in 0..60 {
        controller.update(1.0, 0.0, 1.0);
    }
    (0..3600).take_while(|_| controller.update(0.0, 0.1, 1.0) >= 1.0).count() as u32
}

fn main() {
    let config = || PidConfig::new(1.0, 0.1, 0.0).with_limits(-1.0, 1.0);
    let seen = [
        ("Pid", seconds_at_limit(Pid::new(config()))),
        ("PiD", seconds_at_limit(PiD::new(config()))),
        ("Ipd", seconds_at_limit(Ipd::new(config()))),
        ("VelPid", seconds_at_limit(VelPid::new(config()))),
    ];
    for (name, seconds) in seen {
        println!("{name}: {seconds} s at the limit after the error has changed its sign");
    }
    let as_stated = seen.map(|(_, seconds)| seconds) == [489, 489, 489, 0];
    std::process::exit(i32::from(!as_stated));
}
RUST
cd "$folder"
cargo run --quiet
