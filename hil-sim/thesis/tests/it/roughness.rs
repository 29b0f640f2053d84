//! Roughness parameters against golden sines, profiles with known parameters, and invariances.

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt::Write;
use std::path::Path;

use contact_model::material::average_slope_rad;
use documented_figures::assert_figure;
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution, StandardNormal, StandardUniform};
use thermal_thesis::roughness::{LEAST_POINTS, Profile, Roughness};

/// A profile as CSV.
fn text(points: impl IntoIterator<Item = (f64, f64)>) -> String {
    let mut text = String::from("x_m,z_m\n");
    for (x_m, z_m) in points {
        writeln!(text, "{x_m},{z_m}").expect("text grows");
    }
    text
}

fn measure(points: impl IntoIterator<Item = (f64, f64)>) -> Roughness {
    Profile::parse(text(points).as_bytes()).expect("a profile").roughness()
}

/// `steps + 1` equidistant positions from 0 to a length, m.
fn even(length_m: f64, steps: u32) -> impl Iterator<Item = f64> {
    (0..=steps).map(move |i| length_m * f64::from(i) / f64::from(steps))
}

/// A sine profile: amplitude, m, period, m, and phase, rad.
#[derive(Clone, Copy)]
struct Sine(f64, f64, f64);

impl Sine {
    fn at(self, x_m: f64) -> f64 {
        self.0 * (TAU * x_m / self.1 + self.2).sin()
    }

    fn sampled(self, periods: f64, steps: u32) -> impl Iterator<Item = (f64, f64)> {
        even(periods * self.1, steps).map(move |x_m| (x_m, self.at(x_m)))
    }
}

fn relative(value: f64, expected: f64) -> f64 {
    (value / expected - 1.0).abs()
}

fn rsm_m(roughness: &Roughness) -> f64 {
    roughness.rsm_m.expect("an element")
}

/// Sines of the golden table, from crest to crest, with their parameters.
fn golden() -> Vec<(Sine, Roughness)> {
    let path =
        format!("{}/../../model/tests/data/roughness_sinusoid.csv", env!("CARGO_MANIFEST_DIR"));
    let rows = csv::Reader::from_path(path).expect("golden table");
    let sine = |row: Result<HashMap<String, String>, _>| {
        let row = row.expect("golden row");
        let number = |column: &str| row[column].parse::<f64>().expect("a number");
        let roughness = Roughness {
            rq_m: number("Rq_m"),
            rdq: number("Rdq"),
            slope_rad: number("da_atan_mean_rad"),
            rsm_m: Some(number("RSm_m")),
        };
        (Sine(number("amplitude_m"), number("period_m"), FRAC_PI_2), roughness)
    };
    let sines: Vec<_> = rows.into_deserialize().map(sine).collect();
    assert_eq!(sines.len(), 3);
    sines
}

#[test]
fn sines_meet_golden_values() {
    let mut worst = [0.0; 4];
    for (sine, expected) in golden() {
        let found = measure(sine.sampled(10.0, 4000));
        let errors = [
            relative(found.rq_m, expected.rq_m),
            relative(rsm_m(&found), rsm_m(&expected)),
            relative(found.rdq, expected.rdq),
            relative(found.slope_rad, expected.slope_rad),
        ];
        worst = std::array::from_fn(|i| errors[i].max(worst[i]));
    }
    for (name, error) in ["rq", "rsm", "rdq", "slope"].into_iter().zip(worst) {
        assert_figure(&format!("roughness.{name}"), error);
    }
}

#[test]
fn slopes_converge_with_the_sampling() {
    // Crests are points at each of these, so no kink is cut off.
    let (sine, expected) = golden()[2];
    let errors = [400, 800, 1600, 3200].map(|steps| {
        let found = measure(sine.sampled(10.0, steps));
        [relative(found.rdq, expected.rdq), relative(found.slope_rad, expected.slope_rad)]
    });
    for pair in errors.windows(2) {
        // The end points' own slopes are what is left of rdq's error: second order, times their share, a step.
        let [rdq, slope] = [0, 1].map(|i: usize| (pair[0][i] / pair[1][i]).log2());
        assert!((rdq - 3.0).abs() < 0.1, "{rdq} {errors:?}");
        assert!((slope - 2.0).abs() < 0.1, "{slope} {errors:?}");
    }
}

