//! The normal equations of least squares, added up tick by tick while the display responds to the excitation pulses.
//!
//! All values are integers with the binary places of the readings and currents that they are made of: 22 for K, 24
//! for A and A², and those of both factors for a product. Integrals count time in ticks of 1 ms.

use super::EXCITATION_TICKS;
use crate::drive::Current;

/// Number of unknowns of the least-squares fit, 8: the coefficients of the tile's model after it is integrated twice,
/// each with one regressor.
pub const UNKNOWN_COUNT: usize = 8;
/// Number of columns of the normal equations: one for each of the eight unknowns, and one for the regressand.
pub const NORMAL_EQUATION_COLUMNS: usize = UNKNOWN_COUNT + 1;
/// Number of rows of sums that an identification adds up: one for each of the eight unknowns, and one for the
/// [statistics](StatisticIndex).
pub const NORMAL_EQUATION_AND_STATISTICS_ROWS: usize = UNKNOWN_COUNT + 1;

/// One row of sums. A row for one unknown of the fit contains the products of its regressor with each regressor and
/// with the regressand, added up over all equations, in units of 2^-44 (22 fractional bits of each factor). The last
/// row contains the [statistics](StatisticIndex) instead.
pub type NormalEquationRow = [i64; NORMAL_EQUATION_COLUMNS];

/// Coefficient, in 2^-15 per tick of 1 ms, of the low-pass filter that models how late the module's legs take up heat.
/// Its time constant is 0.11 s: about a fifteenth of 1.8 s, which is the heat capacity of the legs divided by their
/// thermal conductance.
const LEGS_HEAT_FILTER_COEFFICIENT: i64 = 298;
/// Coefficient, in 2^-15 per tick of 1 ms, of the low-pass filter that models how late Joule's heat reaches the plate
/// through the module's legs. Its time constant is 0.149 s: about a twelfth of 1.8 s, which is the heat capacity of the
/// legs divided by their thermal conductance.
const JOULE_HEAT_FILTER_COEFFICIENT: i64 = 220;
/// Fraction of the pumped heat that, behind the low-pass filter of the legs, changes the temperature of the module's
/// legs instead of the plate's, in 2^-15: 5.9 %. It is a third of the legs' heat capacity, divided by the sum of this
/// third and the heat capacity of the plate with its tabs.
const LEGS_PUMPED_HEAT_FRACTION: i64 = 1933;
/// Fractional bits of the coefficients of the low-pass filters, and of [`LEGS_PUMPED_HEAT_FRACTION`].
const FILTER_COEFFICIENT_FRACTION_BITS: u32 = 15;

/// Dead time of a plate like that of the nominal tile, 14.5 ms from the flow of a current, rounded down to ticks of 1 ms. The
/// current's part in an equation appears in the reading by the dead time later, and so does the zero error of the current
/// mirror. Without it, 0.05 A of zero error would shift the gain by 0.04 %.
const EXPECTED_DEAD_TIME_TICKS: i64 = 14;

/// Ticks of 1 ms from one equation of the least-squares fit to the next. Each equation adds the products of its
/// regressors and its regressand to the normal equations; the pulses give 1010 equations.
const EQUATION_INTERVAL_TICKS: u32 = 8;
/// Unit of time of the integrals in the equations, as a power of two of ticks of 1 ms: 2^11 ticks, 2.048 s. In this
/// unit the regressors of the pulses stay within ±16 (in K, A or A²), the limit that keeps the sums within 64 bits.
pub const TIME_UNIT_TICKS_LOG2: u32 = 11;
/// Fractional bits of the regressors and of the regressand: 22, as many as a temperature in K has.
const REGRESSOR_FRACTION_BITS: u32 = 22;
/// Fractional bits of a [`Current`] in A: its unit is 2^-24 A.
const CURRENT_FRACTION_BITS: u32 = 24;
/// Largest magnitude of a regressor or of the regressand, in 2^-22: 16 (in K, A or A², with time in units of 2.048 s),
/// to which larger values are clamped. Of the regressors of the pulses' current, the twice integrated squared current
/// is the largest, 11. The product of two values is below 2^52, so the sums over all 1010 equations stay below 2^62.
const REGRESSOR_MAX: i64 = (1 << (REGRESSOR_FRACTION_BITS + 4)) - 1;
const _: () = assert!(EXCITATION_TICKS / EQUATION_INTERVAL_TICKS <= 1 << 10);

