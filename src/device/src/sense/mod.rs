//! From converter counts to temperatures, force and current.

mod average;
mod correction;
mod force;
mod thermistor;

pub use average::{Average, Averages};
pub use correction::{Calibrated, Polynomial, Steps};
pub use force::{ForceScale, Touch};
pub use thermistor::{SensorFault, Thermistor};

use core::array;

use contact_model::fixed_point::{Celsius, Force};

use crate::drive::Current;
use thermal_settings::Settings;

/// Signals of one finger, in the order in which the converter scans them.
pub const CHANNELS: usize = 7;

/// The first of them are thermistors: display, second display, sink, skin, room.
pub use thermal_settings::THERMISTORS;

/// Scans that are summed into the [`Samples`] of one control tick.
pub const SCANS_PER_TICK: usize = 16;

/// One scan: a 12-bit count per channel, in the order of the fields of [`Samples`].
pub type Scan = [u16; CHANNELS];

/// What one control tick knows: sums of [`SCANS_PER_TICK`] 12-bit conversions (0..=65520) per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Samples {
    /// Display thermistor, in the contact patch.
    pub display: u16,
    /// Second display thermistor, which also feeds the independent comparator.
    pub display_check: u16,
    /// Thermistor on the sink.
    pub sink: u16,
    /// Thermistor on the skin, at the edge of the contact.
    pub skin: u16,
    /// Thermistor in the room.
    pub room: u16,
    /// Force sensor.
    pub force: u16,
    /// Current mirror of the bridge.
    pub current: u16,
    /// The bridge driver pulls its fault pin.
    pub bridge_fault: bool,
}

impl Samples {
    /// Those of the thermistors.
    #[must_use]
    pub const fn thermistors(&self) -> [u16; THERMISTORS] {
        [
            self.display,
            self.display_check,
            self.sink,
            self.skin,
            self.room,
        ]
    }

    /// Sums the scans of one tick.
    ///
    /// A thermistor whose last conversion is at an end of the range counts as being there for the whole tick:
    /// the mean of a tick in which a wire broke would be a temperature.
    #[must_use]
    pub fn from_scans(scans: &[Scan; SCANS_PER_TICK], bridge_fault: bool) -> Self {
        let mut sum = sums(scans);
        let [.., last] = scans;
        for (s, &count) in sum.iter_mut().zip(last).take(THERMISTORS) {
            if thermistor::is_at_an_end(count) {
                *s = count.saturating_mul(SCANS_PER_TICK as u16);
            }
        }
        let [display, display_check, sink, skin, room, force, current] = sum;
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

/// The sum of every channel. Two counts are added at a time: sums of 8 times 4095 and of 16 stay within their halves of
/// a word.
fn sums(scans: &[Scan; SCANS_PER_TICK]) -> [u16; CHANNELS] {
    // Two scans are as many whole words as a scan has channels.
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

/// What the samples of one tick say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Readings {
    /// Display surface, in the contact patch.
    pub display: Result<Celsius, SensorFault>,
    /// The same, by the second thermistor.
    pub display_check: Result<Celsius, SensorFault>,
    /// Sink.
    pub sink: Result<Celsius, SensorFault>,
    /// Skin at the edge of the contact.
    pub skin: Result<Celsius, SensorFault>,
    /// Room.
    pub room: Result<Celsius, SensorFault>,
    /// Force; `None` if the sensor's wire is broken.
    pub force: Option<Force>,
    /// Magnitude of the module's current.
    pub current: Current,
    /// The bridge driver pulls its fault pin.
    pub bridge_fault: bool,
}

/// The sensors of one finger.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sensors {
    thermistor: Thermistor,
    calibrated: Calibrated,
    force: ForceScale,
    /// Current of one unit of the sum, in 2^-24 A.
    current_per_unit: i32,
    /// What the slow thermistors said when it was last their turn.
    slow: Option<[Celsius; SLOW]>,
    /// Whose turn it is.
    turn: usize,
}

/// Skin and room move by less than a millikelvin in two ticks, and no limit depends on them, so they are converted in
/// turn. Whether their wires are whole is looked at on every tick.
const SLOW: usize = 2;

impl Sensors {
    /// `f64`, once.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let per_unit = 1.0 / (settings.current_counts_per_a * SCANS_PER_TICK as f64);
        Self {
            thermistor: Thermistor::new(&settings.thermistor),
            calibrated: Calibrated::new(settings),
            force: ForceScale::new(&settings.force),
            current_per_unit: Current::saturating_from_num(per_unit).to_bits(),
            slow: None,
            turn: 0,
        }
    }

    /// Follows the force sensor's zero, after a tick whose force `touch` has taken.
    pub fn follow_zero(&mut self, samples: &Samples, touch: &Touch) {
        if !touch.touching() {
            self.force.follow_zero(samples.force, touch.left_zero());
        }
    }

    /// Reads by another calibration from now on.
    pub fn recalibrate(&mut self, calibrated: &Calibrated) {
        self.calibrated = *calibrated;
    }

    /// Converts the samples of one tick.
    #[must_use]
    pub fn read(&mut self, samples: &Samples) -> Readings {
        let Calibrated { steps, polynomials } = &self.calibrated;
        let [display, display_check, sink, slow_corrections @ ..] = polynomials;
        let thermistor = &self.thermistor;
        let temperature = |sum, correction: &Polynomial| {
            let reached = thermistor.temperature(sum, steps.without(sum))?;
            Ok(correction.apply(reached))
        };
        let sums = [samples.skin, samples.room];
        let slow = if let Some(before) = &mut self.slow {
            let turn = self.turn % SLOW;
            self.turn = turn + 1;
            if let Ok(now) = temperature(sums[turn], &slow_corrections[turn]) {
                before[turn] = now;
            }
            let before = *before;
            array::from_fn(|i| thermistor::connected(sums[i]).map(|()| before[i]))
        } else {
            let all = array::from_fn(|i| temperature(sums[i], &slow_corrections[i]));
            if let [Ok(skin), Ok(room)] = all {
                self.slow = Some([skin, room]);
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
            force: self.force.force(samples.force),
            current: Current::from_bits(
                self.current_per_unit
                    .saturating_mul(i32::from(samples.current)),
            ),
            bridge_fault: samples.bridge_fault,
        }
    }
}
