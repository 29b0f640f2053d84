//! Detects signals whose samples repeat.

use super::Fault;
use crate::sense::Samples;

/// Ticks of 1 ms in a row in which a channel's sample equals the one before, from which on the channel counts as
/// frozen. Noise moves the sum of 16 conversions by 3 units, so a sum repeats once in ten ticks by chance, and never 46
/// times in a row. With the tick in which the signal freezes, and the one in which the bridge is switched off, the
/// fault lasts less than 50 ms.
pub const FROZEN_TICKS: u8 = 46;
/// Ticks of 1 ms for which every channel must have repeated, when one has reached [`FROZEN_TICKS`], so that the
/// converter and not that one sensor is named as frozen. Fewer than [`FROZEN_TICKS`], because noise lets channels
/// repeat now and then.
const ALL_FROZEN_TICKS: u8 = 30;
/// Number of signals that are monitored: five thermistors and the force sensor. The current mirror is not, because its
/// sample is zero, and so repeats, while the bridge is off.
const MONITORED_CHANNELS: usize = 6;
/// Fault of each monitored channel, in the order in which [`FrozenDetector::check_samples`] lists their samples.
const CHANNEL_FAULTS: [Fault; MONITORED_CHANNELS] = [
    Fault::DisplayFrozen,
    Fault::CheckFrozen,
    Fault::SinkFrozen,
    Fault::SkinFrozen,
    Fault::RoomFrozen,
    Fault::ForceFrozen,
];

/// Detects a wire or converter that delivers a constant: remembers each monitored channel's last sample, and for how
/// many ticks in a row it has repeated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrozenDetector {
    previous: [u16; MONITORED_CHANNELS],
    repeats: [u8; MONITORED_CHANNELS],
}

impl FrozenDetector {
    /// Compares the samples of this tick with those of the tick before. To be called in every tick.
    ///
    /// # Errors
    /// The fault of the first frozen channel, or [`Fault::SamplesFrozen`] if all channels have repeated for 30 ticks by
    /// then.
    pub fn check_samples(&mut self, samples: &Samples) -> Result<(), Fault> {
        let [display, check, sink, skin, room] = samples.thermistor_sums();
        let now = [display, check, sink, skin, room, samples.force];
        let mut frozen = None;
        for (i, now) in now.into_iter().enumerate() {
            let same = now == self.previous[i];
            self.previous[i] = now;
            let ticks = if same {
                self.repeats[i].saturating_add(1)
            } else {
                0
            };
            self.repeats[i] = ticks;
            if ticks >= FROZEN_TICKS {
                frozen = frozen.or(Some(CHANNEL_FAULTS[i]));
            }
        }
        match frozen {
            None => Ok(()),
            Some(_) if self.repeats.iter().all(|ticks| *ticks >= ALL_FROZEN_TICKS) => {
                Err(Fault::SamplesFrozen)
            }
            Some(one) => Err(one),
        }
    }
}
