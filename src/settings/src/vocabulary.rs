//! Words on the line to the host, and the values that they stand for.

/// The words of one kind, such as the control laws.
#[derive(Debug, PartialEq, Eq)]
pub struct WordList {
    /// What they are, for error messages to the host, as in `law`.
    pub kind: &'static str,
    /// The words.
    pub words: &'static [&'static str],
}

/// Values that stand on the line as words.
pub trait Vocabulary: Copy + PartialEq + 'static {
    /// The words, in the order of [`Self::ALL`].
    const WORDS: &'static WordList;
    /// All values.
    const ALL: &'static [Self];

    /// The word that stands for the value.
    fn word(self) -> &'static str;

    /// The value that a word stands for.
    fn of_word(word: &str) -> Option<Self> {
        let place = Self::WORDS.words.iter().position(|known| *known == word);
        place.and_then(|place| Self::ALL.get(place)).copied()
    }
}

/// Declares an enum whose values stand on the line as words.
#[macro_export]
macro_rules! vocabulary {
    (
        $(#[$doc:meta])+
        pub enum $name:ident: $kind:literal {
            $($(#[$value_doc:meta])+ $value:ident = $word:literal,)+
        }
    ) => {
        $(#[$doc])+
        pub enum $name { $($(#[$value_doc])+ $value,)+ }

        impl $name {
            /// All values.
            pub const ALL: &'static [Self] = &[$(Self::$value),+];

            /// Its word on the line.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$value => $word,)+ }
            }
        }

        impl $crate::Vocabulary for $name {
            const WORDS: &'static $crate::WordList =
                &$crate::WordList { kind: $kind, words: &[$($word),+] };
            const ALL: &'static [Self] = Self::ALL;

            fn word(self) -> &'static str {
                self.name()
            }
        }
    };
}
