//! The learner: one finger on one display, window by window.

use contact_model::fixed_point::WEIGHTS;

use crate::estimate::Estimate;
use crate::output::LearnerOutput;
use crate::parameters::{PlaceBeforeContact, RESISTANCE, Scale, relative_weights};
use crate::person::PersonPrior;
use crate::recent::Recent;
use crate::regressors::{Lagged, Signals, to_float};
use crate::sensor::FluxSensor;
use crate::signals::BankOutput;
use crate::trust::{Distrust, Judge, Trust};
use crate::window::{ContactInput, LearnerInput, Resistance, Restart, WINDOW_TICKS};

/// Ticks after landing from which a contact is learnt from.
const LEARNT_FROM_TICKS: u32 = 10;
/// Ticks after landing from which the display's surface and the sensor have settled.
const SETTLED_TICKS: u32 = 20;
/// Error of the model before [`SETTLED_TICKS`], K: small enough that the contact resistance can be learnt already. [`Judge`] takes
/// innovations for 0 until then, so that they cannot cause a distrust.
const UNSETTLED_ERROR_K: f32 = 0.3;
/// Until these ticks after landing the learner uses every window, every second one, and every fourth; later every eighth. A window that
/// stands for two has half of the variance. From 1 s on the error of the model changes so slowly that windows left out would add nothing,
/// and the variance is that of one window.
const ALL_WINDOWS_UNTIL_TICKS: u32 = 300;
const ONE_IN_TWO_UNTIL_TICKS: u32 = 1000;
const ONE_IN_FOUR_UNTIL_TICKS: u32 = 3000;
/// Error of the model at landing, K. Its square grows in proportion to the time, so that each octave of time weighs alike.
const MODEL_ERROR_K: f32 = 20e-3;
/// Ticks after landing at which the variance of the model's error is twice that at landing. It grows linearly.
const MODEL_VARIANCE_DOUBLED_TICKS: f32 = 50.0;
/// Error of the surface of the display, K.
const SURFACE_ERROR_K: f32 = 1.5e-3;
/// Error of the display's surface over its change in the last second: the display's thermistor shows errors of the plate's model only
/// later.
const DISPLAY_CHANGE_ERROR: f32 = 0.05;
/// Coefficients per window of the low-passes from which changes of display and contact resistance are measured: of 1 s, and of 20 ms, the
/// lags of force and sensor.
const DISPLAY_SHARE: f32 = 0.01;
const RESISTANCE_SHARE: f32 = 0.5;
/// Relative change of the learnt factor on the contact resistance over that of the nominal resistance: the force has an error.
const FACTOR_CHANGE: f32 = 0.2;
/// Error of the sensor's zero, W/m²: two of its deviations.
const ZERO_ERROR_W_M2: f32 = 7.0;
/// Ticks of contact after which a finger may be stored.
const STORED_FROM_TICKS: u32 = 8000;
/// Factor by which the parameters shrink in each window after a distrust: towards 0, the mean finger.
const DECAY_PER_WINDOW_IF_DISTRUSTED: f32 = 0.75;
/// Unit of [`Resistance`], m² K/W.
const M2K_W_PER_BIT: f32 = 1e-6 / (1u32 << Resistance::FRAC_NBITS) as f32;

/// Number of windows of which one is learnt from, by the ticks since landing.
const fn windows_per_update(ticks: u32) -> u8 {
    match ticks {
        ..ALL_WINDOWS_UNTIL_TICKS => 1,
        ALL_WINDOWS_UNTIL_TICKS..ONE_IN_TWO_UNTIL_TICKS => 2,
        ONE_IN_TWO_UNTIL_TICKS..ONE_IN_FOUR_UNTIL_TICKS => 4,
        ONE_IN_FOUR_UNTIL_TICKS.. => 8,
    }
}

/// Learns a finger from the flux into the display. All methods are total, take bounded time and do not panic.
#[derive(Clone, Debug, PartialEq)]
pub struct Learner {
    place: PlaceBeforeContact,
    sensor: FluxSensor,
    person: Option<PersonPrior>,
    scale: Scale,
    signals: Signals,
    pub(crate) estimate: Estimate,
    judge: Judge,
    /// Skin before contact above the display's surface, K, and nominal contact resistance, m² K/W, in the present contact.
    above_display: Recent,
    resistance: Recent,
    /// The resistance at which the finger was last learnt from; 0 before.
    learnt_resistance_m2k_w: f32,
    /// Windows of the present contact, modulo 256; `None` without one.
    windows_in_contact: Option<u8>,
    /// Ticks of the last contact.
    ticks_since_landing: u32,
    /// Contacts since the restart or the last distrust that were trusted and long enough to be stored.
    stored_contacts: u8,
    /// Whether the estimate has changed since the last output. Most windows without contact and most of a long one leave it.
    has_changed: bool,
    output: LearnerOutput,
    /// Its weights.
    weights: BankOutput,
}

