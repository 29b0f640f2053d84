//! Detects readings that move faster than the parts to which their thermistors are bonded.

use core::mem;

use contact_model::fixed_point::Celsius;

use super::Fault;
use super::validity::ValidReadings;

/// Ticks between the readings that are compared.
const TICKS: usize = 4;
/// Largest movement of a sound reading in that time, with a wide margin: the bridge at its limit moves a bare display by
/// 0.06 K (16 K/s), the full supply by 0.1 K (25 K/s); noise is 4 mK.
const MOVEMENT_MAX: Celsius = Celsius::lit("0.5");

/// Display, second display and sink of the last ticks, in a ring.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JumpDetector {
    ring: [[Celsius; 3]; TICKS],
    /// Ticks in the ring.
    ticks: u8,
    /// Place of the oldest tick, modulo [`TICKS`].
    oldest: u8,
}

impl JumpDetector {
    /// Takes the readings of one tick.
    ///
    /// # Errors
    /// Display, second display or sink has jumped.
    pub fn check(&mut self, readings: &ValidReadings) -> Result<(), Fault> {
        let now = [readings.display, readings.check, readings.sink];
        let place = &mut self.ring[usize::from(self.oldest) % TICKS];
        let [display, check, sink] = mem::replace(place, now);
        self.oldest = self.oldest.wrapping_add(1);
        if usize::from(self.ticks) < TICKS {
            self.ticks += 1;
            return Ok(());
        }
        let jumped =
            |now: Celsius, then: Celsius| now.saturating_sub(then).saturating_abs() > MOVEMENT_MAX;
        if jumped(readings.display, display) {
            Err(Fault::DisplayJump)
        } else if jumped(readings.check, check) {
            Err(Fault::CheckJump)
        } else if jumped(readings.sink, sink) {
            Err(Fault::SinkJump)
        } else {
            Ok(())
        }
    }
}
