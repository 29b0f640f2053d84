//! Sampling of the sensors: TIM2 starts each scan, ADC1 converts its channels, a stream of DMA2
//! stores the results, and the tick takes a block of scans.
//!
//! No code runs between timer and memory, so sampling has no jitter. The stream fills two blocks
//! alternately, without a gap; the tick exchanges the full one for a third. No sample is lost if it
//! does so while the other block is being filled, which takes a millisecond divided by the number
//! of fingers. A block always begins with the first channel of a scan.
//!
//! Each block belongs to one finger. Several fingers are sampled in turn, block by block.

use stm32f4xx_hal::ReadFlags;
use stm32f4xx_hal::dma::config::{DmaConfig, Priority};
use stm32f4xx_hal::dma::traits::{DMASet, DmaFlagExt, PeriAddress};
use stm32f4xx_hal::dma::{CurrentBuffer, DMAError, PeripheralToMemory, Stream0, Transfer};
use stm32f4xx_hal::gpio::{Analog, PA0, PA1, PA4, PB0, PC0, PC1, PC2};
use stm32f4xx_hal::pac::{ADC_COMMON, ADC1, DMA2, TIM2, tim2};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::{Enable, Rcc, Reset};
use stm32f4xx_hal::timer::{CounterHz, Timer};
use thermal_display::device::sense::{CHANNELS, SCANS_PER_TICK, Scan};
use thermal_display::device::{Finger, TICK_HZ};

use super::clock_monitor::ClockMonitor;
use super::log;
use super::sample_error::SampleError;
use super::wiring::{FINGERS, Multiplexer, SAMPLE_TIME};

/// Scans of one block: those that are dropped while the multiplexers settle, and those of a
/// finger's tick.
const SCANS_PER_BLOCK: usize = Multiplexer::SETTLING_SCANS + SCANS_PER_TICK;

/// Consecutive scans of one finger.
pub type ScanBlock = [Scan; SCANS_PER_BLOCK];

/// Number of blocks: one is being filled, one is filled next, one is read by the tick.
pub const BLOCKS: usize = 3;

/// A block that has not been filled yet.
pub const EMPTY: ScanBlock = [[0; CHANNELS]; SCANS_PER_BLOCK];

/// The analog input pins, with the names of the fields of `Samples`.
pub struct SensorPins {
    pub display: PA0<Analog>,
    pub display_check: PA1<Analog>,
    pub sink: PA4<Analog>,
    pub skin: PB0<Analog>,
    pub room: PC1<Analog>,
    pub force: PC0<Analog>,
    pub current: PC2<Analog>,
}

/// Collects the samples of the fingers, one block a tick and finger.
pub struct Sampler {
    transfer: Transfer<Stream0<DMA2>, 0, Converter, PeripheralToMemory, &'static mut ScanBlock>,
    /// The block that was taken last. It may be read until the next one is taken, and is then given
    /// to the stream.
    spare: Option<&'static mut ScanBlock>,
    /// The buffer of the stream that was taken last, of two.
    last: CurrentBuffer,
    multiplexer: Multiplexer,
    /// The finger that is being sampled.
    finger: Finger<FINGERS>,
    clock_monitor: ClockMonitor,
}

/// The timer that triggers the scans.
///
/// It is started last, once interrupts are enabled: the tick must switch the multiplexers within
/// 11 us of the last scan of a finger.
pub struct SampleTrigger(CounterHz<TIM2>);

impl SampleTrigger {
    /// Starts the timer.
    pub fn start(&mut self) {
        // This cannot fail, because the counter has 32 bits. 90 MHz is an exact multiple of both
        // scan rates, 16 and 90 kHz.
        let _ = self
            .0
            .start(((SCANS_PER_BLOCK * FINGERS) as u32 * TICK_HZ).Hz());
    }
}

impl Sampler {
    /// Sets up the stream and the timer; sampling begins with finger 0 when the trigger is started.
    pub fn new(
        converter: Converter,
        timer: TIM2,
        clock_monitor: ClockMonitor,
        stream: Stream0<DMA2>,
        multiplexer: Multiplexer,
        blocks: &'static mut [ScanBlock; BLOCKS],
        rcc: &mut Rcc,
    ) -> (Self, SampleTrigger) {
        let [first, second, spare] = blocks;
        let config = DmaConfig::default()
            .priority(Priority::VeryHigh)
            .memory_increment(true)
            .double_buffer(true)
            .transfer_complete_interrupt(true)
            .transfer_error_interrupt(true);
        let mut transfer =
            Transfer::init_peripheral_to_memory(stream, converter, first, Some(second), config);
        transfer.start(|_| {});

        let mut timer = Timer::new(timer, rcc);
        timer.set_master_mode(tim2::cr2::MMS::Update);
        let sampler = Self {
            transfer,
            spare: Some(spare),
            last: CurrentBuffer::SecondBuffer,
            multiplexer,
            finger: Finger::FIRST,
            clock_monitor,
        };
        (sampler, SampleTrigger(timer.counter_hz()))
    }

