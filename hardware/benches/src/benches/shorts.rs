//! Shorted outputs: the gate driver must turn off and report.

use anyhow::Result;

use super::transients::OPTIONS;
use super::{Bench, PERIOD_S};
use crate::netlist::Netlists;
use crate::ngspice;
use crate::picture::Scene;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "shorts",
    title: "shorted tile, output to ground, output to 12 V: time to nFAULT",
    parts: &[run],
    // A strap for a limit of 0.96 V in place of 0.12 V.
    broken: |netlists| {
        netlists.with_line(
            "X3 i1 i2 vbr",
            "X3 i1 i2 vbr nfault gh1 o1 gl1 sa gh2 o2 gl2 sb gate_driver v_ds=0.96",
        )
    },
    pictures: &[("shorted-tile", scene)],
};

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let mut all = Vec::new();
    // The current through a shorted tile rises at 0.6 A/us: the inductors do not saturate here, which would be faster.
    for (what, short, most_us) in [
        ("tile shorted", "S1 p n s 0 short", 150.0),
        ("output 1 to ground", "S1 x1.o1 0 s 0 short", 30.0),
        ("output 2 to 12 V", "S1 x1.o2 vbr s 0 short", 30.0),
    ] {
        let lines = format!(
            "{circuit}\n.meas tran fault_at when v(nfault)=1 fall=1 td=60u\n\
             .meas tran left find v(x1.gl2) at={late_us}u\n",
            circuit = deck(short, most_us),
            late_us = 78.0 + most_us,
        );
        let measured = ngspice::run("shorts", netlists, &lines)?;
        all.push(Quantity::between(
            format!("{what}: until nFAULT"),
            (measured.get("fault_at")? - 60e-6) * 1e6,
            "us",
            (0.0, most_us),
        ));
        all.push(Quantity::at_most(
            format!("{what}: low-side gate afterwards"),
            measured.get("left")?,
            "V",
            1.0,
        ));
    }
    Ok(all)
}

/// A bridge that drives 6 A, and a switch that closes at 60 us, between two pulses.
fn deck(short: &str, most_us: f64) -> String {
    format!(
        "V3 v3 0 3.3\nVs vs 0 12\nRs vs vx 20m\nLs vx vbr 0.2u\nCs vbr c 20u\nRc c 0 3m\nVin1 in1 0 3.3\n\
         Vin2 in2 0 PULSE(0 3.3 {first_high_s:e} 5n 5n {high_s:e} {PERIOD_S:e})\nVen enable 0 3.3\n\
         X1 vbr v3 in1 in2 enable nfault p n sa sb bridge\nXt p n tile\n\
         {short}\nVshort s 0 PWL(0 0 60u 0 60.05u 1)\n\
         .model short sw(vt=0.5 vh=0.1 ron=5m roff=1meg)\n\
         {OPTIONS}\n.tran 20n {end_us}u 0 60n",
        first_high_s = 60e-6 - 5.22 * PERIOD_S,
        high_s = 0.46 * PERIOD_S,
        end_us = 80.0 + most_us,
    )
}

fn scene() -> Scene {
    Scene {
        lines: deck("S1 p n s 0 short", 150.0),
        time: ("time, us; shorted at 60 us", 1e6),
        range: 40.0..220.0,
        charts: &[
            ("A", &[("inductor", "i(l.x1.l1)", 1.0)]),
            ("V", &[("nFAULT", "v(nfault)", 1.0), ("break input", "v(x1.break)", 1.0)]),
        ],
    }
}
