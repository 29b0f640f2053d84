//! Books of energy.

/// What has crossed the tile's borders so far, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Electrical work taken up, ripple included.
    pub electrical_j: f64,
    /// Heat given by the finger.
    pub from_finger_j: f64,
    /// Heat given to the room and to the coolant.
    pub to_room_j: f64,
}

/// Sums of many small parts, each with what rounding has left of it (Neumaier).
#[derive(Clone, Copy, Debug, Default)]
pub struct Ledger {
    electrical: Sum,
    from_finger: Sum,
    to_room: Sum,
}

impl Ledger {
    /// Adds what crossed in a step.
    pub fn add(&mut self, step: &Energy) {
        self.electrical.add(step.electrical_j);
        self.from_finger.add(step.from_finger_j);
        self.to_room.add(step.to_room_j);
    }

    /// What has crossed so far.
    #[must_use]
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
    left: f64,
}

impl Sum {
    fn add(&mut self, part: f64) {
        let sum = self.value + part;
        self.left += if self.value.abs() >= part.abs() {
            (self.value - sum) + part
        } else {
            (part - sum) + self.value
        };
        self.value = sum;
    }

    fn value(&self) -> f64 {
        self.value + self.left
    }
}
