//! The normal equations of least squares, added up tick by tick while the display answers the excitation.
//!
//! All values are integers with the binary places of the readings and currents that they are made of: 22 for K, 24
//! for A and A², and those of both factors for a product. TickIntegrals count time in ticks.

use super::EXCITATION_TICKS;
use crate::drive::Current;

/// Number of unknowns of the tile's model, one for each regressor.
pub const UNKNOWNS: usize = 8;
/// Columns of the normal equations: one for each unknown, and one for the regressand.
pub const COLUMNS: usize = UNKNOWNS + 1;
/// Rows of sums that an identification leaves: one for each unknown, and one for the [statistics](Statistic).
pub const ROWS: usize = UNKNOWNS + 1;

/// One row: sums over all equations of the product of one regressor with each regressor and with the regressand, in
/// 2^-44. The last row holds the [statistics](Statistic) instead.
pub type NormalEquationRow = [i64; COLUMNS];

/// Coefficient of the low-pass filter for the heat that the legs take up, in 2^-15 a tick: 0.11 s, a fifteenth of the
/// legs' heat capacity over their conductance, 1.8 s.
const LEGS_FILTER_COEFFICIENT: i64 = 298;
/// Coefficient of the low-pass filter through which Joule's heat reaches the plate, in 2^-15 a tick: 0.149 s, a twelfth
/// of the legs' heat capacity over their conductance, 1.8 s.
const JOULE_FILTER_COEFFICIENT: i64 = 220;
/// Part of the current's heat that the legs take up, behind their filter, in 2^-15: a third of the legs' heat capacity
/// beside that of the plate.
const CURRENT_PART_THROUGH_LEGS: i64 = 1933;
/// Binary places of the filters' coefficients and of the part through the legs.
const FILTER_PLACES: u32 = 15;

/// Ticks of 1 ms from one equation to the next; each adds its products to the normal equations.
const TICKS_PER_EQUATION: u32 = 8;
/// Unit of time in which the integrals enter the equations, as a power of two of ticks of 1 ms: 2.048 s. Keeps the
/// regressors within 16 K or 16 A.
pub const TIME_UNIT_SHIFT: u32 = 11;
/// Binary places of regressors and regressand, those of a temperature.
const REGRESSOR_PLACES: u32 = 22;
/// Binary places of a [`Current`] in A.
const CURRENT_PLACES: u32 = 24;
/// Limit of regressors and regressand: 16 K, or 16 A for a unit of time, which a current within its limits does not
/// reach. The product of two is below 2^52, and there are 1010 equations: their sums stay in 62 bits.
const REGRESSOR_MAX: i64 = (1 << (REGRESSOR_PLACES + 4)) - 1;
const _: () = assert!(EXCITATION_TICKS / TICKS_PER_EQUATION <= 1 << 10);

/// Indices into the last row: what is summed beside the normal equations. Currents are counted along the demanded one,
/// in 2^-16 A.
pub enum Statistic {
    /// Sum of the squared regressand over all equations, in 2^-44, from which the residual of the fit follows.
    SquaredRegressand = 0,
    /// Number of ticks in which demanded and measured current were compared, because the demanded one was above 1 A.
    ComparedTicks = 1,
    /// Sum of the demanded current over the compared ticks, in 2^-16 A.
    Demanded = 2,
    /// Sum of the measured current over the compared ticks, in 2^-16 A; positive along the demanded one.
    Measured = 3,
    /// Sum of the squared demanded current over the compared ticks, in 2^-32 A².
    SquaredDemanded = 4,
    /// Sum of demanded times measured current over the compared ticks, in 2^-32 A².
    DemandedTimesMeasured = 5,
}

/// First and second integral of a signal over time in ticks, since the pulses began, in the signal's unit.
#[derive(Clone, Copy, Debug, Default)]
struct TickIntegrals {
    first: i64,
    second: i64,
}

impl TickIntegrals {
    /// Adds one tick's value to the first integral, and then the first to the second.
    fn add(&mut self, value: i64) {
        self.first += value;
        self.second += self.first;
    }
}

/// The normal equations of the tile's identification, with the integrals and filters from which their regressors are
/// made. All sums are integers.
#[derive(Clone, Debug, Default)]
pub struct NormalEquations {
    /// Ticks of 1 ms since the pulses began.
    ticks: u32,
    /// Integrals of the change of the display's reading from its baseline, in 2^-22 K.
    reading: TickIntegrals,
    /// Integrals of the change of the current from its baseline, in 2^-24 A, less the part of it that the legs take up
    /// behind their filter.
    current: TickIntegrals,
    /// Integrals of the change of the current's direction (-2 to 2) from the baseline, in 2^-24, less the part of it
    /// that the legs take up behind their filter.
    direction: TickIntegrals,
    /// Integrals of the change of the squared current from its baseline, in 2^-24 A², behind Joule's filter.
    squared_current: TickIntegrals,
    /// The change of the current behind the legs' filter, in 2^-24 A.
    filtered_current: i64,
    /// The change of the current's direction behind the legs' filter, in 2^-24.
    filtered_direction: i64,
    /// The change of the squared current behind Joule's filter, in 2^-24 A².
    filtered_squared_current: i64,
    /// One row of sums for each unknown, then the statistics.
    rows: [NormalEquationRow; ROWS],
}

impl NormalEquations {
    /// All sums: one row for each unknown, and the [statistics](Statistic); complete when the identification has
    /// succeeded.
    #[must_use]
    pub const fn rows(&self) -> &[NormalEquationRow; ROWS] {
        &self.rows
    }

    /// Adds the demanded and the measured current of one tick, A, to the statistics.
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

    /// Adds one tick: the change of the display's reading from its baseline in 2^-22 K, the current that has flown
    /// since the last tick, the baseline current in 2^-24 A, and the change of the current's direction from the
    /// baseline, -2 to 2. Every eighth tick makes an equation.
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

    /// Adds one equation: the products of all regressors and the regressand of this tick. `reading` is the change of
    /// the display's reading in 2^-22 K.
    fn add_equation(&mut self, reading: i64) {
        /// Binary places by which a current is shifted right to those of a regressor.
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

/// One tick of a first-order low-pass filter, whose `coefficient` is in 2^-15; its new output, which is also stored in
/// `state`.
const fn step_low_pass(state: &mut i64, input: i64, coefficient: i64) -> i64 {
    *state += ((input - *state) * coefficient) >> FILTER_PLACES;
    *state
}
