//! Sensing: converts each tick's sums of analogue-to-digital conversions to temperatures, force and current.

mod calibration_tables;
mod contact_detector;
mod force_sensor;
mod supply_voltage;
mod thermistor;
mod thermistor_average;

pub use calibration_tables::CalibrationTables;
pub use contact_detector::{CONTACT_DEBOUNCE_TICKS, ContactDetector};
pub use supply_voltage::SupplyVoltage;
pub use thermistor::ThermistorFault;
pub use thermistor_average::{ThermistorAverage, ThermistorAverages};

use core::array;

use contact_model::fixed_point::{Celsius, Force, to_fixed};

use crate::drive::Current;
use force_sensor::ForceChannel;
use thermal_settings::Settings;
use thermistor::ThermistorTable;

/// Number of analogue signals of one finger, 8: five thermistors, force sensor, current and supply of the bridge. The
/// converter scans them in the order of the fields of [`Samples`].
pub const ADC_CHANNELS_PER_FINGER: usize = 8;

/// Number of thermistors of one finger, 5: display, second display, sink, skin, room. They are the first channels of a
/// [`Scan`], in this order.
pub use thermal_settings::THERMISTOR_COUNT;

/// Oversampling: number of scans of all channels in each control tick of 1 ms. The 16 conversions of a channel are
/// added up to one sum in [`Samples`].
pub const SCANS_PER_TICK: usize = 16;

/// One conversion of each channel of one finger: 12-bit codes (0 to 4095), in the order of the fields of [`Samples`].
pub type Scan = [u16; ADC_CHANNELS_PER_FINGER];

/// One finger's input of one control tick of 1 ms: for each analogue channel the sum of its 16 conversions of 12 bits,
/// 0 to 65520, and the levels of the digital inputs. The sum of a thermistor falls as its temperature rises.
// Aligned to words, so that a copy of it takes a few cycles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(align(4))]
pub struct Samples {
    /// Sum of 16 conversions, 0 to 65520, of the display's first thermistor, in the contact patch; the control law
    /// controls its temperature.
    pub display: u16,
    /// Sum of 16 conversions, 0 to 65520, of the display's second thermistor, which checks the first one. This second
    /// thermistor is also connected to the comparator that cuts the bridge's supply without the program.
    pub display_check: u16,
    /// Sum of 16 conversions, 0 to 65520, of the thermistor on the Peltier module's heat sink.
    pub sink: u16,
    /// Sum of 16 conversions, 0 to 65520, of the thermistor on the finger's skin at the edge of the contact. It shows
    /// the skin's own temperature only while the finger does not touch the display, and the room's if no finger is
    /// there.
    pub skin: u16,
    /// Sum of 16 conversions, 0 to 65520, of the thermistor in the room's air.
    pub room: u16,
    /// Sum of 16 conversions, 0 to 65520, of the force sensor under the display. Nominally 6560 without force (410
    /// counts a conversion), so that a broken wire, which reads 0, is detected.
    pub force: u16,
    /// Sum of 16 conversions, 0 to 65520, of the bridge's current mirror, nominally 6400 per ampere. It shows the
    /// magnitude of the Peltier module's current, but not the direction.
    pub current: u16,
    /// Sum of 16 conversions, 0 to 65520, of the bridge's supply behind the switch that the comparator opens; nominally
    /// 4618 per volt.
    pub supply: u16,
    /// Whether the bridge's fault line is pulled: by the bridge driver, or by the comparator after it has cut the
    /// bridge's supply. The station then trips, except in the states off and tripped, and while the self-test makes the
    /// comparator cut the supply.
    pub bridge_fault: bool,
    /// Whether the emergency stop is pressed, which also disconnects the bridge's supply. One for all fingers.
    pub emergency_stop: bool,
    /// Whether the line that selects the side of the comparators' tests does not have the level that the board drives.
    /// One for all fingers.
    pub comparator_side_differs: bool,
    /// Number of thermistors, 0 to 5, whose 16 conversions differ by two codes or more, which shows that the converter
    /// has noise. 0 if it was not [needed](crate::Device::finger_needs_scatter).
    pub scattering_thermistors: u8,
}

