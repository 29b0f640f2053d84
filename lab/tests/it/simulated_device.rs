//! Every command of the client, on the device's own parser and logic.

use std::time::Duration;

use contact_model::impedance::{Impedance, Relaxation};
use contact_model::material::find;
use contact_model::slab::Back;
use thermal_device::StateName;
use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;
use thermal_device::safety::ThermistorId;
use thermal_lab::client::{
    Calibrate, Client, ClientError, Command, CountSettings, DeviceRequest, PointOrClear,
    QueryAssumedFinger, QueryBoard, QueryCause, QueryFlux, QueryIdentity, QueryLaw, QueryMargins,
    QueryRaw, QuerySelfTest, QuerySetting, QueryState, QueryTriggerPulse, SessionRequest,
    StationRequest, upload,
};
use thermal_lab::commissioning::{arm, clear_calibration};
use thermal_lab::link::{Link, SimulatedLink};
use thermal_plant::Params;
use thermal_settings::FluxSensor;
use thermal_sim::commissioning::CommissioningSetup;
use thermal_sim::engine::NativeEngine;

pub fn device() -> NativeEngine {
    let setup = CommissioningSetup::new(&Params::nominal(), 24.0, 1);
    NativeEngine::new(setup.in_use().expect("a plant"))
}

/// The orders that the device refuses, with its answers.
fn refusals<L: Link>(
    client: &mut Client<L>,
    orders: &[impl Command<Answer = ()>],
) -> Vec<(String, ClientError)> {
    let refused = |order: &_| Some((ToString::to_string(order), client.ask(order).err()?));
    orders.iter().filter_map(refused).collect()
}

#[test]
fn the_device_takes_every_order_in_the_form_that_the_client_writes() {
    let mut engine = device();
    let mut client = Client::new(SimulatedLink::new(&mut engine));
    client.wait(Duration::from_millis(600)).unwrap();
    let copper = *find("copper").expect("copper");
    let setting = client.ask(&QuerySetting { number: 3.into() }).unwrap();
    let relaxations = [Relaxation { rate_1_s: 2.0, gain_m2k_j: 4e-5 }];
    let object = Impedance { direct_m2k_w: 5e-7, relaxations: &relaxations };
    let mut refused = refusals(
        &mut client,
        &[
            StationRequest::material("oak"),
            StationRequest::material("granite"),
            StationRequest::custom_material(&copper),
            StationRequest::object_temperature(Some(-3.25)),
            StationRequest::object_temperature(None),
            StationRequest::HalfSpace,
            StationRequest::slab(2.5, Back::Film(12.5)),
            StationRequest::slab(3.0, Back::Held),
            StationRequest::slab(4.0, Back::Insulated),
            StationRequest::Finger { finger: AssumedFinger::MeanOnPad },
            StationRequest::Mode { model: ContactModel::SemiInfinite },
            StationRequest::Law { law: Law::Pi10Hz },
            StationRequest::stream(7),
            StationRequest::stream(0),
        ],
    );
    let checksums = [true, false].map(|on| DeviceRequest::Checksum { switch: on.into() });
    refused.extend(refusals(&mut client, &checksums));
    let (thermistor, point) = (ThermistorId::Check, PointOrClear::Clear);
    refused.extend(refusals(
        &mut client,
        &[
            SessionRequest::Set { setting: setting.setting().clone() },
            SessionRequest::Calibrate { thermistor, point },
            SessionRequest::flux_sensor(None),
            SessionRequest::flux_sensor(Some(FluxSensor::DESIGNED)),
        ],
    ));
    refused.extend(refusals(&mut client, &upload(&object)));
    // The only one that no device knows.
    assert_eq!(refused.len(), 1, "{refused:?}");
    assert!(refused[0].1.refusal().unwrap().starts_with("unknown material 'oak'"));
    let status = client.ask(&QueryState).unwrap();
    assert_eq!(status.state, StateName::Off);
    assert_eq!(status.material.as_deref(), Some("custom"));
    assert_eq!((status.mode, status.body.as_str()), (ContactModel::SemiInfinite, "upload"));
    assert_eq!(client.ask(&QueryLaw).unwrap().law, Law::Pi10Hz);
    assert_eq!(client.ask(&QueryAssumedFinger).unwrap().finger, AssumedFinger::MeanOnPad);
    assert_eq!(client.ask(&QueryTriggerPulse).unwrap().pulse_ms, 10);
    client.ask(&StationRequest::TriggerPulse { pulse_ms: 200.into() }).unwrap();
    assert_eq!(client.ask(&QueryTriggerPulse).unwrap().pulse_ms, 200);
    let too_long = client.ask(&StationRequest::TriggerPulse { pulse_ms: 201.into() }).unwrap_err();
    assert!(too_long.refusal().unwrap().starts_with("pulse '201' out of range; 1 to 200 ms"));
    assert_eq!(client.ask(&QueryCause).unwrap(), None);
    // The board has no sensor.
    client.wait(Duration::from_millis(600)).unwrap();
    let refused = client.ask(&SessionRequest::FluxZero).unwrap_err();
    assert!(refused.refusal().unwrap().contains("look at its wires"));
    let flux = client.ask(&QueryFlux).unwrap().unwrap();
    let json = r#"{"counts_per_w_m2":0.1192,"zero_counts":2048.0,"lag_ms":5.0,"resistance_mm2k_w":30.0,"w_m2":null,"finger":"sensor-range"}"#;
    assert_eq!(serde_json::to_string(&flux).unwrap(), json);
    arm(&mut client, None).unwrap();
    client.ask(&StationRequest::Start).unwrap();
    client.ask(&StationRequest::Arm).unwrap();
    client.ask(&StationRequest::hold(30.0, None)).unwrap();
    client.ask(&StationRequest::Tune).unwrap();
    client.ask(&StationRequest::Abort).unwrap();
    let refused = client.ask(&StationRequest::Clear).unwrap_err();
    assert_eq!(refused.refusal(), Some("no fault to clear"));
    let point =
        Calibrate { thermistor: ThermistorId::Room, point: PointOrClear::Point(24.0.into()) };
    client.wait(Duration::from_millis(600)).unwrap();
    let fit = client.ask(&point).unwrap();
    assert_eq!(fit.points, 1);
    clear_calibration(&mut client, None).unwrap();
    assert_eq!(client.ask(&point).unwrap().points, 1);
    let lines = client.ask(&CountSettings).unwrap().lines as usize;
    let before: Vec<_> =
        (1..=lines).map(|n| client.ask(&QuerySetting { number: n.into() }).unwrap()).collect();
    client.ask(&DeviceRequest::Save).unwrap();
    let after: Vec<_> =
        (1..=lines).map(|n| client.ask(&QuerySetting { number: n.into() }).unwrap()).collect();
    assert_eq!(before, after);
    client.ask(&DeviceRequest::ForgetAll).unwrap();
    assert!((client.ask(&QueryMargins).unwrap().gain_k_s_a - 2.957).abs() < 1e-9);
}

