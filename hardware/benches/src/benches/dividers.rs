//! Thermistor dividers: errors of the front end, crosstalk of the converter, protection.

use anyhow::Result;

use super::{Bench, PERIOD_S};
use crate::netlist::Netlists;
use crate::ngspice;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "dividers",
    title: "thermistor dividers: static error, converter's crosstalk, filter, wrong plug",
    parts: &[run],
    // The converter on the filter's capacitor, without the follower.
    broken: |netlists| netlists.with_line("X1 in follow follower", "Rf in follow 1"),
    pictures: &[],
};

/// Change of the voltage with temperature at 25 °C, V/K.
pub const SLOPE_V_K: f64 = 3.3 * 0.25 * 3950.0 / (298.15 * 298.15);

/// Error of what the converter holds, K, after a channel of `before` volts, with a sampling time and period of conversions.
fn crosstalk_k(netlists: &Netlists, before: f64, sample_us: f64, period_us: f64) -> Result<f64> {
    let deck = format!(
        "V3 v3 0 3.3\nVt tc 0 25\nXn pin 0 tc ntc\nX1 v3 pin in adcpin divider\nVb before 0 {before}\n\
         Xa adcpin before held adc t_sample={sample_us}u period={period_us}u\n\
         .options reltol=1e-5 abstol=1p vntol=1u method=gear\n.tran 100n 6m 5.9m 100n\n\
         .meas tran at find v(held) at={at}u\n",
        // The last conversion's end.
        at = (5980.0 / period_us).floor() * period_us + 5.0 + sample_us - 0.02,
    );
    let held = ngspice::run("crosstalk", netlists, &deck)?.get("at")?;
    Ok((1.65 - held) / SLOPE_V_K)
}

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let mut all = Vec::new();
    for (which, sample_us, period_us) in [
        ("one finger", 2.5, 62.5),
        // 15 cycles and a scan every 11.1 us; the model's previous channel is charged for less than the rest.
        ("five fingers", 0.667, 11.111),
    ] {
        let apart = crosstalk_k(netlists, 0.0, sample_us, period_us)?
            - crosstalk_k(netlists, 3.3, sample_us, period_us)?;
        all.push(Quantity::at_most(
            format!("{which}: reading's shift by the previous channel, 0 to 3.3 V"),
            1e3 * apart.abs(),
            "mK",
            11.0,
        ));
    }
    let step = "V3 v3 0 PULSE(3.2 3.3 1m 1u)\nVt tc 0 25\nXn pin 0 tc ntc\nX1 v3 pin in adc divider\n\
        .options reltol=1e-4 vntol=1u\n.tran 1u 8m 0 5u\n.meas tran final find v(adc) at=8m\n\
        .meas tran level when v(adc)=1.6316 rise=1";
    let measured = ngspice::run("divider-step", netlists, step)?;
    all.extend([
        Quantity::between(
            "static error at 25 °C",
            1e3 * (measured.get("final")? - 1.65) / SLOPE_V_K,
            "mK",
            (-11.0, 11.0),
        ),
        Quantity::between(
            "time constant of the filter; the thermistor has 20 ms or more",
            1e3 * (measured.get("level")? - 1e-3),
            "ms",
            (0.2, 1.0),
        ),
    ]);
    let ripple = format!(
        "V3 v3 0 3.3\nVt tc 0 25\nXn pin 0 tc ntc\nX1 v3 pin in adc divider\nIn 0 pin SIN(0 10u {pwm_hz:e})\n\
        .options reltol=1e-4 vntol=1n\n.tran 0.2u 6m 5.9m 0.2u\n.meas tran ripple pp v(adc)\n.meas tran input pp v(pin)",
        pwm_hz = PERIOD_S.recip(),
    );
    let measured = ngspice::run("divider-ripple", netlists, &ripple)?;
    all.push(Quantity::at_least(
        "attenuation of the PWM's frequency from the connector to the converter",
        measured.get("input")? / measured.get("ripple")?,
        "1",
        20.0,
    ));
    let plug = "V3 v3 0 3.3\nVw pin 0 12\nX1 v3 pin in adc divider\n.dc Vw 0 12 0.5\n.meas dc high find v(in) at=12\n\
        .meas dc source find i(v3) at=12";
    let measured = ngspice::run("divider-plug", netlists, plug)?;
    all.extend([
        Quantity::at_most(
            "12 V on a thermistor's connector: follower's input",
            measured.get("high")?,
            "V",
            4.3,
        ),
        Quantity::at_most(
            "12 V on a thermistor's connector: current into 3.3 V",
            1e3 * measured.get("source")?,
            "mA",
            12.0,
        ),
    ]);
    Ok(all)
}