/// Levels of the digital inputs in one control tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DigitalInputs {
    /// Whether the finger's bridge or its comparator pulls the bridge's fault line.
    pub bridge_fault: bool,
    /// Whether the emergency stop is pressed.
    pub emergency_stop: bool,
    /// Whether the line that selects the side of the comparators' tests does not have the level that the board drives.
    pub comparator_side_differs: bool,
}

impl Samples {
    /// Sums of 16 conversions, 0 to 65520, of the five thermistors, in the order display, second display, sink, skin,
    /// room.
    pub const fn thermistor_sums(&self) -> [u16; THERMISTOR_COUNT] {
        [self.display, self.display_check, self.sink, self.skin, self.room]
    }

    /// Adds up the 16 scans of one tick, channel by channel. Looks at the scatter only if `needs_scatter`, as it takes
    /// several hundred cycles.
    ///
    /// If the last conversion of a thermistor is that of an open or shorted wire, the thermistor's sum becomes 16 times
    /// that conversion. The plain sum of a tick in which a wire breaks mixes valid and invalid conversions, and could
    /// pass for a temperature.
    pub fn from_scans(
        scans: &[Scan; SCANS_PER_TICK],
        inputs: DigitalInputs,
        needs_scatter: bool,
    ) -> Self {
        // Before the sums, which are then moved as words.
        let scattering_thermistors = match needs_scatter {
            true => scattering_thermistors(scans),
            false => 0,
        };
        let mut sums = channel_sums(scans);
        let [.., last] = scans;
        if !are_all_codes_of_connected_thermistors(last) {
            replace_sums_of_open_or_shorted_wires(&mut sums, last);
        }
        let [display, display_check, sink, skin, room, force, current, supply] = sums;
        let DigitalInputs { bridge_fault, emergency_stop, comparator_side_differs } = inputs;
        Self {
            display,
            display_check,
            sink,
            skin,
            room,
            force,
            current,
            supply,
            bridge_fault,
            emergency_stop,
            comparator_side_differs,
            scattering_thermistors,
        }
    }
}

/// Whether no code of a scan is that of an open or shorted thermistor; false also if another channel has such a code.
/// Compares two codes at once: bit 15 of half a word shows whether the sum of a code and a constant has passed 2^15. As codes
/// are below 4096, nothing carries into the other half.
fn are_all_codes_of_connected_thermistors(scan: &Scan) -> bool {
    const TOP_BITS: u32 = 0x8000_8000;
    let in_both_halves = |number: u16| u32::from(number) * 0x1_0001;
    let offset_for_smallest = in_both_halves((1 << 15) - thermistor::SMALLEST_CONNECTED_CODE);
    let offset_for_largest = in_both_halves((1 << 15) - 1 - thermistor::LARGEST_CONNECTED_CODE);
    let words: [u32; ADC_CHANNELS_PER_FINGER / 2] = bytemuck::cast(*scan);
    let (mut connected, mut beyond_12_bits) = (TOP_BITS, 0);
    for word in words.into_iter().take(THERMISTOR_COUNT.div_ceil(2)) {
        connected &=
            word.wrapping_add(offset_for_smallest) & !word.wrapping_add(offset_for_largest);
        beyond_12_bits |= word & in_both_halves(0xf000);
    }
    connected == TOP_BITS && beyond_12_bits == 0
}

/// Replaces the sum of each thermistor whose last conversion is that of an open or shorted wire by 16 times that
/// conversion.
#[cold]
#[inline(never)]
fn replace_sums_of_open_or_shorted_wires(sums: &mut [u16; ADC_CHANNELS_PER_FINGER], last: &Scan) {
    for (sum, &code) in sums.iter_mut().zip(last).take(THERMISTOR_COUNT) {
        if thermistor::is_open_or_short_code(code) {
            *sum = code.saturating_mul(SCANS_PER_TICK as u16);
        }
    }
}

