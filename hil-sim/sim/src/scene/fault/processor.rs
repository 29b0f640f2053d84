//! Faults of the processor and the keys that a scene gives for each.

use std::ops::Range;

use toml::Spanned;

use crate::processor::{Injection, ParseMachineFaultError};
use crate::scene::file;
use crate::scene::source::{SceneError, Source};

named_enum! {
    /// A key that locates a fault of the processor.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum ProcessorKey {
        /// Address of a byte of the RAM or of a peripheral register.
        Address = "address",
        /// Name of a core register.
        Register = "register",
        /// Bit of the byte or register.
        Bit = "bit",
        /// DMA controller; by default 2, the sampler's.
        Controller = "controller",
        /// Stream of the controller; by default 0, the sampler's.
        Stream = "stream",
        /// Select line of the multiplexers, 0 to 2.
        Line = "line",
        /// Level at which a select line is stuck, 0 or 1.
        Level = "level",
    }
}

impl ProcessorKey {
    /// Default of the key, if it has one.
    const fn default(self) -> Option<&'static str> {
        match self {
            Self::Controller => Some("2"),
            Self::Stream => Some("0"),
            _ => None,
        }
    }

    /// Position and text of the key in a table, if it is there.
    fn value(self, row: &file::Fault) -> Option<(Range<usize>, String)> {
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
            Self::Line => number(&row.line),
            Self::Level => number(&row.level),
        }
    }
}

/// Kind of a fault of the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProcessorKind {
    /// Its name in a scene.
    pub name: &'static str,
    /// Keys that locate the fault.
    pub keys: &'static [ProcessorKey],
    /// The effect in words, for `docs/scenes.md`.
    pub(super) text: &'static str,
}

impl ProcessorKind {
    /// All kinds: name, keys, and the effect in words.
    #[rustfmt::skip]
    pub const ALL: [Self; 17] = [
        Self::new("hung-core", &[],
            "the core executes nothing until a reset; timers, DMA, converter and watchdogs continue"),
        Self::new("debugger-halt", &[],
            "a debugger halts the core until a reset; a timer or watchdog that it has chosen in DBGMCU stands still too"),
        Self::new("hse-stopped", &[],
            "the external clock fails; the clock security system acts if it is on, else, if the system runs on that clock, everything but the independent watchdog \
             stands still and pins keep their level"),
        Self::new("hse-started", &[], "the external clock comes, or comes back"),
        Self::new("adc-stopped", &[], "the converter ends no conversion until it is reset"),
        Self::new("adc2-stopped", &[],
            "the converter of the heat-flux sensor, ADC2, ends no conversion until it is reset"),
        Self::new("dma-stopped", &[ProcessorKey::Controller, ProcessorKey::Stream],
            "a bus error ends an enabled stream, the sampler's (2, 0) unless others are named"),
        Self::new("brown-out", &[], "the supply dips: a reset; RAM keeps its contents"),
        Self::new("power-cycle", &[],
            "the supply is lost: a reset; RAM holds noise drawn from the seed"),
        Self::new("reset-pin", &[], "the reset pin is pulled; RAM keeps its contents"),
        Self::new("software-reset", &[],
            "the program requests a reset, as a program out of control may; RAM keeps its contents"),
        Self::new("stack-overflow", &[],
            "the stack pointer is set to the end of the stack, so that the next push leaves it"),
        Self::new("ram-bit", &[ProcessorKey::Address, ProcessorKey::Bit], "a bit (0 to 7) of a byte of the RAM flips"),
        Self::new("core-bit", &[ProcessorKey::Register, ProcessorKey::Bit],
            "a bit of `r0` to `r12`, `sp`, `lr`, `pc`, `psr` (flags), `s0` to `s31` or `fpscr` flips"),
        Self::new("register-bit", &[ProcessorKey::Address, ProcessorKey::Bit],
            "a peripheral register is stored with the bit flipped; the peripheral reacts as it would to that write. In BDTR of \
             TIM1 and TIM8 the bit flips although it is locked. A flip that would stop a peripheral's clock (except the window \
             watchdog's), or that the model does not take, is refused"),
        Self::new("select-line-stuck", &[ProcessorKey::Line, ProcessorKey::Level],
            "five fingers: a select line (0 to 2) of the multiplexers is shorted at its pin, to ground (0) or to 3.3 V (1)"),
        Self::new("select-line-open", &[ProcessorKey::Line],
            "five fingers: the wire of a select line breaks, and the pull-down behind it holds the multiplexers' inputs low"),
    ];

    const fn new(name: &'static str, keys: &'static [ProcessorKey], text: &'static str) -> Self {
        Self { name, keys, text }
    }

    /// The kind with a name.
    pub(super) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name == name)
    }
}

/// Reads the table of a processor fault; the scene's seed draws the noise in the RAM.
pub(super) fn injection(
    source: &Source<'_>,
    row: &Spanned<file::Fault>,
    kind: ProcessorKind,
    duration_s: f64,
    seed: u64,
) -> Result<Injection, SceneError> {
    let file::Fault { t_s, until_s, value, sensor, with, .. } = row.get_ref();
    let spans = [
        ("until_s", until_s.as_ref().map(Spanned::span)),
        ("value", value.as_ref().map(Spanned::span)),
        ("sensor", sensor.as_ref().map(Spanned::span)),
        ("with", with.as_ref().map(Spanned::span)),
    ];
    let known = ProcessorKey::ALL.into_iter().filter(|key| !kind.keys.contains(key));
    let others = known.map(|key| (key.name(), key.value(row.get_ref()).map(|(span, _)| span)));
    for (key, span) in spans.into_iter().chain(others) {
        if let Some(span) = span {
            return Err(meaningless_key(source, key, span, kind.name, kind.keys));
        }
    }
    let mut at = Vec::new();
    for key in kind.keys {
        let given = key.value(row.get_ref()).map(|(_, text)| text);
        at.push(given.or(key.default().map(str::to_owned)).ok_or_else(|| {
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

/// Checks that the table of another fault has no key of a processor fault.
pub(super) fn no_keys(source: &Source<'_>, row: &Spanned<file::Fault>) -> Result<(), SceneError> {
    let row = row.get_ref();
    for key in ProcessorKey::ALL {
        if let Some((span, _)) = key.value(row) {
            return Err(meaningless_key(source, key.name(), span, row.kind.get_ref(), &[]));
        }
    }
    Ok(())
}

fn meaningless_key(
    source: &Source<'_>,
    key: &str,
    span: Range<usize>,
    kind: &str,
    keys: &[ProcessorKey],
) -> SceneError {
    let allowed: Vec<_> = std::iter::once("t_s").chain(keys.iter().map(|key| key.name())).collect();
    let has =
        ProcessorKind::ALL.iter().filter(|kind| kind.keys.iter().any(|own| own.name() == key));
    let has: Vec<_> = has.map(|kind| kind.name).collect();
    let problem = if has.is_empty() {
        format!("fault.{key} has no meaning for {kind}; allowed is {}", allowed.join(", "))
    } else {
        format!("fault.{key} has no meaning for {kind}; it has for {}", has.join(", "))
    };
    source.error(Some(span), problem)
}
