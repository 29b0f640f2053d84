//! NUCLEO-F446RE with bridges of a DRV8702-Q1 and four MOSFETs and with a sensor front end on its
//! headers, for one finger or for five.
//!
//! | pin | header | signal                | notes                                     |
//! |-----|--------|-----------------------|-------------------------------------------|
//! | PA0 | A0     | display thermistor    | ADC1 channel 0                            |
//! | PA1 | A1     | display check         | ADC1 channel 1; also feeds the comparator |
//! | PA4 | A2     | sink thermistor       | ADC1 channel 4                            |
//! | PB0 | A3     | skin thermistor       | ADC1 channel 8                            |
//! | PC1 | A4     | room thermistor       | ADC1 channel 11                           |
//! | PC0 | A5     | force                 | ADC1 channel 10                           |
//! | PC2 | CN7-35 | bridge current        | ADC1 channel 12                           |
//! | PC4 | CN10-34 | bridge supply        | ADC1 channel 14, behind its switch        |
//! | PB2 | CN10-22 | side of the comparators' tests | low hot, high cold; pull-down   |
//! | PC13 | CN7-23 | emergency stop       | low while pressed                         |
//! | PB4 | D5     | trigger input         | rising edge; TIM3 channel 1               |
//! | PB3 | D3     | trigger output        | a pulse of 10 ms marks an event           |
//! | PA2 | -      | to the host           | USART2 by way of the on-board probe       |
//! | PA3 | -      | from the host         | USART2 by way of the on-board probe       |
//! | PH0 | -      | 8 MHz from the probe  | HSE, bypassed oscillator                  |
//!
//! The pins of the bridges depend on the number of fingers, which is fixed when the firmware is
//! built: see `one_finger`, or `five_fingers` for the feature `five-fingers`.
//!
//! The line `bridge enable` opens AND gates between the PWM pins and the inputs of the driver, so
//! that low makes both inputs low, which is high-impedance. The driver's nSLEEP stays high, because
//! a driver that wakes up may report a fault until its charge pump runs. After an over-current it
//! tries again after 3 ms.

mod brown_out_level;
mod chip_monitor;
mod comparator_side;
pub(crate) mod debug_freeze;
mod defmt_rtt_log;
mod emergency_stop;
#[cfg(not(test))]
mod fatal_errors;
#[cfg(feature = "five-fingers")]
mod five_fingers;
mod independent_watchdog;
mod late_clock;
pub mod line_losses;
#[cfg(not(feature = "five-fingers"))]
mod one_finger;
mod program_digest;
mod pwm_settings;
mod requested_restart;
pub(crate) mod reset_cause;
mod sample_error;
mod sampler;
mod saved_dose;
mod serial;
pub(crate) mod settings_flash;
pub(crate) mod settings_storage;
pub(crate) mod stack_guard;
mod tick_rate_and_rcc_monitor;
mod trigger_input;
mod trigger_output;
pub(crate) mod trip_cause_recorder;
mod unique_id;
mod window_watchdog;

use core::mem::MaybeUninit;

use cortex_m::peripheral::SYST;
use heapless::spsc::Queue;
use stm32f4xx_hal::dma::StreamsTuple;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::{Config, Rcc};
use thermal_display::device::command::WithSourceFinger;
use thermal_display::device::events::UnsolicitedReport;
use thermal_display::device::safety::{Fault, TripCause};
use thermal_display::device::{DeviceInPlace, FingerIndex, Station};
use thermal_display::line_queue::LineQueue;
use thermal_display::protocol::{
    BoardStatus, CommandHandler, Error, OutgoingLine, Reply, StorageFailureText,
};
use thermal_display::settings::Settings;

pub use chip_monitor::{ChipMonitor, status_now as board_status_now};
pub use comparator_side::ComparatorSide;
pub use emergency_stop::EmergencyStop;
#[cfg(feature = "five-fingers")]
use five_fingers as wiring;
pub use independent_watchdog::IndependentWatchdog;
#[cfg(not(feature = "five-fingers"))]
use one_finger as wiring;
pub use sample_error::SampleError;
pub use sampler::{SampleTrigger, Sampler};
pub use saved_dose::save_dose_if_changed;
pub use serial::{BlankOrToBeAnsweredLine, Outbox, Receiver, Transmitter};
pub use settings_storage::restart_to_save;
pub use stack_guard::stack_is_overrun;
pub use stm32f4xx_hal::pac;
pub use trigger_input::TriggerInput;
pub use trigger_output::TriggerOutput;
pub use trip_cause_recorder::TripCauseRecorder;
pub use window_watchdog::WindowWatchdog;
pub use wiring::{FINGERS, FingerPowerStage, FluxConverter};

