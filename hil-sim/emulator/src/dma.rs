//! DMA controllers (RM0390 chapter 9): peripheral streams in direct or FIFO mode without packing, circular and
//! double-buffer mode, half- and full-transfer, transfer-error interrupts.
//!
//! A request is served immediately: arbitration and FIFO delays (some ten cycles on silicon) are not modelled, so a FIFO
//! threshold shows to software in FS only.
use super::ram::Memory;
use super::stop::{Answer, Refusal, only};

const EN: u32 = 1;
const TCIF: u32 = 1 << 5;
const HTIF: u32 = 1 << 4;
const TEIF: u32 = 1 << 3;
const CIRC: u32 = 1 << 8;
const MINC: u32 = 1 << 10;
const DBM: u32 = 1 << 18;
const CT: u32 = 1 << 19;
/// Position of each stream's flags in LISR and HISR (9.5.1).
const FLAG_SHIFT: [u32; 4] = [0, 6, 16, 22];
/// Interrupt number of each stream.
const IRQ: [[usize; 8]; 2] = [[11, 12, 13, 14, 15, 16, 17, 47], [56, 57, 58, 59, 60, 68, 69, 70]];

/// A request line that a modelled peripheral has: controller, stream, channel (the request mapping of 9.3.4), and
/// the data register that the stream's PAR must hold.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Route {
    pub controller: usize,
    pub stream: usize,
    pub channel: u32,
    pub register: u32,
    pub to_memory: bool,
}

const fn route(
    controller: usize,
    stream: usize,
    channel: u32,
    register: u32,
    to_memory: bool,
) -> Route {
    Route { controller, stream, channel, register, to_memory }
}

pub(crate) const ADC1: [Route; 2] =
    [route(2, 0, 0, 0x4001_204c, true), route(2, 4, 0, 0x4001_204c, true)];
pub(crate) const USART2_TX: [Route; 1] = [route(1, 6, 4, 0x4000_4404, false)];
pub(crate) const USART2_RX: [Route; 1] = [route(1, 5, 4, 0x4000_4404, true)];

/// Result of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Served {
    /// No stream is enabled for it, or its transfer failed.
    No,
    /// One item was transferred; `last` of the stream's count.
    Item { value: u32, last: bool },
}

#[derive(Default, Clone, Copy)]
struct Stream {
    cr: u32,
    left: u32,
    /// Items of the present round.
    items: u32,
    /// NDTR as software wrote it, with which a new round begins.
    programmed: u32,
    par: u32,
    m: [u32; 2],
    fcr: u32,
    flags: u32,
}

pub(crate) struct Dma {
    number: usize,
    streams: [Stream; 8],
}

impl Dma {
    /// `number` is 1 or 2.
    pub fn new(number: usize) -> Self {
        Self { number, streams: [Stream { fcr: 0x21, ..Stream::default() }; 8] }
    }

    /// Interrupt requests of one stream: `(interrupt, level)`.
    pub fn request_line(&self, stream: usize) -> (usize, bool) {
        let s = &self.streams[stream];
        // TCIE, HTIE, TEIE, DMEIE stand one bit below their flags
        let raised = s.flags & (s.cr & 0x1e) << 1 != 0 || s.flags & s.fcr >> 7 & 1 != 0;
        (IRQ[self.number - 1][stream], raised)
    }

    /// Whether a stream is enabled for this request and has items left.
    pub fn listens(&self, route: &Route) -> bool {
        let s = &self.streams[route.stream];
        s.cr & EN != 0 && s.left != 0 && s.cr >> 25 & 7 == route.channel
    }

