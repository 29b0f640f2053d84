//! Coupling of the tile's current into a thermistor's reading by shared ground.

use anyhow::Result;

use super::Bench;
use super::dividers::SLOPE_V_K;
use crate::netlist::Netlists;
use crate::ngspice;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "ground",
    title: "6 A of tile current in a thermistor's reading",
    parts: &[run],
    // The thermistor's return on the power board, and 1 mohm of copper that both share.
    broken: |netlists| netlists.with("r_star", 1e-3),
    pictures: &[],
};

/// Error of a thermistor's reading, K, with its return at a node and a host whose ground is or is not isolated.
fn error_k(netlists: &Netlists, returns_at: &str, isolated: bool) -> Result<f64> {
    let earth_ohm = if isolated { 1e9 } else { 1e-3 };
    let deck = format!(
        "V3 v3 agnd 3.3\nI6 0 x 0\nVt tc 0 25\nVm minus 0 0\nIt vsup pgnd 6\nRsup vsup minus 1\n\
         Xg pgnd agnd minus earth ground\nRe earth minus {earth_ohm:e}\n\
         Xn pin {returns_at} tc ntc\nX1 v3 pin in adc divider\nB1 read 0 V=V(adc)-V(agnd)\n\
         .dc It 0 6 6\n.meas dc without find v(read) at=0\n.meas dc with find v(read) at=6\n"
    );
    let measured = ngspice::run("ground", netlists, &deck)?;
    Ok((measured.get("with")? - measured.get("without")?) / SLOPE_V_K)
}

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let milli = |kelvin: f64| 1e3 * kelvin.abs();
    let right = error_k(netlists, "agnd", true)?;
    let power_board = error_k(netlists, "pgnd", true)?;
    let host = error_k(netlists, "xg.star", false)?;
    let isolated = error_k(netlists, "xg.star", true)?;
    Ok(vec![
        Quantity::at_most("return on the analog ground, host isolated", milli(right), "mK", 1.0),
        Quantity::at_most(
            "return on the power ground (wrong), host isolated",
            milli(power_board),
            "mK",
            11.0,
        ),
        Quantity::at_most("return at the star, host isolated", milli(isolated), "mK", 1.0),
        Quantity::at_least(
            "return at the star, host earthed and not isolated: why USB is isolated",
            milli(host),
            "mK",
            20.0,
        ),
    ])
}
