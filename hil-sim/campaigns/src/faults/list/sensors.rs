//! Thermistors, force sensor, converter.

use thermal_display::guard::Fault;
use thermal_sim::scene::FaultKind as Kind;
use thermal_sim::scene::Sensor::{Check, Display, Room, Sink, Skin};

use crate::faults::entry::{broken, swapped, thermistor, valued};
use crate::faults::{Entry, Injected, Place, Sign};

const NOW: &[Sign] = &[Sign::Injection];

const fn wire(kind: Kind, of: thermal_sim::scene::Sensor, reasons: &'static [Fault]) -> Entry {
    Entry::trips(thermistor(kind, of, 0.0), NOW, reasons)
}

/// Open, shorted, and stuck in the converter: a reading that repeats itself.
pub const WIRES: &[Entry] = &[
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
const APART: &[Sign] = &[Sign::Apart, Sign::DisplayLimit];
const LIMIT: &[Sign] = &[Sign::DisplayLimit];
/// A step shows at once, the difference that it leaves later.
const STEP: &[Sign] = &[Sign::Jump];
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
const ROOM: &[Sign] = &[Sign::RoomAboveSkin];
const ROOM_ABOVE: &[Fault] = &[Fault::RoomAboveSkin];

const fn drift(of: thermal_sim::scene::Sensor, kelvin: f64) -> Injected {
    thermistor(Kind::ThermistorDrift, of, kelvin)
}

const fn offset(of: thermal_sim::scene::Sensor, kelvin: f64) -> Injected {
    thermistor(Kind::ThermistorOffset, of, kelvin)
}

const fn loose(of: thermal_sim::scene::Sensor) -> Injected {
    thermistor(Kind::ThermistorDetached, of, 20.0)
}

/// Readings that are wrong but possible. A drift of less than 3 K, or of skin and room by less than what tells them
/// apart, cannot be told from another finger or another room, and moves the display by no more than itself.
pub const READINGS: &[Entry] = &[
    Entry::trips(drift(Display, 5.0), APART, DRIFTED),
    Entry::trips(drift(Display, -5.0), APART, DRIFTED).at(&[Place::Warm]),
    Entry::trips(drift(Check, 5.0), APART, CHECK_DRIFTED),
    Entry::trips(drift(Check, -5.0), APART, CHECK_DRIFTED),
    Entry::trips(drift(Display, 2.9), LIMIT, BEYOND).at(&[Place::Cold]),
    Entry::trips(drift(Display, -2.9), LIMIT, BEYOND).at(&[Place::Warm]),
    Entry::trips(drift(Sink, 5.0), &[Sign::SinkLimit], &[Fault::SinkHot]),
    Entry::harmless(drift(Sink, -5.0)),
    Entry::harmless(drift(Skin, 5.0)),
    Entry::harmless(drift(Skin, -3.0)),
    Entry::trips(drift(Skin, -20.0), ROOM, ROOM_ABOVE),
    Entry::harmless(drift(Room, 5.0)),
    Entry::harmless(drift(Room, -5.0)),
    Entry::trips(drift(Room, 20.0), ROOM, ROOM_ABOVE),
    Entry::trips(offset(Display, 5.0), STEP, DISPLAY_STEP),
    Entry::trips(offset(Display, -5.0), STEP, DISPLAY_STEP).at(&[Place::Warm]),
    Entry::trips(offset(Display, 1.0), STEP, DISPLAY_STEP),
    Entry::trips(offset(Check, 5.0), STEP, CHECK_STEP),
    Entry::trips(offset(Check, -5.0), STEP, CHECK_STEP),
    Entry::trips(offset(Sink, 5.0), STEP, &[Fault::SinkJump, Fault::SinkHot]),
    Entry::trips(offset(Sink, -5.0), STEP, &[Fault::SinkJump]),
    // The heat of a finger of 54 °C is none that the display sees.
    Entry::trips(
        offset(Skin, 20.0),
        &[Sign::Dose],
        &[Fault::Dose, Fault::UnlikeModel],
    )
    .at(&[Place::Touched])
    .watched(180.0),
    Entry::trips(offset(Skin, -20.0), ROOM, ROOM_ABOVE),
    Entry::trips(
        loose(Display),
        &[Sign::Apart, Sign::DisplayLimit, Sign::WrongWay],
        DRIFTED,
    )
    .at(&[Place::Slew, Place::Replace]),
    Entry::trips(loose(Check), APART, LOOSE).at(&[Place::Slew, Place::Replace]),
    Entry::harmless(loose(Sink)).at(&[Place::Cold]),
    Entry::harmless(loose(Skin)),
    Entry::harmless(loose(Room)),
];

/// What a swap shows depends on how far apart both are when it happens, and on what the display does then.
const SWAP: &[Sign] = &[
    Sign::Jump,
    Sign::Apart,
    Sign::WrongWay,
    Sign::RoomAboveSkin,
    Sign::SelfTest(0.504),
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
const NO_STEP: &[Sign] = &[Sign::Jump, Sign::RoomAboveSkin];

/// Two thermistors in each other's place.
pub const SWAPPED: &[Entry] = &[
    Entry::harmless(swapped(Display, Check)),
    Entry::trips(swapped(Display, Sink), SWAP, ON_SINK).at(&[Place::Off, Place::Slew]),
    Entry::trips(swapped(Display, Skin), SWAP, ELSEWHERE).at(&[Place::Off, Place::Touched]),
    Entry::trips(swapped(Display, Room), SWAP, ELSEWHERE).at(&[Place::Off, Place::Slew]),
    Entry::trips(swapped(Check, Sink), SWAP, ON_SINK).at(&[Place::Off]),
    Entry::trips(swapped(Check, Skin), SWAP, ELSEWHERE).at(&[Place::Off]),
    Entry::trips(swapped(Check, Room), SWAP, ELSEWHERE).at(&[Place::Off]),
    Entry::trips(
        swapped(Sink, Skin),
        NO_STEP,
        &[Fault::SinkJump, Fault::RoomAboveSkin],
    ),
    Entry::trips(
        swapped(Sink, Room),
        NO_STEP,
        &[Fault::SinkJump, Fault::RoomAboveSkin],
    ),
    Entry::trips(swapped(Skin, Room), NO_STEP, &[Fault::RoomAboveSkin]),
];

/// The rest of what is converted.
pub const OTHERS: &[Entry] = &[
    Entry::trips(broken(Kind::ReferenceOff), NOW, &[Fault::Excitation]),
    // The current's reading stands still, too.
    Entry::trips(
        broken(Kind::AdcStuck),
        NOW,
        &[Fault::SamplesFrozen, Fault::CurrentHigh, Fault::CurrentLow],
    )
    .at(&[Place::Slew]),
    Entry::trips(broken(Kind::ForceOpen), NOW, &[Fault::ForceSensor]),
    // A finger that is not there gives no heat; nearly all of the range, more with a sensor of much gain.
    Entry::harmless(valued(Kind::ForceOffset, 10.0))
        .or_trips(&[Fault::UnlikeModel, Fault::ForceSensor])
        .at(&[Place::Cold, Place::Preset, Place::Warm]),
    Entry::trips(valued(Kind::ForceOffset, -10.0), NOW, &[Fault::ForceSensor]),
    Entry::harmless(valued(Kind::ForceOffset, 1.0)).at(&[Place::Preset]),
    Entry::harmless(valued(Kind::ForceOffset, -0.05)),
    // A finger that it hides warms a display whose current is at its limit.
    Entry::harmless(broken(Kind::ForceStuck)).or_trips(&[Fault::Polarity]),
];
