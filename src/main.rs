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

    use thermal_display::Hand;
    use thermal_display::guard::Fault;
    use thermal_display::protocol::{Addressed, Telemetry};
    use thermal_display::sense::Samples;
    use thermal_display::settings::Settings;

    use crate::board::{
        Board, Console, End, FINGERS, Memory, PowerStage, Receiver, Record, Sampler, Task,
        Transmitter, Trigger, Vigil, Watchdog, WindowWatchdog, at_start, first_cause, keep_dose,
        kept_dose, stack_is_overrun,
    };

    #[shared]
    struct Shared {
        hand: &'static mut Hand<FINGERS>,
        vigil: Vigil,
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

    #[init(local = [memory: Memory = Memory::new(), hand: Option<Hand<FINGERS>> = None])]
    fn init(cx: init::Context) -> (Shared, Local) {
        let cause = first_cause(&cx.device.RCC);
        // Before anything that the flash could delay.
        let found = at_start(&cx.device.FLASH);
        // Takes 0.2 s at 16 MHz, so it comes before the board starts to sample.
        let hand = cx
            .local
            .hand
            .insert(Hand::after(cause, &Settings::default()));
        match &found.kept {
            Ok(Some(kept)) => hand.restore(kept),
            Ok(None) => {}
            Err(_) => hand.trip(Fault::SettingsCorrupt),
        }
        for finger in 0..FINGERS {
            hand.resume(finger, kept_dose(finger));
        }
        // What the flash says it says again after a reset, unless other settings are stored.
        let record = Record::new(hand.tripped().copied());
        let board = Board::new(cx.core.SYST, cx.device, cx.local.memory, &found);
        let shared = Shared {
            hand,
            vigil: Vigil::new(),
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

    #[idle(shared = [&vigil], local = [watchdog, trigger])]
    fn idle(cx: idle::Context) -> ! {
        // Now that everything is in its place and interrupts are taken.
        cx.local.trigger.start();
        loop {
            if cx.shared.vigil.all_checked_in() {
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
        shared = [hand, record, stages, sampler, &vigil, &heard],
        local = [telemetry, window_watchdog, has_clock, until_host: u8 = 0],
    )]
    fn tick(mut cx: tick::Context) {
        let (hand, stages) = (&mut cx.shared.hand, cx.shared.stages);
        let (finger, scans) = match cx.shared.sampler.take() {
            Ok(block) => block,
            Err(error) => {
                stages.iter_mut().for_each(PowerStage::off);
                cx.shared.sampler.stop();
                hand.lock(|hand| {
                    hand.trip(error.fault());
                    cx.shared.record.follow(hand.tripped());
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
        let outputs = hand.lock(|hand| {
            if heard {
                hand.hear();
            }
            if stack_is_overrun() {
                hand.trip(Fault::Stack);
            }
            if !*cx.local.has_clock {
                hand.trip(Fault::Clock);
            }
            let outputs = hand.step(finger, &samples);
            // Five are not asked on every tick of one.
            if cx.shared.record.keeps() || hand.is_tripped(finger) {
                cx.shared.record.follow(hand.tripped());
            }
            keep_dose(finger, hand.dose(finger));
            outputs
        });
        stage.apply(&outputs);
        if let Some(telemetry) = hand.lock(|hand| hand.telemetry(finger)) {
            // A full queue means that the host link cannot keep up: this line is left out.
            let _ = cx.local.telemetry.enqueue(telemetry);
            *cx.local.until_host = 0;
        }
        cx.shared.vigil.check_in(Task::Tick);
        // Refused while `host` is at work: it then finds what waits by itself, or is called by the next tick. What the
        // other tasks bring while it ends waits for the roll-call.
        *cx.local.until_host = match *cx.local.until_host {
            0 if host::spawn().is_ok() => ROLL_CALL_TICKS,
            waiting => waiting.saturating_sub(1),
        };
    }

    #[task(binds = ADC, priority = 3, shared = [hand, record, stages, sampler])]
    fn overrun(mut cx: overrun::Context) {
        cx.shared.stages.iter_mut().for_each(PowerStage::off);
        cx.shared.sampler.stop();
        cx.shared.hand.lock(|hand| {
            hand.trip(Fault::Sampling);
            cx.shared.record.follow(hand.tripped());
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

    #[task(priority = 1, shared = [hand, &vigil], local = [console])]
    async fn host(mut cx: host::Context) {
        let hand = &mut cx.shared.hand;
        cx.local
            .console
            .serve(|request| hand.lock(|hand| hand.execute(request)));
        cx.shared.vigil.check_in(Task::Host);
    }
}
