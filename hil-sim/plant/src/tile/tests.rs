//! Tile against the closed-form steady state of a module, its data sheet, and a finely meshed plate.

use std::f64::consts::PI;

use documented_figures::{assert_figure, assert_row};

use super::*;

/// Long enough to reach the steady state in a few steps: the integration is L-stable.
const REST_S: f64 = 1e12;
const ROOM_C: f64 = 24.0;

/// The nominal module with constant properties and no exchange with the air.
fn plain() -> TileParams {
    TileParams { variation: 0.0, film_w_m2k: 0.0, ..TileParams::NOMINAL }
}

/// The tile after steps under a constant current and a uniform heat load on its plate, W.
fn after(params: TileParams, current_a: f64, load_w: f64, step_s: f64, steps: usize) -> Tile {
    let mut tile = Tile::new(params, ROOM_C);
    for z in 0..ZONES {
        tile.network.source[0][z] += load_w * tile.share[z];
    }
    let current = Current { mean_a: current_a, ..Current::default() };
    for _ in 0..steps {
        tile.prepare(step_s);
        tile.drive(current);
        tile.first_stage(step_s, 0.0, 0.0, 0.0);
        tile.second_stage(0.0);
    }
    tile
}

#[test]
fn steady_state_follows_the_module_equations() {
    let params = plain();
    let (a, r, k) = (params.seebeck_v_k(), params.resistance_ohm(), params.conductance_w_k());
    for current_a in [-3.0, -0.5, 0.0, 1.0, 4.0, 6.0] {
        for load_w in [0.0, 1.0, 5.0] {
            let tile = after(params, current_a, load_w, REST_S, 6);
            for z in 0..ZONES {
                let cold_k = tile.network.node_c(COLD_TAB, z) + ZERO_C_K;
                let hot_k = tile.network.node_c(HOT_TAB, z) + ZERO_C_K;
                let joule_w = current_a * current_a * r;
                let taken_w = a * current_a * cold_k - joule_w / 2.0 - k * (hot_k - cold_k);
                let given_w = a * current_a * hot_k + joule_w / 2.0 - k * (hot_k - cold_k);
                let to_room_w = (tile.sink_c() - ROOM_C) / params.sink_k_w;
                let electrical_w = tile.step_energy(1.0).electrical_j;
                let volts = a * (hot_k - cold_k) + current_a * r;
                let scale_w = 1.0 + joule_w + load_w;
                for (what, got_w, want_w) in [
                    ("load", load_w, taken_w),
                    ("sink", to_room_w, given_w),
                    ("electrical", electrical_w, current_a * volts),
                ] {
                    assert!(
                        (got_w - want_w).abs() < 1e-6 * scale_w,
                        "{what} in zone {z} at {current_a} A, {load_w} W: {got_w} is not {want_w}"
                    );
                }
            }
        }
    }
}

/// Steady-state temperature of the display plate with a load of 1 W, deg C.
fn plate_c(sink_k_w: f64, current_a: f64) -> f64 {
    // The study neglected plates and paste.
    let params = TileParams { sink_k_w, ceramic_w_mk: 1e6, paste_w_k: 1e6, ..plain() };
    after(params, current_a, 1.0, REST_S, 6).patch_c()
}

#[test]
fn current_above_the_optimum_heats_the_plate() {
    // From a study of this module with constant properties: sink, K/W, and optimal current at 1 W, A.
    let mut best_a = Vec::new();
    for sink_k_w in [0.15, 0.5, 1.0, 2.0] {
        let currents_a = || (1..=80).map(|i| 0.1 * f64::from(i));
        let coldest =
            currents_a().min_by(|a, b| plate_c(sink_k_w, *a).total_cmp(&plate_c(sink_k_w, *b)));
        let found_a = coldest.expect("some");
        println!(
            "{sink_k_w} K/W: coldest at {found_a:.1} A, {:.1} deg C",
            plate_c(sink_k_w, found_a)
        );
        best_a.push((10.0 * found_a).round() / 10.0);
        assert!(plate_c(sink_k_w, found_a + 1.0) > plate_c(sink_k_w, found_a) + 0.1);
    }
    assert_row("plant.best_current", &best_a);
    assert_figure("plant.runaway", plate_c(2.0, 6.0));
}

