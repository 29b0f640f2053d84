//! The index of a finger, as a type.

/// Index of one of the `FINGERS` fingers of a device, counted from 0.
///
/// A value with an index of `FINGERS` or more cannot be constructed, so no index can select a finger that does not
/// exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FingerIndex<const FINGERS: usize>(u8);

impl<const FINGERS: usize> FingerIndex<FINGERS> {
    /// The finger with index 0. This constant does not compile for a device without fingers or with more than ten,
    /// because a finger's address is one digit.
    pub const FIRST: Self = {
        assert!(0 < FINGERS && FINGERS <= 10, "the number of a finger is one digit");
        Self(0)
    };

    /// The finger with this index, counted from 0; `None` if the index is not below `FINGERS`.
    pub const fn new(index: usize) -> Option<Self> {
        if index < FINGERS { Some(Self(index as u8)) } else { None }
    }

    /// All fingers of the device, in the order of their indices from 0.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..FINGERS).filter_map(Self::new)
    }

    /// The finger with the next higher index, and finger 0 after the last one: the cyclic order in which the board
    /// samples the fingers and runs their ticks.
    pub const fn next_cyclic(self) -> Self {
        match Self::new(self.index() + 1) {
            Some(next) => next,
            None => Self::FIRST,
        }
    }

    /// Index of the finger, 0 to `FINGERS` - 1, for arrays with an element per finger.
    pub const fn index(self) -> usize {
        // The remainder does not change the index, but lets the compiler omit the bounds check of an array of `FINGERS`
        // elements.
        self.index_u8() as usize % FINGERS
    }

    /// Index of the finger as a byte, 0 to `FINGERS` - 1. In lines to and from the host this index is the digit after
    /// `@`.
    pub const fn index_u8(self) -> u8 {
        self.0
    }

    /// Index of this finger at the start of its telemetry lines, and of its replies to a command that names no finger,
    /// as in `@3 `. `None` on a device with a single finger, where these lines begin without an index.
    pub const fn index_unless_single_finger(self) -> Option<u8> {
        if FINGERS > 1 { Some(self.0) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::FingerIndex;

    #[test]
    fn a_finger_exists_for_each_index_below_the_number_of_fingers() {
        for index in [0, 1, 4] {
            assert_eq!(FingerIndex::<5>::new(index).map(FingerIndex::index), Some(index));
        }
        for index in [5, 256, usize::MAX] {
            assert_eq!(FingerIndex::<5>::new(index), None);
        }
        let all: Vec<_> = FingerIndex::<5>::all().map(FingerIndex::index).collect();
        assert_eq!(all, [0, 1, 2, 3, 4]);
    }

    #[test]
    fn the_finger_after_the_last_is_the_first() {
        let all: Vec<_> = FingerIndex::<5>::all().collect();
        for (n, finger) in all.iter().enumerate() {
            assert_eq!(finger.next_cyclic(), all[(n + 1) % 5]);
        }
        assert_eq!(FingerIndex::<1>::FIRST.next_cyclic(), FingerIndex::FIRST);
    }
}