/// Index of a sum in the last row of the [normal equations](NormalEquationRow), which contains sums other than products
/// of regressors. Its currents are magnitudes.
pub enum StatisticIndex {
    /// Sum of the squared regressand over all equations, in 2^-44 (K times 2.048 s)². The regressand is the first
    /// integral of the change of the display's reading. The residual of the fit is computed from this sum.
    SquaredRegressand = 0,
    /// Number of compared ticks: those whose demanded current was above 1 A in magnitude, so that demanded and measured
    /// current were compared.
    ComparedTicks = 1,
    /// Sum of the magnitude of the demanded current over the compared ticks (those that demand more than 1 A in
    /// magnitude), in 2^-16 A.
    Demanded = 2,
    /// Sum of the magnitude of the measured current over the compared ticks (those that demand more than 1 A in
    /// magnitude), in 2^-16 A.
    Measured = 3,
    /// Sum of the squared demanded current over the compared ticks (those that demand more than 1 A in magnitude), in
    /// 2^-32 A².
    SquaredDemanded = 4,
    /// Sum of the demanded times the measured current, as magnitudes, over the compared ticks (those that demand more
    /// than 1 A in magnitude), in 2^-32 A².
    DemandedTimesMeasured = 5,
}

/// First and second integral of a signal over time since the pulses began, as sums over ticks of 1 ms: in the signal's
/// unit times ticks and times ticks squared.
#[derive(Clone, Copy, Debug, Default)]
struct FirstAndSecondIntegral {
    first: i64,
    second: i64,
}

impl FirstAndSecondIntegral {
    /// Adds one tick: the signal's value to the first integral, and then the first integral to the second.
    fn integrate_tick(&mut self, value: i64) {
        self.first += value;
        self.second += self.first;
    }
}

/// Sums of the least-squares fit of the tile's parameters, and the integrals and low-pass filters from which the
/// regressors of each equation are computed. All values are integers.
#[derive(Clone, Debug, Default)]
pub struct NormalEquationAccumulator {
    /// Ticks of 1 ms since the pulses began.
    ticks: u32,
    /// First and second integral, over ticks of 1 ms, of the display's reading minus its baseline (each reading in
    /// 2^-22 K).
    reading: FirstAndSecondIntegral,
    /// First and second integral, over ticks of 1 ms, of the current's change: the measured current minus its baseline,
    /// in 2^-24 A (positive cools), less [`LEGS_PUMPED_HEAT_FRACTION`] of `filtered_current`, which changes the temperature of
    /// the module's legs instead of the plate's.
    current: FirstAndSecondIntegral,
    /// First and second integral, over ticks of 1 ms, of the change of the current's direction: the direction (1 cools,
    /// -1 heats, 0 uncertain) minus its baseline, in 2^-24, less [`LEGS_PUMPED_HEAT_FRACTION`] of `filtered_direction`. The
    /// fit finds from the second integral, delayed by [`EXPECTED_DEAD_TIME_TICKS`], the zero error of the current mirror.
    direction: FirstAndSecondIntegral,
    /// First and second integral, over ticks of 1 ms, of `filtered_squared_current`: the squared measured current minus
    /// the squared baseline current, in 2^-24 A², delayed as Joule's heat is on its way to the plate.
    squared_current: FirstAndSecondIntegral,
    /// Output of the low-pass filter that models how late the module's legs take up heat, in 2^-24 A; its input is the
    /// measured current minus its baseline.
    filtered_current: i64,
    /// Output of the low-pass filter that models how late the module's legs take up heat, in 2^-24; its input is the
    /// current's direction (1, 0 or -1) minus the direction of the baseline current.
    filtered_direction: i64,
    /// Output of the low-pass filter that models how late Joule's heat reaches the plate, in 2^-24 A²; its input is the
    /// squared measured current minus the square of its baseline.
    filtered_squared_current: i64,
    /// One row of sums for each of the eight unknowns, then the row of [statistics](StatisticIndex).
    rows: [NormalEquationRow; NORMAL_EQUATION_AND_STATISTICS_ROWS],
}

impl NormalEquationAccumulator {
    /// All sums: one row for each of the eight unknowns, then the row of [statistics](StatisticIndex). They are
    /// complete once the identification has succeeded.
    pub const fn rows_and_statistics(
        &self,
    ) -> &[NormalEquationRow; NORMAL_EQUATION_AND_STATISTICS_ROWS] {
        &self.rows
    }

    /// Adds the demanded and the measured current of one tick, A, to the [statistics](StatisticIndex) from which the
    /// ratio of measured to demanded current is fitted. `measured` has the sign of `demanded`, which is above 1 A in
    /// magnitude.
    pub(super) fn add_current_comparison(&mut self, demanded: Current, measured: Current) {
        // 16 fractional bits, so that the sums of squares over all pulses stay within 60 bits.
        let along_demanded = |current: Current| {
            i64::from(current.to_bits() >> 8) * i64::from(demanded.signum().to_num::<i32>())
        };
        let (demanded, measured) = (along_demanded(demanded), along_demanded(measured));
        let [.., statistics] = &mut self.rows;
        for (index, value) in [
            (StatisticIndex::ComparedTicks, 1),
            (StatisticIndex::Demanded, demanded),
            (StatisticIndex::Measured, measured),
            (StatisticIndex::SquaredDemanded, demanded * demanded),
            (StatisticIndex::DemandedTimesMeasured, demanded * measured),
        ] {
            statistics[index as usize] += value;
        }
    }

