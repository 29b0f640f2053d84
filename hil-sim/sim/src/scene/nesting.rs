//! Limits the nesting of a scene's text before it is parsed: the parser uses stack for every level, and each dotted key
//! inside a bracket adds its levels.

use std::ops::Range;

use toml_parser::lexer::TokenKind;

use super::source::{SceneError, Source};

/// Largest number of words of a dotted key; `plant.finger.layer.0.thickness_m` has five.
const WORDS: usize = 8;
/// Largest number of nested brackets.
const BRACKETS: usize = 8;

/// Reports the first key or bracket that nests too deeply.
pub(super) fn check(source: &Source<'_>) -> Result<(), SceneError> {
    let (mut key, mut words) = (0..0, 1);
    let mut brackets = 0_usize;
    for token in toml_parser::Source::new(source.text).lex() {
        let span: Range<usize> = token.span().start()..token.span().end();
        key.end = span.end;
        match token.kind() {
            TokenKind::Atom
            | TokenKind::BasicString
            | TokenKind::LiteralString
            | TokenKind::MlBasicString
            | TokenKind::MlLiteralString
            | TokenKind::Whitespace => continue,
            TokenKind::Dot => {
                words += 1;
                if words > WORDS {
                    let begin = source.text.get(key).unwrap_or_default().trim_start();
                    let problem = format!(
                        "{begin} begins a key of more than {WORDS} words; allowed is 1 to {WORDS}"
                    );
                    return Err(source.error(Some(span), problem));
                }
                continue;
            }
            TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => {
                brackets += 1;
                if brackets > BRACKETS {
                    let problem =
                        format!("{brackets} brackets in each other; allowed is 0 to {BRACKETS}");
                    return Err(source.error(Some(span), problem));
                }
            }
            TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => {
                brackets = brackets.saturating_sub(1);
            }
            TokenKind::Equals
            | TokenKind::Comma
            | TokenKind::Comment
            | TokenKind::Newline
            | TokenKind::Eof => {}
        }
        (key, words) = (span.end..span.end, 1);
    }
    Ok(())
}
