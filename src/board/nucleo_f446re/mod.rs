//! NUCLEO-F446RE with DRV8873-class bridges and a sensor front end on its headers, for one finger
//! or for five.
//!
//! | pin | header | signal                | notes                                     |
//! |-----|--------|-----------------------|-------------------------------------------|
//! | PA0 | A0     | display thermistor    | ADC1 channel 0                            |
//! | PA1 | A1     | display check         | ADC1 channel 1; also feeds the comparator |
//! | PA4 | A2     | sink thermistor       | ADC1 channel 4                            |
//! | PB0 | A3     | skin thermistor       | ADC1 channel 8                            |
//! | PC1 | A4     | room thermistor       | ADC1 channel 11                           |
//! | PC0 | A5     | force                 | ADC1 channel 10                           |
//! | PC2 | CN7-35 | bridge current mirror | ADC1 channel 12                           |
//! | PA2 | -      | to the host           | USART2 by way of the on-board probe       |
//! | PA3 | -      | from the host         | USART2 by way of the on-board probe       |
//! | PH0 | -      | 8 MHz from the probe  | HSE, bypassed oscillator                  |
//!
//! The pins of the bridges depend on the number of fingers, which is fixed when the firmware is
//! built: see `one_finger`, or `five_fingers` for the feature `five-fingers`.
//!
//! The line `bridge enable` drives the input DISABLE of the DRV8873, which has a pull-up, through
//! an inverting transistor. nSLEEP stays high, because a bridge that wakes up may report a fault
//! until its charge pump runs.

mod clock_monitor;
mod fatal_errors;
mod fault_record;
#[cfg(feature = "five-fingers")]
mod five_fingers;
mod flash;
mod log;
#[cfg(not(feature = "five-fingers"))]
mod one_finger;
mod reset;
mod sample_error;
mod sampler;
mod saved_dose;
mod serial;
mod settings_storage;
mod stack;
mod watchdog;
mod window_watchdog;

use cortex_m::peripheral::SYST;
use heapless::spsc::Queue;
use stm32f4xx_hal::dma::StreamsTuple;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::{Config, Rcc};
use thermal_display::device::command::Addressed;
use thermal_display::device::safety::{Fault, TripCause};
use thermal_display::device::{Device, Finger, Telemetry};
use thermal_display::mailbox::Mailbox;
use thermal_display::protocol::{CommandHandler, Error, FailureText, Reply};
use thermal_display::settings::Settings;

pub use fault_record::FaultRecord;
#[cfg(feature = "five-fingers")]
use five_fingers as wiring;
#[cfg(not(feature = "five-fingers"))]
use one_finger as wiring;
pub use sample_error::SampleError;
pub use sampler::{SampleTrigger, Sampler};
pub use saved_dose::save_dose;
pub use serial::{Completed, Outbox, Receiver, Transmitter};
pub use settings_storage::restart_to_save;
pub use stack::stack_is_overrun;
pub use stm32f4xx_hal::pac;
pub use watchdog::Watchdog;
pub use window_watchdog::WindowWatchdog;
pub use wiring::{FINGERS, PowerStage};

use super::{Console, ControlLoop};
use clock_monitor::ClockMonitor;
use reset::Reset;
use settings_storage::StartupStorage;

/// Telemetry lines that can wait for the host task: those of eight ticks.
const TELEMETRY_DEPTH: usize = 8 * FINGERS;

/// Memory that hardware and tasks share by reference, and that must live as long as the program.
pub struct Memory {
    scans: [sampler::ScanBlock; sampler::BLOCKS],
    frames: [serial::FrameBuffer; serial::FRAMES],
    frame_queues: serial::FrameQueues,
    mailbox: Mailbox,
    telemetry: Queue<Addressed<Telemetry>, { TELEMETRY_DEPTH + 1 }>,
    // Created in place, because moving it while sampling runs would delay the first tick.
    handler: Option<CommandHandler<FINGERS>>,
}

impl Memory {
    /// Memory with empty buffers and queues, as it is before [`Board::start`] uses it.
    pub const fn new() -> Self {
        Self {
            scans: [sampler::EMPTY; sampler::BLOCKS],
            frames: [const { serial::FrameBuffer::new() }; serial::FRAMES],
            frame_queues: serial::FrameQueues::new(),
            mailbox: Mailbox::new(),
            telemetry: Queue::new(),
            handler: None,
        }
    }
}

