//! Faults of the processor, and what a scene says of each.

use std::ops::Range;

use toml::Spanned;

use crate::processor::{Injection, ParseMachineFaultError};
use crate::scene::file;
use crate::scene::source::{SceneError, Source};

named_enum! {
    /// A key that tells where the processor breaks.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum ProcessorKey {
        /// Address of a byte of the RAM, or of a device's register.
        Address = "address",
        /// Name of a core register.
        Register = "register",
        /// Bit of it.
        Bit = "bit",
        /// DMA controller; 2, the sampler's, unless given.
        Controller = "controller",
        /// Its stream; 0, the sampler's, unless given.
        Stream = "stream",
    }
}

impl ProcessorKey {
    /// What a scene means that does not say.
    const fn default(self) -> Option<&'static str> {
        match self {
            Self::Controller => Some("2"),
            Self::Stream => Some("0"),
            _ => None,
        }
    }

    /// Where it stands in a table, and what it says.
    fn said(self, row: &file::Fault) -> Option<(Range<usize>, String)> {
        let number = |value: &Option<Spanned<i64>>| {
            let value = value.as_ref()?;
            Some((value.span(), value.get_ref().to_string()))
        };
        match self {
            Self::Address => number(&row.address),
            Self::Register => {
                let name = row.register.as_ref()?;
                Some((name.span(), name.get_ref().clone()))
            }
            Self::Bit => number(&row.bit),
            Self::Controller => number(&row.controller),
            Self::Stream => number(&row.stream),
        }
    }
}

/// What can happen to the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProcessorKind {
    /// Its name in a scene.
    pub name: &'static str,
    /// Keys that tell where.
    pub keys: &'static [ProcessorKey],
}

impl ProcessorKind {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::new("hung-core", &[]),
        Self::new("hse-stopped", &[]),
        Self::new("adc-stopped", &[]),
        Self::new(
            "dma-stopped",
            &[ProcessorKey::Controller, ProcessorKey::Stream],
        ),
        Self::new("brown-out", &[]),
        Self::new("power-cycle", &[]),
        Self::new("reset-pin", &[]),
        Self::new("software-reset", &[]),
        Self::new("stack-overflow", &[]),
        Self::new("ram-bit", &[ProcessorKey::Address, ProcessorKey::Bit]),
        Self::new("core-bit", &[ProcessorKey::Register, ProcessorKey::Bit]),
        Self::new("register-bit", &[ProcessorKey::Address, ProcessorKey::Bit]),
    ];

    const fn new(name: &'static str, keys: &'static [ProcessorKey]) -> Self {
        Self { name, keys }
    }

    /// The kind of a name.
    pub(super) fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name == name)
    }
}

/// Reads a table; noise in RAM is drawn by the scene's seed.
pub(super) fn injection(
    source: &Source<'_>,
    row: &Spanned<file::Fault>,
    kind: ProcessorKind,
    duration_s: f64,
    seed: u64,
) -> Result<Injection, SceneError> {
    let file::Fault {
        t_s,
        until_s,
        value,
        sensor,
        with,
        ..
    } = row.get_ref();
    let spans = [
        ("until_s", until_s.as_ref().map(Spanned::span)),
        ("value", value.as_ref().map(Spanned::span)),
        ("sensor", sensor.as_ref().map(Spanned::span)),
        ("with", with.as_ref().map(Spanned::span)),
    ];
    let known = ProcessorKey::ALL
        .into_iter()
        .filter(|key| !kind.keys.contains(key));
    let others = known.map(|key| (key.name(), key.said(row.get_ref()).map(|(span, _)| span)));
    for (key, span) in spans.into_iter().chain(others) {
        if let Some(span) = span {
            return Err(foreign(source, key, span, kind.name, kind.keys));
        }
    }
    let mut at = Vec::new();
    for key in kind.keys {
        let said = key.said(row.get_ref()).map(|(_, said)| said);
        at.push(said.or(key.default().map(str::to_owned)).ok_or_else(|| {
            let problem = format!("fault.{} is missing; {} needs it", key.name(), kind.name);
            source.error(Some(row.span()), problem)
        })?);
    }
    if kind.name == "power-cycle" {
        at.push(seed.to_string());
    }
    let text = if at.is_empty() {
        kind.name.to_owned()
    } else {
        format!("{}={}", kind.name, at.join("."))
    };
    let fault = (text.parse()).map_err(|error: ParseMachineFaultError| {
        source.error(Some(row.span()), error.to_string())
    })?;
    let t_s = source.time("fault.t_s", t_s, duration_s)?;
    Ok(Injection { t_s, fault })
}

/// A table of another kind has no key of the processor's.
pub(super) fn no_keys(source: &Source<'_>, row: &Spanned<file::Fault>) -> Result<(), SceneError> {
    let row = row.get_ref();
    for key in ProcessorKey::ALL {
        if let Some((span, _)) = key.said(row) {
            return Err(foreign(source, key.name(), span, row.kind.get_ref(), &[]));
        }
    }
    Ok(())
}

fn foreign(
    source: &Source<'_>,
    key: &str,
    span: Range<usize>,
    kind: &str,
    keys: &[ProcessorKey],
) -> SceneError {
    let allowed: Vec<_> = std::iter::once("t_s")
        .chain(keys.iter().map(|key| key.name()))
        .collect();
    let has = ProcessorKind::ALL
        .iter()
        .filter(|kind| kind.keys.iter().any(|own| own.name() == key));
    let has: Vec<_> = has.map(|kind| kind.name).collect();
    let problem = if has.is_empty() {
        format!(
            "fault.{key} has no meaning for {kind}; allowed is {}",
            allowed.join(", ")
        )
    } else {
        format!(
            "fault.{key} has no meaning for {kind}; it has for {}",
            has.join(", ")
        )
    };
    source.error(Some(span), problem)
}
