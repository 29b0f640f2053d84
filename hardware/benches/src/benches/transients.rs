//! Peak currents at enable and at reversal, against over-current limit and saturation of the inductors.

use anyhow::Result;

use super::{Bench, PERIOD_S};
use crate::measure;
use crate::netlist::Netlists;
use crate::ngspice;
use crate::picture::{Chart, Scene};
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "transients",
    title: "enable at 6 A, +6 to -6 A in one PWM period, against over-current and saturation",
    parts: &[run],
    broken: |netlists| netlists.scaled("l_leg", 0.1),
    pictures: &[("enable", enable_scene), ("reversal", reversal_scene)],
};

/// On-resistance of a MOSFET at 125 °C against 25 °C, and tolerance of the gate driver's limit (recalled, check).
const HOT_MOSFET: f64 = 1.6;
const LIMIT_TOLERANCE: f64 = 1.25;
/// Supply at the upper end of its tolerance, V.
const SUPPLY_V: f64 = 12.6;
/// Options for circuits with MOSFETs.
pub const OPTIONS: &str =
    ".options reltol=2e-3 abstol=1u vntol=1m chgtol=1e-13 method=gear itl4=50";

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let mut all = Vec::new();
    // A slow current ramp through two switches that are on: where the driver trips.
    let ramp = format!(
        "V3 v3 0 3.3\nVbr vbr 0 12\nVin1 in1 0 3.3\nVin2 in2 0 0\nVen enable 0 3.3\n\
         X1 vbr v3 in1 in2 enable nfault p n sa sb bridge\nI1 p n PWL(0 0 20u 0 220u 60)\n\
         .model unused d\n{OPTIONS}\n.tran 20n 220u 0 100n\n\
         .meas tran trip_at when v(nfault)=1.6 fall=1"
    );
    let trip_at_s = ngspice::run("over-current", netlists, &ramp)?.get("trip_at")?;
    let trip_a = (trip_at_s - 20e-6) * 60.0 / 200e-6;
    let trip_hot_a = trip_a / (HOT_MOSFET * LIMIT_TOLERANCE);
    all.push(Quantity::between("over-current trip, MOSFETs at 25 °C", trip_a, "A", (25.0, 60.0)));
    all.push(Quantity::at_least(
        "the same, hot MOSFETs and lowest limit (estimated from it)",
        trip_hot_a,
        "A",
        13.0,
    ));
    let most_a = trip_hot_a.min(netlists.param("i_saturation")?);
    for (which, inductance) in [("nominal filter", 1.0), ("inductance 20 % less", 0.8)] {
        let changed = netlists.scaled("l_leg", inductance)?;
        let lines = format!(
            "{circuit}\n\
             .meas tran enable_peak max i(l.x1.l1) from=100u to=200u\n\
             .meas tran reversal_peak min i(l.x1.l1) from=312.5u to=400u\n\
             .meas tran fault min v(nfault) from=100u to=500u\n\
             {before}{after}",
            circuit = enable_and_reversal(),
            before = measure::mean("before", "i(vi)", 312.5e-6 - 10.0 * PERIOD_S..312.5e-6),
            after = measure::mean("after", "i(vi)", 500e-6 - 8.0 * PERIOD_S..500e-6),
        );
        let measured = ngspice::run("transients", &changed, &lines)?;
        for (what, peak_a) in [
            ("peak at enable", measured.get("enable_peak")?),
            ("peak at reversal", -measured.get("reversal_peak")?),
        ] {
            all.push(Quantity::at_most(format!("{which}: {what}"), peak_a, "A", most_a));
        }
        all.push(Quantity::between(
            format!("{which}: tile current before"),
            measured.get("before")?,
            "A",
            (5.4, 6.6),
        ));
        all.push(Quantity::between(
            format!("{which}: tile current after"),
            measured.get("after")?,
            "A",
            (-6.6, -5.4),
        ));
        all.push(Quantity::at_least(
            format!("{which}: nFAULT, lowest"),
            measured.get("fault")?,
            "V",
            2.5,
        ));
    }
    Ok(all)
}

/// Enabled at 102 us, between two pulses, with the duty of 6 A; cooling changes to warming at 312.5 us, at the begin of a period.
fn enable_and_reversal() -> String {
    let low_s = PERIOD_S * 0.55;
    let first_high_s = 312.5e-6 - 30.0 * PERIOD_S + low_s;
    let enable_s = 312.5e-6 - 20.4 * PERIOD_S;
    format!(
        "V3 v3 0 3.3\nVs vs 0 {SUPPLY_V}\nRs vs vbr 20m\nCs vbr 0 20u\n\
         Vpwm pwm 0 PULSE(0 3.3 {first_high_s:e} 5n 5n {high_s:e} {PERIOD_S:e})\n\
         Vw w 0 PWL(0 0 312.5u 0 312.505u 1)\n\
         B1 in1 0 V=V(w)*V(pwm)+(1-V(w))*3.3\nB2 in2 0 V=(1-V(w))*V(pwm)+V(w)*3.3\n\
         Ven enable 0 PULSE(0 3.3 {enable_s:e} 5n)\n\
         X1 vbr v3 in1 in2 enable nfault p n sa sb bridge\nVi p pt 0\nXt pt n tile\nVl l 0 0\n\
         {OPTIONS}\n.tran 20n 500u 0 60n",
        high_s = PERIOD_S - low_s,
    )
}

fn enable_scene() -> Scene {
    Scene {
        lines: enable_and_reversal(),
        time: ("time, us; enabled at 102 us", 1e6),
        range: 90.0..200.0,
        charts: CURRENTS,
    }
}

fn reversal_scene() -> Scene {
    Scene {
        lines: enable_and_reversal(),
        time: ("time, us; reversed at 312.5 us", 1e6),
        range: 290.0..420.0,
        charts: CURRENTS,
    }
}

/// What both pictures show.
const CURRENTS: &[Chart] = &[("A", &[("inductor", "i(l.x1.l1)", 1.0), ("tile", "i(vi)", 1.0)])];
