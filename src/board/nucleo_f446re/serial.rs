//! The serial line to the host: USART2, which receives byte by byte and sends line by line, by DMA.
//!
//! Full frames are passed to the transmitter through a queue and empty ones are passed back through
//! another, so no line is copied and no task waits.

use embedded_dma::ReadBuffer;
use heapless::spsc::{Consumer, Producer, Queue};
use stm32f4xx_hal::dma::config::DmaConfig;
use stm32f4xx_hal::dma::traits::DmaFlagExt;
use stm32f4xx_hal::dma::{DMAError, MemoryToPeripheral, Stream6, Transfer};
use stm32f4xx_hal::gpio::{Input, PA2, PA3};
use stm32f4xx_hal::pac::{DMA1, Interrupt, NVIC, USART2};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::serial::{Config, Error as SerialError, Rx, RxListen, Serial, Tx, config};
use stm32f4xx_hal::{ClearFlags, ReadFlags, nb};
use thermal_display::protocol::{LineError, LineReader, OutgoingLine};

use thermal_display::line_queue::LineProducer;

use super::line_losses;

/// Bits per second of the serial line in both directions. One telemetry line per millisecond does
/// not fit into the usual 115 200. The clocks of both ends are exact multiples of this rate.
const BAUD: u32 = 1_000_000;

/// Number of frames, each with one line to the host: the DMA stream holds the one that it sends or
/// has sent last; the other three are free, or wait to be sent.
pub const FRAME_COUNT: usize = 4;

