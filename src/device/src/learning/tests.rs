//! Windows, answers and the skin's offset, without a station.

extern crate std;

use std::vec::Vec;

use contact_model::fixed_point::Celsius;
use fixed::types::{I2F30, I4F28, U16F16};
use thermal_learner::{Learner, WINDOW_TICKS};
use thermal_settings::FluxSensor;

use super::*;

const STATE: StateAtEnd = StateAtEnd {
    skin: Some(Celsius::lit("34")),
    scaled_air_flux: Celsius::ZERO,
    resistance: None,
    ticks_since_landing: 0,
    is_steady: true,
    is_display_at_room: true,
};

/// A flux of 1000 W/m², with the least noise, into a display that is 5 K colder than the skin.
fn tick(number: u32, presses: bool) -> MeasuredTick {
    MeasuredTick {
        code: 2048 + 119 + (number % 2) as u16,
        surface: Celsius::lit("29"),
        modelled_flux: FluxPerMm2::ZERO,
        presses,
    }
}

fn learning() -> FingerLearning {
    FingerLearning::new(&FluxParameters::new(&FluxSensor::DESIGNED), PlaceBeforeContact::Air)
}

/// An answer to the last input with another finger than the mean one.
fn answer(input: &LearnerInput) -> LearnerOutput {
    let mean = *Learner::new().advance(input);
    LearnerOutput {
        weights: [I2F30::lit("0.9"); 9],
        air_flux_deviation: I4F28::lit("0.5"),
        skin_offset_k: Celsius::lit("-0.05"),
        resistance_factor: I4F28::lit("1.5"),
        revision: 7,
        ..mean
    }
}

/// A window, with or without a contact, that ends in this state; what is applied then.
fn window_to(
    learning: &mut FingerLearning,
    presses: bool,
    state: &StateAtEnd,
) -> Option<LearnerOutput> {
    for number in 1..=WINDOW_TICKS {
        let mut tick = tick(number, presses);
        tick.code = learning.note_code(Some(tick.code));
        assert_eq!(learning.add_tick(&tick), number == WINDOW_TICKS);
    }
    learning.end_window(state).copied()
}

fn window(learning: &mut FingerLearning, presses: bool) -> Option<LearnerOutput> {
    window_to(learning, presses, &STATE)
}

/// A learner that has answered once, and whose answer is applied.
fn taught() -> FingerLearning {
    let mut learning = learning();
    assert_eq!(window(&mut learning, false), None);
    let input = learning.take_input().expect("an input");
    assert_eq!(learning.take_input(), None, "an input is there once");
    learning.put_output(&answer(&input));
    assert_eq!(window(&mut learning, true), Some(answer(&input)));
    learning
}

/// Ten landings, one in each tick of a window: the ticks of contact count once, the flux from the window of the landing to the
/// second one after that of the lifting.
#[test]
fn a_landing_may_be_in_any_tick_of_a_window() {
    for landing in WINDOW_TICKS..2 * WINDOW_TICKS {
        let (mut learning, mut first) = (learning(), None);
        let (mut touching, mut above_k, mut with_flux) = (0, 0.0, Vec::new());
        for number in 0..9 * WINDOW_TICKS {
            let mut tick = tick(number, (landing..landing + 32).contains(&number));
            tick.code = learning.note_code(Some(tick.code));
            if !learning.add_tick(&tick) {
                continue;
            }
            learning.end_window(&STATE);
            let input = learning.take_input().expect("an input");
            let flux_w_m2: f64 = input.flux_w_m2.expect("a valid flux").to_num();
            if flux_w_m2 != 0.0 {
                with_flux.push(u32::from(input.sequence));
                // Half of the codes are 119, the others 120 counts above the zero.
                let exact_w_m2 = 119.5 / FluxSensor::DESIGNED.counts_per_w_m2;
                assert!((flux_w_m2 / exact_w_m2 - 1.0).abs() < 1e-5, "{flux_w_m2}");
            }
            if let Some(contact) = input.contact {
                first = first.or(Some((input.sequence, u32::from(contact.touching_ticks))));
                touching += u32::from(contact.touching_ticks);
                above_k += 10.0 * contact.skin_above_display_k.to_num::<f64>();
            }
        }
        assert_eq!(first, Some((2, 2 * WINDOW_TICKS - landing)));
        assert_eq!(touching, 32);
        assert!((above_k - 5.0 * 32.0).abs() < 1e-3, "{above_k}");
        let last = (landing + 31) / WINDOW_TICKS + 1;
        assert!(with_flux.into_iter().eq(2..=last + 2), "landing in {landing}");
    }
}

