//! The digest by which a device tells which program is in its flash.
use anyhow::{Context, Result};
use crc::{CRC_32_MPEG_2, Crc};
use object::read::elf::{ElfFile32, ProgramHeader};
use object::{Endianness, Object, ObjectSymbol, elf};

/// What `board` answers for `program` once the image is flashed: CRC-32/MPEG-2 of the words from `_stext` to `_program_end`
/// (`memory.x`), each from its most significant byte on, as the CRC unit of the microcontroller takes them.
///
/// # Errors
/// It is no ELF file, lacks one of the symbols, or nothing is loaded between them.
pub fn of_elf(image: &[u8]) -> Result<u32> {
    let file = ElfFile32::<Endianness>::parse(image).context("not a 32-bit ELF file")?;
    let address = |name: &str| {
        let found = file.symbols().find(|symbol| symbol.name() == Ok(name));
        found.map(|symbol| symbol.address() as usize).with_context(|| format!("no symbol {name}"))
    };
    let (first, end) = (address("_stext")?, address("_program_end")?);
    // What no segment fills between two of them is erased flash.
    let mut program = vec![0xff; end.checked_sub(first).context("_program_end before _stext")?];
    let endian = file.endian();
    for segment in file.elf_program_headers() {
        let start = segment.p_paddr(endian) as usize;
        if segment.p_type(endian) != elf::PT_LOAD || start < first || start >= end {
            continue;
        }
        let data = segment.data(endian, image).ok().context("a segment without its contents")?;
        let place = program.get_mut(start - first..start - first + data.len());
        place.context("a segment that ends behind _program_end")?.copy_from_slice(data);
    }
    let (words, _) = program.as_chunks::<4>();
    let unit = Crc::<u32>::new(&CRC_32_MPEG_2);
    let mut digest = unit.digest();
    words.iter().for_each(|word| digest.update(&u32::from_le_bytes(*word).to_be_bytes()));
    Ok(digest.finalize())
}
