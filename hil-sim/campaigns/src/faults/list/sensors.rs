//! Thermistors, force sensor, converter.

use thermal_device::safety::Fault;
use thermal_sim::scene::FaultKind as Kind;
use thermal_sim::scene::Sensor::{Check, Display, Room, Sink, Skin};

use crate::faults::fault_case::{broken, harmless, swapped, thermistor, trips, valued};
use crate::faults::{FaultCase, FaultScene, InjectedFault, Symptom};

const NOW: &[Symptom] = &[Symptom::Injection];

const fn wire(kind: Kind, of: thermal_sim::scene::Sensor, reasons: &'static [Fault]) -> FaultCase {
    trips(thermistor(kind, of, 0.0), NOW, reasons)
}

/// Open, shorted, and stuck in the converter: a reading that repeats itself.
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

/// One reading leads the display astray and the other one tells; near an end of the range its limit comes first.
const APART: &[Symptom] = &[Symptom::DisplaySensorsDiffer, Symptom::DisplayLimit];
const LIMIT: &[Symptom] = &[Symptom::DisplayLimit];
/// A step shows at once, the difference that it leaves later.
const STEP: &[Symptom] = &[Symptom::ReadingJump];
const DISPLAY_STEP: &[Fault] = &[Fault::DisplayJump, Fault::DisplayHot, Fault::DisplayCold];
const CHECK_STEP: &[Fault] = &[Fault::CheckJump, Fault::DisplayHot, Fault::DisplayCold];
/// A drift that begins amid the self-test's pulse looks like too little of an answer, or the other way round; one that the
/// tile just about follows, like another tile.
const DRIFTED: &[Fault] = &[
    Fault::DisplaysApart,
    Fault::DisplayHot,
    Fault::DisplayCold,
    Fault::NoResponse,
    Fault::Polarity,
    Fault::UnlikeModel,
];
/// The model of the tile does not go by the second thermistor.
const CHECK_DRIFTED: &[Fault] = &[
    Fault::DisplaysApart,
    Fault::DisplayHot,
    Fault::DisplayCold,
    Fault::NoResponse,
    Fault::Polarity,
];
/// A slow thermistor may show too little of the self-test's pulse, or enough: how slow it was before is the device's.
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

/// Readings that are wrong but possible. A drift of less than 3 K, or of skin and room by less than what tells them
/// apart, cannot be told from another finger or another room, and moves the display by no more than itself.
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
    // The heat of a finger of 54 °C is none that the display sees.
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

/// What a swap shows depends on how far apart both are when it happens, and on what the display does then.
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
/// The sink's own reading steps too, and may be the only one that steps by enough.
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

/// Two thermistors in each other's place.
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

/// The rest of what is converted.
pub const OTHERS: &[FaultCase] = &[
    trips(broken(Kind::ReferenceOff), NOW, &[Fault::Excitation]),
    // The current's reading stands still, too.
    trips(
        broken(Kind::AdcStuck),
        NOW,
        &[Fault::SamplesFrozen, Fault::CurrentHigh, Fault::CurrentLow],
    )
    .at(&[FaultScene::Slew]),
    trips(broken(Kind::ForceOpen), NOW, &[Fault::ForceSensor]),
    // A finger that is not there gives no heat; nearly all of the range, more with a sensor of much gain.
    harmless(valued(Kind::ForceOffset, 10.0))
        .or_trips(&[Fault::UnlikeModel, Fault::ForceSensor])
        .at(&[FaultScene::Cold, FaultScene::Preset, FaultScene::Warm]),
    trips(valued(Kind::ForceOffset, -10.0), NOW, &[Fault::ForceSensor]),
    harmless(valued(Kind::ForceOffset, 1.0)).at(&[FaultScene::Preset]),
    harmless(valued(Kind::ForceOffset, -0.05)),
    // A finger that it hides warms a display whose current is at its limit.
    harmless(broken(Kind::ForceStuck)).or_trips(&[Fault::Polarity]),
];
