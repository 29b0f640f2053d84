//! The feed-forward of the voltage against the plant's bridge, which computes the mean current of a PWM period from inductor,
//! diodes and dead times.

use contact_model::fixed_point::Celsius;
use documented_figures::assert_figure;
use thermal_display::device::PWM_PERIOD_STEPS_OF_ONE_FINGER;
use thermal_display::device::control::VoltageFeedforward;
use thermal_display::device::drive::{Current, SafeCurrent};
use thermal_display::device::estimate::LegTemperatures;
use thermal_display::settings::Settings;
use thermal_plant::STEP_S;
use thermal_plant::bridge::{Bridge, BridgeOutputs, BridgeParams, Leg, Load};

/// Ticks over which the current is averaged: ticks with and without pulses may take turns.
const TICKS: u32 = 100;

/// Mean current, A, of the ticks in which `current_a` is demanded of a module with this Seebeck voltage.
fn mean_current_a(current_a: f64, seebeck_v: f64) -> f64 {
    let module = Settings::default().module;
    let mut voltage = VoltageFeedforward::new(&module);
    let mut bridge = Bridge::new(BridgeParams::NOMINAL, module.legs_ohm);
    let half = Celsius::from_num(0.5 * seebeck_v / module.seebeck_v_k);
    let mean = Celsius::lit("27");
    let legs = LegTemperatures { cold: mean - half, hot: mean + half, mean };
    let load = Load { seebeck_v, resistance_ohm: module.legs_ohm };
    let demanded = SafeCurrent::saturating(Current::from_num(current_a));
    let period = PWM_PERIOD_STEPS_OF_ONE_FINGER;
    let mut one_tick = || {
        let duty = voltage.duty_for_current(demanded, &legs);
        let (in1, in2) = duty.input_high_times(period);
        let level = |high: u16| Leg::Duty(f64::from(high) / f64::from(period));
        let outputs = BridgeOutputs { a: level(in1), b: level(in2), enabled: true };
        bridge.current(STEP_S, &outputs, &load).mean_a
    };
    (0..TICKS).map(|_| one_tick()).sum::<f64>() / f64::from(TICKS)
}

/// Also where the Seebeck voltage of a display that is warmer or colder than its sink drives the current, against the pulses:
/// there the dead times leave a range of voltages that no duty cycle gives.
#[test]
fn the_mean_current_is_the_demanded_one_for_any_seebeck_voltage() {
    let mut worst_a: f64 = 0.0;
    for step in -35..=35 {
        let seebeck_v = 0.01 * f64::from(step);
        let errors_a = (-50..=50).map(|step| {
            let current_a = 0.04 * f64::from(step);
            mean_current_a(current_a, seebeck_v) - current_a
        });
        let largest_a = errors_a.fold(0.0f64, |largest, error| largest.max(error.abs()));
        println!("{seebeck_v:5.2} V: {:.1} mA", 1e3 * largest_a);
        worst_a = worst_a.max(largest_a);
    }
    assert_figure("law.feedforward_current", 1e3 * worst_a);
}
