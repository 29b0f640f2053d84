//! USART2 (RM0390 chapter 25) as an asynchronous 8N1 port with interrupts, DMA and single-wire mode, and the host at the other end
//! of the line.
use super::stop::{Answer, Refusal, only};
use std::collections::VecDeque;

const FE: u32 = 1 << 1;
const ORE: u32 = 1 << 3;
const IDLE: u32 = 1 << 4;
const RXNE: u32 = 1 << 5;
const TC: u32 = 1 << 6;
const TXE: u32 = 1 << 7;
const UE: u32 = 1 << 13;
const TE: u32 = 1 << 3;
const RE: u32 = 1 << 2;
/// Single-wire mode, in CR3.
const HDSEL: u32 = 1 << 3;
/// Bits of a frame: start, eight data, stop.
const FRAME_BITS: u64 = 10;

/// Content of the transmitter's shift register.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Shift {
    #[default]
    Nothing,
    /// The idle frame that TE sends first (25.4.2).
    Preamble,
    Byte(u8),
}

#[derive(Default)]
pub(crate) struct Usart {
    sr: u32,
    /// Error and idle flags in the last read of SR; a read of DR clears these (25.6.1).
    sr_seen: u32,
    received: u32,
    waiting: u8,
    shift: Shift,
    brr: u32,
    cr1: u32,
    cr2: u32,
    cr3: u32,
    bus_divider: u64,
    hclk_hz: u32,
    host_baud: u32,
    incoming: VecDeque<u8>,
    /// First bit of the byte at the front of `incoming`, in 1/65536 cycles.
    arrival: u128,
    idle_at: u64,
    pub tx_due: u64,
    pub rx_due: u64,
}

impl Usart {
    pub fn new(bus_divider: u64, hclk_hz: u32, host_baud: u32) -> Self {
        Self {
            sr: TC | TXE,
            bus_divider,
            hclk_hz,
            host_baud,
            idle_at: u64::MAX,
            tx_due: u64::MAX,
            rx_due: u64::MAX,
            ..Self::default()
        }
    }

    /// Resets the peripheral; the host and its pending bytes stay.
    pub fn reset(&mut self) {
        let fresh = Self::new(self.bus_divider, self.hclk_hz, self.host_baud);
        let incoming = std::mem::take(&mut self.incoming);
        *self = Self {
            rx_due: if incoming.is_empty() { u64::MAX } else { self.rx_due },
            arrival: self.arrival,
            incoming,
            ..fresh
        };
    }

    pub fn set_clock(&mut self, bus_divider: u64, hclk_hz: u32) {
        (self.bus_divider, self.hclk_hz) = (bus_divider, hclk_hz);
    }

    pub fn set_host_baud(&mut self, baud: u32) {
        self.host_baud = baud.max(1);
    }

    /// CPU cycles per bit: USARTDIV * 16 (or 8) bus clocks, which is BRR itself, its fraction at OVER8 in
    /// three bits (25.4.4).
    fn bit_cycles(&self) -> u64 {
        let brr = u64::from(self.brr);
        self.bus_divider * if self.cr1 >> 15 != 0 { (brr >> 4 << 3) + (brr & 7) } else { brr }
    }

    /// Baud rate of the transmitter, rounded to 1 Bd; 0 while BRR is 0.
    pub fn baud(&self) -> u32 {
        let bit = self.bit_cycles();
        (u64::from(self.hclk_hz) + bit / 2).checked_div(bit).map_or(0, |b| b as u32)
    }

    fn host_frame(&self) -> u128 {
        ((u128::from(self.hclk_hz) * u128::from(FRAME_BITS)) << 16) / u128::from(self.host_baud)
    }

    /// The host sends `bytes` from `now` on, or after the bytes that it is still sending.
    pub fn send(&mut self, bytes: &[u8], now: u64) {
        if self.incoming.is_empty() {
            self.arrival = u128::from(now) << 16;
        }
        self.incoming.extend(bytes);
        self.schedule_rx();
    }

