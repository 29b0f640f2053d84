//! Levels that peripherals drive on their pins, as software reads them in IDR (RM0390 7.3.9: the input data register follows
//! the pin in alternate function too).
use super::{Chip, Output, TIMER_PINS};
use crate::Wiring;
use crate::gpio::Mode;

/// Transmitter of USART2: port, bit and alternate function.
const USART2_TX: (usize, u8, u8) = (0, 2, 7);

impl<W: Wiring> Chip<W> {
    /// Pins of a port that peripherals drive at `now`, and their levels, one bit each.
    pub(super) fn alternate_levels(&mut self, port: usize, now: u64) -> (u32, u32) {
        let (mut driven, mut levels) = (0, 0);
        let mut drive = |bit: u8, level: bool| {
            driven |= 1 << bit;
            levels |= u32::from(level) << bit;
        };
        for (of_port, bit, function, timer, channel) in TIMER_PINS {
            let pins = &self.ports[port];
            if usize::from(of_port) != port || pins.mode(bit) != Mode::Alternate(function) {
                continue;
            }
            let timer = &mut self.tims[timer];
            timer.sync(now);
            if timer.output(channel) != Output::Released {
                drive(bit, timer.is_high(channel, now));
            }
        }
        let (of_port, bit, function) = USART2_TX;
        if of_port == port
            && self.ports[port].mode(bit) == Mode::Alternate(function)
            && let Some(level) = self.usart.tx_level(now)
        {
            drive(bit, level);
        }
        // what an open-drain pin does not pull low, it does not drive
        (driven & !(levels & self.ports[port].open_drain()), levels)
    }
}
