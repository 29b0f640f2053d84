//! Checks the readings of one tick: sensors first, then the limits of what they measure.

use contact_model::fixed_point::{Celsius, Force};

use super::limits::{DISPLAY_TRIP_ABOVE, DISPLAY_TRIP_BELOW, OVER_CURRENT_MARGIN, SINK_TRIP_ABOVE};
use super::{Fault, ThermistorId};
use crate::drive::Current;
use crate::sense::{Readings, SupplyVoltage, ThermistorFault};

/// Readings of one tick that have passed [`validate_readings`]: no thermistor and no force sensor is open or shorted,
/// and temperatures and current are within the limits beyond which the station trips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ValidReadings {
    /// Display surface temperature by the display's first thermistor, which the control uses, °C, 13.5 to 43 °C.
    pub display: Celsius,
    /// Display surface temperature by the display's second thermistor, °C, 13.5 to 43 °C. Used only by the self-test and
    /// for fault detection: it must agree with the first thermistor, and it has the same temperature limits, so that one
    /// wrong thermistor cannot hide a display that is too hot or too cold. The control does not use it.
    pub check: Celsius,
    /// Temperature of the Peltier module's heat sink, °C; at most 42 °C, above which the station trips.
    pub sink: Celsius,
    /// Temperature of the finger's skin at the edge of the contact, °C, by the skin's thermistor; if the thermistor is
    /// on no finger, it reads the room's air.
    pub skin: Celsius,
    /// Air temperature of the room, °C, by the room's thermistor.
    pub room: Celsius,
    /// Force of the finger on the display, N; 0 if the sensor's signal is below the signal of no force.
    pub force: Force,
    /// Magnitude of the measured module current, A; at most 3 A above the largest current that the controller demands,
    /// 6 A.
    pub current: Current,
    /// Voltage of the bridge's supply behind the switch that the comparator opens.
    pub supply: SupplyVoltage,
}

/// Checks what the readings of one tick alone can show: the emergency stop, broken sensors, and temperatures and current
/// beyond their limits. `current_limit` is the largest current that the controller demands, 6 A.
///
/// # Errors
/// The first of these faults: [`Fault::EmergencyStop`], [`Fault::Excitation`] (all five thermistors shorted), the fault of one open or shorted
/// thermistor, [`Fault::ForceSensor`] (signal invalid), [`Fault::DisplayHot`] and [`Fault::DisplayCold`] (a display
/// thermistor above 43 °C, or below 13.5 °C), [`Fault::SinkHot`] (above 42 °C), [`Fault::OverCurrent`] (more than 3 A
/// above `current_limit`). The emergency stop comes first, because it explains what follows from it; broken sensors come
/// before limits, because their readings mean no temperature.
pub fn validate_readings(
    readings: &Readings,
    current_limit: Current,
) -> Result<ValidReadings, Fault> {
    if readings.emergency_stop {
        return Err(Fault::EmergencyStop);
    }
    // One look at all sensors; which one has failed is of interest only then.
    let (Ok(display), Ok(check), Ok(sink), Ok(skin), Ok(room), Some(force)) = (
        readings.display,
        readings.display_check,
        readings.sink,
        readings.skin,
        readings.room,
        readings.force,
    ) else {
        return Err(first_sensor_fault(readings));
    };
    let valid = ValidReadings {
        display,
        check,
        sink,
        skin,
        room,
        force,
        current: readings.current,
        supply: readings.supply,
    };
    if valid.display.max(valid.check) > DISPLAY_TRIP_ABOVE {
        return Err(Fault::DisplayHot);
    }
    if valid.display.min(valid.check) < DISPLAY_TRIP_BELOW {
        return Err(Fault::DisplayCold);
    }
    if valid.sink > SINK_TRIP_ABOVE {
        return Err(Fault::SinkHot);
    }
    if valid.current > current_limit.saturating_add(OVER_CURRENT_MARGIN) {
        return Err(Fault::OverCurrent);
    }
    Ok(valid)
}

/// The fault of the first sensor that is open or shorted.
#[cold]
#[inline(never)]
fn first_sensor_fault(readings: &Readings) -> Fault {
    let thermistors = [
        (readings.display, ThermistorId::Display),
        (readings.display_check, ThermistorId::Check),
        (readings.sink, ThermistorId::Sink),
        (readings.skin, ThermistorId::Skin),
        (readings.room, ThermistorId::Room),
    ];
    if (thermistors.iter()).all(|(reading, _)| *reading == Err(ThermistorFault::Short)) {
        return Fault::Excitation;
    }
    let mut faults = thermistors.into_iter().filter_map(|(reading, thermistor)| {
        let fault = reading.err()?;
        Some(Fault::of_open_or_shorted_thermistor(thermistor, fault))
    });
    faults.next().unwrap_or(Fault::ForceSensor)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn valid() -> Readings {
        let t = |t: i32| Ok(Celsius::from_num(t));
        Readings {
            display: t(30),
            display_check: t(30),
            sink: t(25),
            skin: t(34),
            room: t(24),
            force: Some(Force::ZERO),
            current: Current::ZERO,
            supply: SupplyVoltage::from_volts(12.0),
            bridge_fault: false,
            emergency_stop: false,
        }
    }

    fn fault_of(change: impl Fn(&mut Readings)) -> Option<&'static str> {
        let mut readings = valid();
        change(&mut readings);
        validate_readings(&readings, Current::lit("6")).err().map(Fault::name)
    }

    #[test]
    fn each_invalid_reading_has_its_fault() {
        let t = |t: f64| Ok(Celsius::from_num(t));
        let short = Err(ThermistorFault::Short);
        assert_eq!(fault_of(|_| ()), None);
        assert_eq!(fault_of(|r| r.display = Err(ThermistorFault::Open)), Some("display-open"));
        assert_eq!(fault_of(|r| r.display_check = short), Some("check-short"));
        assert_eq!(fault_of(|r| r.sink = Err(ThermistorFault::Open)), Some("sink-open"));
        assert_eq!(fault_of(|r| r.skin = short), Some("skin-short"));
        assert_eq!(fault_of(|r| r.room = Err(ThermistorFault::Open)), Some("room-open"));
        let all = |r: &mut Readings| {
            (r.display, r.display_check, r.sink, r.skin, r.room) =
                (short, short, short, short, short);
        };
        assert_eq!(fault_of(all), Some("excitation"));
        assert_eq!(
            fault_of(|r| (r.emergency_stop, r.sink) = (true, short)),
            Some("emergency-stop")
        );
        assert_eq!(fault_of(|r| r.force = None), Some("force-sensor"));
        assert_eq!(fault_of(|r| r.display = t(43.01)), Some("display-hot"));
        assert_eq!(fault_of(|r| r.display_check = t(43.01)), Some("display-hot"));
        assert_eq!(fault_of(|r| r.display = t(42.99)), None);
        assert_eq!(fault_of(|r| r.display_check = t(13.49)), Some("display-cold"));
        assert_eq!(fault_of(|r| r.sink = t(42.1)), Some("sink-hot"));
        assert_eq!(fault_of(|r| r.current = Current::lit("9.1")), Some("over-current"));
    }
}
