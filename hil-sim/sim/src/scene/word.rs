//! Words that a key of a scene may have.

use std::fmt;

use serde::de::{Error, Unexpected, Visitor};

/// Declares an enum whose variants are words in a scene.
macro_rules! words {
    ($(#[$attribute:meta])* $visibility:vis enum $enum:ident {
        $($(#[$variant_attribute:meta])* $variant:ident = $word:literal,)*
    }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy)]
        $visibility enum $enum {
            $($(#[$variant_attribute])* $variant,)*
        }

        impl<'de> Deserialize<'de> for $enum {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let index = deserializer.deserialize_str(OneOf(&[$($word),*]))?;
                Ok([$(Self::$variant),*][index])
            }
        }
    };
}
pub(super) use words;

/// Reads one of these words, as its index. A derived reader would not say which words are allowed instead of a number.
pub(super) struct OneOf(pub &'static [&'static str]);

impl Visitor<'_> for OneOf {
    type Value = usize;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words: Vec<_> = self.0.iter().map(|word| format!("{word:?}")).collect();
        f.write_str(&words.join(" or "))
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<usize, E> {
        let index = self.0.iter().position(|known| *known == word);
        index.ok_or_else(|| E::invalid_value(Unexpected::Str(word), &self))
    }
}
