//! Kinds of values on the line: what the device writes, and what a host reads.

use contact_model::fixed_point::{Celsius, Force};
use thermal_device::Flux;
use thermal_device::drive::Current;
use thermal_device::learning::FingerKnowledge;

use crate::LineBuffer;
#[cfg(feature = "host")]
use crate::host::{Value, ValueForm};

/// How a value stands on a line from the device.
pub trait Kind {
    /// The value on the device.
    type Device: Copy;
    /// The value of a host.
    type Host: Copy;

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

/// Declares a kind: a number of the device, and how it is written.
macro_rules! numbers {
    ($($(#[$doc:meta])+ $kind:ident$(<const $digits:ident>)?: $device:ty =
        |$line:ident, $value:ident| $write:expr;)+) => {$(
        $(#[$doc])+
        #[derive(Clone, Copy, Debug)]
        pub struct $kind$(<const $digits: usize>)?;

        impl$(<const $digits: usize>)? Kind for $kind$(<$digits>)? {
            type Device = $device;
            type Host = f64;

            #[cfg(feature = "host")]
            const FORM: ValueForm = ValueForm::Number;

            #[inline]
            fn write($line: &mut LineBuffer, $value: $device) {
                $write;
            }

            #[cfg(feature = "host")]
            fn read(word: &str) -> Option<f64> {
                crate::host::finite(word)
            }

            #[cfg(feature = "host")]
            fn value(value: f64) -> Value {
                Value::Number(value)
            }
        }
    )+};
}

numbers! {
    /// Temperature, °C, with so many decimals.
    Temperature<const DIGITS>: Celsius = |line, value| line.push_celsius_or_dash(DIGITS, Some(value));
    /// Force, N.
    Newtons: Force = |line, value| line.push_force_or_dash(Some(value));
    /// Current, A.
    Amperes: Current = |line, value| line.push_current(value);
    /// Heat flux, W/m².
    WattsPerSquareMetre: Flux = |line, value| line.push_flux_or_dash(Some(value));
}

/// A count.
#[derive(Clone, Copy, Debug)]
pub struct Count;

impl Kind for Count {
    type Device = u32;
    type Host = u32;

    #[cfg(feature = "host")]
    const FORM: ValueForm = ValueForm::Count;

    #[inline]
    fn write(line: &mut LineBuffer, value: u32) {
        line.push_integer(value);
    }

    #[cfg(feature = "host")]
    fn read(word: &str) -> Option<u32> {
        word.parse().ok()
    }

    #[cfg(feature = "host")]
    fn value(value: u32) -> Value {
        Value::Count(value)
    }
}

/// What is known of a finger by its heat flux.
#[derive(Clone, Copy, Debug)]
pub struct Knowledge;

impl Kind for Knowledge {
    type Device = FingerKnowledge;
    type Host = FingerKnowledge;

    #[cfg(feature = "host")]
    const FORM: ValueForm =
        ValueForm::Word(|| FingerKnowledge::ALL.map(FingerKnowledge::name).to_vec());

    #[inline]
    fn write(line: &mut LineBuffer, value: FingerKnowledge) {
        line.push_str_if_fits(value.name());
    }

    #[cfg(feature = "host")]
    fn read(word: &str) -> Option<FingerKnowledge> {
        crate::host::knowledge(word)
    }

    #[cfg(feature = "host")]
    fn value(value: FingerKnowledge) -> Value {
        Value::Word(value.name())
    }
}
