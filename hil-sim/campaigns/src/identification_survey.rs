//! Survey of randomly drawn devices: the tile that each identifies, compared with its plant.

use std::fmt::Write;
use std::time::Duration;

use anyhow::bail;
use serde::Serialize;
use thermal_client::client::{Client, IdentifiedTile, StationRequest, TuneResult};
use thermal_client::commissioning::arm;
use thermal_plant::Params;
use thermal_plant::parameters;
use thermal_plant::tile::ZERO_C_K;
use thermal_sim::commissioning::{CommissioningSetup, FrequencyResponse, settings_for_device};
use thermal_sim::engine::NativeEngine;
use thermal_sim::simulated_link::SimulatedLink;

use crate::percentile;

/// Room temperature, deg C.
const ROOM_C: f64 = 24.0;
/// Timeout of tuning and interval of the question for its result, ms.
const TUNE_MS: u64 = 70_000;
const QUESTION_MS: u64 = 1000;
/// Current at which the gains are compared, A, and current above which the actual current is linear in the demand, A.
const LARGE_A: f64 = 4.5;
const LINEAR_A: f64 = 1.0;
/// Delay from the demanded to the actual current, s: one tick.
const CURRENT_DELAY_S: f64 = 1e-3;
/// Angular frequency at which the dead time of the plate is compared, rad/s.
const DEAD_TIME_RAD_S: f64 = 20.0;
/// Time after power-up in which the device finds the zero of its force sensor.
const ZERO: Duration = Duration::from_millis(500);

/// Names and units of [`IdentificationResult::values`].
pub const QUANTITIES: [(&str, &str); 10] = [
    ("gain, against a T / C of the plant", "%"),
    ("Joule's term, against R / (2 a T)", "%"),
    ("leak, against (K + air) / C", "%"),
    ("sensor's lag", "%"),
    ("sensor's lag", "ms"),
    ("dead time, against the plate's phase at 20 rad/s", "ms"),
    ("loop's gain at its crossover, against the plant", "%"),
    ("phase margin reported", "deg"),
    ("gain margin reported", "times"),
    ("phase margin reported, less the plant's", "deg"),
];

/// Result of one device.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct IdentificationResult {
    /// Seed of the draw.
    pub draw: u64,
    /// The identified tile.
    pub tile: IdentifiedTile,
    /// Actual current per demanded current during tuning.
    pub flows: f64,
    /// The quantities in the order of [`QUANTITIES`].
    pub values: [f64; QUANTITIES.len()],
}

/// Draws a device, commissions it with a drawn reference thermometer, tunes it once more, and compares the result with the
/// plant.
///
/// # Errors
/// The device cannot be commissioned.
pub fn survey_device(draw: u64) -> anyhow::Result<IdentificationResult> {
    let mut params = Params::nominal();
    parameters::draw(&mut params, draw);
    let plants = CommissioningSetup::new(&params, ROOM_C, draw);
    let settings = settings_for_device(&params, ROOM_C, draw)?;
    let (tile, flows) = tune(&plants, &settings)?;
    let lag_s = params.sensors.thermistors[0].lag_s;
    let true_c = true_constants(&params, &plants)?;
    // The crossover frequency of the control loop, as its gains are chosen.
    let crossover = 0.5 / (tile.lag_s + tile.dead_s);
    let plant = FrequencyResponse::measure(&plants, crossover)?;
    let w = plant.w;
    let found_k_a = tile.gain_k_s_a / w.hypot(tile.leak_1_s) / (tile.lag_s * w).hypot(1.0);
    let plant_k_a = plant.k_a * flows / (lag_s * w).hypot(1.0);
    let found_rad = w.atan2(tile.leak_1_s) + (tile.lag_s * w).atan() + tile.dead_s * w;
    let plant_rad = plant.phase_lag_rad + (lag_s * w).atan() + CURRENT_DELAY_S * w;
    let fast = FrequencyResponse::measure(&plants, DEAD_TIME_RAD_S)?;
    let dead_s = (fast.phase_lag_rad - fast.w.atan2(true_c.leak_1_s)) / fast.w + CURRENT_DELAY_S;
    let percent = |found: f64, truth: f64| 100.0 * (found / truth - 1.0);
    let phase_deg = (plant_rad - found_rad).to_degrees();
    Ok(IdentificationResult {
        draw,
        tile: tile.clone(),
        flows,
        values: [
            percent(tile.gain_k_s_a, true_c.gain_k_s_a * flows),
            percent(tile.joule_per_a, true_c.joule_per_a * flows),
            percent(tile.leak_1_s, true_c.leak_1_s),
            percent(tile.lag_s, lag_s),
            1e3 * (tile.lag_s - lag_s),
            1e3 * (tile.dead_s - dead_s),
            percent(found_k_a, plant_k_a),
            tile.phase_deg,
            tile.gain_margin,
            phase_deg,
        ],
    })
}

