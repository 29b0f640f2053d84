//! Thermistor against published slopes of the divider and the balance of self-heating and dissipation.

use super::super::SensorParams;
use super::*;

const DISPLAY: ThermistorParams = SensorParams::NOMINAL.thermistors[0];

fn site(surface_c: f64) -> Site {
    Site { surface_c, room_c: surface_c }
}

#[test]
fn divider_has_the_published_slopes() {
    assert!((DISPLAY.ratio(25.0) - 0.5).abs() < 1e-15);
    for (at_c, counts_per_k) in [(24.0, 46.0), (34.0, 41.0), (45.0, 34.0)] {
        let slope = (DISPLAY.ratio(at_c - 0.5) - DISPLAY.ratio(at_c + 0.5)) * 4096.0;
        assert!((slope - counts_per_k).abs() < 0.5, "{slope} counts/K at {at_c}");
    }
}

#[test]
fn tolerances_shift_the_reading_by_the_beta_equation() {
    // At 25 deg C 1 % of resistance is 1 % / (beta/T^2) = 0.225 K; the error of beta is zero there.
    let kelvin = |params: ThermistorParams, at_c: f64| {
        (DISPLAY.ratio(at_c) - params.ratio(at_c))
            / (DISPLAY.ratio(at_c - 0.5) - DISPLAY.ratio(at_c + 0.5))
    };
    let high = ThermistorParams { at_25c_ohm: 10.1e3, ..DISPLAY };
    let pulled = ThermistorParams { pull_up_ohm: 10.1e3, ..DISPLAY };
    let steep = ThermistorParams { beta_k: 3950.0 * 1.01, ..DISPLAY };
    assert!((kelvin(high, 25.0) + 0.225).abs() < 0.003, "{}", kelvin(high, 25.0));
    assert!((kelvin(pulled, 25.0) - 0.225).abs() < 0.003);
    assert!(kelvin(steep, 25.0).abs() < 1e-12);
    // d ln R = d beta (1/T - 1/T25), over beta/T^2.
    let expected = -0.01 * (307.15f64.recip() - 298.15f64.recip()) * 307.15 * 307.15;
    assert!(
        (kelvin(steep, 34.0) - expected).abs() < 0.005,
        "{} for {expected}",
        kelvin(steep, 34.0)
    );
}

#[test]
fn self_heating_power_is_0_26_mw_at_34_c() {
    let ratio = DISPLAY.ratio(34.0);
    let heat_mw = 1e3 * DISPLAY.heat_scale_w(3.3) * ratio * (1.0 - ratio);
    assert!((heat_mw - 0.26).abs() < 0.005, "{heat_mw} mW");
}

#[test]
fn self_heating_and_dissipation_balance_in_steady_state() {
    for (dissipation_w_k, surface_c) in [(8e-3, 24.0), (1e-3, 24.0), (3e-3, 34.0)] {
        let params = ThermistorParams { dissipation_w_k, lead_share: 0.0, ..DISPLAY };
        let at_rest = Thermistor::new(params, &site(surface_c), 3.3);
        let above_c = at_rest.reached_c - surface_c;
        let ohm =
            10e3 * (3950.0 * ((at_rest.reached_c + 273.15).recip() - 298.15f64.recip())).exp();
        let power_w = (3.3 / (ohm + 10e3)).powi(2) * ohm;
        assert!((above_c * dissipation_w_k / power_w - 1.0).abs() < 1e-9, "{above_c} K above");
        // A transient from 0 deg C converges to the same state.
        let mut cold = Thermistor::new(params, &site(0.0), 3.3);
        for _ in 0..2000 {
            cold.step(1e-3, &site(surface_c));
        }
        assert!((cold.reached_c - at_rest.reached_c).abs() < 1e-6);
    }
}

#[test]
fn leads_shift_the_reading_towards_the_room() {
    let params = ThermistorParams { lead_share: 0.02, ..DISPLAY };
    let cool_room = Site { room_c: 24.0, ..site(34.0) };
    let thermistor = Thermistor::new(params, &cool_room, 0.0);
    assert!((thermistor.reached_c - 33.8).abs() < 1e-12);
}

#[test]
fn thermistor_lags_a_ramp_by_its_time_constant() {
    let step_s = 0.5e-3;
    let mut thermistor = Thermistor::new(DISPLAY, &site(24.0), 0.0);
    // A ramp of 10 K/s: after many time constants the error is time constant times rate.
    for k in 1..=4000 {
        thermistor.step(step_s, &site(24.0 + 10.0 * step_s * f64::from(k)));
    }
    assert!((thermistor.reached_c - (44.0 - 10.0 * 0.1)).abs() < 1e-6);
    // At constant temperature the error decays exponentially.
    for _ in 0..200 {
        thermistor.step(step_s, &site(44.0));
    }
    let left_c = 44.0 - thermistor.reached_c;
    assert!((left_c - 10.0 * 0.1 * (-1.0f64).exp()).abs() < 1e-6, "{left_c}");
}

/// One twentieth of 8 mW/K remains, of which the unchanged 16 uW/K of the leads are 4 %.
#[test]
fn detached_thermistor_has_more_lag_lead_error_and_self_heating() {
    let here = Site { surface_c: 34.0, room_c: 24.0 };
    let mut loose = Thermistor::new(DISPLAY, &here, 0.0);
    loose.set_defect(ThermistorDefect { resistance_factor: 20.0, ..ThermistorDefect::NONE });
    // From 33.98 to 33.6 deg C with 2 s.
    for _ in 0..2000 {
        loose.step(1e-3, &here);
    }
    let left = (loose.reached_c - 33.6) / 0.38;
    assert!((left - (-1f64).exp()).abs() < 1e-3, "{left}");
    let mut heated = Thermistor::new(DISPLAY, &here, 3.3);
    heated.set_defect(loose.defect);
    for _ in 0..100 {
        heated.step(1.0, &here);
    }
    // 0.26 mW over 0.4 mW/K.
    let above_k = heated.reached_c - 33.6;
    assert!((above_k - 0.65).abs() < 0.02, "{above_k} K");
}

#[test]
fn open_or_shorted_thermistor_has_no_self_heating_and_recovers() {
    let here = site(34.0);
    let mut thermistor = Thermistor::new(DISPLAY, &here, 3.3);
    let sound = thermistor.ratio();
    for (circuit, ratio) in [(Circuit::Open, 1.0), (Circuit::Short, 0.0)] {
        thermistor.set_defect(ThermistorDefect { circuit, ..ThermistorDefect::NONE });
        assert_eq!(thermistor.ratio(), ratio);
        for _ in 0..20 {
            thermistor.step(1.0, &here);
        }
        assert!((thermistor.reached_c - 34.0).abs() < 1e-9, "{}", thermistor.reached_c);
    }
    thermistor.set_defect(ThermistorDefect::NONE);
    for _ in 0..20 {
        thermistor.step(1.0, &here);
    }
    assert!((thermistor.ratio() - sound).abs() < 1e-9);
}
