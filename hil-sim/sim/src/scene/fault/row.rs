//! What the table of fault kinds states of each.

use super::{ActiveDefects, ActiveFault};

/// Declares [`FaultKind`](super::FaultKind) from rows of `Variant = "name", row, "effect";`.
macro_rules! fault_kinds {
    ($($variant:ident = $name:literal, $row:expr, $effect:literal;)*) => {
        named_enum! {
            /// Kind of a fault of plant, converter or host.
            #[derive(Clone, Copy, Debug, PartialEq, Eq)]
            pub enum FaultKind {
                $(#[doc = $effect] $variant = $name,)*
            }
        }

        static ROWS: [Row; FaultKind::ALL.len()] = [$($row.says($effect)),*];

        impl FaultKind {
            pub(super) const fn row(self) -> &'static Row {
                &ROWS[self as usize]
            }
        }
    };
}

/// Unit, range and default of a kind's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// Unit; 1 for a pure number.
    pub unit: &'static str,
    /// Smallest allowed value.
    pub min: f64,
    /// Largest allowed value.
    pub max: f64,
    /// Default; without one, the scene must give a value.
    pub default: Option<f64>,
}

/// What a fault acts on, which determines the keys that a scene may give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// One thermistor, which the scene may name.
    Thermistor,
    /// Two thermistors, of which the scene must name the second.
    TwoThermistors,
    /// The heat-flux sensor, which the scene must have.
    FluxSensor,
    /// The rest of the plant, and the converter.
    Plant,
    /// The simulated host.
    Host,
    /// The trigger input.
    Trigger,
}

/// Adds a fault to the present defects.
type Effect = fn(&mut ActiveDefects, &ActiveFault);

/// A kind of fault.
#[derive(Debug)]
pub(super) struct Row {
    pub(super) part: Part,
    pub(super) effect: Effect,
    pub(super) value: Option<ValueRange>,
    /// Whether the fingers of a device for five share what fails.
    pub(super) shared: bool,
    /// Whether it happens once and has no duration.
    pub(super) once: bool,
    /// The effect in words, for `docs/scenes.md`.
    pub(super) text: &'static str,
}

/// A fault of one thermistor.
pub(super) const fn thermistor(effect: Effect) -> Row {
    Row::new(Part::Thermistor, effect)
}

/// A fault of two thermistors.
pub(super) const fn two_thermistors(effect: Effect) -> Row {
    Row::new(Part::TwoThermistors, effect)
}

/// A fault of the heat-flux sensor.
pub(super) const fn flux_sensor(effect: Effect) -> Row {
    Row::new(Part::FluxSensor, effect)
}

/// A fault of another part of one finger's plant.
pub(super) const fn plant(effect: Effect) -> Row {
    Row::new(Part::Plant, effect)
}

/// A fault of the host; [`host`](crate::host) has its effect.
pub(super) const fn host() -> Row {
    Row::new(Part::Host, |_, _| ()).shared()
}

/// A fault of the trigger input; [`trigger_edges`](crate::trigger_edges) has its effect.
pub(super) const fn trigger() -> Row {
    Row::new(Part::Trigger, |_, _| ()).shared()
}

impl Row {
    const fn new(part: Part, effect: Effect) -> Self {
        Self { part, effect, value: None, shared: false, once: false, text: "" }
    }

    /// With a value in a unit, which the scene must give.
    pub(super) const fn value(mut self, unit: &'static str, min: f64, max: f64) -> Self {
        self.value = Some(ValueRange { unit, min, max, default: None });
        self
    }

    /// With a factor from 1 to 1000 as its value.
    pub(super) const fn factor(mut self, default: f64) -> Self {
        self.value = Some(ValueRange { unit: "1", min: 1.0, max: 1000.0, default: Some(default) });
        self
    }

    /// Of what all fingers share.
    pub(super) const fn shared(mut self) -> Self {
        self.shared = true;
        self
    }

    /// Without a duration.
    pub(super) const fn once(mut self) -> Self {
        self.once = true;
        self
    }

    pub(super) const fn says(mut self, text: &'static str) -> Self {
        self.text = text;
        self
    }
}
