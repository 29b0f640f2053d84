//! Orders to store the settings: `save` and `forget`.
//!
//! Writing the flash stalls the processor, so the flash is written while nothing else runs: the device keeps the record
//! in memory that a reset preserves, restarts, writes the record to flash before anything else, and then replies to the
//! order.

use thermal_settings::vocabulary;

vocabulary! {
    /// An order of the host to write the settings of all fingers to flash, from where they are read at start-up. The device
    /// restarts to execute the order.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum StorageOrder: "order" {
        /// `save`: stores the present calibration and tile parameters of all fingers, so that they still hold after a
        /// restart.
        Save = "save",
        /// `forget`: stores the factory defaults of all fingers in place of the stored settings; all calibration is lost.
        Forget = "forget",
    }
}
