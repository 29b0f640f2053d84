//! Readings that move faster than what they are bonded to.

use core::mem;

use contact_model::fixed_point::Celsius;

use super::Fault;
use super::limits::Sound;

/// Ticks between the readings that are compared.
const TICKS: usize = 4;
/// Most that a reading moves meanwhile. The bridge at its limit moves a bare display by 16 K/s, 0.06 K, and full supply
/// by 25 K/s; noise is 4 mK.
const MOST: Celsius = Celsius::lit("0.5");

/// The readings of the last ticks, in turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Jump {
    last: [[Celsius; 3]; TICKS],
    /// Ticks that are in there, and which turn it is.
    ticks: u8,
    turn: u8,
}

impl Jump {
    /// Takes one tick.
    ///
    /// # Errors
    /// Display, its second thermistor or sink has jumped.
    pub fn check(&mut self, sound: &Sound) -> Result<(), Fault> {
        let oldest = &mut self.last[usize::from(self.turn) % TICKS];
        let [display, check, sink] = mem::replace(oldest, [sound.display, sound.check, sound.sink]);
        self.turn = self.turn.wrapping_add(1);
        if usize::from(self.ticks) < TICKS {
            self.ticks += 1;
            return Ok(());
        }
        let jumped =
            |now: Celsius, before: Celsius| now.saturating_sub(before).saturating_abs() > MOST;
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
