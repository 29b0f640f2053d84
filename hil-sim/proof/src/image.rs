//! The image's machine code: functions, vector table, and words that may be addresses of functions.
use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, Result, bail};
use object::read::elf::ElfFile32;
use object::{Endianness, Object, ObjectSection, ObjectSymbol, SymbolKind};

use crate::thumb::{Effect, Instruction, decode};

/// Words of an Armv7-M vector table before the interrupts: the stack pointer and 15 exceptions of the processor.
const PROCESSOR: [&str; 16] = [
    "",
    "Reset",
    "NMI",
    "HardFault",
    "MemManage",
    "BusFault",
    "UsageFault",
    "",
    "",
    "",
    "",
    "SVCall",
    "DebugMonitor",
    "",
    "PendSV",
    "SysTick",
];

/// A section with contents in memory.
struct Contents {
    address: u32,
    bytes: Vec<u8>,
    code: bool,
}

/// A function by its symbol.
#[derive(Clone, Debug)]
pub struct Function {
    /// First address, without the Thumb bit.
    pub start: u32,
    /// Address after the last one.
    pub end: u32,
    /// Demangled name, without a hash.
    pub name: String,
}

/// A parsed image.
pub struct Image {
    contents: Vec<Contents>,
    functions: BTreeMap<u32, Function>,
    symbols: BTreeMap<String, u32>,
    /// Ranges of constants between instructions: start and end.
    constants: Vec<(u32, u32)>,
    taken: BTreeSet<u32>,
}

impl Image {
    /// Parses an ELF file for an Arm core, with its symbols.
    ///
    /// # Errors
    /// The file is no ELF file for Arm, or a function lies outside of its sections.
    pub fn parse(elf: &[u8]) -> Result<Self> {
        let file = ElfFile32::<Endianness>::parse(elf).context("not a 32-bit ELF file")?;
        let mut contents = Vec::new();
        for section in file.sections() {
            let bytes = section.data()?;
            if section.address() != 0 && !bytes.is_empty() {
                contents.push(Contents {
                    address: u32::try_from(section.address())?,
                    bytes: bytes.to_vec(),
                    code: section.kind() == object::SectionKind::Text,
                });
            }
        }
        let mut image = Self {
            contents,
            functions: BTreeMap::new(),
            symbols: BTreeMap::new(),
            constants: Vec::new(),
            taken: BTreeSet::new(),
        };
        image.read_symbols(&file)?;
        image.read_addresses();
        Ok(image)
    }

    fn read_symbols(&mut self, file: &ElfFile32<'_, Endianness>) -> Result<()> {
        let mut marks = BTreeMap::new();
        let mut sized = BTreeMap::<u32, (u32, String)>::new();
        for symbol in file.symbols() {
            let (name, address) = (symbol.name()?, u32::try_from(symbol.address())?);
            if name.starts_with("$t") || name.starts_with("$d") {
                marks.insert(address, name.starts_with("$d"));
            } else if symbol.kind() == SymbolKind::Text {
                let size = u32::try_from(symbol.size())?;
                let name = format!("{:#}", rustc_demangle::demangle(name));
                let entry = sized.entry(address & !1).or_insert((size, name.clone()));
                entry.0 = entry.0.max(size);
                if entry.1 > name {
                    entry.1 = name;
                }
            }
            if !name.is_empty() {
                self.symbols.insert(name.into(), address);
            }
        }
        if sized.is_empty() {
            bail!("the image has no symbols of functions");
        }
        let starts: Vec<u32> = sized.keys().copied().collect();
        for (place, (start, (size, name))) in sized.into_iter().enumerate() {
            // A function in assembly may have no size; it ends where the next one begins.
            let next = starts.get(place + 1).copied();
            let end = match (size, next) {
                (0, Some(next)) => next,
                (0, None) => bail!("{name}: the last function has no size"),
                (size, _) => start + size,
            };
            self.functions.insert(start, Function { start, end, name });
        }
        let marks: Vec<(u32, bool)> = marks.into_iter().collect();
        for (place, (from, constants)) in marks.iter().enumerate() {
            let to = marks.get(place + 1).map_or(u32::MAX, |(to, _)| *to);
            if *constants {
                self.constants.push((*from, to));
            }
        }
        Ok(())
    }

    /// Collects words that may be addresses of functions: each aligned word of the data and of the constants in the code,
    /// and each word that a pair of instructions builds. The vector table is excluded.
    fn read_addresses(&mut self) {
        let table = self.symbol("__EXCEPTIONS").map_or(0, |address| address & !0x3ff);
        let mut words = Vec::new();
        for contents in self.contents.iter().filter(|contents| contents.address != table) {
            for (place, word) in contents.bytes.chunks_exact(4).enumerate() {
                let address = contents.address + 4 * place as u32;
                if !contents.code || self.is_constant(address) {
                    words.extend(word.try_into().map(u32::from_le_bytes));
                }
            }
        }
        for function in self.functions.values() {
            words.extend(self.built(function.start, function.end));
        }
        self.taken = words
            .into_iter()
            .filter(|word| word & 1 == 1 && self.functions.contains_key(&(word & !1)))
            .map(|word| word & !1)
            .collect();
    }

