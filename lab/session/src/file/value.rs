//! Values and tables of a session file, read by key with what is allowed.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::source::{SessionError, Source};
use thermal_device::Vocabulary;

/// A number that a key may have.
pub(super) struct Number {
    /// The key, with its unit.
    pub key: &'static str,
    /// Smallest and largest value.
    pub range: (f64, f64),
    /// Value of a file without the key; `None` if the key is required.
    pub default: Option<f64>,
}

impl Number {
    pub const fn new(key: &'static str, least: f64, most: f64, default: Option<f64>) -> Self {
        Self { key, range: (least, most), default }
    }

    fn allowed(&self) -> String {
        let (least, most) = self.range;
        format!("{least} to {most}")
    }
}

/// A whole number that a key may have.
pub(super) struct Whole {
    /// The key.
    pub key: &'static str,
    /// Smallest and largest value.
    pub range: (u32, u32),
    /// Value of a file without the key; `None` if the key is required.
    pub default: Option<u32>,
}

impl Whole {
    pub const fn new(key: &'static str, least: u32, most: u32, default: Option<u32>) -> Self {
        Self { key, range: (least, most), default }
    }

    fn allowed(&self) -> String {
        let (least, most) = self.range;
        format!("a whole number from {least} to {most}")
    }
}

/// Names and levels are columns and words of recorded tables.
pub(super) const NAME: &str = "1 to 40 letters, digits and _, with a small letter first";
pub(super) const LEVEL: &str = "1 to 40 letters, digits, - _ and .";

/// Whether a text is the name of a factor or a station. Names with a capital letter first are keys of BIDS: a sidecar describes
/// columns and has such keys side by side.
pub(super) fn is_name(text: &str) -> bool {
    is_level(text)
        && text.starts_with(|first: char| first.is_ascii_lowercase())
        && !text.contains(['-', '.'])
}

/// Whether a text is a level of a factor.
pub(super) fn is_level(text: &str) -> bool {
    let known = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    (1..=40).contains(&text.len()) && text.chars().all(known)
}

/// Words as a sentence lists them.
pub(super) fn listed<W: AsRef<str>>(words: &[W]) -> String {
    let words: Vec<_> = words.iter().map(AsRef::as_ref).collect();
    words.join(", ")
}

/// A value with its key.
#[derive(Clone)]
pub(super) struct Value<'a> {
    source: &'a Source<'a>,
    /// The key with the keys of the tables around it, such as `trial.max_s`.
    pub key: String,
    /// Where an error of a whole table points to: its key.
    key_at: usize,
    value: &'a Spanned<DeValue<'a>>,
}

impl<'a> Value<'a> {
    /// An error at this value.
    pub fn error(&self, problem: impl Into<String>) -> SessionError {
        let is_table = self.value.get_ref().is_table();
        let at = if is_table { self.key_at } else { self.value.span().start };
        self.source.error(at, problem)
    }

    /// The error of a value that is not allowed.
    pub fn wrong(&self, allowed: impl AsRef<str>) -> SessionError {
        let (key, allowed) = (&self.key, allowed.as_ref());
        let span: Range<usize> = self.value.span();
        let problem = if self.value.get_ref().is_table() {
            format!("{key} is a table; allowed is {allowed}")
        } else {
            format!("{key} = {}; allowed is {allowed}", self.source.quote(span))
        };
        self.error(problem)
    }

    /// The number, if it is one.
    fn as_number(&self) -> Option<f64> {
        let number = match self.value.get_ref() {
            DeValue::Integer(integer) => {
                i64::from_str_radix(integer.as_str(), integer.radix()).ok()? as f64
            }
            DeValue::Float(float) => float.as_str().parse().ok()?,
            _ => return None,
        };
        number.is_finite().then_some(number)
    }

    /// A number within a range.
    pub fn number(&self, range: (f64, f64)) -> Result<f64, SessionError> {
        let (least, most) = range;
        let number = self.as_number();
        let within = number.filter(|number| (least..=most).contains(number));
        within.ok_or_else(|| self.wrong(format!("{least} to {most}")))
    }

