//! What a calibrated device reads, against what is.

use documented_figures::{assert_figure, assert_sampled, one_case_in};
use thermal_sim::commissioning::{CommissioningSetup, settings_for_device};
use thermal_sim::engine::NativeEngine;

use super::{PERFECT, ROOM_C, bench, device, mean, wait};

/// Time over which a reading is averaged, and before it, ms: its noise is then 0.3 mK.
const MEAN_MS: u64 = 250;
const REST_MS: u64 = 20;

/// Errors over a range, mK: root mean square, largest.
#[derive(Debug, Default)]
struct Errors {
    rms: f64,
    worst: f64,
}

fn errors(all: &[f64]) -> Errors {
    Errors {
        rms: 1e3 * (all.iter().map(|e| e * e).sum::<f64>() / all.len() as f64).sqrt(),
        worst: 1e3 * all.iter().fold(0.0, |worst: f64, e| worst.max(e.abs())),
    }
}

/// Temperatures of a range, 0.15 K apart: every one of the converter's segments has 20, and its border up to one.
fn range(from_c: f64, to_c: f64) -> impl Iterator<Item = f64> {
    (0..).map(move |i| from_c + 0.15 * f64::from(i)).take_while(move |t| *t <= to_c)
}

/// Errors of display, skin, room and sink of a device with some settings.
fn sweep(plants: &CommissioningSetup, seed: u64, settings: &[String]) -> [Vec<f64>; 4] {
    // Without a film of air the display stays where its sink is, and its sensor does not trail behind it.
    let mut params = plants.params().clone();
    params.tile.film_w_m2k = 0.0;
    let plants = &CommissioningSetup::new(&params, ROOM_C, seed);
    let mut engine = NativeEngine::new(plants.in_use().expect("a plant"));
    let mut bench = bench(&mut engine, settings);
    let mut all: [Vec<f64>; 4] = Default::default();
    for t_c in range(15.0, 42.0) {
        // The display rests at the temperature of the sink, in the room that it was calibrated in.
        *bench.link().world() = plants.sink_on_coolant(t_c).expect("a plant");
        wait(&mut bench, REST_MS);
        let (read, truth) =
            mean(&mut bench, |line| line.display_c, MEAN_MS, |world| world.plant().display_c());
        all[0].push(read - truth);
        let (read, truth) =
            mean(&mut bench, |line| line.sink_c, MEAN_MS, |world| world.plant().sink_c());
        all[3].push(read - truth);
    }
    for t_c in range(27.0, 37.0) {
        *bench.link().world() = plants.skin_in_bath(t_c).expect("a plant");
        wait(&mut bench, REST_MS);
        all[1].push(mean(&mut bench, |line| line.skin_c, MEAN_MS, |_| 0.0).0 - t_c);
    }
    for t_c in range(18.0, 30.0) {
        *bench.link().world() = plants.room_in_bath(t_c).expect("a plant");
        wait(&mut bench, REST_MS);
        all[2].push(mean(&mut bench, |line| line.room_c, MEAN_MS, |_| 0.0).0 - t_c);
    }
    all
}

/// With a perfect reference thermometer. Where noise mixes both sides of one of the converter's steps, in two codes on
/// either side, its distance across is unknown to the device: up to half of the step is left there.
#[test]
fn calibrated_readings_are_within_millikelvins() {
    let devices = [(None, 1), (None, 2), (Some(4), 4), (Some(6), 6), (Some(8), 8)];
    let mut worst: [Errors; 2] = Default::default();
    for (draw, seed) in devices.into_iter().step_by(one_case_in(2)) {
        let plants = device(draw, seed);
        assert_eq!(plants.params().host, PERFECT);
        let settings = settings_for_device(plants.params(), ROOM_C, seed).expect("settings");
        let (before, after) = (sweep(&plants, seed, &[]), sweep(&plants, seed, &settings));
        println!("draw {draw:?} seed {seed}");
        let sensors = ["display", "skin", "room", "sink"];
        for ((sensor, before), all) in sensors.iter().zip(&before).zip(&after) {
            let (before, after) = (errors(before), errors(all));
            println!(
                "  {sensor}: {:.1} RMS, {:.1} worst before; {:.2} RMS, {:.1} mK worst after",
                before.rms, before.worst, after.rms, after.worst
            );
            let worst = &mut worst[usize::from(*sensor != "display")];
            worst.rms = worst.rms.max(after.rms);
            worst.worst = worst.worst.max(after.worst);
            if (*sensor, draw, seed) == ("display", None, 1) {
                assert_figure("calibration.display_before", before.rms);
                assert_figure("calibration.display_nominal", after.rms);
            }
            let beyond = all.iter().filter(|error| error.abs() > 6e-3).count();
            if *sensor != "sink" {
                assert!(beyond * 30 < all.len(), "{sensor}: {beyond} of {}", all.len());
            }
            // The box has sensors that happen to be good, but no device whose sensors are.
            assert!(*sensor != "display" || before.rms > 5.0 * after.rms, "{sensor}: {before:?}");
        }
    }
    for (group, worst) in ["display", "others"].iter().zip(&worst) {
        assert_sampled(&format!("calibration.{group}_rms"), worst.rms);
        assert_sampled(&format!("calibration.{group}_worst"), worst.worst);
    }
}

/// The device is as good as the host's reference thermometer.
#[test]
fn what_the_reference_shows_too_much_the_device_reads_too_much() {
    let mut params = device(None, 1).params().clone();
    params.host.reference_offset_k = 0.05;
    let plants = CommissioningSetup::new(&params, ROOM_C, 1);
    let settings = settings_for_device(&params, ROOM_C, 1).expect("settings");
    for (sensor, all) in sweep(&plants, 1, &settings).iter().enumerate() {
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        assert!((mean - 0.05).abs() < 4e-3, "{sensor}: {mean}");
    }
}
