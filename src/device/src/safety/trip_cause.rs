//! Why a station tripped: the fault, its time, and the readings of that tick.

use contact_model::fixed_point::Celsius;

use super::Fault;
use crate::drive::Current;
use crate::sense::Readings;

/// What is known of the tick in which a station tripped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TripCause {
    /// The fault that tripped the station.
    pub fault: Fault,
    /// Ticks since the reset before it; 0 if no tick has seen the fault.
    pub tick: u32,
    /// Reading of the display, °C; `None` if it was invalid.
    pub display: Option<Celsius>,
    /// Reading of the second display thermistor, °C; `None` if it was invalid.
    pub check: Option<Celsius>,
    /// Reading of the sink, °C; `None` if it was invalid.
    pub sink: Option<Celsius>,
    /// Magnitude of the measured current, A.
    pub current: Current,
    /// Current demanded in the tick before, A.
    pub demanded: Current,
}

impl TripCause {
    /// Number of words of [`Self::to_words`].
    pub const WORDS: usize = 7;

    /// Identifies the meaning of the words: their number, their order, and the numbers of the faults. A record that was kept by
    /// another firmware is recognised by it.
    pub const LAYOUT: u32 = layout(
        "fault tick display check sink current asked",
        Self::WORDS,
        Fault::ALL,
    );

    /// The cause in a tick.
    #[must_use]
    pub fn new(fault: Fault, tick: u32, readings: &Readings, demanded: Current) -> Self {
        Self {
            fault,
            tick,
            display: readings.display.ok(),
            check: readings.display_check.ok(),
            sink: readings.sink.ok(),
            current: readings.current,
            demanded,
        }
    }

    /// The cause for a fault that no tick has seen.
    #[must_use]
    pub const fn alone(fault: Fault) -> Self {
        Self {
            fault,
            tick: 0,
            display: None,
            check: None,
            sink: None,
            current: Current::ZERO,
            demanded: Current::ZERO,
        }
    }

    /// Words to be kept through a reset. A change here must change [`Self::LAYOUT`].
    #[must_use]
    pub fn to_words(&self) -> [u32; Self::WORDS] {
        // Stands for an invalid reading: no thermistor reads the lowest representable temperature.
        let word = |t: Option<Celsius>| t.unwrap_or(Celsius::MIN).to_bits().cast_unsigned();
        [
            self.fault as u32,
            self.tick,
            word(self.display),
            word(self.check),
            word(self.sink),
            self.current.to_bits().cast_unsigned(),
            self.demanded.to_bits().cast_unsigned(),
        ]
    }

    /// The cause from words that were kept; `None` if there is no such fault.
    #[must_use]
    pub fn from_words(
        [fault, tick, display, check, sink, measured, demanded]: [u32; Self::WORDS],
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
            demanded: current(demanded),
        })
    }
}

/// FNV-1a hash over what a record consists of.
const fn layout(order: &str, words: usize, faults: &[Fault]) -> u32 {
    let mut sum = hash_word(0x811c_9dc5 ^ words as u32, order);
    let mut number = 0;
    while number < faults.len() {
        sum = hash_word(sum, faults[number].name());
        number += 1;
    }
    sum
}

/// Continues the hash with a word and its end.
const fn hash_word(mut sum: u32, word: &str) -> u32 {
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
    fn other_faults_or_other_words_have_another_layout() {
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
            hash_word(0x811c_9dc5, "a"),
            (0xe40c_292c_u32 ^ 0xff).wrapping_mul(0x0100_0193)
        );
    }
}
