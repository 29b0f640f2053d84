//! What tuning finds, against the plant's own parameters and a fit of the plate's true temperature.

use hil_sim::commission::{Plants, of_device};
use hil_sim::engine::Native;
use hil_sim::plant::tile::TileParams;

use super::{ROOM_C, bench, device};

/// One millisecond: plate, deg C; current, A; current asked for, A.
type Row = (f64, f64, f64);

/// What the device says of its tile: gain, Joule's term, leak, lag, dead time.
struct Found([f64; 5]);

/// Lets a calibrated device tune itself, and watches the truth.
fn tune(plants: &Plants, seed: u64) -> (Found, Vec<Row>) {
    let settings = of_device(plants.params(), ROOM_C, seed).expect("settings");
    let mut engine = Native::new(plants.at_work().expect("a plant"));
    let mut bench = bench(&mut engine, &settings);
    bench.wait(5).expect("it runs");
    for line in ["arm", "tune", "stream 1"] {
        bench.tell(line).expect("obeyed");
    }
    let mut rows = Vec::new();
    for ms in 1..70_000 {
        let ask = (ms % 1000 == 0).then_some(&b"tune result\n"[..]);
        let lines = bench.millisecond(ask).expect("it runs");
        let (display_c, current_a) = {
            let plant = bench.world().plant();
            (plant.display_c(), plant.current_a())
        };
        for line in lines {
            if let Some(rest) = line.strip_prefix("ok gain=") {
                let numbers: Vec<f64> = rest
                    .split(' ')
                    .take(5)
                    .filter_map(|word| word.rsplit('=').next()?.parse().ok())
                    .collect();
                return (Found(numbers.try_into().expect("five numbers")), rows);
            }
            if let Some(asked) = line.strip_prefix("T ").and_then(|rest| rest.split(' ').nth(8)) {
                rows.push((display_c, current_a, asked.parse().expect("a current")));
            }
            assert!(
                !line.starts_with("err") || line.starts_with("err tuning goes on"),
                "{line}"
            );
        }
    }
    panic!("no result");
}

/// Solves a small system.
fn solve(mut a: Vec<Vec<f64>>) -> Vec<f64> {
    let n = a.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&x, &y| a[x][i].abs().total_cmp(&a[y][i].abs()));
        a.swap(i, pivot.expect("a row"));
        let (above, below) = a.split_at_mut(i + 1);
        let row = &above[i];
        for other in below {
            let factor = other[i] / row[i];
            for (x, y) in other.iter_mut().zip(row).skip(i) {
                *x -= factor * y;
            }
        }
    }
    let mut x = vec![0.0; n];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| a[i][k] * x[k]).sum();
        x[i] = (a[i][n] - known) / a[i][i];
    }
    x
}

/// Gain per current asked for of the plate itself, K/s/A: least squares of its true temperature under the true current.
/// How much heat the legs take up, and when, is known of the plant.
fn true_gain(rows: &[Row], tile: &TileParams) -> f64 {
    // The first pulse is a jump upwards that no loop makes.
    let first = (1..rows.len())
        .find(|&i| i > 1200 && rows[i].2 - rows[i - 1].2 > 1.3)
        .expect("a pulse");
    let rest = &rows[first - 400..first];
    let mean = |of: fn(&Row) -> f64| rest.iter().map(of).sum::<f64>() / rest.len() as f64;
    let (rest_c, rest_a) = (mean(|row| row.0), mean(|row| row.1));
    let plate_j_k = tile.plate_m2() * tile.ceramic_m * tile.ceramic_j_m3k + tile.tabs_j_k;
    let part = tile.legs_j_k / 3.0 / plate_j_k;
    let legs_s = tile.legs_j_k / tile.conductance_w_k();
    let (legs_part, legs_lag_s, heat_lag_s) =
        (part / (1.0 + part), legs_s / 15.0 / (1.0 + part), legs_s / 12.0);
    let dt = 1e-3;
    let (mut late, mut heat) = (0.0, 0.0);
    let (mut u1, mut u2, mut v1, mut v2, mut y1, mut y2) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    let (mut asked_asked, mut asked_true) = (0.0, 0.0);
    let mut normal = vec![vec![0.0; 7]; 6];
    for (i, (display_c, current_a, _)) in rows[first..].iter().take(8000).enumerate() {
        // What is asked for flows in the tick after.
        let asked_a = rows[first + i - 1].2;
        asked_asked += asked_a * asked_a;
        asked_true += asked_a * current_a;
        let u = current_a - rest_a;
        late += (u - late) * dt / legs_lag_s;
        heat += (current_a * current_a - rest_a * rest_a - heat) * dt / heat_lag_s;
        u1 += (u - legs_part * late) * dt;
        u2 += u1 * dt;
        v1 += heat * dt;
        v2 += v1 * dt;
        y1 += (display_c - rest_c) * dt;
        y2 += y1 * dt;
        let t = dt * i as f64;
        let equation = [-u2, u1, v2, -y2, t, 0.5 * t * t, y1];
        for (row, a) in normal.iter_mut().zip(&equation) {
            for (sum, b) in row.iter_mut().zip(&equation) {
                *sum += a * b;
            }
        }
    }
    solve(normal)[0] * asked_true / asked_asked
}

#[test]
fn tile_is_identified_over_the_box() {
    let mut worst = [0.0f64; 2];
    for draw in 0..24 {
        let plants = device((draw > 0).then_some(draw), draw);
        let (Found([gain, joule, leak, lag_s, dead_s]), rows) = tune(&plants, draw);
        let params = plants.params();
        let true_lag_s = params.sensors.thermistors[0].lag_s;
        let expected = true_gain(&rows, &params.tile);
        println!(
            "draw {draw}: gain {gain:.3} of {expected:.3} K/s/A, lag {:.1} of {:.1} ms, joule {joule:.4}, leak {leak:.4}, \
             dead {:.1} ms",
            1e3 * lag_s,
            1e3 * true_lag_s,
            1e3 * dead_s
        );
        worst[0] = worst[0].max((gain / expected - 1.0).abs());
        worst[1] = worst[1].max((lag_s - true_lag_s).abs() / (0.05 * true_lag_s).max(3e-3));
    }
    println!(
        "worst: gain {:.2} %, lag {:.2} of what is allowed",
        1e2 * worst[0],
        worst[1]
    );
}
