//! Detects readings that move faster than the parts to which their thermistors are bonded.

use core::mem;

use contact_model::fixed_point::Celsius;

use super::Fault;
use super::validity::ValidReadings;

/// Ticks of 1 ms between two readings that are compared for a jump.
const COMPARED_TICKS: usize = 4;
/// Change of a reading within 4 ms, K, above which it counts as a jump: in that time the bridge at its current limit
/// moves a display without a finger by 0.06 K (16 K/s), the full supply by 0.1 K (25 K/s), and noise is 4 mK.
const MOVEMENT_MAX: Celsius = Celsius::lit("0.5");

/// Detects a broken thermistor by a change that is too fast for the part to which it is bonded: keeps the readings of
/// both display thermistors and of the sink's for four ticks, in a ring.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JumpDetector {
    ring: [[Celsius; 3]; COMPARED_TICKS],
    /// Number of ticks that the ring holds, up to [`COMPARED_TICKS`].
    ticks: u8,
    /// Index of the oldest tick in the ring, modulo [`COMPARED_TICKS`].
    oldest: u8,
}

impl JumpDetector {
    /// Compares the readings of this tick with those of four ticks before; the first four ticks cannot fail.
    ///
    /// # Errors
    /// The first of display, second display and sink thermistor whose reading has changed by more than 0.5 K.
    pub fn check_movement(&mut self, readings: &ValidReadings) -> Result<(), Fault> {
        let now = [readings.display, readings.check, readings.sink];
        let place = &mut self.ring[usize::from(self.oldest) % COMPARED_TICKS];
        let [display, check, sink] = mem::replace(place, now);
        self.oldest = self.oldest.wrapping_add(1);
        if usize::from(self.ticks) < COMPARED_TICKS {
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
