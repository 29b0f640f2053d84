#!/bin/sh
# Guess: discrete_pid's configuration has the same default gains however it is made; the documentation of its builder calls them
# identical.
#
# Seen, with discrete_pid 0.3.0 and rustc 1.95.0: the integral gain differs by a factor of 100. `PidConfig::default()` has 1 per second:
# it keeps 0.01, the gain of one sample of 10 ms, and its table of defaults says so. The builder takes the same 0.01 for the gain per
# second. A controller that is held at an error of 1 for a second adds up 1 with the one and 0.01 with the other.
#
# A controller whose integral is a hundred times too slow looks like one with a lasting error. Give `ki` to the builder.
#
# Fails if a gain or a sum changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cat > "$folder/Cargo.toml" <<'TOML'
[package]
name = "default-gain"
version = "0.0.0"
edition = "2024"

[dependencies]
discrete_pid = "=0.3.0"
TOML
cat > "$folder/src/main.rs" <<'RUST'
use discrete_pid::pid::{PidConfig, PidConfigBuilder, PidController};
use discrete_pid::time::Millis;

/// What the integral adds to the output in a second at an error of 1, sampled every 10 ms.
fn integral_after_second(config: PidConfig<f64>) -> f64 {
    let mut controller = PidController::new_uninit(config);
    let outputs: Vec<f64> = (0..=100).map(|sample| controller.compute(0.0, 1.0, Millis(10 * sample), None)).collect();
    outputs[100] - outputs[0]
}

fn main() {
    let built = PidConfigBuilder::<f64>::default().build().expect("the defaults are valid");
    for (name, config, gain) in [("PidConfig", PidConfig::default(), 1.0), ("PidConfigBuilder", built, 0.01)] {
        let sum = integral_after_second(config);
        println!("{name}: ki {}, integral of a second at an error of 1: {sum:.4}", config.ki());
        assert!((config.ki() - gain).abs() < 1e-12 && (sum - gain).abs() < 0.02 * gain, "CHANGED");
        assert!(config.kp() == 1.0 && config.kd() == 0.0, "CHANGED");
    }
}
RUST
cd "$folder"
cargo run --quiet
