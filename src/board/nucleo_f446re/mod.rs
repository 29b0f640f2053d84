//! NUCLEO-F446RE with DRV8873-class bridges and a sensor front end on its headers, for one finger or for five.
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
//! The bridges' pins depend on the number of fingers, a constant of the build: `one`, or `five` with the feature
//! `five-fingers`.
//!
//! `bridge enable` acts on DISABLE of the DRV8873, through a transistor that inverts it (DISABLE is pulled up).
//! nSLEEP stays high: a bridge that wakes up may report a fault until its charge pump runs.

mod dose;
mod fatal;
#[cfg(feature = "five-fingers")]
mod five;
mod flash;
mod log;
#[cfg(not(feature = "five-fingers"))]
mod one;
mod record;
mod reset;
mod sampler;
mod serial;
mod stack;
mod store;
mod timekeeper;
mod watchdog;
mod window;

use cortex_m::peripheral::SYST;
use heapless::spsc::{Producer, Queue};
use stm32f4xx_hal::dma::StreamsTuple;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::{Config, Rcc};
use thermal_display::device::Telemetry;
use thermal_display::device::command::Addressed;
use thermal_display::device::safety::{Cause, Fault};
use thermal_display::mailbox::Mailbox;
use thermal_display::protocol::{Desk, Error, Reason, Reply};
use thermal_display::settings::Settings;

pub use dose::{keep as keep_dose, kept as kept_dose};
#[cfg(feature = "five-fingers")]
use five as wiring;
#[cfg(not(feature = "five-fingers"))]
use one as wiring;
pub use record::Record;
pub use sampler::{Sampler, Trigger};
pub use serial::{End, Outbox, Receiver, Transmitter};
pub use stack::is_overrun as stack_is_overrun;
pub use stm32f4xx_hal::pac;
pub use store::{Found, at_start, restart};
pub use watchdog::Watchdog;
pub use window::WindowWatchdog;
pub use wiring::{FINGERS, PowerStage};

use super::console::Console;
use reset::Reset;
use timekeeper::Timekeeper;

/// Telemetry that may wait for the host task: what it can be late, in ticks, before a line is left out.
const TELEMETRY_DEPTH: usize = 8 * FINGERS;

/// What the hardware and the tasks share by reference; it must live as long as the program.
pub struct Memory {
    scans: [sampler::Block; sampler::BLOCKS],
    frames: [serial::Bytes; serial::FRAMES],
    links: serial::Links,
    mailbox: Mailbox,
    telemetry: Queue<Addressed<Telemetry>, { TELEMETRY_DEPTH + 1 }>,
    // Here, as moving it once samples are taken makes the first tick late.
    desk: Option<Desk<FINGERS>>,
}

impl Memory {
    /// Empty buffers and queues.
    pub const fn new() -> Self {
        Self {
            scans: [sampler::EMPTY; sampler::BLOCKS],
            frames: [const { serial::Bytes::new() }; serial::FRAMES],
            links: serial::Links::new(),
            mailbox: Mailbox::new(),
            telemetry: Queue::new(),
            desk: None,
        }
    }
}

/// Why the device has tripped before it started; once, and first of all: what follows takes long, and may end in a reset.
pub fn first_cause(rcc: &pac::RCC) -> Option<Cause> {
    let overrun = stack::is_overrun();
    stack::arm();
    let reset = Reset::of(rcc);
    if reset == Reset::PowerOn {
        dose::forget();
    }
    let mut cause = record::of_reset(reset, store::is_planned());
    // The end of a program, without a tick that has seen why, is what comes of an overrun. Not so of the first start of
    // another program, whose stack may lie here.
    let unseen = |cause: Cause| cause.tick == 0 && cause.fault != Fault::UnaskedReset;
    if overrun && cause.is_some_and(unseen) {
        record::forget();
        record::keep(&Cause::alone(Fault::Stack));
        cause = record::kept();
    }
    // Only now that the cause is kept.
    Reset::clear(rcc);
    defmt::info!("start after reset: {}", reset);
    cause
}

/// The board, set up and ready to take samples; the parts go to the tasks that own them.
pub struct Board {
    /// Scans of the sensors.
    pub sampler: Sampler,
    /// What starts them.
    pub trigger: Trigger,
    /// Each finger's bridge and its fault line.
    pub stages: [PowerStage; FINGERS],
    /// Bytes of the host.
    pub receiver: Receiver,
    /// Lines to the host, at the hardware's end.
    pub transmitter: Transmitter,
    /// Lines to the host, at the other end.
    pub console: Console,
    /// Telemetry on its way to the console.
    pub telemetry: Producer<'static, Addressed<Telemetry>>,
    /// The probe's clock runs; without it nothing may be rendered.
    pub has_clock: bool,
    /// The independent watchdog, already running.
    pub watchdog: Watchdog,
    /// The window watchdog, already running.
    pub window_watchdog: WindowWatchdog,
}

