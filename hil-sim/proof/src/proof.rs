//! One image and all that is checked of it.
use std::fmt;
use std::path::Path;

use anyhow::{Context, Result};

use crate::compiler::{of_elf, recorded_with};
use crate::graph::Graph;
use crate::image::Image;
use crate::names::Names;
use crate::{float, levels, loops, panics};

/// An image, its calls and its names.
pub struct Proof {
    /// The machine code.
    pub image: Image,
    /// Its calls.
    pub graph: Graph,
    /// Its names.
    pub names: Names,
    /// Name and version of the compiler.
    pub compiler: String,
    /// What the vector table calls: the exception's name, the function.
    pub vectors: Vec<(String, u32)>,
}

/// What one check has found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Section {
    /// Its title.
    pub title: String,
    /// What it shows.
    pub lines: Vec<String>,
    /// What is wrong.
    pub violations: Vec<String>,
    /// What differs from names and counts that depend on the compiler.
    pub differences: Vec<String>,
}

impl Section {
    /// Makes the differences violations, or warnings if another compiler than the recorded one has compiled the image.
    #[must_use]
    pub fn judged(mut self, compiler: &str) -> Self {
        if recorded_with(compiler, &self.differences) {
            self.violations.append(&mut self.differences);
        }
        self
    }
}

impl Proof {
    /// Reads an ELF file and follows its code.
    ///
    /// # Errors
    /// It cannot be read, or is no image with symbols, a vector table and line tables.
    pub fn read(elf: &Path) -> Result<Self> {
        let bytes = std::fs::read(elf).with_context(|| format!("cannot read {}", elf.display()))?;
        let image = Image::parse(&bytes).with_context(|| elf.display().to_string())?;
        let vectors = image.vectors()?;
        let handlers = vectors.iter().map(|(_, function)| *function).collect();
        Ok(Self {
            graph: Graph::new(&image, &handlers),
            names: Names::read(elf)?,
            compiler: of_elf(&bytes)?,
            vectors,
            image,
        })
    }

    /// The function that the vector table has for an exception.
    ///
    /// # Errors
    /// It has none.
    pub fn root(&self, exception: &str) -> Result<u32> {
        let found = self.vectors.iter().find(|(name, _)| name == exception);
        let (_, function) =
            found.with_context(|| format!("the vector table has no {exception}"))?;
        Ok(*function)
    }

    /// All checks of the machine code.
    ///
    /// # Errors
    /// A handler is missing.
    pub fn check(&self) -> Result<Vec<Section>> {
        Ok([
            self.decoded(),
            panics::check(self)?,
            levels::check(self)?,
            loops::check(self)?,
            float::check(self)?,
        ]
        .map(|section| section.judged(&self.compiler))
        .into())
    }

    /// What could not be followed.
    fn decoded(&self) -> Section {
        let flows = || {
            self.image
                .functions()
                .filter_map(|function| self.graph.flow(function.start))
        };
        let count = |of: &dyn Fn(u32) -> bool| {
            self.image
                .functions()
                .filter(|function| of(function.start))
                .count()
        };
        Section {
            title: "code".into(),
            lines: vec![format!(
                "{} functions, of which {} never return; {} calls, of which {} through registers",
                count(&|_| true),
                count(&|start| !self.graph.returns(start)),
                flows().map(|flow| flow.calls.len()).sum::<usize>(),
                flows()
                    .flat_map(|flow| flow.calls.values())
                    .filter(|call| call.is_indirect())
                    .count(),
            )],
            violations: flows()
                .flat_map(|flow| flow.troubles.iter().cloned())
                .collect(),
            differences: Vec::new(),
        }
    }
}

impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title)?;
        for line in &self.lines {
            writeln!(f, "  {line}")?;
        }
        for violation in &self.violations {
            writeln!(f, "  VIOLATION {violation}")?;
        }
        Ok(())
    }
}
