//! The fingers of the device: their states, and their time.

use thermal_client::client::{AvailableFields, Telemetry};
use thermal_device::StateName;

/// What is known of the device's fingers.
#[derive(Clone, Debug, Default)]
pub struct Fingers {
    /// State of each in its last line of telemetry.
    states: Vec<Option<StateName>>,
    /// Fields of telemetry that each has.
    fields: Vec<AvailableFields>,
}

impl Fingers {
    /// The fingers of a device, of which each has these fields of telemetry.
    pub fn new(fields: Vec<AvailableFields>) -> Self {
        Self { states: vec![None; fields.len()], fields }
    }

    /// Their number.
    pub fn count(&self) -> usize {
        self.states.len()
    }

    /// The fields of telemetry that a finger has.
    pub fn fields(&self, finger: u8) -> AvailableFields {
        let fields = self.fields.get(usize::from(finger));
        fields.copied().unwrap_or(AvailableFields::OF_EVERY_LINE)
    }

    /// How a line addresses a finger; a device with one has no addresses.
    pub fn address(&self, finger: u8) -> Option<u8> {
        (self.count() > 1).then_some(finger)
    }

    /// Forgets the states, which lines that are sent now may change.
    pub fn forget_states(&mut self) {
        self.states.fill(None);
    }

    /// Takes note of a line of telemetry of a finger.
    pub fn received(&mut self, finger: usize, telemetry: &Telemetry) {
        if let Some(state) = self.states.get_mut(finger) {
            *state = Some(telemetry.state);
        }
    }

    /// The state of a finger; `None` if it is not known yet.
    pub fn state(&self, finger: u8) -> Option<StateName> {
        self.states.get(usize::from(finger)).copied().flatten()
    }
}
