//! Settings within the ranges of the `set` lines, and the readings that follow from them.

use arbitrary::{Arbitrary, Unstructured};
use thermal_display::device::FingerIndex;
use thermal_display::device::safety::ThermistorId;
use thermal_display::settings::Vocabulary as _;

use crate::device::{CheckedDevice, READING_ERROR_MAX_K};
use crate::start::StartDevices;
use crate::tile::celsius_at;

static STARTS: StartDevices<1> = StartDevices::new();

/// Values as fractions of their ranges, and sums to read with them.
#[derive(Arbitrary, Debug)]
struct Input {
    steps: [i16; 13],
    corrections: [[i16; 3]; 5],
    tile: [u16; 5],
    sums: Vec<u16>,
}

impl Input {
    /// The `set` lines of the values.
    fn lines(&self) -> Vec<String> {
        // Half of all values are at an end of their range, the worst case.
        let fraction = |value: i16, max: f64| max * (f64::from(value) / 16384.0).clamp(-1.0, 1.0);
        let mut lines = Vec::new();
        for (line, steps) in self.steps.chunks(7).enumerate() {
            let steps = steps.iter().map(|step| format!(" {:.3}", fraction(*step, 4.0)));
            lines.push(format!("set steps {}{}", 10 + 7 * line, steps.collect::<String>()));
        }
        for (name, [offset, slope, curvature]) in
            ThermistorId::WORDS.words.iter().zip(self.corrections)
        {
            let (offset, slope) = (fraction(offset, 1.2), fraction(slope, 0.05));
            let curvature = fraction(curvature, 0.002);
            lines.push(format!("set correction {name} {offset:.6} {slope:.7} {curvature:.8}"));
        }
        let ranges = [(0.1, 15.0), (0.0, 0.5), (0.0, 5.0), (0.001, 5.0), (0.0, 1.0)];
        let tile = self.tile.iter().zip(ranges).map(|(value, (min, max))| {
            format!(" {:.6}", min + (max - min) * f64::from(*value) / 65535.0)
        });
        lines.push(format!("set tile{}", tile.collect::<String>()));
        lines
    }
}

/// The settings that the device reports, as `set` lines.
fn reported(device: &mut CheckedDevice<1>) -> Vec<String> {
    let report = |line| match device.line(&format!("settings {line}")) {
        Ok(answer) => answer.trim_start_matches("ok ").to_string(),
        Err(error) => panic!("settings {line}: {error}"),
    };
    (1..=8).map(report).collect()
}

/// Sends the settings that a device reports to a second one, which must report the same. Then reads every sum with them.
pub fn run(input: &[u8]) -> bool {
    let Ok(values) = Input::arbitrary_take_rest(Unstructured::new(input)) else {
        return false;
    };
    let mut device = STARTS.get(2);
    for line in values.lines() {
        if let Err(error) = device.line(&line) {
            panic!("{line:?}: {error}");
        }
    }
    let lines = reported(&mut device);
    let mut second = STARTS.get(0);
    for line in &lines {
        if let Err(error) = second.line(line) {
            panic!("{line:?} is reported, but refused: {error}");
        }
    }
    assert_eq!(lines, reported(&mut second));
    let _ = device.line("margins");
    let _ = device.line("stream 1");
    for &sum in values.sums.iter().take(256) {
        device.tick_with(FingerIndex::FIRST, |samples| {
            (samples.display, samples.display_check) = (sum, sum);
        });
        check_reading(sum, device.display_c());
        let _ = device.line("clear");
        let _ = device.line("arm");
    }
    true
}

/// No setting can hide an unsafe display temperature from the fault detectors.
fn check_reading(sum: u16, reading_c: Option<f64>) {
    // Outside of codes 40 to 4060 the thermistor counts as shorted or open.
    if !(640..=64_960).contains(&sum) {
        assert_eq!(reading_c, None, "a display at sum {sum}");
        return;
    }
    let Some(reading_c) = reading_c else {
        panic!("no reading of sum {sum}");
    };
    let true_c = celsius_at(sum);
    if (13.0..=45.0).contains(&true_c) {
        let error_k = reading_c - true_c;
        assert!(
            error_k.abs() <= READING_ERROR_MAX_K,
            "{reading_c} C read at {true_c} C (sum {sum})"
        );
    }
}

/// The lines and the sums.
pub fn show(input: &[u8]) -> String {
    match Input::arbitrary_take_rest(Unstructured::new(input)) {
        Ok(values) => format!("{}\nthen sums {:?}", values.lines().join("\n"), values.sums),
        Err(error) => error.to_string(),
    }
}
