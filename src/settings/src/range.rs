//! Ranges of the stored settings, which hold for a line from the host and for a record in flash alike.

use core::fmt;

use contact_model::decimal::Shortest;

use super::{Calibration, DisplaySurface, FluxSensor, Tile};

/// Allowed range of a quantity in a line from the host or in the record in flash, with its name and unit for error
/// messages. `Display` writes limits and unit, as in `15 to 42 C`.
#[derive(Debug, PartialEq)]
pub struct Range {
    /// Name of the quantity in error messages to the host, as in `dead time`.
    pub name: &'static str,
    /// Unit of the quantity, and of its limits, in ASCII for error messages to the host, as in `K/s/A`.
    pub unit: &'static str,
    /// Smallest allowed value of the quantity, in its unit.
    pub min: f64,
    /// Largest allowed value of the quantity, in its unit.
    pub max: f64,
}

impl Range {
    /// Whether a value lies in the range, both ends included; NaN does not.
    pub fn contains(&self, value: f64) -> bool {
        (self.min..=self.max).contains(&value)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (min, max) = (Shortest(self.min), Shortest(self.max));
        write!(f, "{min} to {max}")?;
        if self.unit.is_empty() { Ok(()) } else { write!(f, " {}", self.unit) }
    }
}

/// Allowed range of the step of the analogue-to-digital converter's error at a border between two of its segments,
/// counts (of 4096).
pub static ADC_ERROR_STEP_RANGE: Range =
    Range { name: "step", unit: "counts", min: -4.0, max: 4.0 };
/// Allowed ranges of the offset, slope and curvature of a thermistor's correction, in this order.
///
/// Within these ranges a correction changes a reading by at most 2.5 K from 15 to 43 °C, ten times what the tolerances
/// of the components need; the steps of the converter change it by at most 0.2 K more. So even with a wrong
/// calibration, the fault detectors detect a display that exceeds a temperature limit by more than 2.7 K.
pub static CORRECTION_RANGES: [Range; 3] = [
    Range { name: "offset", unit: "K", min: -1.2, max: 1.2 },
    Range { name: "slope", unit: "K/K", min: -0.05, max: 0.05 },
    Range { name: "curvature", unit: "1/K", min: -0.002, max: 0.002 },
];
/// Allowed ranges of the tile's parameters, in the order of [`Tile::to_array`]: gain, Joule term, leak, sensor lag,
/// dead time.
pub static TILE_RANGES: [Range; 5] = [
    Range { name: "gain", unit: "K/s/A", min: 0.1, max: 15.0 },
    Range { name: "Joule term", unit: "1/A", min: 0.0, max: 0.5 },
    Range { name: "leak", unit: "1/s", min: 0.0, max: 5.0 },
    Range { name: "lag", unit: "s", min: 0.001, max: 5.0 },
    Range { name: "dead time", unit: "s", min: 0.0, max: 1.0 },
];
/// Allowed ranges of a heat-flux sensor's values, in the order of [`FluxSensor::to_array`]. The zeros are the codes that the
/// sensor's amplifier can give without being at a rail.
pub static FLUX_SENSOR_RANGES: [Range; 4] = [
    Range { name: "gain", unit: "counts per W/m2", min: 0.01, max: 1.0 },
    Range { name: "zero", unit: "counts", min: 64.0, max: 4031.0 },
    Range { name: "lag", unit: "ms", min: 0.1, max: 500.0 },
    Range { name: "resistance", unit: "mm2 K/W", min: 0.0, max: 1000.0 },
];
/// Allowed ranges of a display's surface, in the order of [`DisplaySurface::to_array`]: from those of glazes to those of metals,
/// and from polished to blasted ones.
pub static DISPLAY_SURFACE_RANGES: [Range; 3] = [
    Range { name: "conductivity", unit: "W/mK", min: 0.1, max: 500.0 },
    Range { name: "roughness", unit: "um", min: 0.01, max: 30.0 },
    Range { name: "slope", unit: "rad", min: 0.001, max: 1.5 },
];

impl Calibration {
    /// The first value of this calibration that lies outside its allowed range, with that range; `None` if all values
    /// are inside. The steps of the converter are checked first, then the coefficients of the five corrections.
    #[must_use]
    pub fn first_value_out_of_range(&self) -> Option<(&'static Range, f64)> {
        let steps = self.steps_counts.iter().map(|step| (&ADC_ERROR_STEP_RANGE, *step));
        let corrections = self
            .corrections
            .iter()
            .flat_map(|correction| CORRECTION_RANGES.iter().zip(correction.to_array()));
        first_value_out_of_range(steps.chain(corrections))
    }
}

impl Tile {
    /// The first parameter of the tile that is outside its allowed range, with that range; `None` if all are inside.
    #[must_use]
    pub fn first_value_out_of_range(&self) -> Option<(&'static Range, f64)> {
        first_value_out_of_range(TILE_RANGES.iter().zip(self.to_array()))
    }
}

impl DisplaySurface {
    /// The first value of the surface that is outside its allowed range, with that range; `None` if all are inside.
    #[must_use]
    pub fn first_value_out_of_range(&self) -> Option<(&'static Range, f64)> {
        first_value_out_of_range(DISPLAY_SURFACE_RANGES.iter().zip(self.to_array()))
    }
}

impl FluxSensor {
    /// The first value of the sensor that is outside its allowed range, with that range; `None` if all are inside.
    #[must_use]
    pub fn first_value_out_of_range(&self) -> Option<(&'static Range, f64)> {
        first_value_out_of_range(FLUX_SENSOR_RANGES.iter().zip(self.to_array()))
    }
}

fn first_value_out_of_range(
    mut values: impl Iterator<Item = (&'static Range, f64)>,
) -> Option<(&'static Range, f64)> {
    values.find(|(range, value)| !range.contains(*value))
}
