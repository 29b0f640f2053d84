//! One finger taken apart, and with something added.
use std::hint::black_box;

use super::finger::{FORCE_N, Finger};
use super::replay::{Replay, scans};

/// What is timed.
pub type Candidate<'a> = Box<dyn FnMut() + 'a>;

/// One finger taken apart, and with something added.
pub struct Parts {
    ticks: usize,
    still: Finger,
    replay: Replay,
    moving: Finger,
    streaming: Finger,
    /// What a finger that streams said, if that was no telemetry.
    heard: anyhow::Result<()>,
}

impl Parts {
    /// All of it in contact, to be run for `ticks` in a round.
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

    /// What to time, with its name.
    pub fn candidates(&mut self) -> Vec<(&'static str, Candidate<'_>)> {
        let Self {
            ticks,
            still,
            replay,
            moving,
            streaming,
            heard,
        } = self;
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
                "converter: 16 scans of 7 channels",
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
                        // Up and down by 0.5 N in a second.
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

    /// Makes sure that every part has been what it was meant to be.
    ///
    /// # Errors
    /// A finger has left the contact, or said what is no telemetry.
    pub fn check(mut self) -> anyhow::Result<()> {
        self.heard?;
        self.moving.check_contact()
    }
}
