//! Touch current of a person whose finger is on the plate.

use anyhow::Result;

use super::{Bench, PERIOD_S};
use crate::netlist::Netlists;
use crate::ngspice;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "leakage",
    title: "touch current of the plate: mains, PWM, cracked ceramic",
    parts: &[run],
    // A supply with an ordinary Y capacitor.
    broken: |netlists| netlists.with("c_mains", 2.2e-9),
    pictures: &[],
};

/// Largest touch current in normal use, uA (IEC 60601-1, type BF; recalled, check).
const NORMAL_UA: f64 = 100.0;

/// Largest touch current with a single fault, uA (as above).
const FAULT_UA: f64 = 500.0;

/// A crack in the tile's ceramic: one terminal touches the plate.
fn cracked_netlists(netlists: &Netlists) -> Result<Netlists> {
    netlists.with_line("C2 tile plate", "R9 tile plate 1")
}

/// Touch current, weighted by frequency, uA: with these sources, at the end of 100 ms.
fn touch_ua(netlists: &Netlists, sources: &str) -> Result<f64> {
    let deck = format!(
        "Xl mains common tile plate usb leakage\nXp plate earth out person\nVe earth 0 0\nRg common 0 1g\n{sources}\n\
         .options reltol=1e-4\n.meas tran effective rms v(out) from=60m to=100m\n"
    );
    Ok(ngspice::run("leakage", netlists, &deck)?.get("effective")? * 1e3)
}

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let mains = "Vm mains 0 SIN(0 358 50)";
    let quiet = "Vt tile common 0\nVu usb 0 0\n.tran 20u 100m 0 20u";
    let high_s = 0.5 * PERIOD_S;
    let pwm = format!(
        "Vm mains 0 0\nVt tile common PULSE(0 12 0 30n 30n {high_s:e} {PERIOD_S:e})\nVu usb 0 0\n.tran 0.5u 3m 0 0.2u"
    );
    let touch = touch_ua(netlists, &format!("{mains}\n{quiet}"))?;
    let cracked = touch_ua(
        &cracked_netlists(netlists)?,
        &format!("{mains}\nVt tile common 12\nVu usb 0 0\n.tran 20u 100m 0 20u"),
    )?;
    let earthed = cracked_netlists(netlists)?;
    let earthed = touch_ua(
        &earthed,
        &format!("{mains}\nVt tile common 12\nVu usb 0 0\nRu common usb 0.1\n.tran 20u 100m 0 20u"),
    )?;
    let deck = format!(
        "Xl mains common tile plate usb leakage\nXp plate earth out person\nVe earth 0 0\nRg common 0 1\n{pwm}\n\
         .options reltol=1e-3\n.meas tran effective rms v(out) from=2m to=3m\n"
    );
    let pwm_ua = ngspice::run("leakage-pwm", netlists, &deck)?.get("effective")? * 1e3;
    Ok(vec![
        Quantity::at_most(
            "mains by the supply's isolation, 253 V, weighted",
            touch,
            "uA",
            NORMAL_UA,
        ),
        Quantity::at_most("PWM through the ceramic, weighted", pwm_ua, "uA", NORMAL_UA),
        Quantity::at_most(
            "cracked ceramic, host isolated (limit of a single fault)",
            cracked,
            "uA",
            FAULT_UA,
        ),
        Quantity::at_least(
            "cracked ceramic, host earthed and not isolated: why USB is isolated",
            earthed,
            "uA",
            FAULT_UA,
        ),
    ])
}