impl Board {
    /// Sets everything up, with what the start has [found](at_start); the bridge is off before anything else happens and
    /// stays off.
    pub fn new(
        counter: SYST,
        device: pac::Peripherals,
        memory: &'static mut Memory,
        found: &Found,
    ) -> Self {
        // First, on its own oscillator.
        let watchdog = Watchdog::start(device.IWDG);
        let has_clock = probe_clock_runs(&device.RCC);
        let mut rcc = device.RCC.freeze(clocks(has_clock));
        if has_clock {
            watch_clock(&mut rcc);
        }

        let gpioa = device.GPIOA.split(&mut rcc);
        let gpiob = device.GPIOB.split(&mut rcc);
        let gpioc = device.GPIOC.split(&mut rcc);

        #[cfg(not(feature = "five-fingers"))]
        let (stages, multiplexer) = {
            let stage = PowerStage::new(
                device.TIM1,
                (gpioa.pa8, gpioa.pa9),
                gpiob.pb10.into_push_pull_output(),
                gpioa.pa6,
                gpioc.pc3.into_push_pull_output(),
                gpioa.pa5.into_push_pull_output(),
                &mut rcc,
            );
            ([stage], wiring::Multiplexer)
        };
        #[cfg(feature = "five-fingers")]
        let (stages, multiplexer) = {
            let wires = wiring::Wires {
                timers: (device.TIM1, device.TIM8, device.TIM10, device.TIM11),
                first: (gpioa.pa8, gpioa.pa9),
                second: (gpioa.pa10, gpioa.pa11),
                third: (gpioc.pc6, gpioc.pc7),
                fourth: (gpioc.pc8, gpioc.pc9),
                fifth: (gpiob.pb8, gpiob.pb9),
                lines: [
                    wiring::Lines {
                        enable: gpiob.pb10.into_push_pull_output().erase(),
                        fault: gpioa.pa6.into_pull_down_input().erase(),
                        test: gpioc.pc3.into_push_pull_output().erase(),
                    },
                    wiring::Lines {
                        enable: gpiob.pb13.into_push_pull_output().erase(),
                        fault: gpioa.pa7.into_pull_down_input().erase(),
                        test: gpioc.pc4.into_push_pull_output().erase(),
                    },
                    wiring::Lines {
                        enable: gpiob.pb14.into_push_pull_output().erase(),
                        fault: gpioa.pa12.into_pull_down_input().erase(),
                        test: gpioc.pc5.into_push_pull_output().erase(),
                    },
                    wiring::Lines {
                        enable: gpiob.pb15.into_push_pull_output().erase(),
                        fault: gpiob.pb5.into_pull_down_input().erase(),
                        test: gpiob.pb6.into_push_pull_output().erase(),
                    },
                    wiring::Lines {
                        enable: gpiob.pb1.into_push_pull_output().erase(),
                        fault: gpiob.pb12.into_pull_down_input().erase(),
                        test: gpiob.pb7.into_push_pull_output().erase(),
                    },
                ],
            };
            let multiplexer = wiring::Multiplexer::new(gpioc.pc10, gpioc.pc11, gpioc.pc12);
            (wires.into_stages(&mut rcc), multiplexer)
        };

        let (inlet, outlet) = memory.mailbox.split();
        let (telemetry, telemetry_out) = memory.telemetry.split();
        let dma1 = StreamsTuple::new(device.DMA1, &mut rcc);
        let (receiver, transmitter, outbox) = serial::start(
            device.USART2,
            (gpioa.pa2, gpioa.pa3),
            dma1.6,
            &mut memory.frames,
            &mut memory.links,
            inlet,
            &mut rcc,
        );
        let desk = memory.desk.insert(match &found.kept {
            Ok(Some(kept)) => Desk::restored(kept),
            Ok(None) | Err(_) => Desk::new(Settings::default()),
        });
        // The answer to the line that the device was started anew by.
        let first = found.stored.as_ref().map(|stored| match stored {
            Ok(()) => Ok(Reply::DONE),
            Err(error) => Err(Error::NotStored(Reason::of(error))),
        });
        let console = Console::new(outlet, telemetry_out, outbox, desk, first);

        let inputs = sampler::Inputs {
            display: gpioa.pa0.into_analog(),
            display_check: gpioa.pa1.into_analog(),
            sink: gpioa.pa4.into_analog(),
            skin: gpiob.pb0.into_analog(),
            room: gpioc.pc1.into_analog(),
            force: gpioc.pc0.into_analog(),
            current: gpioc.pc2.into_analog(),
        };
        let dma2 = StreamsTuple::new(device.DMA2, &mut rcc);
        let (sampler, trigger) = Sampler::new(
            sampler::Converter::new(device.ADC1, inputs, &mut rcc),
            device.TIM2,
            Timekeeper::new(counter, rcc.clocks.hclk().raw()),
            dma2.0,
            multiplexer,
            &mut memory.scans,
            &mut rcc,
        );

        Self {
            has_clock,
            sampler,
            trigger,
            stages,
            receiver,
            transmitter,
            console,
            telemetry,
            watchdog,
            window_watchdog: WindowWatchdog::start(device.WWDG, &mut rcc),
        }
    }
}

/// Starts the probe's 8 MHz; whether they come within at least 20 ms of 16 MHz.
fn probe_clock_runs(rcc: &pac::RCC) -> bool {
    rcc.cr().modify(|_, w| w.hsebyp().bypassed().hseon().on());
    (0..1 << 16).any(|_| rcc.cr().read().hserdy().is_ready())
}

/// 180 MHz, the most this part can do, from the crystal of the on-board probe: the internal oscillator's
/// 1 % would be an error of time in every rendered contact. Without it the internal one is good enough to tell the host why
/// nothing is rendered. 45 MHz is 45 times the baud rate and 90 MHz (both timer clocks are multiples of it) a multiple of
/// the scan and PWM rates: all are exact.
fn clocks(has_clock: bool) -> Config {
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

/// Lets the clock security system watch the probe's clock. When it fails, TIM1's outputs are cut by its
/// break input, without a program, and the non-maskable interrupt follows (RM0390, 6.2.7).
fn watch_clock(rcc: &mut Rcc) {
    rcc.cr().modify(|_, w| w.csson().on());
}
