//! The infrared instrument against golden radiances and round trips, against an independent quadrature of Planck's law,
//! and against physical invariants.

use std::collections::HashMap;

use documented_figures::assert_figure;
use thermal_plant::infrared::{
    BEAMSPLITTER, Camera, CameraParams, Optic, RANGE_C, SelfReflection, Surroundings, radiance,
    radiance_per_k, temperature_c,
};

const OPTICS: [Optic; 3] = [Optic::None, Optic::Baf2, Optic::Zns];

type Row = HashMap<String, String>;

fn golden(name: &str) -> Vec<Row> {
    let path = format!("{}/tests/data/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let rows = csv::Reader::from_path(path).expect("golden table");
    rows.into_deserialize().collect::<Result<_, _>>().expect("golden row")
}

fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

/// Optics and surroundings of a golden row.
fn conditions(row: &Row) -> (Optic, Surroundings) {
    let optic = match row["optic"].as_str() {
        "none" => Optic::None,
        "baf2" => Optic::Baf2,
        "zns" => Optic::Zns,
        other => panic!("optic {other}"),
    };
    let mut surroundings = Surroundings::at(number(row, "T_amb_C"));
    if optic != Optic::None {
        surroundings.window_c = number(row, "T_opt1_C");
        surroundings.splitter_c = number(row, "T_opt2_C");
    }
    (optic, surroundings)
}

fn noiseless(optic: Optic) -> CameraParams {
    CameraParams { netd_k: 0.0, ..CameraParams::thesis(optic) }
}

fn camera(params: &CameraParams, surroundings: &Surroundings, seed: u64) -> Camera {
    Camera::new(params, surroundings, seed).expect("a camera")
}

/// Temperatures of the whole range, deg C.
fn range() -> impl Iterator<Item = f64> {
    (0..=3000).map(|i| RANGE_C.start() + 0.1 * f64::from(i))
}

#[test]
fn radiance_and_its_inverse_meet_golden_values() {
    let rows = golden("planck_band");
    assert!(rows.len() >= 29);
    let (mut most, mut most_k) = (0.0f64, 0.0f64);
    for row in rows {
        let (t_c, expected) = (number(&row, "T_C"), number(&row, "U_7.5_13um_W_m2_sr"));
        let relative = (radiance(t_c) / expected - 1.0).abs();
        most = most.max(relative);
        most_k = most_k.max((temperature_c(expected) - t_c).abs());
    }
    assert_figure("infrared.radiance", most);
    assert_figure("infrared.temperature", most_k);
}

#[test]
fn radiance_is_planck_s_law_over_the_band() {
    // Boole's rule, with the first and second radiation constants to 16 digits.
    let spectral = |wavelength_m: f64, kelvin: f64| {
        1.191_042_972_397_188e-16
            / (wavelength_m.powi(5) * (1.438_776_877_503_933e-2 / (wavelength_m * kelvin)).exp_m1())
    };
    let mut most = 0.0f64;
    for t_c in range().step_by(100) {
        let step_m = (13e-6 - 7.5e-6) / 400.0;
        let weights = [7.0, 32.0, 12.0, 32.0, 7.0];
        let panel = |panel: i32| {
            let node = |(i, weight): (usize, f64)| {
                weight * spectral(7.5e-6 + step_m * (f64::from(4 * panel) + i as f64), t_c + 273.15)
            };
            weights.into_iter().enumerate().map(node).sum::<f64>()
        };
        let expected = step_m * 2.0 / 45.0 * (0..100).map(panel).sum::<f64>();
        let relative = (radiance(t_c) / expected - 1.0).abs();
        most = most.max(relative);
    }
    assert_figure("infrared.radiance_by_quadrature", most);
}

#[test]
fn slope_is_the_derivative() {
    // Golden radiances, one degree apart, differentiated to fourth order.
    let radiances: Vec<(f64, f64)> = golden("planck_band")
        .iter()
        .map(|row| (number(row, "T_C"), number(row, "U_7.5_13um_W_m2_sr")))
        .collect();
    let mut checked = 0;
    for around in radiances.windows(5).filter(|around| around[4].0 - around[0].0 == 4.0) {
        let [a, b, _, d, e] = [0, 1, 2, 3, 4].map(|i: usize| around[i].1);
        let expected = (a - 8.0 * b + 8.0 * d - e) / 12.0;
        let relative = (radiance_per_k(around[2].0) / expected - 1.0).abs();
        assert!(relative <= 1e-7, "{} deg C: {relative:e}", around[2].0);
        checked += 1;
    }
    assert!(checked >= 15, "{checked}");
}

#[test]
fn temperature_inverts_radiance_and_is_limited_to_the_range() {
    let (mut before, mut most_k) = (0.0, 0.0f64);
    for t_c in range() {
        let here = radiance(t_c);
        assert!(here > before, "{t_c} deg C");
        before = here;
        most_k = most_k.max((temperature_c(here) - t_c).abs());
    }
    assert_figure("infrared.there_and_back", most_k);
    assert_eq!(temperature_c(-1.0), *RANGE_C.start());
    assert_eq!(temperature_c(0.0), *RANGE_C.start());
    assert_eq!(temperature_c(1e9), *RANGE_C.end());
    assert!(temperature_c(f64::NAN).is_nan() && radiance(f64::NAN).is_nan());
}

#[test]
fn optics_are_those_of_table_5_3() {
    let table = [
        (Optic::Baf2.window(), [0.77, 0.04, 0.19]),
        (Optic::Zns.window(), [0.65, 0.22, 0.13]),
        (Some(BEAMSPLITTER), [0.54, 0.42, 0.04]),
    ];
    for (optic, [transmissivity, reflectivity, emissivity]) in table {
        let optic = optic.expect("a window");
        assert_eq!([optic.transmissivity, optic.reflectivity], [transmissivity, reflectivity]);
        assert!((optic.emissivity() - emissivity).abs() < 1e-15);
    }
    assert_eq!(Optic::None.window(), None);
}

#[test]
fn camera_meets_golden_round_trips() {
    let rows = golden("infrared");
    assert!(rows.len() >= 66);
    let mut most_k = 0.0f64;
    for row in rows {
        let (optic, surroundings) = conditions(&row);
        assert_eq!(number(&row, "eps_obj"), noiseless(optic).emissivity);
        let mut camera = camera(&noiseless(optic), &surroundings, 1);
        let reading = camera.read(number(&row, "T_obj_C"));
        let (total, apparent_c) = (number(&row, "U_tot"), number(&row, "T_apparent_C"));
        assert!((reading.u_tot / total - 1.0).abs() <= 1e-14, "{row:?}");
        assert!((reading.apparent_c - apparent_c).abs() <= 1e-11, "{row:?}");
        for recovered_c in [reading.recovered_c, camera.recovered_c(apparent_c)] {
            most_k = most_k.max((recovered_c - number(&row, "T_obj_C")).abs());
        }
    }
    assert_figure("infrared.recovered_golden", most_k);
}

#[test]
fn inversion_recovers_any_target() {
    let mut most_k = 0.0f64;
    for optic in OPTICS {
        for emissivity in [0.3, 0.95, 1.0] {
            for (ambient_c, window_c, splitter_c) in
                [(24.0, 27.0, 25.0), (-20.0, 60.0, 10.0), (45.0, 5.0, 45.0)]
            {
                let params = CameraParams { emissivity, ..noiseless(optic) };
                let surroundings = Surroundings { ambient_c, window_c, splitter_c };
                let mut camera = camera(&params, &surroundings, 1);
                let mut before_c = f64::NEG_INFINITY;
                for target_c in (-40..=125).map(f64::from) {
                    let reading = camera.read(target_c);
                    assert!(reading.apparent_c > before_c, "{optic:?} {target_c}");
                    before_c = reading.apparent_c;
                    most_k = most_k.max((reading.recovered_c - target_c).abs());
                }
            }
        }
    }
    assert_figure("infrared.recovered", most_k);
}

#[test]
fn optics_have_no_effect_in_thermal_equilibrium() {
    for optic in OPTICS {
        for t_c in [-40.0, 0.0, 24.0, 34.0, 120.0] {
            let reflection = SelfReflection { camera_c: t_c, share: 1.0 };
            let params = CameraParams { self_reflection: Some(reflection), ..noiseless(optic) };
            let reading = camera(&params, &Surroundings::at(t_c), 1).read(t_c);
            assert!((reading.apparent_c - t_c).abs() <= 1e-11, "{optic:?} {t_c}: {reading:?}");
        }
    }
}

#[test]
fn self_reflection_of_a_warm_camera_raises_the_reading() {
    // A target of 27 deg C, a camera of 30 deg C and a room of 24 deg C, from golden radiances: the reflected radiation
    // passes the beamsplitter twice.
    let radiances: HashMap<String, f64> = golden("planck_band")
        .iter()
        .map(|row| (row["T_C"].clone(), number(row, "U_7.5_13um_W_m2_sr")))
        .collect();
    let excess = radiances["30"] - radiances["24"];
    for (optic, transmissivity, reflectivity) in
        [(Optic::Baf2, 0.77, 0.04), (Optic::Zns, 0.65, 0.22)]
    {
        for share in [0.0, 0.5, 1.0] {
            let reflection = SelfReflection { camera_c: 30.0, share };
            let params = CameraParams { self_reflection: Some(reflection), ..noiseless(optic) };
            let reading = camera(&params, &Surroundings::at(24.0), 1).read(27.0);
            let expected =
                radiances["27"] + share * reflectivity * 0.54 * excess / (0.95 * transmissivity);
            let relative = (radiance(reading.recovered_c) / expected - 1.0).abs();
            assert!(relative <= 1e-12, "{optic:?} {share}: {relative:e}");
        }
    }
}

/// Mean and standard deviation of the error of the recovered temperature, and of the noise of the apparent one.
fn statistics(params: &CameraParams, target_c: f64, seed: u64) -> ([f64; 2], [f64; 2]) {
    const COUNT: u32 = 40_000;
    let mut camera = camera(params, &Surroundings::at(24.0), seed);
    let exact_c =
        self::camera(&CameraParams { netd_k: 0.0, ..*params }, &Surroundings::at(24.0), seed)
            .read(target_c)
            .apparent_c;
    let readings: Vec<[f64; 2]> = (0..COUNT)
        .map(|_| camera.read(target_c))
        .map(|reading| [reading.recovered_c - target_c, reading.apparent_c - exact_c])
        .collect();
    let mean = [0, 1].map(|i: usize| readings.iter().map(|r| r[i]).sum::<f64>() / f64::from(COUNT));
    let deviation = [0, 1].map(|i: usize| {
        let squares = readings.iter().map(|r| (r[i] - mean[i]).powi(2));
        (squares.sum::<f64>() / f64::from(COUNT - 1)).sqrt()
    });
    ([mean[0], deviation[0]], [mean[1], deviation[1]])
}

#[test]
fn noise_equals_the_netd_without_bias_and_is_amplified_by_optics() {
    for (seed, optic) in OPTICS.into_iter().enumerate() {
        let black = CameraParams { emissivity: 1.0, ..CameraParams::thesis(optic) };
        // The NETD is specified at an apparent temperature of 30 deg C.
        let target_c = camera(&noiseless(optic), &Surroundings::at(24.0), 1).recovered_c(30.0);
        let params = CameraParams::thesis(optic);
        let ([bias_k, recovered_k], [apparent_bias_k, apparent_k]) =
            statistics(&params, target_c, seed as u64);
        assert!((apparent_k / params.netd_k - 1.0).abs() < 0.02, "{optic:?} {apparent_k}");
        // Four standard errors.
        assert!(apparent_bias_k.abs() < 4.0 * apparent_k / 200.0, "{optic:?} {apparent_bias_k}");
        assert!(bias_k.abs() < 4.0 * recovered_k / 200.0, "{optic:?} {bias_k}");
        // Losses of the optics and the slope of Planck's law at the target amplify the noise.
        let window = optic.window().map_or(1.0, |window| window.transmissivity * 0.54);
        let magnified = radiance_per_k(30.0) / (0.95 * window * radiance_per_k(target_c));
        assert!(
            (recovered_k / (params.netd_k * magnified) - 1.0).abs() < 0.02,
            "{optic:?} {recovered_k}"
        );
        let averaged = CameraParams { pixels: 100, ..black };
        let (_, [_, averaged_k]) = statistics(&averaged, 30.0, 7);
        let (_, [_, single_k]) = statistics(&black, 30.0, 8);
        assert!((10.0 * averaged_k / single_k - 1.0).abs() < 0.03, "{optic:?} {averaged_k}");
    }
}

#[test]
fn same_seed_gives_the_same_readings() {
    let readings = |seed| {
        let mut camera = camera(&CameraParams::thesis(Optic::Baf2), &Surroundings::at(24.0), seed);
        [27.0, 27.0, 30.0].map(|target_c| camera.read(target_c).u_tot)
    };
    assert_eq!(readings(3), readings(3));
    assert_ne!(readings(3), readings(4));
    assert_ne!(readings(3)[0], readings(3)[1]);
}

#[test]
fn wrong_parameters_are_named() {
    let fine = CameraParams::thesis(Optic::Zns);
    let room = Surroundings::at(24.0);
    let reflection = |camera_c, share| Some(SelfReflection { camera_c, share });
    for (params, surroundings, expected) in [
        (CameraParams { emissivity: 0.0, ..fine }, room, "emissivity 0; allowed is above 0 to 1"),
        (CameraParams { emissivity: 1.1, ..fine }, room, "emissivity 1.1; allowed is above 0 to 1"),
        (
            CameraParams { netd_k: -0.1, ..fine },
            room,
            "netd_k -0.1; allowed is a finite number from 0 on",
        ),
        (CameraParams { pixels: 0, ..fine }, room, "pixels 0; allowed is 1 or more"),
        (fine, Surroundings { window_c: f64::NAN, ..room }, "window_c NaN; allowed is -100 to 200"),
        (
            fine,
            Surroundings { splitter_c: 300.0, ..room },
            "splitter_c 300; allowed is -100 to 200",
        ),
        (
            fine,
            Surroundings { ambient_c: -101.0, ..room },
            "ambient_c -101; allowed is -100 to 200",
        ),
        (
            CameraParams { self_reflection: reflection(201.0, 1.0), ..fine },
            room,
            "camera_c 201; allowed is -100 to 200",
        ),
        (
            CameraParams { self_reflection: reflection(30.0, 1.5), ..fine },
            room,
            "camera_share 1.5; allowed is 0 to 1",
        ),
    ] {
        let error = Camera::new(&params, &surroundings, 1).expect_err(expected);
        assert_eq!(error.to_string(), expected);
    }
}