use super::{Console, ControlLoop};
use reset_cause::ResetCause;
use settings_storage::SaveAndLoadResult;
use tick_rate_and_rcc_monitor::TickRateAndRccMonitor;

/// Capacity of the telemetry queue, in lines: those of eight ticks of 1 ms, one line a tick for
/// each finger.
const TELEMETRY_QUEUE_CAPACITY: usize = 8 * FINGERS;

/// Buffers and queues that the DMA streams and the tasks share by reference, and the command
/// handler of the host task. `main.rs` allocates them statically, because they must live as long as
/// the program.
pub struct StaticMemory {
    scans: [sampler::ScanBlock; sampler::TRIPLE_BUFFER_BLOCK_COUNT],
    frames: [OutgoingLine; serial::FRAME_COUNT],
    frame_queues: serial::FullAndEmptyFrameQueues,
    line_queue: LineQueue,
    telemetry: Queue<WithSourceFinger<UnsolicitedReport>, { TELEMETRY_QUEUE_CAPACITY + 1 }>,
    // Created in place, because moving it while sampling runs would delay the first tick. Not an `Option`, whose `None` is not
    // all zeros, so that the whole memory would be kept in flash, to be copied from there at the start.
    handler: MaybeUninit<CommandHandler<FINGERS>>,
}

impl StaticMemory {
    /// Creates the memory with empty buffers and queues, as [`Board::set_up`] expects it.
    pub const fn new() -> Self {
        Self {
            scans: [sampler::EMPTY_BLOCK; sampler::TRIPLE_BUFFER_BLOCK_COUNT],
            frames: [const { OutgoingLine::new() }; serial::FRAME_COUNT],
            frame_queues: serial::FullAndEmptyFrameQueues::new(),
            line_queue: LineQueue::new(),
            telemetry: Queue::new(),
            handler: MaybeUninit::uninit(),
        }
    }
}

/// Reads the cause of the reset, and determines the cause, if any, by which all fingers are tripped before their first tick: the trip
/// cause stored before the reset or, if none is stored, the fault that the reset itself indicates.
/// If the stack guard was overwritten, [`Fault::Stack`] replaces a cause that no tick has recorded,
/// except [`Fault::UnaskedReset`]. Stores the cause before the rest of the start-up, which takes
/// long, so that another reset during the start-up does not lose it. After power-on, also sets the
/// saved thermal doses to zero.
fn reset_and_trip_cause_at_start(rcc: &pac::RCC) -> (ResetCause, Option<TripCause>) {
    let stack_was_overrun = stack_guard::stack_is_overrun();
    stack_guard::init_guard();
    let reset = ResetCause::read(rcc);
    if reset == ResetCause::PowerOn {
        saved_dose::zero_saved_doses();
    }
    let restart_was_requested = requested_restart::was_requested();
    let mut cause = trip_cause_recorder::store_reset_fault_and_load_cause(
        reset,
        settings_storage::save_is_pending() || restart_was_requested,
    );
    // A fault that no tick has recorded is a consequence of the overrun. The first start of another
    // version of the firmware is excepted, because its predecessor may have used the words of the
    // guard.
    let is_consequence = |cause: TripCause| cause.tick == 0 && cause.fault != Fault::UnaskedReset;
    if stack_was_overrun && cause.is_some_and(is_consequence) {
        trip_cause_recorder::erase_stored_trip_cause();
        trip_cause_recorder::store_trip_cause_if_none(&TripCause::without_readings(Fault::Stack));
        cause = trip_cause_recorder::stored_trip_cause();
    }
    // The flags are cleared last: if a reset intervenes, the next start still finds them.
    ResetCause::clear_flags(rcc);
    defmt::info!("start after reset: {}", reset);
    (reset, cause)
}