    /// Adds one tick of the pulses. `reading` is the display's reading minus its baseline, in 2^-22 K; `current` the
    /// measured current, A, positive if it cools; `baseline` the mean measured current of the baseline, in 2^-24 A;
    /// `direction` the current's direction (1, 0 or -1) minus that of the baseline. Every eighth tick adds an equation.
    pub(super) fn add_tick(
        &mut self,
        reading: i64,
        current: Current,
        baseline: i64,
        direction: i64,
    ) {
        let current = i64::from(current.to_bits());
        let change = current - baseline;
        let squared_change = (current * current - baseline * baseline) >> CURRENT_FRACTION_BITS;
        let direction = direction << CURRENT_FRACTION_BITS;
        let through_legs = |state: &mut i64, input| {
            (step_low_pass(state, input, LEGS_HEAT_FILTER_COEFFICIENT) * LEGS_PUMPED_HEAT_FRACTION)
                >> FILTER_COEFFICIENT_FRACTION_BITS
        };
        self.ticks += 1;
        (self.current).integrate_tick(change - through_legs(&mut self.filtered_current, change));
        (self.direction)
            .integrate_tick(direction - through_legs(&mut self.filtered_direction, direction));
        let joule_state = &mut self.filtered_squared_current;
        (self.squared_current).integrate_tick(step_low_pass(
            joule_state,
            squared_change,
            JOULE_HEAT_FILTER_COEFFICIENT,
        ));
        self.reading.integrate_tick(reading);
        if self.ticks.is_multiple_of(EQUATION_INTERVAL_TICKS) {
            self.add_equation(reading);
        }
    }

    /// Adds one equation to the sums: the product of each regressor of this tick with every regressor and with the
    /// regressand, and the squared regressand. `reading` is the display's reading minus its baseline, in 2^-22 K.
    fn add_equation(&mut self, reading: i64) {
        /// Number of bits by which a current in 2^-24 A is shifted right to the 22 fractional bits of a regressor.
        const CURRENT_TO_REGRESSOR_SHIFT: u32 = CURRENT_FRACTION_BITS - REGRESSOR_FRACTION_BITS;
        let t = i64::from(self.ticks);
        // The eight regressors, and last the regressand: with time in units of 2.048 s, and in 2^-22.
        let terms: [i64; NORMAL_EQUATION_COLUMNS] = [
            reading,
            self.current.second >> (CURRENT_TO_REGRESSOR_SHIFT + 2 * TIME_UNIT_TICKS_LOG2),
            self.current.first >> (CURRENT_TO_REGRESSOR_SHIFT + TIME_UNIT_TICKS_LOG2),
            self.squared_current.second >> (CURRENT_TO_REGRESSOR_SHIFT + 2 * TIME_UNIT_TICKS_LOG2),
            self.reading.second >> (2 * TIME_UNIT_TICKS_LOG2),
            t << (REGRESSOR_FRACTION_BITS - TIME_UNIT_TICKS_LOG2),
            // t²/2: shifted right by one more bit.
            (t * t) >> (2 * TIME_UNIT_TICKS_LOG2 - REGRESSOR_FRACTION_BITS + 1),
            (self.direction.second - EXPECTED_DEAD_TIME_TICKS * self.direction.first)
                >> (CURRENT_TO_REGRESSOR_SHIFT + 2 * TIME_UNIT_TICKS_LOG2),
            self.reading.first >> TIME_UNIT_TICKS_LOG2,
        ]
        .map(|term: i64| term.clamp(-REGRESSOR_MAX, REGRESSOR_MAX));
        let [equations @ .., statistics] = &mut self.rows;
        for (row, a) in equations.iter_mut().zip(&terms) {
            for (sum, b) in row.iter_mut().zip(&terms) {
                *sum += a * b;
            }
        }
        let [.., regressand] = terms;
        statistics[StatisticIndex::SquaredRegressand as usize] += regressand * regressand;
    }
}

/// Runs one tick of a first-order low-pass filter: moves `state`, the output of the filter, towards `input` by the
/// fraction `coefficient` (in 2^-15) of their difference, and returns the new output.
const fn step_low_pass(state: &mut i64, input: i64, coefficient: i64) -> i64 {
    *state += ((input - *state) * coefficient) >> FILTER_COEFFICIENT_FRACTION_BITS;
    *state
}
