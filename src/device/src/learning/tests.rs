//! Windows, answers and the skin's offset, without a station.

extern crate std;

use std::vec::Vec;

use contact_model::fixed_point::to_fixed;
use fixed::types::{I2F30, I4F28};
use thermal_learner::{Learner, WINDOW_TICKS};
use thermal_settings::FluxSensor;

use super::*;

const STATE: StateAtEnd = StateAtEnd {
    scaled_air_flux: Celsius::ZERO,
    resistance: None,
    ticks_since_landing: 0,
};

const CONTACT: TickOfContact = TickOfContact {
    skin_above_display: Celsius::lit("5"),
    is_steady: true,
};

/// A flux of 1000 W/m², with the least noise.
fn code(tick: u32) -> u16 {
    2048 + 119 + (tick % 2) as u16
}

fn learning() -> FingerLearning {
    FingerLearning::new(&FluxParameters::new(&FluxSensor::DESIGNED), Place::Air)
}

/// An answer to the last input with another finger than the mean one.
fn answer(input: &LearnerInput) -> LearnerOutput {
    let mean = Learner::new().advance(input);
    LearnerOutput {
        weights: [I2F30::lit("0.9"); 9],
        air_change: I4F28::lit("0.5"),
        skin_offset_k: Celsius::lit("-0.05"),
        resistance_factor: I4F28::lit("1.5"),
        ..mean
    }
}

/// A window, with or without a contact; what is applied at its end.
fn window(learning: &mut FingerLearning, contact: Option<TickOfContact>) -> Option<LearnerOutput> {
    for tick in 1..=WINDOW_TICKS {
        let flux = learning.reading.convert(code(tick));
        assert_eq!(learning.add_tick(flux, contact), tick == WINDOW_TICKS);
    }
    learning.end_window(&STATE)
}

/// A learner that has answered once, and whose answer is applied.
fn taught() -> FingerLearning {
    let mut learning = learning();
    assert_eq!(window(&mut learning, None), None);
    let input = learning.take_input().expect("an input");
    assert_eq!(learning.take_input(), None, "an input is there once");
    learning.put_output(&answer(&input));
    assert_eq!(window(&mut learning, Some(CONTACT)), Some(answer(&input)));
    learning
}

/// Ten landings, one in each tick of a window: the ticks of contact, their temperatures and fluxes all count once, and the
/// flux counts 25 ticks longer.
#[test]
fn a_landing_may_be_in_any_tick_of_a_window() {
    for landing in 0..WINDOW_TICKS {
        let (mut learning, mut first) = (learning(), None);
        let (mut touching, mut above_k, mut flux_w_m2) = (0, 0.0, 0.0);
        for tick in 0..8 * WINDOW_TICKS {
            let contact = (landing..landing + 32).contains(&tick).then_some(CONTACT);
            let flux = learning.reading.convert(code(tick));
            if !learning.add_tick(flux, contact) {
                continue;
            }
            learning.end_window(&STATE);
            let input = learning.take_input().expect("an input");
            flux_w_m2 += 10.0 * input.flux_w_m2.expect("a valid flux").to_num::<f64>();
            if let Some(contact) = input.contact {
                first = first.or(Some((input.sequence, u32::from(contact.touching_ticks))));
                touching += u32::from(contact.touching_ticks);
                above_k += 10.0 * contact.skin_above_display_k.to_num::<f64>();
            }
        }
        assert_eq!(first, Some((1, WINDOW_TICKS - landing)));
        assert_eq!(touching, 32);
        assert!((above_k - 5.0 * 32.0).abs() < 1e-4, "{above_k}");
        // Half of the codes are 119, the others 120 counts above the zero.
        let ticks = f64::from(32 + 25);
        let exact_w_m2 = ticks * 119.5 / FluxSensor::DESIGNED.counts_per_w_m2;
        assert!((flux_w_m2 / exact_w_m2 - 1.0).abs() < 5e-3, "{flux_w_m2}");
    }
}

#[test]
fn the_same_finger_is_applied_once() {
    let mut learning = taught();
    let input = learning.take_input().expect("an input");
    learning.put_output(&answer(&input));
    assert_eq!(window(&mut learning, Some(CONTACT)), None);
    let trust = answer(&input).trust;
    assert_eq!(learning.knowledge(), FingerKnowledge::Learnt(trust));
}

/// A weight that falls by a quarter of the tolerance a window: the answers before it differs by more are not applied, and none of
/// its way is lost.
#[test]
fn a_finger_that_drifts_is_applied_when_it_has_moved_enough() {
    let mut learning = taught();
    let drift = I2F30::lit("0x.0008");
    let mut applied = Vec::new();
    for number in 1..=15 {
        let input = learning.take_input().expect("an input");
        let mut drifted = answer(&input);
        drifted.weights[3] -= number * drift;
        learning.put_output(&drifted);
        if let Some(now) = window(&mut learning, Some(CONTACT)) {
            assert_eq!(now, drifted);
            applied.push(number);
        }
    }
    assert_eq!(applied, [5, 10, 15]);
}