#[test]
fn incomplete_periods_cause_an_error_proportional_to_their_length() {
    // A part of a period changes means over n periods by order 1/n at most; spacing counts whole elements.
    let mut worst = 0.0_f64;
    for (amplitude_m, period_m) in [(10e-6, 0.65e-3), (100e-6, 0.5e-3)] {
        for phase in [0.0, 0.7, 2.0, PI, 5.0] {
            let sine = Sine(amplitude_m, period_m, phase);
            let found = measure(sine.sampled(40.37, 16_148));
            let rq_m = amplitude_m / 2_f64.sqrt();
            let rdq = TAU * rq_m / period_m;
            let error = relative(found.rq_m, rq_m).max(relative(found.rdq, rdq));
            worst = worst.max(40.0 * error);
            // The mean line is not exactly level, and crossings are straight between points.
            assert!(relative(rsm_m(&found), period_m) < 1e-4, "{phase} {found:?}");
        }
    }
    assert_figure("roughness.cut", worst);
}

#[test]
fn roughness_is_invariant_under_tilt_and_translation() {
    for (sine, _) in golden() {
        let level = measure(sine.sampled(7.3, 1460));
        for tilt in [-0.2, 0.01, 1.0] {
            let moved =
                sine.sampled(7.3, 1460).map(|(x_m, z_m)| (x_m + 0.02, z_m + tilt * x_m - 1e-3));
            let found = measure(moved);
            assert!(relative(found.rq_m, level.rq_m) < 1e-10, "{tilt}");
            assert!(relative(found.rdq, level.rdq) < 1e-9, "{tilt}");
            assert!(relative(found.slope_rad, level.slope_rad) < 1e-9, "{tilt}");
            assert!(relative(rsm_m(&found), rsm_m(&level)) < 1e-10, "{tilt}");
        }
    }
}

#[test]
fn unequal_steps_give_the_same_roughness() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    for (sine, expected) in golden() {
        // Steps from 1 to 9 times the shortest, crest to crest.
        let steps: Vec<f64> = (0..8000)
            .map(|_| {
                let unit: f64 = StandardUniform.sample(&mut random);
                1.0 + 8.0 * unit
            })
            .collect();
        let scale = 40.0 * sine.1 / steps.iter().sum::<f64>();
        let mut x_m = 0.0;
        let places = std::iter::once(0.0).chain(steps.iter().map(|step| {
            x_m += scale * step;
            x_m
        }));
        let found = measure(places.map(|x_m| (x_m, sine.at(x_m))));
        assert!(relative(found.rq_m, expected.rq_m) < 1e-4, "{found:?}");
        assert!(relative(found.rdq, expected.rdq) < 1e-5, "{found:?}");
        assert!(relative(found.slope_rad, expected.slope_rad) < 5e-4, "{found:?}");
        assert!(relative(rsm_m(&found), rsm_m(&expected)) < 1e-5, "{found:?}");
    }
}

#[test]
fn slopes_of_a_polynomial_of_sixth_degree_are_exact_in_the_middle() {
    // The seven-point formula is exact for it; with uneven points that distinguishes it from the even one. The
    // ends' lower orders are outvoted by a steep middle: heights vanish to fourth order at both ends.
    let bump = |x: f64| (x * (1.0 - x)).powi(3) * 64.0;
    let slope = |x: f64| 192.0 * (x * (1.0 - x)).powi(2) * (1.0 - 2.0 * x);
    let places: Vec<f64> =
        (0..=60).map(|i| (f64::from(i) + 0.35 * f64::from(i % 3)) / 60.0).collect();
    // The mean line of a symmetric bump is level only for symmetric points: take its tilt from heights.
    let found = measure(places.iter().map(|&x| (x, bump(x))));
    let last = places.len() - 1;
    let weight = |i: usize| 0.5 * (places[(i + 1).min(last)] - places[i.saturating_sub(1)]);
    let total = places[last] - places[0];
    let mean = |value: &dyn Fn(f64) -> f64| {
        (0..=last).map(|i| weight(i) * value(places[i])).sum::<f64>() / total
    };
    let (middle, level) = (mean(&|x| x), mean(&bump));
    let tilt = mean(&|x| (x - middle) * (bump(x) - level)) / mean(&|x| (x - middle).powi(2));
    let expected = mean(&|x| (slope(x) - tilt).powi(2)).sqrt();
    assert!(relative(found.rdq, expected) < 1e-4, "{found:?} {expected}");
}