    /// Serves a request: stores `value` in memory, or loads an item from memory.
    pub fn serve(&mut self, route: &Route, value: u32, memory: &mut impl Memory) -> Served {
        if !self.listens(route) {
            return Served::No;
        }
        let s = &mut self.streams[route.stream];
        let bytes = 1u8 << (s.cr >> 11 & 3);
        let index = if s.cr & MINC != 0 { s.items - s.left } else { 0 };
        let address = s.m[(s.cr >> 19 & 1) as usize].wrapping_add(index * u32::from(bytes));
        let moved = if route.to_memory {
            memory.store(address, bytes, value).map(|()| value)
        } else {
            memory.load(address, bytes)
        };
        let Ok(value) = moved else {
            s.fail();
            return Served::No;
        };
        s.left -= 1;
        if s.left == s.items / 2 {
            s.flags |= HTIF;
        }
        let last = s.left == 0;
        if last {
            s.flags |= TCIF;
            if s.cr & DBM != 0 {
                s.cr ^= CT;
            }
            if s.cr & (CIRC | DBM) != 0 {
                s.begin_round();
            } else {
                s.cr &= !EN;
            }
        }
        Served::Item { value, last }
    }

    /// Ends a stream by a bus error. `false`: it was not enabled, and nothing changes.
    pub fn fail(&mut self, stream: usize) -> bool {
        let was_enabled = self.streams[stream].cr & EN != 0;
        if was_enabled {
            self.streams[stream].fail();
        }
        was_enabled
    }

    pub fn read(&self, offset: u32) -> Answer<u32> {
        let flags =
            |first: usize| (0..4).map(|i| self.streams[first + i].flags << FLAG_SHIFT[i]).sum();
        match offset {
            0x00 => return Ok(flags(0)),
            0x04 => return Ok(flags(4)),
            0x08 | 0x0c => return Ok(0),
            _ => {}
        }
        let (stream, register) = Self::stream_register(offset)?;
        let s = &self.streams[stream];
        Ok(match register {
            0x00 => s.cr,
            0x04 => s.left,
            0x08 => s.par,
            0x0c => s.m[0],
            0x10 => s.m[1],
            _ => s.fcr,
        })
    }

    fn stream_register(offset: u32) -> Answer<(usize, u32)> {
        let from_first = offset.wrapping_sub(0x10);
        let stream = (from_first / 0x18) as usize;
        if stream < 8 { Ok((stream, from_first % 0x18)) } else { Err(Refusal::Offset) }
    }

    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x00 | 0x04 => return Ok(()), // read-only
            0x08 | 0x0c => {
                let first = if offset == 0x08 { 0 } else { 4 };
                for (stream, shift) in self.streams[first..].iter_mut().zip(FLAG_SHIFT) {
                    stream.flags &= !(value >> shift & 0x3d);
                }
                return Ok(());
            }
            _ => {}
        }
        let (stream, register) = Self::stream_register(offset)?;
        let number = self.number;
        let s = &mut self.streams[stream];
        let enabled = s.cr & EN != 0;
        match register {
            0x00 => return s.write_cr(value, number, stream),
            0x04 if !enabled => (s.left, s.programmed) = (value & 0xffff, value & 0xffff),
            0x08 if !enabled => s.par = value,
            // 9.5.8, 9.5.9: the buffer that is not the current target may change while running
            0x0c | 0x10 if enabled => {
                let which = (register as usize - 0x0c) / 4;
                if s.cr & DBM != 0 && (s.cr >> 19 & 1) as usize != which {
                    s.m[which] = value;
                } else {
                    return Err(Refusal::NotModelled("DMA SxMAR of the buffer in use"));
                }
            }
            0x0c | 0x10 => s.m[(register as usize - 0x0c) / 4] = value,
            0x14 => {
                only(value, 0xbf, "DMA SxFCR reserved bits")?;
                s.fcr = value & 0x87 | 0x20;
            }
            _ => {
                return Err(Refusal::NotModelled("DMA SxNDTR or SxPAR of an enabled stream"));
            }
        }
        Ok(())
    }
}

impl Stream {
    /// Reloads NDTR (9.5.6: in circular mode, and when a completed stream is enabled again).
    fn begin_round(&mut self) {
        self.left = self.programmed;
        self.items = self.programmed;
    }

    /// Disables the stream and sets the transfer-error flag.
    fn fail(&mut self) {
        self.flags |= TEIF;
        self.cr &= !EN;
    }

