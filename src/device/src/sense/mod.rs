//! Sensing: sums of conversions to temperatures, force and current.

mod average;
mod correction;
mod force;
mod thermistor;

pub use average::{ThermistorAverage, ThermistorAverages};
pub use correction::CalibrationTables;
pub use force::ContactDetector;
pub use thermistor::SensorFault;

use core::array;

use contact_model::fixed_point::{Celsius, Force};

use crate::drive::Current;
use correction::ThermistorCorrection;
use force::ForceChannel;
use thermal_settings::Settings;
use thermistor::ThermistorTable;

/// Analogue signals of one finger: five thermistors, force sensor, and current mirror. [`Samples`] lists them in the
/// order in which the converter scans them.
pub const CHANNELS: usize = 7;

/// The first channels are thermistors: display, second display, sink, skin, room.
pub use thermal_settings::THERMISTORS;

/// Oversampling: scans of all channels whose conversions are summed into the [`Samples`] of one control tick of 1 ms.
pub const SCANS_PER_TICK: usize = 16;

/// One scan of a finger's signals: a 12-bit count (0 to 4095) for each channel, in the order of the fields of
/// [`Samples`].
pub type Scan = [u16; CHANNELS];

/// Input of one control tick: for each channel the sum of [`SCANS_PER_TICK`] conversions of 12 bits, 0 to 65520.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Samples {
    /// Display thermistor in the contact patch, to whose reading the display is controlled.
    pub display: u16,
    /// Second display thermistor, which checks the first, and which the independent comparator reads, too.
    pub display_check: u16,
    /// Thermistor on the heat sink of the Peltier module.
    pub sink: u16,
    /// Thermistor on the skin, at the edge of the contact.
    pub skin: u16,
    /// Thermistor in the air of the room.
    pub room: u16,
    /// Force sensor under the display.
    pub force: u16,
    /// Current mirror of the bridge, which shows the magnitude of the module's current.
    pub current: u16,
    /// The bridge driver pulls its fault pin, or a comparator that has cut the supply does; except where that is
    /// expected, the station trips.
    pub bridge_fault: bool,
}

impl Samples {
    /// The sums of the five thermistors: display, second display, sink, skin, room.
    #[must_use]
    pub const fn thermistor_sums(&self) -> [u16; THERMISTORS] {
        [
            self.display,
            self.display_check,
            self.sink,
            self.skin,
            self.room,
        ]
    }

    /// Sums the scans of one tick, channel by channel; `bridge_fault` is the level of the fault pin.
    ///
    /// If the last conversion of a thermistor is that of an open or shorted wire, its sum becomes 16 times that
    /// conversion, because the plain sum over a tick in which a wire breaks would pass for a temperature.
    #[must_use]
    pub fn from_scans(scans: &[Scan; SCANS_PER_TICK], bridge_fault: bool) -> Self {
        let mut sums = channel_sums(scans);
        let [.., last] = scans;
        for (sum, &code) in sums.iter_mut().zip(last).take(THERMISTORS) {
            if thermistor::is_code_out_of_range(code) {
                *sum = code.saturating_mul(SCANS_PER_TICK as u16);
            }
        }
        let [display, display_check, sink, skin, room, force, current] = sums;
        Self {
            display,
            display_check,
            sink,
            skin,
            room,
            force,
            current,
            bridge_fault,
        }
    }
}

/// The sum of every channel over 16 scans. One addition of 32-bit words adds the codes of two channels, because sums of
/// 8 codes, and of 16, stay within half a word.
fn channel_sums(scans: &[Scan; SCANS_PER_TICK]) -> [u16; CHANNELS] {
    // A scan has an odd number of half-words: two scans are a whole number of words, as many as there are channels.
    let mut words = [0u32; CHANNELS];
    let (pairs, _) = scans.as_chunks::<2>();
    for pair in pairs {
        let (halves, _) = pair.as_flattened().as_chunks::<2>();
        for (word, [low, high]) in words.iter_mut().zip(halves) {
            *word += u32::from(*low) | u32::from(*high) << 16;
        }
    }
    let half = |i: usize| (words[i / 2 % CHANNELS] >> (16 * (i % 2))) as u16;
    core::array::from_fn(|channel| half(channel).wrapping_add(half(channel + CHANNELS)))
}

