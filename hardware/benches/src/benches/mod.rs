//! The benches, one for each block of the circuit.

mod current_measurement;
mod dividers;
mod edges;
mod faults;
mod five_fingers;
mod flux;
mod force;
mod ground;
mod leakage;
mod multiplexer;
mod parity;
mod pins;
mod self_test;
mod shorts;
mod thresholds;
mod timing;
mod transients;

use anyhow::Result;
use thermal_device::{
    PWM_PERIOD_STEPS_OF_FIVE_FINGERS, PWM_PERIOD_STEPS_OF_ONE_FINGER, PWM_STEPS_PER_SECOND,
};

use crate::netlist::Netlists;
use crate::picture::Picture;
use crate::quantity::Quantity;

/// The firmware's PWM period for one finger, s.
pub const PERIOD_S: f64 = PWM_PERIOD_STEPS_OF_ONE_FINGER as f64 / PWM_STEPS_PER_SECOND as f64;
/// The firmware's PWM period for five fingers, s.
pub const PERIOD_OF_FIVE_FINGERS_S: f64 =
    PWM_PERIOD_STEPS_OF_FIVE_FINGERS as f64 / PWM_STEPS_PER_SECOND as f64;

/// Simulates a part of a bench and returns its quantities with what is allowed.
pub type Part = fn(&Netlists) -> Result<Vec<Quantity>>;

/// One bench.
#[derive(Clone, Copy)]
pub struct Bench {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it compares.
    pub title: &'static str,
    /// What it simulates, in this order.
    pub parts: &'static [Part],
    /// The circuit with one deliberate error that the bench must notice.
    pub broken: fn(&Netlists) -> Result<Netlists>,
    /// What of it people would rather see than read, by the name of the picture.
    pub pictures: &'static [Picture],
}

impl Bench {
    /// The quantities of all parts.
    ///
    /// # Errors
    /// A simulation fails, or an event that is measured never comes.
    pub fn run(&self, netlists: &Netlists) -> Result<Vec<Quantity>> {
        let mut all = Vec::new();
        for part in self.parts {
            all.extend(part(netlists)?);
        }
        Ok(all)
    }

    /// Whether a quantity of a circuit is not allowed, or cannot be measured; parts after that one are not simulated.
    pub fn fails(&self, netlists: &Netlists) -> bool {
        let passes = |quantities: Vec<Quantity>| quantities.iter().all(Quantity::holds);
        let mut parts = self.parts.iter();
        parts.any(|part| !part(netlists).is_ok_and(passes))
    }
}

/// All benches.
pub const ALL: [Bench; 17] = [
    thresholds::BENCH,
    self_test::BENCH,
    faults::BENCH,
    pins::BENCH,
    transients::BENCH,
    shorts::BENCH,
    edges::BENCH,
    timing::BENCH,
    current_measurement::BENCH,
    dividers::BENCH,
    force::BENCH,
    flux::BENCH,
    ground::BENCH,
    leakage::BENCH,
    multiplexer::BENCH,
    parity::BENCH,
    five_fingers::BENCH,
];
