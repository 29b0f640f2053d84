//! The queue of received lines, between the interrupt that receives them and the task that answers
//! them.
//!
//! Every line gets exactly one answer, in the order of arrival. A line that arrives while the queue
//! is full is only counted, and answered by an error. Until all counted lines are answered, no
//! other line enters the queue, because its answer would overtake theirs.

use core::sync::atomic::{AtomicU32, Ordering};

use heapless::spsc::{Consumer, Producer, Queue};
use thermal_protocol::{Line, LineError};

/// Number of received lines that can wait for their answers.
pub const DEPTH: usize = 4;

/// A received line, or why it could not be received.
type Received = Result<Line, LineError>;

/// The queue, which [`split`](Self::split) divides into its two ends.
#[derive(Default)]
pub struct Mailbox {
    // The queue always keeps one slot free, to tell full from empty.
    lines: Queue<Received, { DEPTH + 1 }>,
    refused: AtomicU32,
}

/// The end that the receiver puts lines into.
pub struct Inlet<'a> {
    lines: Producer<'a, Received>,
    refused: &'a AtomicU32,
}

/// The end that the answering task takes lines from.
pub struct Outlet<'a> {
    lines: Consumer<'a, Received>,
    refused: &'a AtomicU32,
}

impl Mailbox {
    /// A mailbox in which no line waits.
    pub const fn new() -> Self {
        Self {
            lines: Queue::new(),
            refused: AtomicU32::new(0),
        }
    }

    /// The two ends of the queue, each for one task.
    pub fn split(&mut self) -> (Inlet<'_>, Outlet<'_>) {
        let (producer, consumer) = self.lines.split();
        let refused = &self.refused;
        (
            Inlet {
                lines: producer,
                refused,
            },
            Outlet {
                lines: consumer,
                refused,
            },
        )
    }
}

impl Inlet<'_> {
    /// Appends a line to the queue, or counts it as refused if the queue is full or refused lines
    /// are not answered yet.
    pub fn put(&mut self, line: Received) {
        if self.refused.load(Ordering::Acquire) > 0 || self.lines.enqueue(line).is_err() {
            self.refused.fetch_add(1, Ordering::Release);
        }
    }
}

impl Outlet<'_> {
    /// Takes the next line to be answered; [`LineError::QueueFull`] stands for a line that did not
    /// fit into the queue.
    pub fn take(&mut self) -> Option<Received> {
        // The count is read before the queue. While it is above zero no line enters the queue, so
        // if the queue is empty then the refused lines are next.
        let refused = self.refused.load(Ordering::Acquire);
        if let Some(line) = self.lines.dequeue() {
            return Some(line);
        }
        (refused > 0).then(|| {
            self.refused.fetch_sub(1, Ordering::Release);
            Err(LineError::QueueFull)
        })
    }
}
