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
use stm32f4xx_hal::gpio::{Analog, PA0, PA1, PA4, PB0, PC0, PC1, PC2, PC4};
use stm32f4xx_hal::pac::{ADC_COMMON, ADC1, DMA2, TIM2, tim2};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::{Enable, Rcc, Reset};
use stm32f4xx_hal::timer::{CounterHz, Timer};
use thermal_display::device::sense::{ADC_CHANNELS_PER_FINGER, SCANS_PER_TICK, Scan};
use thermal_display::device::{FingerIndex, TICK_HZ};

use super::defmt_rtt_log;
use super::sample_error::SampleError;
use super::tick_rate_and_rcc_monitor::TickRateAndRccMonitor;
use super::wiring::{FINGERS, Multiplexer, SAMPLE_TIME_CODE};

/// Number of scans in one block: 16 with one finger, 18 with five. A control tick uses the last 16;
/// the scans before them are dropped, because the multiplexers still settle.
const SCANS_PER_BLOCK: usize = Multiplexer::SETTLING_SCANS + SCANS_PER_TICK;

/// Consecutive scans of one finger, in counts of the converter (0 to 4095). The DMA stream fills
/// one block for each finger and control tick.
pub type ScanBlock = [Scan; SCANS_PER_BLOCK];

/// Number of blocks: the DMA stream fills one and has the next one ready, and the tick reads the
/// third.
pub const TRIPLE_BUFFER_BLOCK_COUNT: usize = 3;

/// Initial content of a block, before the DMA stream first fills it: all counts are zero.
pub const EMPTY_BLOCK: ScanBlock = [[0; ADC_CHANNELS_PER_FINGER]; SCANS_PER_BLOCK];

/// The analog input pins of the eight signals that ADC1 converts. The fields have the same names as
/// those of `Samples`.
pub struct SensorPins {
    pub display: PA0<Analog>,
    pub display_check: PA1<Analog>,
    pub sink: PA4<Analog>,
    pub skin: PB0<Analog>,
    pub room: PC1<Analog>,
    pub force: PC0<Analog>,
    pub current: PC2<Analog>,
    pub supply: PC4<Analog>,
}

/// Samples the sensors of all fingers in turn: one block of scans for each finger and control tick,
/// stored by DMA.
pub struct Sampler {
    transfer: Transfer<Stream0<DMA2>, 0, SensorAdc, PeripheralToMemory, &'static mut ScanBlock>,
    /// The block that the last
    /// [`take_block_and_select_next_finger`](Self::take_block_and_select_next_finger) returned or,
    /// before the first call, one that was never filled. The next call gives this block to the DMA
    /// stream to be filled. `None` only after that function has returned an error, which stops
    /// sampling.
    spare: Option<&'static mut ScanBlock>,
    /// Which of the DMA stream's two buffers the last call of
    /// [`take_block_and_select_next_finger`](Self::take_block_and_select_next_finger) emptied. The
    /// buffers must alternate: the same one twice means that a block was overwritten before it was
    /// taken.
    last_buffer: CurrentBuffer,
    multiplexer: Multiplexer,
    /// The finger whose samples the DMA stream stores now. The next tick takes that finger's block.
    finger: FingerIndex<FINGERS>,
    /// Whether the multiplexers had selected the finger of the last block, as far as the parity of
    /// their select lines shows.
    finger_was_selected: bool,
    tick_rate_and_rcc_monitor: TickRateAndRccMonitor,
}

/// The timer TIM2, which triggers the scans of the sensors.
///
/// It is started last, once interrupts are enabled: with five fingers, the control tick must switch
/// the multiplexers within 11 us after the last scan of a finger, and no tick runs while interrupts
/// are disabled.
pub struct SampleTrigger(CounterHz<TIM2>);

impl SampleTrigger {
    /// Starts the timer, which from then on triggers scans of all channels without end: every
    /// millisecond 16 scans for one finger, or 18 scans for each of five fingers.
    pub fn start(&mut self) {
        // This cannot fail, because the counter has 32 bits. 90 MHz is an exact multiple of both
        // scan rates, 16 and 90 kHz.
        let _ = self.0.start(((SCANS_PER_BLOCK * FINGERS) as u32 * TICK_HZ).Hz());
    }
}