#[test]
fn triangles_and_steps_have_their_analytical_slopes() {
    // A sawtooth of 1 in 10: slope atan 0.1 everywhere, spacing 2 mm, Rq a / sqrt 3.
    let triangle = |x_m: f64| {
        let phase = (x_m / 2e-3 + 0.5).rem_euclid(1.0);
        1e-4 * (4.0 * (phase - 0.5).abs() - 1.0) * 0.5
    };
    let found = measure(even(40e-3, 4000).map(|x_m| (x_m, triangle(x_m))));
    assert!(relative(found.slope_rad, 0.1_f64.atan()) < 1e-4, "{found:?}");
    assert!(relative(found.rq_m, 0.5e-4 / 3_f64.sqrt()) < 1e-3, "{found:?}");
    assert!(relative(rsm_m(&found), 2e-3) < 1e-5, "{found:?}");
}

#[test]
fn spacing_ignores_low_and_narrow_peaks() {
    // In each millimetre a full wave of 10 µm, then ripples that are wide enough to count. 1 µm is 5 % of Rz,
    // below the threshold of 10 %; 3 µm are 15 %, and each wave and each ripple is an element.
    let rippled = |height_m: f64| {
        let (wave, ripple) = (Sine(10e-6, 0.5e-3, 0.0), Sine(height_m, 0.125e-3, 0.0));
        let pattern = move |x_m: f64| match x_m.rem_euclid(1e-3) {
            place if place < 0.5e-3 => wave.at(place),
            place => ripple.at(place),
        };
        measure(even(30.3e-3, 30_300).map(move |x_m| (x_m, pattern(x_m))))
    };
    assert!(relative(rsm_m(&rippled(1e-6)), 1e-3) < 5e-3);
    assert!(relative(rsm_m(&rippled(3e-6)), 0.2e-3) < 0.01);
    let carrier = Sine(10e-6, 1e-3, 0.3);
    // Single spikes: 20 µm high, wider or narrower than 5 % of the spacing, one in every valley.
    let spiked = |width_m: f64| {
        measure(carrier.sampled(30.0, 30_000).map(move |(x_m, z_m)| {
            let in_valley = (x_m / 1e-3 + 0.3 / TAU - 0.75).rem_euclid(1.0) * 1e-3;
            (x_m, z_m + if in_valley < width_m { 20e-6 } else { 0.0 })
        }))
    };
    assert!(relative(rsm_m(&spiked(0.02e-3)), 1e-3) < 1e-3);
    assert!(relative(rsm_m(&spiked(0.1e-3)), 0.5e-3) < 0.05);
    // One speck of dust raises one of the five heights of which Rz is the mean, and hides no peak.
    let dusty = carrier
        .sampled(30.0, 30_000)
        .map(|(x_m, z_m)| (x_m, if (2.19e-3..2.2e-3).contains(&x_m) { 150e-6 } else { z_m }));
    assert!(relative(rsm_m(&measure(dusty)), 1e-3) < 1e-3);
}

#[test]
fn noise_increases_roughness_but_not_spacing() {
    let sine = Sine(10e-6, 0.65e-3, 1.0);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let noise_m = 0.3e-6;
    let noisy = sine.sampled(50.0, 10_000).map(|(x_m, z_m)| {
        let normal: f64 = StandardNormal.sample(&mut random);
        (x_m, z_m + noise_m * normal)
    });
    let found = measure(noisy);
    assert!(relative(rsm_m(&found), 0.65e-3) < 1e-3, "{found:?}");
    assert!(relative(found.rq_m, (50e-12 + noise_m * noise_m).sqrt()) < 5e-3, "{found:?}");
    // The formula's weights: sum of squares 2 (45² + 9² + 1) / 60² over the step squared.
    let step_m = 50.0 * 0.65e-3 / 10_000.0;
    let from_noise =
        noise_m * noise_m * 2.0 * (45.0_f64.powi(2) + 81.0 + 1.0) / 3600.0 / (step_m * step_m);
    let expected = (0.5 * (TAU * 10e-6 / 0.65e-3).powi(2) + from_noise).sqrt();
    assert!(relative(found.rdq, expected) < 0.02, "{found:?} {expected}");
}

