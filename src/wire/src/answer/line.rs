//! An answer that is being written.

use core::fmt::{self, Display as _};

use crate::{Argument, LineBuffer};

/// An answer that is being written: a beginning, then words.
pub struct AnswerLine<'a, 'b> {
    formatter: &'a mut fmt::Formatter<'b>,
    buffer: LineBuffer,
    names: &'static str,
    result: fmt::Result,
}

impl<'a, 'b> AnswerLine<'a, 'b> {
    /// An answer that begins so, with `ok` or why something is refused.
    pub fn new(formatter: &'a mut fmt::Formatter<'b>, beginning: &str) -> Self {
        let mut buffer = LineBuffer::new();
        buffer.push_str_if_fits(beginning);
        Self { formatter, buffer, names: "", result: Ok(()) }
    }

    /// The values that follow have these names, each with a space behind it: an address and a length for each of them would take
    /// 0.7 KB of flash.
    pub const fn begin_values(&mut self, names: &'static str) {
        self.names = names;
    }

    /// Appends a word.
    #[inline(never)]
    pub fn word(&mut self, word: &str) -> &mut LineBuffer {
        // An answer can be longer than the buffer, a value cannot.
        self.hand_on();
        self.buffer.push_str_if_fits(" ");
        self.buffer.push_str_if_fits(word);
        &mut self.buffer
    }

    /// The name of the next value.
    #[inline(never)]
    pub fn next_name(&mut self) -> &'static str {
        let (name, others) = self.names.split_once([' ']).unwrap_or_default();
        self.names = others;
        name
    }

    /// Appends a name and `=`; the value is to be appended to the buffer.
    #[inline(never)]
    pub fn name(&mut self, name: &str) -> &mut LineBuffer {
        self.word(name).push_str_if_fits("=");
        &mut self.buffer
    }

    /// Appends the name of the next value and `=`; the value is to be appended to the buffer.
    #[inline(never)]
    pub fn named(&mut self) -> &mut LineBuffer {
        let name = self.next_name();
        self.name(name)
    }

    /// Appends numbers behind names of their own, with so many decimals; the next name stands for all of them.
    #[inline(never)]
    pub fn numbers(&mut self, names: &[&str], numbers: &[f64], decimals: &[i32]) {
        self.next_name();
        for ((name, number), decimals) in names.iter().zip(numbers).zip(decimals) {
            self.name(name).push_decimal(*number, *decimals as usize);
        }
    }

    /// Appends an argument, as a host would send it.
    pub fn argument(&mut self, argument: &impl Argument) {
        self.hand_on();
        self.result = self.result.and(argument.write(self.formatter));
    }

    #[inline(never)]
    fn hand_on(&mut self) {
        self.result = self.result.and(self.buffer.fmt(self.formatter));
        self.buffer.clear();
    }

    /// Ends the answer.
    ///
    /// # Errors
    /// That of the formatter.
    pub fn end(mut self) -> fmt::Result {
        self.hand_on();
        self.result
    }
}
