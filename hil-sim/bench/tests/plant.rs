//! The benchmark of the plant as its user runs it, in few rounds: what does not depend on the host's speed.
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::LazyLock;

use serde_json::Value;

static RUN: LazyLock<Value> = LazyLock::new(|| {
    let done = Command::new(env!("CARGO_BIN_EXE_model-bench"))
        .args(["plant", "--json", "--rounds", "3", "--out"])
        .arg(out())
        .stderr(Stdio::inherit())
        .output()
        .expect("the benchmark starts");
    assert!(done.status.success(), "the benchmark ends well");
    serde_json::from_slice(&done.stdout).expect("one JSON object on standard output")
});

fn out() -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("bench-plant")
}

fn rows(table: &str) -> &'static Vec<Value> {
    RUN[table].as_array().expect("a table")
}

fn number(value: &Value, pointer: &str) -> f64 {
    value
        .pointer(pointer)
        .and_then(Value::as_f64)
        .unwrap_or_else(|| panic!("{pointer} of {value} is a number"))
}

fn column(table: &str, pointer: &str) -> Vec<f64> {
    rows(table).iter().map(|row| number(row, pointer)).collect()
}

/// Mesh and time step of a simulated run keep the plant's required accuracy against the contact equations.
#[test]
fn the_discretization_of_a_run_is_accurate() {
    let of_runs: Vec<_> = (rows("meshes").iter().chain(rows("steps")))
        .filter(|row| row["growth"] == 1.12 && row["step_ms"] == 1.0)
        .collect();
    assert_eq!(of_runs.len(), 2);
    for row in of_runs {
        assert_eq!(row["cells"], RUN["cells"], "{row}");
        assert!(number(row, "/errors/counted/surface_mk") < 1.0, "{row}");
        assert!(number(row, "/errors/counted/flux") < 1e-4, "{row}");
        assert!(number(row, "/errors/before/surface_mk") < 3.0, "{row}");
    }
}

/// Errors inside a body fall with the square of the growth of its cells.
#[test]
fn finer_meshes_are_more_accurate_inside() {
    let growth = column("meshes", "/growth");
    let cells = column("meshes", "/cells");
    let inside = column("meshes", "/errors/counted/inside_mk");
    for i in 1..growth.len() {
        assert!(cells[i] > cells[i - 1], "{cells:?}");
        let order = (inside[i - 1] / inside[i]).ln() / (growth[i - 1].ln() / growth[i].ln()).ln();
        assert!((1.5..2.5).contains(&order), "{order} from {inside:?}");
    }
}

#[test]
fn shorter_steps_are_more_accurate_at_the_surface() {
    let steps = column("steps", "/step_ms");
    assert_eq!(steps, [0.5, 1.0, 2.0, 4.0]);
    for name in ["surface_mk", "flux"] {
        let errors = column("steps", &format!("/errors/counted/{name}"));
        assert!(errors.windows(2).all(|pair| pair[1] > 1.5 * pair[0]), "{errors:?}");
    }
}

/// Times depend on the host, but are consistent with each other.
#[test]
fn costs_are_consistent() {
    let fingers = column("fingers", "/fingers");
    assert_eq!(fingers, [1.0, 2.0, 5.0, 10.0, 20.0, 40.0]);
    assert_eq!(number(&RUN["fingers"][0], "/ratio"), 1.0);
    for table in ["fingers", "parts", "meshes", "steps"] {
        for row in rows(table) {
            let product = number(row, "/ns") * number(row, "/times_real_time");
            assert!((product / 1e6 - 1.0).abs() < 1e-9, "{row}");
            assert!(
                number(row, "/least_ns") > 0.0 && number(row, "/least_ns") <= number(row, "/ns"),
                "{row}"
            );
        }
    }
    for row in rows("steps") {
        let per_step = number(row, "/step_ns") / number(row, "/step_ms");
        assert!((per_step / number(row, "/ns") - 1.0).abs() < 1e-9, "{row}");
    }
}

#[test]
fn page_and_picture_are_written() {
    LazyLock::force(&RUN);
    let page = std::fs::read_to_string(out().join("plant-benchmark.md")).expect("a page");
    for row in rows("parts") {
        let name = row["name"].as_str().expect("a name");
        assert!(page.contains(name), "{name}");
    }
    assert!(page.contains("(plant-benchmark.svg)"));
    let picture = std::fs::read_to_string(out().join("plant-benchmark.svg")).expect("a picture");
    assert!(picture.starts_with("<svg"));
    for name in ["1.03", "0.5 ms", "receptors / mK"] {
        assert!(picture.contains(name), "{name}");
    }
}
