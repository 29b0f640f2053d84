//! The index of a finger, as a type.

/// Selects one of the `FINGERS` fingers of a device, by an index that is counted from 0.
///
/// Its index is below `FINGERS` by construction, so an index that is out of range cannot select
/// another finger's station or bridge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Finger<const FINGERS: usize>(u8);

impl<const FINGERS: usize> Finger<FINGERS> {
    /// The finger with index 0, which every device has. Compiling fails for no finger and for more than ten.
    pub const FIRST: Self = {
        assert!(
            0 < FINGERS && FINGERS <= 10,
            "the number of a finger is one digit"
        );
        Self(0)
    };

    /// The finger with this index, counted from 0; `None` if the device has fewer fingers.
    #[must_use]
    pub const fn new(index: usize) -> Option<Self> {
        if index < FINGERS {
            Some(Self(index as u8))
        } else {
            None
        }
    }

    /// All fingers of the device, from index 0 upwards.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..FINGERS).filter_map(Self::new)
    }

    /// The finger with the next higher index, and finger 0 after the last one: the order in which their
    /// ticks take turns.
    #[must_use]
    pub const fn next_cyclic(self) -> Self {
        match Self::new(self.index() + 1) {
            Some(next) => next,
            None => Self::FIRST,
        }
    }

    /// Index of the finger, 0 to `FINGERS` - 1, for arrays with an element per finger.
    #[must_use]
    pub const fn index(self) -> usize {
        // The remainder changes nothing. It tells the compiler that an array of `FINGERS` elements
        // needs no bounds check.
        self.number() as usize % FINGERS
    }

    /// Index of the finger as a byte, 0 to 9: the digit after `@` in lines to and from the host.
    #[must_use]
    pub const fn number(self) -> u8 {
        self.0
    }

    /// Index with which the finger's replies and telemetry begin when the host has named no finger;
    /// `None` on a device with a single finger, whose lines name none.
    #[must_use]
    pub const fn reply_address(self) -> Option<u8> {
        if FINGERS > 1 { Some(self.0) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::Finger;

    #[test]
    fn a_finger_exists_for_each_index_below_the_number_of_fingers() {
        for index in [0, 1, 4] {
            assert_eq!(Finger::<5>::new(index).map(Finger::index), Some(index));
        }
        for index in [5, 256, usize::MAX] {
            assert_eq!(Finger::<5>::new(index), None);
        }
        let all: Vec<_> = Finger::<5>::all().map(Finger::index).collect();
        assert_eq!(all, [0, 1, 2, 3, 4]);
    }

    #[test]
    fn the_finger_after_the_last_is_the_first() {
        let all: Vec<_> = Finger::<5>::all().collect();
        for (n, finger) in all.iter().enumerate() {
            assert_eq!(finger.next_cyclic(), all[(n + 1) % 5]);
        }
        assert_eq!(Finger::<1>::FIRST.next_cyclic(), Finger::FIRST);
    }
}
