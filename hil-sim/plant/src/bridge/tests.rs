//! Bridge against a time-domain simulation of the circuit, analytical limits without filter, and the driver's data sheet.

mod circuit;

use super::*;

const STEP_S: f64 = 1e-3;
const TILE: Load = Load { seebeck_v: 0.0, resistance_ohm: 1.061 };

fn driven(a: f64, b: f64) -> BridgeOutputs {
    BridgeOutputs { a: Leg::Duty(a), b: Leg::Duty(b), enabled: true }
}

fn bridge(params: BridgeParams) -> Bridge {
    Bridge::new(params, TILE.resistance_ohm)
}

fn current(params: BridgeParams, legs: &BridgeOutputs, load: &Load) -> Current {
    bridge(params).current(STEP_S, legs, load)
}

/// Ideal switches without filter.
fn unfiltered(supply_v: f64) -> BridgeParams {
    BridgeParams {
        supply_v,
        dead_time_s: 0.0,
        on_ohm: 0.0,
        filter_h: 1e-15,
        filter_ohm: 0.0,
        filter_f: 0.0,
        filter_esr_ohm: 0.0,
        trip_a: f64::INFINITY,
        ..BridgeParams::NOMINAL
    }
}

#[test]
fn mean_and_ripple_match_the_circuit_simulation() {
    let mut crossing = 0;
    for dead_time_s in [0.0, 0.3e-6, 0.6e-6] {
        let params = BridgeParams { dead_time_s, ..BridgeParams::NOMINAL };
        for seebeck_v in [-1.0, -0.2, 0.0, 0.5, 1.0] {
            for width in [0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7] {
                let load = Load { seebeck_v, ..TILE };
                let [mean_a, ripple_a2, least_a, most_a] =
                    circuit::steady_state(&params, width, &load);
                let got = current(params, &driven(1.0, 1.0 - width), &load);
                let at = format!("dead {dead_time_s} s, {seebeck_v} V, width {width}");
                // The mean is exact while the current keeps its sign, and approximate around zero.
                let clear = dead_time_s == 0.0 || least_a > 0.05 || most_a < -0.05;
                crossing += u32::from(!clear);
                let (allowed_a, allowed) = if clear { (1e-3, 0.04) } else { (0.03, 0.15) };
                let off_a = got.mean_a - mean_a;
                assert!(off_a.abs() < allowed_a, "{at}: mean {mean_a} A, off by {off_a}");
                let off_a2 = got.ripple_a2 - ripple_a2;
                assert!(
                    off_a2.abs() < allowed * ripple_a2 + 2e-5,
                    "{at}: ripple {ripple_a2} A2, off by {off_a2}"
                );
            }
        }
    }
    assert!((10..40).contains(&crossing), "{crossing} cases around zero");
}

/// Around zero the error of the mean is that of the triangular approximation of the inductor current, which is exact if a
/// large capacitor holds the tile voltage.
#[test]
fn mean_around_zero_is_exact_for_a_stiff_filter() {
    let params =
        BridgeParams { filter_f: 100e-6, on_ohm: 0.02, filter_ohm: 0.0, ..BridgeParams::NOMINAL };
    // From a current with the sign of the pulses to one with the opposite sign.
    let width = 0.1;
    for seebeck_v in [0.3, 0.45, 0.6, 0.8, 1.0, 1.3, 1.5, 1.7, 1.9, 2.1, 2.3] {
        let load = Load { seebeck_v, ..TILE };
        let [mean_a, ..] = circuit::steady_state(&params, width, &load);
        let off_a = current(params, &driven(1.0, 1.0 - width), &load).mean_a - mean_a;
        assert!(off_a.abs() < 2e-3, "{seebeck_v} V: {mean_a} A, off by {off_a}");
    }
}

/// Duty cycles below the first interval of the table.
#[test]
fn ripple_of_narrow_pulses_matches_the_circuit_simulation() {
    let params = BridgeParams { dead_time_s: 0.0, ..BridgeParams::NOMINAL };
    for width in [0.002, 0.006] {
        let [_, ripple_a2, ..] = circuit::steady_state(&params, width, &TILE);
        let got_a2 = current(params, &driven(1.0, 1.0 - width), &TILE).ripple_a2;
        assert!((got_a2 / ripple_a2 - 1.0).abs() < 0.02, "{got_a2} for {ripple_a2}");
    }
}

#[test]
fn without_filter_the_joule_heat_rises_by_the_inverse_duty_cycle() {
    for width in [0.1, 0.25, 0.5, 0.9] {
        let Current { mean_a, ripple_a2, .. } =
            current(unfiltered(12.0), &driven(1.0, 1.0 - width), &TILE);
        let factor = (mean_a * mean_a + ripple_a2) / (mean_a * mean_a);
        assert!((factor * width - 1.0).abs() < 2e-3, "{factor} at {width}");
    }
}

#[test]
fn without_filter_the_ripple_heat_is_that_of_antiphase_drive() {
    // Antiphase drive of 12 V at 50 % equals pulses of 24 V minus a mean of 12 V: the ripple is that of the pulses.
    let ripple_a2 = current(unfiltered(24.0), &driven(1.0, 0.5), &TILE).ripple_a2;
    assert!((ripple_a2 * 1.061 / 136.0 - 1.0).abs() < 5e-3, "{ripple_a2} A2");
}

