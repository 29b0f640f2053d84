//! The normal equations of least squares, added up tick by tick while the display answers the excitation.
//!
//! All values are integers with the binary places of the readings and currents that they are made of: 22 for K, 24
//! for A and A², and those of both factors for a product. TickIntegrals count time in ticks.

use super::EXCITATION_TICKS;
use crate::drive::Current;

/// Unknowns of the model, one for each regressor.
pub const UNKNOWNS: usize = 8;
/// One for each unknown, and one for the regressand.
pub const COLUMNS: usize = UNKNOWNS + 1;
/// One for each unknown, and one for the [statistics](Statistic).
pub const ROWS: usize = UNKNOWNS + 1;

/// One row: sums of the products of one regressor with each regressor and with the regressand, in 2^-44.
pub type NormalEquationRow = [i64; COLUMNS];

/// Coefficients of the low-pass filters, in 2^-15 a tick: 0.11 s for the heat that the legs take up, 0.149 s for Joule's
/// heat (a fifteenth and a twelfth of the legs' capacity over their conductance, 1.8 s).
const LEGS_FILTER_COEFFICIENT: i64 = 298;
const JOULE_FILTER_COEFFICIENT: i64 = 220;
/// Part of the current that acts through the legs' filter, in 2^-15: a third of the legs' capacity beside that of the
/// plate.
const CURRENT_PART_THROUGH_LEGS: i64 = 1933;
/// Binary places of the three above.
const FILTER_PLACES: u32 = 15;

/// Ticks from one equation to the next.
const TICKS_PER_EQUATION: u32 = 8;
/// Ticks in the equations' unit of time, 2.048 s, as a power of two.
pub const TIME_UNIT_SHIFT: u32 = 11;
/// Binary places of regressors and regressand, as of a temperature.
const REGRESSOR_PLACES: u32 = 22;
/// Binary places of a [`Current`].
const CURRENT_PLACES: u32 = 24;
/// Largest magnitude: 16 K, or 16 A for a unit of time, which a current within its limits does not reach. The product of
/// two is below 2^52, and there are 1010 equations: their sums stay in 62 bits.
const REGRESSOR_MAX: i64 = (1 << (REGRESSOR_PLACES + 4)) - 1;
const _: () = assert!(EXCITATION_TICKS / TICKS_PER_EQUATION <= 1 << 10);

/// Indices of the last row. Currents are counted along the demanded one, in 2^-16 A.
pub enum Statistic {
    /// Sum of the squared regressand.
    SquaredRegressand = 0,
    /// Number of ticks in which demanded and measured current were compared.
    ComparedTicks = 1,
    /// Sum of the demanded current in these ticks.
    Demanded = 2,
    /// Sum of the measured current.
    Measured = 3,
    /// Sum of the squared demanded current.
    SquaredDemanded = 4,
    /// Sum of demanded times measured current.
    DemandedTimesMeasured = 5,
}

/// First and second integral of a signal over ticks.
#[derive(Clone, Copy, Debug, Default)]
struct TickIntegrals {
    first: i64,
    second: i64,
}

impl TickIntegrals {
    fn add(&mut self, value: i64) {
        self.first += value;
        self.second += self.first;
    }
}

/// The normal equations, and the integrals and filters that make their regressors.
#[derive(Clone, Debug, Default)]
pub struct NormalEquations {
    ticks: u32,
    /// Of the change of the reading, in 2^-22 K.
    reading: TickIntegrals,
    /// Of the change of the current, in 2^-24 A.
    current: TickIntegrals,
    /// Of the change of the current's direction, in 2^-24.
    direction: TickIntegrals,
    /// Of the change of the squared current, in 2^-24 A², behind Joule's filter.
    squared_current: TickIntegrals,
    /// States of the filters, with the same places.
    filtered_current: i64,
    filtered_direction: i64,
    filtered_squared_current: i64,
    rows: [NormalEquationRow; ROWS],
}

impl NormalEquations {
    /// One row for each unknown, and the [statistics](Statistic); complete when the identification has succeeded.
    #[must_use]
    pub const fn rows(&self) -> &[NormalEquationRow; ROWS] {
        &self.rows
    }