    /// Returns the finger whose block has just been filled, with its scans, and switches the
    /// multiplexers to the next finger.
    ///
    /// # Errors
    /// [`SampleError`] if samples are missing or the clocks are wrong; control must then stop.
    pub fn take(&mut self) -> Result<(Finger<FINGERS>, &[Scan; SCANS_PER_TICK]), SampleError> {
        // Checked first, because the start of the tick is measured; reported last, because the
        // other errors are more specific.
        let clock_check = self.clock_monitor.check();
        let finger = self.finger;
        self.finger = finger.next_cyclic();
        self.multiplexer.select(self.finger);
        if Multiplexer::SETTLING_SCANS != 0 && self.has_completed_a_scan() {
            return Err(SampleError::LateSwitch);
        }
        if self.transfer.flags().is_transfer_error() {
            return Err(SampleError::Bus);
        }
        let spare = self.spare.take().ok_or(SampleError::Bus)?;
        let (block, which) = self
            .transfer
            .next_transfer(spare)
            .map_err(|error| match error {
                DMAError::Overrun(_) => SampleError::Late,
                DMAError::NotReady(_) | DMAError::SmallBuffer(_) => SampleError::Bus,
            })?;
        if which == self.last {
            return Err(SampleError::Late);
        }
        self.last = which;
        clock_check?;
        if finger == Finger::FIRST {
            log::count_tick();
        }
        let scans = self
            .spare
            .insert(block)
            .last_chunk()
            .ok_or(SampleError::Bus)?;
        Ok((finger, scans))
    }

    /// Whether the first scan of the next block is complete.
    fn has_completed_a_scan(&self) -> bool {
        usize::from(self.transfer.number_of_transfers()) <= (SCANS_PER_BLOCK - 1) * CHANNELS
    }

    /// Stops sampling for good. No tick follows, so the watchdogs reset the device.
    pub fn stop(&mut self) {
        self.transfer.pause(Converter::stop);
    }
}

/// ADC1, which converts all channels once for each trigger.
///
/// The driver of `stm32f4xx-hal` is not used: it measures the supply voltage during its set-up,
/// which is of no use here because all sensors are ratiometric to the supply, and it does not
/// support the overrun interrupt.
pub struct Converter {
    adc: ADC1,
    _inputs: SensorPins,
}

impl Converter {
    /// Sets the converter up, with a clock of 90 MHz / 4 = 22.5 MHz (the maximum is 36 MHz) and
    /// [`SAMPLE_TIME`].
    pub fn new(adc: ADC1, inputs: SensorPins, rcc: &mut Rcc) -> Self {
        ADC1::enable(rcc);
        ADC1::reset(rcc);
        // SAFETY: the common registers are shared by three converters, of which only ADC1 is used.
        let common = unsafe { ADC_COMMON::steal() };
        common.ccr().write(|w| w.adcpre().div4());
        adc.smpr1().write(|w| {
            w.smp10().set(SAMPLE_TIME);
            w.smp11().set(SAMPLE_TIME);
            w.smp12().set(SAMPLE_TIME)
        });
        adc.smpr2().write(|w| {
            w.smp0().set(SAMPLE_TIME);
            w.smp1().set(SAMPLE_TIME);
            w.smp4().set(SAMPLE_TIME);
            w.smp8().set(SAMPLE_TIME)
        });
        // SAFETY: ADC1 has these channels. Their order is that of the fields of `Samples`.
        adc.sqr3().write(|w| unsafe {
            w.sq1().bits(0); // display, PA0
            w.sq2().bits(1); // display_check, PA1
            w.sq3().bits(4); // sink, PA4
            w.sq4().bits(8); // skin, PB0
            w.sq5().bits(11); // room, PC1
            w.sq6().bits(10) // force, PC0
        });
        // SAFETY: ADC1 has this channel.
        adc.sqr2().write(|w| unsafe { w.sq7().bits(12) }); // current, PC2
        adc.sqr1().write(|w| w.l().set(CHANNELS as u8 - 1));
        adc.cr1().write(|w| w.scan().enabled().ovrie().enabled());
        adc.cr2().write(|w| {
            w.dma().enabled();
            w.dds().continuous();
            w.extsel().tim2trgo();
            w.exten().rising_edge();
            w.adon().enabled()
        });
        // The converter takes 3 us to start (datasheet, t_STAB); the core runs at 180 MHz.
        cortex_m::asm::delay(3 * 180);
        Self {
            adc,
            _inputs: inputs,
        }
    }

    /// Stops conversions and disables the overrun interrupt.
    fn stop(&mut self) {
        self.adc.cr1().write(|w| w.ovrie().disabled());
        self.adc.cr2().write(|w| w.adon().disabled());
    }
}

// SAFETY: the address is that of the data register of ADC1, which may be read as half-words.
unsafe impl PeriAddress for Converter {
    type MemSize = u16;

    fn address(&self) -> u32 {
        self.adc.dr().as_ptr() as u32
    }
}

// SAFETY: channel 0 of stream 0 of DMA2 serves the requests of ADC1 (RM0390, table 29).
unsafe impl DMASet<Stream0<DMA2>, 0, PeripheralToMemory> for Converter {}