/// Number of thermistors whose conversions in a tick differ by two codes or more.
#[inline(never)]
fn scattering_thermistors(scans: &[Scan; SCANS_PER_TICK]) -> u8 {
    let [first, ..] = scans;
    let (mut lowest, mut highest) = (*first, *first);
    for scan in scans {
        for ((lowest, highest), code) in lowest.iter_mut().zip(&mut highest).zip(scan) {
            *lowest = (*lowest).min(*code);
            *highest = (*highest).max(*code);
        }
    }
    let ranges = lowest.iter().zip(&highest).take(THERMISTOR_COUNT);
    ranges.map(|(low, high)| u8::from(high.abs_diff(*low) >= 2)).sum()
}

/// Sum of each channel over the 16 scans of a tick. One addition of 32-bit words adds two codes at once: a sum of 16
/// codes of 12 bits is at most 65520, so it fits in half a word and never carries into the other half. The processor
/// loads several words at once only from an address that is known to be that of a word. Not inlined, so that it has all registers.
#[inline(never)]
fn channel_sums(scans: &[Scan; SCANS_PER_TICK]) -> [u16; ADC_CHANNELS_PER_FINGER] {
    type ScanWords = [u32; ADC_CHANNELS_PER_FINGER / 2];
    if let Ok(scans) = bytemuck::try_cast_ref::<_, [ScanWords; SCANS_PER_TICK]>(scans) {
        let mut sums = [0; ADC_CHANNELS_PER_FINGER / 2];
        for scan in scans {
            for (sum, word) in sums.iter_mut().zip(scan) {
                *sum += word;
            }
        }
        return bytemuck::cast(sums);
    }
    array::from_fn(|channel| scans.iter().map(|scan| scan[channel % scan.len()]).sum())
}

/// One finger's readings of one control tick in physical units. Open or shorted sensors are marked by `Err` or `None`;
/// no other limit has been checked yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Readings {
    /// Temperature, °C, of the display's first thermistor, in the contact patch, which the control law controls; `Err`
    /// if the thermistor or its wire is open or shorted.
    pub display: Result<Celsius, ThermistorFault>,
    /// Temperature, °C, of the display's second thermistor, which checks the first one; `Err` if the thermistor or its
    /// wire is open or shorted.
    pub display_check: Result<Celsius, ThermistorFault>,
    /// Temperature, °C, of the Peltier module's heat sink; `Err` if the thermistor or its wire is open or shorted.
    pub sink: Result<Celsius, ThermistorFault>,
    /// Temperature, °C, of the thermistor on the finger's skin at the edge of the contact; `Err` if the thermistor or
    /// its wire is open or shorted.
    pub skin: Result<Celsius, ThermistorFault>,
    /// Temperature, °C, of the room's air; `Err` if the thermistor or its wire is open or shorted.
    pub room: Result<Celsius, ThermistorFault>,
    /// Force on the display, N; 0 if the signal is below the force sensor's tracked zero; `None` if the sensor's wire
    /// is broken or shorted.
    pub force: Option<Force>,
    /// Magnitude of the Peltier module's current, A, 0 or more, from the bridge's current mirror, which does not show
    /// the direction.
    pub current: Current,
    /// Voltage of the bridge's supply behind the switch that the comparator opens.
    pub supply: SupplyVoltage,
    /// Whether the bridge's fault line is pulled: by the bridge driver, or by the comparator after it has cut the
    /// bridge's supply.
    pub bridge_fault: bool,
    /// Whether the emergency stop is pressed.
    pub emergency_stop: bool,
}

impl Readings {
    /// Placeholder before the first tick: every thermistor is open, the force sensor is broken, current and supply are
    /// zero, the bridge has no fault and the emergency stop is not pressed.
    pub const ALL_OPEN: Self = Self {
        display: Err(ThermistorFault::Open),
        display_check: Err(ThermistorFault::Open),
        sink: Err(ThermistorFault::Open),
        skin: Err(ThermistorFault::Open),
        room: Err(ThermistorFault::Open),
        force: None,
        current: Current::ZERO,
        supply: SupplyVoltage::ZERO,
        bridge_fault: false,
        emergency_stop: false,
    };
}

