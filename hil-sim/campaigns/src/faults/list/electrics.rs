//! Bridge, supply, mirror, comparator.

use thermal_device::safety::Fault;
use thermal_sim::scene::FaultKind as Kind;

use crate::faults::fault_case::{broken, harmless, trips, valued};
use crate::faults::{FaultCase, FaultScene, Symptom};

/// A faulty leg is detectable by the current, the direction of the display temperature, or the self-test.
const LEG: &[Symptom] = &[
    Symptom::CurrentOff,
    Symptom::OverCurrent,
    Symptom::WrongWay,
    Symptom::DisplayLimit,
    Symptom::FaultLine,
    Symptom::SelfTest(0.704),
];
pub(super) const LEG_REASONS: &[Fault] = &[
    Fault::CurrentHigh,
    Fault::CurrentLow,
    Fault::OverCurrent,
    Fault::Polarity,
    Fault::UnlikeModel,
    Fault::NoResponse,
    Fault::Bridge,
];
const CURRENT: &[Symptom] = &[
    Symptom::CurrentOff,
    Symptom::OverCurrent,
    Symptom::SelfTest(0.304),
];
/// A supply that still drives the 1 A of the self-test.
const SUPPLY: &[Symptom] = &[
    Symptom::CurrentOff,
    Symptom::OverCurrent,
    Symptom::FaultLine,
];
const CURRENT_LOW: &[Fault] = &[Fault::CurrentLow, Fault::NoResponse];
/// A current error too small to be detected by itself still changes the response of the display, or lets finger and sink
/// determine its temperature.
const NO_CURRENT: &[Fault] = &[
    Fault::CurrentLow,
    Fault::NoResponse,
    Fault::UnlikeModel,
    Fault::Polarity,
];
const MUCH_CURRENT: &[Fault] = &[
    Fault::CurrentHigh,
    Fault::OverCurrent,
    Fault::Bridge,
    Fault::UnlikeModel,
];
const WORST: &[FaultScene] = &[FaultScene::Slew, FaultScene::Warm, FaultScene::Off];
/// Includes a scene without a tuned model.
const PLAIN: &[FaultScene] = &[FaultScene::Untuned, FaultScene::Slew, FaultScene::Off];
/// The module pumps less heat than it should.
const WEAK: &[Symptom] = &[Symptom::DisplayDeviates, Symptom::WrongWay];
const WEAK_REASONS: &[Fault] = &[
    Fault::NoResponse,
    Fault::Polarity,
    Fault::UnlikeModel,
    Fault::Runaway,
];

/// Faults of bridge, supply, mirror and comparator.
pub const FAULT_CASES: &[FaultCase] = &[
    trips(broken(Kind::BridgeStuckHigh), LEG, LEG_REASONS).at(WORST),
    trips(broken(Kind::BridgeBStuckHigh), LEG, LEG_REASONS).at(WORST),
    trips(broken(Kind::BridgeStuckLow), LEG, LEG_REASONS).at(WORST),
    trips(broken(Kind::LegOpen), CURRENT, NO_CURRENT).at(PLAIN),
    trips(
        broken(Kind::BridgeShorted),
        &[Symptom::FaultLine],
        &[Fault::Bridge],
    )
    .at(WORST),
    trips(
        broken(Kind::PolaritySwapped),
        &[
            Symptom::WrongWay,
            Symptom::DisplayLimit,
            Symptom::CurrentOff,
            Symptom::SelfTest(0.504),
        ],
        // The Seebeck voltage of the module then drives a current in the wrong direction.
        &[
            Fault::Polarity,
            Fault::UnlikeModel,
            Fault::OverCurrent,
            Fault::CurrentHigh,
            Fault::CurrentLow,
        ],
    )
    .at(PLAIN),
    // The weakened module can pass the self-test. It is detectable under load; at low load the control loop compensates it.
    trips(valued(Kind::ModuleWeak, 0.3), WEAK, WEAK_REASONS).at(&[
        FaultScene::Slew,
        FaultScene::Cold,
        FaultScene::Replace,
    ]),
    trips(valued(Kind::ModuleWeak, 0.1), WEAK, WEAK_REASONS)
        .at(&[FaultScene::Slew, FaultScene::Off]),
    // The self-test must detect it.
    trips(
        valued(Kind::ModuleWeak, 0.0),
        &[
            Symptom::DisplayDeviates,
            Symptom::WrongWay,
            Symptom::SelfTest(0.504),
        ],
        WEAK_REASONS,
    )
    .at(FaultScene::TESTED),
    harmless(broken(Kind::BridgeEnableStuck)).latent(),
    trips(
        broken(Kind::FaultPinDead),
        &[Symptom::SelfTest(0.02)],
        &[Fault::Comparator],
    )
    .latent()
    .at(&[FaultScene::Off]),
    trips(
        broken(Kind::ComparatorDead),
        &[Symptom::SelfTest(0.02)],
        &[Fault::Comparator],
    )
    .latent()
    .at(&[FaultScene::Off]),
    trips(
        broken(Kind::ComparatorStuck),
        &[Symptom::FaultLine, Symptom::SelfTest(0.04)],
        &[Fault::Bridge, Fault::Comparator],
    )
    .at(WORST),
    trips(valued(Kind::MirrorStuck, 0.0), CURRENT, CURRENT_LOW).at(WORST),
    trips(
        valued(Kind::MirrorStuck, 3.0),
        CURRENT,
        &[Fault::CurrentHigh, Fault::CurrentLow],
    ),
    trips(
        valued(Kind::MirrorStuck, 10.0),
        &[Symptom::OverCurrent],
        &[Fault::OverCurrent],
    ),
    trips(valued(Kind::SupplyLow, 9.0), SUPPLY, NO_CURRENT).at(WORST),
    trips(valued(Kind::SupplyLow, 4.5), CURRENT, NO_CURRENT).at(WORST),
    trips(valued(Kind::SupplyHigh, 16.0), SUPPLY, MUCH_CURRENT).at(WORST),
    trips(valued(Kind::SupplyHigh, 24.0), SUPPLY, MUCH_CURRENT).at(WORST),
];
