//! Sets a device up before its first client comes.

use std::time::Duration;

use thermal_client::client::{Client, ClientError};
use thermal_client::link::{Link, LinkError, ReceivedLine};

use super::ServedDevice;
use crate::simulated_link::VirtualLine;

/// Sends lines to a device, whose time passes until it has accepted each.
///
/// # Errors
/// The device refused a line, or stopped.
pub fn set_up<'a, D: ServedDevice>(
    device: &mut D,
    lines: impl IntoIterator<Item = &'a str>,
) -> Result<(), ClientError> {
    let mut client = Client::new(FirstLine { device, line: VirtualLine::default() });
    lines.into_iter().try_for_each(|line| client.command(line).map(drop))
}

/// The line to a device that nobody else talks to yet.
struct FirstLine<'a, D> {
    device: &'a mut D,
    line: VirtualLine,
}

impl<D: ServedDevice> Link for FirstLine<'_, D> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.line.send(bytes);
        Ok(())
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        let device = &mut *self.device;
        self.line.receive(timeout, |bytes, received| {
            if !bytes.is_empty() {
                device.send(bytes);
            }
            device.run_1_ms().map_err(|stop| LinkError::Gone(stop.to_string()))?;
            device.receive(received);
            Ok(())
        })
    }

    fn now(&self) -> Duration {
        self.line.now()
    }
}
