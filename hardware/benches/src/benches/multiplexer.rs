//! Multiplexers of five fingers: settling, the neighbour's error, and what the followers in front of them are for.

use anyhow::Result;

use super::Bench;
use super::dividers::SLOPE_V_K;
use crate::netlist::Netlists;
use crate::ngspice;
use crate::picture::Scene;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "multiplexer",
    title: "multiplexer of five fingers: settling within a scan, error by the neighbouring finger",
    parts: &[run],
    // The multiplexer on the filters' capacitors, without the followers in front of it.
    broken: |netlists| netlists.with_line("X1 in follow follower", "Rf in follow 1"),
    pictures: &[("multiplexer", scene)],
};

/// Time between two scans, us. The program switches in the first scan that is left out, so at least the second is left.
const SCAN_US: f64 = 100.0 / 9.0;
/// Half of a count, mK at 25 °C: what the reading may differ by.
const ALLOWED_MK: f64 = 11.0;

/// Two fingers' dividers at 25 °C and with a resistor on the neighbour's connector; the multiplexer connects finger 0 every
/// millisecond at 0 ms and finger 1 for 0.2 ms before, as the firmware does. `more` are further lines.
fn deck(neighbour_ohm: f64, more: &str) -> String {
    format!(
        "V3 v3 0 3.3\nVt tc 0 25\nXn pin0 0 tc ntc\nRn pin1 0 {neighbour_ohm:e}\n\
         X1 v3 pin0 in0 y0 divider\nX2 v3 pin1 in1 y1 divider\n\
         Vs0 s0 0 PULSE(3.3 0 200u 5n 5n 800u 1m)\nVs1 s1 0 0\nVs2 s2 0 0\n\
         Xm v3 y0 y1 0 0 0 s0 s1 s2 adcpin multiplexer\nVb before 0 1.65\n\
         Xa adcpin before held adc t_sample=0.667u period=11.111u\n\
         .options reltol=1e-5 abstol=1p vntol=1u method=gear\n{more}"
    )
}

/// Error of finger 0's reading, mK, for each delay of `after_us` after its multiplexer has been switched, us.
fn errors_mk<const N: usize>(
    netlists: &Netlists,
    neighbour_ohm: f64,
    after_us: [f64; N],
) -> Result<[f64; N]> {
    // Switched at 5.2 ms; by then the filters' capacitors have been switched five times.
    let mut more = ".tran 0.2u 5.4m 0 2u\n.meas tran alone find v(pin0) at=0\n".to_owned();
    for (number, after_us) in after_us.iter().enumerate() {
        let at_us = 5200.0 + after_us;
        more += &format!(".meas tran follower{number} find v(adcpin) at={at_us}u\n");
    }
    let measured = ngspice::run("multiplexer", netlists, &deck(neighbour_ohm, &more))?;
    let alone = measured.get("alone")?;
    let mut errors_mk = [0.0; N];
    for (number, error_mk) in errors_mk.iter_mut().enumerate() {
        let follower = measured.get(&format!("follower{number}"))?;
        *error_mk = 1e3 * (alone - follower).abs() / SLOPE_V_K;
    }
    Ok(errors_mk)
}

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let mut all = Vec::new();
    // A shorted and an open thermistor of the neighbour: 0 and 3.3 V, the full difference.
    for (neighbour, ohm) in [("shorted (0 V)", 1.0), ("open (3.3 V)", 1e9)] {
        let errors_mk = errors_mk(netlists, ohm, [SCAN_US, 2.0 * SCAN_US])?;
        for (scans, error_mk) in ["one scan", "two scans"].into_iter().zip(errors_mk) {
            all.push(Quantity::at_most(
                format!("neighbour's thermistor {neighbour}: error {scans} after switching"),
                error_mk,
                "mK",
                ALLOWED_MK,
            ));
        }
    }
    let settled = deck(
        1.0,
        ".tran 20n 1.22m 1.19m 20n\n.meas tran settled when v(adcpin)=1.6496 rise=1 td=1.2m\n",
    );
    let settled = ngspice::run("multiplexer-settling", netlists, &settled)?;
    all.push(Quantity::at_most(
        "settling to 10 mK after a step of 1.65 V",
        settled.get("settled")? * 1e6 - 1200.0,
        "us",
        SCAN_US,
    ));
    let slowest = netlists.with_line(
        "X1 y0 y1 y2 y3 y4 0 0 0 z s0 s1 s2 v3 mux8",
        "X1 y0 y1 y2 y3 y4 0 0 0 z s0 s1 s2 v3 mux8 r_on=1k",
    )?;
    let [error_mk] = errors_mk(&slowest, 1.0, [SCAN_US])?;
    all.push(Quantity::at_least(
        "shorted, with 1 kohm: why not a 74HC4051, which is not specified on 3.3 V",
        error_mk,
        "mK",
        ALLOWED_MK,
    ));
    Ok(all)
}

fn scene() -> Scene {
    Scene {
        lines: deck(1.0, ".tran 20n 1.22m 1.19m 20n"),
        time: ("time, us; the neighbour's connector is shorted, switched at 1200 us", 1e6),
        range: 1198.0..1204.0,
        charts: &[(
            "V",
            &[
                ("select line 0", "v(s0)", 1.0),
                ("behind the multiplexer", "v(xm.z)", 1.0),
                ("at the pin", "v(adcpin)", 1.0),
            ],
        )],
    }
}
