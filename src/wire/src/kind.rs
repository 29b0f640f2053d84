//! Kinds of values on the line: what the device writes, and what a host reads.

use core::marker::PhantomData;

use contact_model::fixed_point::{Celsius, Force};
use thermal_device::Flux;
use thermal_device::drive::Current;
use thermal_device::learning::FingerKnowledge;
use thermal_device::safety::SelfTestResult;
use thermal_device::sense::SupplyVoltage;
use thermal_settings::{PersonCode, Vocabulary};

use crate::answer::PersonCodes;
#[cfg(feature = "host")]
use crate::host::{Value, ValueForm, finite};
use crate::telemetry::{TUNED_WORD, UNKNOWN_WORD, UNTUNED_WORD};
use crate::{LineBuffer, PersonData};
#[cfg(feature = "host")]
use std::string::{String, ToString};
#[cfg(feature = "host")]
use std::vec::Vec;
#[cfg(feature = "host")]
use thermal_device::safety::Fault;

/// How a value stands on a line from the device.
pub trait Kind {
    /// The value on the device.
    type Device;
    /// The value of a host.
    type Host: Clone;

    /// What the word says to a host.
    #[cfg(feature = "host")]
    const FORM: ValueForm;

    /// Appends the word.
    fn write(line: &mut LineBuffer, value: Self::Device);

    /// Reads the word; `None` if it is not of this kind.
    #[cfg(feature = "host")]
    fn read(word: &str) -> Option<Self::Host>;

    /// The value, for tables.
    #[cfg(feature = "host")]
    fn value(value: Self::Host) -> Value;
}

