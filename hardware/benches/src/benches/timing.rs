//! The times that the firmware assumes of the circuit, from its lines to the tile and from a fault to its break input.

use anyhow::Result;

use super::transients::OPTIONS;
use super::{Bench, edges};
use crate::netlist::Netlists;
use crate::ngspice;
use crate::picture::Scene;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "timing",
    title: "line to tile and fault to break input, against what the firmware assumes",
    parts: &[run],
    // No filter at the break input: a glitch of 100 ns stops the PWM.
    broken: |netlists| netlists.scaled("c_break", 1e-3),
    pictures: &[("break-input", break_scene)],
};

/// Levels of an input of the microcontroller, V: 0.3 and 0.7 of 3.3 V.
const LOW_V: f64 = 0.99;
const HIGH_V: f64 = 2.31;

/// How long the gate driver holds nFAULT low before it tries again, ms (recalled, check).
const RETRY_MS: f64 = 3.0;

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let mut all = Vec::new();
    for (seebeck_v, range_a) in [(4.9, (0.8, 1.4)), (2.8, (2.5, 3.5)), (-0.6, (5.5, 6.5))] {
        let measured = edges::simulate(netlists, seebeck_v)?;
        let (current_a, lost_us) = (measured.get("current")?, edges::lost_us(&measured)?);
        all.push(Quantity::between("tile current", current_a, "A", range_a));
        all.push(Quantity::between(
            "effective dead time at this current; tuning fails above 0.53",
            lost_us,
            "us",
            (0.0, 0.53),
        ));
    }
    all.extend(disable(netlists)?);
    all.extend(break_input(netlists)?);
    Ok(all)
}

/// The enable line falls while 6 A flow: the firmware's and the hardware's way to turn off.
fn disable(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let lines = format!(
        "V3 v3 0 3.3\nVs vs 0 12\nRs vs vbr 20m\nCs vbr 0 20u\nVin1 in1 0 3.3\n\
         {pulses}\nVen enable 0 PWL(0 3.3 200u 3.3 200.005u 0)\n\
         X1 vbr v3 in1 in2 enable nfault p n sa sb bridge\nVi p pt 0\nXt pt n tile seebeck=-0.6\n\
         Bg gate 0 V=V(x1.gh1,x1.o1)\n\
         {OPTIONS}\n.tran 5n 260u 0 25n\n\
         .meas tran high_off when v(gate)=1 fall=1 td=200u\n.meas tran low_off when v(x1.gl2)=1 fall=1 td=200u\n\
         .meas tran gone when i(vi)=0.3 fall=1 td=200u\n.meas tran most max v(vbr) from=200u to=260u\n",
        pulses = edges::half_duty(),
    );
    let measured = ngspice::run("timing-disable", netlists, &lines)?;
    Ok(vec![
        Quantity::at_most(
            "enable low to both switches of the pulse off",
            measured.find("high_off").unwrap_or(200e-6).max(measured.get("low_off")?) * 1e6 - 200.0,
            "us",
            1.5,
        ),
        Quantity::at_most(
            "enable low to tile current below 0.3 A",
            measured.get("gone")? * 1e6 - 200.0,
            "us",
            60.0,
        ),
        Quantity::at_most(
            "bridge supply, highest, while the filter's energy returns",
            measured.get("most")?,
            "V",
            14.0,
        ),
    ])
}

/// nFAULT, its RC and the microcontroller's input.
fn break_input(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let lines = break_deck()
        + "\n.meas tran glitch min v(x1.break) from=9u to=15u\n.meas tran coupled min v(x1.break) from=19u to=25u\n\
           .meas tran low_at when v(x1.break)=0.99 fall=1 td=29u\n.meas tran high_at when v(x1.break)=2.31 rise=1 td=60u\n";
    let measured = ngspice::run("timing-break", netlists, &lines)?;
    let low_us = measured.get("low_at")? * 1e6 - 30.0;
    let high_us = measured.get("high_at")? * 1e6 - 60.0;
    Ok(vec![
        Quantity::at_least(
            "glitch of 100 ns on nFAULT: lowest voltage at the break input",
            measured.get("glitch")?,
            "V",
            HIGH_V,
        ),
        Quantity::at_least(
            "12 V edge through 10 pF on nFAULT: lowest voltage at the break input",
            measured.get("coupled")?,
            "V",
            HIGH_V,
        ),
        Quantity::between(
            format!("nFAULT low to break input below {LOW_V} V"),
            low_us,
            "us",
            (0.5, 3.0),
        ),
        Quantity::at_least(
            "break input low in a fault of 3 ms (the gate driver's retry; the firmware reads the line every 1 ms)",
            RETRY_MS + 1e-3 * (high_us - low_us),
            "ms",
            2.0,
        ),
    ])
}

/// A glitch of 100 ns on nFAULT at 10 us, an output's edge of 12 V in 20 ns through 10 pF at 20 us, a fault from 30 to 60 us.
fn break_deck() -> String {
    format!(
        "V3 v3 0 3.3\nVbr vbr 0 12\nVin1 in1 0 3.3\nVin2 in2 0 3.3\nVen enable 0 3.3\n\
         X1 vbr v3 in1 in2 enable nfault p n sa sb bridge\nXt p n tile\n\
         Sf nfault 0 f 0 open_drain\n\
         Vf f 0 PWL(0 0 10u 0 10.005u 1 10.1u 1 10.105u 0 30u 0 30.005u 1 60u 1 60.005u 0)\n\
         .model open_drain sw(vt=0.5 vh=0.1 ron=50 roff=100meg)\n\
         Ve edge 0 PWL(0 12 20u 12 20.02u 0)\nCe edge nfault 10p\n{OPTIONS}\n.tran 20n 90u 0 100n"
    )
}

fn break_scene() -> Scene {
    Scene {
        lines: break_deck(),
        time: ("time, us; glitch at 10, coupled edge at 20, fault from 30 to 60 us", 1e6),
        range: 5.0..75.0,
        charts: &[("V", &[("nFAULT", "v(nfault)", 1.0), ("break input", "v(x1.break)", 1.0)])],
    }
}