    fn schedule_rx(&mut self) {
        self.rx_due = if self.incoming.is_empty() {
            self.idle_at
        } else {
            ((self.arrival + self.host_frame()) >> 16) as u64
        };
    }

    /// Event at the receiver: the end of a byte's stop bit, or a frame of idle line. `connected`: PA3 is the receiver's pin.
    pub fn receive(&mut self, connected: bool) {
        let Some(byte) = self.incoming.pop_front() else {
            self.idle_at = u64::MAX;
            self.rx_due = u64::MAX;
            if self.is_receiving() {
                self.sr |= IDLE;
            }
            return;
        };
        self.arrival += self.host_frame();
        let now = self.rx_due;
        if connected && self.is_receiving() && self.cr3 & HDSEL == 0 {
            let (value, checked_frame) = self.sampled(byte);
            self.take_in(value, checked_frame, now);
        }
        self.schedule_rx();
    }

    /// A frame that the transmitter has just sent: in single-wire mode the receiver hears it (25.4.10).
    pub fn hear_own(&mut self, byte: u8, now: u64) {
        if self.cr3 & HDSEL != 0 && self.is_receiving() {
            self.take_in(byte.into(), true, now);
            self.schedule_rx();
        }
    }

    fn take_in(&mut self, value: u32, checked_frame: bool, now: u64) {
        if self.sr & RXNE != 0 {
            self.sr |= ORE; // the new byte is lost (25.4.3)
        } else {
            self.received = value;
            self.sr |= RXNE | if checked_frame { 0 } else { FE };
        }
        self.idle_at = now + FRAME_BITS * self.bit_cycles();
    }

    fn is_receiving(&self) -> bool {
        self.cr1 & (UE | RE) == UE | RE && self.brr != 0
    }

    /// The value that the receiver samples, in the middle of its own bits, of a byte at the host's rate; and whether the frame
    /// is valid: the rates may differ by 3 % (25.4.5 allows 3.3 to 3.9 %).
    fn sampled(&self, byte: u8) -> (u32, bool) {
        let own = self.bit_cycles() * u64::from(self.host_baud);
        let host = u64::from(self.hclk_hz);
        let line = u32::from(byte) << 1 | 1 << 9;
        let level = |bit: u64| {
            let at = (2 * bit + 1) * own / (2 * host);
            at >= FRAME_BITS || line >> at & 1 != 0
        };
        let value = (0..8).filter(|b| level(b + 1)).map(|b| 1 << b).sum();
        let close = own.abs_diff(host) * 100 <= 3 * host;
        (value, close && level(FRAME_BITS - 1))
    }

    /// End of the frame in the shift register; its byte, `None` for the preamble.
    pub fn transmitted(&mut self) -> Option<u8> {
        let sent = self.shift;
        let at = self.tx_due;
        self.shift = Shift::Nothing;
        self.tx_due = u64::MAX;
        if self.sr & TXE == 0 {
            self.load_shift(at);
        } else {
            self.sr |= TC;
        }
        match sent {
            Shift::Byte(byte) => Some(byte),
            _ => None,
        }
    }

    fn load_shift(&mut self, now: u64) {
        self.shift = Shift::Byte(self.waiting);
        self.sr |= TXE;
        self.tx_due = now + FRAME_BITS * self.bit_cycles();
    }

    /// Level of the transmitter's pin; `None` while the transmitter is off.
    pub fn tx_level(&self, now: u64) -> Option<bool> {
        let on = self.cr1 & (UE | TE) == UE | TE;
        let level = match self.shift {
            Shift::Byte(byte) => {
                let left = self.tx_due.saturating_sub(now);
                let sent = FRAME_BITS.saturating_sub(left.div_ceil(self.bit_cycles()));
                (u32::from(byte) << 1 | 1 << (FRAME_BITS - 1)) >> sent & 1 != 0
            }
            Shift::Nothing | Shift::Preamble => true,
        };
        on.then_some(level)
    }

