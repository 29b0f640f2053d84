//! Signals that repeat themselves.

use super::Fault;
use crate::sense::Samples;

/// Ticks of identical samples of a channel that count as one that stands still: noise moves the sum of 16
/// conversions by 3, so it repeats once in ten ticks by chance, and 46 times in a row never. The tick in which it begins
/// to stand still still has sound samples, and the bridge is off a tick after the last: 50 ms in all.
pub const FROZEN_TICKS: u8 = 46;
/// When one channel is through, others that have repeated themselves for this long are so too.
const NEARLY_TICKS: u8 = 30;
/// Thermistors and force. The current may well be none.
const CHANNELS: usize = 6;
const NAMES: [Fault; CHANNELS] = [
    Fault::DisplayFrozen,
    Fault::CheckFrozen,
    Fault::SinkFrozen,
    Fault::SkinFrozen,
    Fault::RoomFrozen,
    Fault::ForceFrozen,
];

/// What the channels were, and for how long.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Frozen {
    last: [u16; CHANNELS],
    ticks: [u8; CHANNELS],
}

impl Frozen {
    /// Takes one tick.
    ///
    /// # Errors
    /// A channel that stands still, or all.
    pub fn check(&mut self, samples: &Samples) -> Result<(), Fault> {
        let [display, check, sink, skin, room] = samples.thermistors();
        let now = [display, check, sink, skin, room, samples.force];
        let mut through = None;
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
                through = through.or(Some(NAMES[i]));
            }
        }
        match through {
            None => Ok(()),
            Some(_) if self.ticks.iter().all(|ticks| *ticks >= NEARLY_TICKS) => {
                Err(Fault::SamplesFrozen)
            }
            Some(one) => Err(one),
        }
    }
}