#[test]
fn a_missing_answer_and_one_for_another_window_end_in_the_mean_finger() {
    for earlier in [None, Some(1), Some(u16::MAX)] {
        let mut learning = taught();
        let before = answer(&learning.take_input().expect("an input"));
        if let Some(earlier) = earlier {
            let sequence = before.sequence.wrapping_sub(earlier);
            learning.put_output(&LearnerOutput { sequence, ..before });
        }
        let mut last = None;
        for number in 0..80 {
            if let Some(input) = learning.take_input() {
                let answer = answer(&input);
                match earlier {
                    Some(earlier) => learning.put_output(&LearnerOutput {
                        sequence: input.sequence.wrapping_sub(earlier),
                        ..answer
                    }),
                    // After one that is missing, even those in time change nothing in this contact.
                    None if number > 5 => learning.put_output(&answer),
                    None => {}
                }
            }
            last = window(&mut learning, Some(CONTACT)).or(last);
            assert_eq!(learning.knowledge(), FingerKnowledge::Late);
            let now = last.expect("a finger nearer to the mean one");
            let share = |now: f64, before: f64| now / before;
            let left = share(now.air_change.to_num(), before.air_change.to_num());
            assert!((left - 0.75f64.powi(number + 1)).abs() < 1e-6, "{left}");
        }
        let last = last.expect("a finger");
        assert!(
            last.weights
                .iter()
                .all(|weight| weight.abs_diff(I2F30::ONE) < 4)
        );
        assert!(last.resistance_factor.abs_diff(I4F28::ONE) < 4);
        assert!(last.skin_offset_k.unsigned_abs() < 4);
        // After the contact the learner is believed again.
        let input = learning.take_input().expect("an input");
        learning.put_output(&answer(&input));
        assert_eq!(window(&mut learning, None), Some(answer(&input)));
        let trust = answer(&input).trust;
        assert_eq!(learning.knowledge(), FingerKnowledge::Learnt(trust));
    }
}

#[test]
fn an_answer_from_before_a_restart_is_void_and_nothing_is_late() {
    let mut learning = taught();
    let input = learning.take_input().expect("an input");
    learning.restart(Place::Pad, None);
    learning.put_output(&answer(&input));
    assert_eq!(window(&mut learning, Some(CONTACT)), None);
    assert_eq!(
        learning.knowledge(),
        FingerKnowledge::Learnt(Trust::Learning)
    );
    let input = learning.take_input().expect("an input");
    let place = input.restart.map(|restart| restart.place);
    assert_eq!(place, Some(Place::Pad));
}

#[test]
fn a_window_with_a_flux_that_is_not_valid_has_none_and_is_a_fault() {
    let mut learning = taught();
    let input = learning.take_input().expect("an input");
    learning.put_output(&answer(&input));
    for tick in 0..60 {
        learning.reading.convert(4094 + tick % 2);
    }
    for _ in 1..WINDOW_TICKS {
        learning.add_tick(Some(Flux::ONE), Some(CONTACT));
    }
    assert!(learning.add_tick(None, Some(CONTACT)));
    learning.end_window(&STATE);
    assert_eq!(learning.knowledge(), FingerKnowledge::SensorFault);
    let input = learning.take_input().expect("an input");
    assert_eq!(input.flux_w_m2, None);
}

/// A steady flux: the sensor's difference from the model, at once where both have lagged alike, and nothing without contact.
#[test]
fn the_flux_beyond_the_model_is_a_slow_difference() {
    let mut learning = learning();
    let modelled = FluxPerMm2::lit("0.001");
    let mut beyond = FluxPerMm2::ZERO;
    for tick in 0..100 {
        // 119 or 120 counts: 998 or 1007 W/m².
        learning.take(code(tick), None);
        beyond = learning.flux_beyond_model(Some(modelled + FluxPerMm2::lit("0.0005")));
    }
    assert!(
        (beyond + FluxPerMm2::lit("0.0005")).abs() < 1e-5,
        "{beyond}"
    );
    learning.take(code(0), None);
    assert_eq!(learning.flux_beyond_model(None), FluxPerMm2::ZERO);
    // A jump of the model reaches the difference with the sensor's lag of 5 ms.
    for tick in 0..5 {
        learning.take(code(tick), None);
        beyond = learning.flux_beyond_model(Some(modelled));
    }
    let lagged = modelled.to_num::<f64>() * (1.0 - (-1f64).exp());
    let expected = 0.001 - lagged;
    assert!((beyond.to_num::<f64>() - expected).abs() < 5e-5, "{beyond}");
}

/// Filtered as the skin's estimate is, with an offset that changes while nothing touches: the estimate goes to the reading
/// plus the offset, and what the learner is given is the reading.
#[test]
fn the_filtered_skin_follows_reading_and_offset() {
    let mut learning = taught();
    let reading: Celsius = to_fixed(34.0);
    let mut skin = reading;
    for (offset, ticks) in [(-0.05, 4000), (0.2, 4000), (0.0, 4000)] {
        learning.skin_offset = to_fixed(offset);
        for _ in 0..ticks {
            skin = skin.saturating_add(filter_change(reading.saturating_sub(skin)));
            skin = skin.saturating_add(learning.skin_change(true, true));
            let apart = learning.skin_without_offset(skin) - reading;
            assert!(apart.abs() < 1e-4, "{apart} K from the reading");
        }
        let apart = skin.to_num::<f64>() - 34.0 - offset;
        assert!(apart.abs() < 1e-4, "{apart} K from reading and offset");
    }
    // In a contact the filter rests.
    learning.skin_offset = to_fixed(0.1);
    assert_eq!(learning.skin_change(true, false), Celsius::ZERO);
    let change = learning.adopt_skin_offset(to_fixed(0.1), true);
    assert!((change - Celsius::lit("0.1")).abs() < 1e-4);
}