#[test]
fn gaussian_profiles_follow_eq_6_13() {
    // Many waves of random phase, each of whole periods: Gaussian heights, moments known exactly. Slopes are
    // small, as Eq. 6-13 requires.
    let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
    let (rq_m, count, length_m) = (2e-6, 300, 60e-3);
    let waves: Vec<Sine> = (0..count)
        .map(|i| {
            let phase: f64 = StandardUniform.sample(&mut random);
            let amplitude_m = rq_m * (2.0 / f64::from(count)).sqrt();
            Sine(amplitude_m, length_m / f64::from(120 + i), TAU * phase)
        })
        .collect();
    let profile =
        even(length_m, 12_000).map(|x_m| (x_m, waves.iter().map(|wave| wave.at(x_m)).sum()));
    let found = measure(profile);
    let square_slope: f64 = waves.iter().map(|wave| 0.5 * (TAU * wave.0 / wave.1).powi(2)).sum();
    assert!(relative(found.rq_m, rq_m) < 1e-3, "{found:?}");
    assert!(relative(found.rdq, square_slope.sqrt()) < 1e-3, "{found:?}");
    // Eq. 6-13's 1.25 is sqrt(pi / 2) = 1.2533 rounded.
    assert!(relative(found.slope_rad, average_slope_rad(found.rdq)) < 0.01, "{found:?}");
}

#[test]
fn flat_profiles_and_profiles_without_complete_element_have_no_spacing() {
    let flat = measure(even(1e-3, 50).map(|x_m| (x_m, 3e-6)));
    assert_eq!((flat.rq_m, flat.rdq, flat.slope_rad, flat.rsm_m), (0.0, 0.0, 0.0, None));
    // A crest with half a valley on either side crosses its mean line twice: not one element is complete.
    let crest = measure(Sine(1e-6, 1e-3, -FRAC_PI_2).sampled(1.0, 100));
    assert_eq!(crest.rsm_m, None);
}

#[test]
fn invalid_profiles_are_refused_with_their_line() {
    let fine: Vec<String> = text((0..=40).map(|i| (f64::from(i), f64::from(i % 7))))
        .lines()
        .map(str::to_owned)
        .collect();
    let with = |line: usize, instead: &str| {
        let mut lines = fine.clone();
        instead.clone_into(&mut lines[line - 1]);
        lines.join("\n")
    };
    let gap = [&fine[..11], &fine[21..]].concat().join("\n");
    for (text, expected) in [
        (with(1, "x,z"), "line 1: columns x, z; needed are x_m and z_m"),
        (with(1, "x_m"), "line 1: columns x_m; needed are x_m and z_m"),
        (with(1, "x_m,z_m,z_m"), "line 1: two columns \"z_m\"; allowed is each name once"),
        (String::new(), "line 1: columns ; needed are x_m and z_m"),
        (with(9, "7,high"), "line 9: z_m = \"high\"; allowed is a finite number"),
        (with(9, "7,NaN"), "line 9: z_m = \"NaN\"; allowed is a finite number"),
        (with(9, "inf,0"), "line 9: x_m = \"inf\"; allowed is a finite number"),
        (with(9, "7"), "line 9: z_m = \"\"; allowed is a finite number"),
        (with(9, "6,0"), "line 9: x_m = 6 after 6; allowed is a greater x_m in every line"),
        (with(9, "1.5,0"), "line 9: x_m = 1.5 after 6; allowed is a greater x_m in every line"),
        (with(9, "7,1e308"), "line 9: z_m = 1e308; allowed is from -1e3 to 1e3 m"),
        (with(9, "1e305,0"), "line 9: x_m = 1e305; allowed is from -1e3 to 1e3 m"),
        (with(3, "1e-320,0"), "line 3: a step of 1e-320 m; allowed is 1e-12 m or more"),
        (with(9, "6.8,0"), "line 9: x_m is printed to 1.0e0 m, and a step of 8.0e-1 m ends here; "),
        (fine[..LEAST_POINTS].join("\n"), "19 points; allowed is 20 or more"),
        (gap, "line 12: a step of 1.1e1 m; allowed is up to 10 times the shortest step, 1e0 m"),
    ] {
        let error = Profile::parse(text.as_bytes()).expect_err(expected).to_string();
        assert!(error.starts_with(expected), "{error}\n{expected}");
    }
}

/// A plane with a tilt of 1.1 %, whose points are 156.25 nm apart.
const PLANE: [f64; 2] = [1.5625e-7, 1.71875e-9];