impl Default for Learner {
    fn default() -> Self {
        Self::new()
    }
}

impl Learner {
    /// A learner for an input with a [`Restart`], which must be its first.
    pub const fn new() -> Self {
        let (place, sensor) = (PlaceBeforeContact::Air, FluxSensor::UNKNOWN);
        Self {
            scale: Scale::new(place, sensor.lag_deviation()),
            place,
            sensor,
            person: None,
            signals: Signals::NEW,
            estimate: Estimate::PRIOR,
            judge: Judge::NEW,
            above_display: Recent::NEW,
            resistance: Recent::NEW,
            learnt_resistance_m2k_w: 0.0,
            windows_in_contact: None,
            ticks_since_landing: 0,
            stored_contacts: 0,
            has_changed: true,
            output: LearnerOutput::MEAN,
            weights: [1.0; WEIGHTS],
        }
    }

    /// Begins anew with this place, sensor and person, by value: a reference would keep the whole input in memory.
    #[inline(always)]
    pub(crate) fn restart(&mut self, restart: Restart) {
        self.place = restart.place;
        self.sensor = restart.sensor;
        self.person = restart.person;
        self.begin();
    }

    #[cold]
    #[inline(never)]
    fn begin(&mut self) {
        self.scale = Scale::new(self.place, self.sensor.lag_deviation());
        self.signals = Signals::NEW;
        self.estimate = self.prior();
        self.weights = relative_weights(&self.estimate.parameters);
        self.judge = Judge::NEW;
        self.windows_in_contact = None;
        self.ticks_since_landing = 0;
        self.stored_contacts = 0;
        self.has_changed = true;
    }

    /// What is known of the finger before its contacts.
    fn prior(&self) -> Estimate {
        self.person.map_or(Estimate::PRIOR, |person| person.estimate(self.place, &self.scale))
    }

    /// Takes one window's measurements, and returns what is known of the finger after it.
    pub fn advance(&mut self, input: &LearnerInput) -> &LearnerOutput {
        if let Some(restart) = input.restart {
            self.restart(restart);
        }
        let mut person = None;
        // Number of windows that this one stands for, if it is learnt from.
        let mut every = None;
        match &input.contact {
            Some(contact) => {
                let lands = self.windows_in_contact.is_none();
                if lands {
                    self.land();
                    self.ticks_since_landing = 0;
                }
                self.follow(contact, lands);
                let windows = self.windows_in_contact.map_or(1, |windows| windows.wrapping_add(1));
                self.windows_in_contact = Some(windows);
                // 0 in the window in which the finger lifts.
                self.ticks_since_landing =
                    (self.ticks_since_landing).max(contact.ticks_since_landing);
                if input.flux_w_m2.is_none() {
                    self.judge.distrust(Distrust::Sensor);
                }
                let is_learnt_from =
                    contact.is_steady && contact.ticks_since_landing >= LEARNT_FROM_TICKS;
                if is_learnt_from && !matches!(self.judge.trust(), Trust::Mean(_)) {
                    every = Some(windows_per_update(contact.ticks_since_landing))
                        .filter(|every| windows.is_multiple_of(*every));
                }
            }
            None => {
                if self.windows_in_contact.take().is_some() {
                    self.estimate.widen(&self.scale);
                    person = self.person_after_contact();
                    self.has_changed = true;
                }
            }
        }
        let drive = self.signals.drive(input, &self.sensor);
        if let (Some(contact), Some(every)) = (&input.contact, every) {
            let lagged = self.signals.lagged(&drive, &self.sensor);
            self.learn(contact, every, &lagged);
        }
        self.signals.advance(&drive, &self.sensor);
        if matches!(self.judge.trust(), Trust::Mean(_)) {
            self.approach_mean();
            self.stored_contacts = 0;
        }
        self.output(input.sequence, person)
    }

    fn land(&mut self) {
        if !self.judge.land() {
            self.estimate = self.prior();
            self.has_changed = true;
        }
    }

    /// Follows display and force.
    fn follow(&mut self, contact: &ContactInput, lands: bool) {
        let touching = f32::from(contact.touching_ticks.max(1)) / WINDOW_TICKS as f32;
        let above_k = to_float(contact.skin_above_display_k) / touching;
        let share = |share: f32| if lands { 1.0 } else { share };
        (self.above_display).advance(above_k, share(DISPLAY_SHARE));
        (self.resistance).advance(resistance_m2k_w(contact), share(RESISTANCE_SHARE));
    }

