//! A device commissioned by the simulated operator, against the truth of its plant.

mod aborts;
mod accuracy;
mod margins;
mod restore;
mod tile;

use thermal_plant::{HostParams, Params, parameters};
use thermal_sim::World;
use thermal_sim::commissioning::{CommissioningBench, CommissioningSetup};
use thermal_sim::engine::NativeEngine;

/// Room in which the devices are used, deg C.
const ROOM_C: f64 = 24.0;

/// A reference thermometer without error but its resolution.
const PERFECT: HostParams = HostParams {
    reference_offset_k: 0.0,
    reference_noise_k: 0.0,
};

/// A device of the box; the nominal one for no draw. The reference thermometer is perfect.
fn device(draw: Option<u64>, seed: u64) -> CommissioningSetup {
    let mut params = Params::nominal();
    if let Some(draw) = draw {
        parameters::draw(&mut params, draw);
    }
    params.host = PERFECT;
    CommissioningSetup::new(&params, ROOM_C, seed)
}

/// A bench with a device on it that has these settings.
fn bench<'a>(
    engine: &'a mut NativeEngine,
    settings: &[String],
) -> CommissioningBench<'a, NativeEngine> {
    let mut bench = CommissioningBench::new(engine, PERFECT, 1);
    for line in settings {
        bench.command(line).expect("its own settings");
    }
    bench
}

/// Mean of a field of telemetry over so many milliseconds, and of a truth.
fn mean(
    bench: &mut CommissioningBench<'_, NativeEngine>,
    field: usize,
    ms: u64,
    truth: impl Fn(&World) -> f64,
) -> (f64, f64) {
    bench.command("stream 1").expect("telemetry");
    let (mut read, mut true_c) = (Vec::new(), 0.0);
    for _ in 0..ms {
        let lines = bench.run_1_ms(None).expect("the device runs");
        true_c += truth(bench.world());
        read.extend(lines.iter().filter_map(|line| {
            let word = line.strip_prefix("T ")?.split(' ').nth(field - 1)?;
            word.parse::<f64>().ok()
        }));
    }
    bench.command("stream 0").expect("no telemetry");
    assert!(read.len() as u64 > ms / 2, "telemetry of every tick");
    (
        read.iter().sum::<f64>() / read.len() as f64,
        true_c / ms as f64,
    )
}
