//! What the self-test says of the heat-flux sensor.

use thermal_client::client::{QuerySelfTest, SessionRequest};
use thermal_client::commissioning::arm;
use thermal_device::learning::FluxSensorTest;
use thermal_plant::sensors::{FluxCircuit, FluxDefect, FluxParams};
use thermal_plant::{Defects, Params};
use thermal_settings::FluxSensor;
use thermal_sim::commissioning::CommissioningSetup;
use thermal_sim::engine::NativeEngine;

use super::{ROOM_C, bench, wait};

/// The test of a device that is told of the designed sensor, with a sink that is so much warmer than the room, K.
fn tested(
    flux: Option<FluxParams>,
    defect: FluxDefect,
    sink_k: f64,
    force_n: f64,
) -> Option<FluxSensorTest> {
    let mut params = Params { flux, ..Params::nominal() };
    params.tile.coolant_k = sink_k;
    let setup = CommissioningSetup::new(&params, ROOM_C, 1);
    let mut engine = NativeEngine::new(setup.in_use().expect("a plant"));
    let mut bench = bench(&mut engine, &[]);
    let world = bench.link().world();
    world.set_force_and_faults(force_n, std::iter::empty());
    world.set_plant_defects(Defects { flux: defect, ..Defects::default() });
    let sensor = SessionRequest::flux_sensor(Some(FluxSensor::DESIGNED));
    bench.ask(&sensor).expect("a sensor");
    wait(&mut bench, 100);
    arm(&mut bench, None).expect("armed: the sensor trips nothing");
    bench.ask(&QuerySelfTest).expect("a report").flux
}

#[test]
fn a_sensor_that_reads_what_it_cannot_is_named_and_trips_nothing() {
    let sound = FluxDefect::default();
    let circuit = |circuit| FluxDefect { circuit, ..sound };
    let zero = |zero_w_m2| FluxDefect { zero_w_m2, ..sound };
    let fitted = Some(FluxParams::NOMINAL);
    for (flux, defect, expected) in [
        (fitted, sound, FluxSensorTest::Passed),
        (fitted, zero(30.0), FluxSensorTest::Passed),
        (fitted, zero(-80.0), FluxSensorTest::Zero),
        (fitted, zero(80.0), FluxSensorTest::Zero),
        (fitted, circuit(FluxCircuit::Open), FluxSensorTest::Range),
        (fitted, FluxDefect { stuck: true, ..sound }, FluxSensorTest::Range),
        (None, sound, FluxSensorTest::Range),
        // Both read no flux, or as little as of the air: that is not tested.
        (fitted, circuit(FluxCircuit::Short), FluxSensorTest::Passed),
        (fitted, circuit(FluxCircuit::Reversed), FluxSensorTest::Passed),
    ] {
        assert_eq!(tested(flux, defect, 0.0, 0.0), Some(expected), "{defect:?}");
    }
}

#[test]
fn flux_of_the_air_and_of_a_finger_do_not_fail_the_test() {
    let fitted = Some(FluxParams::NOMINAL);
    for sink_k in [-8.0, 12.0] {
        let passed = tested(fitted, FluxDefect::default(), sink_k, 0.0);
        assert_eq!(passed, Some(FluxSensorTest::Passed), "{sink_k}");
    }
    let touched = tested(fitted, FluxDefect::default(), 0.0, 2.0);
    assert_eq!(touched, Some(FluxSensorTest::NotAtRest));
    let mut engine = NativeEngine::new(super::device(None, 1).in_use().expect("a plant"));
    let mut bench = bench(&mut engine, &[]);
    wait(&mut bench, 100);
    arm(&mut bench, None).expect("armed");
    assert_eq!(bench.ask(&QuerySelfTest).expect("a report").flux, None);
}