/// Determines the fault by which the device is tripped from the start, and stores it before
/// anything else is done: the rest of the start-up takes long, and another reset may end it.
fn cause_at_start(rcc: &pac::RCC) -> Option<TripCause> {
    let stack_was_overrun = stack::stack_is_overrun();
    stack::init_guard();
    let reset = Reset::read(rcc);
    if reset == Reset::PowerOn {
        saved_dose::clear_doses();
    }
    let mut cause = fault_record::cause_at_start(reset, settings_storage::save_is_pending());
    // A fault that no tick has recorded is a consequence of the overrun. The first start of another
    // version of the firmware is excepted, because its predecessor may have used the words of the
    // guard.
    let is_consequence = |cause: TripCause| cause.tick == 0 && cause.fault != Fault::UnaskedReset;
    if stack_was_overrun && cause.is_some_and(is_consequence) {
        fault_record::erase();
        fault_record::store_if_empty(&TripCause::without_readings(Fault::Stack));
        cause = fault_record::stored();
    }
    // The flags are cleared last: if a reset intervenes, the next start still finds them.
    Reset::clear(rcc);
    defmt::info!("start after reset: {}", reset);
    cause
}

/// Creates the device with its stored settings and doses, tripped by `cause` if there is one.
fn restore_device(
    place: &'static mut Option<Device<FINGERS>>,
    cause: Option<TripCause>,
    storage: &StartupStorage,
) -> &'static mut Device<FINGERS> {
    let device = place.insert(Device::with_trip_cause(cause, &Settings::default()));
    match &storage.settings {
        Ok(Some(settings)) => device.restore_settings(settings),
        Ok(None) => {}
        Err(_) => device.trip_all(Fault::SettingsCorrupt),
    }
    for finger in Finger::all() {
        device.restore_dose(finger, saved_dose::saved_dose(finger));
    }
    device
}

/// The parts of the board, set up and ready to take samples, which are moved to the tasks that own
/// them.
pub struct Board {
    /// The hardware-free device: the stations of all fingers.
    pub device: &'static mut Device<FINGERS>,
    /// Sampling, bridges and window watchdog, which is already running.
    pub control_loop: ControlLoop,
    /// The timer that the idle task starts, so that sampling begins once interrupts are enabled.
    pub trigger: SampleTrigger,
    /// Receives bytes from the host and assembles them to lines, in the interrupt of the serial port.
    pub receiver: Receiver,
    /// Sends the lines to the host one after the other, in the interrupt of the sending DMA stream.
    pub transmitter: Transmitter,
    /// Answers the lines of the host and sends telemetry, in the host task.
    pub console: Console,
    /// The independent watchdog, already running.
    pub watchdog: Watchdog,
}

