//! Faults of thermistors, force sensor and converter.

use thermal_device::safety::Fault;
use thermal_sim::scene::FaultKind as Kind;
use thermal_sim::scene::Sensor::{Check, Display, Room, Sink, Skin};

use crate::faults::fault_case::{broken, harmless, swapped, thermistor, trips, valued};
use crate::faults::{FaultCase, FaultScene, InjectedFault, Symptom};

const NOW: &[Symptom] = &[Symptom::Injection];

const fn wire(kind: Kind, of: thermal_sim::scene::Sensor, reasons: &'static [Fault]) -> FaultCase {
    trips(thermistor(kind, of, 0.0), NOW, reasons)
}

/// Open and shorted thermistors, and frozen converter channels.
pub const WIRES: &[FaultCase] = &[
    wire(Kind::ThermistorOpen, Display, &[Fault::DisplayOpen]),
    wire(Kind::ThermistorOpen, Check, &[Fault::CheckOpen]),
    wire(Kind::ThermistorOpen, Sink, &[Fault::SinkOpen]),
    wire(Kind::ThermistorOpen, Skin, &[Fault::SkinOpen]),
    wire(Kind::ThermistorOpen, Room, &[Fault::RoomOpen]),
    wire(Kind::ThermistorShort, Display, &[Fault::DisplayShort]),
    wire(Kind::ThermistorShort, Check, &[Fault::CheckShort]),
    wire(Kind::ThermistorShort, Sink, &[Fault::SinkShort]),
    wire(Kind::ThermistorShort, Skin, &[Fault::SkinShort]),
    wire(Kind::ThermistorShort, Room, &[Fault::RoomShort]),
    wire(Kind::ThermistorStuck, Display, &[Fault::DisplayFrozen]),
    wire(Kind::ThermistorStuck, Check, &[Fault::CheckFrozen]),
    wire(Kind::ThermistorStuck, Sink, &[Fault::SinkFrozen]),
    wire(Kind::ThermistorStuck, Skin, &[Fault::SkinFrozen]),
    wire(Kind::ThermistorStuck, Room, &[Fault::RoomFrozen]),
];

/// The control loop follows the wrong reading and the other thermistor shows it; near an end of the range the limit is
/// reached first.
const APART: &[Symptom] = &[Symptom::DisplaySensorsDiffer, Symptom::DisplayLimit];
const LIMIT: &[Symptom] = &[Symptom::DisplayLimit];
/// A step is detectable at once.
const STEP: &[Symptom] = &[Symptom::ReadingJump];
const DISPLAY_STEP: &[Fault] = &[Fault::DisplayJump, Fault::DisplayHot, Fault::DisplayCold];
const CHECK_STEP: &[Fault] = &[Fault::CheckJump, Fault::DisplayHot, Fault::DisplayCold];
/// A drift during the pulse of the self-test can look like a weak or reversed response. A drift that the tile can just
/// follow can look like a model mismatch.
const DRIFTED: &[Fault] = &[
    Fault::DisplaysApart,
    Fault::DisplayHot,
    Fault::DisplayCold,
    Fault::NoResponse,
    Fault::Polarity,
    Fault::UnlikeModel,
];
/// The model of the tile does not use the second thermistor.
const CHECK_DRIFTED: &[Fault] = &[
    Fault::DisplaysApart,
    Fault::DisplayHot,
    Fault::DisplayCold,
    Fault::NoResponse,
    Fault::Polarity,
];
/// A slow thermistor may respond too weakly to the pulse of the self-test, depending on its lag before the fault.
const LOOSE: &[Fault] = &[
    Fault::DisplaysApart,
    Fault::DisplayHot,
    Fault::DisplayCold,
    Fault::NoResponse,
];
const BEYOND: &[Fault] = &[
    Fault::DisplayHot,
    Fault::DisplayCold,
    Fault::NoResponse,
    Fault::Polarity,
    Fault::UnlikeModel,
];
const ROOM: &[Symptom] = &[Symptom::RoomAboveSkin];
const ROOM_ABOVE: &[Fault] = &[Fault::RoomAboveSkin];

const fn drift(of: thermal_sim::scene::Sensor, kelvin: f64) -> InjectedFault {
    thermistor(Kind::ThermistorDrift, of, kelvin)
}

const fn offset(of: thermal_sim::scene::Sensor, kelvin: f64) -> InjectedFault {
    thermistor(Kind::ThermistorOffset, of, kelvin)
}

const fn loose(of: thermal_sim::scene::Sensor) -> InjectedFault {
    thermistor(Kind::ThermistorDetached, of, 20.0)
}