#[test]
fn what_the_device_says_it_can_do_it_does() {
    let mut engine = device();
    let mut client = Client::attach(SimulatedLink::new(&mut engine)).unwrap();
    let identity = client.ask(&QueryIdentity).unwrap();
    assert_eq!((identity.fingers, identity.tick_hz), (1, 1000));
    assert_eq!(identity.protocol, Some(1));
    if identity.can("self-test") {
        client.ask(&QuerySelfTest).unwrap();
    }
    if identity.can("raw") {
        let raw = client.ask(&QueryRaw).unwrap();
        assert!(raw.display > 100.0 && raw.display < 4000.0, "{raw:?}");
    }
    if identity.can("board") {
        client.ask(&QueryBoard).unwrap();
    }
    if identity.can("flux") {
        assert_eq!(client.ask(&QueryFlux).unwrap(), None);
    }
}

/// Time of the device against that of its link, which in a simulation are the same but for the time on the line.
#[test]
fn telemetry_comes_at_its_interval_and_a_device_that_restarts_is_noticed() {
    let mut engine = device();
    let mut client = Client::new(SimulatedLink::new(&mut engine));
    client.wait(Duration::from_millis(100)).unwrap();
    client.ask(&StationRequest::stream(5)).unwrap();
    client.wait(Duration::from_secs(3)).unwrap();
    let mut last = None;
    while let Some(line) = client.next_telemetry(Duration::ZERO).unwrap() {
        let tick = line.telemetry.tick;
        assert!(last.is_none_or(|last| tick == last + 5), "{last:?}, {tick}");
        last = Some(tick);
    }
    let time = client.clock().time_of(last.unwrap()).unwrap();
    assert!((time.at_s - client.link().now().as_secs_f64()).abs() < 0.01, "{time:?}");
    assert!(time.error_s < 1.1e-3 && time.drift_ppm.abs() < 1.0, "{time:?}");
    client.ask(&DeviceRequest::ForgetAll).unwrap();
    client.ask(&StationRequest::stream(5)).unwrap();
    client.wait(Duration::from_millis(50)).unwrap();
    let line = client.next_telemetry(Duration::ZERO).unwrap().unwrap();
    assert!(line.telemetry.tick < 100, "{line:?}");
    assert_eq!((client.clock().restarts(), client.counts().lost), (1, 0));
}

/// Two minutes without any other line: the device would trip after two seconds.
#[test]
fn a_driven_device_whose_host_only_listens_does_not_trip() {
    let mut engine = device();
    let mut client = Client::new(SimulatedLink::new(&mut engine));
    client.wait(Duration::from_millis(500)).unwrap();
    arm(&mut client, None).unwrap();
    client.ask(&StationRequest::stream(1000)).unwrap();
    client.wait(Duration::from_secs(120)).unwrap();
    assert_eq!(client.ask(&QueryState).unwrap().state, StateName::Armed);
}
