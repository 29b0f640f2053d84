//! Flash and RAM that an image uses.
use anyhow::{Context, Result, bail};
use object::elf::{SHF_ALLOC, SHT_NOBITS};
use object::{Architecture, Object, ObjectSection, SectionFlags};

/// One region of the linker script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    origin: u64,
    /// In bytes.
    length: u64,
}

impl Region {
    fn holds(self, address: u64) -> bool {
        (self.origin..self.origin + self.length).contains(&address)
    }

    fn meets(self, address: u64, bytes: u64) -> bool {
        address < self.origin + self.length && self.origin < address + bytes
    }
}

/// The regions `FLASH`, `RAM` and `SETTINGS`, a part of the flash, of `memory.x`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    flash: Region,
    ram: Region,
    stack: Region,
    settings: Region,
}

impl Memory {
    /// Reads the regions out of a linker script's `MEMORY` block.
    pub fn parse(script: &str) -> Result<Self> {
        let region = |name: &str| {
            let line = script.lines().map(str::trim_start).find(|line| {
                line.strip_prefix(name)
                    .is_some_and(|rest| rest.trim_start().starts_with([':', '(']))
            });
            let line = line.with_context(|| format!("no memory region {name}"))?;
            let value = |key: &str| {
                let rest = line.split_once(key)?.1.trim_start().strip_prefix('=')?;
                number(rest.split(',').next()?.trim())
            };
            let shape = || {
                format!("`{}` is not of the form {name} : ORIGIN = 0x…, LENGTH = …K", line.trim())
            };
            let origin = value("ORIGIN").with_context(shape)?;
            Ok::<_, anyhow::Error>(Region { origin, length: value("LENGTH").with_context(shape)? })
        };
        Ok(Self {
            flash: region("FLASH")?,
            ram: region("RAM")?,
            stack: region("STACK")?,
            settings: region("SETTINGS")?,
        })
    }
}

/// A number as linker scripts write it: hexadecimal with `0x`, `K` or `M` for 2^10 or 2^20.
fn number(text: &str) -> Option<u64> {
    if let Some(hex) = text.strip_prefix("0x") {
        return u64::from_str_radix(hex, 16).ok();
    }
    let (digits, unit) = match text.strip_suffix('K') {
        Some(digits) => (digits, 1 << 10),
        None => text.strip_suffix('M').map_or((text, 1), |digits| (digits, 1 << 20)),
    };
    digits.trim().parse::<u64>().ok()?.checked_mul(unit)
}

/// A section that is loaded or reserved in memory.
struct Section {
    name: String,
    address: u64,
    size: u64,
    /// Its contents are stored in flash; otherwise it is zeroed or left uninitialised at the start.
    stored: bool,
}

/// Bytes of flash, and of RAM without the stack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    flash: u64,
    ram: u64,
}

impl Usage {
    /// Adds up the sections of an ELF file for an Arm core.
    pub fn of_elf(elf: &[u8], memory: &Memory) -> Result<Self> {
        let file = object::read::elf::ElfFile32::<object::Endianness>::parse(elf)
            .context("not a 32-bit ELF file")?;
        if file.architecture() != Architecture::Arm {
            bail!("an image for {:?}, not for Arm", file.architecture());
        }
        let mut sections = Vec::new();
        for section in file.sections() {
            let SectionFlags::Elf { sh_flags, sh_type } = section.flags() else {
                continue;
            };
            if !sh_flags.contains(SHF_ALLOC) || section.size() == 0 {
                continue;
            }
            sections.push(Section {
                name: section.name()?.into(),
                address: section.address(),
                size: section.size(),
                stored: sh_type != SHT_NOBITS,
            });
        }
        Self::of_sections(&sections, memory)
    }

    fn of_sections(sections: &[Section], memory: &Memory) -> Result<Self> {
        let mut usage = Self::default();
        for Section { name, address, size, stored } in sections {
            let in_ram = memory.ram.holds(*address);
            if !in_ram && !memory.flash.holds(*address) {
                bail!("section {name} at {address:#010x} lies neither in FLASH nor in RAM");
            }
            if memory.settings.meets(*address, *size) {
                bail!("section {name} at {address:#010x} lies where the settings are");
            }
            usage.flash += if *stored { *size } else { 0 };
            usage.ram += if in_ram { *size } else { 0 };
        }
        Ok(usage)
    }

