//! Tests of the comparator that cuts the bridge's supply, on its hot and on its cold side, by the self-test.
//!
//! ```text
//! ms      0        20         40        60         80
//!         | hot on | hot off  | cold on | cold off |
//! nFAULT   low       high       low       high        10 ms after each change
//! supply   < 6 V     10.8 to    < 6 V     10.8 to     19 ms after each change
//!                    13.2 V               13.2 V
//! ```
//!
//! A test connects the comparator's input to a level outside of its window, so a dead side, a wrong ladder and a dead
//! latch show on the fault line, and a shorted switch shows on the supply behind it, which a bleeder discharges. All
//! fingers share the line that selects the side. It is read back, because one that is stuck would let the tests of both
//! sides pass on one side. The line of a test needs no reading back: stuck low it lets no test begin, stuck high none end. Tests begin in ticks whose numbers are multiples of 64, so hot tests
//! are in the first 20 of 64 ticks and cold ones in ticks 40 to 59: two fingers never need different sides.

use super::Fault;
use super::limits::{SUPPLY_CUT_MAX, SUPPLY_MAX, SUPPLY_MIN};
use super::self_test_report::{SelfTestReport, SideLine};
use crate::drive::ComparatorTest;
use crate::sense::{Samples, SupplyVoltage};

/// Length of each of the four phases, ticks of 1 ms: hot on, hot off, cold on, cold off.
const PHASE_TICKS: u16 = 20;
/// Length of the tests of both sides, ticks of 1 ms.
pub const COMPARATOR_TEST_TICKS: u16 = 4 * PHASE_TICKS;
/// Ticks of 1 ms after which the fault line must show each change: pulled by a test, released after it. The release
/// takes 3 to 7 ms, because the circuit filters the end of a test and the supply rises slowly.
const FAULT_LINE_DELAY_MAX_TICKS: u16 = 10;
/// The tests begin in ticks whose numbers are multiples of this. A power of two, so that the numbers can wrap.
const BEGIN_INTERVAL_TICKS: u32 = 64;

// A cold test of one finger and a hot one of another finger never overlap.
const _: () = assert!(3 * PHASE_TICKS as u32 <= BEGIN_INTERVAL_TICKS);

/// Whether the tests may begin in the station's tick with this number.
pub const fn may_begin_in(station_tick: u32) -> bool {
    station_tick.is_multiple_of(BEGIN_INTERVAL_TICKS)
}

/// Runs the tick number `tick`, 0 to 79, of the tests: checks the fault line and the supply as the ticks before have set
/// them, and returns the test that must be applied until the next tick.
///
/// # Errors
/// [`Fault::Comparator`]: the line that selects the side does not have its level in a test; or, from 10 ms after a change
/// on, the fault line does not show it. [`Fault::SupplySwitch`]: the
/// supply is above 6 V at the end of a test. [`Fault::Supply`]: it is outside of 10.8 to 13.2 V at the end of the pause
/// after a test.
pub fn run_tick(
    report: &mut SelfTestReport,
    tick: u16,
    samples: &Samples,
    supply: SupplyVoltage,
) -> Result<ComparatorTest, Fault> {
    let is_hot = tick < 2 * PHASE_TICKS;
    let (side, test) = if is_hot {
        (&mut report.hot, ComparatorTest::Hot)
    } else {
        (&mut report.cold, ComparatorTest::Cold)
    };
    let is_on = (tick / PHASE_TICKS).is_multiple_of(2);
    let elapsed = tick % PHASE_TICKS;
    let responded = samples.bridge_fault == is_on;
    let delay = if is_on { &mut side.cut_ms } else { &mut side.release_ms };
    // The readings of the first tick are those before the change.
    if is_on && elapsed > 0 {
        if samples.comparator_side_differs {
            report.side_line = Some(if is_hot { SideLine::StuckHigh } else { SideLine::StuckLow });
            return Err(Fault::Comparator);
        }
        report.side_line = Some(SideLine::Follows);
    }
    if elapsed > 0 && responded && delay.is_none() {
        *delay = Some(elapsed as u8);
    }
    if elapsed >= FAULT_LINE_DELAY_MAX_TICKS && !responded {
        return Err(Fault::Comparator);
    }
    if elapsed == PHASE_TICKS - 1 {
        if is_on {
            side.cut_supply = Some(supply);
            if supply > SUPPLY_CUT_MAX {
                return Err(Fault::SupplySwitch);
            }
        } else {
            report.supply = Some(supply);
            if !(SUPPLY_MIN..=SUPPLY_MAX).contains(&supply) {
                return Err(Fault::Supply);
            }
        }
    }
    Ok(if is_on { test } else { ComparatorTest::None })
}
