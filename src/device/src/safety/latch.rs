//! The fault latch of a station.

use super::{Fault, TripCause};

/// Remembers why a station tripped, for `cause`, and which fault is still present or pending, for `clear`. Whether the
/// station is tripped is part of its state, not of the latch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaultLatch {
    /// Cause of the present trip, or of the last one since it was cleared; `None` if the station has never tripped.
    cause: Option<TripCause>,
    /// Number of the tick in which the station tripped; 0 if it has not, or was tripped from the start.
    tripped_at_tick: u32,
    /// Fault that the last tick has detected, or that the board had raised before it.
    present: Option<Fault>,
    /// Fault that the board has raised since the last tick; the next tick makes it the present one.
    external: Option<Fault>,
    /// First fault that the board has raised while another one was latched. It may show in no later tick, so `clear`
    /// trips the station by it again.
    pending: Option<Fault>,
}

impl FaultLatch {
    /// Cause of the present trip or, after `clear`, of the last one; `None` if the station has never tripped.
    #[must_use]
    pub const fn cause(&self) -> Option<&TripCause> {
        self.cause.as_ref()
    }

    /// Number of the tick, of 1 ms since the start, in which the station tripped last; 0 if that was before the first
    /// tick. The device finds the earliest trip of several fingers by it.
    #[must_use]
    pub const fn tripped_at_tick(&self) -> u32 {
        self.tripped_at_tick
    }

    /// Stores why the station trips, and the number of the tick. To be called when the state changes to tripped, so
    /// that a later fault does not replace the first.
    pub const fn latch_cause(&mut self, cause: TripCause, tick: u32) {
        self.cause = Some(cause);
        self.tripped_at_tick = tick;
    }

    /// Notes a fault that the board has found outside of the tick: it is present in the next tick. If the station is
    /// already tripped by a different fault, `latched`, it also becomes pending.
    pub fn raise_external_fault(&mut self, fault: Fault, latched: Option<Fault>) {
        self.external = Some(fault);
        if latched.is_some_and(|first| first != fault) {
            self.pending = self.pending.or(Some(fault));
        }
    }

    /// Ends a tick: the present fault is now the one that the tick has detected or else the one that the board has
    /// raised since the tick before, or `None`.
    pub const fn set_present_fault(&mut self, detected: Option<Fault>) {
        let external = self.external.take();
        self.present = match detected {
            Some(fault) => Some(fault),
            None => external,
        };
    }

    /// Fault that was present in the last tick, latched or not; `clear` is refused while there is one.
    #[must_use]
    pub const fn present_fault(&self) -> Option<Fault> {
        self.present
    }

    /// Removes and returns the fault that the board has raised while another one was latched. Called when the latched
    /// one is cleared; the station then trips by the returned one.
    pub const fn take_pending_fault(&mut self) -> Option<Fault> {
        self.pending.take()
    }
}
