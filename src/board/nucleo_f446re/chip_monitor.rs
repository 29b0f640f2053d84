//! Checks of the microcontroller itself: what must be right at the start, and what must stay right.

use thermal_display::device::safety::Fault;
use thermal_display::protocol::BoardStatus;

use super::brown_out_level::REQUIRED_LEVEL;
use super::late_clock::LateClock;
use super::wiring::FingerPowerStage;
use super::{debug_freeze, line_losses, requested_restart};

/// Checks in every tick the settings of the microcontroller on which the safety of the bridges
/// depends.
pub struct ChipMonitor {
    /// A fault that the start has found and that lasts until the next start.
    fault_at_start: Option<Fault>,
    late_clock: Option<LateClock>,
}

impl ChipMonitor {
    /// Creates the monitor. `has_clock`: the 8 MHz clock of the debug probe was stable at the start.
    /// If not, the ticks come from the internal oscillator, whose tolerance of 1 % makes their
    /// period inaccurate.
    pub fn new(has_clock: bool, brown_out_level: u8) -> Self {
        let fault_at_start = match (has_clock, brown_out_level) {
            (false, _) => Some(Fault::Clock),
            (true, REQUIRED_LEVEL) => None,
            (true, _) => Some(Fault::BrownOutLevel),
        };
        Self { fault_at_start, late_clock: (!has_clock).then(LateClock::default) }
    }

    /// The fault of the microcontroller that is present in this tick, if any.
    pub fn present_fault(&self) -> Option<Fault> {
        if self.fault_at_start.is_some() {
            return self.fault_at_start;
        }
        if debug_freeze::watchdogs_or_pwm_may_freeze() {
            return Some(Fault::WatchdogsFrozen);
        }
        if !FingerPowerStage::pwm_settings_are_locked() {
            return Some(Fault::PwmSettings);
        }
        None
    }

    /// Whether a fault has been present since the start. It trips every finger in every tick, and
    /// every start finds it again, so that it need not be stored for the next start.
    pub const fn has_fault_at_start(&self) -> bool {
        self.fault_at_start.is_some()
    }

    /// If the device waits for the 8 MHz clock: counts a tick of 1 ms, and restarts the device when
    /// the clock has been stable for a second. Called while all bridges are off.
    pub fn restart_when_clock_has_come(&mut self) {
        if let Some(late_clock) = &mut self.late_clock
            && late_clock.count_tick_and_check_stable()
        {
            defmt::info!("the 8 MHz clock has come");
            requested_restart::restart();
        }
    }
}

/// The status of the board now; what only the start shows is that of `at_start`.
pub fn status_now(at_start: &BoardStatus) -> BoardStatus {
    BoardStatus {
        watchdogs_may_freeze: debug_freeze::watchdogs_or_pwm_may_freeze(),
        pwm_lock_level: FingerPowerStage::pwm_lock_level(),
        receive_overruns: line_losses::OVERRUNS.total(),
        receive_framing_errors: line_losses::FRAMING_ERRORS.total(),
        receive_noise: line_losses::NOISY_BYTES.total(),
        telemetry_dropped: line_losses::DROPPED_TELEMETRY.total(),
        ..*at_start
    }
}
