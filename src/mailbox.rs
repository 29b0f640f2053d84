//! Lines on their way from the receiver to the task that answers them.
//!
//! Every line gets exactly one answer, in order. When more lines arrive than are waited for, those that do
//! not fit are counted and the sender is told so; until it has been told of all of them, nothing is accepted,
//! which keeps the answers in the order of the lines.

use core::sync::atomic::{AtomicU32, Ordering};

use heapless::spsc::{Consumer, Producer, Queue};
use thermal_protocol::{Line, LineError};

/// Lines that may wait.
pub const DEPTH: usize = 4;

type Received = Result<Line, LineError>;

/// The store of both ends.
pub struct Mailbox {
    // One slot of the queue tells full from empty.
    lines: Queue<Received, { DEPTH + 1 }>,
    refused: AtomicU32,
}

/// Where lines come in.
pub struct Inlet<'a> {
    lines: Producer<'a, Received>,
    refused: &'a AtomicU32,
}

/// Where lines are taken out.
pub struct Outlet<'a> {
    lines: Consumer<'a, Received>,
    refused: &'a AtomicU32,
}

impl Mailbox {
    /// An empty mailbox.
    pub const fn new() -> Self {
        Self {
            lines: Queue::new(),
            refused: AtomicU32::new(0),
        }
    }

    /// Its two ends, one for each of two tasks.
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
    /// Puts a line in, or counts it as refused.
    pub fn put(&mut self, line: Received) {
        if self.refused.load(Ordering::Acquire) > 0 || self.lines.enqueue(line).is_err() {
            self.refused.fetch_add(1, Ordering::Release);
        }
    }
}

impl Outlet<'_> {
    /// The next line to be answered; [`LineError::Refused`] for one that found no place.
    pub fn take(&mut self) -> Option<Received> {
        // Looked at before the queue: while it is not zero nothing is put in, so an empty queue then means
        // that the refused lines are next.
        let refused = self.refused.load(Ordering::Acquire);
        if let Some(line) = self.lines.dequeue() {
            return Some(line);
        }
        (refused > 0).then(|| {
            self.refused.fetch_sub(1, Ordering::Release);
            Err(LineError::Refused)
        })
    }
}
