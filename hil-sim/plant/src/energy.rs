//! Energy balance of the tile.

/// Energy that has crossed the boundaries of the tile, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Electrical energy taken up, ripple included.
    pub electrical_j: f64,
    /// Heat received from the finger.
    pub from_finger_j: f64,
    /// Heat given to the room and to the coolant.
    pub to_room_j: f64,
}

/// Compensated sums (Neumaier) of the energies of all steps, so that the balance closes to rounding.
#[derive(Clone, Copy, Debug, Default)]
pub struct EnergyBalance {
    electrical: Sum,
    from_finger: Sum,
    to_room: Sum,
}

impl EnergyBalance {
    /// Adds the energies of one step.
    pub fn add(&mut self, step: &Energy) {
        self.electrical.add(step.electrical_j);
        self.from_finger.add(step.from_finger_j);
        self.to_room.add(step.to_room_j);
    }

    /// Total energies.
    pub fn total(&self) -> Energy {
        Energy {
            electrical_j: self.electrical.value(),
            from_finger_j: self.from_finger.value(),
            to_room_j: self.to_room.value(),
        }
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    value: f64,
    compensation: f64,
}

impl Sum {
    fn add(&mut self, part: f64) {
        let sum = self.value + part;
        self.compensation += if self.value.abs() >= part.abs() {
            (self.value - sum) + part
        } else {
            (part - sum) + self.value
        };
        self.value = sum;
    }

    fn value(&self) -> f64 {
        self.value + self.compensation
    }
}