/// Number of thermistors that take turns, 4: all but the display's first one, which the control law needs in every tick.
/// To save time, each tick converts the sum of only one of them to °C, so that their temperatures are at most 3 ms old.
/// Every tick checks the wires of all.
const THERMISTORS_CONVERTED_IN_TURN: usize = THERMISTOR_COUNT - 1;
/// Number, 2, of those that take turns whose temperature has a trip limit: the second display thermistor and the sink's, the
/// first two.
const THERMISTORS_IN_TURN_WITH_LIMIT_COUNT: usize = 2;
/// If the sum of a thermistor with a limit differs by more than this from the sum that was last converted, 4 codes or about
/// 0.1 K, all four are converted in this tick. A smaller excess over the limit trips up to 3 ticks later. For comparison: the
/// noise of a sum is 3 to 5, and the fastest display moves by 0.1 K in 4 ms.
const CONVERT_OUT_OF_TURN_ABOVE: u32 = 4 * SCANS_PER_TICK as u32;

/// Converts one finger's [`Samples`] of each tick to [`Readings`] with the finger's calibration. Stores the zero of the
/// force sensor, which it tracks while no finger touches, and the last temperatures of the thermistors that take turns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampleConverter {
    thermistor: ThermistorTable,
    calibration: CalibrationTables,
    force: ForceChannel,
    /// Current of the Peltier module, A, per unit of the current mirror's sum of 16 conversions; nominally 1/6400 A.
    current_per_unit: Current,
    /// Last converted temperatures, °C, of the thermistors of second display, sink, skin and room, in this order. `None` until all four
    /// thermistors were connected in the same tick, also after one of them was open or shorted, and after a change of the
    /// calibration; until then each tick converts all of them.
    last_temperatures: Option<[Celsius; THERMISTORS_CONVERTED_IN_TURN]>,
    /// The sums from which `last_temperatures` were converted.
    last_sums: [u32; THERMISTORS_CONVERTED_IN_TURN],
    /// Number of the thermistor in `last_temperatures` that the next tick converts to °C.
    next_in_turn: usize,
}

impl SampleConverter {
    /// SampleConverter of one finger with these settings, before the first tick. Computes in `f64`, so it is for
    /// start-up and not for the control tick.
    pub fn new(settings: &Settings) -> Self {
        let per_unit = 1.0 / (settings.current_counts_per_a * SCANS_PER_TICK as f64);
        Self {
            thermistor: ThermistorTable::new(&settings.thermistor),
            calibration: CalibrationTables::new(settings),
            force: ForceChannel::new(&settings.force),
            current_per_unit: to_fixed(per_unit),
            last_temperatures: None,
            last_sums: [0; THERMISTORS_CONVERTED_IN_TURN],
            next_in_turn: 0,
        }
    }

    /// Moves the stored zero of the force sensor towards this tick's force signal, unless a finger touches the display
    /// or the signal is more than 0.21 N from the zero in the settings; takes it anew if the force sensor's zero `has_moved`. To be
    /// called in each tick with valid readings, after `contact` has been updated by this tick's `force`, N.
    pub fn track_force_zero_unless_touching(
        &mut self,
        samples: &Samples,
        force: Force,
        contact: &ContactDetector,
        has_moved: bool,
    ) {
        if has_moved {
            self.force.restart_zero();
        }
        if !contact.touching() {
            self.force.track_zero(samples.force, contact.may_be_finger(force));
        }
    }

    /// Whether the force signal of the last tick was below its zero by more than 8 mN, which noise is not.
    pub const fn is_force_below_zero(&self) -> bool {
        self.force.is_below_zero()
    }

    /// Replaces the calibration of converter and thermistors from the next tick on. The force sensor's zero is not
    /// changed.
    pub fn replace_calibration_tables(&mut self, calibration: &CalibrationTables) {
        self.calibration = *calibration;
        self.last_temperatures = None;
    }

