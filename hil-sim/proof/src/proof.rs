//! An image and its checks.
use std::fmt;
use std::path::Path;

use anyhow::{Context, Result};

use crate::compiler::{of_elf, recorded_with};
use crate::graph::Graph;
use crate::image::Image;
use crate::names::Names;
use crate::{float, levels, loops, panics};

/// An image with its call graph and its names.
pub struct Proof {
    /// The machine code.
    pub image: Image,
    /// Call graph.
    pub graph: Graph,
    /// Names of functions, with those inlined into others.
    pub names: Names,
    /// Name and version of the compiler.
    pub compiler: String,
    /// Functions of the vector table, with the name of the exception.
    pub vectors: Vec<(String, u32)>,
}

/// Result of one check.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Section {
    /// Title.
    pub title: String,
    /// Findings that are no violation.
    pub lines: Vec<String>,
    /// Violations.
    pub violations: Vec<String>,
    /// Differences from recorded names and counts, which depend on the compiler.
    pub differences: Vec<String>,
}

impl Section {
    /// Turns the differences into violations, or into warnings if the image is of another compiler than the recorded one.
    #[must_use]
    pub fn judged(mut self, compiler: &str) -> Self {
        if recorded_with(compiler, &self.differences) {
            self.violations.append(&mut self.differences);
        }
        self
    }
}

impl Proof {
    /// Reads an ELF file and analyses its code.
    ///
    /// # Errors
    /// The file cannot be read, or lacks symbols, vector table or line tables.
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

    /// The handler of an exception.
    ///
    /// # Errors
    /// The vector table has none.
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

    /// Code that could not be analysed.
    fn decoded(&self) -> Section {
        let flows =
            || self.image.functions().filter_map(|function| self.graph.flow(function.start));
        let count = |of: &dyn Fn(u32) -> bool| {
            self.image.functions().filter(|function| of(function.start)).count()
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
            violations: flows().flat_map(|flow| flow.troubles.iter().cloned()).collect(),
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
