//! The firmware: which task runs when, at which priority, and what it may touch. Nothing else.
//!
//! | task      | runs when                       | priority | must be done within                   |
//! |-----------|---------------------------------|----------|---------------------------------------|
//! | `receive` | a byte came from the host       | 4        | 20 us: two bytes at 1 Mbaud           |
//! | `tick`    | a finger's scans are in memory  | 3        | 1 ms over the number of fingers       |
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
    use core::sync::atomic::{AtomicBool, Ordering};
    use heapless::spsc::Producer;

    use thermal_display::device::command::Addressed;
    use thermal_display::device::safety::Fault;
    use thermal_display::device::sense::Samples;
    use thermal_display::device::{Device, Telemetry};
    use thermal_display::settings::Settings;
    use thermal_display::task_liveness::{Task, TaskLiveness};

    use crate::board::{
        Board, Console, End, FINGERS, Memory, PowerStage, Receiver, Record, Sampler, Transmitter,
        Trigger, Watchdog, WindowWatchdog, at_start, first_cause, keep_dose, kept_dose,
        stack_is_overrun,
    };

    #[shared]
    struct Shared {
        fingers: &'static mut Device<FINGERS>,
        task_liveness: TaskLiveness,
        /// A line has come since the last tick.
        heard: AtomicBool,
        #[lock_free]
        record: Record,
        #[lock_free]
        stages: [PowerStage; FINGERS],
        #[lock_free]
        sampler: Sampler,
    }

    #[local]
    struct Local {
        telemetry: Producer<'static, Addressed<Telemetry>>,
        receiver: Receiver,
        transmitter: Transmitter,
        console: Console,
        watchdog: Watchdog,
        window_watchdog: WindowWatchdog,
        trigger: Trigger,
        has_clock: bool,
    }

    #[init(local = [memory: Memory = Memory::new(), fingers: Option<Device<FINGERS>> = None])]
    fn init(cx: init::Context) -> (Shared, Local) {
        let cause = first_cause(&cx.device.RCC);
        // Before anything that the flash could delay.
        let found = at_start(&cx.device.FLASH);
        // Takes 0.2 s at 16 MHz, so it comes before the board starts to sample.
        let fingers = cx
            .local
            .fingers
            .insert(Device::after(cause, &Settings::default()));
        match &found.kept {
            Ok(Some(kept)) => fingers.restore(kept),
            Ok(None) => {}
            Err(_) => fingers.trip(Fault::SettingsCorrupt),
        }
        for finger in 0..FINGERS {
            fingers.resume(finger, kept_dose(finger));
        }
        // What the flash says it says again after a reset, unless other settings are stored.
        let record = Record::new(fingers.tripped().copied());
        let board = Board::new(cx.core.SYST, cx.device, cx.local.memory, &found);
        let shared = Shared {
            fingers,
            task_liveness: TaskLiveness::new(),
            heard: AtomicBool::new(false),
            record,
            stages: board.stages,
            sampler: board.sampler,
        };
        let local = Local {
            telemetry: board.telemetry,
            receiver: board.receiver,
            transmitter: board.transmitter,
            console: board.console,
            watchdog: board.watchdog,
            window_watchdog: board.window_watchdog,
            trigger: board.trigger,
            has_clock: board.has_clock,
        };
        (shared, local)
    }

    #[idle(shared = [&task_liveness], local = [watchdog, trigger])]
    fn idle(cx: idle::Context) -> ! {
        // Now that everything is in its place and interrupts are taken.
        cx.local.trigger.start();
        loop {
            if cx.shared.task_liveness.all_checked_in() {
                cx.local.watchdog.feed();
            }
            rtic::export::wfi();
        }
    }

    /// Ticks between two calls of `host` that nothing else asks for: within what the watchdog waits for it.
    const ROLL_CALL_TICKS: u8 = 8;

    #[task(
        binds = DMA2_STREAM0,
        priority = 3,
        shared = [fingers, record, stages, sampler, &task_liveness, &heard],
        local = [telemetry, window_watchdog, has_clock, until_host: u8 = 0],
    )]
    fn tick(mut cx: tick::Context) {
        let (fingers, stages) = (&mut cx.shared.fingers, cx.shared.stages);
        let (finger, scans) = match cx.shared.sampler.take() {
            Ok(block) => block,
            Err(error) => {
                stages.iter_mut().for_each(PowerStage::off);
                cx.shared.sampler.stop();
                fingers.lock(|fingers| {
                    fingers.trip(error.fault());
                    cx.shared.record.follow(fingers.tripped());
                });
                return defmt::error!("sampling stopped: {}", error);
            }
        };
        cx.local.window_watchdog.feed();
        // There is one for each finger.
        let Some(stage) = stages.get_mut(finger) else {
            return;
        };
        let samples = Samples::from_scans(scans, stage.fault());
        let heard = cx.shared.heard.swap(false, Ordering::Relaxed);
        let outputs = fingers.lock(|fingers| {
            if heard {
                fingers.hear();
            }
            if stack_is_overrun() {
                fingers.trip(Fault::Stack);
            }
            if !*cx.local.has_clock {
                fingers.trip(Fault::Clock);
            }
            let outputs = fingers.step(finger, &samples);
            // Five are not asked on every tick of one.
            if cx.shared.record.keeps() || fingers.is_tripped(finger) {
                cx.shared.record.follow(fingers.tripped());
            }
            keep_dose(finger, fingers.dose(finger));
            outputs
        });
        stage.apply(&outputs);
        if let Some(telemetry) = fingers.lock(|fingers| fingers.telemetry(finger)) {
            // A full queue means that the host link cannot keep up: this line is left out.
            let _ = cx.local.telemetry.enqueue(telemetry);
            *cx.local.until_host = 0;
        }
        cx.shared.task_liveness.check_in(Task::Tick);
        // Refused while `host` is at work: it then finds what waits by itself, or is called by the next tick. What the
        // other tasks bring while it ends waits for the roll-call.
        *cx.local.until_host = match *cx.local.until_host {
            0 if host::spawn().is_ok() => ROLL_CALL_TICKS,
            waiting => waiting.saturating_sub(1),
        };
    }

    #[task(binds = ADC, priority = 3, shared = [fingers, record, stages, sampler])]
    fn overrun(mut cx: overrun::Context) {
        cx.shared.stages.iter_mut().for_each(PowerStage::off);
        cx.shared.sampler.stop();
        cx.shared.fingers.lock(|fingers| {
            fingers.trip(Fault::Sampling);
            cx.shared.record.follow(fingers.tripped());
        });
        defmt::error!("sampling stopped: converter overrun");
    }

    #[task(binds = USART2, priority = 4, shared = [&heard], local = [receiver])]
    fn receive(cx: receive::Context) {
        let Some(end) = cx.local.receiver.take() else {
            return;
        };
        cx.shared.heard.store(true, Ordering::Relaxed);
        if end == End::Line {
            let _ = host::spawn();
        }
    }

    #[task(binds = DMA1_STREAM6, priority = 2, local = [transmitter])]
    fn refill(cx: refill::Context) {
        cx.local.transmitter.refill();
        let _ = host::spawn();
    }

    #[task(priority = 1, shared = [fingers, &task_liveness], local = [console])]
    async fn host(mut cx: host::Context) {
        let fingers = &mut cx.shared.fingers;
        cx.local
            .console
            .serve(|request| fingers.lock(|fingers| fingers.execute(request)));
        cx.shared.task_liveness.check_in(Task::Host);
    }
}