    /// What to store of the finger after a contact, if that was trusted and long enough.
    fn person_after_contact(&mut self) -> Option<PersonPrior> {
        let is_stored =
            self.judge.trust() == Trust::Trusted && self.ticks_since_landing >= STORED_FROM_TICKS;
        is_stored.then(|| {
            self.stored_contacts = self.stored_contacts.saturating_add(1);
            PersonPrior::new(&self.estimate, self.stored_contacts, self.place)
        })
    }

    /// Learns from a window, one of `every`.
    fn learn(&mut self, contact: &ContactInput, every: u8, lagged: &Lagged) {
        let ticks = contact.ticks_since_landing;
        let resistance_m2k_w = resistance_m2k_w(contact);
        let parameters = self.estimate.parameters;
        if self.has_changed {
            self.weights = relative_weights(&parameters);
        }
        let measurement =
            lagged.measurement(resistance_m2k_w, &self.sensor, &self.scale, &self.weights);

        let mut model_k2 =
            MODEL_ERROR_K * MODEL_ERROR_K * (1.0 + ticks as f32 / MODEL_VARIANCE_DOUBLED_TICKS);
        let is_settled = ticks >= SETTLED_TICKS;
        if !is_settled {
            model_k2 += UNSETTLED_ERROR_K * UNSETTLED_ERROR_K;
        }
        let factor = 1.0 + parameters[RESISTANCE] * self.scale.deviations[RESISTANCE];
        let zero_k = factor * resistance_m2k_w * ZERO_ERROR_W_M2;
        let error_k2 = model_k2 + zero_k * zero_k + SURFACE_ERROR_K * SURFACE_ERROR_K;
        let display_k = DISPLAY_CHANGE_ERROR * self.above_display.change();
        let force_k = self.resistance.change() * lagged.flux_w_m2;
        let changes_k2 = display_k * display_k + force_k * force_k;
        self.has_changed = true;
        self.widen_factor(resistance_m2k_w);
        let skipped = if ticks < ONE_IN_TWO_UNTIL_TICKS { every } else { 1 };
        let variance_k2 = (error_k2 + changes_k2) / f32::from(skipped);
        let innovation = self.estimate.update(&measurement, variance_k2, &self.scale);
        let innovation = innovation.map(|innovation| if is_settled { innovation } else { 0.0 });
        let parameters = &self.estimate.parameters;
        let state = (resistance_m2k_w, ticks, error_k2);
        self.judge.judge(innovation, &measurement, state, parameters, &self.scale);
    }

    /// Raises the variance of the factor on the contact resistance, because the nominal resistance has changed.
    fn widen_factor(&mut self, resistance_m2k_w: f32) {
        let before_m2k_w = self.learnt_resistance_m2k_w;
        self.learnt_resistance_m2k_w = resistance_m2k_w;
        if before_m2k_w > 0.0 {
            let change_m2k_w = resistance_m2k_w - before_m2k_w;
            let larger_m2k_w = if change_m2k_w > 0.0 { resistance_m2k_w } else { before_m2k_w };
            let relative = change_m2k_w / larger_m2k_w;
            let deviation = FACTOR_CHANGE * relative / self.scale.deviations[RESISTANCE];
            self.estimate.widen_resistance(deviation * deviation);
        }
    }

    /// Takes the parameters to those of the mean finger, in some 100 ms so that set-points do not jump.
    fn approach_mean(&mut self) {
        self.has_changed = true;
        for parameter in &mut self.estimate.parameters {
            *parameter *= DECAY_PER_WINDOW_IF_DISTRUSTED;
        }
    }

    fn output(&mut self, sequence: u16, person: Option<PersonPrior>) -> &LearnerOutput {
        if self.has_changed {
            let revision = self.output.revision.wrapping_add(1);
            self.weights = relative_weights(&self.estimate.parameters);
            self.output = LearnerOutput::new(revision, &self.estimate, &self.weights, &self.scale);
            self.has_changed = false;
        }
        (self.output.sequence, self.output.trust) = (sequence, self.judge.trust());
        self.output.person = person;
        &self.output
    }
}

/// The nominal contact resistance, m² K/W.
fn resistance_m2k_w(contact: &ContactInput) -> f32 {
    contact.resistance_mm2k_w.to_bits() as f32 * M2K_W_PER_BIT
}
