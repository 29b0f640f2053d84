//! Bridge, supply, mirror, comparator.

use thermal_display::guard::Fault;
use thermal_sim::scene::FaultKind as Kind;

use crate::faults::entry::{broken, valued};
use crate::faults::{Entry, Place, Sign};

/// A leg that does not do what it is told shows in the current, the display's way, or the self-test.
const LEG: &[Sign] = &[
    Sign::CurrentOff,
    Sign::OverCurrent,
    Sign::WrongWay,
    Sign::DisplayLimit,
    Sign::FaultLine,
    Sign::SelfTest(0.704),
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
const CURRENT: &[Sign] = &[Sign::CurrentOff, Sign::OverCurrent, Sign::SelfTest(0.304)];
/// A supply that drives the self-test's ampere well enough.
const SUPPLY: &[Sign] = &[Sign::CurrentOff, Sign::OverCurrent, Sign::FaultLine];
const CURRENT_LOW: &[Fault] = &[Fault::CurrentLow, Fault::NoResponse];
/// Current that is less, or more, by too little to be told from a sound one still moves the display less, or more; or leaves it to
/// what finger and sink do.
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
const WORST: &[Place] = &[Place::Slew, Place::Warm, Place::Off];
/// Where no tuned model helps, too.
const PLAIN: &[Place] = &[Place::Untuned, Place::Slew, Place::Off];
/// The module does less than it should.
const WEAK: &[Sign] = &[Sign::Astray, Sign::WrongWay];
const WEAK_REASONS: &[Fault] = &[
    Fault::NoResponse,
    Fault::Polarity,
    Fault::UnlikeModel,
    Fault::Runaway,
];

/// What drives the tile, and what watches that.
pub const ENTRIES: &[Entry] = &[
    Entry::trips(broken(Kind::BridgeStuckHigh), LEG, LEG_REASONS).at(WORST),
    Entry::trips(broken(Kind::BridgeBStuckHigh), LEG, LEG_REASONS).at(WORST),
    Entry::trips(broken(Kind::BridgeStuckLow), LEG, LEG_REASONS).at(WORST),
    Entry::trips(broken(Kind::LegOpen), CURRENT, NO_CURRENT).at(PLAIN),
    Entry::trips(
        broken(Kind::BridgeShorted),
        &[Sign::FaultLine],
        &[Fault::Bridge],
    )
    .at(WORST),
    Entry::trips(
        broken(Kind::PolaritySwapped),
        &[
            Sign::WrongWay,
            Sign::DisplayLimit,
            Sign::CurrentOff,
            Sign::SelfTest(0.504),
        ],
        // A module that is warmer on one side drives a current of its own, now the other way.
        &[
            Fault::Polarity,
            Fault::UnlikeModel,
            Fault::OverCurrent,
            Fault::CurrentHigh,
            Fault::CurrentLow,
        ],
    )
    .at(PLAIN),
    // What is left answers to the self-test's ampere by more than it asks for, or by about that. So what tells is what comes then:
    // for a module that has little to do the loop makes up.
    Entry::trips(valued(Kind::ModuleWeak, 0.3), WEAK, WEAK_REASONS).at(&[
        Place::Slew,
        Place::Cold,
        Place::Replace,
    ]),
    Entry::trips(valued(Kind::ModuleWeak, 0.1), WEAK, WEAK_REASONS).at(&[Place::Slew, Place::Off]),
    // The self-test must tell.
    Entry::trips(
        valued(Kind::ModuleWeak, 0.0),
        &[Sign::Astray, Sign::WrongWay, Sign::SelfTest(0.504)],
        WEAK_REASONS,
    )
    .at(Place::TESTED),
    Entry::harmless(broken(Kind::BridgeEnableStuck)).latent(),
    Entry::trips(
        broken(Kind::FaultPinDead),
        &[Sign::SelfTest(0.02)],
        &[Fault::Comparator],
    )
    .latent()
    .at(&[Place::Off]),
    Entry::trips(
        broken(Kind::ComparatorDead),
        &[Sign::SelfTest(0.02)],
        &[Fault::Comparator],
    )
    .latent()
    .at(&[Place::Off]),
    Entry::trips(
        broken(Kind::ComparatorStuck),
        &[Sign::FaultLine, Sign::SelfTest(0.04)],
        &[Fault::Bridge, Fault::Comparator],
    )
    .at(WORST),
    Entry::trips(valued(Kind::MirrorStuck, 0.0), CURRENT, CURRENT_LOW).at(WORST),
    Entry::trips(
        valued(Kind::MirrorStuck, 3.0),
        CURRENT,
        &[Fault::CurrentHigh, Fault::CurrentLow],
    ),
    Entry::trips(
        valued(Kind::MirrorStuck, 10.0),
        &[Sign::OverCurrent],
        &[Fault::OverCurrent],
    ),
    Entry::trips(valued(Kind::SupplyLow, 9.0), SUPPLY, NO_CURRENT).at(WORST),
    Entry::trips(valued(Kind::SupplyLow, 4.5), CURRENT, NO_CURRENT).at(WORST),
    Entry::trips(valued(Kind::SupplyHigh, 16.0), SUPPLY, MUCH_CURRENT).at(WORST),
    Entry::trips(valued(Kind::SupplyHigh, 24.0), SUPPLY, MUCH_CURRENT).at(WORST),
];
