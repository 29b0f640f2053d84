//! Any settings that lines can set, and what is read by them.

use arbitrary::{Arbitrary, Unstructured};
use thermal_display::commissioning::SENSOR_WORDS;
use thermal_display::device::Finger;

use crate::device::{CheckedDevice, READING_ERROR_MAX_K};
use crate::start::StartDevices;
use crate::tile::celsius_at;

static STARTS: StartDevices<1> = StartDevices::new();

/// Values in parts of their ranges, and sums that are then read.
#[derive(Arbitrary, Debug)]
struct Stored {
    steps: [i16; 13],
    corrections: [[i16; 3]; 5],
    tile: [u16; 5],
    sums: Vec<u16>,
}

impl Stored {
    /// The lines that set them.
    fn lines(&self) -> Vec<String> {
        // Half of all values are at an end, where the others are worst.
        let part = |value: i16, most: f64| most * (f64::from(value) / 16384.0).clamp(-1.0, 1.0);
        let mut lines = Vec::new();
        for (block, steps) in self.steps.chunks(7).enumerate() {
            let steps = steps.iter().map(|step| format!(" {:.3}", part(*step, 4.0)));
            lines.push(format!(
                "set steps {}{}",
                10 + 7 * block,
                steps.collect::<String>()
            ));
        }
        for (name, [offset, slope, curvature]) in SENSOR_WORDS.iter().zip(self.corrections) {
            let (offset, slope) = (part(offset, 1.2), part(slope, 0.05));
            let curvature = part(curvature, 0.002);
            lines.push(format!(
                "set correction {name} {offset:.6} {slope:.7} {curvature:.8}"
            ));
        }
        let ranges = [
            (0.1, 15.0),
            (0.0, 0.5),
            (0.0, 5.0),
            (0.001, 5.0),
            (0.0, 1.0),
        ];
        let tile = self.tile.iter().zip(ranges).map(|(value, (least, most))| {
            format!(
                " {:.6}",
                least + (most - least) * f64::from(*value) / 65535.0
            )
        });
        lines.push(format!("set tile{}", tile.collect::<String>()));
        lines
    }
}

/// What the device says that it has.
fn told(device: &mut CheckedDevice<1>) -> Vec<String> {
    let lines = 1..=8;
    let said = lines.map(|line| match device.line(&format!("settings {line}")) {
        Ok(said) => said.trim_start_matches("ok ").to_string(),
        Err(error) => panic!("settings {line}: {error}"),
    });
    said.collect()
}

/// What is told is what is kept: said again to a new device, it tells the same. Then every sum is read by them.
pub fn run(input: &[u8]) -> bool {
    let Ok(stored) = Stored::arbitrary_take_rest(Unstructured::new(input)) else {
        return false;
    };
    let mut device = STARTS.get(2);
    for line in stored.lines() {
        if let Err(error) = device.line(&line) {
            panic!("{line:?}: {error}");
        }
    }
    let kept = told(&mut device);
    let mut again = STARTS.get(0);
    for line in &kept {
        if let Err(error) = again.line(line) {
            panic!("{line:?} is told, but answered {error}");
        }
    }
    assert_eq!(kept, told(&mut again));
    let _ = device.line("margins");
    let _ = device.line("stream 1");
    for &sum in stored.sums.iter().take(256) {
        device.tick_with(Finger::FIRST, |samples| {
            (samples.display, samples.display_check) = (sum, sum);
        });
        look_at_reading(sum, device.display_c());
        let _ = device.line("clear");
        let _ = device.line("arm");
    }
    true
}

/// Nothing that is set can hide from the guard what a display is like.
fn look_at_reading(sum: u16, reads_c: Option<f64>) {
    // Codes beyond 40 and 4060 are no thermistor's.
    if !(640..=64_960).contains(&sum) {
        assert_eq!(reads_c, None, "a display at sum {sum}");
        return;
    }
    let Some(reads_c) = reads_c else {
        panic!("no reading of sum {sum}");
    };
    let is_c = celsius_at(sum);
    if (13.0..=45.0).contains(&is_c) {
        let off_k = reads_c - is_c;
        assert!(
            off_k.abs() <= READING_ERROR_MAX_K,
            "{reads_c} C read of {is_c} C (sum {sum})"
        );
    }
}

/// The lines.
pub fn show(input: &[u8]) -> String {
    match Stored::arbitrary_take_rest(Unstructured::new(input)) {
        Ok(stored) => format!("{}\nthen sums {:?}", stored.lines().join("\n"), stored.sums),
        Err(error) => error.to_string(),
    }
}
