//! Limits the nesting of a file before it is parsed: the parser's values are dropped on the stack, level by level, and a
//! dotted key makes a level of each of its words.

use toml_parser::lexer::TokenKind;

use super::source::{SessionError, Source};

/// Largest number of words of a dotted key; `present.real-left.left.sample` has four.
const WORDS: usize = 8;
/// Largest number of brackets in each other.
const BRACKETS: usize = 8;

/// Reports the first key or bracket that nests too deeply.
pub(super) fn check(source: &Source<'_>) -> Result<(), SessionError> {
    let (mut words, mut brackets) = (1, 0_usize);
    for token in toml_parser::Source::new(source.text).lex() {
        let at = token.span().start();
        match token.kind() {
            TokenKind::Dot => {
                words += 1;
                if words > WORDS {
                    let problem =
                        format!("a key of more than {WORDS} words; allowed is 1 to {WORDS}");
                    return Err(source.error(at, problem));
                }
            }
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => {
                (words, brackets) = (1, brackets + 1);
                if brackets > BRACKETS {
                    let problem =
                        format!("{brackets} brackets in each other; allowed is 0 to {BRACKETS}");
                    return Err(source.error(at, problem));
                }
            }
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => {
                (words, brackets) = (1, brackets.saturating_sub(1));
            }
            TokenKind::Equals
            | TokenKind::Comma
            | TokenKind::Comment
            | TokenKind::Newline
            | TokenKind::Eof => words = 1,
            TokenKind::Atom
            | TokenKind::BasicString
            | TokenKind::LiteralString
            | TokenKind::MlBasicString
            | TokenKind::MlLiteralString
            | TokenKind::Whitespace => {}
        }
    }
    Ok(())
}
