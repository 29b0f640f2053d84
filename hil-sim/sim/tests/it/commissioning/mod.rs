//! A device commissioned by the simulated operator, against the truth of its plant.

mod aborts;
mod accuracy;
mod flux_self_test;
mod margins;
mod phantom;
mod restore;
mod shipped;
mod tile;

use std::time::Duration;

use thermal_client::client::{Client, StationRequest, Telemetry};
use thermal_plant::{HostParams, Params, parameters};
use thermal_sim::World;
use thermal_sim::commissioning::CommissioningSetup;
use thermal_sim::engine::NativeEngine;
use thermal_sim::simulated_link::SimulatedLink;

/// A client of a simulated device.
type Bench<'a> = Client<SimulatedLink<'a, NativeEngine>>;

/// Room in which the devices are used, deg C.
const ROOM_C: f64 = 24.0;

/// A reference thermometer without error but its resolution.
const PERFECT: HostParams = HostParams { reference_offset_k: 0.0, reference_noise_k: 0.0 };

/// A device of the box; the nominal one for no draw. The reference thermometer is perfect.
fn device(draw: Option<u64>, seed: u64) -> CommissioningSetup {
    let mut params = Params::nominal();
    if let Some(draw) = draw {
        parameters::draw(&mut params, draw);
    }
    params.host = PERFECT;
    CommissioningSetup::new(&params, ROOM_C, seed)
}

/// A client of a device that has these settings.
fn bench<'a>(engine: &'a mut NativeEngine, settings: &[String]) -> Bench<'a> {
    let mut bench = Client::new(SimulatedLink::new(engine));
    for line in settings {
        bench.command(line).expect("its own settings");
    }
    bench
}

/// Runs the device for some milliseconds.
fn wait(bench: &mut Bench<'_>, ms: u64) {
    bench.wait(Duration::from_millis(ms)).expect("it runs");
}

/// Mean of a field of telemetry over so many milliseconds, and of a truth.
fn mean(
    bench: &mut Bench<'_>,
    field: impl Fn(&Telemetry) -> Option<f64>,
    ms: u64,
    truth: impl Fn(&World) -> f64,
) -> (f64, f64) {
    bench.ask(&StationRequest::stream(1)).expect("telemetry");
    let (mut read, mut true_c) = (Vec::new(), 0.0);
    for _ in 0..ms {
        wait(bench, 1);
        true_c += truth(bench.link().world());
        while let Some(line) = bench.next_telemetry(Duration::ZERO).expect("it runs") {
            read.extend(field(&line.telemetry));
        }
    }
    bench.ask(&StationRequest::stream(0)).expect("no telemetry");
    assert!(read.len() as u64 > ms / 2, "telemetry of every tick");
    (read.iter().sum::<f64>() / read.len() as f64, true_c / ms as f64)
}