#[test]
fn dead_time_reduces_the_current_equally_in_both_directions() {
    // Far from zero current: 12 V plus two diode drops for 0.16 us of 10.31 us, divided by the total resistance.
    let params = BridgeParams::NOMINAL;
    let ideal = BridgeParams { dead_time_s: 0.0, ..params };
    let lost_a = (12.0 + 2.0 * 0.9) * 0.16e-6 * 180e6 / 1856.0 / (1.061 + 0.04 + 0.01);
    for (a, b) in [(1.0, 0.5), (0.5, 1.0)] {
        let [with, without] =
            [params, ideal].map(|params| current(params, &driven(a, b), &TILE).mean_a);
        assert!((without.abs() - with.abs() - lost_a).abs() < 1e-9, "{with} of {without}");
    }
}

#[test]
fn current_is_continuous_through_zero() {
    let mut before_a: Option<f64> = None;
    for k in 0..4000 {
        let load = Load { seebeck_v: 1e-3 * f64::from(k) - 1.0, ..TILE };
        let now_a = current(BridgeParams::NOMINAL, &driven(1.0, 0.9), &load).mean_a;
        // One millivolt divided by the resistance, or less where the dead-time loss changes.
        if let Some(before_a) = before_a {
            assert!(
                (-0.91e-3..=0.0).contains(&(now_a - before_a)),
                "at {load:?}: {before_a} to {now_a}"
            );
        }
        before_a = Some(now_a);
    }
    assert!(before_a.is_some_and(|last_a| last_a < -0.5));
}

#[test]
fn without_pwm_edges_the_current_follows_ohms_law() {
    let load = Load { seebeck_v: 0.5, ..TILE };
    let short = current(BridgeParams::NOMINAL, &driven(1.0, 1.0), &load);
    assert!((short.mean_a + 0.5 / 1.111).abs() < 1e-12 && short.ripple_a2 == 0.0);
    let full = current(BridgeParams::NOMINAL, &driven(7.0, -1.0), &load);
    assert!((full.mean_a - 11.5 / 1.111).abs() < 1e-12 && full.ripple_a2 < 1e-12);
}

#[test]
fn no_current_without_two_driven_legs() {
    let warm = Load { seebeck_v: 1.0, ..TILE };
    let open = |legs| assert_eq!(current(BridgeParams::NOMINAL, &legs, &warm), Current::default());
    open(BridgeOutputs::default());
    open(BridgeOutputs { b: Leg::Off, ..driven(1.0, 0.0) });
    open(BridgeOutputs { enabled: false, ..driven(1.0, 0.0) });
    open(driven(0.0, 0.0));
}

#[test]
fn the_supply_gives_the_current_during_the_pulses_and_takes_what_the_tile_drives_back() {
    let got = |a, b, load| current(BridgeParams::NOMINAL, &driven(a, b), load);
    for (a, b) in [(1.0, 0.6), (0.6, 1.0)] {
        let got = got(a, b, &TILE);
        assert!((got.supply_a - 0.4 * got.mean_a.abs()).abs() < 1e-12);
    }
    let load = Load { seebeck_v: 4.0, ..TILE };
    let back = got(1.0, 0.9, &load);
    assert!(back.mean_a < 0.0 && (back.supply_a - 0.1 * back.mean_a).abs() < 1e-12);
}

/// The driver's truth table: 10 and 01 drive, 11 is both low, 00 is high-impedance. A short of leg a to ground trips in
/// the pulses of one direction only.
#[test]
fn inputs_drive_the_legs_by_the_truth_table() {
    for (inputs, legs) in [
        ((1.0, 0.6), (Leg::Duty(0.4), Leg::Duty(0.0))),
        ((0.6, 1.0), (Leg::Duty(0.0), Leg::Duty(0.4))),
        ((1.0, 1.0), (Leg::Duty(0.0), Leg::Duty(0.0))),
        ((0.0, 0.0), (Leg::Off, Leg::Off)),
    ] {
        assert_eq!(driven(inputs.0, inputs.1).leg_levels(), legs, "{inputs:?}");
    }
    let defects = BridgeDefects { a: LegDefect::Shorted, ..BridgeDefects::default() };
    for (inputs, trips) in [((1.0, 0.5), true), ((0.5, 1.0), false)] {
        let mut bridge = bridge(BridgeParams::NOMINAL);
        let legs = defects.apply(&driven(inputs.0, inputs.1));
        bridge.current(STEP_S, &legs, &TILE);
        assert_eq!(bridge.fault(), trips, "{inputs:?}");
    }
}

#[test]
fn overcurrent_turns_the_legs_off_for_the_retry_time() {
    let mut bridge = bridge(BridgeParams::NOMINAL);
    let stalled = Load { resistance_ohm: 0.05, ..TILE };
    let mut step = |load: &Load| {
        let current = bridge.current(STEP_S, &driven(1.0, 0.5), load);
        (current.mean_a > 0.0, bridge.fault())
    };
    assert_eq!(step(&TILE), (true, false));
    // Trips again at every retry, each 3 ms.
    for _ in 0..6 {
        assert_eq!(step(&stalled), (false, true));
    }
    // A normal load is detected only at the next retry.
    assert_eq!(step(&stalled), (false, true));
    for _ in 0..2 {
        assert_eq!(step(&TILE), (false, true));
    }
    assert_eq!(step(&TILE), (true, false));
}

#[test]
fn shorted_output_trips_when_it_is_driven() {
    let mut bridge = bridge(BridgeParams::NOMINAL);
    let shorted = |enabled| BridgeOutputs { a: Leg::Shorted, b: Leg::Duty(0.5), enabled };
    assert_eq!(bridge.current(STEP_S, &shorted(false), &TILE), Current::default());
    assert!(!bridge.fault());
    assert_eq!(bridge.current(STEP_S, &shorted(true), &TILE), Current::default());
    assert!(bridge.fault());
}
