//! The heat-flux sensor, calibrated by the simulated operator's phantom.

use documented_figures::{assert_sampled, one_case_in};
use thermal_client::client::{Client, QueryFlux, QueryState, SessionRequest};
use thermal_client::commissioning::{
    CommissionError, CommissioningEvent, FluxCalibration, PhantomPlace, Surroundings,
    SurroundingsError, SurroundingsRequest, calibrate_flux,
};
use thermal_device::StateName;
use thermal_device::safety::ThermistorId;
use thermal_plant::parameters::{self, Tolerance, relative};
use thermal_plant::sensors::{FluxCircuit, FluxDefect, FluxParams};
use thermal_plant::{Defects, Params};
use thermal_settings::FluxSensor;
use thermal_sim::commissioning::{
    CommissioningSetup, SimulatedPhantom, SimulatedSurroundings, settings_for_device,
};
use thermal_sim::engine::NativeEngine;
use thermal_sim::simulated_link::SimulatedLink;

use super::ROOM_C;

/// Gain of a sensor that nobody has calibrated: layer, thermopile and resistors, one standard deviation of 6 %.
const UNCALIBRATED: Tolerance = relative(0.12).normal();

type Link<'a> = SimulatedLink<'a, NativeEngine>;

/// An operator who moves a phantom, and what is wrong.
struct Bench {
    surroundings: SimulatedSurroundings,
    defect: FluxDefect,
    /// Whether the phantom is really put on.
    puts_on: bool,
}

impl<'a> Surroundings<Link<'a>> for Bench {
    fn reference_c(
        &mut self,
        _client: &mut Client<Link<'a>>,
        _thermistor: ThermistorId,
    ) -> Result<f64, SurroundingsError> {
        Err(SurroundingsError::Failed("no thermometer".into()))
    }

    fn put_into_bath(
        &mut self,
        _client: &mut Client<Link<'a>>,
        _thermistor: ThermistorId,
        _bath_c: f64,
    ) -> Result<(), SurroundingsError> {
        Err(SurroundingsError::Failed("no bath".into()))
    }

    fn move_phantom(
        &mut self,
        client: &mut Client<Link<'a>>,
        place: PhantomPlace,
    ) -> Result<(), SurroundingsError> {
        let world = client.link().world();
        if place != PhantomPlace::OnDisplay || self.puts_on {
            let moved = self.surroundings.move_phantom(world, place);
            moved.map_err(|error| SurroundingsError::Failed(error.to_string()))?;
        }
        world.set_plant_defects(Defects { flux: self.defect, ..Defects::default() });
        Ok(())
    }

    fn reads_again(&mut self, _why: &str) -> bool {
        false
    }

    fn notice(&mut self, _event: &CommissioningEvent) {}
}

/// A drawn device with a drawn sensor that nobody has calibrated.
fn device(draw: u64) -> Params {
    let mut params = Params { flux: Some(FluxParams::NOMINAL), ..Params::nominal() };
    parameters::draw(&mut params, draw);
    if let Some(flux) = &mut params.flux {
        flux.gain_error = UNCALIBRATED.draw(1.0, draw, "uncalibrated") - 1.0;
    }
    params
}

/// The gel of the table, without an error.
fn gel() -> SimulatedPhantom {
    SimulatedPhantom {
        effusivity: 1585.0 + 1.95 * (ROOM_C - 25.0),
        resistance_factor: 0.2,
        above_room_k: 0.0,
    }
}

/// Calibrates a sensor of a device that is commissioned otherwise. After a failure its settings are those of before, and the bridge
/// is off.
fn calibrated(
    params: &Params,
    seed: u64,
    phantom: SimulatedPhantom,
    (defect, puts_on): (FluxDefect, bool),
) -> Result<FluxCalibration, CommissionError> {
    let settings = settings_for_device(params, ROOM_C, seed).expect("a commissioned device");
    let setup = CommissioningSetup::new(params, ROOM_C, seed);
    let mut engine = NativeEngine::new(setup.in_use().expect("a plant"));
    let mut client = Client::new(SimulatedLink::new(&mut engine));
    for line in &settings {
        client.command(line).expect("its own settings");
    }
    let designed = SessionRequest::flux_sensor(Some(FluxSensor::DESIGNED));
    client.ask(&designed).expect("a sensor");
    let mut bench = Bench {
        surroundings: SimulatedSurroundings::new(&setup).with_phantom(phantom),
        defect,
        puts_on,
    };
    let found = calibrate_flux(&mut client, None, &mut bench);
    let state = client.ask(&QueryState).expect("a state").state;
    let report = client.ask(&QueryFlux).expect("an answer");
    let set = report.expect("a sensor").sensor;
    match &found {
        Ok(found) => assert_eq!(set.counts_per_w_m2, found.counts_per_w_m2),
        Err(_) => assert_eq!(set, FluxSensor::DESIGNED),
    }
    assert!(
        matches!(state, StateName::Ready | StateName::Off) || state.fault().is_some(),
        "{state:?}"
    );
    found
}