    pub fn whole(&self, key: &Whole) -> Result<u32, SessionError> {
        let (least, most) = key.range;
        let number = match self.value.get_ref() {
            DeValue::Integer(integer) => {
                u32::from_str_radix(integer.as_str(), integer.radix()).ok()
            }
            _ => None,
        };
        let within = number.filter(|number| (least..=most).contains(number));
        within.ok_or_else(|| self.wrong(key.allowed()))
    }

    /// The text, if it is one; `allowed` says what is.
    pub fn string(&self, allowed: &str) -> Result<&'a str, SessionError> {
        let value: &'a DeValue<'a> = self.value.get_ref();
        value.as_str().ok_or_else(|| self.wrong(allowed))
    }

    /// A text for people: not empty, and not longer than so many characters.
    pub fn text(&self, most: usize) -> Result<String, SessionError> {
        let allowed = format!("a text of 1 to {most} characters");
        let text = self.string(&allowed)?.trim();
        if text.is_empty() || text.chars().count() > most {
            return Err(self.wrong(allowed));
        }
        Ok(text.into())
    }

    /// One of these words, with what it stands for.
    pub fn word<T: Clone>(&self, words: &[(&str, T)]) -> Result<T, SessionError> {
        let quoted: Vec<_> = words.iter().map(|(word, _)| format!("{word:?}")).collect();
        let allowed = quoted.join(" or ");
        let given = self.string(&allowed)?;
        let found = words.iter().find(|(word, _)| *word == given);
        found.map(|(_, meaning)| meaning.clone()).ok_or_else(|| self.wrong(allowed))
    }

    /// A name of a factor, a station or a part.
    pub fn name(&self) -> Result<String, SessionError> {
        let name = self.string(NAME)?;
        if is_name(name) { Ok(name.into()) } else { Err(self.wrong(NAME)) }
    }

    /// A level of a factor: a word, or a number as the file writes it.
    pub fn level(&self) -> Result<String, SessionError> {
        let text = match self.value.get_ref() {
            DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str(),
            DeValue::Float(float) => float.as_str(),
            DeValue::String(text) => text,
            _ => return Err(self.wrong(LEVEL)),
        };
        if is_level(text) { Ok(text.into()) } else { Err(self.wrong(LEVEL)) }
    }

    pub fn boolean(&self) -> Result<bool, SessionError> {
        let boolean = self.value.get_ref().as_bool();
        boolean.ok_or_else(|| self.wrong("true or false"))
    }

    pub fn is_table(&self) -> bool {
        self.value.get_ref().is_table()
    }

    pub fn is_string(&self) -> bool {
        self.value.get_ref().is_str()
    }

    /// The values of a list; their keys are that of the list.
    pub fn list(&self, allowed: &str) -> Result<Vec<Self>, SessionError> {
        let value: &'a DeValue<'a> = self.value.get_ref();
        let Some(array) = value.as_array() else {
            return Err(self.wrong(allowed));
        };
        let element = |value: &'a Spanned<DeValue<'a>>| Self {
            source: self.source,
            key: self.key.clone(),
            key_at: value.span().start,
            value,
        };
        Ok(array.iter().map(element).collect())
    }

    /// The table, with any keys.
    pub fn any_table(&self, allowed: &str) -> Result<Table<'a>, SessionError> {
        let value: &'a DeValue<'a> = self.value.get_ref();
        match value.as_table() {
            Some(table) => Ok(Table::new(self.source, self.key.clone(), self.key_at, table)),
            None => Err(self.wrong(allowed)),
        }
    }

    /// The table, which may have these keys.
    pub fn table(&self, keys: &[&str]) -> Result<Table<'a>, SessionError> {
        let table = self.any_table(&format!("a table with the keys {}", listed(keys)))?;
        table.only(keys)?;
        Ok(table)
    }
}

