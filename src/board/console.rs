//! The console: answers the host's lines and sends telemetry.

use heapless::spsc::Consumer;
use thermal_display::commissioning::StorageOrder;
use thermal_display::device::Telemetry;
use thermal_display::device::command::Addressed;
use thermal_display::mailbox::Outlet;
use thermal_display::protocol::{CommandHandler, Error, Execute, Reply, telemetry_line};

use super::{FINGERS, Outbox, restart_to_save};

/// Takes received lines and telemetry from their queues and sends answers and telemetry lines to
/// the host.
pub struct Console {
    pub lines: Outlet<'static>,
    pub telemetry: Consumer<'static, Addressed<Telemetry>>,
    pub outbox: Outbox,
    pub handler: &'static mut CommandHandler<FINGERS>,
    /// Sent before anything else: the answer to the line that requested the restart.
    pub first_answer: Option<Result<Reply, Error>>,
    /// The settings are to be stored or erased by a restart, once all answers are sent.
    pub storage_order: Option<StorageOrder>,
}

impl Console {
    /// Sends what waits, answers before telemetry, until nothing waits or the outbox is full.
    ///
    /// What does not fit into the outbox stays in its queue. No answer is ever lost; telemetry is
    /// lost only when its queue is full. A request is parsed, checked and computed here, which
    /// takes long but needs no lock; `execute` then executes the resulting command under one.
    pub fn serve(&mut self, mut execute: impl Execute<FINGERS>) {
        while self.outbox.has_room() {
            if let Some(order) = self.storage_order {
                if self.outbox.is_empty() {
                    restart_to_save(&self.handler.settings_record(order));
                }
                // The task is called again whenever a line has been sent.
                return;
            }
            if let Some(first_answer) = self.first_answer.take() {
                match first_answer {
                    Ok(reply) => self.outbox.send(&reply),
                    Err(error) => self.outbox.send(&error),
                }
            } else if let Some(line) = self.lines.take() {
                let answer = line
                    .map_err(|error| Addressed::from_whole_device(Error::from(error)))
                    .and_then(|line| self.handler.answer(&line, &mut execute));
                match answer {
                    Ok(Addressed {
                        content: Reply::Restart(order),
                        ..
                    }) => self.storage_order = Some(order),
                    Ok(reply) => self.outbox.send(&reply),
                    Err(error) => {
                        defmt::warn!("line refused: {}", defmt::Display2Format(&error));
                        self.outbox.send(&error);
                    }
                }
            } else if let Some(telemetry) = self.telemetry.dequeue() {
                self.outbox.send(&telemetry_line(telemetry));
            } else {
                break;
            }
        }
    }
}
