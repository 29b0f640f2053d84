//! Scans of the sensors: TIM2 starts them, ADC1 converts, DMA2 stores, the tick takes a block of them.
//!
//! No program takes part between the timer and the memory, so sampling has no jitter. The stream writes
//! to two blocks in turn without a gap; the tick exchanges the one that is full for a third one. Nothing is
//! lost if it does so within the millisecond in which the other block fills up, and a block always
//! begins with the first channel of a scan.
//!
//! A block is of one finger; several fingers take turns, block by block.

use stm32f4xx_hal::ReadFlags;
use stm32f4xx_hal::dma::config::{DmaConfig, Priority};
use stm32f4xx_hal::dma::traits::{DMASet, DmaFlagExt, PeriAddress};
use stm32f4xx_hal::dma::{CurrentBuffer, DMAError, PeripheralToMemory, Stream0, Transfer};
use stm32f4xx_hal::gpio::{Analog, PA0, PA1, PA4, PB0, PC0, PC1, PC2};
use stm32f4xx_hal::pac::{ADC_COMMON, ADC1, DMA2, TIM2, tim2};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::{Enable, Rcc, Reset};
use stm32f4xx_hal::timer::{CounterHz, Timer};
use thermal_display::device::TICK_HZ;
use thermal_display::device::safety::Fault;
use thermal_display::device::sense::{CHANNELS, SCANS_PER_TICK, Scan};

use super::log;
use super::timekeeper::Timekeeper;
use super::wiring::{FINGERS, Multiplexer, SAMPLE_TIME};

/// Scans of one block: those of a finger's tick, after those that may show the finger before.
const SCANS_PER_BLOCK: usize = Multiplexer::SETTLING_SCANS + SCANS_PER_TICK;

/// The scans of one finger's turn.
pub type Block = [Scan; SCANS_PER_BLOCK];

/// Blocks in circulation: one is filled, one is filled next, one is read.
pub const BLOCKS: usize = 3;

/// A block before its first scan.
pub const EMPTY: Block = [[0; CHANNELS]; SCANS_PER_BLOCK];

/// The pins of the sensors, named as in `Samples`.
pub struct Inputs {
    pub display: PA0<Analog>,
    pub display_check: PA1<Analog>,
    pub sink: PA4<Analog>,
    pub skin: PB0<Analog>,
    pub room: PC1<Analog>,
    pub force: PC0<Analog>,
    pub current: PC2<Analog>,
}

/// Why there is no block.
#[derive(Clone, Copy, Debug, defmt::Format)]
pub enum SampleError {
    /// The stream could not write.
    Bus,
    /// A block was overwritten before it was taken: the last tick took longer than its period.
    Late,
    /// The multiplexers were switched too late for the next block.
    LateSwitch,
    /// A block has not come when it was due: the timer, or what is measured against it, has another rate.
    Pace,
    /// The clocks are not those that were set.
    Clocks,
}

impl SampleError {
    /// What it is to the guard.
    pub const fn fault(self) -> Fault {
        match self {
            Self::Bus | Self::Late | Self::LateSwitch | Self::Pace => Fault::Sampling,
            Self::Clocks => Fault::Clock,
        }
    }
}

/// The samples of the sensors, tick by tick.
pub struct Sampler {
    transfer: Transfer<Stream0<DMA2>, 0, Converter, PeripheralToMemory, &'static mut Block>,
    /// The block that the stream is given next; until then it may be read.
    spare: Option<&'static mut Block>,
    /// Which of the stream's two blocks was taken last.
    last: CurrentBuffer,
    multiplexer: Multiplexer,
    /// The finger whose block is being filled.
    finger: usize,
    timekeeper: Timekeeper,
}

/// What starts the scans, once somebody waits for them: the multiplexers must be switched 11 us after a finger's last.
pub struct Trigger(CounterHz<TIM2>);