    /// Adds the demanded and the measured current of one tick to the statistics.
    pub(super) fn add_current_comparison(&mut self, demanded: Current, measured: Current) {
        // 16 binary places: the sums of squares over all pulses stay in 60 bits.
        let along_demanded = |current: Current| {
            i64::from(current.to_bits() >> 8) * i64::from(demanded.signum().to_num::<i32>())
        };
        let (demanded, measured) = (along_demanded(demanded), along_demanded(measured));
        let [.., statistics] = &mut self.rows;
        for (index, value) in [
            (Statistic::ComparedTicks, 1),
            (Statistic::Demanded, demanded),
            (Statistic::Measured, measured),
            (Statistic::SquaredDemanded, demanded * demanded),
            (Statistic::DemandedTimesMeasured, demanded * measured),
        ] {
            statistics[index as usize] += value;
        }
    }

    /// Adds one tick: the change of the reading in 2^-22 K, the current that has flown since the last tick, its baseline
    /// in 2^-24 A, and the change of its direction, -2 to 2.
    pub(super) fn add_tick(
        &mut self,
        reading: i64,
        current: Current,
        baseline: i64,
        direction: i64,
    ) {
        let current = i64::from(current.to_bits());
        let change = current - baseline;
        let squared_change = (current * current - baseline * baseline) >> CURRENT_PLACES;
        let direction = direction << CURRENT_PLACES;
        let through_legs = |state: &mut i64, input| {
            (step_low_pass(state, input, LEGS_FILTER_COEFFICIENT) * CURRENT_PART_THROUGH_LEGS)
                >> FILTER_PLACES
        };
        self.ticks += 1;
        (self.current).add(change - through_legs(&mut self.filtered_current, change));
        (self.direction).add(direction - through_legs(&mut self.filtered_direction, direction));
        let joule_state = &mut self.filtered_squared_current;
        (self.squared_current).add(step_low_pass(
            joule_state,
            squared_change,
            JOULE_FILTER_COEFFICIENT,
        ));
        self.reading.add(reading);
        if self.ticks.is_multiple_of(TICKS_PER_EQUATION) {
            self.add_equation(reading);
        }
    }

    /// Adds the products of all regressors and the regressand of this tick.
    fn add_equation(&mut self, reading: i64) {
        /// From the places of a current to those of a regressor.
        const CURRENT_TO_REGRESSOR_SHIFT: u32 = CURRENT_PLACES - REGRESSOR_PLACES;
        let t = i64::from(self.ticks);
        // In units of time, and in 2^-22.
        let terms: [i64; COLUMNS] = [
            reading,
            self.current.second >> (CURRENT_TO_REGRESSOR_SHIFT + 2 * TIME_UNIT_SHIFT),
            self.current.first >> (CURRENT_TO_REGRESSOR_SHIFT + TIME_UNIT_SHIFT),
            self.squared_current.second >> (CURRENT_TO_REGRESSOR_SHIFT + 2 * TIME_UNIT_SHIFT),
            self.reading.second >> (2 * TIME_UNIT_SHIFT),
            t << (REGRESSOR_PLACES - TIME_UNIT_SHIFT),
            // t²/2: one more place to the right.
            (t * t) >> (2 * TIME_UNIT_SHIFT - REGRESSOR_PLACES + 1),
            self.direction.second >> (CURRENT_TO_REGRESSOR_SHIFT + 2 * TIME_UNIT_SHIFT),
            self.reading.first >> TIME_UNIT_SHIFT,
        ]
        .map(|term: i64| term.clamp(-REGRESSOR_MAX, REGRESSOR_MAX));
        let [equations @ .., statistics] = &mut self.rows;
        for (row, a) in equations.iter_mut().zip(&terms) {
            for (sum, b) in row.iter_mut().zip(&terms) {
                *sum += a * b;
            }
        }
        let [.., regressand] = terms;
        statistics[Statistic::SquaredRegressand as usize] += regressand * regressand;
    }
}

/// One tick of a first-order low-pass filter; its new output, which is its state.
const fn step_low_pass(state: &mut i64, input: i64, coefficient: i64) -> i64 {
    *state += ((input - *state) * coefficient) >> FILTER_PLACES;
    *state
}
