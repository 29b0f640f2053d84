//! Current measurement: gain, error and ripple against duty.

use anyhow::Result;

use super::{Bench, PERIOD_S};
use crate::measure;
use crate::netlist::Netlists;
use crate::ngspice;
use crate::picture::Scene;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "current",
    title: "current measurement against 400 counts/A: error and ripple over duty and direction",
    parts: &[run],
    // Without the capacitors the converter samples one phase of the ripple.
    broken: |netlists| netlists.scaled("c_sum", 1e-3)?.scaled("c_shunt_filter", 1e-3),
    pictures: &[("mirror-ripple", scene)],
};

/// What the firmware assumes.
const COUNTS_PER_A: f64 = 400.0;
/// Counts of the converter per volt.
pub const COUNTS_PER_V: f64 = 4096.0 / 3.3;

/// The tile's current with its ripple, in the sense resistors. Positive currents cool: the second sense resistor carries the
/// inductor's current all the time, the first the opposite one while both legs are low.
fn deck(henry: f64, current_a: f64, duty: f64) -> String {
    let ripple_a = 12.0 * duty * (1.0 - duty) * PERIOD_S / henry;
    let (on_s, off_s) = (duty * PERIOD_S, (1.0 - duty) * PERIOD_S);
    let size_a = current_a.abs();
    let (always, sometimes) = if current_a >= 0.0 { ("sb", "sa") } else { ("sa", "sb") };
    format!(
        "V3 v3 0 3.3\nV5 v5 0 5\nRa sa 0 {{r_shunt}}\nRb sb 0 {{r_shunt}}\n\
         Vt tri 0 PULSE(-0.5 0.5 0 {on_s:e} {off_s:e} 1n {PERIOD_S:e})\n\
         Vr low 0 PULSE(0 1 {on_s:e} 50n 50n {low_s:e} {PERIOD_S:e})\n\
         B1 0 {always} I={size_a}+{ripple_a}*V(tri)\nB2 {sometimes} 0 I=({size_a}+{ripple_a}*V(tri))*V(low)\n\
         X1 sa sb v3 v5 adc mirror\n.options reltol=1e-3 method=gear\n.tran 100n 3.12503m 0 300n",
        low_s = off_s - 100e-9,
    )
}

/// Mean reading and half of its ripple, A, for a tile current and duty.
fn reading(netlists: &Netlists, current_a: f64, duty: f64) -> Result<[f64; 2]> {
    let to_s = 3.125e-3;
    let from_s = to_s - 10.0 * PERIOD_S;
    let lines = deck(2.0 * netlists.param("l_leg")?, current_a, duty)
        + &format!("\n.meas tran ripple pp v(adc) from={from_s:e} to={to_s:e}\n")
        + &measure::mean("mean", "v(adc)", from_s..to_s);
    let measured = ngspice::run("current", netlists, &lines)?;
    let ampere = |volt: f64| volt * COUNTS_PER_V / COUNTS_PER_A;
    Ok([ampere(measured.get("mean")?), 0.5 * ampere(measured.get("ripple")?)])
}

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let mut all = Vec::new();
    for (current_a, duty) in
        [(1.0, 0.1), (3.0, 0.3), (6.0, 0.55), (6.0, 0.85), (-6.0, 0.55), (9.0, 0.8)]
    {
        let [mean_a, ripple_a] = reading(netlists, current_a, duty)?;
        // The plant's parameter box: `mirror.offset_a` and `mirror.gain_error`.
        let allowed_a = 0.05 + 0.02 * f64::abs(current_a);
        all.push(Quantity::between(
            format!("reading of {current_a} A at a duty of {duty}"),
            mean_a,
            "A",
            (current_a.abs() - allowed_a, current_a.abs() + allowed_a),
        ));
        all.push(Quantity::at_most(
            format!("error by the phase of sampling, {current_a} A, duty {duty}"),
            ripple_a,
            "A",
            0.03,
        ));
    }
    let [seebeck_a, _] = reading(netlists, 0.0, 0.25)?;
    all.push(Quantity::at_most(
        "reading of 0 A at a duty of 0.25 (the tile's own voltage)",
        seebeck_a,
        "A",
        0.05,
    ));
    let [offset_a, _] = reading(&netlists.with("vos_sense", 25e-6)?, 0.0, 0.01)?;
    all.push(Quantity::at_most("reading of 0 A, offset of 25 uV", offset_a, "A", 0.05));
    let [most_a, _] = reading(netlists, 10.0, 0.9)?;
    all.push(Quantity::between(
        "reading of 10 A: above the 9 A of over-current, below the end of the range",
        most_a,
        "A",
        (9.7, 10.2),
    ));
    Ok(all)
}

fn scene() -> Scene {
    Scene {
        lines: deck(9.4e-6, 6.0, 0.55),
        time: ("time, us; 6 A at a duty of 0.55, steady", 1e6),
        range: 3083.0..3125.0,
        charts: &[(
            "A",
            &[
                ("in the sense resistor", "v(sb)", 200.0),
                ("behind its filter", "v(x1.fb1)", 200.0),
                ("reading", "v(adc)", READING_A_PER_V),
            ],
        )],
    }
}

/// Reading per volt at the converter.
const READING_A_PER_V: f64 = COUNTS_PER_V / COUNTS_PER_A;
