//! The sensor of the heat flux between skin and display.

use super::round_to_decimals;

/// Properties of the heat-flux sensor, a thin layer on the display's face with an amplifier (`docs/flux.md`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxSensor {
    /// Gain, counts of its converter (of 4096) per W/m².
    pub counts_per_w_m2: f64,
    /// Code without flux, counts.
    pub zero_counts: f64,
    /// Time constant of layer and filter together, ms.
    pub lag_ms: f64,
    /// Thermal resistance of the layer, mm² K/W (1e-6 m² K/W).
    pub resistance_mm2k_w: f64,
}

impl FluxSensor {
    /// The designed sensor.
    pub const DESIGNED: Self =
        Self { counts_per_w_m2: 0.1192, zero_counts: 2048.0, lag_ms: 5.0, resistance_mm2k_w: 30.0 };

    /// Names of gain, zero, lag and resistance in an answer.
    pub const NAMES: [&str; 4] = ["counts_per_w_m2", "zero_counts", "lag_ms", "resistance_mm2k_w"];

    /// Decimals of gain, zero, lag and resistance in a line of settings and in the record in flash.
    pub const DECIMALS: [i32; 4] = [6, 3, 3, 3];

    /// Gain, zero, lag and resistance, in the order of lines and record.
    pub const fn to_array(&self) -> [f64; 4] {
        [self.counts_per_w_m2, self.zero_counts, self.lag_ms, self.resistance_mm2k_w]
    }

    /// A sensor with this gain, zero, lag and resistance, each rounded to [`Self::DECIMALS`].
    pub fn from_array_rounded(values: [f64; 4]) -> Self {
        let mut rounded = values;
        for (value, decimals) in rounded.iter_mut().zip(Self::DECIMALS) {
            *value = round_to_decimals(*value, decimals);
        }
        let [counts_per_w_m2, zero_counts, lag_ms, resistance_mm2k_w] = rounded;
        Self { counts_per_w_m2, zero_counts, lag_ms, resistance_mm2k_w }
    }
}
