#!/bin/sh
# Guess: crates for special functions compute erfc to the precision of f64, because exp(x^2) erfc(x), which contact models need,
# amplifies nothing else.
#
# Seen, by rustc 1.95.0, with default features off where there are some:
# - statrs 0.19.1: erfc(0.5) has a relative error of 1.0e-10; the worst between 0.01 and 5 is at 0.5.
# - scilib 1.0.0: erfc is 1 - erf, so erfc(4) has a relative error of 2.5e-3, and erfc(5) is 0 in place of 1.5e-12. Its documentation
#   does not limit the argument.
# - puruspe 0.4.4 and errorfunctions 0.2.0 agree with 17 digits to 2e-15, errorfunctions also in erfcx.
#
# Fails if one of these errors changes. References: 20 digits, computed with mpmath 1.3.0 at 25 digits.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cat > "$folder/Cargo.toml" <<'TOML'
[package]
name = "erfc-of-crates"
version = "0.0.0"
edition = "2024"

[dependencies]
errorfunctions = "=0.2.0"
puruspe = "=0.4.4"
scilib = "=1.0.0"
statrs = { version = "=0.19.1", default-features = false }
TOML
cat > "$folder/src/main.rs" <<'RUST'
use errorfunctions::RealErrorFunctions;

/// Argument, erfc, exp(x^2) erfc(x).
const REFERENCE: [(f64, f64, f64); 5] = [
    (0.5, 0.47950012218695346232, 0.61569034419292587487),
    (1.0, 0.15729920705028513066, 0.42758357615580700441),
    (2.0, 4.6777349810472658379e-3, 0.25539567631050574387),
    (4.0, 1.5417257900280018852e-8, 0.13699945762506138989),
    (5.0, 1.5374597944280348502e-12, 0.11070463773306862637),
];

fn main() {
    let mut failed = false;
    let mut check = |name: &str, found: f64, expected: f64, from: f64, to: f64| {
        let error = (found / expected - 1.0).abs();
        let as_seen = (from..=to).contains(&error);
        println!("{name}: {found:e}, relative error {error:.1e}{}", if as_seen { "" } else { " CHANGED" });
        failed |= !as_seen;
    };
    for (x, erfc, erfcx) in REFERENCE {
        check(&format!("puruspe erfc({x})"), puruspe::erfc(x), erfc, 0.0, 2e-15);
        check(&format!("errorfunctions erfc({x})"), RealErrorFunctions::erfc(x), erfc, 0.0, 2e-15);
        check(&format!("errorfunctions erfcx({x})"), x.erfcx(), erfcx, 0.0, 2e-15);
    }
    check("statrs erfc(0.5)", statrs::function::erf::erfc(0.5), REFERENCE[0].1, 1.0e-10, 1.1e-10);
    check("statrs erfc(1)", statrs::function::erf::erfc(1.0), REFERENCE[1].1, 4e-11, 5e-11);
    check("scilib erfc(4)", scilib::math::basic::erfc(4.0), REFERENCE[3].1, 2.4e-3, 2.6e-3);
    check("scilib erfc(5)", scilib::math::basic::erfc(5.0), REFERENCE[4].1, 1.0, 1.0);
    std::process::exit(i32::from(failed));
}
RUST
cd "$folder"
cargo run --quiet
