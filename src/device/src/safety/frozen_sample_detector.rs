//! Detects signals whose samples repeat.

use super::Fault;
use crate::sense::Samples;

/// Number of ticks of 1 ms in a row in which a channel's sum of 16 conversions equals that of the tick before, from
/// which on the channel counts as frozen. The sum has noise of 3 units, so it repeats by chance in one tick of ten, and
/// never 46 times in a row. A frozen channel switches the bridge off less than 50 ms after the signal stops.
pub const FROZEN_TICKS: u8 = 46;
/// When one channel has repeated for [`FROZEN_TICKS`], all channels must have repeated for this number of ticks of 1 ms
/// for the converter, and not that one sensor, to be named as frozen. It is smaller than [`FROZEN_TICKS`], because by
/// chance one channel may have begun to repeat earlier than the others.
const CONVERTER_BLAMED_IF_ALL_FROZEN_TICKS: u8 = 30;
/// Number of signals that are monitored: five thermistors and the force sensor. The current mirror is not monitored,
/// because its sum is zero, and thus repeats, while the bridge is off.
const MONITORED_CHANNEL_COUNT: usize = 6;
/// The fault of each monitored channel when that channel is frozen, in the order in which
/// [`FrozenSampleDetector::check_samples`] compares the channels.
const FROZEN_CHANNEL_FAULTS: [Fault; MONITORED_CHANNEL_COUNT] = [
    Fault::DisplayFrozen,
    Fault::CheckFrozen,
    Fault::SinkFrozen,
    Fault::SkinFrozen,
    Fault::RoomFrozen,
    Fault::ForceFrozen,
];

/// Detects a wire or a converter that delivers a constant. Keeps, for each of the five thermistors and the force
/// sensor, the last sum of 16 conversions, and the number of ticks in a row for which the sum has not changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrozenSampleDetector {
    previous: [u16; MONITORED_CHANNEL_COUNT],
    repeats: [u8; MONITORED_CHANNEL_COUNT],
}

impl FrozenSampleDetector {
    /// Compares the samples of this tick with those of the tick before. To be called in every tick.
    ///
    /// # Errors
    /// The fault of the first channel that has repeated for 46 ticks, or [`Fault::SamplesFrozen`] if by then all
    /// channels have repeated for 30 ticks.
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
                frozen = frozen.or(Some(FROZEN_CHANNEL_FAULTS[i]));
            }
        }
        match frozen {
            None => Ok(()),
            Some(_)
                if self
                    .repeats
                    .iter()
                    .all(|ticks| *ticks >= CONVERTER_BLAMED_IF_ALL_FROZEN_TICKS) =>
            {
                Err(Fault::SamplesFrozen)
            }
            Some(one) => Err(one),
        }
    }
}