/// Declares kinds: the value on the device and on a host, what the word says, and how it is written, read and put into tables.
macro_rules! kinds {
    ($($(#[$doc:meta])+
        $kind:ident$(<const $digits:ident>)?: $device:ty => $host:ty, $form:expr,
        |$line:ident, $value:ident| $write:expr, |$word:ident| $read:expr, $table:expr;)+) => {$(
        $(#[$doc])+
        #[derive(Clone, Copy, Debug)]
        pub struct $kind$(<const $digits: usize>)?;

        impl$(<const $digits: usize>)? Kind for $kind$(<$digits>)? {
            type Device = $device;
            #[cfg(feature = "host")]
            type Host = $host;
            #[cfg(not(feature = "host"))]
            type Host = ();

            #[cfg(feature = "host")]
            const FORM: ValueForm = $form;

            #[inline]
            fn write($line: &mut LineBuffer, $value: $device) {
                $write;
            }

            #[cfg(feature = "host")]
            fn read($word: &str) -> Option<$host> {
                $read
            }

            #[cfg(feature = "host")]
            fn value(value: $host) -> Value {
                $table(value)
            }
        }
    )+};
}

kinds! {
    /// Temperature, °C, with so many decimals.
    Temperature<const DIGITS>: Celsius => f64, ValueForm::Number,
        |line, value| line.push_celsius_or_dash(DIGITS, Some(value)), |word| finite(word), Value::Number;
    /// Force, N.
    Newtons: Force => f64, ValueForm::Number,
        |line, value| line.push_force_or_dash(Some(value)), |word| finite(word), Value::Number;
    /// Current, A, with so many decimals.
    Amperes<const DIGITS>: Current => f64, ValueForm::Number,
        |line, value| line.push_current(DIGITS, value), |word| finite(word), Value::Number;
    /// Voltage of the bridge's supply, V.
    Volts: SupplyVoltage => f64, ValueForm::Number,
        |line, value| line.push_supply(value), |word| finite(word), Value::Number;
    /// Heat flux, W/m².
    WattsPerSquareMetre: Flux => f64, ValueForm::Number,
        |line, value| line.push_flux_or_dash(Some(value)), |word| finite(word), Value::Number;
    /// Mean of 16 conversions, counts, of their sum.
    MeanOf16: u16 => f64, ValueForm::Number,
        |line, value| line.push_mean_of_16(value), |word| finite(word), Value::Number;
    /// Number with so many decimals.
    Decimal<const DIGITS>: f64 => f64, ValueForm::Number,
        |line, value| line.push_decimal(value, DIGITS), |word| finite(word), Value::Number;
    /// A count.
    Count: u32 => u32, ValueForm::Count,
        |line, value| line.push_integer(value), |word| word.parse().ok(), Value::Count;
    /// A count of at most 255.
    SmallCount: u8 => u8, ValueForm::Count,
        |line, value| line.push_integer(value.into()), |word| word.parse().ok(), |count| Value::Count(u32::from(count));
    /// Number of fingers of a device.
    FingerCount: u8 => u8, ValueForm::CountWithin(1, FINGERS_MAX as u32),
        |line, value| line.push_integer(value.into()),
        |word| word.parse().ok().filter(|count| (1..=FINGERS_MAX).contains(count)),
        |count| Value::Count(u32::from(count));
    /// `1` or `0`.
    Bit: bool => bool, ValueForm::Bit,
        |line, value| line.push_str_if_fits(if value { "1" } else { "0" }),
        |word| match word { "1" => Some(true), "0" => Some(false), _ => None }, Value::Flag;
    /// Whether the tile was identified or set.
    Tuned: bool => bool, ValueForm::Whether(TUNED_WORD, UNTUNED_WORD),
        |line, value| line.push_str_if_fits(if value { TUNED_WORD } else { UNTUNED_WORD }),
        |word| match word { TUNED_WORD => Some(true), UNTUNED_WORD => Some(false), _ => None }, Value::Flag;
    /// What is known of a finger by its heat flux.
    Knowledge: FingerKnowledge => FingerKnowledge, ValueForm::Word(|| FingerKnowledge::ALL.map(FingerKnowledge::name).to_vec()),
        |line, value| line.push_str_if_fits(value.name()),
        |word| FingerKnowledge::ALL.into_iter().find(|known| known.name() == word),
        |known: FingerKnowledge| Value::Word(known.name());
    /// Result of a self-test: one of these words, or a fault's.
    TestResult: SelfTestResult => SelfTestResult, ValueForm::Text,
        |line, value| line.push_str_if_fits(value.name()), |word| self_test_result(word),
        |result: SelfTestResult| Value::Word(result.name());
    /// A word of which a host knows no list.
    Text: &'static str => String, ValueForm::Text,
        |line, value| line.push_str_if_fits(value), |word| Some(word.into()), Value::Text;
    /// Temperature of an object before contact, °C; `room` for that of the room.
    ObjectTemperature: Option<Celsius> => Option<f64>, ValueForm::NumberOr(ROOM_WORD),
        |line, value| match value {
            Some(_) => line.push_celsius_or_dash(2, value),
            None => line.push_str_if_fits(ROOM_WORD),
        },
        |word| if word == ROOM_WORD { Some(None) } else { finite(word).map(Some) },
        |celsius: Option<f64>| celsius.map_or(Value::Unknown, Value::Number);
    /// Three words, as hexadecimal digits.
    UniqueId: [u32; 3] => String, ValueForm::Text,
        |line, value| for word in value {
            for byte in word.to_be_bytes() {
                line.push_hexadecimal(byte, b'A');
            }
        },
        |word| Some(word.into()), Value::Text;
    /// A word, as eight hexadecimal digits.
    Digest: u32 => String, ValueForm::Text,
        |line, value| for byte in value.to_be_bytes() {
            line.push_hexadecimal(byte, b'a');
        }, |word| Some(word.into()), Value::Text;
    /// A person's code; `none` for an unknown person.
    Person: Option<PersonCode> => Option<PersonCode>, ValueForm::TextOr(NOBODY_WORD),
        |line, value| match value {
            Some(code) => line.push_person_code(code),
            None => line.push_str_if_fits(NOBODY_WORD),
        },
        |word| if word == NOBODY_WORD { Some(None) } else { PersonCode::new(word).map(Some) },
        |code: Option<PersonCode>| code.map_or(Value::Unknown, |code| Value::Text(code.to_string()));
    /// What was learnt of a finger, as hexadecimal digits.
    LearntFinger: PersonData => PersonData, ValueForm::Text,
        |line, value| for byte in value.0 {
            line.push_hexadecimal(byte, b'A');
        },
        |word| thermal_settings::Person::read_finger(word).map(PersonData),
        |data: PersonData| Value::Text(data.to_string());
    /// Codes of persons with commas between them; `none` without any.
    Codes: PersonCodes => Vec<PersonCode>, ValueForm::ListOr(NOBODY_WORD),
        |line, value| value.write(line),
        |word| match word {
            NOBODY_WORD => Some(Vec::new()),
            codes => codes.split(',').map(PersonCode::new).collect(),
        },
        |codes: Vec<PersonCode>| Value::List(codes.iter().map(ToString::to_string).collect());
}

/// Stands for the temperature of the room.
const ROOM_WORD: &str = "room";
/// Stands for an unknown person, and for no persons.
pub const NOBODY_WORD: &str = "none";
/// Largest number of fingers that a device can have. An answer may be damaged before checksums are on, and a host loops over the
/// number in it.
#[cfg(feature = "host")]
const FINGERS_MAX: u8 = 5;

#[cfg(feature = "host")]
fn self_test_result(word: &str) -> Option<SelfTestResult> {
    let known = [SelfTestResult::None, SelfTestResult::Running, SelfTestResult::Passed];
    let known = known.into_iter().find(|known| known.name() == word);
    known.or_else(|| Fault::of_word(word).map(SelfTestResult::Failed))
}

/// One of the words of a vocabulary.
#[derive(Clone, Copy, Debug)]
pub struct Word<V>(PhantomData<V>);

impl<V: Vocabulary> Kind for Word<V> {
    type Device = V;
    type Host = V;

    #[cfg(feature = "host")]
    const FORM: ValueForm = ValueForm::Word(|| V::WORDS.words.to_vec());

    fn write(line: &mut LineBuffer, value: V) {
        line.push_str_if_fits(value.word());
    }

    #[cfg(feature = "host")]
    fn read(word: &str) -> Option<V> {
        V::of_word(word)
    }

    #[cfg(feature = "host")]
    fn value(value: V) -> Value {
        Value::Word(value.word())
    }
}

/// A value that the device may not know: `-`.
#[derive(Clone, Copy, Debug)]
pub struct OrUnknown<K>(PhantomData<K>);

impl<K: Kind> Kind for OrUnknown<K> {
    type Device = Option<K::Device>;
    type Host = Option<K::Host>;

    #[cfg(feature = "host")]
    const FORM: ValueForm = ValueForm::OrUnknown(&K::FORM);

    fn write(line: &mut LineBuffer, value: Option<K::Device>) {
        match value {
            Some(value) => K::write(line, value),
            None => line.push_str_if_fits(UNKNOWN_WORD),
        }
    }

    #[cfg(feature = "host")]
    fn read(word: &str) -> Option<Option<K::Host>> {
        if word == UNKNOWN_WORD { Some(None) } else { K::read(word).map(Some) }
    }

    #[cfg(feature = "host")]
    fn value(value: Option<K::Host>) -> Value {
        value.map_or(Value::Unknown, K::value)
    }
}
