//! Names of functions, with those that the compiler has inlined into others.
use std::path::Path;

use addr2line::Loader;
use anyhow::{Result, anyhow};

/// Stands for an unknown line.
const UNKNOWN: &str = "?";

/// One function at an address: the innermost, or one that it is inlined into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Path of the function without generic parameters, see [`plain`].
    pub function: String,
    /// File's name and line.
    pub place: String,
}

impl Frame {
    /// A function without a name.
    pub fn unknown(at: u32) -> Self {
        Self { function: format!("{at:#010x}"), place: UNKNOWN.into() }
    }

    /// Whether the line is known.
    pub fn has_line(&self) -> bool {
        self.place != UNKNOWN
    }

    /// Whether it belongs to the language's own library: its crates and the methods of integers.
    pub fn is_core(&self) -> bool {
        let head = self.function.split("::").next().unwrap_or_default();
        let width = head.trim_start_matches(['i', 'u']);
        let is_integer = head.len() == width.len() + 1
            && (width == "size" || width.bytes().all(|digit| digit.is_ascii_digit()));
        is_integer || matches!(head, "core" | "alloc")
    }

    /// Whether it belongs to this project.
    pub fn is_ours(&self) -> bool {
        ["thermal_", "contact_model::"].iter().any(|ours| self.function.starts_with(ours))
    }
}

/// The symbols and line tables of an image.
pub struct Names(Loader);

impl Names {
    /// Reads them from an ELF file.
    ///
    /// # Errors
    /// The file has none.
    pub fn read(elf: &Path) -> Result<Self> {
        let loader = Loader::new(elf).map_err(|error| anyhow!("{}: {error}", elf.display()))?;
        Ok(Self(loader))
    }

    /// The functions at an address, innermost first.
    pub fn frames(&self, address: u32) -> Vec<Frame> {
        let mut frames = Vec::new();
        if let Ok(mut found) = self.0.find_frames(u64::from(address)) {
            while let Ok(Some(frame)) = found.next() {
                let name = frame.function.as_ref().and_then(|name| name.raw_name().ok());
                let Some(name) = name else { continue };
                let place = frame.location.as_ref().and_then(|place| {
                    let file = Path::new(place.file?).file_name()?.to_str()?;
                    Some(format!("{file}:{}", place.line?))
                });
                frames.push(Frame {
                    function: plain(&format!("{:#}", rustc_demangle::demangle(&name))),
                    place: place.unwrap_or_else(|| UNKNOWN.into()),
                });
            }
        }
        if frames.is_empty() {
            let name = self.0.find_symbol(u64::from(address)).unwrap_or("?");
            frames.push(Frame {
                function: plain(&format!("{:#}", rustc_demangle::demangle(name))),
                place: UNKNOWN.into(),
            });
        }
        frames
    }

    /// The functions at an address on one line, innermost first, up to the first of this project.
    pub fn chain(&self, address: u32) -> String {
        let mut frames = self.frames(address);
        if let Some(ours) = frames.iter().position(Frame::is_ours) {
            frames.truncate(ours + 1);
        }
        let names: Vec<String> = frames
            .into_iter()
            .map(|Frame { function, place }| format!("{function} ({place})"))
            .collect();
        names.join(" in ")
    }
}

/// A function's path without generic parameters: `<a::B<C> as d::E<F>>::g::<H>` is `a::B::g`, `<[B] as d::E>::g` is
/// `d::E::g`.
pub fn plain(name: &str) -> String {
    let (mut text, rest) =
        match name.strip_prefix('<').and_then(|rest| rest.split_at_checked(closing(rest)?)) {
            Some((inside, rest)) => (plain(implementor(inside)), &rest[1..]),
            None => (String::new(), name),
        };
    let mut rest = rest;
    while let Some(open) = rest.find('<') {
        let (before, inside) = (&rest[..open], &rest[open + 1..]);
        let Some(end) = closing(inside) else { break };
        text += before.strip_suffix("::").unwrap_or(before);
        // Implementations for the language's own types have no path of their own.
        if let Some(kind) = inside[..end].strip_prefix("impl ") {
            text = format!("{text}::{}", plain(implementor(kind)));
        }
        rest = &inside[end + 1..];
    }
    text + rest
}

/// Position of the bracket that closes one opened before the text.
fn closing(text: &str) -> Option<usize> {
    let mut depth = 1;
    let mut last = ' ';
    for (place, letter) in text.char_indices() {
        match letter {
            '<' => depth += 1,
            '>' if last != '-' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(place);
        }
        last = letter;
    }
    None
}

/// Of `Type as Trait` the one whose crate defines the function: the type, unless it is the language's own.
fn implementor(inside: &str) -> &str {
    let mut depth = 0;
    for (place, letter) in inside.char_indices() {
        match letter {
            '<' | '(' | '[' => depth += 1,
            '>' | ')' | ']' => depth -= 1,
            ' ' if depth == 0 => {
                if let Some(of) = inside[place..].strip_prefix(" as ") {
                    let kind = &inside[..place];
                    let built_in = kind.starts_with(['[', '&', '(', '*']) || !kind.contains("::");
                    return if built_in { of } else { kind };
                }
            }
            _ => {}
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn generic_parameters_are_left_out() {
        for (name, expected) in [
            ("main", "main"),
            ("a::b::c", "a::b::c"),
            ("a::B<C,D<E>>::f", "a::B::f"),
            ("a::B::<C>::f::<G>", "a::B::f"),
            ("<a::B<C> as d::E<F>>::g", "a::B::g"),
            ("<a::B>::g::{{closure}}", "a::B::g::{{closure}}"),
            ("core::slice::<impl [T]>::split_at", "core::slice::[T]::split_at"),
            ("core::ops::f<fn() -> u8>::call", "core::ops::f::call"),
            ("<[a::B] as core::ops::Index<C>>::index", "core::ops::Index::index"),
            ("<u32 as a::Wide>::wide", "a::Wide::wide"),
        ] {
            assert_eq!(plain(name), expected, "{name}");
        }
    }
}
