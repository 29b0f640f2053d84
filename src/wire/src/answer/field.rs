//! How a value stands in an answer.

use core::marker::PhantomData;

use contact_model::contact_law::ContactLaw;
use thermal_device::StateName;
#[cfg(feature = "host")]
use thermal_settings::{DISPLAY_SURFACE_RANGES, FLUX_SENSOR_RANGES};
use thermal_settings::{DisplaySurface, FluxSensor};

use super::AnswerLine;
use crate::Kind;
#[cfg(feature = "host")]
use crate::host::{FieldForm, Fields, NamedValues};
use crate::kind::OrUnknown;
#[cfg(feature = "host")]
use crate::number::Quantity as _;
#[cfg(feature = "host")]
use crate::quantity::{Exponent, Gap, Microhardness};
use crate::telemetry::UNKNOWN_WORD;

/// A value of an answer: one word, or several.
pub trait Field {
    /// The value on the device.
    type Device;
    /// The value of a host.
    type Host;

    /// What stands there, for tables.
    #[cfg(feature = "host")]
    const FORM: FieldForm;

    /// Appends it, with the next name.
    fn write(line: &mut AnswerLine<'_, '_>, value: Self::Device);

    /// Reads it; `None` if it is missing or not of its kind.
    #[cfg(feature = "host")]
    fn read(fields: &Fields<'_>, name: &str) -> Option<Self::Host>;

    /// Appends it to the values of the whole answer.
    #[cfg(feature = "host")]
    fn add(values: &mut NamedValues, name: &'static str, value: &Self::Host);
}

/// A word `name=value`.
impl<K: Kind> Field for K {
    type Device = K::Device;
    type Host = K::Host;

    #[cfg(feature = "host")]
    const FORM: FieldForm = FieldForm::Named(K::FORM);

    fn write(line: &mut AnswerLine<'_, '_>, value: K::Device) {
        K::write(line.named(), value);
    }

    #[cfg(feature = "host")]
    fn read(fields: &Fields<'_>, name: &str) -> Option<K::Host> {
        K::read(fields.word(name)?)
    }

    #[cfg(feature = "host")]
    fn add(values: &mut NamedValues, name: &'static str, value: &K::Host) {
        values.push((name, K::value(value.clone())));
    }
}

/// A word `name=value` that may be missing: firmware from before it does not write it.
pub struct IfReported<K>(PhantomData<K>);

impl<K: Kind> Field for IfReported<K> {
    type Device = Option<K::Device>;
    type Host = Option<K::Host>;

    #[cfg(feature = "host")]
    const FORM: FieldForm = FieldForm::IfReported(K::FORM);

    fn write(line: &mut AnswerLine<'_, '_>, value: Option<K::Device>) {
        let name = line.next_name();
        if let Some(value) = value {
            K::write(line.name(name), value);
        }
    }

    #[cfg(feature = "host")]
    fn read(fields: &Fields<'_>, name: &str) -> Option<Option<K::Host>> {
        match fields.word(name) {
            None => Some(None),
            Some(word) => K::read(word).map(Some),
        }
    }

    #[cfg(feature = "host")]
    fn add(values: &mut NamedValues, name: &'static str, value: &Option<K::Host>) {
        let value = value.clone().map_or(crate::host::Value::Unknown, K::value);
        values.push((name, value));
    }
}

/// A truth value: the name stands alone on the line if it is true.
pub enum NameAlone {}

impl Field for NameAlone {
    type Device = bool;
    type Host = bool;

    #[cfg(feature = "host")]
    const FORM: FieldForm = FieldForm::NameAlone;

    fn write(line: &mut AnswerLine<'_, '_>, value: bool) {
        let name = line.next_name();
        if value {
            line.word(name);
        }
    }

    #[cfg(feature = "host")]
    fn read(fields: &Fields<'_>, name: &str) -> Option<bool> {
        Some(fields.words().any(|word| word == name))
    }

    #[cfg(feature = "host")]
    fn add(values: &mut NamedValues, name: &'static str, value: &bool) {
        values.push((name, crate::host::Value::Flag(*value)));
    }
}

/// A word without a name, by its place behind `ok`.
pub enum WordAt<const PLACE: usize> {}

impl<const PLACE: usize> Field for WordAt<PLACE> {
    type Device = &'static str;
    #[cfg(feature = "host")]
    type Host = std::string::String;
    #[cfg(not(feature = "host"))]
    type Host = ();

    #[cfg(feature = "host")]
    const FORM: FieldForm = FieldForm::WordAt(PLACE);

    fn write(line: &mut AnswerLine<'_, '_>, value: &'static str) {
        line.next_name();
        line.word(value);
    }

    #[cfg(feature = "host")]
    fn read(fields: &Fields<'_>, _name: &str) -> Option<Self::Host> {
        fields.words().nth(PLACE).map(Into::into)
    }

    #[cfg(feature = "host")]
    fn add(values: &mut NamedValues, name: &'static str, value: &Self::Host) {
        values.push((name, crate::host::Value::Text(value.clone())));
    }
}

/// A value that the device may not know, and that older firmware does not report.
pub struct UnknownIfNotReported<K>(PhantomData<K>);

impl<K: Kind> Field for UnknownIfNotReported<K> {
    type Device = Option<K::Device>;
    type Host = Option<K::Host>;

    #[cfg(feature = "host")]
    const FORM: FieldForm = FieldForm::IfReported(<OrUnknown<K> as Kind>::FORM);

    fn write(line: &mut AnswerLine<'_, '_>, value: Option<K::Device>) {
        <OrUnknown<K> as Kind>::write(line.named(), value);
    }

    #[cfg(feature = "host")]
    fn read(fields: &Fields<'_>, name: &str) -> Option<Option<K::Host>> {
        <OrUnknown<K> as Kind>::read(fields.word(name).unwrap_or(UNKNOWN_WORD))
    }

    #[cfg(feature = "host")]
    fn add(values: &mut NamedValues, name: &'static str, value: &Option<K::Host>) {
        values.push((name, OrUnknown::<K>::value(value.clone())));
    }
}

/// Words with commas between them behind `name=`; none from firmware that does not report them.
pub enum ListIfReported {}

impl Field for ListIfReported {
    type Device = &'static str;
    #[cfg(feature = "host")]
    type Host = std::vec::Vec<std::string::String>;
    #[cfg(not(feature = "host"))]
    type Host = ();

    #[cfg(feature = "host")]
    const FORM: FieldForm = FieldForm::ListIfReported;

    fn write(line: &mut AnswerLine<'_, '_>, value: &'static str) {
        line.named().push_str_if_fits(value);
    }

    #[cfg(feature = "host")]
    fn read(fields: &Fields<'_>, name: &str) -> Option<Self::Host> {
        let words = fields.word(name).unwrap_or_default().split(',');
        Some(words.filter(|word| !word.is_empty()).map(Into::into).collect())
    }

    #[cfg(feature = "host")]
    fn add(values: &mut NamedValues, name: &'static str, value: &Self::Host) {
        values.push((name, crate::host::Value::List(value.clone())));
    }
}

/// The words `state=… fault=…`, `-` for the fault of a state without one.
pub enum StateAndFault {}

impl Field for StateAndFault {
    type Device = StateName;
    type Host = StateName;

    #[cfg(feature = "host")]
    const FORM: FieldForm = FieldForm::StateAndFault;

    fn write(line: &mut AnswerLine<'_, '_>, value: StateName) {
        line.named().push_str_if_fits(value.name());
        let fault = value.fault().map_or(UNKNOWN_WORD, |fault| fault.name());
        line.name("fault").push_str_if_fits(fault);
    }

    #[cfg(feature = "host")]
    fn read(fields: &Fields<'_>, name: &str) -> Option<StateName> {
        crate::host::state(fields.word(name)?, fields.word("fault")?)
    }

    #[cfg(feature = "host")]
    fn add(values: &mut NamedValues, name: &'static str, value: &StateName) {
        values.push((name, crate::host::Value::Word(value.name())));
    }
}

/// Declares values that are several numbers, each behind a name of its own: names, decimals, ranges, the numbers, and the value made of
/// them.
macro_rules! groups {
    ($($(#[$doc:meta])+ $group:ident: $value:ty = $names:expr, $decimals:expr, $ranges:expr,
        |$from:ident| $numbers:expr, |$array:ident| $made:expr;)+) => {$(
        $(#[$doc])+
        pub enum $group {}

        impl Field for $group {
            type Device = $value;
            type Host = $value;

            #[cfg(feature = "host")]
            const FORM: FieldForm = FieldForm::Numbers(|| $names.into_iter().zip($ranges).collect());

            fn write(line: &mut AnswerLine<'_, '_>, $from: $value) {
                line.numbers(&$names, &$numbers, &$decimals);
            }

            #[cfg(feature = "host")]
            fn read(fields: &Fields<'_>, _name: &str) -> Option<$value> {
                fields.numbers($names).map(|$array| $made)
            }

            #[cfg(feature = "host")]
            fn add(values: &mut NamedValues, _name: &'static str, $from: &$value) {
                let numbers = $numbers.map(crate::host::Value::Number);
                values.extend($names.into_iter().zip(numbers));
            }
        }
    )+};
}

groups! {
    /// Properties of a heat-flux sensor.
    FluxSensorNumbers: FluxSensor = FluxSensor::NAMES, FluxSensor::DECIMALS, &FLUX_SENSOR_RANGES,
        |sensor| sensor.to_array(), |numbers| FluxSensor::from_array_rounded(numbers);
    /// Properties of the display's surface.
    DisplaySurfaceNumbers: DisplaySurface = DisplaySurface::NAMES, DisplaySurface::DECIMALS,
        &DISPLAY_SURFACE_RANGES,
        |surface| surface.to_array(), |numbers| DisplaySurface::from_array_rounded(numbers);
    /// Parameters of a contact law.
    ContactLawNumbers: ContactLaw = ["exponent", "hardness_pa", "gap_w_m2k"], [4, 0, 1],
        [Exponent::RANGE, Microhardness::RANGE, Gap::RANGE],
        |law| [law.exponent, law.hardness_pa, law.gap_w_m2k],
        |numbers| {
            let [exponent, hardness_pa, gap_w_m2k] = numbers;
            ContactLaw { exponent, hardness_pa, gap_w_m2k }
        };
}
