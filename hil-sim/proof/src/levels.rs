//! The most stack that the whole can need: the background, and on it one handler of each priority, on one another.
//!
//! Interrupts are masked while the start goes on, so that it shares the stack with failures only; RTIC lets them in as the last
//! thing that `__rtic_init_resources` does, when all that it has called has returned.
use std::collections::BTreeSet;

use anyhow::{Context, Result};

use crate::allowed::{CONVERTER, HOST, RECEIVER, REFILL, TICK};
use crate::stack::{Budget, Deepest, EXCEPTION, Stacks};
use crate::{Proof, Section};

/// What sets everything up.
const START: &str = "::__rtic_init_resources";
/// Priorities from this one on cannot be masked.
const FAILURES: usize = 6;
/// Handlers of one priority, which never interrupt each other. The lowest priority first; as in the firmware's `main.rs`.
static LEVELS: [(&str, &[&str]); 8] = [
    ("background", &["Reset"]),
    ("host", &[HOST]),
    ("refill", &[REFILL]),
    ("tick", &[TICK, CONVERTER]),
    ("receive", &[RECEIVER]),
    ("any other", &["others"]),
    ("clock failure", &["NMI"]),
    ("hard fault", &["HardFault"]),
];
/// The most stack that the whole can need, bytes. Of all panics the first is reported, no other.
///
/// # Errors
/// A handler is missing.
pub fn bound(proof: &Proof) -> Result<u32> {
    Ok(Levels::new(proof)?.bound())
}

/// What each priority needs.
struct Levels {
    /// Name, without a report of a panic, and with.
    each: Vec<Level>,
    /// The background while the start goes on.
    start: Level,
    recursive: BTreeSet<u32>,
}

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
        Ok(Self {
            each,
            start,
            recursive,
        })
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
                let way = stacks.deepest(proof.root(handler)?, budget);
                if way.bytes > deepest.bytes {
                    *deepest = way;
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

/// Levels on one another; nothing is stacked below the first.
fn sum<'a>(levels: impl Iterator<Item = &'a Level> + Clone) -> u32 {
    let frames = EXCEPTION * (levels.clone().count() as u32 - 1);
    let silent: u32 = levels.clone().map(|(_, silent, _)| silent.bytes).sum();
    let reports = levels.map(|(_, silent, report)| report.bytes - silent.bytes);
    frames + silent + reports.max().unwrap_or(0)
}

/// Size of the stack, bytes.
///
/// # Errors
/// The image does not say.
pub fn size(proof: &Proof) -> Result<u32> {
    let symbol = |name| {
        proof
            .image
            .symbol(name)
            .with_context(|| format!("the image has no symbol {name}"))
    };
    let (start, end) = (symbol("_stack_start")?, symbol("_stack_end")?);
    start
        .checked_sub(end)
        .context("_stack_end lies above _stack_start")
}

/// The stack is larger than the bound, and the bound is one.
///
/// # Errors
/// A handler is missing, or the image does not say where its stack is.
pub fn check(proof: &Proof) -> Result<Section> {
    let mut section = Section {
        title: "stack".into(),
        ..Section::default()
    };
    let known: Vec<&str> = LEVELS
        .iter()
        .flat_map(|(_, handlers)| *handlers)
        .copied()
        .collect();
    for (name, _) in proof
        .vectors
        .iter()
        .filter(|(name, _)| !known.contains(&name.as_str()))
    {
        section
            .violations
            .push(format!("{name} has no place among the priorities"));
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
        section.violations.push(format!(
            "{} at {start:#010x} calls itself",
            proof.image.name(*start)
        ));
    }
    let (bound, size) = (levels.bound(), size(proof)?);
    section.lines.push(format!(
        "with {EXCEPTION} for each exception and one report: {bound} of {size} bytes"
    ));
    if bound > size {
        section.violations.push(format!(
            "the stack of {size} bytes is smaller than the bound of {bound}"
        ));
    }
    Ok(section)
}

/// Bytes, and the functions that take most of them.
fn shown(proof: &Proof, deepest: &Deepest) -> String {
    let mut large: Vec<_> = deepest
        .way
        .iter()
        .filter(|(_, bytes)| *bytes >= 200)
        .collect();
    large.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
    let names: Vec<String> = large
        .iter()
        .take(4)
        .map(|(start, bytes)| format!("{bytes} {}", proof.image.name(*start)))
        .collect();
    format!(
        "{} bytes, through {} functions ({})",
        deepest.bytes,
        deepest.way.len(),
        names.join(", ")
    )
}
