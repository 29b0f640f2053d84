//! `hil-sim infrared`.

use super::{command, number, rows};

fn infrared(arguments: &[&str]) -> (Option<i32>, String, String) {
    command(&[&["infrared"], arguments].concat())
}

/// The numbers of a good answer.
fn table(arguments: &[&str]) -> Vec<[f64; 3]> {
    let (status, out, error) = infrared(arguments);
    assert_eq!((status, error.as_str()), (Some(0), ""), "{arguments:?}");
    let mut lines = out.lines();
    assert_eq!(lines.next(), Some("u_tot,apparent_c,recovered_c"));
    let cells = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        cells.try_into().expect("three columns")
    };
    lines.map(cells).collect()
}

#[test]
fn command_meets_golden_round_trips() {
    for row in rows("plant/tests/data/infrared.csv") {
        let mut arguments = vec!["--optic", &row["optic"], "--target-c", &row["T_obj_C"]];
        arguments.extend(["--ambient-c", &row["T_amb_C"]]);
        if row["optic"] != "none" {
            arguments.extend(["--window-c", &row["T_opt1_C"], "--splitter-c", &row["T_opt2_C"]]);
        }
        let expected = ["U_tot", "T_apparent_C", "T_obj_C"].map(|column| number(&row, column));
        for (value, expected) in table(&arguments)[0].into_iter().zip(expected) {
            assert!((value - expected).abs() <= 1e-10, "{row:?}: {value}");
        }
    }
}

#[test]
fn command_takes_lists_and_the_optics_default_to_the_room() {
    let common = ["--optic", "zns", "--ambient-c", "24"];
    let both = table(&[&common[..], &["--target-c", "-5,27"]].concat());
    let given = ["--window-c", "24", "--splitter-c", "24", "--target-c"];
    assert_eq!(both[0], table(&[&common[..], &given[..], &["-5"]].concat())[0]);
    assert_eq!(both[1], table(&[&common[..], &given[..], &["27"]].concat())[0]);
    assert_eq!(both.len(), 2);
    let warm = table(&[&common[..], &["--target-c", "27", "--camera-c", "30"]].concat());
    assert!(warm[0][2] > 27.5, "{warm:?}");
    let noisy = ["--target-c", "27,27", "--netd-k", "0.08", "--seed", "5"];
    let noisy = table(&[&common[..], &noisy[..]].concat());
    assert!(noisy[0] != noisy[1] && (noisy[0][2] - 27.0).abs() < 2.0, "{noisy:?}");
}
