//! Calibration points: pairs of a converter reading and the temperature of a reference thermometer.

use contact_model::fixed_point::{Celsius, to_fixed};
use heapless::Vec;

use thermal_device::sense::{THERMISTOR_COUNT, ThermistorAverage};
use thermal_settings::CODES_PER_ADC_SEGMENT;

/// Largest number of calibration points of one thermistor; a further one is rejected with [`PointError::Full`].
pub const POINTS_PER_THERMISTOR_MAX: usize = 24;
/// Largest difference, K, between the reference thermometer and the device's reading of a calibration point. A point
/// with a larger difference is rejected with [`PointError::TooFar`], because the reference thermometer is then not at
/// the thermistor.
pub const REFERENCE_DIFFERENCE_MAX_K: f64 = 2.0;
/// Distance, in codes of the 12-bit converter, from a border between two of its segments of 128 codes. A calibration
/// point nearer to a border is rejected, because the converter's characteristic has a step there, and noise spreads the
/// conversions to both sides of the step.
const SEGMENT_BORDER_MARGIN_CODES: f64 = 6.0;

/// One calibration point of a thermistor: the converter's mean reading of the thermistor, and the temperature that the
/// reference thermometer showed at the same time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibrationPoint {
    /// Mean over 512 ticks of 1 ms of the sum of 16 conversions that each tick makes: 0 to 65520, in sixteenths of a
    /// converter count.
    pub sum: f64,
    /// Temperature of the reference thermometer at the thermistor, °C.
    pub reference_c: f64,
}

/// Why a calibration point is rejected. The earlier points and the calibration in use stay as they were.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointError {
    /// The thermistor's reading is drifting: the means of its last two quarters of a second differ by more than 0.12
    /// converter counts, about 3 mK.
    Unsteady,
    /// The thermistor's reading is less than 6 converter codes from a border between two segments of 128 codes, where
    /// the converter's characteristic has a step.
    AtBorder,
    /// The reference thermometer differs by more than [`REFERENCE_DIFFERENCE_MAX_K`] from the device's reading of the
    /// thermistor. The value is that reading, °C.
    TooFar(Celsius),
    /// No allowed calibration fits: the best fit to this point and the earlier ones has a correction or a converter
    /// step outside its allowed range, or cannot be computed.
    Contradicts,
    /// The thermistor already has [`POINTS_PER_THERMISTOR_MAX`] (24) points, or no thermistor has this index.
    Full,
}

/// Calibration points of the five thermistors of one finger since start-up, without those that have been removed. They
/// are kept in memory only, and `save` does not store them.
#[derive(Clone, Debug, Default)]
pub struct CalibrationPoints {
    by_sensor: [Vec<CalibrationPoint, POINTS_PER_THERMISTOR_MAX>; THERMISTOR_COUNT],
}

impl CalibrationPoints {
    /// Calibration points of the thermistor with the index `sensor` (0 to 4), in the order in which they were added;
    /// empty for any other index.
    pub fn of_sensor(&self, sensor: usize) -> &[CalibrationPoint] {
        self.by_sensor.get(sensor).map_or(&[], |points| points.as_slice())
    }

    /// Removes all calibration points of the thermistor with the index `sensor`.
    pub fn remove_points_of_sensor(&mut self, sensor: usize) {
        if let Some(points) = self.by_sensor.get_mut(sensor) {
            points.clear();
        }
    }

    /// Adds a calibration point of the thermistor with the index `sensor`. `average` is its half-second mean,
    /// `reading_c` the temperature, °C, to which the device converts this mean, and `reference_c` the temperature of
    /// the reference thermometer, °C.
    ///
    /// # Errors
    /// Nothing is added then.
    ///
    /// - [`PointError::Unsteady`]: `average` is drifting, by more than 0.12 converter counts in a quarter of a second.
    /// - [`PointError::AtBorder`]: `average` is less than 6 codes from a border of the converter's segments.
    /// - [`PointError::TooFar`]: `reading_c` and `reference_c` differ by more than 2 K.
    /// - [`PointError::Full`]: the thermistor has 24 points already, or `sensor` is above 4.
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
        let segments = average.mean_sum() / f64::from(16 * CODES_PER_ADC_SEGMENT);
        let from_border_codes =
            (segments - libm::round(segments)) * f64::from(CODES_PER_ADC_SEGMENT);
        if libm::fabs(from_border_codes) < SEGMENT_BORDER_MARGIN_CODES {
            return Err(PointError::AtBorder);
        }
        if libm::fabs(reading_c - reference_c) > REFERENCE_DIFFERENCE_MAX_K {
            return Err(PointError::TooFar(to_fixed(reading_c)));
        }
        let point = CalibrationPoint { sum: average.mean_sum(), reference_c };
        let points = self.by_sensor.get_mut(sensor).ok_or(PointError::Full)?;
        points.push(point).map_err(|_| PointError::Full)
    }

    /// Removes the calibration point that was added last for the thermistor with the index `sensor`. Called when the
    /// point was added, but no allowed calibration fits it or the station refuses the new calibration.
    pub fn remove_latest(&mut self, sensor: usize) {
        if let Some(points) = self.by_sensor.get_mut(sensor) {
            points.pop();
        }
    }
}
