//! What the tick adds up while the display answers pulses: integrals, and the normal equations that they make.

use super::{AFTER, Row};
use crate::drive::Current;

/// Unknowns, and what the reading's integral is made of.
pub const UNKNOWNS: usize = 8;
/// A place for each unknown, and one for what they make up.
pub const COLUMNS: usize = UNKNOWNS + 1;
/// One for each unknown; then [totals](Totals).
pub const ROWS: usize = UNKNOWNS + 1;

/// Rates of the filters, of 2^15 a tick: 0.11 s for what the legs take up, 0.149 s for Joule's heat (a fifteenth and a
/// twelfth of the legs' capacity over their conductance, 1.8 s).
const LEGS_RATE: i64 = 298;
const JOULE_RATE: i64 = 220;
/// Part of the current that acts late, of 2^15: a third of the legs' capacity beside that of the plate.
const LEGS_PART: i64 = 1933;
const RATE_BITS: u32 = 15;

/// Ticks from one equation to the next.
const EVERY: u32 = 8;
/// Ticks of an equation's unit of time, as a power of two.
pub const UNIT_BITS: u32 = 11;
/// Binary places of an equation's parts, which are the reading's, and of currents.
const PART_BITS: u32 = 22;
const CURRENT_BITS: u32 = 24;
/// Largest part: 16 K, 16 A of a unit of time, which only a current that is not the one asked for comes to. Products of
/// two are below 2^52, and [`AFTER`] has 1010 equations: their sum stays in 62 bits.
const LARGEST: i64 = (1 << (PART_BITS + 4)) - 1;

/// Places in the last row.
pub enum Totals {
    /// What the unknowns make up, squared.
    Made = 0,
    /// Ticks in which the current was compared.
    Ticks = 1,
    /// Sum of the demanded current's magnitude in these ticks.
    Asked = 2,
    /// Sum of the measured current, counted along the demanded one.
    Measured = 3,
    /// Sum of the demanded current squared.
    AskedSquared = 4,
    /// Sum of demanded times measured current.
    AskedMeasured = 5,
}

/// The integrals, in ticks, and the normal equations.
#[derive(Clone, Debug, Default)]
pub struct Sums {
    ticks: u32,
    u1: i64,
    u2: i64,
    d1: i64,
    d2: i64,
    v1: i64,
    v2: i64,
    /// What the filters have reached: current, its direction, and its square.
    late: i64,
    late_direction: i64,
    heat: i64,
    y1: i64,
    y2: i64,
    /// What is read when all is added up.
    pub rows: [Row; ROWS],
}

const _: () = assert!(AFTER / EVERY <= 1 << 10, "sums of products overflow");

impl Sums {
    /// Takes the current that was asked for, and what it came to.
    pub fn compare(&mut self, asked: Current, measured: Current) {
        let along = |current: Current| {
            i64::from(current.to_bits() >> 8) * i64::from(asked.signum().to_num::<i32>())
        };
        let (asked, measured) = (along(asked), along(measured));
        let [.., totals] = &mut self.rows;
        for (place, value) in [
            (Totals::Ticks, 1),
            (Totals::Asked, asked),
            (Totals::Measured, measured),
            (Totals::AskedSquared, asked * asked),
            (Totals::AskedMeasured, asked * measured),
        ] {
            totals[place as usize] += value;
        }
    }

    /// Takes the change of the reading, 2^-22 K, the current that has flown meanwhile beside that at rest, and the change
    /// of its direction.
    pub fn take(&mut self, y: i64, current: Current, rest: i64, direction: i64) {
        let current = i64::from(current.to_bits());
        let (u, v) = (
            current - rest,
            (current * current - rest * rest) >> CURRENT_BITS,
        );
        let d = direction << CURRENT_BITS;
        self.ticks += 1;
        self.u1 += u - legs(&mut self.late, u);
        self.u2 += self.u1;
        self.d1 += d - legs(&mut self.late_direction, d);
        self.d2 += self.d1;
        self.heat += ((v - self.heat) * JOULE_RATE) >> RATE_BITS;
        self.v1 += self.heat;
        self.v2 += self.v1;
        self.y1 += y;
        self.y2 += self.y1;
        if self.ticks.is_multiple_of(EVERY) {
            self.equation(y);
        }
    }

    fn equation(&mut self, y: i64) {
        let t = i64::from(self.ticks);
        // In seconds of 2^UNIT_BITS ticks and 2^-PART_BITS.
        let parts: [i64; COLUMNS] = [
            y,
            self.u2 >> (CURRENT_BITS - PART_BITS + 2 * UNIT_BITS),
            self.u1 >> (CURRENT_BITS - PART_BITS + UNIT_BITS),
            self.v2 >> (CURRENT_BITS - PART_BITS + 2 * UNIT_BITS),
            self.y2 >> (2 * UNIT_BITS),
            t << (PART_BITS - UNIT_BITS),
            (t * t) >> (2 * UNIT_BITS - PART_BITS + 1),
            self.d2 >> (CURRENT_BITS - PART_BITS + 2 * UNIT_BITS),
            self.y1 >> UNIT_BITS,
        ]
        .map(|part: i64| part.clamp(-LARGEST, LARGEST));
        let [unknowns @ .., totals] = &mut self.rows;
        for (row, a) in unknowns.iter_mut().zip(&parts) {
            for (sum, b) in row.iter_mut().zip(&parts) {
                *sum += a * b;
            }
        }
        let [.., made] = parts;
        totals[Totals::Made as usize] += made * made;
    }
}

/// The part of a current that acts late.
const fn legs(late: &mut i64, current: i64) -> i64 {
    *late += ((current - *late) * LEGS_RATE) >> RATE_BITS;
    (*late * LEGS_PART) >> RATE_BITS
}
