//! Defects of the sink's cooling.

/// Conductance from an external thermostat to the sink, W/K: large enough to hold the sink at its temperature.
pub const THERMOSTAT_W_K: f64 = 1e4;

/// Defects of the cooling; none by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoolingDefects {
    /// Factor on the thermal resistance from sink to coolant, 1 or more.
    pub resistance_factor: f64,
    /// Temperature of the coolant instead of the nominal one, deg C.
    pub coolant_c: Option<f64>,
    /// Temperature at which an external thermostat holds the sink, deg C.
    pub held_c: Option<f64>,
}

impl CoolingDefects {
    /// No defect.
    pub const NONE: Self = Self { resistance_factor: 1.0, coolant_c: None, held_c: None };
}

impl Default for CoolingDefects {
    fn default() -> Self {
        Self::NONE
    }
}
