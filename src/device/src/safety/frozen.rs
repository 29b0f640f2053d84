//! Detects signals whose samples repeat.

use super::Fault;
use crate::sense::Samples;

/// Ticks of identical samples after which a channel is frozen. Noise moves the sum of 16 conversions by 3 units, so a sum
/// repeats once in ten ticks by chance, and never 46 times in a row. With the tick in which the signal freezes, and the one
/// in which the bridge is switched off, the fault lasts less than 50 ms.
pub const FROZEN_TICKS: u8 = 46;
/// When one channel is frozen, and all others have repeated for this long, the converter itself is.
const ALL_CHANNELS_TICKS: u8 = 30;
/// The thermistors and the force. The current is left out: it is zero while the bridge is off.
const CHANNELS: usize = 6;
const FAULTS: [Fault; CHANNELS] = [
    Fault::DisplayFrozen,
    Fault::CheckFrozen,
    Fault::SinkFrozen,
    Fault::SkinFrozen,
    Fault::RoomFrozen,
    Fault::ForceFrozen,
];

/// The last sample of each channel, and how often it has repeated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrozenDetector {
    last: [u16; CHANNELS],
    ticks: [u8; CHANNELS],
}

impl FrozenDetector {
    /// Takes the samples of one tick.
    ///
    /// # Errors
    /// A channel is frozen, or all are.
    pub fn check(&mut self, samples: &Samples) -> Result<(), Fault> {
        let [display, check, sink, skin, room] = samples.thermistor_sums();
        let now = [display, check, sink, skin, room, samples.force];
        let mut frozen = None;
        for (i, now) in now.into_iter().enumerate() {
            let same = now == self.last[i];
            self.last[i] = now;
            let ticks = if same {
                self.ticks[i].saturating_add(1)
            } else {
                0
            };
            self.ticks[i] = ticks;
            if ticks >= FROZEN_TICKS {
                frozen = frozen.or(Some(FAULTS[i]));
            }
        }
        match frozen {
            None => Ok(()),
            Some(_) if self.ticks.iter().all(|ticks| *ticks >= ALL_CHANNELS_TICKS) => {
                Err(Fault::SamplesFrozen)
            }
            Some(one) => Err(one),
        }
    }
}
