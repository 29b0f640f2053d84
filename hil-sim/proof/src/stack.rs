//! Upper bound of the stack of a function, with all functions that it calls.
use std::collections::{BTreeMap, BTreeSet};

use crate::Proof;
use crate::flow::{Call, Target};

/// Bytes that the processor pushes on exception entry: 26 words with the floating-point registers, and one for alignment
/// (DDI 0403E, section B1.5.7).
pub const EXCEPTION: u32 = 26 * 4 + 4;

/// The function that every panic calls last.
const PANIC: &str = "rust_begin_unwind";

/// Limits of the recursion that formatting causes: it calls the formatting of its parts, and a panic formats its message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Budget {
    /// Nested indirect calls, each of which formats a part of a value.
    nested: u8,
    /// Nested panics.
    panics: u8,
}

impl Budget {
    /// Five for an answer: the line, its reply, a setting, a number, the output buffer. Six for a panic while formatting
    /// it: the panic, its message, an error, a field, a number, the output buffer. One in reserve.
    const NESTED: u8 = 12;
    /// No panic is reported; the analysis ends at the function that every panic calls last.
    pub const SILENT: Self = Self { nested: Self::NESTED, panics: 0 };
    /// One panic is reported.
    pub const REPORT: Self = Self { nested: Self::NESTED, panics: 1 };
}

/// Possible targets of an indirect call.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Reach {
    /// Functions that write text.
    Text,
    /// All functions whose address is taken.
    Anything,
}

/// The deepest path of calls from a function.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Deepest {
    /// Stack, bytes.
    pub bytes: u32,
    /// Functions of the path, with the stack that each uses at the call of the next one, bytes.
    pub path: Vec<(u32, u32)>,
}

/// Sums of the stacks along the calls.
pub struct Stacks<'a> {
    proof: &'a Proof,
    targets: BTreeMap<Reach, Vec<u32>>,
    known: BTreeMap<(u32, Budget), Deepest>,
    open: BTreeSet<(u32, Budget)>,
    /// Functions that call themselves without another level of formatting or panic.
    pub recursive: BTreeSet<u32>,
    /// Calls of functions with this name are left out.
    shallow: Option<&'static str>,
}

impl<'a> Stacks<'a> {
    /// An analysis without results.
    pub fn new(proof: &'a Proof) -> Self {
        let through_register = Call { target: Target::Register, stack: 0 };
        let all: Vec<u32> = proof.graph.targets(&through_register).collect();
        let is_text = |start: &u32| {
            let name = proof.image.name(*start);
            name.ends_with("::write_str") || name.ends_with("::write_char")
        };
        let text = all.iter().copied().filter(is_text).collect();
        Self {
            proof,
            targets: BTreeMap::from([(Reach::Text, text), (Reach::Anything, all)]),
            known: BTreeMap::new(),
            open: BTreeSet::new(),
            recursive: BTreeSet::new(),
            shallow: None,
        }
    }

    /// The same without the calls of functions whose name ends with `name`.
    pub fn without_calls_of(proof: &'a Proof, name: &'static str) -> Self {
        Self { shallow: Some(name), ..Self::new(proof) }
    }

    /// The deepest path of calls from a function.
    pub fn deepest(&mut self, function: u32, mut budget: Budget) -> Deepest {
        let proof = self.proof;
        let flow = proof.graph.flow(function);
        let own = flow.map_or(0, |flow| flow.stack);
        let mut deepest = Deepest { bytes: own, path: vec![(function, own)] };
        if proof.image.name(function).ends_with(PANIC) {
            match budget.panics.checked_sub(1) {
                Some(rest) => budget.panics = rest,
                None => return deepest,
            }
        }
        if self.shallow.is_some_and(|name| proof.image.name(function).ends_with(name)) {
            return deepest;
        }
        let key = (function, budget);
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        if !self.open.insert(key) {
            self.recursive.insert(function);
            return deepest;
        }
        for (at, call) in flow.into_iter().flat_map(|flow| &flow.calls) {
            if let Some(inner) = self.called(*at, call, budget)
                && call.stack + inner.bytes > deepest.bytes
            {
                deepest.bytes = call.stack + inner.bytes;
                deepest.path = vec![(function, call.stack)];
                deepest.path.extend(inner.path);
            }
        }
        self.open.remove(&key);
        self.known.insert(key, deepest.clone());
        deepest
    }

    fn called(&mut self, at: u32, call: &Call, mut budget: Budget) -> Option<Deepest> {
        let Target::Function(target) = call.target else {
            budget.nested = budget.nested.checked_sub(1)?;
            let targets = self.targets.get(&self.reach(at)).cloned().unwrap_or_default();
            let paths = targets.into_iter().map(|target| self.deepest(target, budget));
            return paths.max_by_key(|path| path.bytes);
        };
        Some(self.deepest(target, budget))
    }

    /// Formatters call the output by its address, and it writes text; other indirect calls may reach any function.
    fn reach(&self, at: u32) -> Reach {
        let frames = self.proof.names.frames(at);
        let text = [
            "core::fmt::Formatter::",
            "core::fmt::PostPadding::",
            "core::fmt::builders::PadAdapter::",
        ];
        match frames.first() {
            Some(frame) if !frame.has_line() => Reach::Anything,
            Some(frame) if text.iter().any(|kind| frame.function.starts_with(kind)) => Reach::Text,
            // The text between formatted parts; the parts themselves are formatted in inlined functions with other names.
            Some(frame) if frame.function == "core::fmt::write" => Reach::Text,
            _ => Reach::Anything,
        }
    }
}
