//! The displays.

use serde::Serialize;
use thermal_client::course::{COURSE_POINTS_MAX, Course, reduce};
use thermal_device::command::AssumedFinger;
use thermal_device::control::Law;
use thermal_device::reference::ContactModel;
use thermal_plant::ConfigError;
use thermal_sim::scene::Scene;

use crate::rc_ladder::RcLadder;
use crate::recording::{skin_on_object, through_sensor};
use crate::touch::SingleContact;
use crate::{closed_form, layered_finger};

/// Time in which the device goes from Yamamoto's static temperature to the contact temperature, s. On a half-space the touch
/// itself does it at once.
pub const YAMAMOTO_RAMP_S: f64 = 0.1;
/// Depth whose temperature Yang's display shows, m.
const YANG_DEPTH_M: f64 = 1.24e-3;
/// Time constant of Caldwell's sensor, s: three of them are 4 s, in the middle of the 3 to 5 s that a reading took.
const CALDWELL_LAG_S: f64 = 4.0 / 3.0;
/// Cells of finger and of object in Benali-Khoudja's ladder.
const LADDER: RcLadder = RcLadder { order: 10 };

/// A display, by its maker.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Display {
    /// Ho 2006, chapter 4: Eq. 3-1 at 10 Hz.
    #[serde(rename = "ho-2006-chapter-4")]
    HoChapter4,
    /// Ho 2006, chapter 6: Eq. 6-12.
    #[serde(rename = "ho-2006-chapter-6")]
    HoChapter6,
    /// Yamamoto 2004: static temperature before the contact, then the contact temperature.
    #[serde(rename = "yamamoto-2004")]
    Yamamoto,
    /// Yang 2006: the course at a depth.
    #[serde(rename = "yang-2006")]
    Yang,
    /// Ino 1993: recorded falls of the finger's temperature.
    #[serde(rename = "ino-1993")]
    Ino,
    /// Caldwell 1993: transients recorded by a slow sensor.
    #[serde(rename = "caldwell-1993")]
    Caldwell,
    /// Benali-Khoudja 2004: electrical analogy.
    #[serde(rename = "benali-khoudja-2004")]
    BenaliKhoudja,
    /// Kron 2003, Deml 2006 and Citerin 2006: layers with blood.
    LayeredBioHeat,
    /// This device.
    Ours,
}

/// How the device shows what a display would have shown.
#[derive(Clone, Debug, PartialEq)]
pub enum Showing {
    /// By a mode of its own.
    Mode {
        /// Contact model.
        model: ContactModel,
        /// Control law.
        law: Law,
        /// Finger that it assumes.
        finger: AssumedFinger,
    },
    /// By a course from the landing on, with at most 128 points.
    Course {
        /// The course.
        course: Course,
        /// Largest difference to the course that was computed, from its reduction, its rounding and the rate limit, K.
        error_k: f64,
    },
}

