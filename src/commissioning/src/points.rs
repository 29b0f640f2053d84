//! The points of a calibration: what the converter read, and what a reference thermometer said.

use contact_model::fixed_point::Celsius;
use heapless::Vec;

use thermal_device::sense::{Average, THERMISTORS};

/// Points of one thermistor.
pub const POINTS: usize = 24;
/// Farther than this from what the device reads, K, is no reference thermometer at the same place.
pub const FARTHEST_K: f64 = 2.0;
/// Codes on either side of a border between the converter's segments in which noise mixes both.
const BORDER_CODES: f64 = 6.0;

/// One point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Mean of the sums of 16 conversions.
    pub sum: f64,
    /// The reference thermometer, °C.
    pub reference_c: f64,
}

/// Why a point is not taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointError {
    /// The reading moves.
    Unsteady,
    /// At a border between the converter's segments.
    AtBorder,
    /// The device reads something else, °C.
    TooFar(Celsius),
    /// No correction within the limits of settings goes with it and those before.
    Contradicts,
    /// There is no room for more.
    Full,
}

/// All points since the device was switched on.
#[derive(Clone, Debug, Default)]
pub struct Points {
    of: [Vec<Point, POINTS>; THERMISTORS],
}

impl Points {
    /// Those of one thermistor.
    #[must_use]
    pub fn of(&self, thermistor: usize) -> &[Point] {
        self.of
            .get(thermistor)
            .map_or(&[], |points| points.as_slice())
    }

    /// Forgets those of one thermistor.
    pub fn clear(&mut self, thermistor: usize) {
        if let Some(points) = self.of.get_mut(thermistor) {
            points.clear();
        }
    }

    /// Adds a point of a thermistor that `reads_c` on average.
    ///
    /// # Errors
    /// Why it is not taken.
    pub fn add(
        &mut self,
        thermistor: usize,
        average: &Average,
        reads_c: f64,
        reference_c: f64,
    ) -> Result<(), PointError> {
        if !average.is_steady() {
            return Err(PointError::Unsteady);
        }
        let segments = average.sum() / f64::from(16 * thermal_settings::SEGMENT_CODES);
        let from_border =
            (segments - libm::round(segments)) * f64::from(thermal_settings::SEGMENT_CODES);
        if libm::fabs(from_border) < BORDER_CODES {
            return Err(PointError::AtBorder);
        }
        if libm::fabs(reads_c - reference_c) > FARTHEST_K {
            return Err(PointError::TooFar(Celsius::saturating_from_num(reads_c)));
        }
        let point = Point {
            sum: average.sum(),
            reference_c,
        };
        let points = self.of.get_mut(thermistor).ok_or(PointError::Full)?;
        points.push(point).map_err(|_| PointError::Full)
    }

    /// Takes the last point of a thermistor back.
    pub fn drop_last(&mut self, thermistor: usize) {
        if let Some(points) = self.of.get_mut(thermistor) {
            points.pop();
        }
    }
}
