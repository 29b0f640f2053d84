//! The fault latch of a station.

use super::{Fault, TripCause};

/// Memory of a station's faults: the cause of the last trip, which the command `cause` reports, and the present and
/// pending faults, which `clear` checks. Whether the station is tripped is not stored here but in its state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaultLatch {
    cause: Option<TripCause>,
    last_trip_tick_or_zero: u32,
    present: Option<Fault>,
    /// Last fault that the board has raised, outside of a tick, since the last tick. At the end of the next tick it
    /// becomes the present fault, unless that tick detects a fault itself.
    external: Option<Fault>,
    /// First fault that the board has raised while the station was tripped by another fault. `clear` then trips the
    /// station by it again, because later ticks may not show it.
    pending: Option<Fault>,
}

impl FaultLatch {
    /// Cause of the present trip or, after `clear`, of the last one; `None` if the station has never tripped since the
    /// start.
    pub const fn last_trip_cause(&self) -> Option<&TripCause> {
        self.cause.as_ref()
    }

    /// Number of the tick (of 1 ms since the start) in which the station tripped last; 0 if it has never tripped or was
    /// tripped before the first tick. The device compares these numbers to report the earliest trip of all fingers.
    pub const fn last_trip_tick_or_zero(&self) -> u32 {
        self.last_trip_tick_or_zero
    }

    /// Stores the cause of a trip and the number `tick` of the present tick. To be called only when the station's state
    /// changes to tripped, so that a later fault does not replace the first one.
    pub const fn store_trip_cause_and_tick(&mut self, cause: TripCause, tick: u32) {
        self.cause = Some(cause);
        self.last_trip_tick_or_zero = tick;
    }

    /// Records `fault`, which the board has found outside of a tick. At the end of the next tick `fault` becomes the
    /// present fault, unless that tick detects one itself. `latched` is the fault by which the station is tripped
    /// already; if it differs from `fault` and no fault is pending yet, `fault` also becomes the pending fault.
    pub fn raise_external_fault(&mut self, fault: Fault, latched: Option<Fault>) {
        self.external = Some(fault);
        if latched.is_some_and(|first| first != fault) {
            self.pending = self.pending.or(Some(fault));
        }
    }

    /// Ends a tick: the present fault becomes `detected`, the fault that the tick has detected. If that is `None`, the
    /// fault that the board has raised since the tick before becomes the present fault; `None` if there is neither. A
    /// fault that the board has raised counts for this one tick only.
    pub const fn set_present_to_detected_else_external(&mut self, detected: Option<Fault>) {
        let external = self.external.take();
        self.present = match detected {
            Some(fault) => Some(fault),
            None => external,
        };
    }

    /// Fault that the last tick detected, or that the board raised before that tick; `None` if that tick found no
    /// fault. The command `clear` is refused while a fault is present.
    #[must_use]
    pub const fn present_fault(&self) -> Option<Fault> {
        self.present
    }

    /// Removes and returns the pending fault: the first that the board raised while the station was tripped by another
    /// one; `None` if there is none. To be called when `clear` has cleared the latched fault; `clear` then trips the
    /// station by the returned fault.
    pub const fn take_deferred_board_fault(&mut self) -> Option<Fault> {
        self.pending.take()
    }
}