    /// Whether the transmitter requests a byte by DMA.
    pub fn wants_tx(&self) -> bool {
        self.cr3 >> 7 & 1 != 0 && self.sr & TXE != 0 && self.cr1 & (UE | TE) == UE | TE
    }

    /// Whether the receiver requests a transfer of its byte by DMA.
    pub fn offers_rx(&self) -> bool {
        self.cr3 >> 6 & 1 != 0 && self.sr & RXNE != 0
    }

    /// Writes the data register, from the CPU or by DMA.
    pub fn write_data(&mut self, value: u32, now: u64) {
        self.sr &= !TC;
        self.waiting = value as u8;
        self.sr &= !TXE;
        let on = self.cr1 & (UE | TE) == UE | TE && self.brr != 0;
        if on && self.shift == Shift::Nothing {
            self.load_shift(now);
        }
    }

    /// Reads the data register, from the CPU or by DMA.
    pub fn read_data(&mut self) -> u32 {
        self.sr &= !RXNE & !self.sr_seen;
        self.sr_seen = 0;
        self.received
    }

    /// Interrupt request (25.5).
    pub fn request(&self) -> bool {
        let enabled = (self.cr1 & 0x80 != 0 && self.sr & TXE != 0)
            || (self.cr1 & 0x40 != 0 && self.sr & TC != 0)
            || (self.cr1 & 0x20 != 0 && self.sr & (RXNE | ORE) != 0)
            || (self.cr1 & 0x10 != 0 && self.sr & IDLE != 0)
            || (self.cr3 & 1 != 0 && self.cr3 & 0x40 != 0 && self.sr & (FE | ORE) != 0);
        enabled && self.cr1 & UE != 0
    }

    pub fn read(&mut self, offset: u32) -> Answer<u32> {
        Ok(match offset {
            0x00 => {
                self.sr_seen = self.sr & (FE | ORE | IDLE);
                self.sr
            }
            0x04 => self.read_data(),
            0x08 => self.brr,
            0x0c => self.cr1,
            0x10 => self.cr2,
            0x14 => self.cr3,
            0x18 => 0,
            _ => return Err(Refusal::Offset),
        })
    }

