//! The comparator's numbers.

use super::Source::Design;
use super::slot::{Slot, slot, under};
use super::spread::absolute;
use crate::comparator::ComparatorParams;

/// What resistors of 1 % make of a threshold.
pub fn slots(comparator: &mut ComparatorParams) -> impl Iterator<Item = Slot<'_>> {
    let ComparatorParams { cold_c, hot_c } = comparator;
    let all = [
        slot(
            cold_c,
            "cold_c",
            "C",
            "below this, by a nominal thermistor, the comparator cuts the bridge supply",
            absolute(0.3),
            (-40.0, 25.0),
            Design,
        ),
        slot(
            hot_c,
            "hot_c",
            "C",
            "above this, by a nominal thermistor, it does so too",
            absolute(0.3),
            (30.0, 100.0),
            Design,
        ),
    ];
    under("comparator", all)
}