/// Constants of a lumped model of the tile, from the plant's parameters.
struct Constants {
    gain_k_s_a: f64,
    joule_per_a: f64,
    leak_1_s: f64,
}

fn true_constants(params: &Params, plants: &CommissioningSetup) -> anyhow::Result<Constants> {
    let tile = &params.tile;
    let cold_k = plants.in_use()?.plant().display_c() + ZERO_C_K;
    let plate_j_k = tile.plate_m2() * tile.ceramic_m * tile.ceramic_j_m3k + tile.tabs_j_k;
    let seebeck_v_k = tile.seebeck_v_k();
    let air_w_k = tile.film_w_m2k * tile.plate_m2();
    Ok(Constants {
        gain_k_s_a: seebeck_v_k * cold_k / plate_j_k,
        joule_per_a: tile.resistance_ohm() / (2.0 * seebeck_v_k * cold_k),
        leak_1_s: (tile.conductance_w_k() + air_w_k) / (plate_j_k + tile.legs_j_k / 3.0),
    })
}

/// Tunes a device with settings; returns the tile and the ratio of actual to demanded current at [`LARGE_A`], from a line
/// fitted above [`LINEAR_A`].
fn tune(plants: &CommissioningSetup, settings: &[String]) -> anyhow::Result<(IdentifiedTile, f64)> {
    let mut engine = NativeEngine::new(plants.in_use()?);
    let mut client = Client::new(SimulatedLink::new(&mut engine));
    client.wait(ZERO)?;
    for line in settings {
        client.command(line)?;
    }
    arm(&mut client, None)?;
    client.ask(&StationRequest::Tune)?;
    client.ask(&StationRequest::stream(1))?;
    let (mut demand_a, mut pairs) = (0.0f64, Vec::new());
    for ms in 1..TUNE_MS {
        // An answer comes in the millisecond in which its line is sent.
        if ms.is_multiple_of(QUESTION_MS) {
            match client.ask(&TuneResult) {
                Ok(tile) => return Ok((tile, ratio_at_large_current(&pairs))),
                Err(error)
                    if error.refusal().is_some_and(|why| why.starts_with("tuning goes on")) => {}
                Err(error) => return Err(error.into()),
            }
        } else {
            client.wait(Duration::from_millis(1))?;
        }
        let current_a = client.link().world().plant().current_a();
        while let Some(line) = client.next_telemetry(Duration::ZERO)? {
            if demand_a.abs() > LINEAR_A {
                pairs.push((demand_a.abs(), current_a * demand_a.signum()));
            }
            demand_a = line.telemetry.demand_a.unwrap_or_default();
        }
    }
    bail!("tuning takes longer than {TUNE_MS} ms")
}

/// Ratio of actual to demanded current at [`LARGE_A`], by a least-squares line through pairs of both, A.
fn ratio_at_large_current(pairs: &[(f64, f64)]) -> f64 {
    let count = pairs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (demand_a, flows_a) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let off = pairs.iter().map(|pair| (pair.0 - demand_a, pair.1 - flows_a));
    let (together, alone) = off.fold((0.0, 0.0), |(together, alone), (demand, flows)| {
        (together + demand * flows, alone + demand * demand)
    });
    (flows_a + together / alone * (LARGE_A - demand_a)) / LARGE_A
}

/// Percentiles of each quantity.
pub fn table(all: &[IdentificationResult]) -> String {
    let mut text = format!(
        "{:50} {:>8} {:>8} {:>8}\n",
        format!("{} devices", all.len()),
        "5 %",
        "50 %",
        "95 %"
    );
    for (place, (name, unit)) in QUANTITIES.into_iter().enumerate() {
        let values: Vec<f64> = all.iter().map(|result| result.values[place]).collect();
        let [low, middle, high] =
            [5.0, 50.0, 95.0].map(|at| percentile(&values, at).unwrap_or(f64::NAN));
        let name = format!("{name}, {unit}");
        let _infallible = writeln!(text, "{name:50} {low:8.2} {middle:8.2} {high:8.2}");
    }
    text
}
