//! The columns of recorded telemetry, from which every table that is written of it takes its own.

use thermal_device::TelemetryFields;
use thermal_device::learning::FingerKnowledge;

use super::telemetry::Telemetry;

/// A column of recorded telemetry: a field of a line.
#[derive(Clone, Copy, Debug)]
pub struct TelemetryColumn {
    /// Quantity that the column holds, without a unit, as `display`.
    pub quantity: &'static str,
    /// Name of the column in tables: the quantity with its unit, as `display_c`.
    pub name: &'static str,
    /// Unit as BIDS writes it; empty for a count or a word.
    pub unit: &'static str,
    /// What it is.
    pub description: &'static str,
    value: Value,
}

/// How a column is read from a line; `None` is what the device does not know, or was not asked for.
#[derive(Clone, Copy, Debug)]
enum Value {
    Number(fn(&Telemetry) -> Option<f64>),
    Count(fn(&Telemetry) -> Option<u32>),
    Knowledge(fn(&Telemetry) -> Option<FingerKnowledge>),
}

use Value::{Count, Knowledge, Number};

impl TelemetryColumn {
    /// A column for each field, in the order of [`TelemetryFields::NAMES`].
    pub const ALL: &'static [Self; TelemetryFields::NAMES.len()] = &[
        Self::new(
            "setpoint",
            "setpoint_c",
            "degC",
            "Set-point of the display's surface",
            Number(|t| t.setpoint_c),
        ),
        Self::new(
            "display",
            "display_c",
            "degC",
            "Thermistor of the display",
            Number(|t| t.display_c),
        ),
        Self::new("sink", "sink_c", "degC", "Thermistor of the heat sink", Number(|t| t.sink_c)),
        Self::new(
            "skin",
            "skin_c",
            "degC",
            "Thermistor on the skin at the edge of the contact",
            Number(|t| t.skin_c),
        ),
        Self::new("room", "room_c", "degC", "Thermistor of the room", Number(|t| t.room_c)),
        Self::new("force", "force_n", "N", "Force of the finger", Number(|t| t.force_n)),
        Self::new(
            "demand",
            "demand_a",
            "A",
            "Demanded current of the Peltier module; positive cools",
            Number(|t| t.demand_a),
        ),
        Self::new(
            "current",
            "current_a",
            "A",
            "Magnitude of the measured current",
            Number(|t| t.current_a),
        ),
        Self::new(
            "evaluations",
            "evaluations",
            "",
            "Evaluations of erfcx since the device's reset",
            Count(|t| t.evaluations),
        ),
        Self::new(
            "flux",
            "flux_w_m2",
            "W/m^2",
            "Heat flux out of the skin by the heat-flux sensor",
            Number(|t| t.flux_w_m2),
        ),
        Self::new(
            "surface",
            "surface_c",
            "degC",
            "Estimate of the display's surface under the finger",
            Number(|t| t.surface_c),
        ),
        Self::new(
            "known",
            "known",
            "",
            "What is known of the finger by its flux",
            Knowledge(|t| t.finger),
        ),
    ];
    /// Number of the columns that every device reports; the others are those of the heat-flux sensor.
    const DEFAULT: usize = Self::ALL.len() - TelemetryFields::NAMED_ONLY;

    const fn new(
        quantity: &'static str,
        name: &'static str,
        unit: &'static str,
        description: &'static str,
        value: Value,
    ) -> Self {
        Self { quantity, name, unit, description, value }
    }

    /// The columns that every device reports.
    pub fn default_ones() -> &'static [Self] {
        &Self::ALL[..Self::DEFAULT]
    }

    /// The columns of the heat-flux sensor; none without one. They stand at the end of a table.
    pub fn of_flux(has_sensor: bool) -> &'static [Self] {
        if has_sensor { &Self::ALL[Self::DEFAULT..] } else { &[] }
    }

    /// The value in a line as text: a number, a count or a word.
    pub fn text(&self, line: &Telemetry) -> Option<String> {
        match self.value {
            Number(value) => value(line).map(|number| number.to_string()),
            Count(value) => value(line).map(|count| count.to_string()),
            Knowledge(value) => value(line).map(|knowledge| knowledge.name().into()),
        }
    }

    /// The value in a line as a number; a word is its index in [`words`](Self::words).
    pub fn number(&self, line: &Telemetry) -> Option<f64> {
        match self.value {
            Number(value) => value(line),
            Count(value) => value(line).map(f64::from),
            Knowledge(value) => {
                let known = value(line)?;
                FingerKnowledge::ALL
                    .iter()
                    .position(|other| *other == known)
                    .map(|index| index as f64)
            }
        }
    }

    /// The words of a column with words; none for one with numbers.
    pub fn words(&self) -> Vec<&'static str> {
        match self.value {
            Number(_) | Count(_) => Vec::new(),
            Knowledge(_) => FingerKnowledge::ALL.map(FingerKnowledge::name).to_vec(),
        }
    }
}