/// Wrong but plausible readings. A drift of less than 3 K, or of skin and room by less than the limit of their difference,
/// cannot be distinguished from another finger or room, and moves the display by no more than the drift.
pub const READINGS: &[FaultCase] = &[
    trips(drift(Display, 5.0), APART, DRIFTED),
    trips(drift(Display, -5.0), APART, DRIFTED).at(&[FaultScene::Warm]),
    trips(drift(Check, 5.0), APART, CHECK_DRIFTED),
    trips(drift(Check, -5.0), APART, CHECK_DRIFTED),
    trips(drift(Display, 2.9), LIMIT, BEYOND).at(&[FaultScene::Cold]),
    trips(drift(Display, -2.9), LIMIT, BEYOND).at(&[FaultScene::Warm]),
    trips(drift(Sink, 5.0), &[Symptom::SinkLimit], &[Fault::SinkHot]),
    harmless(drift(Sink, -5.0)),
    harmless(drift(Skin, 5.0)),
    harmless(drift(Skin, -3.0)),
    trips(drift(Skin, -20.0), ROOM, ROOM_ABOVE),
    harmless(drift(Room, 5.0)),
    harmless(drift(Room, -5.0)),
    trips(drift(Room, 20.0), ROOM, ROOM_ABOVE),
    trips(offset(Display, 5.0), STEP, DISPLAY_STEP),
    trips(offset(Display, -5.0), STEP, DISPLAY_STEP).at(&[FaultScene::Warm]),
    trips(offset(Display, 1.0), STEP, DISPLAY_STEP),
    trips(offset(Check, 5.0), STEP, CHECK_STEP),
    trips(offset(Check, -5.0), STEP, CHECK_STEP),
    trips(offset(Sink, 5.0), STEP, &[Fault::SinkJump, Fault::SinkHot]),
    trips(offset(Sink, -5.0), STEP, &[Fault::SinkJump]),
    // The display does not receive the heat of a finger of 54 °C.
    trips(
        offset(Skin, 20.0),
        &[Symptom::Dose],
        &[Fault::Dose, Fault::UnlikeModel],
    )
    .at(&[FaultScene::Touched])
    .watched(180.0),
    trips(offset(Skin, -20.0), ROOM, ROOM_ABOVE),
    trips(
        loose(Display),
        &[
            Symptom::DisplaySensorsDiffer,
            Symptom::DisplayLimit,
            Symptom::WrongWay,
        ],
        DRIFTED,
    )
    .at(&[FaultScene::Slew, FaultScene::Replace]),
    trips(loose(Check), APART, LOOSE).at(&[FaultScene::Slew, FaultScene::Replace]),
    harmless(loose(Sink)).at(&[FaultScene::Cold]),
    harmless(loose(Skin)),
    harmless(loose(Room)),
];

/// The symptom of an exchange depends on the difference of the two temperatures and on the state of the display.
const SWAP: &[Symptom] = &[
    Symptom::ReadingJump,
    Symptom::DisplaySensorsDiffer,
    Symptom::WrongWay,
    Symptom::RoomAboveSkin,
    Symptom::SelfTest(0.504),
];
const ELSEWHERE: &[Fault] = &[
    Fault::DisplayJump,
    Fault::CheckJump,
    Fault::DisplaysApart,
    Fault::Polarity,
    Fault::UnlikeModel,
    Fault::RoomAboveSkin,
    Fault::NoResponse,
];
/// The reading of the sink steps too, and may be the only one to exceed its limit.
const ON_SINK: &[Fault] = &[
    Fault::DisplayJump,
    Fault::CheckJump,
    Fault::SinkJump,
    Fault::DisplaysApart,
    Fault::Polarity,
    Fault::UnlikeModel,
    Fault::RoomAboveSkin,
    Fault::NoResponse,
];
const NO_STEP: &[Symptom] = &[Symptom::ReadingJump, Symptom::RoomAboveSkin];

/// Exchanged thermistors.
pub const SWAPPED: &[FaultCase] = &[
    harmless(swapped(Display, Check)),
    trips(swapped(Display, Sink), SWAP, ON_SINK).at(&[FaultScene::Off, FaultScene::Slew]),
    trips(swapped(Display, Skin), SWAP, ELSEWHERE).at(&[FaultScene::Off, FaultScene::Touched]),
    trips(swapped(Display, Room), SWAP, ELSEWHERE).at(&[FaultScene::Off, FaultScene::Slew]),
    trips(swapped(Check, Sink), SWAP, ON_SINK).at(&[FaultScene::Off]),
    trips(swapped(Check, Skin), SWAP, ELSEWHERE).at(&[FaultScene::Off]),
    trips(swapped(Check, Room), SWAP, ELSEWHERE).at(&[FaultScene::Off]),
    trips(
        swapped(Sink, Skin),
        NO_STEP,
        &[Fault::SinkJump, Fault::RoomAboveSkin],
    ),
    trips(
        swapped(Sink, Room),
        NO_STEP,
        &[Fault::SinkJump, Fault::RoomAboveSkin],
    ),
    trips(swapped(Skin, Room), NO_STEP, &[Fault::RoomAboveSkin]),
];

/// Reference, converter and force sensor.
pub const OTHERS: &[FaultCase] = &[
    trips(broken(Kind::ReferenceOff), NOW, &[Fault::Excitation]),
    // The reading of the current is frozen, too.
    trips(
        broken(Kind::AdcStuck),
        NOW,
        &[Fault::SamplesFrozen, Fault::CurrentHigh, Fault::CurrentLow],
    )
    .at(&[FaultScene::Slew]),
    trips(broken(Kind::ForceOpen), NOW, &[Fault::ForceSensor]),
    // The model expects heat of a finger that is absent; the offset is nearly the whole range of the sensor.
    harmless(valued(Kind::ForceOffset, 10.0))
        .or_trips(&[Fault::UnlikeModel, Fault::ForceSensor])
        .at(&[FaultScene::Cold, FaultScene::Preset, FaultScene::Warm]),
    trips(valued(Kind::ForceOffset, -10.0), NOW, &[Fault::ForceSensor]),
    harmless(valued(Kind::ForceOffset, 1.0)).at(&[FaultScene::Preset]),
    harmless(valued(Kind::ForceOffset, -0.05)),
    // An undetected finger warms a display whose current is at its limit.
    harmless(broken(Kind::ForceStuck)).or_trips(&[Fault::Polarity]),
];
