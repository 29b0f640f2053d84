//! Calibration points: pairs of a converter reading and the temperature of a reference thermometer.

use contact_model::fixed_point::Celsius;
use heapless::Vec;

use thermal_device::sense::{THERMISTORS, ThermistorAverage};
use thermal_settings::SEGMENT_CODES;

/// Largest number of points of one thermistor.
pub const POINTS_MAX: usize = 24;
/// Largest difference between the reference and the device's reading, K; a larger one means that the reference
/// thermometer is not at the sensor.
pub const POINT_DEVIATION_MAX_K: f64 = 2.0;
/// Distance from a segment border of the converter, codes, within which noise mixes readings from both segments.
const BORDER_MARGIN_CODES: f64 = 6.0;

/// One calibration point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Mean over many ticks of the sum of 16 conversions.
    pub sum: f64,
    /// Temperature of the reference thermometer, °C.
    pub reference_c: f64,
}

/// Why a calibration point is rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointError {
    /// The reading is drifting.
    Unsteady,
    /// The reading is too near to a border between two segments of the converter.
    AtBorder,
    /// The reference differs too much from the device's reading, °C.
    TooFar(Celsius),
    /// No calibration within the allowed ranges fits this point and the earlier ones.
    Contradicts,
    /// The thermistor already has [`POINTS_MAX`] points.
    Full,
}

/// All calibration points since start-up.
#[derive(Clone, Debug, Default)]
pub struct Points {
    by_sensor: [Vec<Point, POINTS_MAX>; THERMISTORS],
}

impl Points {
    /// The points of one sensor.
    #[must_use]
    pub fn of_sensor(&self, sensor: usize) -> &[Point] {
        self.by_sensor
            .get(sensor)
            .map_or(&[], |points| points.as_slice())
    }

    /// Removes all points of one sensor.
    pub fn clear(&mut self, sensor: usize) {
        if let Some(points) = self.by_sensor.get_mut(sensor) {
            points.clear();
        }
    }

    /// Adds a point of a sensor whose average converts to `reading_c`.
    ///
    /// # Errors
    /// The point is rejected.
    pub fn add(
        &mut self,
        sensor: usize,
        average: &ThermistorAverage,
        reading_c: f64,
        reference_c: f64,
    ) -> Result<(), PointError> {
        if !average.is_steady() {
            return Err(PointError::Unsteady);
        }
        let segments = average.mean_sum() / f64::from(16 * SEGMENT_CODES);
        let from_border_codes = (segments - libm::round(segments)) * f64::from(SEGMENT_CODES);
        if libm::fabs(from_border_codes) < BORDER_MARGIN_CODES {
            return Err(PointError::AtBorder);
        }
        if libm::fabs(reading_c - reference_c) > POINT_DEVIATION_MAX_K {
            return Err(PointError::TooFar(Celsius::saturating_from_num(reading_c)));
        }
        let point = Point {
            sum: average.mean_sum(),
            reference_c,
        };
        let points = self.by_sensor.get_mut(sensor).ok_or(PointError::Full)?;
        points.push(point).map_err(|_| PointError::Full)
    }

    /// Removes the latest point of a sensor.
    pub fn remove_latest(&mut self, sensor: usize) {
        if let Some(points) = self.by_sensor.get_mut(sensor) {
            points.pop();
        }
    }
}
