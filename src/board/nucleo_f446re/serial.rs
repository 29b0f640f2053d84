//! The serial line to the host: USART2, which receives byte by byte and sends line by line, by DMA.
//!
//! Full frames are passed to the transmitter through a queue and empty ones are passed back through
//! another, so no line is copied and no task waits.

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
use thermal_display::protocol::{ANSWER_MAX_BYTES, LineError, LineReader};

use thermal_display::mailbox::Inlet;

/// Bits per second. One telemetry line per millisecond does not fit into the usual 115 200. The
/// clocks of both ends are exact multiples of this rate.
const BAUD: u32 = 1_000_000;

/// Number of frames: one is being sent, one has been sent and is still held by the stream, two are
/// written meanwhile.
pub const FRAMES: usize = 4;

/// Longest line to the host with its end, bytes.
const FRAME_MAX: usize = "@0 ".len() + ANSWER_MAX_BYTES + 1;

/// The bytes of one frame: one line to the host with its line ending.
pub type FrameBuffer = Vec<u8, FRAME_MAX>;

/// One line to the host.
struct Frame(&'static mut FrameBuffer);

impl Frame {
    /// Writes `line` and an end of line, in place of the previous content.
    fn fill(&mut self, line: &impl fmt::Display) {
        self.0.clear();
        // All lines of the protocol fit; a longer one would be truncated.
        let _ = write!(self.0, "{line}");
        self.0.truncate(FRAME_MAX - 1);
        let _ = self.0.push(b'\n');
    }
}

// SAFETY: the memory lives as long as the program, and no code writes to a frame that the stream
// owns.
unsafe impl ReadBuffer for Frame {
    type Word = u8;

    unsafe fn read_buffer(&self) -> (*const u8, usize) {
        (self.0.as_ptr(), self.0.len())
    }
}

/// The queues between [`Outbox`] and [`Transmitter`]. Each has room for all frames, so it is never
/// full.
pub struct FrameQueues {
    full: Queue<Frame, { FRAMES + 1 }>,
    empty: Queue<Frame, { FRAMES + 1 }>,
}

impl FrameQueues {
    /// Queues before [`start`] puts the empty frames into one of them.
    pub const fn new() -> Self {
        Self {
            full: Queue::new(),
            empty: Queue::new(),
        }
    }
}

/// The end of the queues at which lines to the host are written.
pub struct Outbox {
    full: Producer<'static, Frame>,
    empty: Consumer<'static, Frame>,
}

impl Outbox {
    /// Whether there is an empty frame for another line.
    pub fn has_room(&self) -> bool {
        self.empty.ready()
    }

    /// Whether no line waits; the last one may not have been sent completely.
    pub fn is_empty(&self) -> bool {
        self.empty.len() == FRAMES - 1
    }

    /// Writes one line into an empty frame, which is sent later; drops the line if there is none.
    pub fn send(&mut self, line: &impl fmt::Display) {
        let Some(mut frame) = self.empty.dequeue() else {
            return;
        };
        frame.fill(line);
        let _ = self.full.enqueue(frame);
        // The interrupt otherwise occurs only at the end of a line, so an idle transmitter would
        // not start.
        NVIC::pend(Interrupt::DMA1_STREAM6);
    }
}

/// Sends the full frames one after the other.
pub struct Transmitter {
    transfer: Transfer<Stream6<DMA1>, 4, Tx<USART2>, MemoryToPeripheral, Frame>,
    sending: bool,
    full: Consumer<'static, Frame>,
    empty: Producer<'static, Frame>,
}

impl Transmitter {
    /// Starts to send the next frame if the stream has read the last one completely. The USART then
    /// still holds two bytes; the line pauses if the next frame is not started within these 20 us.
    pub fn send_next(&mut self) {
        if self.sending {
            let flags = self.transfer.flags();
            if !flags.is_transfer_complete() && !flags.is_transfer_error() {
                return;
            }
            // All flags must be cleared before the stream can be enabled again (RM0390, 9.3.18).
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

/// What a received byte has completed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Completed {
    /// A line, which now waits for its answer.
    Line,
    /// A blank line, which has no answer but shows that the host is active.
    BlankLine,
}

/// Assembles the received bytes to lines and puts these into the mailbox.
pub struct Receiver {
    rx: Rx<USART2>,
    reader: LineReader,
    inlet: Inlet<'static>,
}

impl Receiver {
    /// Reads the byte that has arrived and returns what it has completed, if anything.
    pub fn receive(&mut self) -> Option<Completed> {
        match self.rx.read() {
            Ok(byte) => match self.reader.push(byte) {
                Some(line) => {
                    self.inlet.put(line);
                    Some(Completed::Line)
                }
                None => LineReader::is_end(byte).then_some(Completed::BlankLine),
            },
            Err(nb::Error::WouldBlock) => None,
            Err(nb::Error::Other(_)) => {
                self.reader.fail(LineError::Reception);
                None
            }
        }
    }
}

/// Sets up the USART and the stream that sends.
pub fn start(
    usart: USART2,
    (tx, rx): (PA2<Input>, PA3<Input>),
    stream: Stream6<DMA1>,
    buffers: &'static mut [FrameBuffer; FRAMES],
    queues: &'static mut FrameQueues,
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

    let (full_in, full_out) = queues.full.split();
    let (mut empty_in, empty_out) = queues.empty.split();
    let [first, rest @ ..] = buffers.each_mut().map(Frame);
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
