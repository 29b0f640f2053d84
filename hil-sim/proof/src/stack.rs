//! The most stack that a function can need, with all that it calls.
use std::collections::{BTreeMap, BTreeSet};

use crate::Proof;
use crate::flow::{Call, Target};

/// Bytes that the processor puts on the stack when an exception is entered: 26 words with the floating-point registers,
/// and one to align it (DDI 0403E, section B1.5.7).
pub const EXCEPTION: u32 = 26 * 4 + 4;

/// The function that a panic ends in.
const PANIC: &str = "rust_begin_unwind";

/// What bounds recursion: formatting calls the formatting of its parts, and a panic formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Budget {
    /// Calls through registers, one within the other: formatting of a part of what is formatted.
    nested: u8,
    /// Panics, one within the other.
    panics: u8,
}

impl Budget {
    /// An answer, its reply, a setting in it, a number, the text's place: five. A panic within, its message, an error in
    /// it, a field of that, its number, the text's place: six. And one to spare.
    const NESTED: u8 = 12;
    /// No panic is reported: it goes no deeper than the function that all panics end in.
    pub const SILENT: Self = Self {
        nested: Self::NESTED,
        panics: 0,
    };
    /// One panic is reported.
    pub const REPORT: Self = Self {
        nested: Self::NESTED,
        panics: 1,
    };
}

/// What a call through a register can reach.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Reach {
    /// Where text goes to.
    Text,
    /// Whatever has its address taken.
    Anything,
}

/// The deepest way from a function.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Deepest {
    /// Bytes.
    pub bytes: u32,
    /// The functions on the way, and the stack that each has in use where it calls the next.
    pub way: Vec<(u32, u32)>,
}

/// Adds up stacks along calls.
pub struct Stacks<'a> {
    proof: &'a Proof,
    targets: BTreeMap<Reach, Vec<u32>>,
    known: BTreeMap<(u32, Budget), Deepest>,
    open: BTreeSet<(u32, Budget)>,
    /// Functions that call themselves within one level of formatting and panic.
    pub recursive: BTreeSet<u32>,
    /// What the functions of this name call is left out.
    shallow: Option<&'static str>,
}

impl<'a> Stacks<'a> {
    /// Nothing is added up yet.
    pub fn new(proof: &'a Proof) -> Self {
        let through_register = Call {
            target: Target::Register,
            stack: 0,
        };
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

    /// The same without what the functions of a name call.
    pub fn without_calls_of(proof: &'a Proof, name: &'static str) -> Self {
        Self {
            shallow: Some(name),
            ..Self::new(proof)
        }
    }

    /// The deepest way from a function.
    pub fn deepest(&mut self, function: u32, mut budget: Budget) -> Deepest {
        let proof = self.proof;
        let flow = proof.graph.flow(function);
        let own = flow.map_or(0, |flow| flow.stack);
        let mut deepest = Deepest {
            bytes: own,
            way: vec![(function, own)],
        };
        if proof.image.name(function).ends_with(PANIC) {
            match budget.panics.checked_sub(1) {
                Some(rest) => budget.panics = rest,
                None => return deepest,
            }
        }
        if self
            .shallow
            .is_some_and(|name| proof.image.name(function).ends_with(name))
        {
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
                deepest.way = vec![(function, call.stack)];
                deepest.way.extend(inner.way);
            }
        }
        self.open.remove(&key);
        self.known.insert(key, deepest.clone());
        deepest
    }

    fn called(&mut self, at: u32, call: &Call, mut budget: Budget) -> Option<Deepest> {
        let Target::Function(target) = call.target else {
            budget.nested = budget.nested.checked_sub(1)?;
            let targets = self
                .targets
                .get(&self.reach(at))
                .cloned()
                .unwrap_or_default();
            let ways = targets
                .into_iter()
                .map(|target| self.deepest(target, budget));
            return ways.max_by_key(|way| way.bytes);
        };
        Some(self.deepest(target, budget))
    }

    /// Formatters hand text to its place; only what calls a formatter by its address can reach more.
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
            // Between the parts it formats, for which it has a name of its own.
            Some(frame) if frame.function == "core::fmt::write" => Reach::Text,
            _ => Reach::Anything,
        }
    }
}
