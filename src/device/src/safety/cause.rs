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

    /// Another one where the words mean something else: their number, which of them they are, or the faults by their numbers.
    pub const LAYOUT: u32 = layout(
        "fault tick display check sink current asked",
        Self::WORDS,
        Fault::ALL,
    );

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

    /// To be kept; what changes here changes [`Self::LAYOUT`].
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

/// A sum over what a record is made of (FNV-1a).
const fn layout(order: &str, words: usize, faults: &[Fault]) -> u32 {
    let mut sum = spelt(0x811c_9dc5 ^ words as u32, order);
    let mut number = 0;
    while number < faults.len() {
        sum = spelt(sum, faults[number].name());
        number += 1;
    }
    sum
}

/// Goes on with a word and its end.
const fn spelt(mut sum: u32, word: &str) -> u32 {
    let bytes = word.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        sum = (sum ^ bytes[at] as u32).wrapping_mul(0x0100_0193);
        at += 1;
    }
    (sum ^ 0xff).wrapping_mul(0x0100_0193)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_of_other_faults_or_other_words_has_another_layout() {
        let order = "fault tick";
        let of = |faults: &[Fault]| layout(order, 2, faults);
        let (stack, panic) = (Fault::Stack, Fault::Panic);
        let all = [
            of(&[stack, panic]),
            of(&[panic, stack]),
            of(&[stack]),
            of(&[stack, panic, Fault::Clock]),
            layout("tick fault", 2, &[stack, panic]),
            layout(order, 3, &[stack, panic]),
        ];
        for (i, one) in all.iter().enumerate() {
            assert!(!all[..i].contains(one), "{i}");
        }
        // FNV-1a of "a", as its authors give it; a word's end is one more byte.
        assert_eq!(
            spelt(0x811c_9dc5, "a"),
            (0xe40c_292c_u32 ^ 0xff).wrapping_mul(0x0100_0193)
        );
    }
}
