//! The queue yields one answer for each line, in the order of the lines, also when it overflows.

use std::format;
use std::vec::Vec;

use crate::line_queue::{self, LINE_QUEUE_CAPACITY, LineQueue};
use crate::protocol::{Line, LineError};

/// Puts a numbered line into the queue and appends it to `sent`.
fn put(inlet: &mut line_queue::LineProducer<'_>, sent: &mut Vec<Line>) {
    let line = Line::try_from(format!("line {}", sent.len()).as_str()).expect("short");
    sent.push(line.clone());
    inlet.enqueue_or_count_refused(Ok(line));
}

#[test]
fn lines_beyond_the_depth_are_taken_as_refused() {
    let mut line_queue = LineQueue::new();
    let (mut inlet, mut outlet) = line_queue.split();
    let mut sent = Vec::new();
    for _ in 0..LINE_QUEUE_CAPACITY + 3 {
        put(&mut inlet, &mut sent);
    }
    for line in &sent[..LINE_QUEUE_CAPACITY] {
        assert_eq!(outlet.dequeue_line_or_queue_full(), Some(Ok(line.clone())));
    }
    for _ in 0..3 {
        assert_eq!(outlet.dequeue_line_or_queue_full(), Some(Err(LineError::QueueFull)));
    }
    assert_eq!(outlet.dequeue_line_or_queue_full(), None);
}

/// Tries every sequence of 18 steps, each of which puts or takes one line.
#[test]
fn lines_are_taken_in_the_order_in_which_they_were_put() {
    for sequence in 0..1u32 << 18 {
        let mut line_queue = LineQueue::new();
        let (mut inlet, mut outlet) = line_queue.split();
        let (mut sent, mut answered) = (Vec::new(), Vec::new());
        for step in 0..18 {
            if sequence >> step & 1 == 1 {
                put(&mut inlet, &mut sent);
            } else {
                answered.extend(outlet.dequeue_line_or_queue_full());
            }
        }
        answered.extend(std::iter::from_fn(|| outlet.dequeue_line_or_queue_full()));
        assert_eq!(answered.len(), sent.len(), "sequence {sequence:#b}");
        for (answer, line) in answered.iter().zip(&sent) {
            match answer {
                Ok(text) => assert_eq!(text, line, "sequence {sequence:#b}"),
                Err(error) => assert_eq!(*error, LineError::QueueFull, "sequence {sequence:#b}"),
            }
        }
    }
}
