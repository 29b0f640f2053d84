//! The console: answers the host's lines and sends telemetry.

use core::fmt::Display;

use heapless::spsc::Consumer;
use thermal_display::commissioning::StorageOrder;
use thermal_display::device::command::WithSourceFinger;
use thermal_display::device::events::UnsolicitedReport;
use thermal_display::line_queue::LineConsumer;
use thermal_display::protocol::{
    BoardStatus, CommandHandler, Error, ExecuteOnStations, Reply, UnsolicitedLine,
};

use super::{FINGERS, Outbox, board_status_now, restart_to_save};

/// The host task's part of the serial line: answers received lines, and sends queued telemetry to
/// the host.
pub struct Console {
    pub lines: LineConsumer<'static>,
    pub telemetry: Consumer<'static, WithSourceFinger<UnsolicitedReport>>,
    pub outbox: Outbox,
    pub handler: &'static mut CommandHandler<FINGERS>,
    /// The answer to `save` or `forget` after the restart that either of them requests: whether the
    /// settings were stored. Sent before any other line; `None` after any other start, and once
    /// sent.
    pub first_answer: Option<Result<Reply, Error>>,
    /// State of the board as the start has found it.
    pub status_at_start: BoardStatus,
    /// The order of the host to store the present settings (`save`) or factory defaults (`forget`).
    /// Once all lines in the outbox are sent, the console restarts the device to execute this
    /// order. `None` while there is no order.
    pub storage_order: Option<StorageOrder>,
}

impl Console {
    /// Answers received lines and sends queued telemetry, answers first, until nothing waits or the
    /// [`Outbox`] is full. What does not fit into the outbox stays in its queue for the next call.
    ///
    /// No answer is ever lost; telemetry is lost only when its queue is full. A request is parsed,
    /// checked and computed without locking the device, because that takes long; only `execute`,
    /// which executes the resulting command, locks it. After `save` or `forget` no more lines are
    /// answered, and the device restarts once the outbox is empty.
    pub fn answer_lines_and_send_telemetry(
        &mut self,
        mut execute: impl ExecuteOnStations<FINGERS>,
    ) {
        while self.outbox.has_room() {
            if let Some(order) = self.storage_order {
                if self.outbox.is_empty() {
                    restart_to_save(&self.handler.record_to_save_or_forget(order));
                }
                // The task is called again whenever a line has been sent.
                return;
            }
            if let Some(first_answer) = self.first_answer.take() {
                match first_answer {
                    Ok(reply) => self.send(&reply),
                    Err(error) => self.send(&error),
                }
            } else if let Some(line) = self.lines.dequeue_line_or_queue_full() {
                self.handler.board = board_status_now(&self.status_at_start);
                let answer = line
                    .map_err(|error| WithSourceFinger::from_whole_device(Error::from(error)))
                    .and_then(|line| self.handler.answer(&line, &mut execute));
                match answer {
                    Ok(WithSourceFinger { content: Reply::Restart(order), .. }) => {
                        self.storage_order = Some(order)
                    }
                    Ok(reply) => self.send(&reply),
                    Err(error) => {
                        defmt::warn!("line refused: {}", defmt::Display2Format(&error));
                        self.send(&error);
                    }
                }
            } else if let Some(report) = self.telemetry.dequeue() {
                self.send(&UnsolicitedLine::of_report(report, &mut execute));
            } else {
                break;
            }
        }
    }

    fn send(&mut self, content: &dyn Display) {
        let handler = &self.handler;
        self.outbox.enqueue_or_drop(|line| handler.write_line(line, content));
    }
}
