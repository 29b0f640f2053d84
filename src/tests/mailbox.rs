//! Every line has one answer, in order, whatever the load.

use std::format;
use std::vec::Vec;

use crate::mailbox::{self, DEPTH, Mailbox};
use crate::protocol::{Line, LineError};

/// Puts line number `n` in and notes it.
fn put(inlet: &mut mailbox::Inlet<'_>, sent: &mut Vec<Line>) {
    let line = Line::try_from(format!("line {}", sent.len()).as_str()).expect("short");
    sent.push(line.clone());
    inlet.put(Ok(line));
}

#[test]
fn lines_that_fit_come_out_and_the_others_are_counted() {
    let mut mailbox = Mailbox::new();
    let (mut inlet, mut outlet) = mailbox.split();
    let mut sent = Vec::new();
    for _ in 0..DEPTH + 3 {
        put(&mut inlet, &mut sent);
    }
    for line in &sent[..DEPTH] {
        assert_eq!(outlet.take(), Some(Ok(line.clone())));
    }
    for _ in 0..3 {
        assert_eq!(outlet.take(), Some(Err(LineError::Refused)));
    }
    assert_eq!(outlet.take(), None);
}

/// All ways to mix 18 arrivals and answers.
#[test]
fn answers_come_in_the_order_of_the_lines() {
    for order in 0..1u32 << 18 {
        let mut mailbox = Mailbox::new();
        let (mut inlet, mut outlet) = mailbox.split();
        let (mut sent, mut answered) = (Vec::new(), Vec::new());
        for step in 0..18 {
            if order >> step & 1 == 1 {
                put(&mut inlet, &mut sent);
            } else {
                answered.extend(outlet.take());
            }
        }
        answered.extend(std::iter::from_fn(|| outlet.take()));
        assert_eq!(answered.len(), sent.len(), "order {order:#b}");
        for (answer, line) in answered.iter().zip(&sent) {
            match answer {
                Ok(text) => assert_eq!(text, line, "order {order:#b}"),
                Err(error) => assert_eq!(*error, LineError::Refused, "order {order:#b}"),
            }
        }
    }
}