    /// Words that pairs of instructions (MOVW, MOVT) between two addresses build, in their order.
    fn built(&self, mut at: u32, end: u32) -> Vec<u32> {
        let mut low = [0; 16];
        let mut words = Vec::new();
        while let Some((instruction, first, second)) = self.raw(at).filter(|_| at < end) {
            let register = usize::from(second >> 8 & 0xf);
            let value =
                (first & 0xf) << 12 | (first & 0x400) << 1 | (second >> 4 & 0x700) | second & 0xff;
            match first & 0xfbf0 {
                0xf240 if second & 0x8000 == 0 => low[register] = value,
                0xf2c0 if second & 0x8000 == 0 => {
                    words.push(u32::from(value) << 16 | u32::from(low[register]));
                }
                _ => {}
            }
            at += instruction.length;
        }
        words
    }

    /// Words that the last `count` instructions before an address build.
    pub fn loaded_before(&self, at: u32, instructions: usize) -> Vec<u32> {
        let Some(function) = self.functions.range(..=at).next_back() else {
            return Vec::new();
        };
        let mut starts = Vec::new();
        let mut start = function.1.start;
        while start < at {
            starts.push(start);
            // Constants are skipped by halfwords.
            start += self.instruction(start).map_or(2, |instruction| instruction.length);
        }
        let first = starts.len().saturating_sub(instructions);
        starts.get(first).map_or(Vec::new(), |from| self.built(*from, at))
    }

    /// Whether an address holds a constant between instructions.
    pub fn is_constant(&self, address: u32) -> bool {
        let after = self.constants.partition_point(|(from, _)| *from <= address);
        after > 0 && address < self.constants[after - 1].1
    }

    /// The bytes at an address.
    pub fn at(&self, address: u32, length: usize) -> Option<&[u8]> {
        self.contents.iter().find_map(|contents| {
            let from = usize::try_from(address.checked_sub(contents.address)?).ok()?;
            contents.bytes.get(from..from.checked_add(length)?)
        })
    }

    /// The halfword at an address.
    pub fn half(&self, address: u32) -> Option<u16> {
        self.at(address, 2).map(|bytes| u16::from_le_bytes([bytes[0], bytes[1]]))
    }

    /// The byte at an address.
    pub fn byte(&self, address: u32) -> Option<u8> {
        self.at(address, 1).map(|bytes| bytes[0])
    }

    /// The word at an address.
    pub fn word(&self, address: u32) -> Option<u32> {
        let bytes = self.at(address, 4)?;
        bytes.try_into().ok().map(u32::from_le_bytes)
    }

    fn raw(&self, address: u32) -> Option<(Instruction, u16, u16)> {
        let first = self.half(address)?;
        let second = self.half(address + 2).unwrap_or(0);
        Some((decode(address, first, second), first, second))
    }

    /// The instruction at an address; none where there are constants or nothing.
    pub fn instruction(&self, address: u32) -> Option<Instruction> {
        if self.is_constant(address) {
            return None;
        }
        self.raw(address).map(|(instruction, ..)| instruction)
    }

    /// All functions, by address.
    pub fn functions(&self) -> impl Iterator<Item = &Function> {
        self.functions.values()
    }

    /// The function that begins at an address.
    pub fn function(&self, start: u32) -> Option<&Function> {
        self.functions.get(&start)
    }

    /// The function around an address, if the compiler has taken it out of others that end alike or have a part in common. It may
    /// take what those have put on the stack.
    pub fn outlined(&self, address: u32) -> Option<&Function> {
        let (_, function) = self.functions.range(..=address).next_back()?;
        let is_inside = address < function.end;
        (is_inside && function.name.starts_with("OUTLINED_FUNCTION_")).then_some(function)
    }

    /// The name of the function that begins at an address.
    pub fn name(&self, start: u32) -> &str {
        self.function(start).map_or("?", |function| &function.name)
    }

    /// Functions whose address is taken in data or code: the possible targets of an indirect call.
    pub fn taken(&self) -> &BTreeSet<u32> {
        &self.taken
    }

    /// Value of a symbol, by its mangled name.
    pub fn symbol(&self, name: &str) -> Option<u32> {
        self.symbols.get(name).copied()
    }

    /// Functions of the vector table in its order, with the exception's name. Interrupts have the names of their
    /// functions; the handler that all unused interrupts share occurs once.
    ///
    /// # Errors
    /// There is no vector table, or one of its entries is no function.
    pub fn vectors(&self) -> Result<Vec<(String, u32)>> {
        let start = self.symbol("__EXCEPTIONS").context("no symbol __EXCEPTIONS")? & !0x3ff;
        let default = self.symbol("DefaultHandler").context("no symbol DefaultHandler")? & !1;
        let section = self.contents.iter().find(|contents| contents.address == start);
        let words = section
            .with_context(|| format!("no vector table at {start:#010x}"))?
            .bytes
            .chunks_exact(4);
        let mut vectors = vec![("others".to_owned(), default)];
        for (number, word) in words.enumerate().skip(1) {
            let word = u32::from_le_bytes([word[0], word[1], word[2], word[3]]);
            let target = word & !1;
            if word == 0 || target == default {
                continue;
            }
            let function = self
                .function(target)
                .with_context(|| format!("vector {number}: {word:#010x} is no function"))?;
            let name = PROCESSOR.get(number).map_or(function.name.as_str(), |name| name);
            vectors.push((name.to_owned(), target));
        }
        Ok(vectors)
    }
}

/// Whether control continues after an instruction.
pub fn goes_on(effect: Effect) -> bool {
    !matches!(
        effect,
        Effect::Jump(_)
            | Effect::JumpRegister
            | Effect::Table { .. }
            | Effect::Return(_)
            | Effect::Undefined
    )
}
