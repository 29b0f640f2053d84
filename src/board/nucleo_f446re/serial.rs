//! The line to the host: USART2, received byte by byte, sent by DMA a line at a time.
//!
//! Full frames go to the transmitter and empty ones come back, so nothing is copied and nobody waits.

use core::fmt::{self, Write as _};

use embedded_dma::ReadBuffer;
use heapless::Vec;
use heapless::spsc::{Consumer, Producer, Queue};
use stm32f4xx_hal::dma::config::DmaConfig;
use stm32f4xx_hal::dma::traits::DmaFlagExt;
use stm32f4xx_hal::dma::{DMAError, MemoryToPeripheral, Stream6, Transfer};
use stm32f4xx_hal::gpio::{Input, PA2, PA3};
use stm32f4xx_hal::pac::{DMA1, Interrupt, NVIC, USART2};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::serial::{Config, Rx, RxListen, Serial, Tx, config};
use stm32f4xx_hal::{ClearFlags, ReadFlags, nb};
use thermal_display::protocol::{ANSWER_MAX, LineError, LineReader};

use thermal_display::mailbox::Inlet;

/// Bits per second. A telemetry line a millisecond needs more than the usual 115 200; both ends divide their
/// clocks to this rate exactly.
const BAUD: u32 = 1_000_000;

/// Frames in circulation: one on the line, one kept by the stream after it has been sent, two to be written
/// meanwhile.
pub const FRAMES: usize = 4;

/// Longest line to the host, in bytes, with its end.
const FRAME_MAX: usize = "@0 ".len() + ANSWER_MAX + 1;

/// The store of a frame.
pub type Bytes = Vec<u8, FRAME_MAX>;

/// One line to the host.
struct Frame(&'static mut Bytes);

impl Frame {
    /// Replaces the content by `line` and an end of line.
    fn fill(&mut self, line: &impl fmt::Display) {
        self.0.clear();
        // Lines of the library fit; of any other the host gets the beginning.
        let _ = write!(self.0, "{line}");
        self.0.truncate(FRAME_MAX - 1);
        let _ = self.0.push(b'\n');
    }
}

// SAFETY: the bytes live as long as the program, and nobody writes to a frame that the stream owns.
unsafe impl ReadBuffer for Frame {
    type Word = u8;

    unsafe fn read_buffer(&self) -> (*const u8, usize) {
        (self.0.as_ptr(), self.0.len())
    }
}

/// The queues between [`Outbox`] and [`Transmitter`]; each holds all frames, so it is never full.
pub struct Links {
    full: Queue<Frame, { FRAMES + 1 }>,
    empty: Queue<Frame, { FRAMES + 1 }>,
}

impl Links {
    /// No frame yet.
    pub const fn new() -> Self {
        Self {
            full: Queue::new(),
            empty: Queue::new(),
        }
    }
}

/// Lines to be sent.
pub struct Outbox {
    full: Producer<'static, Frame>,
    empty: Consumer<'static, Frame>,
}

impl Outbox {
    /// Whether a line can be sent without waiting.
    pub fn has_room(&self) -> bool {
        self.empty.ready()
    }

    /// Whether nothing waits; the last frame may still be on the line.
    pub fn is_empty(&self) -> bool {
        self.empty.len() == FRAMES - 1
    }

    /// Sends one line, or nothing if there is no room.
    pub fn send(&mut self, line: &impl fmt::Display) {
        let Some(mut frame) = self.empty.dequeue() else {
            return;
        };
        frame.fill(line);
        let _ = self.full.enqueue(frame);
        // The stream asks for the next line when it has sent one; this is for when it sends nothing.
        NVIC::pend(Interrupt::DMA1_STREAM6);
    }
}

/// Sends frame after frame.
pub struct Transmitter {
    transfer: Transfer<Stream6<DMA1>, 4, Tx<USART2>, MemoryToPeripheral, Frame>,
    sending: bool,
    full: Consumer<'static, Frame>,
    empty: Producer<'static, Frame>,
}

impl Transmitter {
    /// Starts the next frame if the last one has left the memory. There are then still two bytes in the
    /// USART, 20 us, in which the next one must start if the line is not to pause.
    pub fn refill(&mut self) {
        if self.sending {
            let flags = self.transfer.flags();
            if !flags.is_transfer_complete() && !flags.is_transfer_error() {
                return;
            }
            // All of them, or the stream cannot be enabled again (RM0390, 9.3.18).
            self.transfer.clear_all_flags();
            self.sending = false;
        }
        let Some(frame) = self.full.dequeue() else {
            return;
        };
        let (Ok((sent, _))
        | Err(DMAError::NotReady(sent) | DMAError::SmallBuffer(sent) | DMAError::Overrun(sent))) =
            self.transfer.next_transfer(frame);
        let _ = self.empty.enqueue(sent);
        self.sending = true;
    }
}

/// What a byte has ended.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// A line that waits for its answer.
    Line,
    /// A blank line: the host is there.
    Blank,
}

/// Lines of the host.
pub struct Receiver {
    rx: Rx<USART2>,
    reader: LineReader,
    inlet: Inlet<'static>,
}

impl Receiver {
    /// Takes the byte that has come; what it ended, if anything.
    pub fn take(&mut self) -> Option<End> {
        match self.rx.read() {
            Ok(byte) => match self.reader.push(byte) {
                Some(line) => {
                    self.inlet.put(line);
                    Some(End::Line)
                }
                None => LineReader::is_end(byte).then_some(End::Blank),
            },
            Err(nb::Error::WouldBlock) => None,
            Err(nb::Error::Other(_)) => {
                self.reader.fail(LineError::Reception);
                None
            }
        }
    }
}

/// Sets up the USART and its stream.
pub fn start(
    usart: USART2,
    (tx, rx): (PA2<Input>, PA3<Input>),
    stream: Stream6<DMA1>,
    bytes: &'static mut [Bytes; FRAMES],
    links: &'static mut Links,
    inlet: Inlet<'static>,
    rcc: &mut Rcc,
) -> (Receiver, Transmitter, Outbox) {
    let config = Config::default()
        .baudrate(BAUD.bps())
        .dma(config::DmaConfig::Tx);
    let (tx, mut rx) = Serial::new(usart, (tx, rx), config, rcc)
        .expect("the clock of the USART is at least eight times the baud rate")
        .split();
    rx.listen();

    let (full_in, full_out) = links.full.split();
    let (mut empty_in, empty_out) = links.empty.split();
    let [first, rest @ ..] = bytes.each_mut().map(Frame);
    for frame in rest {
        let _ = empty_in.enqueue(frame);
    }
    let config = DmaConfig::default()
        .memory_increment(true)
        .transfer_complete_interrupt(true)
        .transfer_error_interrupt(true);
    let transfer = Transfer::init_memory_to_peripheral(stream, tx, first, None, config);

    let receiver = Receiver {
        rx,
        reader: LineReader::new(),
        inlet,
    };
    let transmitter = Transmitter {
        transfer,
        sending: false,
        full: full_out,
        empty: empty_in,
    };
    let outbox = Outbox {
        full: full_in,
        empty: empty_out,
    };
    (receiver, transmitter, outbox)
}
