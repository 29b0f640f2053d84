//! Devices in every state, prepared once, because reaching a state takes hundreds of ticks.

use std::sync::OnceLock;

use thermal_display::device::safety::Fault;
use thermal_display::device::{FingerIndex, StateName};

use crate::device::CheckedDevice;

/// By this time an identification of the tile has ended; at a quarter of it, it drives pulses.
const IDENTIFIED_MS: u32 = 40_000;

/// Devices that an input can start with.
#[derive(Debug)]
pub struct StartDevices<const FINGERS: usize>(OnceLock<Vec<CheckedDevice<FINGERS>>>);

impl<const FINGERS: usize> StartDevices<FINGERS> {
    /// Prepares nothing yet.
    pub const fn new() -> Self {
        Self(OnceLock::new())
    }

    /// The device with this index, modulo their number: off, in self-test, armed, at the preset, in contact, ready,
    /// tripped, identifying the tile (begun, driving pulses, done), streaming telemetry in contact under the PI law, playing a
    /// course and waiting for a landing to play one, with events; in contact with a heat-flux sensor.
    pub fn get(&self, index: u8) -> CheckedDevice<FINGERS> {
        let all = self.0.get_or_init(|| {
            let device_after = |lines: &[&str], force_n: f64, ticks: u32| {
                let mut device = CheckedDevice::<FINGERS>::new();
                device.run(300);
                for line in lines {
                    assert!(device.line(line).is_ok(), "{line}");
                    if *line == "arm" {
                        device.run(800);
                    }
                }
                device.press_all(force_n);
                device.run(ticks);
                device
            };
            let off = device_after(&[], 0.0, 0);
            let mut testing = off.clone();
            assert!(testing.line("arm").is_ok());
            testing.run(35);
            let armed = device_after(&["arm"], 0.0, 100);
            let preset = device_after(&["material granite", "arm", "start"], 0.0, 100);
            let contact = device_after(&["material copper", "arm", "start"], 2.0, 300);
            let ready = device_after(&["arm", "abort"], 0.0, 10);
            let mut tripped = device_after(&["material abs", "arm"], 0.0, 0);
            tripped.trip_all(Fault::Bridge);
            let identifying = device_after(&["arm", "stream 20", "tune"], 0.0, 300);
            let mut driving_pulses = identifying.clone();
            let mut identified = identifying.clone();
            for ms in 0..IDENTIFIED_MS {
                if ms == IDENTIFIED_MS / 4 {
                    driving_pulses = identified.clone();
                }
                identified.note_host_activity();
                identified.run(1);
            }
            let answer = identified.clone().line("@0 tune result");
            assert!(answer.is_ok(), "{answer:?}");
            let streaming = device_after(
                &["law pi", "object 20", "material foam", "arm", "start", "stream 1"],
                0.5,
                50,
            );
            let pulse = "pulse 24 40 20 0.1 20";
            let with_course = |play: &str| {
                let course = format!("{pulse} {play}");
                // An untuned tile refuses so fast a course.
                let tuned = "set tile 2.957 0.0585 0.104 0.1 0.016";
                device_after(&[tuned, "stream 10", "events on", "arm", &course], 0.0, 50)
            };
            let playing = with_course("now 100");
            let waiting = with_course("landing 3 neutral");
            let sensor = "flux set 0.1192 2048 5 30";
            let learning = device_after(&[sensor, "material granite", "arm", "start"], 2.0, 1000);
            let mut all = vec![
                off,
                testing,
                armed,
                preset,
                contact,
                ready,
                tripped,
                identifying,
                driving_pulses,
                identified,
                streaming,
                playing,
                waiting,
                learning,
            ];
            let states: Vec<_> =
                all.iter_mut().map(|device| device.state(FingerIndex::FIRST)).collect();
            let expected = [
                StateName::Off,
                StateName::SelfTest,
                StateName::Armed,
                StateName::Preset,
                StateName::Contact,
                StateName::Ready,
                StateName::Tripped(Fault::Bridge),
                StateName::Armed,
                StateName::Armed,
                StateName::Armed,
                StateName::Contact,
                StateName::Stimulus,
                StateName::Stimulus,
                StateName::Contact,
            ];
            assert_eq!(states, expected);
            all
        });
        all[usize::from(index) % all.len()].clone()
    }
}
