//! What is connected at the beginning of stages, as lines to the surroundings of an emulated board.

/// Powered, emergency stop pressed, 10 kΩ in place of each thermistor.
pub const COLD: &[&str] = &[
    "press stop",
    "fit usb",
    "fit supply",
    "fit load-cell",
    "fit resistor display 10000",
    "fit resistor check 10000",
    "fit resistor sink 10000",
    "fit resistor skin 10000",
    "fit resistor room 10000",
];

/// The same with the emergency stop released.
pub const ON: &[&str] = &[
    "press stop",
    "fit usb",
    "fit supply",
    "fit load-cell",
    "fit resistor display 10000",
    "fit resistor check 10000",
    "fit resistor sink 10000",
    "fit resistor skin 10000",
    "fit resistor room 10000",
    "release stop",
];

/// Powered, with tile and thermistors.
pub const TILE: &[&str] = &[
    "press stop",
    "fit usb",
    "fit supply",
    "fit load-cell",
    "fit tile",
    "fit thermistors",
    "release stop",
];