    /// Converts the samples of one tick to °C, N and A. To save computing time, each tick converts only the display's first
    /// thermistor and one of the others, in turn, and gives the last temperatures of the other three. A thermistor's reading
    /// is `Err` in every tick in which its own wire is open or shorted. All four are converted until one tick has found all
    /// of them connected, and when second display or sink have changed by 0.1 K since they were converted.
    pub fn convert_samples(&mut self, samples: &Samples) -> Readings {
        let [display_sum, others @ ..] = samples.thermistor_sums();
        let [display_check, sink, skin, room] = self.temperatures_in_turn(others);
        Readings {
            display: self.temperature(display_sum, 0),
            display_check,
            sink,
            skin,
            room,
            force: self.force.force_of_sum(samples.force),
            // Multiplies the bits, because `saturating_mul_int` takes more instructions.
            current: Current::from_bits(
                (self.current_per_unit.to_bits()).saturating_mul(samples.current.into()),
            ),
            supply: SupplyVoltage::from_sum(samples.supply),
            bridge_fault: samples.bridge_fault,
            emergency_stop: samples.emergency_stop,
        }
    }

    /// Temperatures of all thermistors but the display's first, of which one is converted in this tick.
    fn temperatures_in_turn(
        &mut self,
        sums: [u16; THERMISTORS_CONVERTED_IN_TURN],
    ) -> [Result<Celsius, ThermistorFault>; THERMISTORS_CONVERTED_IN_TURN] {
        let turn = self.next_in_turn % THERMISTORS_CONVERTED_IN_TURN;
        self.next_in_turn = turn + 1;
        let are_connected = sums.iter().all(|sum| thermistor::check_wiring(*sum).is_ok());
        let mut with_limit =
            sums.iter().zip(&self.last_sums).take(THERMISTORS_IN_TURN_WITH_LIMIT_COUNT);
        let have_moved = with_limit.any(|(now, last)| {
            (u32::from(*now) + CONVERT_OUT_OF_TURN_ABOVE).wrapping_sub(*last)
                > 2 * CONVERT_OUT_OF_TURN_ABOVE
        });
        if are_connected
            && !have_moved
            && let Ok(now) = self.temperature(sums[turn], turn + 1)
            && let Some(last) = &mut self.last_temperatures
        {
            last[turn] = now;
            self.last_sums[turn] = sums[turn].into();
            return last.map(Ok);
        }
        self.temperatures_of_all(sums)
    }

    /// Converts the sums of all thermistors but the display's first.
    #[cold]
    #[inline(never)]
    fn temperatures_of_all(
        &mut self,
        sums: [u16; THERMISTORS_CONVERTED_IN_TURN],
    ) -> [Result<Celsius, ThermistorFault>; THERMISTORS_CONVERTED_IN_TURN] {
        let all = array::from_fn(|i| self.temperature(sums[i], i + 1));
        self.last_temperatures = match all {
            [Ok(display_check), Ok(sink), Ok(skin), Ok(room)] => {
                Some([display_check, sink, skin, room])
            }
            _ => None,
        };
        self.last_sums = sums.map(u32::from);
        all
    }