    /// Two lines: used and available bytes of flash and RAM.
    pub fn against(&self, memory: &Memory) -> String {
        let line = |used: u64, length: u64| {
            let percent = 100.0 * used as f64 / length as f64;
            format!("{used:>7} of {length} bytes ({percent:.1} % of {} KiB)", length >> 10)
        };
        format!(
            "flash  {}, without the settings'\nRAM    {}, beside the stack's {} KiB",
            line(self.flash, memory.flash.length - memory.settings.length),
            line(self.ram, memory.ram.length),
            memory.stack.length >> 10
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// RM0390 table 1 and section 2: 512 KiB from 0x0800_0000, of them sectors 1 to 3 of 16 KiB (table 4), 112 + 16 KiB from 0x2000_0000, of them one half each for the stack and the rest.
    const F446RE: Memory = Memory {
        flash: Region { origin: 0x0800_0000, length: 524_288 },
        ram: Region { origin: 0x2001_0000, length: 65_536 },
        stack: Region { origin: 0x2000_0000, length: 65_536 },
        settings: Region { origin: 0x0800_4000, length: 49_152 },
    };

    #[test]
    fn the_workspace_describes_the_microcontroller() {
        let script = std::fs::read_to_string(crate::process::workspace().join("memory.x")).unwrap();
        assert_eq!(Memory::parse(&script).unwrap(), F446RE);
    }

    #[test]
    fn an_error_in_the_linker_script_is_reported_with_its_line() {
        let cases = [
            ("FLASH : ORIGIN = 0x08000000, LENGTH = 512K", "no memory region RAM"),
            ("FLASH : ORIGIN = here, LENGTH = 512K\nRAM : ORIGIN = 0, LENGTH = 1", "ORIGIN = here"),
            ("FLASH : ORIGIN = 0x0, LENGTH = 5Q\nRAM : ORIGIN = 0, LENGTH = 1", "LENGTH = 5Q"),
        ];
        for (script, part) in cases {
            let error = Memory::parse(script).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }

    fn section(name: &str, address: u64, size: u64, stored: bool) -> Section {
        Section { name: name.into(), address, size, stored }
    }

    #[test]
    fn initialised_data_counts_in_flash_and_ram_and_zeroed_data_in_ram_only() {
        let sections = [
            section(".vector_table", 0x0800_0000, 0x1c4, true),
            section(".text", 0x0801_0000, 1000, true),
            section(".rodata", 0x0801_0400, 200, true),
            section(".data", 0x2001_0000, 30, true),
            section(".bss", 0x2001_0020, 4, false),
            section(".uninit", 0x2001_0024, 1024, false),
        ];
        let usage = Usage::of_sections(&sections, &F446RE).unwrap();
        assert_eq!(usage, Usage { flash: 452 + 1000 + 200 + 30, ram: 30 + 4 + 1024 });
        let text = usage.against(&F446RE);
        assert!(text.contains("1682 of 475136 bytes (0.4 % of 464 KiB)"), "{text}");
    }

    #[test]
    fn a_section_in_the_settings_sectors_is_an_error() {
        for (address, size) in [(0x0800_3ffc, 8), (0x0800_fffc, 4), (0x0800_0000, 0x1_0000)] {
            let error =
                Usage::of_sections(&[section(".text", address, size, true)], &F446RE).unwrap_err();
            assert!(error.to_string().contains("where the settings are"), "{error}");
        }
        let beside = [section(".vector_table", 0x0800_0000, 0x4000, true)];
        assert!(Usage::of_sections(&beside, &F446RE).is_ok());
    }

    #[test]
    fn sections_of_another_chip_are_named() {
        let error = Usage::of_sections(&[section(".ccm", 0x1000_0000, 8, false)], &F446RE)
            .unwrap_err()
            .to_string();
        assert!(error.contains(".ccm at 0x10000000"), "{error}");
        let host = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        assert!(Usage::of_elf(&host, &F446RE).is_err());
    }
}
