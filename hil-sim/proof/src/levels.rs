//! Upper bound of the image's stack: the background, and one handler of each priority nested on it.
//!
//! Interrupts are masked during start-up, so that only the handlers of failures can share the stack with it. RTIC unmasks them
//! at the end of `__rtic_init_resources`, after all functions that it calls have returned.
use std::collections::BTreeSet;

use anyhow::{Context, Result};

use crate::allowed::{CONVERTER, HOST, LEARN, RECEIVER, REFILL, TICK};
use crate::stack::{Budget, Deepest, EXCEPTION, Stacks};
use crate::{Proof, Section};

/// The function that runs the start-up.
const START: &str = "::__rtic_init_resources";
/// Index of the first level that cannot be masked.
const FAILURES: usize = 6;
/// Levels of the firmware's `main.rs`, lowest priority first. Handlers of one priority never interrupt each other.
static LEVELS: [(&str, &[&str]); 8] = [
    ("background", &["Reset"]),
    ("host", &[HOST]),
    ("refill, learner", &[REFILL, LEARN]),
    ("tick", &[TICK, CONVERTER]),
    ("receive", &[RECEIVER]),
    ("any other", &["others"]),
    ("clock failure", &["NMI"]),
    ("hard fault", &["HardFault"]),
];

/// Upper bound of the stack, bytes, if only the first panic is reported.
///
/// # Errors
/// A handler is missing.
pub fn bound(proof: &Proof) -> Result<u32> {
    Ok(Levels::new(proof)?.bound())
}

/// Stack of each priority.
struct Levels {
    each: Vec<Level>,
    /// The background during start-up.
    start: Level,
    recursive: BTreeSet<u32>,
}

/// Name, deepest path without the report of a panic, and with it.
type Level = (&'static str, Deepest, Deepest);

impl Levels {
    fn new(proof: &Proof) -> Result<Self> {
        let mut stacks = Stacks::new(proof);
        let start = Self::level(proof, &mut stacks, "start", &["Reset"])?;
        let mut recursive = std::mem::take(&mut stacks.recursive);
        let mut stacks = Stacks::without_calls_of(proof, START);
        let each = LEVELS
            .iter()
            .map(|(level, handlers)| Self::level(proof, &mut stacks, level, handlers))
            .collect::<Result<_>>()?;
        recursive.append(&mut stacks.recursive);
        Ok(Self { each, start, recursive })
    }

    fn level(
        proof: &Proof,
        stacks: &mut Stacks,
        name: &'static str,
        handlers: &[&str],
    ) -> Result<Level> {
        let mut deepest = [Deepest::default(), Deepest::default()];
        for (deepest, budget) in deepest.iter_mut().zip([Budget::SILENT, Budget::REPORT]) {
            for handler in handlers {
                let path = stacks.deepest(proof.root(handler)?, budget);
                if path.bytes > deepest.bytes {
                    *deepest = path;
                }
            }
        }
        let [silent, report] = deepest;
        Ok((name, silent, report))
    }

    fn bound(&self) -> u32 {
        let start = std::iter::once(&self.start).chain(&self.each[FAILURES..]);
        sum(self.each.iter()).max(sum(start))
    }
}

/// Stack of nested levels, bytes; the first one has no exception frame.
fn sum<'a>(levels: impl Iterator<Item = &'a Level> + Clone) -> u32 {
    let frames = EXCEPTION * (levels.clone().count() as u32 - 1);
    let silent: u32 = levels.clone().map(|(_, silent, _)| silent.bytes).sum();
    let reports = levels.map(|(_, silent, report)| report.bytes - silent.bytes);
    frames + silent + reports.max().unwrap_or(0)
}

/// Size of the stack, bytes.
///
/// # Errors
/// The image lacks a symbol of the stack.
pub fn size(proof: &Proof) -> Result<u32> {
    let symbol =
        |name| proof.image.symbol(name).with_context(|| format!("the image has no symbol {name}"));
    let (start, end) = (symbol("_stack_start")?, symbol("_stack_end")?);
    start.checked_sub(end).context("_stack_end lies above _stack_start")
}

/// Checks that the stack is larger than its upper bound, and that no recursion invalidates the bound.
///
/// # Errors
/// A handler or a symbol of the stack is missing.
pub fn check(proof: &Proof) -> Result<Section> {
    let mut section = Section { title: "stack".into(), ..Section::default() };
    let known: Vec<&str> = LEVELS.iter().flat_map(|(_, handlers)| *handlers).copied().collect();
    for (name, _) in proof.vectors.iter().filter(|(name, _)| !known.contains(&name.as_str())) {
        section.violations.push(format!("{name} has no place among the priorities"));
    }
    let levels = Levels::new(proof)?;
    for (level, silent, report) in std::iter::once(&levels.start).chain(&levels.each) {
        section.lines.push(format!(
            "{level}: {}; {} if it reports a panic",
            shown(proof, silent),
            report.bytes
        ));
    }
    for start in &levels.recursive {
        section
            .violations
            .push(format!("{} at {start:#010x} calls itself", proof.image.name(*start)));
    }
    let (bound, size) = (levels.bound(), size(proof)?);
    section.lines.push(format!(
        "with {EXCEPTION} for each exception and one report: {bound} of {size} bytes"
    ));
    if bound > size {
        section
            .violations
            .push(format!("the stack of {size} bytes is smaller than the bound of {bound}"));
    }
    Ok(section)
}

/// Bytes, and the functions that use most of them.
fn shown(proof: &Proof, deepest: &Deepest) -> String {
    let mut large: Vec<_> = deepest.path.iter().filter(|(_, bytes)| *bytes >= 200).collect();
    large.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
    let names: Vec<String> = large
        .iter()
        .take(4)
        .map(|(start, bytes)| format!("{bytes} {}", proof.image.name(*start)))
        .collect();
    format!(
        "{} bytes, through {} functions ({})",
        deepest.bytes,
        deepest.path.len(),
        names.join(", ")
    )
}
