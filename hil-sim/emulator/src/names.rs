//! Names of registers for messages: address to `PERIPHERAL_REGISTER` (RM0390 memory map and register maps).

use std::collections::HashMap;
use std::sync::LazyLock;

use serde::Deserialize;

/// What `names.toml` holds.
#[derive(Deserialize)]
struct Map {
    /// By ascending address.
    peripherals: Vec<Peripheral>,
    /// Offset of each register, by group and name.
    registers: HashMap<String, HashMap<String, u32>>,
}

/// A peripheral. The next one's address bounds it.
#[derive(Deserialize)]
struct Peripheral {
    base: u32,
    /// None in a reserved range.
    #[serde(default)]
    name: Option<String>,
    /// Group of its registers, if their names are known.
    #[serde(default)]
    registers: Option<String>,
}

static MAP: LazyLock<Map> =
    LazyLock::new(|| toml::from_str(include_str!("names.toml")).expect("names.toml"));

fn find(address: u32) -> Option<(&'static Peripheral, &'static str)> {
    let after = (MAP.peripherals).partition_point(|peripheral| peripheral.base <= address);
    let found = MAP.peripherals.get(after.checked_sub(1)?)?;
    Some((found, found.name.as_deref()?))
}

/// Name of the peripheral at an address; `None` in reserved ranges, where silicon answers with a bus error.
pub(crate) fn peripheral(address: u32) -> Option<&'static str> {
    find(address).map(|(_, name)| name)
}

/// Name of the register at an address.
pub(crate) fn register(address: u32) -> String {
    let Some((peripheral, name)) = find(address) else {
        return format!("{address:#010x}");
    };
    let offset = (address - peripheral.base) & !3;
    let group = peripheral.registers.as_ref().map(|group| &MAP.registers[group]);
    match group.and_then(|group| group.iter().find(|(_, at)| **at == offset)) {
        Some((register, _)) => format!("{name}_{register}"),
        None => format!("{name}+{offset:#x}"),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn the_map_ascends_and_names_registers() {
        assert!((MAP.peripherals).is_sorted_by(|one, next| one.base < next.base));
        assert_eq!(register(0x4001_2304), "ADC_COMMON_CCR");
        assert_eq!(register(0x4002_64b8), "DMA2_S7CR");
        assert_eq!(register(0x4001_300c), "SPI1+0xc");
        assert_eq!(peripheral(0x4002_2800), None);
    }

    #[test]
    fn every_group_of_registers_exists_and_belongs_to_a_peripheral() {
        let groups = MAP.peripherals.iter().filter_map(|row| row.registers.as_ref());
        let named: HashSet<_> = groups.collect();
        assert_eq!(named, MAP.registers.keys().collect());
    }

    #[test]
    fn offsets_are_words_and_no_two_registers_of_a_group_share_one() {
        for (group, registers) in &MAP.registers {
            let offsets: HashSet<_> = registers.values().collect();
            assert_eq!(offsets.len(), registers.len(), "{group}");
            assert!(registers.values().all(|offset| offset.is_multiple_of(4)), "{group}");
        }
    }
}
