//! The firmware: which task runs when, at which priority, and what it may touch. Nothing else.
//!
//! | task      | runs when                       | priority | must be done within                   |
//! |-----------|---------------------------------|----------|---------------------------------------|
//! | `receive` | a byte came from the host       | 4        | 20 us: two bytes at 1 Mbaud           |
//! | `tick`    | the scans of 1 ms are in memory | 3        | 1 ms                                  |
//! | `overrun` | the converter lost a conversion | 3        | -                                     |
//! | `refill`  | a line has been sent            | 2        | 20 us, or the line to the host pauses |
//! | `host`    | a line or telemetry waits       | 1        | 68 ms: the watchdog at its fastest    |
//! | `idle`    | otherwise                       | -        | 68 ms: the watchdog at its fastest    |
//!
//! Priorities are rate-monotonic. A byte that is not fetched before the next but one is lost, whereas
//! nothing is lost when a tick starts a microsecond late: a timer starts the conversions, and a new duty
//! takes effect at the next period of the PWM. A flood of bytes costs 100 000 short interrupts a second, no
//! more, so `receive` cannot starve the tick. The tick may make the line to the host pause for its own length.
#![no_std]
#![no_main]

mod board;

#[rtic::app(device = crate::board::pac, peripherals = true, dispatchers = [EXTI0])]
mod app {
    use heapless::spsc::Producer;
    use thermal_display::Station;
    use thermal_display::protocol::Telemetry;
    use thermal_display::sense::Samples;
    use thermal_display::settings::Settings;

    use crate::board::{
        Board, Console, Memory, PowerStage, Receiver, Sampler, Task, Transmitter, Vigil, Watchdog,
    };

    #[shared]
    struct Shared {
        station: Station,
        vigil: Vigil,
        #[lock_free]
        stage: PowerStage,
        #[lock_free]
        sampler: Sampler,
    }

    #[local]
    struct Local {
        telemetry: Producer<'static, Telemetry>,
        receiver: Receiver,
        transmitter: Transmitter,
        console: Console,
        watchdog: Watchdog,
    }

    #[init(local = [memory: Memory = Memory::new()])]
    fn init(cx: init::Context) -> (Shared, Local) {
        let settings = Settings::default();
        // Takes milliseconds, so it comes before the board starts to sample.
        let station = Station::new(&settings);
        let board = Board::new(cx.device, cx.local.memory, settings);
        let shared = Shared {
            station,
            vigil: Vigil::new(),
            stage: board.stage,
            sampler: board.sampler,
        };
        let local = Local {
            telemetry: board.telemetry,
            receiver: board.receiver,
            transmitter: board.transmitter,
            console: board.console,
            watchdog: board.watchdog,
        };
        (shared, local)
    }

    #[idle(shared = [&vigil], local = [watchdog])]
    fn idle(cx: idle::Context) -> ! {
        loop {
            if cx.shared.vigil.all_checked_in() {
                cx.local.watchdog.feed();
            }
            rtic::export::wfi();
        }
    }

    #[task(binds = DMA2_STREAM0, priority = 3, shared = [station, stage, sampler, &vigil], local = [telemetry])]
    fn tick(mut cx: tick::Context) {
        let stage = cx.shared.stage;
        let scans = match cx.shared.sampler.take() {
            Ok(scans) => scans,
            Err(error) => {
                stage.off();
                cx.shared.sampler.stop();
                return defmt::error!("sampling stopped: {}", error);
            }
        };
        let samples = Samples::from_scans(scans, stage.fault());
        let drive = cx.shared.station.lock(|station| station.step(&samples));
        stage.apply(drive);
        if let Some(telemetry) = cx.shared.station.lock(|station| station.telemetry()) {
            // A full queue means that the host link cannot keep up: this line is left out.
            let _ = cx.local.telemetry.enqueue(telemetry);
        }
        cx.shared.vigil.check_in(Task::Tick);
        // Refused while `host` is at work: it then finds what waits by itself, or with the next tick.
        let _ = host::spawn();
    }

    #[task(binds = ADC, priority = 3, shared = [stage, sampler])]
    fn overrun(cx: overrun::Context) {
        cx.shared.stage.off();
        cx.shared.sampler.stop();
        defmt::error!("sampling stopped: converter overrun");
    }

    #[task(binds = USART2, priority = 4, local = [receiver])]
    fn receive(cx: receive::Context) {
        if cx.local.receiver.take() {
            let _ = host::spawn();
        }
    }

    #[task(binds = DMA1_STREAM6, priority = 2, local = [transmitter])]
    fn refill(cx: refill::Context) {
        cx.local.transmitter.refill();
        let _ = host::spawn();
    }

    #[task(priority = 1, shared = [station, &vigil], local = [console])]
    async fn host(mut cx: host::Context) {
        let station = &mut cx.shared.station;
        cx.local
            .console
            .serve(|command| station.lock(|station| station.execute(command)));
        cx.shared.vigil.check_in(Task::Host);
    }
}