#[test]
fn the_same_finger_is_applied_once() {
    let mut learning = taught();
    let input = learning.take_input().expect("an input");
    learning.put_output(&answer(&input));
    assert_eq!(window(&mut learning, true), None);
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
        drifted.revision += number as u16;
        learning.put_output(&drifted);
        if let Some(now) = window(&mut learning, true) {
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
            last = window(&mut learning, true).or(last);
            assert_eq!(learning.knowledge(), FingerKnowledge::Late);
            let now = last.expect("a finger nearer to the mean one");
            let share = |now: f64, before: f64| now / before;
            let left = share(now.air_flux_deviation.to_num(), before.air_flux_deviation.to_num());
            assert!((left - 0.75f64.powi(number + 1)).abs() < 1e-6, "{left}");
        }
        let last = last.expect("a finger");
        assert!(last.weights.iter().all(|weight| weight.abs_diff(I2F30::ONE) < 4));
        assert!(last.resistance_factor.abs_diff(I4F28::ONE) < 4);
        assert!(last.skin_offset_k.unsigned_abs() < 4);
        // After the contact the learner is believed again.
        let input = learning.take_input().expect("an input");
        learning.put_output(&answer(&input));
        let now = window(&mut learning, false).expect("the learnt finger");
        assert_eq!(now.weights, answer(&input).weights);
        assert_eq!(now.resistance_factor, answer(&input).resistance_factor);
        let trust = answer(&input).trust;
        assert_eq!(learning.knowledge(), FingerKnowledge::Learnt(trust));
    }
}

#[test]
fn an_answer_from_before_a_restart_is_void_and_nothing_is_late() {
    let mut learning = taught();
    let input = learning.take_input().expect("an input");
    learning.restart(PlaceBeforeContact::Pad, None);
    learning.put_output(&LearnerOutput {
        weights: [I2F30::lit("1.1"); 9],
        trust: Trust::Trusted,
        revision: 8,
        ..answer(&input)
    });
    assert_eq!(window(&mut learning, true), None);
    assert_eq!(learning.knowledge(), FingerKnowledge::Learnt(Trust::Learning));
    let input = learning.take_input().expect("an input");
    let place = input.restart.map(|restart| restart.place);
    assert_eq!(place, Some(PlaceBeforeContact::Pad));
}

/// Its place and person must reach the learner, whatever windows it misses.
#[test]
fn a_restart_stays_until_the_learner_has_taken_it() {
    let mut learning = taught();
    learning.restart(PlaceBeforeContact::Pad, None);
    for _ in 0..3 {
        window(&mut learning, false);
    }
    let restart = |learning: &mut FingerLearning| learning.take_input().expect("an input").restart;
    assert_eq!(restart(&mut learning).map(|restart| restart.place), Some(PlaceBeforeContact::Pad));
    window(&mut learning, false);
    assert_eq!(restart(&mut learning), None);
}

/// The finger has been cooled before the learner looked, so that its skin is not what it was before contact.
#[test]
fn nothing_is_learnt_from_a_finger_that_rests_during_a_restart() {
    let mut learning = taught();
    learning.restart(PlaceBeforeContact::Air, None);
    let state = StateAtEnd { resistance: Some(U16F16::ONE), ..STATE };
    let mut is_steady = |presses| {
        window_to(&mut learning, presses, &state);
        let contact = learning.take_input().expect("an input").contact;
        contact.map(|contact| contact.is_steady)
    };
    for _ in 0..5 {
        assert_eq!(is_steady(true), Some(false));
    }
    assert_eq!(is_steady(false), None);
    assert_eq!(is_steady(true), Some(true));
}

/// Its steps are those of the learner, a quarter of the way in each window; several at once would be felt.
#[test]
fn the_way_to_the_mean_finger_is_applied_in_each_window_however_long_the_contact_is() {
    for (trust, applied) in
        [(Trust::Trusted, 2), (Trust::Mean(Distrust::Contact), 2 * u32::from(SELDOM_WINDOWS))]
    {
        let mut learning = taught();
        let state = StateAtEnd { ticks_since_landing: APPLIED_SELDOM_FROM_TICKS, ..STATE };
        let mut count = 0;
        for number in 1..=2 * SELDOM_WINDOWS {
            let input = learning.take_input().expect("an input");
            let mut next = answer(&input);
            (next.trust, next.revision) = (trust, next.revision + number);
            next.resistance_factor -= I4F28::lit("0.01") * i32::from(number);
            learning.put_output(&next);
            count += u32::from(window_to(&mut learning, true, &state).is_some());
        }
        assert_eq!(count, applied, "{trust:?}");
    }
}

#[test]
fn codes_that_cannot_be_right_give_no_flux_and_a_word() {
    for (code, windows, knowledge) in [
        (None, 1, FingerKnowledge::NoCode),
        // The first window has two ticks from before, and one is compared with that before it.
        (Some(4095), 6, FingerKnowledge::SensorFault),
        (Some(2048), 12, FingerKnowledge::SensorFault),
    ] {
        let mut learning = taught();
        for window in 1..=14 {
            let input = learning.take_input().expect("an input");
            learning.put_output(&answer(&input));
            for number in 1..=WINDOW_TICKS {
                // One missing code is enough.
                let code = code.or_else(|| (number != 3).then_some(2048 + number as u16));
                let code = learning.note_code(code);
                learning.add_tick(&MeasuredTick { code, ..tick(number, true) });
            }
            learning.end_window(&STATE);
            let is_fault = window >= windows;
            assert_eq!(learning.knowledge() == knowledge, is_fault, "{code:?}: {window}");
            assert_eq!(learning.flux().is_none(), is_fault);
            let input = learning.take_input().expect("an input");
            assert_eq!(input.flux_w_m2.is_none(), is_fault);
            learning.input = Some(input);
        }
        let _ = learning.take_input();
        window(&mut learning, false);
        assert!(learning.flux().is_some());
    }
}
