//! A display under a finger follows courses of the host; the campaign `cargo hil-sim tracking` has all of them.

use documented_figures::assert_figure;
use thermal_campaigns::tracking::{LimitCase, Stimulus, TouchingFinger, TrackingCase};
use thermal_sim::NativeRunner;

fn worst_mk(stimulus: &Stimulus, touch: TouchingFinger) -> f64 {
    let case = TrackingCase::nominal(stimulus, touch, 0.1);
    let result = case.run(&NativeRunner).expect("follows it");
    println!(
        "{}, {}: {:.1} mK at {:.2} s",
        stimulus.name,
        touch.name(),
        result.worst_mk,
        result.worst_t_s
    );
    result.worst_mk
}

/// The ramp of 1 K/s passes the voltages that no duty cycle gives.
#[test]
fn ramps_of_1_and_5_k_s_are_followed_under_a_finger() {
    for (rate_k_s, figure) in [(1.0, "tracking.ramp_1"), (5.0, "tracking.ramp_5")] {
        let ramp = Stimulus::ramp(rate_k_s);
        assert_figure(figure, worst_mk(&ramp, TouchingFinger::Thesis));
    }
}

#[test]
fn a_course_that_turns_often_is_missed_by_more_at_its_corners() {
    for (rate_k_s, figure) in [(4.0, "tracking.triangles_4"), (6.0, "tracking.triangles_6")] {
        let triangles = Stimulus::triangles(3.0, rate_k_s);
        assert_figure(figure, worst_mk(&triangles, TouchingFinger::Thesis));
    }
}

#[test]
fn a_step_is_overshot_little() {
    assert_figure("tracking.step_10", worst_mk(&Stimulus::step(10.0), TouchingFinger::Thesis));
}

#[test]
fn a_tile_at_25_c_heats_faster_than_it_cools() {
    let case = LimitCase { touch: TouchingFinger::Thesis, coolant_c: 25.0 };
    let limits = case.run(&NativeRunner).expect("reaches both ends");
    assert_figure("tracking.heating", limits.heating_k_s);
    assert_figure("tracking.cooling", limits.cooling_k_s);
}
