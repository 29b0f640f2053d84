//! Detects readings that move faster than the parts to which their thermistors are bonded.

use core::mem;

use contact_model::fixed_point::Celsius;

use super::Fault;
use super::validate_readings::ValidReadings;

/// Number of ticks of 1 ms between the two readings that are compared to detect a jump.
const JUMP_INTERVAL_TICKS: usize = 4;
/// Change of a thermistor's reading within 4 ms, K, above which it counts as a jump. The display cannot do that:
/// without a finger it moves by 0.06 K in 4 ms (16 K/s) at the bridge's current limit, and by 0.1 K (25 K/s) with the
/// whole supply voltage on the module; noise is 4 mK.
const JUMP_ABOVE: Celsius = Celsius::lit("0.5");

/// Detects a broken thermistor by a reading that changes faster than the display or the heat sink can. Keeps the
/// readings of the two display thermistors and the sink thermistor for the last four ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JumpDetector {
    ring: [[Celsius; 3]; JUMP_INTERVAL_TICKS],
    /// Number of ticks whose readings the ring holds, up to [`JUMP_INTERVAL_TICKS`].
    ticks: u8,
    /// Count of the ticks that were added to the ring, wrapping at 256. Modulo [`JUMP_INTERVAL_TICKS`] it is the index
    /// of the oldest readings in the ring.
    oldest: u8,
}

impl JumpDetector {
    /// Compares the thermistor readings of this tick with those of four ticks before; returns `Ok` in the first four
    /// ticks after construction.
    ///
    /// # Errors
    /// [`Fault::DisplayJump`], [`Fault::CheckJump`] or [`Fault::SinkJump`]: the first of these whose thermistor's
    /// reading has changed by more than 0.5 K.
    pub fn check_jumps(&mut self, readings: &ValidReadings) -> Result<(), Fault> {
        let now = [readings.display, readings.check, readings.sink];
        let place = &mut self.ring[usize::from(self.oldest) % JUMP_INTERVAL_TICKS];
        let [display, check, sink] = mem::replace(place, now);
        self.oldest = self.oldest.wrapping_add(1);
        if usize::from(self.ticks) < JUMP_INTERVAL_TICKS {
            self.ticks += 1;
            return Ok(());
        }
        let jumped = |now: Celsius, then: Celsius| {
            !(-JUMP_ABOVE..=JUMP_ABOVE).contains(&now.saturating_sub(then))
        };
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