/// A table with its key.
pub(super) struct Table<'a> {
    source: &'a Source<'a>,
    path: String,
    at: usize,
    /// In the order of the file.
    pub values: Vec<(&'a str, Value<'a>)>,
}

impl<'a> Table<'a> {
    pub fn new(source: &'a Source<'a>, path: String, at: usize, table: &'a DeTable<'a>) -> Self {
        let mut values: Vec<_> = table.iter().collect();
        values.sort_by_key(|(key, _)| key.span().start);
        let named = values.into_iter().map(|(key, value)| {
            let name: &'a str = key.get_ref();
            let full = if path.is_empty() { name.into() } else { format!("{path}.{name}") };
            let value = Value { source, key: full, key_at: key.span().start, value };
            (name, value)
        });
        Self { source, values: named.collect(), path, at }
    }

    /// A table of this one that the file leaves out.
    pub fn empty(&self, key: &str) -> Self {
        Self { source: self.source, path: self.key(key), at: self.at, values: Vec::new() }
    }

    /// The full name of a key of this table.
    pub fn key(&self, key: &str) -> String {
        if self.path.is_empty() { key.into() } else { format!("{}.{key}", self.path) }
    }

    /// Reports the first key that is none of these.
    pub fn only(&self, keys: &[&str]) -> Result<(), SessionError> {
        match self.values.iter().find(|(key, _)| !keys.contains(key)) {
            None => Ok(()),
            Some((_, value)) => {
                let problem = format!("{} is no key; allowed are {}", value.key, listed(keys));
                Err(self.source.error(value.key_at, problem))
            }
        }
    }

    /// Reports the first of these keys that the table has; `needed` says beside what it is allowed.
    pub fn without(&self, keys: &[&str], needed: &str) -> Result<(), SessionError> {
        match self.values.iter().find(|(key, _)| keys.contains(key)) {
            None => Ok(()),
            Some((_, value)) => {
                let problem = format!("{} has no meaning here; it is allowed {needed}", value.key);
                Err(self.source.error(value.key_at, problem))
            }
        }
    }

    /// An error of the whole table.
    pub fn error(&self, problem: impl Into<String>) -> SessionError {
        self.source.error(self.at, problem)
    }

    pub fn get(&self, key: &str) -> Option<&Value<'a>> {
        let found = self.values.iter().find(|(name, _)| *name == key);
        found.map(|(_, value)| value)
    }

    /// The value of a key that must be there.
    pub fn need(&self, key: &str, allowed: &str) -> Result<&Value<'a>, SessionError> {
        self.get(key).ok_or_else(|| {
            self.error(format!("{} is missing; allowed is {allowed}", self.key(key)))
        })
    }

    pub fn number(&self, key: &Number) -> Result<f64, SessionError> {
        match (self.get(key.key), key.default) {
            (Some(value), _) => value.number(key.range),
            (None, Some(default)) => Ok(default),
            (None, None) => self.need(key.key, &key.allowed())?.number(key.range),
        }
    }

    pub fn whole(&self, key: &Whole) -> Result<u32, SessionError> {
        match (self.get(key.key), key.default) {
            (Some(value), _) => value.whole(key),
            (None, Some(default)) => Ok(default),
            (None, None) => self.need(key.key, &key.allowed())?.whole(key),
        }
    }

    pub fn word_or<T: Clone>(
        &self,
        key: &str,
        words: &[(&str, T)],
        default: T,
    ) -> Result<T, SessionError> {
        self.get(key).map_or(Ok(default), |value| value.word(words))
    }

    /// A word of the device's protocol.
    pub fn vocabulary_or<T: Vocabulary>(&self, key: &str, default: T) -> Result<T, SessionError> {
        let words = T::WORDS.words.iter().copied().zip(T::ALL.iter().copied());
        self.word_or(key, &words.collect::<Vec<_>>(), default)
    }

    pub fn boolean_or(&self, key: &str, default: bool) -> Result<bool, SessionError> {
        self.get(key).map_or(Ok(default), Value::boolean)
    }
}