/// Creates the device, its stations in `places`, with the settings from the flash and with the thermal doses that
/// were saved in RAM before the reset. All fingers are tripped by `cause` if there is one, and by
/// [`Fault::SettingsCorrupt`] if the settings cannot be read.
fn create_and_restore_device(
    places: &'static mut MaybeUninit<[Station; FINGERS]>,
    cause: Option<TripCause>,
    storage: &SaveAndLoadResult,
) -> DeviceInPlace<FINGERS> {
    let mut device = DeviceInPlace::from_stations(create_stations(places, cause));
    match &storage.settings {
        Ok(Some(stored)) => device.restore_settings(&stored.fingers),
        Ok(None) => {}
        Err(_) => device.trip_all(Fault::SettingsCorrupt),
    }
    for finger in FingerIndex::all() {
        device.restore_finger_thermal_dose(finger, saved_dose::saved_dose_or_zero(finger));
    }
    device
}

/// Creates the stations in `places`: the first one, and the others as its copies. On the stack they would need more of it
/// than everything that runs later.
///
/// The device gets one reference to the whole array, not an array of references. The latter was once all that a resource of
/// RTIC held, in memory that the start leaves as it is (`.uninit`). As the program stored it once only, LLVM 21 made the
/// stored value the initial value, which nothing puts there, and left out the store: a loop over the fingers read an address
/// that had never been written.
#[inline(never)]
fn create_stations(
    places: &'static mut MaybeUninit<[Station; FINGERS]>,
    cause: Option<TripCause>,
) -> &'static mut [Station; FINGERS] {
    let first = places.as_mut_ptr().cast::<Station>();
    // SAFETY: the places are those of the array, which nothing else refers to, and the first one is written first.
    unsafe {
        first.write(Station::new(&Settings::default()));
        // Not before the move, which then needs no second place on the stack.
        if let Some(cause) = cause {
            (*first).trip(cause);
        }
        for finger in (0..FINGERS).skip(1) {
            first.add(finger).write((*first).clone());
        }
    }
    // SAFETY: all places were written.
    unsafe { places.assume_init_mut() }
}

/// Creates the command handler in `place`, with the settings from the flash. A function of its own,
/// so that the copy of the handler that it needs takes stack at the start only, and not in `main`,
/// which never returns.
#[inline(never)]
fn create_handler(
    place: &'static mut MaybeUninit<CommandHandler<FINGERS>>,
    storage: &SaveAndLoadResult,
) -> &'static mut CommandHandler<FINGERS> {
    place.write(match &storage.settings {
        Ok(Some(stored)) => CommandHandler::from_stored(stored),
        Ok(None) | Err(_) => CommandHandler::new(Settings::default()),
    })
}

/// The parts of the board, set up and ready to sample. `main.rs` moves each part to the task that
/// owns it.
pub struct Board {
    /// The control of all fingers, independent of the hardware: one station for each finger, which
    /// computes the outputs of a control tick from the samples.
    pub device: DeviceInPlace<FINGERS>,
    /// Sampling, bridges and window watchdog, for the control tick. The window watchdog already
    /// runs, so the first tick must follow within 46.6 ms.
    pub control_loop: ControlLoop,
    /// The timer that triggers the scans, not started yet. The idle task starts it, because
    /// sampling must not begin before interrupts are enabled.
    pub trigger: SampleTrigger,
    /// Receives bytes from the host and assembles them into lines, in the interrupt of USART2.
    pub receiver: Receiver,
    /// Sends queued lines to the host one after the other, in the interrupt of the DMA stream that
    /// sends.
    pub transmitter: Transmitter,
    /// Answers the lines of the host and sends telemetry, in the host task.
    pub console: Console,
    /// The independent watchdog, which already runs; the idle task feeds it.
    pub watchdog: IndependentWatchdog,
}

