//! The image that runs on the emulated microcontroller: its build, and the symbols of its ELF file.
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, ensure};
use object::{Object, ObjectSymbol, SymbolKind};

/// Builds the image; cargo decides what is stale.
///
/// # Errors
/// Cargo cannot be started or fails.
pub fn build() -> anyhow::Result<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .context("the benchmark has no workspace")?;
    let built = Command::new("cargo")
        .args(["xtask", "bench-image"])
        .current_dir(root)
        .stderr(Stdio::inherit())
        .output()
        .context("cargo cannot be started to build the image")?;
    ensure!(
        built.status.success(),
        "the image could not be built: `cargo xtask bench-image` ended with {}",
        built.status
    );
    Ok(PathBuf::from(String::from_utf8_lossy(&built.stdout).trim()))
}

/// A function or a static.
struct Symbol {
    /// Its path in the source.
    path: String,
    address: u32,
    size: u64,
    kind: SymbolKind,
}

/// Functions and data of an ELF file, by their paths in the source.
pub struct Image {
    symbols: Vec<Symbol>,
    compiler: String,
}

impl Image {
    /// Reads an ELF file.
    ///
    /// # Errors
    /// The file is no ELF file, or names no compiler.
    pub fn new(elf: &[u8]) -> anyhow::Result<Self> {
        let file = object::File::parse(elf)?;
        let symbols = file.symbols().filter_map(|symbol| {
            Some(Symbol {
                path: format!("{:#}", rustc_demangle::demangle(symbol.name().ok()?)),
                address: symbol.address().try_into().ok()?,
                size: symbol.size(),
                kind: symbol.kind(),
            })
        });
        Ok(Self { symbols: symbols.collect(), compiler: image_proof::compiler::of_elf(elf)? })
    }

    /// Address of the function or static with this path; a function's includes the Thumb bit.
    ///
    /// # Errors
    /// There is none, or more than one.
    pub fn address(&self, path: &str) -> anyhow::Result<u32> {
        let mut found = self.symbols.iter().filter(|symbol| symbol.path == path);
        let symbol = found.next().with_context(|| format!("the image has no {path}"))?;
        ensure!(found.next().is_none(), "the image has more than one {path}");
        Ok(symbol.address)
    }

    /// Bytes of all data whose path has this prefix.
    pub fn data_bytes(&self, prefix: &str) -> usize {
        let data = self
            .symbols
            .iter()
            .filter(|symbol| symbol.kind == SymbolKind::Data && symbol.path.starts_with(prefix));
        data.map(|symbol| symbol.size as usize).sum()
    }

    /// Name and version of the compiler.
    pub fn compiler(&self) -> &str {
        &self.compiler
    }
}
