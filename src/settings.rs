//! Constants of one built device.

/// Everything that differs between two built devices.
#[derive(Clone, Copy, Debug, Default)]
pub struct Settings {}
