//! Levels that peripherals drive on their pins, as software reads them in IDR (RM0390 7.3.9: the input data register follows
//! the pin in alternate function too).
use super::{Chip, Output, TIMER_PINS};
use crate::Wiring;
use crate::gpio::Mode;

/// Transmitter of USART2: port, bit and alternate function.
const USART2_TX: (usize, u8, u8) = (0, 2, 7);

impl<W: Wiring> Chip<W> {
    /// Brings the timers that drive pins of a port up to `now`.
    pub(super) fn sync_timers_of_port(&mut self, port: usize, now: u64) {
        for (of_port, bit, function, timer, _) in TIMER_PINS {
            let driven = usize::from(of_port) == port
                && self.ports[port].mode(bit) == Mode::Alternate(function);
            if driven {
                self.tims[timer].sync(now);
                self.timer_changed(timer, now);
            }
        }
    }

    /// Level that a peripheral drives on a pin; `None` if none does.
    pub(super) fn alternate_level(&self, port: usize, bit: u8, now: u64) -> Option<bool> {
        let Mode::Alternate(function) = self.ports[port].mode(bit) else {
            return None;
        };
        let level = if (port, bit, function) == USART2_TX {
            self.usart.tx_level(now)?
        } else {
            let pin = (port as u8, bit, function);
            let (.., timer, channel) = *TIMER_PINS.iter().find(|p| (p.0, p.1, p.2) == pin)?;
            match self.tims[timer].output(channel) {
                Output::Released => return None,
                Output::High { .. } => self.tims[timer].is_high(channel, now),
            }
        };
        (!level || !self.ports[port].is_open_drain(bit)).then_some(level)
    }
}
