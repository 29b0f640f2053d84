//! Voltage of the bridge's supply.

/// Voltage of the bridge's supply behind the switch that the comparator opens. Kept in the unit of the sum of 16
/// conversions, so that a tick compares it with limits without a conversion to volts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct SupplyVoltage(u16);

/// Sum of 16 conversions per volt of the supply: 65536 at 3.3 V of the pin, behind a divider of 33 and 10 kΩ.
const SUM_PER_VOLT: f64 = 65536.0 / 3.3 * 10.0 / (33.0 + 10.0);

impl SupplyVoltage {
    /// No voltage.
    pub const ZERO: Self = Self(0);

    /// The voltage that a sum of 16 conversions stands for.
    pub const fn from_sum(sum: u16) -> Self {
        Self(sum)
    }

    /// A voltage of 0 to 14.19 V. For limits, at compile time.
    pub const fn from_volts(volts: f64) -> Self {
        Self((volts * SUM_PER_VOLT) as u16)
    }

    /// The voltage in tenths of a volt, rounded, 0 to 142.
    pub const fn decivolts(self) -> u32 {
        /// Tenths of a volt per unit of the sum, in units of 2^-32.
        const DECIVOLTS_PER_SUM: u64 = ((1u64 << 32) as f64 * 10.0 / SUM_PER_VOLT) as u64;
        ((self.0 as u64 * DECIVOLTS_PER_SUM + (1 << 31)) >> 32) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::SupplyVoltage;

    /// 12 V are 2.7907 V at the pin, 3463.9 of 4096 counts.
    #[test]
    fn twelve_volts_are_3464_counts() {
        assert_eq!(SupplyVoltage::from_sum(16 * 3464).decivolts(), 120);
        assert_eq!(SupplyVoltage::from_sum(u16::MAX).decivolts(), 142);
        assert!(SupplyVoltage::from_volts(12.0) < SupplyVoltage::from_sum(16 * 3464));
        assert!(SupplyVoltage::from_volts(12.0) > SupplyVoltage::from_sum(16 * 3463));
    }
}
