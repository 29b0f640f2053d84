//! Parameters of the comparator.

use super::Source::{Design, Netlist};
use super::entry::{Entry, entry, prefixed};
use super::tolerance::{absolute, between};
use crate::comparator::ComparatorParams;

/// The tolerances are those of the circuit, without the thermistor's.
pub fn entries(comparator: &mut ComparatorParams) -> impl Iterator<Item = Entry<'_>> {
    let ComparatorParams { cold_c, hot_c, cold_test_c, hot_test_c, release_s } = comparator;
    let all = [
        entry!(
            cold_c,
            "C",
            "below this, by a nominal thermistor, the comparator cuts the bridge supply",
            absolute(0.5),
            (-40.0, 25.0),
            Netlist,
        ),
        entry!(
            hot_c,
            "C",
            "above this, by a nominal thermistor, it does so too",
            absolute(0.5),
            (30.0, 100.0),
            Netlist,
        ),
        entry!(
            cold_test_c,
            "C",
            "input in the test of the cold side, by a nominal thermistor",
            absolute(0.5),
            (-40.0, 25.0),
            Design,
        ),
        entry!(
            hot_test_c,
            "C",
            "input in the test of the hot side",
            absolute(0.5),
            (30.0, 100.0),
            Design,
        ),
        entry!(
            release_s,
            "s",
            "time from the end of a test until the latch is cleared",
            between(2.7e-3, 7e-3),
            (0.0, 1.0),
            Netlist,
        ),
    ];
    prefixed("comparator", all)
}
