//! Readings that move faster than what they are bonded to.

use contact_model::fixed_point::Celsius;

use super::Fault;
use super::limits::Sound;

/// Ticks between two looks.
const TICKS: u8 = 4;
/// Most that a reading moves meanwhile. The bridge at its limit moves a bare display by 16 K/s, 0.06 K, and full supply
/// by 25 K/s; noise is 4 mK.
const MOST: Celsius = Celsius::lit("0.5");

/// The readings at the last look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Jump {
    last: Option<[Celsius; 3]>,
    ticks: u8,
}

impl Jump {
    /// Takes one tick.
    ///
    /// # Errors
    /// Display, its second thermistor or sink has jumped.
    pub fn check(&mut self, sound: &Sound) -> Result<(), Fault> {
        self.ticks += 1;
        if self.ticks < TICKS {
            return Ok(());
        }
        self.ticks = 0;
        let now = [sound.display, sound.check, sound.sink];
        let Some([display, check, sink]) = self.last.replace(now) else {
            return Ok(());
        };
        let jumped = |now: Celsius, before: Celsius| now.saturating_sub(before).saturating_abs() > MOST;
        if jumped(sound.display, display) {
            Err(Fault::DisplayJump)
        } else if jumped(sound.check, check) {
            Err(Fault::CheckJump)
        } else if jumped(sound.sink, sink) {
            Err(Fault::SinkJump)
        } else {
            Ok(())
        }
    }
}
