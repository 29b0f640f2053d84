//! Measurements of the thesis beside what the simulated plant gives under the same conditions.

mod course;
mod quantity;

use std::sync::LazyLock;

use serde::Deserialize;
use thermal_plant::contact::ContactLaw;
use thermal_plant::finger::FingerParams;

use super::stated_value::Stated;
use super::statement::read;
use course::Courses;

/// Conductance of air in the gap of the plants that have one, W/(m² K): of 130 µm; a ridge's depth of 60 µm has 400.
const GAP_W_M2K: f64 = 200.0;

/// Finger and law of the contact of one plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// Whether its finger has layers with blood that the force stops; else it is the thesis's half-space.
    pub layered: bool,
    /// Whether air in the gap conducts in parallel to Eq. 6-8.
    pub gap: bool,
}

/// The plants that a measurement is compared with. The first is that of the thesis.
pub const VARIANTS: [Variant; 4] = [
    Variant { layered: false, gap: false },
    Variant { layered: true, gap: false },
    Variant { layered: false, gap: true },
    Variant { layered: true, gap: true },
];

impl Variant {
    /// Name of the finger.
    pub const fn finger(self) -> &'static str {
        if self.layered { "layered" } else { "thesis" }
    }

    /// Name of the law of the contact.
    pub const fn contact(self) -> &'static str {
        if self.gap { "Eq. 6-8 and a gap of 200 W/(m² K)" } else { "Eq. 6-8" }
    }

    fn finger_params(self) -> FingerParams {
        if self.layered { FingerParams::layered() } else { FingerParams::homogeneous() }
    }

    fn law(self) -> ContactLaw {
        ContactLaw { gap_w_m2k: if self.gap { GAP_W_M2K } else { 0.0 }, ..ContactLaw::NOMINAL }
    }
}

/// A line of `data/measured.csv`.
#[derive(Deserialize)]
struct Line {
    /// Section or figure of the thesis.
    place: String,
    /// Material, or empty.
    of: String,
    /// Name of the quantity, in which `{}` is replaced by `given`.
    quantity: String,
    given: String,
    unit: String,
    measured: Stated,
    /// Why the plant cannot show it.
    why: String,
}

impl Line {
    fn given(&self) -> f64 {
        let given = self.given.parse();
        given.unwrap_or_else(|_| panic!("measured.csv, {}: given is no number", self.quantity))
    }
}

static LINES: LazyLock<Vec<Line>> = LazyLock::new(|| {
    read("measured.csv", include_str!("../../data/measured.csv")).expect("a table of the program")
});

/// A measurement and what the plants give.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Section or figure of the thesis.
    pub place: &'static str,
    /// Quantity and its object.
    pub quantity: String,
    /// Unit, empty for a dimensionless number.
    pub unit: &'static str,
    /// What was measured.
    pub measured: Stated,
    /// What each of [`VARIANTS`] gives; none if the plant has no such quantity.
    pub plant: Option<[f64; VARIANTS.len()]>,
    why: &'static str,
}

/// Whether the plant can show a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// A finger of the plant shows it with the thesis's law of the contact.
    Yes,
    /// A finger of the plant shows it with air in the gap only.
    WithGap,
    /// No variant shows it.
    No,
    /// The plant has no such quantity.
    NotModelled,
}

impl Shown {
    /// The word of JSON and CSS.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Yes => "shows",
            Self::WithGap => "shows-with-gap",
            Self::No => "cannot",
            Self::NotModelled => "not-modelled",
        }
    }

    /// The words of the report.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Yes => "can show",
            Self::WithGap => "can show with a gap",
            Self::No => "cannot show",
            Self::NotModelled => "not in the plant",
        }
    }
}

impl Measurement {
    /// Whether a variant of the plant agrees with the measurement.
    pub fn shown(&self) -> Shown {
        let Some(plant) = self.plant else {
            return Shown::NotModelled;
        };
        let with = |gap| {
            let mut values = VARIANTS.iter().zip(plant);
            values.any(|(variant, value)| variant.gap == gap && self.measured.agrees(value))
        };
        match (with(false), with(true)) {
            (true, _) => Shown::Yes,
            (false, true) => Shown::WithGap,
            (false, false) => Shown::No,
        }
    }

    /// Why Eq. 6-8 does not show it; empty where it does.
    pub fn why(&self) -> &'static str {
        if self.shown() == Shown::Yes { "" } else { self.why }
    }

    /// The values of the plants; empty if there are none.
    pub(super) fn plant_texts(&self) -> [String; VARIANTS.len()] {
        let text = |value| format!("{value:.*}", self.measured.decimals_for_computed());
        self.plant.map_or_else(Default::default, |plant| plant.map(text))
    }
}

/// Every measurement, compared. The plants run in simulated time, so this takes seconds.
///
/// # Errors
/// A plant refuses its configuration.
pub fn measurements() -> anyhow::Result<Vec<Measurement>> {
    let mut courses = VARIANTS.map(Courses::new);
    let mut all = Vec::with_capacity(LINES.len());
    for line in LINES.iter() {
        let mut values = Vec::with_capacity(VARIANTS.len());
        for courses in &mut courses {
            values.extend(quantity::of_plant(line, courses)?);
        }
        let quantity = line.quantity.replace("{}", &line.given);
        all.push(Measurement {
            place: &line.place,
            quantity: match line.of.as_str() {
                "" => quantity,
                of => format!("{of}, {quantity}"),
            },
            unit: &line.unit,
            measured: line.measured.clone(),
            plant: values.try_into().ok(),
            why: &line.why,
        });
    }
    Ok(all)
}
