//! State of the board, which the control of the fingers does not know.

use thermal_settings::vocabulary;

/// What the board tells of the microcontroller and of the serial line, for bring-up and diagnosis: the answer to the
/// command `board`. The default is that of a prepared board after power-on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoardStatus {
    /// Brown-out level of the option bytes, 0 (off) to 3.
    pub brown_out_level: u8,
    /// Whether a debugger has selected that watchdogs or PWM timers stand still while it halts the core.
    pub watchdogs_may_freeze: bool,
    /// Whether the clocks are derived from the external clock, and not from the internal oscillator.
    pub clock_is_external: bool,
    /// Level of the lock of the PWM timers' settings, 0 (off) to 3; the lowest of all timers.
    pub pwm_lock_level: u8,
    /// Cause of the last reset.
    pub reset: &'static str,
    /// Received bytes that were lost because they were fetched too late, since the start.
    pub receive_overruns: u32,
    /// Received bytes without a valid stop bit, since the start.
    pub receive_framing_errors: u32,
    /// Received bytes with noise, since the start.
    pub receive_noise: u32,
    /// Lines of telemetry that were dropped because the line to the host was too slow, since the start.
    pub telemetry_dropped: u32,
    /// Unique identifier of the microcontroller, in words. The default is no chip's.
    pub unique_id: [u32; 3],
    /// CRC-32 of the program in flash, which tells one build from another; `None` where no flash holds it.
    pub program_digest: Option<u32>,
}

impl Default for BoardStatus {
    fn default() -> Self {
        Self {
            brown_out_level: 3,
            watchdogs_may_freeze: false,
            clock_is_external: true,
            pwm_lock_level: 3,
            reset: "power-on",
            receive_overruns: 0,
            receive_framing_errors: 0,
            receive_noise: 0,
            telemetry_dropped: 0,
            unique_id: [0; 3],
            program_digest: None,
        }
    }
}

vocabulary! {
    /// Whether the watchdogs run.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Watchdogs: "watchdogs" {
        /// The watchdogs run, whatever the program or a debugger does.
        Running = "running",
        /// A debugger has selected that they, or the PWM timers, stand still while it halts the core.
        Frozen = "frozen",
    }
}

vocabulary! {
    /// Where the clocks come from.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum ClockSource: "clock" {
        /// The external clock.
        External = "hse",
        /// The internal oscillator.
        Internal = "hsi",
    }
}
