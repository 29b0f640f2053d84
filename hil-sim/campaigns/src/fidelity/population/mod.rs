//! Populations: many objects, fingers or contact laws, each run as the device is now told of it, and as version 0.1 was.

mod bound;
mod case;
mod chart;
mod measured_contact;
mod object;
mod statistics;

use contact_model::contact_law::ContactLaw;
use contact_model::material::{REFERENCE_DISPLAY, SKIN, Surface};
use thermal_client::client::StationRequest;
use thermal_plant::Params;
use thermal_plant::parameters::{self, stream_seed};
use thermal_plant::sensors::FluxParams;
use thermal_sim::named_enum;

use super::plant_draws::SAME_VALUE;

pub use bound::{BoundResult, BoundRow, Compared, Priors, rows as bound_rows};
pub use case::{PopulationCase, Way};
pub use chart::{SVG, draw as chart};
use measured_contact::measured_contact;
pub use object::{BodyObject, every_object, layer_keys, six_objects};
pub use statistics::{ImageSample, PopulationReport, PopulationResult, WayStatistics, table};

named_enum! {
    /// A population.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
    pub enum Population {
        /// Slabs, half-spaces and layered objects under the thesis's finger, on the nominal plant.
        #[serde(rename = "E")]
        Objects = "E",
        /// Layered fingers of the parameter box, on drawn devices.
        #[serde(rename = "F-box")]
        FingerBox = "F-box",
        /// Fingers that differ as people do, on the same devices.
        #[serde(rename = "F-draw")]
        DrawnFingers = "F-draw",
        /// The same fingers and devices, with a sensor of the heat flux from which the device learns the finger in this contact.
        #[serde(rename = "G-designed")]
        DesignedSensor = "G-designed",
        /// The same with a better sensor, which nobody has designed.
        #[serde(rename = "G-hypothetical")]
        HypotheticalSensor = "G-hypothetical",
        /// The same with surfaces of display and skin that are rough and conduct as the device assumes.
        #[serde(rename = "G-known-surfaces")]
        KnownSurfaces = "G-known-surfaces",
        /// As `G-designed`, with the finger enrolled on the device on another day.
        #[serde(rename = "H-designed")]
        EnrolledDesigned = "H-designed",
        /// As `G-hypothetical`, likewise.
        #[serde(rename = "H-hypothetical")]
        EnrolledHypothetical = "H-hypothetical",
        /// Contact laws under the nominal layered finger, on an otherwise nominal plant.
        #[serde(rename = "I")]
        ContactLaws = "I",
        /// The same, with the device told of each: what measuring a person's law can give at most.
        #[serde(rename = "I-told")]
        ToldContactLaws = "I-told",
        /// The same, with the device told of what was measured of each at a device with the designed sensor of the heat flux.
        #[serde(rename = "I-measured")]
        MeasuredContactLaws = "I-measured",
    }
}

/// Time since landing from which a largest skin error counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Since {
    /// 50 ms, after the step that nothing can show.
    Ms50,
    /// Half a second.
    Ms500,
}

impl Since {
    /// The time, s.
    pub const fn since_s(self) -> f64 {
        match self {
            Self::Ms50 => 0.05,
            Self::Ms500 => 0.5,
        }
    }
}

/// An aim for the largest skin error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// From when on the error counts.
    pub since: Since,
    /// Percentile, %.
    pub percent: f64,
    /// Aim, mK.
    pub aim_mk: f64,
}

const fn aim(since: Since, percent: f64, aim_mk: f64) -> Aim {
    Aim { since, percent, aim_mk }
}