impl Sampler {
    /// Sets up the DMA stream and the timer of the scans. Sampling begins with finger 0 when the
    /// returned trigger is started.
    pub fn new_with_trigger(
        converter: SensorAdc,
        timer: TIM2,
        tick_rate_and_rcc_monitor: TickRateAndRccMonitor,
        stream: Stream0<DMA2>,
        multiplexer: Multiplexer,
        blocks: &'static mut [ScanBlock; TRIPLE_BUFFER_BLOCK_COUNT],
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
            last_buffer: CurrentBuffer::SecondBuffer,
            multiplexer,
            finger: FingerIndex::FIRST,
            finger_was_selected: true,
            tick_rate_and_rcc_monitor,
        };
        (sampler, SampleTrigger(timer.counter_hz()))
    }

    /// Returns the finger whose block has just been filled, with the 16 scans for its control tick,
    /// and switches the multiplexers to the next finger. Called in the interrupt of the DMA stream,
    /// which occurs when a block is full.
    ///
    /// # Errors
    /// [`SampleError::LateSwitch`] if the multiplexers were switched too late, [`SampleError::Bus`]
    /// if the DMA stream has failed, [`SampleError::Late`] if a block was overwritten before it was
    /// taken, [`SampleError::Clocks`] or [`SampleError::TickRate`] if the clock settings or the
    /// rate of the ticks are wrong. The control loop must then stop.
    pub fn take_block_and_select_next_finger(
        &mut self,
    ) -> Result<(FingerIndex<FINGERS>, &[Scan; SCANS_PER_TICK]), SampleError> {
        // Checked first, because the start of the tick is measured; reported last, because the
        // other errors are more specific.
        let clock_check = self.tick_rate_and_rcc_monitor.check_rcc_cfgr_and_tick_rate();
        let finger = self.finger;
        self.finger_was_selected = self.multiplexer.can_have_selected(finger);
        self.finger = finger.next_cyclic();
        self.multiplexer.select(self.finger);
        if Multiplexer::SETTLING_SCANS != 0 && self.first_scan_of_block_is_stored() {
            return Err(SampleError::LateSwitch);
        }
        if self.transfer.flags().is_transfer_error() {
            return Err(SampleError::Bus);
        }
        let spare = self.spare.take().ok_or(SampleError::Bus)?;
        let (block, which) = self.transfer.next_transfer(spare).map_err(|error| match error {
            DMAError::Overrun(_) => SampleError::Late,
            DMAError::NotReady(_) | DMAError::SmallBuffer(_) => SampleError::Bus,
        })?;
        if which == self.last_buffer {
            return Err(SampleError::Late);
        }
        self.last_buffer = which;
        clock_check?;
        if finger == FingerIndex::FIRST {
            defmt_rtt_log::advance_uptime_by_1_ms();
        }
        let scans = self.spare.insert(block).last_chunk().ok_or(SampleError::Bus)?;
        Ok((finger, scans))
    }

    /// Whether the last block can be that of its finger: a select line of the multiplexers that is
    /// broken or shorted connects other sensors. All fingers must then trip.
    pub const fn finger_was_selected(&self) -> bool {
        self.finger_was_selected
    }

    /// Whether the DMA stream has already stored the first scan of the block that it is filling.
    /// The multiplexers must be switched before that.
    fn first_scan_of_block_is_stored(&self) -> bool {
        usize::from(self.transfer.number_of_transfers())
            <= (SCANS_PER_BLOCK - 1) * ADC_CHANNELS_PER_FINGER
    }

    /// Stops sampling until the next reset. No control tick follows, so the watchdogs are no longer
    /// fed and reset the device.
    pub fn stop(&mut self) {
        self.transfer.pause(SensorAdc::disable_adc_and_overrun_interrupt);
    }
}

/// ADC1, which converts all eight channels of the sensors once for each trigger by TIM2.
///
/// The driver of `stm32f4xx-hal` is not used: it measures the supply voltage during its set-up,
/// which is of no use here because all sensors are ratiometric to the supply, and it does not
/// support the overrun interrupt.
pub struct SensorAdc {
    adc: ADC1,
    _inputs: SensorPins,
}

impl SensorAdc {
    /// Sets up ADC1 with a clock of 90 MHz / 4 = 22.5 MHz (the maximum is 36 MHz) and with the
    /// sampling time [`SAMPLE_TIME_CODE`] for each of the eight channels.
    pub fn new(adc: ADC1, inputs: SensorPins, rcc: &mut Rcc) -> Self {
        ADC1::enable(rcc);
        ADC1::reset(rcc);
        // SAFETY: the common registers are shared by three converters, of which only ADC1 is used.
        let common = unsafe { ADC_COMMON::steal() };
        common.ccr().write(|w| w.adcpre().div4());
        adc.smpr1().write(|w| {
            w.smp10().set(SAMPLE_TIME_CODE);
            w.smp11().set(SAMPLE_TIME_CODE);
            w.smp12().set(SAMPLE_TIME_CODE);
            w.smp14().set(SAMPLE_TIME_CODE)
        });
        adc.smpr2().write(|w| {
            w.smp0().set(SAMPLE_TIME_CODE);
            w.smp1().set(SAMPLE_TIME_CODE);
            w.smp4().set(SAMPLE_TIME_CODE);
            w.smp8().set(SAMPLE_TIME_CODE)
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
        // SAFETY: ADC1 has these channels.
        adc.sqr2().write(|w| unsafe {
            w.sq7().bits(12); // current, PC2
            w.sq8().bits(14) // supply, PC4
        });
        adc.sqr1().write(|w| w.l().set(ADC_CHANNELS_PER_FINGER as u8 - 1));
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
        Self { adc, _inputs: inputs }
    }

    /// Switches ADC1 off and disables its overrun interrupt, which the conversions would raise once
    /// the DMA stream no longer fetches them.
    fn disable_adc_and_overrun_interrupt(&mut self) {
        self.adc.cr1().write(|w| w.ovrie().disabled());
        self.adc.cr2().write(|w| w.adon().disabled());
    }
}

// SAFETY: the address is that of the data register of ADC1, which may be read as half-words.
unsafe impl PeriAddress for SensorAdc {
    type MemSize = u16;

    fn address(&self) -> u32 {
        self.adc.dr().as_ptr() as u32
    }
}

// SAFETY: channel 0 of stream 0 of DMA2 serves the requests of ADC1 (RM0390, table 29).
unsafe impl DMASet<Stream0<DMA2>, 0, PeripheralToMemory> for SensorAdc {}