/// One control tick's samples in physical units, not yet checked against any limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Readings {
    /// Temperature, °C, of the display's thermistor in the contact patch.
    pub display: Result<Celsius, SensorFault>,
    /// Temperature, °C, of the display's second thermistor.
    pub display_check: Result<Celsius, SensorFault>,
    /// Temperature of the sink, °C.
    pub sink: Result<Celsius, SensorFault>,
    /// Temperature of the skin at the edge of the contact, °C.
    pub skin: Result<Celsius, SensorFault>,
    /// Temperature of the room, °C.
    pub room: Result<Celsius, SensorFault>,
    /// Force on the display, N, 0 below the tracked zero; `None` if the sensor's wire is broken or shorted.
    pub force: Option<Force>,
    /// Magnitude of the module's current, A, from the bridge's current mirror, which does not tell the direction.
    pub current: Current,
    /// The bridge driver pulls its fault pin, or a comparator that has cut the supply does.
    pub bridge_fault: bool,
}

impl Readings {
    /// Readings before the first tick: every thermistor open, no force, no current.
    pub const ALL_OPEN: Self = Self {
        display: Err(SensorFault::Open),
        display_check: Err(SensorFault::Open),
        sink: Err(SensorFault::Open),
        skin: Err(SensorFault::Open),
        room: Err(SensorFault::Open),
        force: None,
        current: Current::ZERO,
        bridge_fault: false,
    };
}

/// Number of the slow thermistors, skin and room. Their temperatures change by less than a millikelvin in two ticks, so
/// each tick converts only one of the two. Every tick checks the wires of both.
const SLOW_THERMISTORS: usize = 2;

/// Converts one finger's samples to °C, N and A, with its calibration; keeps the force sensor's zero and the last
/// temperatures of skin and room.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sensors {
    thermistor: ThermistorTable,
    calibration: CalibrationTables,
    force: ForceChannel,
    /// Current, A, per unit of the sum of 16 conversions.
    current_per_unit: Current,
    /// Last temperatures of skin and room, °C; `None` before a first tick has had both.
    slow_temperatures: Option<[Celsius; SLOW_THERMISTORS]>,
    /// Which slow thermistor the next tick converts: 0 for the skin, 1 for the room, modulo 2.
    next_slow: usize,
}

impl Sensors {
    /// Converts the settings of one finger from `f64`, so it is for start-up and not for the tick.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let per_unit = 1.0 / (settings.current_counts_per_a * SCANS_PER_TICK as f64);
        Self {
            thermistor: ThermistorTable::new(&settings.thermistor),
            calibration: CalibrationTables::new(settings),
            force: ForceChannel::new(&settings.force),
            current_per_unit: Current::saturating_from_num(per_unit),
            slow_temperatures: None,
            next_slow: 0,
        }
    }

    /// Lets the force sensor's zero follow the signal while nothing touches. Called once a tick, after `contact` has
    /// been updated by the force of this tick.
    pub fn track_zero(&mut self, samples: &Samples, contact: &ContactDetector) {
        if !contact.touching() {
            self.force.track_zero(samples.force, contact.is_off_zero());
        }
    }

    /// Uses another calibration of the thermistors from the next tick on; the force sensor's zero stays.
    pub fn recalibrate(&mut self, calibration: &CalibrationTables) {
        self.calibration = *calibration;
    }

    /// Converts the samples of one tick to readings. Of skin and room it converts only one in each tick, once both have
    /// been read; the other one keeps its last temperature, unless its wire is open or shorted.
    #[must_use]
    pub fn read_samples(&mut self, samples: &Samples) -> Readings {
        let CalibrationTables {
            converter,
            thermistors: [display, display_check, sink, slow_corrections @ ..],
        } = &self.calibration;
        let thermistor = &self.thermistor;
        let temperature = |sum, correction: &ThermistorCorrection| {
            let uncorrected = thermistor.temperature_of_sum(sum, converter.correct_sum(sum))?;
            Ok(correction.corrected_temperature(uncorrected))
        };
        let slow_sums = [samples.skin, samples.room];
        let slow = if let Some(last) = &mut self.slow_temperatures {
            let converted = self.next_slow % SLOW_THERMISTORS;
            self.next_slow = converted + 1;
            if let Ok(now) = temperature(slow_sums[converted], &slow_corrections[converted]) {
                last[converted] = now;
            }
            let last = *last;
            array::from_fn(|i| thermistor::check_wiring(slow_sums[i]).map(|()| last[i]))
        } else {
            let all = array::from_fn(|i| temperature(slow_sums[i], &slow_corrections[i]));
            if let [Ok(skin), Ok(room)] = all {
                self.slow_temperatures = Some([skin, room]);
            }
            all
        };
        let [skin, room] = slow;
        Readings {
            display: temperature(samples.display, display),
            display_check: temperature(samples.display_check, display_check),
            sink: temperature(samples.sink, sink),
            skin,
            room,
            force: self.force.force_of_sum(samples.force),
            // On the bits: `saturating_mul_int` takes more instructions.
            current: Current::from_bits(
                (self.current_per_unit.to_bits()).saturating_mul(samples.current.into()),
            ),
            bridge_fault: samples.bridge_fault,
        }
    }
}
