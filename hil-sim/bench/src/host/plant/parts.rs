//! Parts of one finger, and fingers with an addition.
use std::hint::black_box;

use super::finger::{FORCE_N, Finger};
use super::replay::{Replay, scans};

/// A candidate to time, with its name.
pub type Candidate<'a> = Box<dyn FnMut() + 'a>;

/// Parts of one finger, and fingers with an addition.
pub struct Parts {
    ticks: usize,
    still: Finger,
    replay: Replay,
    moving: Finger,
    streaming: Finger,
    /// Error of a streaming finger, if it sent a line other than telemetry.
    heard: anyhow::Result<()>,
}

impl Parts {
    /// Prepares all parts in contact, to be run for `ticks` in a round.
    ///
    /// # Errors
    /// The device refused its set-up, or is not in contact.
    pub fn new(ticks: usize) -> anyhow::Result<Self> {
        let mut streaming = Finger::in_contact(1)?;
        streaming.stream();
        Ok(Self {
            ticks,
            still: Finger::in_contact(1)?,
            replay: Replay::record(1, ticks)?,
            moving: Finger::in_contact(1)?,
            streaming,
            heard: Ok(()),
        })
    }

    /// The candidates.
    pub fn candidates(&mut self) -> Vec<(&'static str, Candidate<'_>)> {
        let Self { ticks, still, replay, moving, streaming, heard } = self;
        let ticks = *ticks;
        let legs = still.legs();
        let mut plant = still.plant();
        let mut converted = still.plant();
        let mut ms = 0u32;
        vec![
            (
                "plant, truth and sensors",
                Box::new(move || (0..ticks).for_each(|_| plant.step(black_box(&legs)))),
            ),
            (
                "converter: 16 scans of 8 channels",
                Box::new(move || {
                    for _ in 0..ticks {
                        black_box(scans(&mut converted));
                    }
                }),
            ),
            (
                "the firmware's logic",
                Box::new(|| {
                    black_box(replay.run());
                }),
            ),
            (
                "all, with a force that moves in every ms",
                Box::new(move || {
                    for _ in 0..ticks {
                        // A triangle of 0.5 N with a period of two seconds.
                        let part = (f64::from(ms % 2000) * 1e-3 - 1.0).abs();
                        moving.step(FORCE_N - 0.5 * part);
                        ms += 1;
                    }
                }),
            ),
            (
                "all, with every tick streamed and parsed",
                Box::new(move || {
                    for _ in 0..ticks {
                        if let Err(error) = streaming.step_and_listen() {
                            *heard = Err(error);
                        }
                    }
                }),
            ),
        ]
    }

    /// Checks that all fingers are still in contact and sent nothing but telemetry.
    ///
    /// # Errors
    /// A finger has left the contact, or sent a line other than telemetry.
    pub fn check(mut self) -> anyhow::Result<()> {
        self.heard?;
        self.moving.check_contact()
    }
}
