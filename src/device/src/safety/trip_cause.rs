//! Why a station tripped: the fault, its time, and the readings of that tick.

use contact_model::fixed_point::Celsius;

use super::Fault;
use crate::drive::Current;
use crate::sense::Readings;

/// Why and when a station tripped: the fault, the tick's number, and the temperatures and currents of that tick. A trip
/// cause is kept in RAM through a reset, and the host's command `cause` returns it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TripCause {
    /// The fault that tripped the station.
    pub fault: Fault,
    /// Number of the tick of the trip, in ticks of 1 ms since the start of the program run in which the station
    /// tripped; 0 if the trip came before the first tick, or was recorded by the start-up code or an exception handler.
    pub tick: u32,
    /// Reading of the display's first thermistor in the tick that detected the fault, °C; `None` if the reading was
    /// invalid or the fault was detected outside of a tick.
    pub display: Option<Celsius>,
    /// Reading of the display's second thermistor in the tick that detected the fault, °C; `None` if the reading was
    /// invalid or the fault was detected outside of a tick.
    pub check: Option<Celsius>,
    /// Reading of the heat sink's thermistor in the tick that detected the fault, °C; `None` if the reading was invalid
    /// or the fault was detected outside of a tick.
    pub sink: Option<Celsius>,
    /// Magnitude of the measured module current in the tick that detected the fault, A; zero if the fault was detected
    /// outside of a tick.
    pub current: Current,
    /// Current that the tick before the detection demanded of the bridge, A; positive cools. Zero if the fault was
    /// detected outside of a tick.
    pub demanded: Current,
}

impl TripCause {
    /// Number of 32-bit words in which a trip cause is kept in RAM through a reset.
    pub const WORD_COUNT: usize = 7;

    /// Hash of the meaning of the stored words: their number, their order, and the numbers and names of the faults. The
    /// board includes it in the checksum of a stored trip cause, so that one stored by firmware with another layout
    /// counts as invalid.
    pub const LAYOUT_HASH: u32 =
        layout_hash("fault tick display check sink current asked", Self::WORD_COUNT, Fault::ALL);

    /// The cause of a trip by `fault`, which tick number `tick` has detected with `readings`. `demanded` is the current
    /// that the tick before demanded of the bridge, A; positive cools.
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

    /// The cause of a trip by a fault that was detected outside of a tick, such as a watchdog reset: the tick number
    /// and the currents are zero, all temperatures are `None`.
    pub const fn without_readings(fault: Fault) -> Self {
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

    /// Converts the trip cause to the words in which the board keeps it in RAM through a reset. Whoever changes the
    /// words here must also change the list of their names in [`Self::LAYOUT_HASH`].
    pub fn to_retained_words(&self) -> [u32; Self::WORD_COUNT] {
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

    /// The trip cause that [`to_retained_words`](Self::to_retained_words) converted before a reset; `None` if the first word is not the
    /// number of a fault.
    pub fn from_retained_words(
        [fault, tick, display, check, sink, measured, demanded]: [u32; Self::WORD_COUNT],
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

/// FNV-1a hash over what a stored trip cause consists of: the number of its words (`words`), their names in `order`,
/// and the names of all faults in the order of their numbers.
const fn layout_hash(order: &str, words: usize, faults: &[Fault]) -> u32 {
    let mut sum = continue_hash(0x811c_9dc5 ^ words as u32, order);
    let mut number = 0;
    while number < faults.len() {
        sum = continue_hash(sum, faults[number].name());
        number += 1;
    }
    sum
}

/// Continues the FNV-1a hash `sum` with the bytes of `word` and then with 0xff as separator, so that the words "a", "b"
/// hash differently from the word "ab".
const fn continue_hash(mut sum: u32, word: &str) -> u32 {
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
        let of = |faults: &[Fault]| layout_hash(order, 2, faults);
        let (stack, panic) = (Fault::Stack, Fault::Panic);
        let all = [
            of(&[stack, panic]),
            of(&[panic, stack]),
            of(&[stack]),
            of(&[stack, panic, Fault::Clock]),
            layout_hash("tick fault", 2, &[stack, panic]),
            layout_hash(order, 3, &[stack, panic]),
        ];
        for (i, one) in all.iter().enumerate() {
            assert!(!all[..i].contains(one), "{i}");
        }
        // FNV-1a of "a", as its authors give it; a word's end is one more byte.
        assert_eq!(
            continue_hash(0x811c_9dc5, "a"),
            (0xe40c_292c_u32 ^ 0xff).wrapping_mul(0x0100_0193)
        );
    }
}
