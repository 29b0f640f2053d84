//! Devices in every state, made once: getting there takes hundreds of ticks.

use std::sync::OnceLock;

use thermal_display::device::safety::{Fault, State};

use crate::device::Device;

/// An experiment has ended by now; at a quarter of it, it drives.
const TUNED_MS: u32 = 40_000;

/// Where a run of inputs begins.
#[derive(Debug)]
pub struct Starts<const FINGERS: usize>(OnceLock<Vec<Device<FINGERS>>>);

impl<const FINGERS: usize> Starts<FINGERS> {
    /// None are made yet.
    pub const fn new() -> Self {
        Self(OnceLock::new())
    }

    /// One of them, counted modulo their number: off, in self-test, armed, at a preset, in contact, ready, tripped, tuning
    /// (just begun, on its way, done), streaming in contact by the plain law.
    pub fn get(&self, which: u8) -> Device<FINGERS> {
        let all = self.0.get_or_init(|| {
            let lead = |lines: &[&str], newton: f64, ticks: usize| {
                let mut device = Device::<FINGERS>::new();
                (0..300).for_each(|_| device.tick());
                for line in lines {
                    assert!(device.line(line).is_ok(), "{line}");
                    if *line == "arm" {
                        (0..800).for_each(|_| device.tick());
                    }
                }
                (0..FINGERS).for_each(|finger| device.tile(finger).press(newton));
                (0..ticks).for_each(|_| device.tick());
                device
            };
            let off = lead(&[], 0.0, 0);
            let mut testing = off.clone();
            assert!(testing.line("arm").is_ok());
            (0..35).for_each(|_| testing.tick());
            let armed = lead(&["arm"], 0.0, 100);
            let preset = lead(&["material granite", "arm", "start"], 0.0, 100);
            let contact = lead(&["material copper", "arm", "start"], 2.0, 300);
            let ready = lead(&["arm", "abort"], 0.0, 10);
            let mut tripped = lead(&["material abs", "arm"], 0.0, 0);
            tripped.trip(Fault::Bridge);
            let tuning = lead(&["arm", "stream 20", "tune"], 0.0, 300);
            let mut on_the_way = tuning.clone();
            let mut tuned = tuning.clone();
            for ms in 0..TUNED_MS {
                if ms == TUNED_MS / 4 {
                    on_the_way = tuned.clone();
                }
                tuned.hear();
                tuned.tick();
            }
            let answer = tuned.clone().line("@0 tune result");
            assert!(answer.is_ok(), "{answer:?}");
            let streaming = lead(
                &[
                    "law pi",
                    "object 20",
                    "material foam",
                    "arm",
                    "start",
                    "stream 1",
                ],
                0.5,
                50,
            );
            let mut all = vec![
                off, testing, armed, preset, contact, ready, tripped, tuning, on_the_way, tuned,
                streaming,
            ];
            let states: Vec<_> = all
                .iter_mut()
                .map(|device| device.status(0).state)
                .collect();
            let expected = [
                State::Off,
                State::SelfTest,
                State::Armed,
                State::Preset,
                State::Contact,
                State::Ready,
                State::Tripped(Fault::Bridge),
                State::Armed,
                State::Armed,
                State::Armed,
                State::Contact,
            ];
            assert_eq!(states, expected);
            all
        });
        all[usize::from(which) % all.len()].clone()
    }
}
