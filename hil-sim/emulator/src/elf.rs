//! The firmware image: loadable contents and symbols of an ELF file for this chip.
use object::read::elf::{ElfFile32, FileHeader, ProgramHeader};
use object::{Endianness, Object, ObjectSymbol, SymbolKind, elf};
use std::path::Path;
use thermal_client::text;

/// First address of the main flash.
pub const FLASH_BASE: u32 = 0x0800_0000;
/// Main flash of the STM32F446RE, bytes.
pub const FLASH_SIZE: u32 = 512 * 1024;
/// First address of SRAM1; SRAM2 follows it without a gap.
pub const RAM_BASE: u32 = 0x2000_0000;
/// SRAM1 and SRAM2 of the STM32F446RE, bytes.
pub const RAM_SIZE: u32 = 128 * 1024;

/// Why a file is not an image for this chip.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The file could not be read.
    #[error("cannot be read: {0}")]
    Unreadable(std::io::Error),
    /// Not an ELF file, or a truncated one.
    #[error("not a complete 32-bit little-endian ELF file: {0}")]
    NotElf(String),
    /// Compiled for another processor.
    #[error("the ELF is for machine {found} ({name}), not for ARM (40)")]
    Machine {
        /// `e_machine` of the file.
        found: u16,
        /// Its usual name.
        name: &'static str,
    },
    /// Contents for an address where this chip has no flash.
    #[error(
        "segment at {address:#010x}..{end:#010x} does not fit the flash at 0x08000000..0x08080000 (STM32F446RE)"
    )]
    Segment {
        /// First load address.
        address: u32,
        /// One past the last.
        end: u64,
    },
    /// Nothing to load.
    #[error("the ELF has no loadable contents")]
    Empty,
    /// The first word of the vector table is not a stack for this chip.
    #[error(
        "initial stack pointer {0:#010x} is outside the RAM at 0x20000000..0x20020000 (STM32F446RE) or not a multiple of 8"
    )]
    StackPointer(u32),
    /// The second word of the vector table is no Thumb address in flash.
    #[error("reset vector {0:#010x} is not a Thumb address in the flash at 0x08000000..0x08080000")]
    ResetVector(u32),
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Function {
    start: u32,
    end: u32,
    name: String,
}

/// A parsed image.
#[derive(Debug, Clone)]
pub struct Firmware {
    flash: Vec<u8>,
    functions: Vec<Function>,
    symbols: Vec<(String, u32)>,
    initial_sp: u32,
}

impl Firmware {
    /// Reads an ELF file.
    ///
    /// # Errors
    /// The file cannot be read, or is not an image for the STM32F446RE.
    pub fn from_file(path: &Path) -> Result<Self, ImageError> {
        let bytes =
            text::read_bytes(path, text::TABLE_BYTES_MAX).map_err(ImageError::Unreadable)?;
        Self::from_elf(&bytes)
    }

