//! The first cause: what tripped, when, and what was read then.

use contact_model::fixed_point::Celsius;

use super::Fault;
use crate::drive::Current;
use crate::sense::Readings;

/// What is known of the moment of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cause {
    /// What tripped.
    pub fault: Fault,
    /// Ticks since the start of the program that saw it.
    pub tick: u32,
    /// Display thermistor, if it had a temperature.
    pub display: Option<Celsius>,
    /// Second display thermistor.
    pub check: Option<Celsius>,
    /// Sink.
    pub sink: Option<Celsius>,
    /// Magnitude of the measured current.
    pub current: Current,
    /// Current asked for in the tick before.
    pub asked: Current,
}

impl Cause {
    /// Words of [`Self::to_words`].
    pub const WORDS: usize = 7;

    /// In a tick.
    #[must_use]
    pub fn new(fault: Fault, tick: u32, readings: &Readings, asked: Current) -> Self {
        Self {
            fault,
            tick,
            display: readings.display.ok(),
            check: readings.display_check.ok(),
            sink: readings.sink.ok(),
            current: readings.current,
            asked,
        }
    }

    /// Of a fault that no tick has seen.
    #[must_use]
    pub const fn alone(fault: Fault) -> Self {
        Self {
            fault,
            tick: 0,
            display: None,
            check: None,
            sink: None,
            current: Current::ZERO,
            asked: Current::ZERO,
        }
    }

    /// To be kept.
    #[must_use]
    pub fn to_words(&self) -> [u32; Self::WORDS] {
        // No thermistor reads the least of all temperatures.
        let word = |t: Option<Celsius>| t.unwrap_or(Celsius::MIN).to_bits().cast_unsigned();
        [
            self.fault as u32,
            self.tick,
            word(self.display),
            word(self.check),
            word(self.sink),
            self.current.to_bits().cast_unsigned(),
            self.asked.to_bits().cast_unsigned(),
        ]
    }

    /// From what was kept; none if there is no such fault.
    #[must_use]
    pub fn from_words(
        [fault, tick, display, check, sink, measured, asked]: [u32; Self::WORDS],
    ) -> Option<Self> {
        let celsius = |word: u32| {
            let t = Celsius::from_bits(word.cast_signed());
            (t != Celsius::MIN).then_some(t)
        };
        let current = |word: u32| Current::from_bits(word.cast_signed());
        Some(Self {
            fault: *Fault::ALL.get(fault as usize)?,
            tick,
            display: celsius(display),
            check: celsius(check),
            sink: celsius(sink),
            current: current(measured),
            asked: current(asked),
        })
    }
}