impl Trigger {
    /// Begins.
    pub fn start(&mut self) {
        // Cannot fail: 90 MHz over 16 or 90 kHz fits the counter. Both divide it exactly.
        let _ = self
            .0
            .start(((SCANS_PER_BLOCK * FINGERS) as u32 * TICK_HZ).Hz());
    }
}

impl Sampler {
    /// Gets ready to sample, finger 0 first: a block of each finger a tick.
    pub fn new(
        converter: Converter,
        timer: TIM2,
        timekeeper: Timekeeper,
        stream: Stream0<DMA2>,
        multiplexer: Multiplexer,
        blocks: &'static mut [Block; BLOCKS],
        rcc: &mut Rcc,
    ) -> (Self, Trigger) {
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
            finger: 0,
            timekeeper,
        };
        (sampler, Trigger(timer.counter_hz()))
    }

    /// The finger whose block has just been filled, and its scans; the next finger's turn has begun.
    ///
    /// # Errors
    /// [`SampleError`]; samples are then missing and control cannot go on.
    pub fn take(&mut self) -> Result<(usize, &[Scan; SCANS_PER_TICK]), SampleError> {
        // First, as it is the tick's begin that counts; what else is wrong says more.
        let in_time = self.timekeeper.take();
        let finger = self.finger;
        self.finger = if finger + 1 < FINGERS { finger + 1 } else { 0 };
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
        in_time?;
        if finger == 0 {
            log::count_tick();
        }
        let scans = self
            .spare
            .insert(block)
            .last_chunk()
            .ok_or(SampleError::Bus)?;
        Ok((finger, scans))
    }

    /// Whether the first scan of the block that is being filled is in memory.
    fn has_completed_a_scan(&self) -> bool {
        usize::from(self.transfer.number_of_transfers()) <= (SCANS_PER_BLOCK - 1) * CHANNELS
    }

    /// Stops for good. No tick follows, so the watchdog resets the device.
    pub fn stop(&mut self) {
        self.transfer.pause(Converter::stop);
    }
}

/// ADC1, scanning the inputs at every trigger.
///
/// The library's driver measures the supply by the internal reference when it is set up; here every sensor
/// is ratiometric to the supply, so that would be a second, slower path through the same registers for
/// nothing. It also knows nothing of the overrun interrupt.
pub struct Converter {
    adc: ADC1,
    _inputs: Inputs,
}

impl Converter {
    /// 90 MHz / 4: 22.5 MHz (36 at most), sampling for [`SAMPLE_TIME`].
    pub fn new(adc: ADC1, inputs: Inputs, rcc: &mut Rcc) -> Self {
        ADC1::enable(rcc);
        ADC1::reset(rcc);
        // SAFETY: the common registers belong to the three converters, of which only ADC1 is used.
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
        // SAFETY: these are channels that ADC1 has, in the order of `Samples`.
        adc.sqr3().write(|w| unsafe {
            w.sq1().bits(0); // display, PA0
            w.sq2().bits(1); // display_check, PA1
            w.sq3().bits(4); // sink, PA4
            w.sq4().bits(8); // skin, PB0
            w.sq5().bits(11); // room, PC1
            w.sq6().bits(10) // force, PC0
        });
        // SAFETY: as above.
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
        // 3 us for the converter to wake up (datasheet, t_STAB), at 180 MHz.
        cortex_m::asm::delay(3 * 180);
        Self {
            adc,
            _inputs: inputs,
        }
    }

    /// Converts no more and asks for no interrupt.
    fn stop(&mut self) {
        self.adc.cr1().write(|w| w.ovrie().disabled());
        self.adc.cr2().write(|w| w.adon().disabled());
    }
}

// SAFETY: the data register of ADC1, which is read as half-words.
unsafe impl PeriAddress for Converter {
    type MemSize = u16;

    fn address(&self) -> u32 {
        self.adc.dr().as_ptr() as u32
    }
}

// SAFETY: stream 0, channel 0 of DMA2 is a request of ADC1 (RM0390, table 29).
unsafe impl DMASet<Stream0<DMA2>, 0, PeripheralToMemory> for Converter {}