    pub fn write(&mut self, offset: u32, value: u32, now: u64) -> Answer<()> {
        match offset {
            0x00 => self.sr &= value | !(TC | RXNE), // the other flags are cleared by reading SR, then DR
            0x04 => {
                only(value, 0x1ff, "USART_DR reserved bits")?;
                self.write_data(value, now);
            }
            0x08 => {
                only(value, 0xffff, "USART_BRR reserved bits")?;
                self.brr = value;
            }
            0x0c => {
                only(value, 0xa1fc, "USART_CR1 beyond 8N1 (M, PCE, WAKE, RWU, SBK)")?;
                only(value & 0x0100, 0, "USART_CR1.PEIE")?;
                let starts = value & (UE | TE) == UE | TE && self.cr1 & (UE | TE) != UE | TE;
                self.cr1 = value;
                if starts && self.shift == Shift::Nothing && self.brr != 0 {
                    self.shift = Shift::Preamble;
                    self.tx_due = now + FRAME_BITS * self.bit_cycles();
                }
                if value & (UE | TE) != UE | TE {
                    self.shift = Shift::Nothing;
                    self.tx_due = u64::MAX;
                }
            }
            0x10 => {
                only(value, 0, "USART_CR2 (stop bits, clock, LIN)")?;
                self.cr2 = value;
            }
            0x14 => {
                only(value, 0x08c1 | HDSEL, "USART_CR3 beyond DMAT, DMAR, HDSEL, EIE and ONEBIT")?;
                self.cr3 = value;
            }
            0x18 => only(value, 0, "USART_GTPR")?,
            _ => return Err(Refusal::Offset),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// PCLK1 = 45 MHz at HCLK = 180 MHz, receiver and transmitter on, past the first idle frame.
    fn usart(brr: u32, over8: bool, extra: u32) -> Usart {
        let mut usart = Usart::new(4, 180_000_000, 1_000_000);
        usart.write(0x08, brr, 0).unwrap();
        usart.write(0x0c, UE | TE | RE | u32::from(over8) << 15 | extra, 0).unwrap();
        assert_eq!(usart.transmitted(), None);
        usart
    }

    #[test]
    fn baud_is_that_of_the_divider() {
        assert_eq!(usart(45, false, 0).baud(), 1_000_000, "USARTDIV = 2.8125");
        assert_eq!(
            usart(5 << 4 | 5, true, 0).baud(),
            1_000_000,
            "OVER8: USARTDIV = 5.625, three bits of fraction"
        );
        // 45 MHz / (16 * 24.4375) = 115 089.5
        assert_eq!(usart(24 * 16 + 7, false, 0).baud(), 115_090);
    }

    #[test]
    fn transmission_keeps_one_byte_waiting() {
        let mut usart = usart(45, false, 0);
        usart.write(0x04, 0x41, 10_000).unwrap();
        assert_eq!((usart.sr & (TXE | TC), usart.tx_due), (TXE, 11_800), "ten bits of 180 cycles");
        usart.write(0x04, 0x42, 10_100).unwrap();
        assert_eq!(usart.sr & (TXE | TC), 0);
        assert_eq!((usart.transmitted(), usart.tx_due), (Some(0x41), 13_600), "back to back");
        assert_eq!(usart.transmitted(), Some(0x42));
        assert_eq!(usart.sr & (TXE | TC), TXE | TC);
    }

    #[test]
    fn an_unread_byte_overruns_and_the_new_one_is_lost() {
        let mut usart = usart(45, false, 0x20);
        usart.send(b"ab", 20_000);
        assert_eq!(usart.rx_due, 21_800);
        usart.receive(true);
        assert!(usart.request());
        usart.receive(true);
        assert_eq!(usart.read(0).unwrap() & (RXNE | ORE), RXNE | ORE);
        assert_eq!(usart.read(4).unwrap(), u32::from(b'a'));
        assert_eq!(usart.read(0).unwrap() & (RXNE | ORE), 0, "SR then DR clears both");
        assert!(!usart.request());
    }

    #[test]
    fn in_single_wire_mode_the_transmitter_hears_itself_and_not_the_host() {
        let mut usart = usart(45, false, 0);
        usart.write(0x14, HDSEL, 0).unwrap();
        usart.write(0x04, 0x41, 10_000).unwrap();
        let sent = usart.transmitted().unwrap();
        usart.hear_own(sent, 11_800);
        assert_eq!(usart.read(0).unwrap() & RXNE, RXNE);
        assert_eq!(usart.read(4).unwrap(), 0x41);
        usart.send(b"a", 20_000);
        usart.receive(true);
        assert_eq!(usart.read(0).unwrap() & RXNE, 0);
    }

    #[test]
    fn the_line_is_idle_a_frame_after_the_last_byte() {
        let mut usart = usart(45, false, 0x10);
        usart.send(b"a", 20_000);
        usart.receive(true);
        assert_eq!(usart.rx_due, 21_800 + 1800);
        usart.receive(true);
        assert!(usart.request());
        usart.read(0).unwrap();
        usart.read(4).unwrap();
        assert!(!usart.request());
    }

    #[test]
    fn parity_and_other_frames_are_refused() {
        let mut usart = Usart::new(4, 180_000_000, 1_000_000);
        assert!(usart.write(0x0c, UE | 1 << 10, 0).is_err(), "PCE");
        assert!(usart.write(0x10, 2 << 12, 0).is_err(), "two stop bits");
    }
}