/// One line to the host, in memory that the DMA stream can read.
struct TxFrame(&'static mut OutgoingLine);

// SAFETY: the memory lives as long as the program, and no code writes to a frame that the stream
// owns.
unsafe impl ReadBuffer for TxFrame {
    type Word = u8;

    unsafe fn read_buffer(&self) -> (*const u8, usize) {
        (self.0.as_ptr(), self.0.len())
    }
}

/// The two queues between [`Outbox`] and [`Transmitter`]: `full` with the lines to be sent, `empty`
/// with the free frames. Each has room for all frames, so none is ever full.
pub struct FullAndEmptyFrameQueues {
    full: Queue<TxFrame, { FRAME_COUNT + 1 }>,
    empty: Queue<TxFrame, { FRAME_COUNT + 1 }>,
}

impl FullAndEmptyFrameQueues {
    /// Creates both queues without frames; [`set_up`] then puts the free frames into `empty`.
    pub const fn new() -> Self {
        Self { full: Queue::new(), empty: Queue::new() }
    }
}

/// The host task's end of the frame queues: writes lines to the host into free frames and queues
/// them for [`Transmitter`].
pub struct Outbox {
    full: Producer<'static, TxFrame>,
    empty: Consumer<'static, TxFrame>,
}

impl Outbox {
    /// Whether a frame is free, so that [`enqueue_or_drop`](Self::enqueue_or_drop) can accept another line.
    pub fn has_room(&self) -> bool {
        self.empty.ready()
    }

    /// Whether no line waits to be sent. The DMA stream may still be sending the last one.
    pub fn is_empty(&self) -> bool {
        self.empty.len() == FRAME_COUNT - 1
    }

    /// Lets `write` replace the content of a free frame by a line and queues it to be sent; drops
    /// the line if no frame is free, so callers check [`has_room`](Self::has_room) first.
    pub fn enqueue_or_drop(&mut self, write: impl FnOnce(&mut OutgoingLine)) {
        let Some(frame) = self.empty.dequeue() else {
            return;
        };
        write(&mut *frame.0);
        let _ = self.full.enqueue(frame);
        // The interrupt otherwise occurs only at the end of a line, so an idle transmitter would
        // not start.
        NVIC::pend(Interrupt::DMA1_STREAM6);
    }
}

/// Sends the full frames to the host one after the other, in the interrupt of the DMA stream.
pub struct Transmitter {
    transfer: Transfer<Stream6<DMA1>, 4, Tx<USART2>, MemoryToPeripheral, TxFrame>,
    sending: bool,
    full: Consumer<'static, TxFrame>,
    empty: Producer<'static, TxFrame>,
}

impl Transmitter {
    /// Starts to send the next full frame, if there is one and the DMA stream has read the last one
    /// completely. Called in the interrupt of the stream, which occurs at the end of a frame and
    /// when a line is queued. At the end of a frame the USART still holds two bytes, which take 20
    /// us; the line to the host pauses if the next frame is not started within this time.
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

/// The kind of line that a received byte, a carriage return or line feed, has ended.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum BlankOrToBeAnsweredLine {
    /// A line with content, valid or not. It waits for its answer in the queue of received lines
    /// or, if that queue is full, is refused, and its answer is an error.
    ToBeAnswered,
    /// A blank line, which has no answer but shows that the host is active.
    Blank,
}

/// Assembles the bytes that the host sends into lines and appends the lines to the queue of
/// received lines, in the interrupt of USART2.
pub struct Receiver {
    rx: Rx<USART2>,
    reader: LineReader,
    line_queue: LineProducer<'static>,
}

impl Receiver {
    /// Reads the byte that has arrived. Returns the kind of line that this byte has ended, `None`
    /// if it has ended no line.
    pub fn receive_byte_and_queue_line(&mut self) -> Option<BlankOrToBeAnsweredLine> {
        match self.rx.read() {
            Ok(byte) => match self.reader.push(byte) {
                Some(line) => {
                    self.line_queue.enqueue_or_count_refused(line);
                    Some(BlankOrToBeAnsweredLine::ToBeAnswered)
                }
                None => LineReader::is_line_end(byte).then_some(BlankOrToBeAnsweredLine::Blank),
            },
            Err(nb::Error::WouldBlock) => None,
            Err(nb::Error::Other(error)) => {
                match error {
                    SerialError::Overrun => line_losses::OVERRUNS.count(),
                    SerialError::Noise => line_losses::NOISY_BYTES.count(),
                    _ => line_losses::FRAMING_ERRORS.count(),
                }
                self.reader.mark_invalid(LineError::Reception);
                None
            }
        }
    }
}

/// Sets up USART2 and the DMA stream that sends, and enables the interrupt of received bytes.
/// Returns the three parts of the serial line: one for the interrupt of USART2, one for the
/// interrupt of the DMA stream, and one for the host task.
pub fn set_up(
    usart: USART2,
    (tx, rx): (PA2<Input>, PA3<Input>),
    stream: Stream6<DMA1>,
    buffers: &'static mut [OutgoingLine; FRAME_COUNT],
    queues: &'static mut FullAndEmptyFrameQueues,
    line_queue: LineProducer<'static>,
    rcc: &mut Rcc,
) -> (Receiver, Transmitter, Outbox) {
    let config = Config::default().baudrate(BAUD.bps()).dma(config::DmaConfig::Tx);
    let (tx, mut rx) = Serial::new(usart, (tx, rx), config, rcc)
        .expect("the clock of the USART is at least eight times the baud rate")
        .split();
    rx.listen();

    let (full_in, full_out) = queues.full.split();
    let (mut empty_in, empty_out) = queues.empty.split();
    let [first, rest @ ..] = buffers.each_mut().map(TxFrame);
    for frame in rest {
        let _ = empty_in.enqueue(frame);
    }
    let config = DmaConfig::default()
        .memory_increment(true)
        .transfer_complete_interrupt(true)
        .transfer_error_interrupt(true);
    let transfer = Transfer::init_memory_to_peripheral(stream, tx, first, None, config);

    let receiver = Receiver { rx, reader: LineReader::new(), line_queue };
    let transmitter = Transmitter { transfer, sending: false, full: full_out, empty: empty_in };
    let outbox = Outbox { full: full_in, empty: empty_out };
    (receiver, transmitter, outbox)
}