    fn write_cr(&mut self, value: u32, number: usize, stream: usize) -> Answer<()> {
        only(value, 0x0fef_ffff, "DMA SxCR reserved bits")?;
        only(value & 1 << 5, 0, "DMA SxCR.PFCTRL (peripheral flow controller)")?;
        only(value & 1 << 9, 0, "DMA SxCR.PINC")?;
        only(value & 0x8000, 0, "DMA SxCR.PINCOS")?;
        if self.cr & EN != 0 {
            if value & EN == 0 {
                self.cr = value;
                self.flags |= TCIF; // a stream that software stops reports the end (chapter 9, stream disable)
                return Ok(());
            }
            only((value ^ self.cr) & !0x1e, 0, "DMA SxCR configuration of an enabled stream")?;
            self.cr = value;
            return Ok(());
        }
        if value & EN != 0 && self.flags != 0 {
            return Err(Refusal::Misuse(
                "EN is set while flags of the stream stand in LISR or HISR; they must be cleared first (RM0390 9.5.5)",
            ));
        }
        self.cr = value;
        if value & EN == 0 {
            return Ok(());
        }
        let known = [ADC1.as_slice(), &USART2_TX, &USART2_RX].concat();
        let channel = value >> 25 & 7;
        let route = known
            .iter()
            .find(|r| (r.controller, r.stream, r.channel) == (number, stream, channel))
            .ok_or(Refusal::NotModelled("DMA SxCR.CHSEL: a request of a peripheral that"))?;
        if self.par != route.register {
            return Err(Refusal::NotModelled(
                "DMA SxPAR: a register other than the requester's data register",
            ));
        }
        if value >> 6 & 3 != u32::from(!route.to_memory) {
            return Err(Refusal::NotModelled("DMA SxCR.DIR against the requester's direction"));
        }
        let direct = self.fcr & 4 == 0;
        if !direct && value >> 11 & 3 != value >> 13 & 3 {
            return Err(Refusal::NotModelled("DMA SxCR.MSIZE other than PSIZE (FIFO packing)"));
        }
        if value >> 11 & 3 == 3 {
            return Err(Refusal::NotModelled("DMA SxCR.PSIZE = reserved"));
        }
        if self.left == 0 {
            self.begin_round();
        }
        self.items = self.left;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::ram::NoMemory;
    use super::*;

    struct Buffer([u8; 16]);

    impl Memory for Buffer {
        fn load(&mut self, address: u32, bytes: u8) -> Result<u32, NoMemory> {
            let at = address.checked_sub(0x2000_0000).ok_or(NoMemory)? as usize;
            let bytes = self.0.get(at..at + usize::from(bytes)).ok_or(NoMemory)?;
            Ok(bytes.iter().rev().fold(0, |v, b| v << 8 | u32::from(*b)))
        }

        fn store(&mut self, address: u32, bytes: u8, value: u32) -> Result<(), NoMemory> {
            let at = address.checked_sub(0x2000_0000).ok_or(NoMemory)? as usize;
            let n = usize::from(bytes);
            self.0.get_mut(at..at + n).ok_or(NoMemory)?.copy_from_slice(&value.to_le_bytes()[..n]);
            Ok(())
        }
    }

    /// DMA2 stream 0 from the ADC, half-words, TC and HT interrupts.
    fn adc_stream(extra: u32, items: u32) -> Dma {
        let mut dma = Dma::new(2);
        dma.write(0x18, 0x4001_204c).unwrap();
        dma.write(0x1c, 0x2000_0000).unwrap();
        dma.write(0x20, 0x2000_0008).unwrap();
        dma.write(0x14, items).unwrap();
        dma.write(0x10, 1 << 13 | 1 << 11 | MINC | 0x18 | EN | extra).unwrap();
        dma
    }

    #[test]
    fn a_circular_stream_flags_half_and_full_and_starts_over() {
        let (mut dma, mut ram) = (adc_stream(CIRC, 4), Buffer([0; 16]));
        for value in 1..=2 {
            dma.serve(&ADC1[0], value, &mut ram);
        }
        assert_eq!(dma.read(0).unwrap(), HTIF);
        assert_eq!(dma.request_line(0), (56, true));
        dma.write(0x08, 0x3d).unwrap();
        assert_eq!(dma.request_line(0), (56, false));
        for value in 3..=5 {
            dma.serve(&ADC1[0], value, &mut ram);
        }
        assert_eq!(dma.read(0).unwrap(), TCIF);
        assert_eq!(ram.0[..8], [5, 0, 2, 0, 3, 0, 4, 0]);
        assert_eq!(dma.read(0x14).unwrap(), 3, "NDTR reloaded, one item of the new round done");
    }

    #[test]
    fn double_buffer_switches_target_at_each_full_transfer() {
        let (mut dma, mut ram) = (adc_stream(DBM, 2), Buffer([0; 16]));
        for value in 1..=3 {
            dma.serve(&ADC1[0], value, &mut ram);
        }
        assert_eq!(ram.0[..10], [1, 0, 2, 0, 0, 0, 0, 0, 3, 0]);
        assert_eq!(dma.read(0x10).unwrap() & CT, CT);
        dma.write(0x1c, 0x2000_0004).expect("the idle buffer may move");
        assert!(dma.write(0x20, 0x2000_0004).is_err(), "the one in use may not");
    }

    #[test]
    fn a_normal_stream_ends_and_an_address_without_memory_is_an_error() {
        let (mut dma, mut ram) = (adc_stream(0, 1), Buffer([0; 16]));
        assert_eq!(dma.serve(&ADC1[0], 9, &mut ram), Served::Item { value: 9, last: true });
        assert_eq!(dma.serve(&ADC1[0], 9, &mut ram), Served::No);
        let mut dma = adc_stream(0, 1);
        dma.write(0x10, 0).unwrap();
        dma.write(0x08, 0x3d).unwrap();
        dma.write(0x1c, 0x1000_0000).unwrap();
        dma.write(0x10, 1 << 13 | 1 << 11 | 0x1c | EN).unwrap();
        assert_eq!(dma.serve(&ADC1[0], 9, &mut ram), Served::No);
        assert_eq!((dma.read(0).unwrap(), dma.read(0x10).unwrap() & EN), (TEIF, 0));
        assert_eq!(dma.request_line(0), (56, true));
    }

    #[test]
    fn a_completed_stream_begins_anew_when_it_is_enabled_again() {
        let (mut dma, mut ram) = (adc_stream(0, 2), Buffer([0; 16]));
        for value in 1..=2 {
            dma.serve(&ADC1[0], value, &mut ram);
        }
        let (cr, left) = (dma.read(0x10).unwrap(), dma.read(0x14).unwrap());
        assert_eq!((cr & EN, left), (0, 0));
        dma.write(0x08, 0x3d).unwrap();
        dma.write(0x10, cr | EN).unwrap();
        assert_eq!(dma.read(0x14).unwrap(), 2, "RM0390 9.5.6");
        dma.serve(&ADC1[0], 7, &mut ram);
        assert_eq!(ram.0[..4], [7, 0, 2, 0]);
    }

    #[test]
    fn a_stream_without_items_serves_nothing() {
        let (mut dma, mut ram) = (adc_stream(0, 0), Buffer([0; 16]));
        assert_eq!(dma.read(0x10).unwrap() & EN, EN);
        assert_eq!(dma.serve(&ADC1[0], 1, &mut ram), Served::No);
        assert_eq!(dma.read(0x00).unwrap(), 0);
    }

    #[test]
    fn a_stream_whose_flags_stand_must_not_be_enabled() {
        let (mut dma, mut ram) = (adc_stream(0, 2), Buffer([0; 16]));
        for value in 1..=2 {
            dma.serve(&ADC1[0], value, &mut ram);
        }
        let cr = dma.read(0x10).unwrap() | EN;
        for cleared in [0, TCIF, HTIF] {
            dma.write(0x08, cleared).unwrap();
            let misused = cleared != HTIF;
            let answer = dma.write(0x10, cr);
            assert_eq!(matches!(answer, Err(Refusal::Misuse(_))), misused, "{cleared:#x}");
        }
    }

    #[test]
    fn requests_of_unmodelled_peripherals_are_refused() {
        let mut dma = Dma::new(2);
        dma.write(0x14, 1).unwrap();
        assert!(matches!(dma.write(0x10, 3 << 25 | EN), Err(Refusal::NotModelled(_))), "SPI1_RX");
    }
}
