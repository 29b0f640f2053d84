//! From converter counts to temperatures, force and current.

/// Signals of one finger, in the order in which the converter scans them.
pub const CHANNELS: usize = 7;

/// Scans that are summed into the [`Samples`] of one control tick.
pub const SCANS_PER_TICK: usize = 16;

/// One scan: a 12-bit count per channel, in the order of the fields of [`Samples`].
pub type Scan = [u16; CHANNELS];

/// What one control tick knows: sums of [`SCANS_PER_TICK`] 12-bit conversions (0..=65520) per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Samples {
    /// Display thermistor, in the contact patch.
    pub display: u16,
    /// Second display thermistor, which also feeds the independent comparator.
    pub display_check: u16,
    /// Thermistor on the sink.
    pub sink: u16,
    /// Thermistor on the skin, at the edge of the contact.
    pub skin: u16,
    /// Thermistor in the room.
    pub room: u16,
    /// Force sensor.
    pub force: u16,
    /// Current mirror of the bridge.
    pub current: u16,
    /// The bridge driver pulls its fault pin.
    pub bridge_fault: bool,
}

impl Samples {
    /// Sums the scans of one tick.
    #[must_use]
    pub fn from_scans(scans: &[Scan; SCANS_PER_TICK], bridge_fault: bool) -> Self {
        let mut sum = [0u16; CHANNELS];
        for scan in scans {
            for (s, &count) in sum.iter_mut().zip(scan) {
                *s = s.saturating_add(count & 0x0fff);
            }
        }
        let [display, display_check, sink, skin, room, force, current] = sum;
        Self {
            display,
            display_check,
            sink,
            skin,
            room,
            force,
            current,
            bridge_fault,
        }
    }
}
