//! The mailbox between receiver and host task: every command line gets one answer, in the order of arrival, even when it overflows.

#[path = "../../src/board/mailbox.rs"]
mod mailbox;

use mailbox::{DEPTH, Mailbox};
use thermal_display::protocol::{Line, LineError};

/// Puts the next numbered line into the mailbox and appends it to `sent`.
fn put(inlet: &mut mailbox::Inlet<'_>, sent: &mut Vec<Line>) {
    let line = Line::try_from(format!("line {}", sent.len()).as_str()).expect("short");
    sent.push(line.clone());
    inlet.put(Ok(line));
}

#[test]
fn lines_beyond_the_depth_are_answered_as_refused() {
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

/// All 2^18 interleavings of arrivals and answers.
#[test]
fn answers_come_in_the_order_of_the_lines_for_every_interleaving() {
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