impl Population {
    /// The scenario's name on the command line; F to I have several populations.
    pub const fn scenario(self) -> &'static str {
        match self {
            Self::Objects => "E",
            Self::FingerBox | Self::DrawnFingers => "F",
            Self::DesignedSensor | Self::HypotheticalSensor | Self::KnownSurfaces => "G",
            Self::EnrolledDesigned | Self::EnrolledHypothetical => "H",
            Self::ContactLaws | Self::ToldContactLaws | Self::MeasuredContactLaws => "I",
        }
    }

    /// Whether its fingers are enrolled before.
    pub const fn is_of_enrolled(self) -> bool {
        matches!(self, Self::EnrolledDesigned | Self::EnrolledHypothetical)
    }

    /// Description of the population.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Objects => {
                "objects: slabs, half-spaces, layers; the thesis's finger, nominal plant"
            }
            Self::FingerBox => "layered fingers and devices of the parameter box, six objects",
            Self::DrawnFingers => "fingers of finger.draw, devices of the box, six objects",
            Self::DesignedSensor => {
                "as F-draw, first contact with the designed sensor of the heat flux"
            }
            Self::HypotheticalSensor => {
                "as F-draw, first contact with a hypothetical sensor of 1 %"
            }
            Self::EnrolledDesigned => "as G-designed, finger enrolled on another day",
            Self::EnrolledHypothetical => "as G-hypothetical, finger enrolled on another day",
            Self::KnownSurfaces => "as G-hypothetical, surfaces in contact as the device assumes",
            Self::ContactLaws => {
                "contact laws of contact.draw; nominal layered finger, six objects"
            }
            Self::ToldContactLaws => "the same contact laws, each told to the device",
            Self::MeasuredContactLaws => {
                "the same contact laws, each told as it was measured with the designed sensor"
            }
        }
    }

    /// Percentiles of the largest skin error from a time on and their aims; none of drawn contact laws.
    pub const fn aims(self) -> &'static [Aim] {
        use Since::{Ms50, Ms500};
        const OBJECTS: [Aim; 2] = [aim(Ms50, 95.0, 10.0), aim(Ms50, 100.0, 20.0)];
        const FINGER_BOX: [Aim; 2] = [aim(Ms50, 50.0, 40.0), aim(Ms50, 95.0, 130.0)];
        const DRAWN_FINGERS: [Aim; 2] = [aim(Ms50, 50.0, 100.0), aim(Ms50, 95.0, 370.0)];
        const FIRST_CONTACT: [Aim; 4] = [
            aim(Ms50, 50.0, 25.0),
            aim(Ms50, 95.0, 75.0),
            aim(Ms500, 50.0, 15.0),
            aim(Ms500, 95.0, 40.0),
        ];
        const ENROLLED: [Aim; 4] = [
            aim(Ms50, 50.0, 20.0),
            aim(Ms50, 95.0, 50.0),
            aim(Ms500, 50.0, 15.0),
            aim(Ms500, 95.0, 40.0),
        ];
        match self {
            Self::Objects => &OBJECTS,
            Self::FingerBox => &FINGER_BOX,
            Self::DrawnFingers => &DRAWN_FINGERS,
            Self::DesignedSensor | Self::HypotheticalSensor | Self::KnownSurfaces => &FIRST_CONTACT,
            Self::EnrolledDesigned | Self::EnrolledHypothetical => &ENROLLED,
            Self::ContactLaws | Self::ToldContactLaws | Self::MeasuredContactLaws => &[],
        }
    }

    /// What its devices are told. Version 0.1 knew no sensor of the heat flux, and no contact law but Eq. 6-8.
    pub const fn ways(self) -> &'static [Way] {
        match self {
            Self::DesignedSensor
            | Self::HypotheticalSensor
            | Self::KnownSurfaces
            | Self::EnrolledDesigned
            | Self::EnrolledHypothetical
            | Self::ToldContactLaws
            | Self::MeasuredContactLaws => &[Way::AsItIs],
            _ => &Way::ALL,
        }
    }

    /// The cases: all objects, or six objects for each of a number of draws.
    ///
    /// # Errors
    /// A person's contact law cannot be measured.
    pub fn cases(self, seed: u64, draws: u64) -> anyhow::Result<Vec<PopulationCase>> {
        let case = |object, (name, own): (String, u64), tables: String| PopulationCase {
            population: self,
            name,
            object,
            seed: own,
            tables,
        };
        if self == Self::Objects {
            return Ok(every_object()
                .into_iter()
                .map(|object| case(object.clone(), (object.name, seed), String::new()))
                .collect());
        }
        let mut cases = Vec::new();
        for number in 0..draws {
            // A scene file holds 63 bits.
            // G and H have the fingers and devices of F.
            let stream = match self {
                Self::DesignedSensor
                | Self::HypotheticalSensor
                | Self::KnownSurfaces
                | Self::EnrolledDesigned
                | Self::EnrolledHypothetical => Self::DrawnFingers.scenario(),
                other => other.scenario(),
            };
            let own = stream_seed(seed, &format!("{stream} {number}")) >> 1;
            let (of_device, tables) = match self {
                Self::FingerBox => (own, layered("") + &device(own)),
                Self::DrawnFingers | Self::DesignedSensor | Self::EnrolledDesigned => {
                    (own, drawn_finger(own))
                }
                Self::HypotheticalSensor | Self::EnrolledHypothetical => {
                    (own, drawn_finger(own) + &hypothetical_sensor(own))
                }
                Self::KnownSurfaces => {
                    let hypothetical = drawn_finger(own) + &hypothetical_sensor(own);
                    (own, hypothetical + &known_surfaces())
                }
                Self::ToldContactLaws => (seed, drawn_contact(own) + &told(exact_contact(own))),
                Self::MeasuredContactLaws => {
                    (seed, drawn_contact(own) + &told(measured_contact(own)?))
                }
                _ => (seed, drawn_contact(own)),
            };
            for object in six_objects() {
                let name = format!("{}, draw {number}", object.name);
                cases.push(case(object, (name, of_device), tables.clone()));
            }
        }
        Ok(cases)
    }
}

