//! Force amplifier: zero, gain, each wire broken.

use anyhow::Result;

use super::Bench;
use super::current_measurement::COUNTS_PER_V;
use crate::netlist::Netlists;
use crate::ngspice;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "force",
    title: "force amplifier against 410 counts at 0 N and 300 counts/N; each wire broken",
    parts: &[run],
    // The lower sense wire is not used, as with a four-wire cell.
    broken: |netlists| netlists.with_line("R4 ref0 sm", "R4 ref0 0 {r_ref_bottom}"),
    pictures: &[],
};

/// Tare resistor, times the weight that it takes off, ohm N: 350 ohm / (4 * 1e-4 / N).
const TARE_OHM_N: f64 = 875e3;

/// Wires of the load cell.
const WIRES: [&str; 6] = ["ep", "em", "sp", "sm", "p", "n"];

/// Counts at a force, N, with one wire broken or none.
fn counts(netlists: &Netlists, force_n: f64, broken: Option<&str>) -> Result<f64> {
    counts_with(netlists, force_n, broken, "")
}

/// The same with further lines.
fn counts_with(netlists: &Netlists, force_n: f64, broken: Option<&str>, more: &str) -> Result<f64> {
    let mut deck =
        format!("V3 v3 0 3.3\nV5 v5 0 5\nVf f 0 {force_n}\nXc cep cem cp cn f load_cell\n");
    for wire in WIRES {
        let at_cell = match wire {
            "ep" | "sp" => "cep",
            "em" | "sm" => "cem",
            "p" => "cp",
            _ => "cn",
        };
        let ohm = if broken == Some(wire) { 1e12 } else { 0.2 };
        deck += &format!("Rw_{wire} {wire} {at_cell} {ohm:e}\n");
    }
    deck += "X1 v3 v5 ep em sp sm p n adc force\n.options gmin=1e-14\n.dc Vf 0 12 0.5\n";
    deck += &format!(".meas dc out find v(adc) at={force_n}\n{more}");
    Ok(ngspice::run("force", netlists, &deck)?.get("out")? * COUNTS_PER_V)
}

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let zero = counts(netlists, 0.0, None)?;
    let five = counts(netlists, 5.0, None)?;
    let ten = counts(netlists, 10.0, None)?;
    let mut all = vec![
        Quantity::between("zero", zero, "counts", (402.0, 418.0)),
        Quantity::between("gain", (ten - zero) / 10.0, "counts/N", (294.0, 306.0)),
        Quantity::between(
            "straight line, error at 5 N",
            five - 0.5 * (zero + ten),
            "counts",
            (-2.0, 2.0),
        ),
    ];
    let weight_n = 5.0;
    let tare = format!("Rtare cp cem {:e}", TARE_OHM_N / weight_n);
    all.push(Quantity::between(
        "zero with a stack of 5 N and its tare resistor",
        counts_with(netlists, weight_n, None, &tare)?,
        "counts",
        (402.0, 418.0),
    ));
    for wire in WIRES {
        let reading = counts(netlists, 0.0, Some(wire))?;
        // Below half of the zero, or above 4060 counts: distance from both, negative if neither.
        let margin = f64::max(0.5 * zero - reading, reading - 4060.0);
        all.push(Quantity::at_least(
            format!("wire {wire} broken: beyond the limits of the fault force-sensor by"),
            margin,
            "counts",
            0.0,
        ));
    }
    Ok(all)
}
