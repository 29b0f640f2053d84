//! Words of an answer.

use super::finite;

/// The words of an answer after `ok`.
#[derive(Clone, Copy, Debug)]
pub struct Fields<'a>(&'a str);

impl<'a> Fields<'a> {
    /// Those of this text, which begins after `ok`.
    pub fn new(text: &'a str) -> Self {
        Self(text.trim())
    }

    /// The whole text.
    pub const fn text(&self) -> &'a str {
        self.0
    }

    /// All words.
    pub fn words(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.0.split_ascii_whitespace()
    }

    /// The word behind `name=`; the first one if the name occurs twice.
    pub fn word(&self, name: &str) -> Option<&'a str> {
        let mut words = self.words().filter_map(|word| word.split_once('='));
        words.find_map(|(word, value)| (word == name).then_some(value))
    }

    /// The finite numbers behind these names.
    pub fn numbers<const N: usize>(&self, names: [&str; N]) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for (number, name) in numbers.iter_mut().zip(names) {
            *number = finite(self.word(name)?)?;
        }
        Some(numbers)
    }
}
