//! A station with a flux sensor, whose finger is learnt.

use std::vec::Vec;

use contact_model::fixed_point::{Force, to_fixed};
use contact_model::material::{REFERENCE_DISPLAY, find};
use fixed::types::{I2F30, I4F28};
use thermal_learner::Learner;
use thermal_settings::{FluxSensor, Settings};

use super::*;
use crate::command::{ChosenMaterial, Command};
use crate::drive::Current;
use crate::learning::FingerKnowledge;
use crate::reference::Reference;
use crate::safety::ValidReadings;
use crate::sense::{Samples, SupplyVoltage};
use crate::station::State;

const LANDING_TICK: u32 = 23;

/// A station that presents granite to a mean finger.
fn station(flux_sensor: Option<FluxSensor>) -> Station {
    let mut station = Station::new(&Settings { flux_sensor, ..Settings::default() });
    let granite = find("granite").expect("granite");
    let granite = ChosenMaterial::new("granite", granite, &REFERENCE_DISPLAY).expect("a material");
    station.object.choose_material(&granite);
    station.object.choose_finger(AssumedFinger::Mean);
    station.state = State::Preset;
    station
}

/// A tick of a display that is where it shall be, under a finger that lands on it; the reference.
fn step(station: &mut Station, tick: u32, code: Option<u16>) -> Option<Reference> {
    if code.is_some() {
        station.note_flux_code(code);
    }
    if station.due != DueWork::default() {
        station.do_due_work();
    }
    let room = to_fixed(24.0);
    let before = station.last.reference.map(|reference| reference.setpoint.celsius());
    let display = before.unwrap_or(room);
    let readings = ValidReadings {
        display,
        check: display,
        sink: room,
        skin: to_fixed(34.0),
        room,
        force: if tick < LANDING_TICK { Force::ZERO } else { Force::lit("2") },
        current: Current::ZERO,
        supply: SupplyVoltage::default(),
    };
    let estimate = station.detect_touch_and_update_estimates(&Samples::default(), &readings);
    station.last.reference = station.reference_for_present_state(&estimate);
    station.last.reference
}

/// Some 5 kW/m² in contact.
fn code(tick: u32) -> Option<u16> {
    let contact = if tick < LANDING_TICK { 0 } else { 600 };
    Some(2048 + contact + (tick % 2) as u16)
}

/// An answer with another finger than the mean one.
fn answer(input: &LearnerInput) -> LearnerOutput {
    LearnerOutput {
        weights: [I2F30::lit("0.8"); 9],
        air_flux_deviation: I4F28::lit("0.5"),
        skin_offset_k: Celsius::lit("-0.05"),
        resistance_factor: I4F28::lit("1.5"),
        ..*Learner::new().advance(input)
    }
}

/// References of 400 ticks in which each input is answered after so many ticks; not at all without them.
fn references(after_ticks: Option<u32>) -> Vec<Option<Reference>> {
    let mut station = station(Some(FluxSensor::DESIGNED));
    let (mut asked, mut seen) = (None, Vec::new());
    for tick in 0..400 {
        seen.push(step(&mut station, tick, code(tick)));
        if let Some(input) = station.take_learner_input() {
            assert_eq!(tick % 10, 9, "an input at the end of a window");
            asked = Some((tick, input));
        }
        let is_due = |(at, _): &mut (u32, LearnerInput)| Some(tick - *at) == after_ticks;
        if let Some((_, input)) = asked.take_if(|asked| is_due(asked)) {
            station.put_learner_output(&answer(&input));
        }
    }
    seen
}

#[test]
fn the_learnt_finger_is_applied_at_the_next_windows_end_however_soon_it_was_there() {
    let at_once = references(Some(0));
    assert!(at_once == references(Some(9)), "an answer after nine ticks");
    let never = references(None);
    let first = at_once.iter().zip(&never).position(|(now, never)| now != never);
    // The first input is that of tick 9.
    assert_eq!(first, Some(19));
}

