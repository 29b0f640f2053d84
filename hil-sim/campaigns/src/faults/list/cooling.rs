//! Faults of the cooling. None holds the sink above the pain threshold, against which no device could protect a finger.

use thermal_device::safety::Fault;
use thermal_sim::scene::FaultKind as Kind;

use crate::faults::fault_case::{trips, valued};
use crate::faults::{FaultCase, FaultScene, Symptom};

const HOT: &[Symptom] = &[Symptom::SinkLimit, Symptom::WrongWay, Symptom::DisplayLimit];
const HOT_REASONS: &[Fault] = &[Fault::SinkHot, Fault::Runaway, Fault::DisplayHot];

/// The fan fails, the coolant takes the temperature of a hot room, or the sink is held warm.
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
        // During the self-test the heat hides the response; a cold display may warm by 1 K before the sink's thermistor reacts.
        &[
            Fault::SinkHot,
            Fault::SinkJump,
            Fault::NoResponse,
            Fault::Polarity,
        ],
    )
    .at(&[FaultScene::Warm]),
];
