//! Parameters of the comparator.

use super::Source::Design;
use super::entry::{Entry, entry, prefixed};
use super::tolerance::absolute;
use crate::comparator::ComparatorParams;

/// The tolerances follow from resistors of 1 %.
pub fn entries(comparator: &mut ComparatorParams) -> impl Iterator<Item = Entry<'_>> {
    let ComparatorParams { cold_c, hot_c } = comparator;
    let all = [
        entry!(
            cold_c,
            "C",
            "below this, by a nominal thermistor, the comparator cuts the bridge supply",
            absolute(0.3),
            (-40.0, 25.0),
            Design,
        ),
        entry!(
            hot_c,
            "C",
            "above this, by a nominal thermistor, it does so too",
            absolute(0.3),
            (30.0, 100.0),
            Design,
        ),
    ];
    prefixed("comparator", all)
}
