//! What can be broken in the cooling of the sink.

/// Conductance of a heater to a sink that it holds at its temperature, W/K.
pub const HEATER_W_K: f64 = 1e4;

/// What is broken in the cooling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoolingDefects {
    /// By how much less heat the sink gives to its coolant, 1 or more.
    pub resistance: f64,
    /// Temperature of the coolant, deg C, instead of the one it should have.
    pub coolant_c: Option<f64>,
    /// Something strong holds the sink at a temperature, deg C.
    pub held_c: Option<f64>,
}

impl CoolingDefects {
    /// Nothing.
    pub const NONE: Self = Self {
        resistance: 1.0,
        coolant_c: None,
        held_c: None,
    };
}

impl Default for CoolingDefects {
    fn default() -> Self {
        Self::NONE
    }
}