#[test]
fn without_answers_the_assumed_finger_stays_with_a_word() {
    let mut station = station(Some(FluxSensor::DESIGNED));
    for tick in 0..400 {
        step(&mut station, tick, code(tick));
        if let Some(input) = station.take_learner_input().filter(|_| tick < 100) {
            station.put_learner_output(&answer(&input));
            let factor = station.object.bodies().resistances.skin_factor;
            assert_eq!(factor, if tick < 19 { 1.0 } else { 1.5 }, "{tick}");
        }
    }
    let state = station.flux_state().expect("a sensor");
    assert_eq!(state.knowledge, FingerKnowledge::Late);
    let bodies = station.object.bodies();
    assert!((bodies.resistances.skin_factor - I4F28::ONE).abs() < 1e-3);
    let air = bodies.finger.air.abs_diff(AssumedFinger::Mean.body().air);
    assert!(air < AssumedFinger::Mean.body().air >> 9);
    let skin = station.estimator.finger.temperatures_before_contact();
    assert!((skin.expect("a skin").skin - Celsius::lit("34")).abs() < 1e-3);
}

#[test]
fn another_finger_is_assumed_at_once_and_learnt_from_the_next_window_on() {
    let mut station = station(Some(FluxSensor::DESIGNED));
    for tick in 0..60 {
        step(&mut station, tick, code(tick));
        if tick == 45 {
            let pad = Command::Finger(Some(AssumedFinger::MeanOnPad));
            assert!(station.execute(&pad).is_ok());
            assert_eq!(station.object.bodies().finger, *AssumedFinger::MeanOnPad.body());
        }
        if let Some(input) = station.take_learner_input() {
            let place = match tick {
                9 => Some(PlaceBeforeContact::Air),
                49 => Some(PlaceBeforeContact::Pad),
                _ => None,
            };
            let restarted = input.restart.map(|restart| restart.place);
            assert_eq!(restarted, place, "{tick}");
            station.put_learner_output(&answer(&input));
        }
        if tick == 58 {
            // The answer to the window that ended during the command is void.
            assert_eq!(station.object.bodies().resistances.skin_factor, I4F28::ONE);
        }
    }
    assert_eq!(station.object.bodies().resistances.skin_factor, 1.5);
}

#[test]
fn another_sensor_and_none_forget_the_learnt_finger() {
    let other = FluxSensor { resistance_mm2k_w: 60.0, ..FluxSensor::DESIGNED };
    for sensor in [Some(other), None] {
        let mut station = station(Some(FluxSensor::DESIGNED));
        let layer = |station: &Station| station.object.bodies().resistances.display_layer;
        let designed_layer = layer(&station);
        // e_skin = 1170 W s^0.5/(m2 K) times 3e-5 m2 K/W over the root of a tick.
        assert!((designed_layer.to_num::<f64>() - 1.110).abs() < 2e-3, "{designed_layer}");
        for tick in 0..30 {
            step(&mut station, tick, code(tick));
            if let Some(input) = station.take_learner_input() {
                station.put_learner_output(&answer(&input));
            }
        }
        assert_eq!(station.object.bodies().resistances.skin_factor, 1.5);
        let parameters = sensor.as_ref().map(FluxParameters::new);
        // Refused while an object is presented.
        let command = Command::FluxSensor(parameters);
        assert_eq!(station.execute(&command), Err(Refused::Presenting));
        station.state = State::Ready;
        assert!(station.execute(&command).is_ok());
        step(&mut station, 30, None);
        let bodies = station.object.bodies();
        assert_eq!(bodies.finger, *AssumedFinger::Mean.body());
        assert_eq!(bodies.resistances.skin_factor, I4F28::ONE);
        let ratio = layer(&station).to_num::<f64>() / designed_layer.to_num::<f64>();
        let expected = if sensor.is_some() { 2.0 } else { 0.0 };
        assert!((ratio - expected).abs() < 1e-4, "{ratio}");
        assert_eq!(station.has_flux_sensor(), sensor.is_some());
        let skin = station.estimator.finger.temperatures_before_contact();
        assert!((skin.expect("a skin").skin - Celsius::lit("34")).abs() < 1e-3);
    }
}

#[test]
fn codes_change_nothing_without_a_sensor() {
    let (mut with, mut without) = (station(None), station(None));
    for tick in 0..400 {
        assert_eq!(step(&mut with, tick, code(tick)), step(&mut without, tick, None));
        assert_eq!(with.estimator.finger, without.estimator.finger);
        assert_eq!(with.object.bodies(), without.object.bodies());
        assert_eq!(with.take_learner_input(), None);
        assert_eq!(with.flux_state(), None);
    }
}