impl Board {
    /// Sets up the device and all parts of the board at the start of the program; all bridges are
    /// then off, and sampling has not started. If settings wait in RAM, because the host has
    /// requested the restart by `save` or `forget`, they are stored in flash first. `memory` and
    /// `stations` are static memory: `memory` for buffers, queues and command handler, `stations`
    /// for those of the device, which are created in it.
    pub fn set_up(
        systick: SYST,
        peripherals: pac::Peripherals,
        memory: &'static mut StaticMemory,
        stations: &'static mut MaybeUninit<[Station; FINGERS]>,
    ) -> Self {
        debug_freeze::clear_freeze_bits(&peripherals.DBGMCU);
        let (reset, cause) = reset_and_trip_cause_at_start(&peripherals.RCC);
        let brown_out_level = brown_out_level::brown_out_level(&peripherals.FLASH);
        // Before anything is set up that the flash would delay.
        let storage = settings_storage::save_pending_and_load(&peripherals.FLASH);
        // Creating the device takes 0.2 s at 16 MHz, so it comes before the watchdogs and the
        // sampling start.
        let device = create_and_restore_device(stations, cause, &storage);
        // A fault of the settings is not stored, because every start finds it again until other
        // settings are stored.
        let trip_cause_recorder = TripCauseRecorder::new(device.earliest_trip_cause().copied());

        // Before the clocks are set up, because this watchdog has its own oscillator.
        let watchdog = IndependentWatchdog::start(peripherals.IWDG);
        let has_clock = try_start_hse_from_probe(&peripherals.RCC);
        let mut rcc = peripherals.RCC.freeze(clock_config_from_hse_or_hsi(has_clock));
        if has_clock {
            enable_clock_security(&mut rcc);
        }

        let gpioa = peripherals.GPIOA.split(&mut rcc);
        let gpiob = peripherals.GPIOB.split(&mut rcc);
        let gpioc = peripherals.GPIOC.split(&mut rcc);

        #[cfg(not(feature = "five-fingers"))]
        let (stages, multiplexer) = {
            let stage = FingerPowerStage::new(
                peripherals.TIM1,
                (gpioa.pa8, gpioa.pa9),
                gpiob.pb10,
                gpioa.pa6,
                gpioc.pc3,
                gpioa.pa5,
                &mut rcc,
            );
            ([stage], wiring::Multiplexer)
        };
        #[cfg(feature = "five-fingers")]
        let (stages, multiplexer) = {
            let gpiod = peripherals.GPIOD.split(&mut rcc);
            let pins = wiring::BridgePeripherals {
                timers: (peripherals.TIM1, peripherals.TIM8, peripherals.TIM10, peripherals.TIM11),
                first: (gpioa.pa8, gpioa.pa9),
                second: (gpioa.pa10, gpioa.pa11),
                third: (gpioc.pc6, gpioc.pc7),
                fourth: (gpioc.pc8, gpioc.pc9),
                fifth: (gpiob.pb8, gpiob.pb9),
                lines: [
                    wiring::BridgeAndComparatorPins::new(gpiob.pb10, gpioa.pa6, gpioc.pc3),
                    wiring::BridgeAndComparatorPins::new(
                        gpiob.pb13,
                        gpioa.pa7,
                        gpioa.pa15.into_input(),
                    ),
                    wiring::BridgeAndComparatorPins::new(gpiob.pb14, gpioa.pa12, gpiod.pd2),
                    wiring::BridgeAndComparatorPins::new(gpiob.pb15, gpiob.pb5, gpiob.pb6),
                    wiring::BridgeAndComparatorPins::new(gpiob.pb1, gpiob.pb12, gpiob.pb7),
                ],
            };
            let multiplexer =
                wiring::Multiplexer::new(gpioc.pc10, gpioc.pc11, gpioc.pc12, gpioa.pa5);
            (pins.into_power_stages(&mut rcc), multiplexer)
        };

        let (line_producer, line_consumer) = memory.line_queue.split();
        let (telemetry_in, telemetry_out) = memory.telemetry.split();
        let dma1 = StreamsTuple::new(peripherals.DMA1, &mut rcc);
        let (receiver, transmitter, outbox) = serial::set_up(
            peripherals.USART2,
            (gpioa.pa2, gpioa.pa3),
            dma1.6,
            &mut memory.frames,
            &mut memory.frame_queues,
            line_producer,
            &mut rcc,
        );
        let console = Console {
            lines: line_consumer,
            telemetry: telemetry_out,
            outbox,
            handler: create_handler(&mut memory.handler, &storage),
            first_answer: storage.save_result.map(|result| match result {
                Ok(()) => Ok(Reply::DONE),
                Err(error) => Err(Error::NotStored(StorageFailureText::new(&error))),
            }),
            storage_order: None,
            status_at_start: BoardStatus {
                brown_out_level,
                clock_is_external: has_clock,
                reset: reset.name(),
                unique_id: unique_id::unique_id(),
                program_digest: Some(program_digest::program_digest(peripherals.CRC, &mut rcc)),
                ..BoardStatus::default()
            },
        };

        let pins = sampler::SensorPins {
            display: gpioa.pa0.into_analog(),
            display_check: gpioa.pa1.into_analog(),
            sink: gpioa.pa4.into_analog(),
            skin: gpiob.pb0.into_analog(),
            room: gpioc.pc1.into_analog(),
            force: gpioc.pc0.into_analog(),
            current: gpioc.pc2.into_analog(),
            supply: gpioc.pc4.into_analog(),
        };
        let dma2 = StreamsTuple::new(peripherals.DMA2, &mut rcc);
        let (sampler, trigger) = Sampler::new_with_trigger(
            sampler::SensorAdc::new(peripherals.ADC1, pins, &mut rcc),
            peripherals.TIM2,
            TickRateAndRccMonitor::new(systick, rcc.clocks.hclk().raw()),
            dma2.0,
            multiplexer,
            &mut memory.scans,
            &mut rcc,
        );

        #[cfg(not(feature = "five-fingers"))]
        let flux_converter =
            FluxConverter::new(peripherals.ADC2, gpioc.pc5.into_analog(), &mut rcc);
        #[cfg(feature = "five-fingers")]
        let flux_converter = wiring::NoFluxConverter;

        Self {
            device,
            control_loop: ControlLoop {
                sampler,
                flux_converter,
                stages,
                comparator_side: ComparatorSide::new(gpiob.pb2),
                emergency_stop: EmergencyStop::new(gpioc.pc13),
                trigger_input: TriggerInput::new(
                    peripherals.TIM3,
                    gpiob.pb4.into_input(),
                    &mut rcc,
                ),
                trigger_output: TriggerOutput::new(gpiob.pb3),
                trip_cause_recorder,
                telemetry: telemetry_in,
                window_watchdog: WindowWatchdog::start(peripherals.WWDG, &mut rcc),
                chip_monitor: ChipMonitor::new(has_clock, brown_out_level),
            },
            trigger,
            receiver,
            transmitter,
            console,
            watchdog,
        }
    }
}

