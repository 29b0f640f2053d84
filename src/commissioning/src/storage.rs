//! Orders to store the settings: `save` and `forget`.
//!
//! The flash stalls the processor, so it is written while nothing else runs: the device hands the record over in memory that
//! a reset preserves, restarts, stores the record before anything else, and then replies to the order.

/// An order to store the settings of all fingers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StorageOrder {
    /// `save`: store the present settings.
    Save,
    /// `forget`: store factory defaults.
    Forget,
}

impl StorageOrder {
    /// The word that begins its line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Save => "save",
            Self::Forget => "forget",
        }
    }
}
