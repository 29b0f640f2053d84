//! The device's side of the conversation with the host.

use heapless::spsc::Consumer;
use thermal_display::commission::Service;
use thermal_display::protocol::{Command, Error, Reply, Telemetry};
use thermal_display::settings::Settings;

use super::Outbox;
use super::mailbox::Outlet;

/// Answers lines and sends telemetry, as far as there is room to send.
pub struct Console {
    lines: Outlet<'static>,
    telemetry: Consumer<'static, Telemetry>,
    outbox: Outbox,
    service: Service,
}

impl Console {
    /// A console that answers `lines` and sends `telemetry` through `outbox`, on a device with `settings`.
    pub fn new(
        lines: Outlet<'static>,
        telemetry: Consumer<'static, Telemetry>,
        outbox: Outbox,
        settings: Settings,
    ) -> Self {
        Self {
            lines,
            telemetry,
            outbox,
            service: Service::new(settings),
        }
    }

    /// Does what waits: answers first, then telemetry; returns when nothing waits or the outbox is full.
    ///
    /// What waits stays in its queue, so that answers are never lost and only telemetry that finds its
    /// queue full is. `execute` is called with commands that are parsed, checked and computed, since
    /// that takes longer than executing and needs no lock.
    pub fn serve(&mut self, mut execute: impl FnMut(Command) -> Result<Reply, Error>) {
        while self.outbox.has_room() {
            if let Some(line) = self.lines.take() {
                let answer = line
                    .map_err(Error::from)
                    .and_then(|line| self.service.answer(&line, &mut execute));
                match answer {
                    Ok(reply) => self.outbox.send(&reply),
                    Err(error) => {
                        defmt::warn!("line refused: {}", defmt::Display2Format(&error));
                        self.outbox.send(&error);
                    }
                }
            } else if let Some(telemetry) = self.telemetry.dequeue() {
                self.outbox.send(&telemetry);
            } else {
                break;
            }
        }
    }
}
