//! Detects signals whose samples repeat, although the converter's noise would change them.
//!
//! A sum of 16 conversions repeats by chance. How often depends on the converter's noise: with the noise of one conversion
//! above 0.2 counts the sum changes every few ticks, wherever the signal lies. With less noise a sound signal in the middle
//! of a code repeats without end. A repeating sum is therefore evidence only if noise is seen where it should be:
//!
//! - One channel repeats: meanwhile conversions of other thermistors scatter by two codes or more, as those of a quiet
//!   converter do not.
//! - All channels repeat: they have begun to do so together, and before that most of them changed in most ticks. What has
//!   begun when the bridge was turned off, or just after, does not count, because its noise may have ended with it.
//!
//! On a quiet converter, this detector finds nothing; the limits of the display, its second thermistor, the model of the
//! tile and the current mirror then find what matters of a frozen channel, later.

use super::Fault;
use crate::sense::Samples;

/// Number of ticks of 1 ms in a row in which a channel's sum of 16 conversions equals that of the tick before, from
/// which on the channel may count as frozen. A frozen channel switches the bridge off less than 50 ms after the signal
/// stops.
pub const FROZEN_TICKS: u8 = 46;
/// Ticks in a row from which on the scatter of the other channels is looked at. A sound signal on a converter with visible
/// noise hardly ever repeats as often.
const SUSPICIOUS_TICKS: u8 = 14;
/// When one channel has repeated for [`FROZEN_TICKS`], all channels must have repeated for this number of ticks of 1 ms
/// for the converter, and not that one sensor, to be named as frozen.
const CONVERTER_BLAMED_IF_ALL_FROZEN_TICKS: u8 = 30;
/// Difference of the number of repeats of two channels, ticks, up to which they have begun to repeat together: by chance
/// one channel may have begun to repeat earlier than the others.
const BEGAN_TOGETHER_TICKS: u8 = 8;
/// Of the 48 sums of six channels in eight ticks in a row, the number that must have changed for the converter to have
/// had noise: two thirds.
const CHANGES_OF_NOISY_CHANNELS: u32 = 32;
/// Score of a thermistor whose conversions scatter in one tick, and loss of the score in each tick: on the mean a
/// thermistor must scatter every fourth tick for the score to grow.
const SCATTER_SCORE: u8 = 4;
/// Score from which on the converter counts as noisy. One conversion with a noise of 0.4 counts gives it within 15 ticks.
const NOISY_SCORE: u8 = 48;
const SCORE_MAX: u8 = 200;
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrozenSampleDetector {
    previous: [u16; MONITORED_CHANNEL_COUNT],
    /// At most 255.
    repeats: [u8; MONITORED_CHANNEL_COUNT],
    /// Which channels changed in each of the last eight ticks, a byte for each tick, up to the last tick in which any did and
    /// back to the last one before it in which none did.
    changes: u64,
    nothing_changed: bool,
    scatter_score: u8,
    bridge_was_driven: bool,
    suspicious: bool,
}

impl Default for FrozenSampleDetector {
    fn default() -> Self {
        Self {
            previous: [0; MONITORED_CHANNEL_COUNT],
            repeats: [0; MONITORED_CHANNEL_COUNT],
            changes: 0,
            nothing_changed: true,
            scatter_score: 0,
            bridge_was_driven: false,
            suspicious: false,
        }
    }
}

impl FrozenSampleDetector {
    /// Whether a channel repeats for so long that the next tick's [`Samples::scattering_thermistors`] is needed.
    pub const fn needs_scatter(&self) -> bool {
        self.suspicious
    }

    /// Compares the samples of this tick with those of the tick before. `bridge_is_driven`: a current was demanded in the
    /// tick before. To be called in every tick.
    ///
    /// # Errors
    /// The fault of the first channel that has repeated for 46 ticks while the other thermistors scatter, or
    /// [`Fault::SamplesFrozen`] if by then all channels have repeated for 30 ticks, or if all have begun to repeat
    /// together 46 ticks ago and had noise before.
    pub fn check_samples(
        &mut self,
        samples: &Samples,
        bridge_is_driven: bool,
    ) -> Result<(), Fault> {
        if bridge_is_driven != self.bridge_was_driven {
            self.bridge_was_driven = bridge_is_driven;
            if bridge_is_driven {
                // The scatter of the others may be the bridge's, which must reach all channels first.
                self.repeats = [0; MONITORED_CHANNEL_COUNT];
            } else if !self.nothing_changed {
                self.changes = 0;
            }
        }
        let (changed, longest) = self.count_repeats(samples);
        if changed != 0 {
            // After a tick without a change the history begins anew: a single disturbance of all channels of a quiet
            // converter does not count as its noise.
            let before = if self.nothing_changed { 0 } else { self.changes << 8 };
            self.changes = before | u64::from(changed);
        }
        self.nothing_changed = changed == 0;
        self.suspicious = longest >= SUSPICIOUS_TICKS;
        if !self.suspicious {
            self.scatter_score = 0;
            return Ok(());
        }
        let scatter = SCATTER_SCORE * samples.scattering_thermistors.min(5);
        let score = self.scatter_score.saturating_add(scatter);
        self.scatter_score = score.saturating_sub(1).min(SCORE_MAX);
        if longest < FROZEN_TICKS {
            return Ok(());
        }
        self.judge()
    }

    /// Updates the repeats of all channels. Returns which channels changed, a bit for each, and the largest number of
    /// repeats.
    fn count_repeats(&mut self, samples: &Samples) -> (u8, u8) {
        let [display, check, sink, skin, room] = samples.thermistor_sums();
        let now = [display, check, sink, skin, room, samples.force];
        let (mut changed, mut longest) = (0, 0);
        let channels = self.previous.iter_mut().zip(&mut self.repeats);
        for (i, ((previous, repeats), now)) in channels.zip(now).enumerate() {
            if *previous != now {
                *previous = now;
                *repeats = 0;
                changed |= 1 << i;
            } else {
                *repeats = repeats.saturating_add(1);
                longest = longest.max(*repeats);
            }
        }
        (changed, longest)
    }

    /// The fault of channels of which at least one has repeated for [`FROZEN_TICKS`], unless the converter is quiet.
    fn judge(&self) -> Result<(), Fault> {
        let shortest = self.repeats.iter().copied().min().unwrap_or(0);
        let longest = self.repeats.iter().copied().max().unwrap_or(0);
        let began_together = longest < u8::MAX && longest - shortest <= BEGAN_TOGETHER_TICKS;
        let had_noise = self.changes.count_ones() >= CHANGES_OF_NOISY_CHANNELS;
        if began_together && had_noise {
            return Err(Fault::SamplesFrozen);
        }
        if self.scatter_score < NOISY_SCORE {
            return Ok(());
        }
        if shortest >= CONVERTER_BLAMED_IF_ALL_FROZEN_TICKS {
            return Err(Fault::SamplesFrozen);
        }
        let first = self.repeats.iter().zip(FROZEN_CHANNEL_FAULTS);
        let mut faults =
            first.filter_map(|(repeats, fault)| (*repeats >= FROZEN_TICKS).then_some(fault));
        faults.next().map_or(Ok(()), Err)
    }
}

#[cfg(test)]
mod tests;
