//! The finger's estimates while a skin is assumed, compared with those without an assumption.

extern crate std;

use contact_model::fixed_point::{FingerBody, to_fixed};
use contact_model::material::{REFERENCE_DISPLAY, SKIN, find};
use proptest::prelude::*;

use super::*;

const ROOM_C: f64 = 24.0;

/// Half-spaces, and the mean layered finger.
const FINGERS: [Bodies; 2] = [
    Bodies::HALF_SPACES,
    Bodies { finger: FingerBody::MEAN, are_half_spaces: false, ..Bodies::HALF_SPACES },
];

fn copper() -> ContactPair {
    let copper = find("copper").expect("copper");
    ContactPair::new(&SKIN, copper, &REFERENCE_DISPLAY, 1e-3).expect("a valid pair")
}

/// What a tick brings.
struct Inputs<'a> {
    bodies: &'a Bodies,
    skin: Celsius,
    surface: Celsius,
    touch: Option<Force>,
}

/// Updates the estimator by one tick; heat into the display, W.
fn step(estimator: &mut FingerEstimator, pair: &ContactPair, inputs: &Inputs<'_>) -> Watt {
    estimator.update_by_readings(inputs.skin, to_fixed(ROOM_C), inputs.touch, 5);
    estimator.step_skin_heat_flow(pair, inputs.bodies, inputs.surface)
}

fn before_contact(estimator: &FingerEstimator) -> Celsius {
    let before = estimator.temperatures_before_contact();
    before.expect("temperatures").skin
}

/// Two contacts with a display that goes from 42 °C to 30 °C, under a force that falls; before them the sensor's reading
/// rises.
#[test]
fn the_heat_into_the_display_is_that_of_the_sensed_skin_while_another_is_assumed() {
    let pair = copper();
    for bodies in &FINGERS {
        for assumed in [15.0, 42.0].map(to_fixed::<Celsius>) {
            let (mut sensed, mut estimator) =
                (FingerEstimator::default(), FingerEstimator::default());
            let (mut least, mut most) = (Watt::MAX, Watt::MIN);
            for tick in 0..12_000u32 {
                if tick == 100 {
                    estimator.assume_skin(Some(assumed));
                }
                let force_n = if tick < 5000 { 2.0 } else { 1.0 };
                let touches = (4000..7000).contains(&tick) || tick >= 8000;
                let inputs = Inputs {
                    bodies,
                    skin: to_fixed(33.0 + f64::from(tick.min(3500)) * 5e-4),
                    surface: to_fixed(42.0 - f64::from(tick) * 1e-3),
                    touch: touches.then_some(to_fixed(force_n)),
                };
                let heat = step(&mut sensed, &pair, &inputs);
                assert_eq!(step(&mut estimator, &pair, &inputs), heat, "tick {tick}");
                if tick >= 100 {
                    assert_eq!(before_contact(&estimator), assumed);
                }
                (least, most) = (least.min(heat), most.max(heat));
            }
            assert!(least < -0.2 && most > 0.2, "{least} to {most} W");
            let simulated = |estimator: &FingerEstimator| {
                let cooling = estimator.skin_state_on_display().free_response();
                before_contact(estimator) - cooling
            };
            let apart = (simulated(&estimator) - simulated(&sensed)).abs();
            assert!(apart > 1, "the assumed skin is {apart} K from the sensed one");
            estimator.assume_skin(None);
            assert_eq!(estimator, sensed);
        }
    }
}

#[derive(Clone, Debug)]
enum Event {
    Assume(Option<f64>),
    Invalidate,
    ChangeFinger,
    Ticks(f64, f64, Option<f64>, u32),
}

fn event() -> impl Strategy<Value = Event> {
    prop_oneof![
        2 => prop::option::weighted(0.8, 15.0..=42.0).prop_map(Event::Assume),
        1 => Just(Event::Invalidate),
        1 => Just(Event::ChangeFinger),
        8 => (10.0..45.0, 10.0..45.0, prop::option::of(0.01..5.0), 1..3000u32)
            .prop_map(|(skin_c, surface_c, force_n, ticks)| Event::Ticks(skin_c, surface_c, force_n, ticks)),
    ]
}

proptest! {
    /// At landing, after lifting, in a contact, after invalid readings and after another finger.
    #[test]
    fn assumptions_at_any_time_change_no_heat_and_leave_no_trace(events in prop::collection::vec(event(), 1..20)) {
        let pair = copper();
        let (mut sensed, mut estimator) = (FingerEstimator::default(), FingerEstimator::default());
        let (mut finger, mut assumed) = (0, None);
        for event in events {
            match event {
                Event::Assume(skin_c) => {
                    assumed = skin_c.map(to_fixed);
                    estimator.assume_skin(assumed);
                }
                Event::Invalidate => [&mut sensed, &mut estimator].into_iter().for_each(FingerEstimator::invalidate),
                Event::ChangeFinger => {
                    finger = 1 - finger;
                    [&mut sensed, &mut estimator].into_iter().for_each(FingerEstimator::forget_tissue_history);
                }
                Event::Ticks(skin_c, surface_c, force_n, ticks) => {
                    let inputs = Inputs {
                        bodies: &FINGERS[finger],
                        skin: to_fixed(skin_c),
                        surface: to_fixed(surface_c),
                        touch: force_n.map(to_fixed),
                    };
                    for _ in 0..ticks {
                        let heat = step(&mut sensed, &pair, &inputs);
                        prop_assert_eq!(step(&mut estimator, &pair, &inputs), heat);
                        let expected = assumed.unwrap_or_else(|| before_contact(&sensed));
                        prop_assert_eq!(before_contact(&estimator), expected);
                    }
                }
            }
        }
        estimator.assume_skin(None);
        prop_assert_eq!(estimator, sensed);
    }
}
