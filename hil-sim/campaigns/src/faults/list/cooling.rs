//! What cools the sink. Nothing here holds the sink above what hurts: no device could keep a finger from that.

use thermal_device::safety::Fault;
use thermal_sim::scene::FaultKind as Kind;

use crate::faults::fault_case::{trips, valued};
use crate::faults::{FaultCase, FaultScene, Symptom};

const HOT: &[Symptom] = &[Symptom::SinkLimit, Symptom::WrongWay, Symptom::DisplayLimit];
const HOT_REASONS: &[Fault] = &[Fault::SinkHot, Fault::Runaway, Fault::DisplayHot];

/// The fan stops; what the sink is cooled by stops and takes the temperature of a hot room; something warm touches it.
pub const FAULT_CASES: &[FaultCase] = &[
    trips(valued(Kind::FanOff, 10.0), HOT, HOT_REASONS)
        .at(&[FaultScene::Cold])
        .watched(90.0),
    trips(valued(Kind::FanOff, 1000.0), HOT, HOT_REASONS)
        .at(&[FaultScene::Cold])
        .watched(90.0),
    trips(valued(Kind::ChillerOff, 40.0), HOT, HOT_REASONS)
        .at(&[FaultScene::Cold])
        .watched(90.0),
    trips(valued(Kind::ChillerOff, 45.0), HOT, HOT_REASONS)
        .at(&[FaultScene::Cold])
        .watched(80.0),
    trips(
        valued(Kind::SinkHot, 45.0),
        &[Symptom::ReadingJump, Symptom::SinkLimit],
        // In the self-test its heat hides the answer; a cold display may warm by a kelvin before the sink's thermistor is there.
        &[
            Fault::SinkHot,
            Fault::SinkJump,
            Fault::NoResponse,
            Fault::Polarity,
        ],
    )
    .at(&[FaultScene::Warm]),
];