#[test]
fn varying_properties_keep_the_data_sheet() {
    // Hot side held at the temperature of the data sheet; no load.
    let params = TileParams {
        film_w_m2k: 0.0,
        sink_k_w: 1e-6,
        paste_w_k: 1e6,
        ceramic_w_mk: 1e6,
        coolant_k: TileParams::NOMINAL.sheet_hot_c - ROOM_C,
        ..TileParams::NOMINAL
    };
    let difference_k = |current_a| {
        let tile = after(params, current_a, 0.0, REST_S, 60);
        tile.network.node_c(HOT_TAB, 0) - tile.network.node_c(COLD_TAB, 0)
    };
    let most_k = (40..80).map(|i| difference_k(0.1 * f64::from(i))).fold(0.0, f64::max);
    let sheet = TileParams::NOMINAL;
    assert_figure("plant.largest_difference", most_k);
    assert!((most_k / sheet.dtmax_k - 1.0).abs() < 0.1, "{most_k} K");
    assert_figure("plant.implied_heat", sheet.implied_qmax_w());
    assert!((sheet.implied_qmax_w() / sheet.qmax_w - 1.0).abs() < 0.06);
}

#[test]
fn initial_slope_of_the_plate_is_typical_of_its_class() {
    // Largest slope 2.7 K/s per A, within 15 %.
    let (step_s, window) = (0.5e-3, 20);
    for current_a in [1.0, 3.0, 6.0] {
        let plate_c: Vec<f64> =
            (0..20).map(|n| after(plain(), current_a, 0.0, step_s, n * window).patch_c()).collect();
        let fastest_k = plate_c.windows(2).map(|w| w[0] - w[1]).fold(0.0, f64::max);
        let slope = fastest_k / (window as f64 * step_s) / current_a;
        assert!((slope / 2.7 - 1.0).abs() < 0.15, "{slope} K/s per A at {current_a} A");
    }
}

/// Reference solution: mean temperature rise of the patch, K/W, on a disc with a convective back, meshed in 4000 rings.
fn patch_rise_k(params: &TileParams, sheet_w_k: f64, back_w_m2k: f64) -> f64 {
    let n = 4000;
    let (patch_m, edge_m) = ((params.patch_m2 / PI).sqrt(), (params.plate_m2() / PI).sqrt());
    let ring_m = edge_m / n as f64;
    let area = |i: usize| PI * ring_m * ring_m * (2 * i + 1) as f64;
    let inside = |i: usize| {
        let part = (patch_m - i as f64 * ring_m) * (patch_m + i as f64 * ring_m) * PI;
        part.clamp(0.0, area(i))
    };
    // One watt, uniform over the patch; elimination outwards.
    let link = |i: usize| sheet_w_k * 2.0 * PI * (i + 1) as f64;
    let (mut pivots, mut loads) = (vec![0.0; n], vec![0.0; n]);
    for i in 0..n {
        let outer = if i + 1 < n { link(i) } else { 0.0 };
        pivots[i] = back_w_m2k * area(i) + outer;
        loads[i] = inside(i) / params.patch_m2;
        if i > 0 {
            let inner = link(i - 1);
            pivots[i] += inner * (1.0 - inner / pivots[i - 1]);
            loads[i] += inner / pivots[i - 1] * loads[i - 1];
        }
    }
    let mut rise = vec![0.0; n];
    for i in (0..n).rev() {
        let from_outside = if i + 1 < n { link(i) * rise[i + 1] } else { 0.0 };
        rise[i] = (loads[i] + from_outside) / pivots[i];
    }
    (0..n).map(|i| rise[i] * inside(i)).sum::<f64>() / params.patch_m2
}

#[test]
fn three_zones_approximate_the_heat_spreading_of_a_plate() {
    let params = TileParams::NOMINAL;
    let zones = Zones::new(&params);
    let sheet_w_k = params.ceramic_w_mk * params.ceramic_m;
    // From a back cooled by the legs only to one that prevents spreading.
    let mut off_percent = Vec::new();
    for back_w_m2k in [100.0, 316.0, 1000.0] {
        // The plate alone: column, lower plate and sink have no conductance to it.
        let mut network = ThermalNetwork::<3, ZONES, 1, 1>::new(0.0);
        for z in 0..ZONES {
            network.lateral[0][z] = sheet_w_k * zones.shape[z];
            network.feedback[0][z] = -back_w_m2k * zones.area_m2[z];
        }
        for _ in 0..6 {
            network.first_stage(REST_S, if network.sink_c() == 0.0 { 1.0 } else { 0.0 }, 0.0, 0.0);
            network.second_stage(0.0);
        }
        let exact_k = patch_rise_k(&params, sheet_w_k, back_w_m2k);
        let off = network.node_c(0, PATCH) / exact_k - 1.0;
        println!("back {back_w_m2k} W/(m2 K): {exact_k:.3} K/W, zones off by {:.1} %", 100.0 * off);
        off_percent.push((1000.0 * off).round() / 10.0);
    }
    assert_row("plant.zones_off", &off_percent);
}
