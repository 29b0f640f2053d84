//! Ranges of the stored settings, which hold for a line from the host and for a record in flash alike.

use core::fmt;

use super::{Calibration, Tile};

/// The range of a quantity, with its name and unit for error messages; it is displayed as `15 to 42 C`.
#[derive(Debug, PartialEq)]
pub struct Range {
    /// Name of the quantity, as error messages to the host have it.
    pub name: &'static str,
    /// Unit of the quantity in ASCII, as error messages to the host have it.
    pub unit: &'static str,
    /// Smallest allowed value.
    pub min: f64,
    /// Largest allowed value.
    pub max: f64,
}

impl Range {
    /// Whether a value lies in the range, both ends included; NaN does not.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        (self.min..=self.max).contains(&value)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {} {}", self.min, self.max, self.unit)
    }
}

/// Range of one step of the converter at a border of its segments, counts.
pub static STEP_RANGE: Range = Range {
    name: "step",
    unit: "counts",
    min: -4.0,
    max: 4.0,
};
/// Ranges of a correction's offset, slope and curvature.
///
/// A correction within them changes a reading by at most 2.5 K in the calibrated range, ten times what components of
/// this class need; the steps of the converter add at most 0.2 K. So no calibration hides from the safety limits a
/// display that exceeds them by more than 2.7 K.
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
/// Ranges of the tile's parameters, in the order of [`Tile::to_array`].
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
        let corrections = self
            .corrections
            .iter()
            .flat_map(|correction| CORRECTION_RANGES.iter().zip(correction.to_array()));
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