impl Display {
    /// All displays, ours last.
    pub const ALL: [Self; 9] = [
        Self::HoChapter4,
        Self::HoChapter6,
        Self::Yamamoto,
        Self::Yang,
        Self::Ino,
        Self::Caldwell,
        Self::BenaliKhoudja,
        Self::LayeredBioHeat,
        Self::Ours,
    ];

    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::HoChapter4 => "ho-2006-chapter-4",
            Self::HoChapter6 => "ho-2006-chapter-6",
            Self::Yamamoto => "yamamoto-2004",
            Self::Yang => "yang-2006",
            Self::Ino => "ino-1993",
            Self::Caldwell => "caldwell-1993",
            Self::BenaliKhoudja => "benali-khoudja-2004",
            Self::LayeredBioHeat => "layered-bio-heat",
            Self::Ours => "ours",
        }
    }

    /// What the source says of the display. But for Ho's, and for ours, the source is what Ho's thesis reports of it.
    pub const fn source(self) -> &'static str {
        match self {
            Self::HoChapter4 => {
                "Ho 2006, chapter 4: the contact temperature of two half-spaces (Eq. 3-1), held by a digital PI controller at \
                 10 Hz"
            }
            Self::HoChapter6 => {
                "Ho 2006, chapter 6: half-spaces joined by a contact resistance; the display's temperature by Eq. 6-12. The \
                 thesis computes it and built no display with it"
            }
            Self::Yamamoto => {
                "thesis 1.2, 1.3: half-spaces, no contact resistance; before the contact a static temperature, computed from the \
                 contact temperature and the thermal properties of the display, after it the contact temperature; PID"
            }
            Self::Yang => {
                "thesis 1.3: same equations as Yamamoto; the time-dependent temperature at 1.24 mm from the skin surface"
            }
            Self::Ino => {
                "thesis 1.2, 5: falls of the finger's temperature, measured on the contact area of real materials, are shown by \
                 the display"
            }
            Self::Caldwell => {
                "thesis 1.2, 3.2: transients recorded on a robot hand that touches an object are presented on the back of the \
                 index finger; a successful reading took 3 to 5 s"
            }
            Self::BenaliKhoudja => {
                "thesis 1.2, 6.1: electrical analogy, contact resistance after Yovanovich; it predicts the temperature of the \
                 skin"
            }
            Self::LayeredBioHeat => {
                "thesis 1.3 on Kron 2003, Deml 2006 and Citerin 2006: bio-heat equation in the layers of the finger, with \
                 blood and metabolic heat, in contact with the object"
            }
            Self::Ours => {
                "this device: Eq. 6-12 by relaxations for the finger that it is told to assume, followed by a model of plate and \
                 finger"
            }
        }
    }

    /// What had to be assumed to compute it.
    pub const fn assumed(self) -> &'static str {
        match self {
            Self::HoChapter4 => "gains of the PI controller, which the thesis does not give",
            Self::HoChapter6 => "this device's control law, because the thesis has none for it",
            Self::Yamamoto => {
                "the static temperature is that from which a half-space of this tile's ceramic comes to the contact temperature; \
                 this tile, which is none, takes 0.1 s"
            }
            Self::Yang => {
                "the display's surface shows that temperature, and waits at skin temperature"
            }
            Self::Ino => {
                "recorded on the simulated finger, without lag or noise, on the object of the scene; the display's surface \
                 shows it"
            }
            Self::Caldwell => {
                "recorded on the simulated finger by a sensor of 1.33 s, three of which are 4 s; shown on the fingertip, not on \
                 the back of the finger"
            }
            Self::BenaliKhoudja => {
                "10 equal cells each for finger and object, three diffusion lengths deep; Eq. 6-8 for the resistance; the \
                 display's surface shows the predicted skin"
            }
            Self::LayeredBioHeat => {
                "three layers with typical values, of which blood flows in two; no contact resistance, which the thesis says was \
                 rarely evaluated; the display's surface shows the predicted skin"
            }
            Self::Ours => {
                "Eq. 6-8, and that it is told which finger touches: its layers without blood, or the half-space"
            }
        }
    }

    /// What an ideal tile shows from the landing on.
    ///
    /// # Errors
    /// The scene's plant does not accept a value.
    pub fn ideal_course(self, scene: &Scene, touch: &SingleContact) -> Result<Course, ConfigError> {
        Ok(match self {
            Self::HoChapter4 | Self::Yamamoto => closed_form::constant(touch),
            Self::HoChapter6 => closed_form::with_resistance(touch),
            Self::Yang => closed_form::at_depth(touch, YANG_DEPTH_M),
            Self::Ino => through_sensor(touch, &skin_on_object(touch)?, 0.0),
            Self::Caldwell => through_sensor(touch, &skin_on_object(touch)?, CALDWELL_LAG_S),
            Self::BenaliKhoudja => LADDER.skin(touch),
            Self::LayeredBioHeat => layered_finger::bio_heat(touch)?,
            Self::Ours => match scene.assumed_finger {
                AssumedFinger::Thesis => closed_form::with_resistance(touch),
                AssumedFinger::Mean | AssumedFinger::MeanOnPad => {
                    layered_finger::mean_finger(touch)?
                }
            },
        })
    }

    /// How the device shows it.
    ///
    /// # Errors
    /// The scene's plant does not accept a value.
    pub fn showing(self, scene: &Scene, touch: &SingleContact) -> Result<Showing, ConfigError> {
        let own = Showing::Mode {
            model: ContactModel::ContactResistance,
            law: scene.law.unwrap_or(Law::Model),
            finger: scene.assumed_finger,
        };
        let computed = match self {
            Self::HoChapter4 => {
                return Ok(Showing::Mode {
                    model: ContactModel::SemiInfinite,
                    law: Law::Pi10Hz,
                    finger: AssumedFinger::Thesis,
                });
            }
            Self::HoChapter6 => {
                return Ok(Showing::Mode {
                    model: ContactModel::ContactResistance,
                    law: Law::Model,
                    finger: AssumedFinger::Thesis,
                });
            }
            Self::Ours => return Ok(own),
            Self::Yamamoto => closed_form::static_then_contact(touch, YAMAMOTO_RAMP_S),
            _ => self.ideal_course(scene, touch)?,
        };
        let mut limited = computed.rate_limited(RATE_MAX_K_S);
        if limited != computed {
            // On whole milliseconds, because rounding the time of a point changes the rates beside it.
            limited = touch.sampled(|t_s| limited.at(t_s));
        }
        let course = reduce(&limited, COURSE_POINTS_MAX).course.rounded();
        Ok(Showing::Course { error_k: course.largest_difference_k(&computed), course })
    }

    /// The scene with the device told to show what the display would have shown.
    ///
    /// # Errors
    /// The scene's plant does not accept a value.
    pub fn scene(
        self,
        scene: &Scene,
        touch: &SingleContact,
    ) -> Result<(Scene, Option<f64>), ConfigError> {
        let mut scene = scene.clone();
        let error_k = match self.showing(&scene, touch)? {
            Showing::Mode { model, law, finger } => {
                (scene.mode, scene.law, scene.assumed_finger) = (model, Some(law), finger);
                None
            }
            Showing::Course { course, error_k } => {
                scene.course = Some(course);
                Some(error_k)
            }
        };
        Ok((scene, error_k))
    }
}

/// Largest rate of a course that the device is given, K/s: below the 100 K/s that it accepts by more than the roundings of two
/// temperatures a millisecond apart.
const RATE_MAX_K_S: f64 = 99.0;
