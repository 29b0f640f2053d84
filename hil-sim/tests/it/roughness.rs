//! `hil-sim roughness`.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use thermal_thesis::roughness::Profile;

use super::{command, temporary};

fn roughness(profile: &Path) -> (Option<i32>, String, String) {
    command(&["roughness", profile.to_str().expect("a path")])
}

fn file(name: &str, text: &str) -> PathBuf {
    let path = temporary(name);
    std::fs::write(&path, text).expect("a file");
    path
}

/// Text of a profile with a height, m, at every other micrometre of 8 mm.
fn profile(z_m: impl Fn(f64) -> f64) -> String {
    let points = (0..=4000).map(|n| 2e-6 * f64::from(n));
    let line = |x_m: f64| format!("{x_m},{}\n", z_m(x_m));
    "x_m,z_m\n".to_owned() + &points.map(line).collect::<String>()
}

#[test]
fn command_prints_the_parameters() {
    let sine = profile(|x_m| 3e-6 * (TAU * x_m / 0.8e-3).sin());
    let (status, out, error) = roughness(&file("sine.csv", &sine));
    assert_eq!((status, error.as_str()), (Some(0), ""));
    let found = Profile::parse(sine.as_bytes()).expect("a profile").roughness();
    let (header, row) = out.trim_end().split_once('\n').expect("two lines");
    assert_eq!(header, "rq_m,rdq,slope_rad,rsm_m");
    let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
    assert_eq!(cells, [found.rq_m, found.rdq, found.slope_rad, found.rsm_m.expect("an element")]);
    let (status, out, _) = roughness(&file("flat.csv", &profile(|_| 0.0)));
    assert_eq!((status, out.as_str()), (Some(0), "rq_m,rdq,slope_rad,rsm_m\n0,0,0,\n"));
}

#[test]
fn command_says_that_equal_steps_stand_in_place_of_the_printed_positions() {
    let points = (0..40).map(f64::from);
    let line = |n: f64| format!("{:.7},{}\n", n * 1.5625e-7, n * 1.71875e-9);
    let path =
        file("coarse.csv", &("x_m,z_m\n".to_owned() + &points.map(line).collect::<String>()));
    let (status, out, error) = roughness(&path);
    assert_eq!(status, Some(0));
    assert!(out.starts_with("rq_m,rdq,slope_rad,rsm_m\n"), "{out}");
    let expected = format!(
        "hil-sim: {}: x_m is printed to 1.0e-7 m; taken are equal steps of 1.5625e-7 m, within 3e-9 m\n",
        path.display()
    );
    assert_eq!(error, expected);
}

#[test]
fn command_names_file_and_line() {
    let path = file("short.csv", "x_m,z_m\n0,0\n1e-6,nan\n");
    let (status, out, error) = roughness(&path);
    assert_eq!((status, out.as_str()), (Some(2), ""));
    let expected =
        format!("hil-sim: {}: line 3: z_m = \"nan\"; allowed is a finite number\n", path.display());
    assert_eq!(error, expected);
    let (status, out, error) = roughness(Path::new("no such profile.csv"));
    assert_eq!((status, out.as_str()), (Some(2), ""));
    assert!(error.starts_with("hil-sim: no such profile.csv: "), "{error}");
}
