//! Limits and faults: what switches the bridge off, and keeps it off.
//!
//! Faults are levels, checked on every tick in every state. The first one is latched; only the
//! host's `clear` takes it back, and only when no fault is present any more.

mod setpoint;
mod watch;

pub use setpoint::Setpoint;
pub use watch::Watch;

use contact_model::fixed_point::Celsius;

use crate::drive::Current;
use crate::sense::{Readings, SensorFault};

/// Display temperatures that trip. Commands stay within [`Setpoint`]; pain begins at 13 and 45 °C.
const DISPLAY_COLDEST: Celsius = Celsius::lit("13.5");
const DISPLAY_HOTTEST: Celsius = Celsius::lit("43");
/// Sink temperature that trips: with the bridge off, heat flows from the sink back to the skin.
const SINK_HOTTEST: Celsius = Celsius::lit("44");
/// Current above the limit of the command that trips.
const CURRENT_MARGIN: Current = Current::lit("1.5");

/// Why the bridge is off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A thermistor is open or shorted.
    Sensor(Thermistor, SensorFault),
    /// Force sensor below its live zero.
    ForceSensor,
    /// A display thermistor above 43 °C.
    DisplayTooHot,
    /// A display thermistor below 13.5 °C.
    DisplayTooCold,
    /// Sink above 44 °C.
    SinkTooHot,
    /// Measured current beyond the limit.
    OverCurrent,
    /// The bridge driver reports a fault.
    Bridge,
    /// All samples have repeated themselves for 50 ms: the converter stands still.
    SamplesFrozen,
    /// The display's thermistors have been more than 3 K apart for 100 ms.
    DisplaysDisagree,
    /// What was stored is no settings: the device has those of its class.
    SettingsCorrupt,
}

/// One of the five thermistors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Thermistor {
    /// Display surface.
    Display,
    /// Display surface, second.
    DisplayCheck,
    /// Sink.
    Sink,
    /// Skin.
    Skin,
    /// Room.
    Room,
}

impl Fault {
    /// The word for it in the protocol.
    #[must_use]
    pub const fn name(self) -> &'static str {
        use SensorFault::{Open, Short};
        match self {
            Self::Sensor(Thermistor::Display, Open) => "display-open",
            Self::Sensor(Thermistor::Display, Short) => "display-short",
            Self::Sensor(Thermistor::DisplayCheck, Open) => "check-open",
            Self::Sensor(Thermistor::DisplayCheck, Short) => "check-short",
            Self::Sensor(Thermistor::Sink, Open) => "sink-open",
            Self::Sensor(Thermistor::Sink, Short) => "sink-short",
            Self::Sensor(Thermistor::Skin, Open) => "skin-open",
            Self::Sensor(Thermistor::Skin, Short) => "skin-short",
            Self::Sensor(Thermistor::Room, Open) => "room-open",
            Self::Sensor(Thermistor::Room, Short) => "room-short",
            Self::ForceSensor => "force-sensor",
            Self::DisplayTooHot => "display-hot",
            Self::DisplayTooCold => "display-cold",
            Self::SinkTooHot => "sink-hot",
            Self::OverCurrent => "over-current",
            Self::Bridge => "bridge",
            Self::SamplesFrozen => "samples-frozen",
            Self::DisplaysDisagree => "displays-apart",
            Self::SettingsCorrupt => "settings-corrupt",
        }
    }
}

/// Readings without a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sound {
    /// Display surface.
    pub display: Celsius,
    /// Sink.
    pub sink: Celsius,
    /// Skin at the edge of the contact.
    pub skin: Celsius,
    /// Room.
    pub room: Celsius,
    /// Force.
    pub force: contact_model::fixed_point::Force,
}

/// Checks one tick.
///
/// # Errors
/// The first fault, sensors before what they measure.
pub fn check(readings: &Readings, current_limit: Current) -> Result<Sound, Fault> {
    let named =
        |reading: Result<Celsius, SensorFault>, which| reading.map_err(|fault| Fault::Sensor(which, fault));
    let sound = Sound {
        display: named(readings.display, Thermistor::Display)?,
        sink: named(readings.sink, Thermistor::Sink)?,
        skin: named(readings.skin, Thermistor::Skin)?,
        room: named(readings.room, Thermistor::Room)?,
        force: readings.force.ok_or(Fault::ForceSensor)?,
    };
    let display_check = named(readings.display_check, Thermistor::DisplayCheck)?;
    if sound.display.max(display_check) > DISPLAY_HOTTEST {
        return Err(Fault::DisplayTooHot);
    }
    if sound.display.min(display_check) < DISPLAY_COLDEST {
        return Err(Fault::DisplayTooCold);
    }
    if sound.sink > SINK_HOTTEST {
        return Err(Fault::SinkTooHot);
    }
    if readings.current > current_limit.saturating_add(CURRENT_MARGIN) {
        return Err(Fault::OverCurrent);
    }
    if readings.bridge_fault {
        return Err(Fault::Bridge);
    }
    Ok(sound)
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact_model::fixed_point::Force;

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
        assert_eq!(fault_of(|_| ()), None);
        assert_eq!(
            fault_of(|r| r.display = Err(SensorFault::Open)),
            Some("display-open")
        );
        assert_eq!(
            fault_of(|r| r.display_check = Err(SensorFault::Short)),
            Some("check-short")
        );
        assert_eq!(fault_of(|r| r.sink = Err(SensorFault::Open)), Some("sink-open"));
        assert_eq!(fault_of(|r| r.skin = Err(SensorFault::Short)), Some("skin-short"));
        assert_eq!(fault_of(|r| r.room = Err(SensorFault::Open)), Some("room-open"));
        assert_eq!(fault_of(|r| r.force = None), Some("force-sensor"));
        assert_eq!(fault_of(|r| r.display = t(43.01)), Some("display-hot"));
        assert_eq!(fault_of(|r| r.display_check = t(43.01)), Some("display-hot"));
        assert_eq!(fault_of(|r| r.display = t(42.99)), None);
        assert_eq!(fault_of(|r| r.display_check = t(13.49)), Some("display-cold"));
        assert_eq!(fault_of(|r| r.sink = t(44.1)), Some("sink-hot"));
        assert_eq!(
            fault_of(|r| r.current = Current::lit("7.6")),
            Some("over-current")
        );
        assert_eq!(fault_of(|r| r.bridge_fault = true), Some("bridge"));
    }

    #[test]
    fn setpoint_cannot_leave_its_range() {
        for (wanted, allowed, limited) in [(14.9, 15.0, true), (15.0, 15.0, false), (42.5, 42.0, true)] {
            let (setpoint, was_limited) = Setpoint::limited(Celsius::from_num(wanted));
            assert_eq!(
                (setpoint.celsius().to_num::<f64>(), was_limited),
                (allowed, limited)
            );
        }
        assert_eq!(Setpoint::limited(Celsius::MAX).0, Setpoint::MAX);
        assert_eq!(Setpoint::limited(Celsius::MIN).0, Setpoint::MIN);
    }
}