    /// Temperature, °C, of the thermistor with this number, by its sum.
    fn temperature(&self, sum: u16, thermistor: usize) -> Result<Celsius, ThermistorFault> {
        let CalibrationTables { converter, thermistors } = &self.calibration;
        let uncorrected = (self.thermistor).temperature_of_sum(sum, converter.correct_sum(sum))?;
        Ok(thermistors[thermistor % THERMISTOR_COUNT].corrected_temperature(uncorrected))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Thermistor sums near 25 °C: 10 kohm against a pull-up of 10 kohm, and force sensor and supply at rest.
    const AT_25_C: Samples = Samples {
        display: 32_768,
        display_check: 32_768,
        sink: 32_768,
        skin: 32_768,
        room: 32_768,
        force: 6_560,
        current: 0,
        supply: 55_416,
        bridge_fault: false,
        emergency_stop: false,
        comparator_side_differs: false,
        scattering_thermistors: 0,
    };

    /// Readings of second display, sink, skin and room, °C.
    fn taking_turns(readings: &Readings) -> [f64; THERMISTORS_CONVERTED_IN_TURN] {
        [readings.display_check, readings.sink, readings.skin, readings.room]
            .map(|reading| reading.expect("connected").to_num())
    }

    /// A converter that has seen [`AT_25_C`] once and whose next turn is that of the second display.
    fn started() -> SampleConverter {
        let mut converter = SampleConverter::new(&Settings::default());
        for _ in 0..THERMISTORS_CONVERTED_IN_TURN {
            let _ = converter.convert_samples(&AT_25_C);
        }
        converter
    }

    /// 60 units of a sum are 0.08 K, less than makes a reading be converted out of turn.
    #[test]
    fn each_of_four_ticks_renews_the_next_of_second_display_sink_skin_and_room() {
        let mut converter = started();
        let before = taking_turns(&converter.clone().convert_samples(&AT_25_C));
        let warmer = Samples {
            display_check: 32_768 - 60,
            sink: 32_768 - 60,
            skin: 32_768 - 60,
            room: 32_768 - 60,
            ..AT_25_C
        };
        for tick in 0..2 * THERMISTORS_CONVERTED_IN_TURN {
            let now = taking_turns(&converter.convert_samples(&warmer));
            for (thermistor, (now, before)) in now.iter().zip(before).enumerate() {
                let expected = if thermistor <= tick { 0.08 } else { 0.0 };
                let change = now - before;
                assert!((change - expected).abs() < 0.01, "{tick}: {thermistor} by {change}");
            }
        }
    }

    /// 60 units of the sum are 0.082 K at 25 °C.
    #[test]
    fn the_first_display_thermistor_is_converted_in_every_tick() {
        let mut converter = started();
        let mut display = |units| {
            let samples = Samples { display: AT_25_C.display - units, ..AT_25_C };
            let reading = converter.convert_samples(&samples).display;
            reading.expect("connected").to_num::<f64>()
        };
        let mut before = display(0);
        for tick in 1..20 {
            let now = display(60 * tick);
            assert!((now - before - 0.082).abs() < 0.003, "{tick}: {before} {now}");
            before = now;
        }
    }

    #[test]
    fn a_tick_after_a_calibration_renews_the_readings_of_all_thermistors() {
        let mut converter = started();
        let before = taking_turns(&converter.clone().convert_samples(&AT_25_C));
        let mut settings = Settings::default();
        for correction in &mut settings.calibration.corrections {
            correction.offset_k += 0.5;
        }
        converter.replace_calibration_tables(&CalibrationTables::new(&settings));
        let after = taking_turns(&converter.convert_samples(&AT_25_C));
        for (before, after) in before.iter().zip(after) {
            assert!((after - before - 0.5).abs() < 0.001, "{before} {after}");
        }
    }

    /// 4 codes, 64 units of the sum, are 0.1 K at 25 °C. The turn is that of the room, so that it renews neither.
    #[test]
    fn second_display_and_sink_are_converted_at_once_when_they_have_moved_by_more_than_0_1_k() {
        let mut converter = started();
        for _ in 0..THERMISTORS_CONVERTED_IN_TURN - 1 {
            let _ = converter.convert_samples(&AT_25_C);
        }
        let before = taking_turns(&converter.clone().convert_samples(&AT_25_C));
        for sign in [-1i16, 1] {
            for (units, is_converted) in [(64, false), (65, true)] {
                let moved = 32_768u16.wrapping_add_signed(sign * units);
                let check = Samples { display_check: moved, ..AT_25_C };
                let sink = Samples { sink: moved, ..AT_25_C };
                for (thermistor, samples) in [check, sink].iter().enumerate() {
                    let now = taking_turns(&converter.clone().convert_samples(samples));
                    let change = (now[thermistor] - before[thermistor]) * f64::from(-sign);
                    let expected = if is_converted { 0.088 } else { 0.0 };
                    assert!((change - expected).abs() < 0.012, "{thermistor} by {units}: {change}");
                }
            }
        }
    }
}
