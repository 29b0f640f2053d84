//! The sensor of the heat flux between skin and display.

/// Properties of the heat-flux sensor, a thin layer on the display's face with an amplifier (`docs/flux.md`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxSensor {
    /// Gain, counts of its converter (of 4096) per W/m².
    pub counts_per_w_m2: f64,
    /// Count without flux.
    pub zero_counts: f64,
    /// Time constant of layer and filter together, s.
    pub lag_s: f64,
    /// Thermal resistance of the layer, m² K/W.
    pub resistance_m2k_w: f64,
}

impl FluxSensor {
    /// The designed sensor.
    pub const DESIGNED: Self = Self {
        counts_per_w_m2: 0.1192,
        zero_counts: 2048.0,
        lag_s: 5e-3,
        resistance_m2k_w: 3e-5,
    };
}