/// Turns on the input of the 8 MHz clock that the debug probe provides, and returns whether this
/// clock has become stable. Gives up after at least 20 ms, at a core clock of 16 MHz.
fn try_start_hse_from_probe(rcc: &pac::RCC) -> bool {
    rcc.cr().modify(|_, w| w.hsebyp().bypassed().hseon().on());
    (0..1 << 16).any(|_| rcc.cr().read().hserdy().is_ready())
}

/// Clock settings of the microcontroller: 180 MHz for the core, which is the maximum. If
/// `has_clock`, the clocks are derived from the 8 MHz crystal of the debug probe, else from the
/// internal oscillator. The tolerance of the internal oscillator, 1 %, would falsify the time in
/// every rendered contact, so all fingers then stay tripped by [`Fault::Clock`], and the device
/// runs only so that the host can read this fault, until the clock [has come](late_clock).
///
/// All rates are exact: the USART's 45 MHz are a multiple of the baud rate, and the sample timer's
/// 90 MHz a multiple of the scan rate.
fn clock_config_from_hse_or_hsi(has_clock: bool) -> Config {
    let source =
        if has_clock { Config::hse(8.MHz()).bypass_hse_oscillator() } else { Config::hsi() };
    source.sysclk(180.MHz()).hclk(180.MHz()).pclk1(45.MHz()).pclk2(90.MHz())
}

/// Enables the clock security system. When the 8 MHz clock of the probe fails, the hardware
/// disables the PWM outputs of TIM1 (and of TIM8, which drives bridges of the five-finger wiring)
/// by their break inputs, without any code, and raises the non-maskable interrupt, whose handler
/// turns all bridges off (RM0390, 6.2.7).
fn enable_clock_security(rcc: &mut Rcc) {
    rcc.cr().modify(|_, w| w.csson().on());
}
