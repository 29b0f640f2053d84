//! What cools the sink. Nothing here holds the sink above what hurts: no device could keep a finger from that.

use thermal_display::guard::Fault;
use thermal_sim::scene::FaultKind as Kind;

use crate::faults::entry::valued;
use crate::faults::{Entry, Place, Sign};

const HOT: &[Sign] = &[Sign::SinkLimit, Sign::WrongWay, Sign::DisplayLimit];
const HOT_REASONS: &[Fault] = &[Fault::SinkHot, Fault::Runaway, Fault::DisplayHot];

/// The fan stops; what the sink is cooled by stops and takes the temperature of a hot room; something warm touches it.
pub const ENTRIES: &[Entry] = &[
    Entry::trips(valued(Kind::FanOff, 10.0), HOT, HOT_REASONS)
        .at(&[Place::Cold])
        .watched(90.0),
    Entry::trips(valued(Kind::FanOff, 1000.0), HOT, HOT_REASONS)
        .at(&[Place::Cold])
        .watched(90.0),
    Entry::trips(valued(Kind::ChillerOff, 40.0), HOT, HOT_REASONS)
        .at(&[Place::Cold])
        .watched(90.0),
    Entry::trips(valued(Kind::ChillerOff, 45.0), HOT, HOT_REASONS)
        .at(&[Place::Cold])
        .watched(80.0),
    Entry::trips(
        valued(Kind::SinkHot, 45.0),
        &[Sign::Jump, Sign::SinkLimit],
        // In the self-test its heat hides the answer; a cold display may warm by a kelvin before the sink's thermistor is there.
        &[
            Fault::SinkHot,
            Fault::SinkJump,
            Fault::NoResponse,
            Fault::Polarity,
        ],
    )
    .at(&[Place::Warm]),
];