#[test]
fn a_tilted_plane_has_no_slope_however_coarsely_its_positions_are_printed() {
    let [step_m, rise_m] = PLANE;
    // As printed, the coarsest digits make a slope of 0.0035 and an RMS slope of 0.0040 of it.
    for decimals in 7..=12 {
        let line = |n: u32| {
            format!("{:.decimals$},{:.11e}\n", f64::from(n) * step_m, f64::from(n) * rise_m)
        };
        let text = "x_m,z_m\n".to_owned() + &(0..40).map(line).collect::<String>();
        let profile = Profile::parse(text.as_bytes()).expect("a profile");
        let Roughness { rdq, slope_rad, .. } = profile.roughness();
        assert!(rdq < 1e-12 && slope_rad < 1e-12, "{decimals}: {rdq} {slope_rad}");
        // 156.25 nm is a whole number of 1e-11 m.
        match profile.equal_steps() {
            Some(steps) => {
                assert!(decimals < 11);
                assert!((steps.step_m - step_m).abs() <= steps.uncertainty_m, "{steps:?}");
            }
            None => assert!(decimals >= 11),
        }
    }
}

#[test]
fn coarsely_printed_positions_change_a_sine_by_no_more_than_the_error_of_their_step() {
    let (sine, expected) = golden()[2];
    let points = || sine.sampled(10.0, 4000);
    let step_m = 10.0 * sine.1 / 4000.0;
    let unit_m = 10_f64.powi(step_m.log10().floor() as i32);
    let decimals = -unit_m.log10().round() as usize;
    let mut text = String::from("x_m,z_m\n");
    for (x_m, z_m) in points() {
        writeln!(text, "{x_m:.decimals$},{z_m}").expect("text grows");
    }
    let profile = Profile::parse(text.as_bytes()).expect("a profile");
    let found = profile.roughness();
    let allowed = profile.equal_steps().map_or(0.0, |steps| steps.uncertainty_m / steps.step_m);
    assert!(relative(found.rdq, expected.rdq) < allowed + 1e-7, "{found:?} {allowed}");
    assert!(relative(found.slope_rad, expected.slope_rad) < allowed + 1e-5, "{found:?}");
    assert!(relative(rsm_m(&found), rsm_m(&expected)) < allowed + 1e-7, "{found:?}");
}

#[test]
fn slopes_that_are_those_of_rounded_heights_are_refused() {
    let [step_m, rise_m] = PLANE;
    let plane = |decimals: usize| {
        let line =
            |n: u32| format!("{},{:.decimals$}\n", f64::from(n) * step_m, f64::from(n) * rise_m);
        "x_m,z_m\n".to_owned() + &(0..400).map(line).collect::<String>()
    };
    for decimals in 7..=10 {
        let error = Profile::parse(plane(decimals).as_bytes()).expect_err("coarse").to_string();
        assert!(error.starts_with(&format!("z_m is printed to 1.0e-{decimals} m, ")), "{error}");
    }
    let found = Profile::parse(plane(11).as_bytes()).expect("a profile").roughness();
    assert!(found.rdq < 1e-4 && found.slope_rad < 1e-4, "{found:?}");
}

#[test]
fn files_may_have_comments_spaces_and_other_columns() {
    let points: Vec<_> = Sine(1e-6, 1e-3, 0.0).sampled(4.0, 80).collect();
    let mut text = String::from("# stylus, 2 um\nn, z_m , x_m\n");
    for (n, (x_m, z_m)) in points.iter().enumerate() {
        writeln!(text, "{n}, {z_m:e} ,\t{x_m}").expect("text grows");
    }
    let found = Profile::parse(text.as_bytes()).expect("a profile").roughness();
    assert_eq!(found, measure(points));
}

#[test]
fn example_profile_has_the_roughness_stated_in_its_first_line() {
    let path = format!("{}/../../scenes/profile.csv", env!("CARGO_MANIFEST_DIR"));
    let found = Profile::read(Path::new(&path)).expect("the example").roughness();
    // Gaussian heights of 3 µm with correlation exp(-x²/l²), l = 50 µm: Rdq = sqrt 2 Rq / l. 80 correlation
    // lengths are few: a tenth of scatter.
    assert!(relative(found.rq_m, 3e-6) < 0.1, "{found:?}");
    assert!(relative(found.rdq, 2_f64.sqrt() * found.rq_m / 50e-6) < 0.1, "{found:?}");
    assert!(relative(found.slope_rad, average_slope_rad(found.rdq)) < 0.05, "{found:?}");
}
