//! Settings that outlive the power: `save` and `forget`.
//!
//! The flash is written by a device that does nothing else. So an order is obeyed by starting anew: what is to be stored waits in a
//! memory that a reset does not clear, and is stored before anything else happens; then the order is answered.

use thermal_device::State;
use thermal_settings::{Kept, StoredBytes, encode};

use crate::Service;

/// What is to be stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StorageOrder {
    /// `save`: the settings of all fingers.
    Save,
    /// `forget`: factory defaults.
    Forget,
}

impl StorageOrder {
    /// The command.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Save => "save",
            Self::Forget => "forget",
        }
    }
}

/// The bytes that an order stores for the sessions of all fingers.
#[must_use]
pub fn record<const FINGERS: usize>(
    order: StorageOrder,
    fingers: &[Service; FINGERS],
) -> StoredBytes {
    match order {
        StorageOrder::Save => encode(Some(
            &fingers.each_ref().map(|one| Kept::of(one.settings())),
        )),
        StorageOrder::Forget => encode::<FINGERS>(None),
    }
}

/// Whether the bridge is off in a state, so that nobody can feel a device that starts anew.
#[must_use]
pub const fn is_off(state: State) -> bool {
    matches!(state, State::Off | State::Ready | State::Tripped(_))
}
