//! The fault latch of a station.

use super::{Fault, TripCause};

/// Remembers why the station tripped, and which faults are still present.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaultLatch {
    /// Why the station tripped, now or the last time.
    cause: Option<TripCause>,
    /// Tick in which it tripped; 0 if that was before the reset.
    tripped_at: u32,
    /// Fault that the last tick has seen.
    present: Option<Fault>,
    /// Fault that the board has raised since the last tick.
    external: Option<Fault>,
    /// Second fault that the board has raised while the first was latched; no tick sees it, so `clear` reports it.
    pending: Option<Fault>,
}

impl FaultLatch {
    /// Why the station tripped, now or the last time.
    #[must_use]
    pub const fn cause(&self) -> Option<&TripCause> {
        self.cause.as_ref()
    }

    /// Tick since reset in which the station tripped, 0 if it tripped before the reset.
    #[must_use]
    pub const fn tripped_at(&self) -> u32 {
        self.tripped_at
    }

    /// Latches the cause of a trip in a tick.
    pub const fn latch(&mut self, cause: TripCause, tick: u32) {
        self.cause = Some(cause);
        self.tripped_at = tick;
    }

    /// Takes a fault that the board has raised; `latched` is the one that has tripped the station already.
    pub fn raise(&mut self, fault: Fault, latched: Option<Fault>) {
        self.external = Some(fault);
        if latched.is_some_and(|first| first != fault) {
            self.pending = self.pending.or(Some(fault));
        }
    }

    /// Takes the fault that a tick has detected.
    pub const fn end_tick(&mut self, detected: Option<Fault>) {
        let external = self.external.take();
        self.present = match detected {
            Some(fault) => Some(fault),
            None => external,
        };
    }

    /// The fault that was present in the last tick.
    #[must_use]
    pub const fn present(&self) -> Option<Fault> {
        self.present
    }

    /// Takes the second fault that the board has raised, when the first is cleared.
    pub const fn take_pending(&mut self) -> Option<Fault> {
        self.pending.take()
    }
}
