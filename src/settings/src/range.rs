//! The range that each setting may have, on a line from the host and in flash.

use super::{Calibration, Correction, Tile};

/// The range of a number, with the words that an error message needs.
#[derive(Debug, PartialEq)]
pub struct Range {
    /// Name of the quantity.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
}

impl Range {
    /// Whether a value lies in the range, both ends included; NaN does not.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        (self.min..=self.max).contains(&value)
    }
}

/// Range of one of the converter's steps.
pub static STEP_RANGE: Range = Range {
    name: "step",
    unit: "counts",
    min: -4.0,
    max: 4.0,
};
/// Ranges of a correction's offset, slope and curvature.
///
/// Together they change a reading by at most 2.5 K within the calibrated temperatures, ten times what parts of this class
/// need. The converter's steps add at most 0.2 K. So no `set` line can hide from the safety limits a display that is
/// hotter than its limit by more than the sum of both.
pub static CORRECTION_RANGES: [Range; 3] = [
    Range {
        name: "offset",
        unit: "K",
        min: -1.2,
        max: 1.2,
    },
    Range {
        name: "slope",
        unit: "K/K",
        min: -0.05,
        max: 0.05,
    },
    Range {
        name: "curvature",
        unit: "1/K",
        min: -0.002,
        max: 0.002,
    },
];
/// Ranges of a tile's values, in the order of [`Tile::to_array`].
pub static TILE_RANGES: [Range; 5] = [
    Range {
        name: "gain",
        unit: "K/s/A",
        min: 0.1,
        max: 15.0,
    },
    Range {
        name: "Joule term",
        unit: "1/A",
        min: 0.0,
        max: 0.5,
    },
    Range {
        name: "leak",
        unit: "1/s",
        min: 0.0,
        max: 5.0,
    },
    Range {
        name: "lag",
        unit: "s",
        min: 0.001,
        max: 5.0,
    },
    Range {
        name: "dead time",
        unit: "s",
        min: 0.0,
        max: 1.0,
    },
];

impl Calibration {
    /// The first value outside its range, with that range.
    #[must_use]
    pub fn out_of_range(&self) -> Option<(&'static Range, f64)> {
        let steps = self.steps_counts.iter().map(|step| (&STEP_RANGE, *step));
        let corrections = self.corrections.iter().flat_map(|correction| {
            let Correction {
                offset_k,
                slope,
                curvature_1_k,
            } = *correction;
            CORRECTION_RANGES
                .iter()
                .zip([offset_k, slope, curvature_1_k])
        });
        first_outside(steps.chain(corrections))
    }
}

impl Tile {
    /// The first value outside its range, with that range.
    #[must_use]
    pub fn out_of_range(&self) -> Option<(&'static Range, f64)> {
        first_outside(TILE_RANGES.iter().zip(self.to_array()))
    }
}

fn first_outside(
    mut values: impl Iterator<Item = (&'static Range, f64)>,
) -> Option<(&'static Range, f64)> {
    values.find(|(range, value)| !range.contains(*value))
}
