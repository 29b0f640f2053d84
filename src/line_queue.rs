//! The queue of received lines, between the interrupt that receives them and the task that answers
//! them.
//!
//! Every line gets exactly one answer, in the order of arrival. A line that arrives while the queue
//! is full is refused: it is dropped and counted, and its answer is an error. No other line enters
//! the queue until all refused lines are answered, because its answer would overtake theirs.

use core::sync::atomic::{AtomicU32, Ordering};

use heapless::spsc::{Consumer, Producer, Queue};
use thermal_protocol::{Line, LineError};

/// Number of received lines that can wait for their answers. A line beyond that is refused with
/// [`LineError::QueueFull`].
pub const LINE_QUEUE_CAPACITY: usize = 4;

/// A line from the host, or the reason why the received bytes form no valid line.
type ReceivedLineOrError = Result<Line, LineError>;

/// What the queue stores: the line, or an empty line and the error. A `Result` has its tag before the line, which is then not
/// aligned to words, so that copying it takes four times as long.
struct QueuedLine {
    line: Line,
    error: Option<LineError>,
}

/// The queue of lines that were received and wait for their answers. [`split`](Self::split) divides
/// it into a writing end for the receiving interrupt and a reading end for the answering task.
#[derive(Default)]
pub struct LineQueue {
    // The queue always keeps one slot free, to distinguish full from empty.
    lines: Queue<QueuedLine, { LINE_QUEUE_CAPACITY + 1 }>,
    refused: AtomicU32,
}

/// The writing end of a [`LineQueue`], for the interrupt that receives lines from the host.
pub struct LineProducer<'a> {
    lines: Producer<'a, QueuedLine>,
    refused: &'a AtomicU32,
}

/// The reading end of a [`LineQueue`], for the task that answers the lines.
pub struct LineConsumer<'a> {
    lines: Consumer<'a, QueuedLine>,
    refused: &'a AtomicU32,
}

impl LineQueue {
    /// Creates a queue in which no line waits.
    pub const fn new() -> Self {
        Self { lines: Queue::new(), refused: AtomicU32::new(0) }
    }

    /// Divides the queue into its writing end, for the receiving interrupt, and its reading end,
    /// for the answering task.
    pub fn split(&mut self) -> (LineProducer<'_>, LineConsumer<'_>) {
        let (producer, consumer) = self.lines.split();
        let refused = &self.refused;
        (LineProducer { lines: producer, refused }, LineConsumer { lines: consumer, refused })
    }
}

impl LineProducer<'_> {
    /// Appends a line from the host to the queue. If the queue is full, the line is refused: it is
    /// dropped and counted, and [`LineConsumer::dequeue_line_or_queue_full`] returns [`LineError::QueueFull`] in its
    /// place. All further lines are also refused until every refused line has its error answer, so
    /// that the answers keep the order of the lines.
    #[inline]
    pub fn enqueue_or_count_refused(&mut self, line: ReceivedLineOrError) {
        if self.refused.load(Ordering::Acquire) > 0 || !self.lines.ready() {
            self.refused.fetch_add(1, Ordering::Release);
            return;
        }
        let (line, error) = match line {
            Ok(line) => (line, None),
            Err(error) => (Line::new(), Some(error)),
        };
        if self.lines.enqueue(QueuedLine { line, error }).is_err() {
            self.refused.fetch_add(1, Ordering::Release);
        }
    }
}

impl LineConsumer<'_> {
    /// Removes and returns the next line to be answered, or [`LineError::QueueFull`] in place of a
    /// line that was refused. `None` if no line waits for an answer.
    pub fn dequeue_line_or_queue_full(&mut self) -> Option<ReceivedLineOrError> {
        // The count is read before the queue. While it is above zero no line enters the queue, so
        // if the queue is empty then the refused lines are next.
        let refused = self.refused.load(Ordering::Acquire);
        if let Some(QueuedLine { line, error }) = self.lines.dequeue() {
            return Some(error.map_or(Ok(line), Err));
        }
        (refused > 0).then(|| {
            self.refused.fetch_sub(1, Ordering::Release);
            Err(LineError::QueueFull)
        })
    }
}