    /// Parses the contents of an ELF file.
    ///
    /// # Errors
    /// The file is truncated or for another processor, or its contents do not fit the chip's memories.
    pub fn from_elf(bytes: &[u8]) -> Result<Self, ImageError> {
        check_header(bytes)?;
        let not_elf = |e: object::Error| ImageError::NotElf(e.to_string());
        let file: ElfFile32<'_, Endianness> = ElfFile32::parse(bytes).map_err(not_elf)?;
        let endian = file.endian();
        let mut flash = vec![0xff; FLASH_SIZE as usize];
        let mut loaded = false;
        for segment in file.elf_program_headers() {
            let address = segment.p_paddr(endian);
            let size = segment.p_filesz(endian);
            if segment.p_type(endian) != elf::PT_LOAD || size == 0 {
                continue;
            }
            let contents = segment.data(endian, bytes).map_err(|()| {
                ImageError::NotElf(format!(
                    "contents of the segment at {address:#010x} are missing"
                ))
            })?;
            let start = address.wrapping_sub(FLASH_BASE) as usize;
            flash
                .get_mut(start..start.saturating_add(contents.len()))
                .ok_or(ImageError::Segment { address, end: u64::from(address) + u64::from(size) })?
                .copy_from_slice(contents);
            loaded = true;
        }
        if !loaded {
            return Err(ImageError::Empty);
        }
        let word =
            |o: usize| u32::from_le_bytes([flash[o], flash[o + 1], flash[o + 2], flash[o + 3]]);
        let (initial_sp, reset) = (word(0), word(4));
        if !(RAM_BASE + 8..=RAM_BASE + RAM_SIZE).contains(&initial_sp)
            || !initial_sp.is_multiple_of(8)
        {
            return Err(ImageError::StackPointer(initial_sp));
        }
        if reset & 1 == 0 || !(FLASH_BASE..FLASH_BASE + FLASH_SIZE).contains(&reset) {
            return Err(ImageError::ResetVector(reset));
        }
        let mut functions = Vec::new();
        let mut symbols = Vec::new();
        for symbol in file.symbols() {
            let (Ok(name), Ok(address)) = (symbol.name(), u32::try_from(symbol.address())) else {
                continue;
            };
            if symbol.kind() == SymbolKind::Text && symbol.size() > 0 {
                let start = address & !1;
                let end = start.saturating_add(u32::try_from(symbol.size()).unwrap_or(u32::MAX));
                functions.push(Function {
                    start,
                    end,
                    name: format!("{:#}", rustc_demangle::demangle(name)),
                });
            }
            if !name.is_empty() {
                symbols.push((name.to_owned(), address));
            }
        }
        functions.sort_by_key(|f| f.start);
        symbols.sort();
        Ok(Self { flash, functions, symbols, initial_sp })
    }

    /// The whole flash; 0xff outside the image's contents.
    pub fn flash(&self) -> &[u8] {
        &self.flash
    }

    /// First word of the vector table.
    pub fn initial_sp(&self) -> u32 {
        self.initial_sp
    }

    /// Value of a linker or object symbol by its name in the file.
    pub fn symbol(&self, name: &str) -> Option<u32> {
        let at = self.symbols.binary_search_by(|(n, _)| n.as_str().cmp(name)).ok()?;
        self.symbols.get(at).map(|(_, address)| *address)
    }

    /// Name of the function with the instruction at `pc`; `?` if no symbol covers it.
    pub fn function_at(&self, pc: u32) -> &str {
        let after = self.functions.partition_point(|f| f.start <= pc);
        self.functions[..after].iter().rev().find(|f| pc < f.end).map_or("?", |f| f.name.as_str())
    }
}

/// Checks for a 32-bit little-endian ARM file; the error names another processor.
fn check_header(bytes: &[u8]) -> Result<(), ImageError> {
    if bytes.len() < 20 || bytes[..4] != elf::ELFMAG {
        return Err(ImageError::NotElf("no ELF header".into()));
    }
    let little = elf::DataEncoding(bytes[5]) == elf::ELFDATA2LSB;
    let machine = [bytes[18], bytes[19]];
    let found = if little { u16::from_le_bytes(machine) } else { u16::from_be_bytes(machine) };
    if elf::Machine(found) != elf::EM_ARM {
        let name = match elf::Machine(found) {
            elf::EM_386 => "x86",
            elf::EM_X86_64 => "x86-64",
            elf::EM_AARCH64 => "AArch64",
            elf::EM_RISCV => "RISC-V",
            elf::EM_AVR => "AVR",
            elf::EM_XTENSA => "Xtensa",
            _ => "another processor",
        };
        return Err(ImageError::Machine { found, name });
    }
    let header: &elf::FileHeader32<Endianness> =
        elf::FileHeader32::parse(bytes).map_err(|e| ImageError::NotElf(e.to_string()))?;
    header.endian().map_err(|e| ImageError::NotElf(e.to_string()))?;
    if !little { Err(ImageError::NotElf("big-endian ARM".into())) } else { Ok(()) }
}
