//! Thresholds of the window comparator over tolerances and temperature.

use anyhow::Result;

use super::Bench;
use crate::netlist::Netlists;
use crate::ngspice;
use crate::quantity::Quantity;

pub const BENCH: Bench = Bench {
    name: "thresholds",
    title: "window comparator against 10 and 45 °C, over tolerances and 0 to 50 °C of the board",
    parts: &[run],
    broken: |netlists| netlists.scaled("r_ladder_bottom", 1.05),
    pictures: &[],
};

/// Tolerance of the resistors that set the thresholds: 0.1 %, and 25 ppm/K over 25 K.
const PRECISE: f64 = 0.001 + 25e-6 * 25.0;
/// Tolerance of all others: 1 %, and 100 ppm/K over 25 K.
const ORDINARY: f64 = 0.01 + 100e-6 * 25.0;

/// What contributes to the error: parameter, and its largest deviation, as a fraction.
const RELATIVE: [(&str, f64); 8] = [
    ("r_pull", PRECISE),
    ("r_ladder_top", PRECISE),
    ("r_ladder_mid", PRECISE),
    ("r_ladder_bottom", PRECISE),
    ("r_bias", ORDINARY),
    ("r_hot", ORDINARY),
    ("r_hot_hysteresis", ORDINARY),
    ("r_cold_hysteresis", ORDINARY),
];
/// Offsets at most, V: follower, comparators.
const OFFSETS: [(&str, f64); 3] =
    [("vos_follower", 1.6e-3), ("vos_hot", 3.5e-3), ("vos_cold", 3.5e-3)];

/// Supplies and thermistor around the block.
#[derive(Clone, Copy)]
struct Surroundings {
    v3: f64,
    v5: f64,
    r25: f64,
    beta: f64,
}

const NOMINAL: Surroundings = Surroundings { v3: 3.3, v5: 5.0, r25: 10e3, beta: 3950.0 };

/// Cold and hot threshold, °C, with the temperature falling or rising away from the middle.
fn thresholds(netlists: &Netlists, around: Surroundings) -> Result<[f64; 2]> {
    let [cold, _, hot, _] = trips_and_releases(netlists, around)?;
    Ok([cold, hot])
}

/// Temperatures, °C, at which the output trips and releases: cold, cold, hot, hot.
fn trips_and_releases(
    netlists: &Netlists,
    Surroundings { v3, v5, r25, beta }: Surroundings,
) -> Result<[f64; 4]> {
    // Outwards from the middle, and back.
    let sweep = |from: f64, to: f64, edge: &str| -> Result<f64> {
        let step = 0.01f64.copysign(to - from);
        let deck = format!(
            "V3 v3 0 {v3}\nV5 v5 0 {v5}\nVt tc 0 {from}\nVtest test 0 0\nVside side 0 0\n\
             Xn pin 0 tc ntc r25={r25} beta={beta}\nX1 v3 pin in adc divider\n\
             X2 v3 v5 in test side nrst on trip nfault window\nRn v3 nrst 40k\nR1 v3 nfault 4.7k\n\
             .dc Vt {from} {to} {step}\n.meas dc at when v(x2.out)=2.5 {edge}=1\n"
        );
        ngspice::run("thresholds", netlists, &deck)?.get("at")
    };
    Ok([
        sweep(15.0, 7.0, "fall")?,
        sweep(7.0, 15.0, "rise")?,
        sweep(40.0, 48.0, "fall")?,
        sweep(48.0, 40.0, "rise")?,
    ])
}

fn run(netlists: &Netlists) -> Result<Vec<Quantity>> {
    let [cold, cold_back, hot, hot_back] = trips_and_releases(netlists, NOMINAL)?;
    let mut circuit = [0.0; 2];
    let mut thermistor = [0.0; 2];
    let add = |sum: &mut [f64; 2], at: [f64; 2]| {
        sum[0] += (at[0] - cold).abs();
        sum[1] += (at[1] - hot).abs();
    };
    for (name, tolerance) in RELATIVE {
        let changed = netlists.scaled(name, 1.0 + tolerance)?;
        add(&mut circuit, thresholds(&changed, NOMINAL)?);
    }
    for (name, volt) in OFFSETS {
        add(&mut circuit, thresholds(&netlists.with(name, volt)?, NOMINAL)?);
    }
    for around in [Surroundings { v3: 3.2, ..NOMINAL }, Surroundings { v5: 5.1, ..NOMINAL }] {
        add(&mut circuit, thresholds(netlists, around)?);
    }
    for around in
        [Surroundings { r25: 10.1e3, ..NOMINAL }, Surroundings { beta: 3950.0 * 1.01, ..NOMINAL }]
    {
        add(&mut thermistor, thresholds(netlists, around)?);
    }
    let mut all = Vec::new();
    for (side, middle, back, index) in [("cold", cold, cold_back, 0), ("hot", hot, hot_back, 1)] {
        let limit = [10.0, 45.0][index];
        let (own, all_parts) = (circuit[index], circuit[index] + thermistor[index]);
        all.push(Quantity::between(
            format!("{side} threshold, nominal"),
            middle,
            "°C",
            (limit - 0.15, limit + 0.15),
        ));
        for (what, error, allowed) in [
            ("circuit's tolerances", own, 0.5),
            ("and thermistor of 1 % and 1 % of beta", all_parts, 1.25),
        ] {
            for (end, at) in [("lowest", middle - error), ("highest", middle + error)] {
                all.push(Quantity::between(
                    format!("{side}, {end}, {what}"),
                    at,
                    "°C",
                    (limit - allowed, limit + allowed),
                ));
            }
        }
        all.push(Quantity::between(
            format!("{side} hysteresis"),
            (back - middle).abs(),
            "K",
            (0.1, 1.0),
        ));
    }
    Ok(all)
}