const SOUND: (FluxDefect, bool) = (
    FluxDefect {
        circuit: FluxCircuit::Closed,
        stuck: false,
        gain: 1.0,
        zero_w_m2: 0.0,
        noise: 1.0,
    },
    true,
);

#[test]
fn gains_of_drawn_sensors_are_found_within_what_is_stated() {
    const DEVICES: u64 = 12;
    /// Of these, the suite takes one in so many.
    const ONE_IN: usize = 3;
    let (mut by_fit, mut by_gel, mut stated) = (Vec::new(), Vec::new(), Vec::new());
    for draw in (0..DEVICES).step_by(one_case_in(ONE_IN)) {
        let params = device(draw);
        let flux = params.flux.as_ref().expect("a sensor");
        let gain = (1.0 + flux.gain_error) * flux.counts_per_w_m2;
        let drawn = SimulatedPhantom::gel(draw, ROOM_C);
        let exact = SimulatedPhantom { effusivity: gel().effusivity, ..drawn };
        for (phantom, errors) in [(exact, &mut by_fit), (drawn, &mut by_gel)] {
            let found = calibrated(&params, draw, phantom, SOUND).expect("a calibration");
            let error = 100.0 * (found.counts_per_w_m2 / gain - 1.0);
            println!("{draw}: gain {gain:.4}, {error:+.2} % off; {found}");
            errors.push(error);
            stated.push(found.gain_error_percent);
        }
    }
    let rms =
        |all: &[f64]| (all.iter().map(|one| one * one).sum::<f64>() / all.len() as f64).sqrt();
    let worst = |all: &[f64]| all.iter().fold(0.0, |worst: f64, one| worst.max(one.abs()));
    assert_sampled("flux-phantom.fit", rms(&by_fit));
    assert_sampled("flux-phantom.fit_worst", worst(&by_fit));
    assert_sampled("flux-phantom.gain", rms(&by_gel));
    assert_sampled("flux-phantom.gain_worst", worst(&by_gel));
    // The stated deviation is that of the errors: neither half nor twice.
    assert!((0.5..2.0).contains(&(rms(&stated) / rms(&by_gel))), "{stated:?}");
}

#[test]
fn lines_that_move_the_phantom_are_read_as_they_are_written() {
    for (_, place) in PhantomPlace::WORDS {
        let request = SurroundingsRequest::Phantom(place);
        assert_eq!(request.to_string().parse(), Ok(request));
    }
    let error = "phantom under".parse::<SurroundingsRequest>();
    assert_eq!(error, Err("unknown place 'under'; known: beside on away".into()));
}

#[test]
fn what_cannot_be_right_is_refused_and_changes_nothing() {
    let params = device(4);
    let refused = |phantom: SimulatedPhantom, bench, why: &str| {
        let error = calibrated(&params, 4, phantom, bench).expect_err(why).to_string();
        println!("{error}");
        assert!(error.contains(why), "{error}");
    };
    let with = |defect: FluxDefect| (defect, true);
    refused(gel(), (SOUND.0, false), "the phantom presses with 0.0");
    // Acrylic glass, and marble.
    for (effusivity, why) in [(573.0, "of the designed one"), (2400.0, "of the designed one")] {
        let phantom = SimulatedPhantom { effusivity, ..gel() };
        refused(phantom, SOUND, why);
    }
    let warm = SimulatedPhantom { above_room_k: 0.6, ..gel() };
    refused(warm, SOUND, "the phantom had 24.");
    // A finger's skin, or a foil between.
    let rough = SimulatedPhantom { resistance_factor: 1.5, ..gel() };
    refused(rough, SOUND, "the contact of the phantom has");
    let circuit = |circuit| with(FluxDefect { circuit, ..SOUND.0 });
    refused(
        gel(),
        circuit(FluxCircuit::Open),
        "the heat-flux sensor has no code, or one at a rail",
    );
    refused(gel(), circuit(FluxCircuit::Short), "heat-flux sensor: ");
    refused(gel(), circuit(FluxCircuit::Reversed), "of the designed one");
    refused(gel(), with(FluxDefect { stuck: true, ..SOUND.0 }), "does not change");
    refused(gel(), with(FluxDefect { gain: 0.5, ..SOUND.0 }), "of the designed one");
}
