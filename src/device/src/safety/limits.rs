//! What one tick shows: levels.

use contact_model::fixed_point::{Celsius, Force};

use super::{Fault, Thermistor};
use crate::drive::Current;
use crate::sense::{Readings, SensorFault};

/// Display temperatures that trip. Commands stay within [`Setpoint`](super::Setpoint); pain begins at 13 and 45 °C.
const DISPLAY_COLDEST: Celsius = Celsius::lit("13.5");
const DISPLAY_HOTTEST: Celsius = Celsius::lit("43");
/// Sink temperature that trips. With the bridge off, the plate drifts to the sink's temperature, and the finger on it
/// with the plate: at 42 °C it takes four minutes of that to make one of the dose's, and the sink cools meanwhile.
const SINK_HOTTEST: Celsius = Celsius::lit("42");
/// Current above the limit of the command that trips: before it is tuned, supply, module and mirror may make 1.8 A more of 6 A.
const CURRENT_MARGIN: Current = Current::lit("3");

/// Readings without a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sound {
    /// Display surface.
    pub display: Celsius,
    /// The same, by the second thermistor.
    pub check: Celsius,
    /// Sink.
    pub sink: Celsius,
    /// Skin at the edge of the contact.
    pub skin: Celsius,
    /// Room.
    pub room: Celsius,
    /// Force.
    pub force: Force,
}

/// Checks one tick; `limit` is the largest current that is ever asked for.
///
/// # Errors
/// The first fault, sensors before what they measure.
pub fn check(readings: &Readings, limit: Current) -> Result<Sound, Fault> {
    let all = [
        readings.display,
        readings.display_check,
        readings.sink,
        readings.skin,
        readings.room,
    ];
    if all == [Err(SensorFault::Short); 5] {
        return Err(Fault::Excitation);
    }
    let named = |reading: Result<Celsius, SensorFault>, which| {
        reading.map_err(|fault| Fault::of_sensor(which, fault))
    };
    let sound = Sound {
        display: named(readings.display, Thermistor::Display)?,
        check: named(readings.display_check, Thermistor::Check)?,
        sink: named(readings.sink, Thermistor::Sink)?,
        skin: named(readings.skin, Thermistor::Skin)?,
        room: named(readings.room, Thermistor::Room)?,
        force: readings.force.ok_or(Fault::ForceSensor)?,
    };
    if sound.display.max(sound.check) > DISPLAY_HOTTEST {
        return Err(Fault::DisplayHot);
    }
    if sound.display.min(sound.check) < DISPLAY_COLDEST {
        return Err(Fault::DisplayCold);
    }
    if sound.sink > SINK_HOTTEST {
        return Err(Fault::SinkHot);
    }
    if readings.current > limit.saturating_add(CURRENT_MARGIN) {
        return Err(Fault::OverCurrent);
    }
    Ok(sound)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sound() -> Readings {
        let t = |t: i32| Ok(Celsius::from_num(t));
        Readings {
            display: t(30),
            display_check: t(30),
            sink: t(25),
            skin: t(34),
            room: t(24),
            force: Some(Force::ZERO),
            current: Current::ZERO,
            bridge_fault: false,
        }
    }

    fn fault_of(change: impl Fn(&mut Readings)) -> Option<&'static str> {
        let mut readings = sound();
        change(&mut readings);
        check(&readings, Current::lit("6")).err().map(Fault::name)
    }

    #[test]
    fn each_bad_reading_is_named() {
        let t = |t: f64| Ok(Celsius::from_num(t));
        let short = Err(SensorFault::Short);
        assert_eq!(fault_of(|_| ()), None);
        assert_eq!(
            fault_of(|r| r.display = Err(SensorFault::Open)),
            Some("display-open")
        );
        assert_eq!(fault_of(|r| r.display_check = short), Some("check-short"));
        assert_eq!(
            fault_of(|r| r.sink = Err(SensorFault::Open)),
            Some("sink-open")
        );
        assert_eq!(fault_of(|r| r.skin = short), Some("skin-short"));
        assert_eq!(
            fault_of(|r| r.room = Err(SensorFault::Open)),
            Some("room-open")
        );
        let all = |r: &mut Readings| {
            (r.display, r.display_check, r.sink, r.skin, r.room) =
                (short, short, short, short, short);
        };
        assert_eq!(fault_of(all), Some("excitation"));
        assert_eq!(fault_of(|r| r.force = None), Some("force-sensor"));
        assert_eq!(fault_of(|r| r.display = t(43.01)), Some("display-hot"));
        assert_eq!(
            fault_of(|r| r.display_check = t(43.01)),
            Some("display-hot")
        );
        assert_eq!(fault_of(|r| r.display = t(42.99)), None);
        assert_eq!(
            fault_of(|r| r.display_check = t(13.49)),
            Some("display-cold")
        );
        assert_eq!(fault_of(|r| r.sink = t(42.1)), Some("sink-hot"));
        assert_eq!(
            fault_of(|r| r.current = Current::lit("9.1")),
            Some("over-current")
        );
    }
}