/// A layered finger with further keys.
fn layered(keys: &str) -> String {
    format!("[finger]\ntissue = \"layered\"\n{keys}")
}

/// A nominal layered finger with a contact law of `contact.draw`.
fn drawn_contact(seed: u64) -> String {
    layered("") + &format!("[plant]\ncontact.draw = {seed}\n")
}

/// That law. The pressure is the force over the true area there, which shows as another microhardness of the area that the device
/// assumes.
fn exact_contact(seed: u64) -> ContactLaw {
    let mut params = Params::nominal();
    parameters::draw_contact(&mut params, seed);
    let plant = params.contact;
    ContactLaw {
        exponent: plant.exponent,
        hardness_pa: plant.hardness_pa * plant.area_factor,
        gap_w_m2k: plant.gap_w_m2k,
    }
}

/// The line that tells the device of a law.
fn told(law: ContactLaw) -> String {
    let line = StationRequest::contact_law(law);
    format!("[[host]]\nt_s = 0.0\nline = \"{line}\"\n")
}

/// A finger of `finger.draw` on a device of the parameter box.
fn drawn_finger(seed: u64) -> String {
    layered(&format!("draw = {seed}\n")) + &device(seed)
}

/// Standard deviations of the hypothetical sensor over those of the designed one (`docs/flux.md`): its gain, 1 of 1.5 %, and its
/// zero, 2.7 of 3.5 W/m².
const HYPOTHETICAL_GAIN: f64 = 1.0 / 1.5;
const HYPOTHETICAL_ZERO: f64 = 2.7 / 3.5;
/// Noise of a conversion of the hypothetical sensor, W/m².
const HYPOTHETICAL_NOISE_W_M2: f64 = 22.0;

/// Keys of `[plant]` by which the device of this seed has the hypothetical sensor in place of the designed one.
fn hypothetical_sensor(seed: u64) -> String {
    let mut params = Params { flux: Some(FluxParams::NOMINAL), ..Params::nominal() };
    parameters::draw(&mut params, seed);
    let flux = params.flux.unwrap_or(FluxParams::NOMINAL);
    format!(
        "flux.gain_error = {:?}\nflux.zero_w_m2 = {:?}\nflux.noise_w_m2 = {HYPOTHETICAL_NOISE_W_M2:?}\n",
        flux.gain_error * HYPOTHETICAL_GAIN,
        flux.zero_w_m2 * HYPOTHETICAL_ZERO,
    )
}

/// Keys of `[plant]` by which display and skin have the surfaces that the device assumes.
fn known_surfaces() -> String {
    let surfaces = [("display", REFERENCE_DISPLAY), ("skin", SKIN.surface)];
    let keys = surfaces.map(|(name, surface)| {
        let Surface {
            conductivity_w_mk,
            roughness_um,
            slope_rad,
        } = surface;
        format!(
            "{name}.conductivity_w_mk = {conductivity_w_mk:?}\n{name}.roughness_um = {roughness_um:?}\n\
             {name}.slope_rad = {slope_rad:?}\n"
        )
    });
    keys.concat()
}

/// A device of the parameter box. Its display thermistors are bonded alike ([`SAME_VALUE`]): with lags that are drawn apart,
/// a device of eight trips while it presets itself.
fn device(seed: u64) -> String {
    let mut params = Params::nominal();
    parameters::draw(&mut params, seed);
    let (key, same) = SAME_VALUE;
    let drawn = parameters::all(&params).into_iter();
    let lags = drawn.filter(|parameter| parameter.key == key);
    let lags: String = lags.map(|lag| format!("{same} = {:?}\n", lag.value)).collect();
    format!("[plant]\ndraw = {seed}\n{lags}")
}

/// So many items, spread over a list; all if there are fewer. One is taken from each of `count` equal parts of the list, from
/// one part to the next a place later in it, so that a list in which six objects alternate does not give one of them only.
pub fn spread<T: Clone>(items: &[T], count: usize) -> Vec<T> {
    let count = count.min(items.len());
    (0..count)
        .filter_map(|i| {
            let place = i % (items.len() / count);
            items.get(i * items.len() / count + place).cloned()
        })
        .collect()
}

#[cfg(test)]
mod tests;
