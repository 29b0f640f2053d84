//! The device's side of the conversation with the host.

use heapless::spsc::Consumer;
use thermal_display::commissioning::StorageOrder;
use thermal_display::device::Telemetry;
use thermal_display::device::command::Addressed;
use thermal_display::mailbox::Outlet;
use thermal_display::protocol::{Desk, Error, Execute, Reply, telemetry_line};

use super::{FINGERS, Outbox, restart};

/// Answers lines and sends telemetry, as far as there is room to send.
pub struct Console {
    lines: Outlet<'static>,
    telemetry: Consumer<'static, Addressed<Telemetry>>,
    outbox: Outbox,
    desk: &'static mut Desk<FINGERS>,
    /// What the device says first.
    first: Option<Result<Reply, Error>>,
    /// What is to be stored by starting anew.
    order: Option<StorageOrder>,
}

impl Console {
    /// A console that answers `lines` by its `desk` and sends `telemetry` through `outbox`, after what is to be said `first`.
    pub fn new(
        lines: Outlet<'static>,
        telemetry: Consumer<'static, Addressed<Telemetry>>,
        outbox: Outbox,
        desk: &'static mut Desk<FINGERS>,
        first: Option<Result<Reply, Error>>,
    ) -> Self {
        Self {
            lines,
            telemetry,
            outbox,
            desk,
            first,
            order: None,
        }
    }

    /// Does what waits: answers first, then telemetry; returns when nothing waits or the outbox is full.
    ///
    /// What waits stays in its queue, so that answers are never lost and only telemetry that finds its
    /// queue full is. `execute` is called with requests that are parsed, checked and computed, since
    /// that takes longer than executing and needs no lock.
    pub fn serve(&mut self, mut execute: impl Execute) {
        while self.outbox.has_room() {
            if let Some(order) = self.order {
                if self.outbox.is_empty() {
                    restart(&self.desk.record(order));
                }
                // The end of each line leads here again.
                return;
            }
            if let Some(first) = self.first.take() {
                match first {
                    Ok(reply) => self.outbox.send(&reply),
                    Err(error) => self.outbox.send(&error),
                }
            } else if let Some(line) = self.lines.take() {
                let answer = line
                    .map_err(|error| Addressed::device(Error::from(error)))
                    .and_then(|line| self.desk.answer(&line, &mut execute));
                match answer {
                    Ok(Addressed {
                        said: Reply::Restart(order),
                        ..
                    }) => self.order = Some(order),
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