impl Board {
    /// Starts the device in the memory that is passed: stores settings if the restart was requested
    /// for that, and sets everything up with the bridges off.
    pub fn start(
        systick: SYST,
        peripherals: pac::Peripherals,
        memory: &'static mut Memory,
        device: &'static mut Option<Device<FINGERS>>,
    ) -> Self {
        let cause = cause_at_start(&peripherals.RCC);
        // Before anything is set up that the flash would delay.
        let storage = settings_storage::save_pending_and_load(&peripherals.FLASH);
        // This takes 0.2 s at 16 MHz, so it comes before the watchdogs and the sampling start.
        let device = restore_device(device, cause, &storage);
        // A fault of the settings is not stored, because every start finds it again until other
        // settings are stored.
        let fault_record = FaultRecord::new(device.earliest_cause().copied());

        // First, because it has its own oscillator.
        let watchdog = Watchdog::start(peripherals.IWDG);
        let has_clock = start_probe_clock(&peripherals.RCC);
        let mut rcc = peripherals.RCC.freeze(clock_config(has_clock));
        if has_clock {
            enable_clock_security(&mut rcc);
        }

        let gpioa = peripherals.GPIOA.split(&mut rcc);
        let gpiob = peripherals.GPIOB.split(&mut rcc);
        let gpioc = peripherals.GPIOC.split(&mut rcc);

        #[cfg(not(feature = "five-fingers"))]
        let (stages, multiplexer) = {
            let stage = PowerStage::new(
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
            let pins = wiring::BridgePeripherals {
                timers: (
                    peripherals.TIM1,
                    peripherals.TIM8,
                    peripherals.TIM10,
                    peripherals.TIM11,
                ),
                first: (gpioa.pa8, gpioa.pa9),
                second: (gpioa.pa10, gpioa.pa11),
                third: (gpioc.pc6, gpioc.pc7),
                fourth: (gpioc.pc8, gpioc.pc9),
                fifth: (gpiob.pb8, gpiob.pb9),
                lines: [
                    wiring::ControlLines::new(gpiob.pb10, gpioa.pa6, gpioc.pc3),
                    wiring::ControlLines::new(gpiob.pb13, gpioa.pa7, gpioc.pc4),
                    wiring::ControlLines::new(gpiob.pb14, gpioa.pa12, gpioc.pc5),
                    wiring::ControlLines::new(gpiob.pb15, gpiob.pb5, gpiob.pb6),
                    wiring::ControlLines::new(gpiob.pb1, gpiob.pb12, gpiob.pb7),
                ],
            };
            let multiplexer = wiring::Multiplexer::new(gpioc.pc10, gpioc.pc11, gpioc.pc12);
            (pins.into_stages(&mut rcc), multiplexer)
        };

        let (inlet, outlet) = memory.mailbox.split();
        let (telemetry_in, telemetry_out) = memory.telemetry.split();
        let dma1 = StreamsTuple::new(peripherals.DMA1, &mut rcc);
        let (receiver, transmitter, outbox) = serial::start(
            peripherals.USART2,
            (gpioa.pa2, gpioa.pa3),
            dma1.6,
            &mut memory.frames,
            &mut memory.frame_queues,
            inlet,
            &mut rcc,
        );
        let handler = match &storage.settings {
            Ok(Some(settings)) => CommandHandler::from_stored(settings),
            Ok(None) | Err(_) => CommandHandler::new(Settings::default()),
        };
        let console = Console {
            lines: outlet,
            telemetry: telemetry_out,
            outbox,
            handler: memory.handler.insert(handler),
            first_answer: storage.save_result.map(|result| match result {
                Ok(()) => Ok(Reply::DONE),
                Err(error) => Err(Error::NotStored(FailureText::new(&error))),
            }),
            storage_order: None,
        };

        let pins = sampler::SensorPins {
            display: gpioa.pa0.into_analog(),
            display_check: gpioa.pa1.into_analog(),
            sink: gpioa.pa4.into_analog(),
            skin: gpiob.pb0.into_analog(),
            room: gpioc.pc1.into_analog(),
            force: gpioc.pc0.into_analog(),
            current: gpioc.pc2.into_analog(),
        };
        let dma2 = StreamsTuple::new(peripherals.DMA2, &mut rcc);
        let (sampler, trigger) = Sampler::new(
            sampler::Converter::new(peripherals.ADC1, pins, &mut rcc),
            peripherals.TIM2,
            ClockMonitor::new(systick, rcc.clocks.hclk().raw()),
            dma2.0,
            multiplexer,
            &mut memory.scans,
            &mut rcc,
        );

        Self {
            device,
            control_loop: ControlLoop {
                sampler,
                stages,
                fault_record,
                telemetry: telemetry_in,
                window_watchdog: WindowWatchdog::start(peripherals.WWDG, &mut rcc),
                has_clock,
            },
            trigger,
            receiver,
            transmitter,
            console,
            watchdog,
        }
    }
}

/// Starts the 8 MHz clock that the debug probe provides, and returns whether it has become stable.
/// Waits for at least 20 ms, at a core clock of 16 MHz.
fn start_probe_clock(rcc: &pac::RCC) -> bool {
    rcc.cr().modify(|_, w| w.hsebyp().bypassed().hseon().on());
    (0..1 << 16).any(|_| rcc.cr().read().hserdy().is_ready())
}

/// 180 MHz, the maximum of this microcontroller, derived from the crystal of the debug probe. The
/// internal oscillator has a tolerance of 1 %, which would be an error of time in every rendered
/// contact; it is used only if the probe's clock is missing, so that the host can be told why
/// nothing is rendered.
///
/// All rates are exact: 45 MHz is a multiple of the baud rate, and 90 MHz, of which both timer
/// clocks are multiples, is a multiple of the scan and PWM rates.
fn clock_config(has_clock: bool) -> Config {
    let source = if has_clock {
        Config::hse(8.MHz()).bypass_hse_oscillator()
    } else {
        Config::hsi()
    };
    source
        .sysclk(180.MHz())
        .hclk(180.MHz())
        .pclk1(45.MHz())
        .pclk2(90.MHz())
}

/// Enables the clock security system. When the probe's clock fails, the hardware disables the
/// outputs of TIM1 by its break input, without any code, and raises the non-maskable interrupt
/// (RM0390, 6.2.7).
fn enable_clock_security(rcc: &mut Rcc) {
    rcc.cr().modify(|_, w| w.csson().on());
}
