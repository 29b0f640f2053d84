//! The firmware's tasks: when each runs, at which priority, and which data it may use.
//!
//! | task          | runs when                             | priority | must end within                       |
//! |---------------|---------------------------------------|----------|---------------------------------------|
//! | `receive`     | a byte has come from the host         | 4        | 20 us: two bytes at 1 Mbaud           |
//! | `tick`        | the samples of a finger are in memory | 3        | 1 ms divided by the number of fingers |
//! | `adc_overrun` | the converter has lost a conversion   | 3        | no limit: sampling has stopped        |
//! | `transmit`    | a line has been sent                  | 2        | 20 us, or the line to the host pauses |
//! | `learn`       | ten ticks have measured the heat flux | 2        | 9 ms: the tick that needs its answer  |
//! | `host`        | a line or telemetry waits             | 1        | 68 ms: the shortest watchdog period   |
//! | `idle`        | nothing else runs                     | 0        | 68 ms: the shortest watchdog period   |
//!
//! Priorities are rate-monotonic. `receive` has the highest one because a byte is lost if it is not
//! fetched before the next but one arrives. Nothing is lost when a tick starts some microseconds
//! late: a timer starts the conversions, and a new duty takes effect at the next PWM period. At
//! 1 Mbaud `receive` runs at most 100 000 times a second and only briefly, so it cannot starve the
//! tick. `tick` may delay `transmit`; the line to the host then pauses for as long as that tick
//! runs.
//!
//! Each interrupt handler ends with a DSB, which waits for its stores to the peripherals: the core may run the wrong handler next
//! if a store is under way at the return (Arm's errata notice of the Cortex-M4, 838869), and a handler would run twice if its
//! request were still set. The tasks `learn` and `host` need none, because their dispatchers go on for longer than a store
//! takes. The emulator checks all of them in a scene with `strict = true`.
#![no_std]
#![no_main]

mod board;

#[rtic::app(device = crate::board::pac, peripherals = true, dispatchers = [EXTI0, EXTI1])]
mod app {
    use core::mem::MaybeUninit;
    use core::sync::atomic::{AtomicBool, Ordering};

    use cortex_m::asm::dsb;
    use thermal_display::device::{DeviceInPlace, FingerIndex, Station, execute_in_turn};
    use thermal_display::learner::Learner;
    use thermal_display::task_liveness::{HostTaskTimer, Task, TaskLiveness};

    use crate::board::{
        BlankOrToBeAnsweredLine, Board, Console, ControlLoop, FINGERS, IndependentWatchdog,
        Receiver, SampleError, SampleTrigger, StaticMemory, Transmitter,
    };

    #[shared]
    struct Shared {
        device: DeviceInPlace<FINGERS>,
        #[lock_free]
        control_loop: ControlLoop,
        task_liveness: TaskLiveness,
        /// Set when the host has sent a line, even a blank one. The next control tick clears it and
        /// restarts the 2 s after which a silent host trips a finger whose display follows a
        /// set-point while its telemetry streams.
        host_is_active: AtomicBool,
    }

    #[local]
    struct Local {
        receiver: Receiver,
        transmitter: Transmitter,
        console: Console,
        watchdog: IndependentWatchdog,
        trigger: SampleTrigger,
    }

    // `stations` is a variable of its own, not a field of `memory`: the compiler then treats its
    // address as a constant, which saves 200 instructions a tick.
    #[init(local = [
        memory: StaticMemory = StaticMemory::new(),
        stations: MaybeUninit<[Station; FINGERS]> = MaybeUninit::uninit()
    ])]
    fn init(cx: init::Context) -> (Shared, Local) {
        let board = Board::set_up(cx.core.SYST, cx.device, cx.local.memory, cx.local.stations);
        let shared = Shared {
            device: board.device,
            control_loop: board.control_loop,
            task_liveness: TaskLiveness::new(),
            host_is_active: AtomicBool::new(false),
        };
        let local = Local {
            receiver: board.receiver,
            transmitter: board.transmitter,
            console: board.console,
            watchdog: board.watchdog,
            trigger: board.trigger,
        };
        (shared, local)
    }

    #[idle(shared = [&task_liveness], local = [watchdog, trigger])]
    fn idle(cx: idle::Context) -> ! {
        // Sampling starts here and not in `init`, during which interrupts are disabled.
        cx.local.trigger.start();
        loop {
            if cx.shared.task_liveness.clear_if_all_checked_in() {
                cx.local.watchdog.feed();
            }
            cortex_m::asm::wfi();
        }
    }

    #[task(
        binds = DMA2_STREAM0,
        priority = 3,
        shared = [device, control_loop, &task_liveness, &host_is_active],
        local = [host_task_timer: HostTaskTimer = HostTaskTimer::new_due_at_first_tick()],
    )]
    fn tick(mut cx: tick::Context) {
        let (control_loop, host_is_active) = (cx.shared.control_loop, cx.shared.host_is_active);
        let done = (cx.shared.device).lock(|device| {
            // `spawn` fails while `learn` still runs; it then takes this input when it is called next, which is too late.
            let start_learner = || {
                let _ = learn::spawn();
            };
            control_loop.run_finger_tick(device, host_is_active, start_learner)
        });
        // After an error sampling has stopped; the watchdogs reset the device, because no task checks in any more.
        if let Ok(telemetry_is_due) = done {
            cx.shared.task_liveness.check_in(Task::Tick);
            // `spawn` fails while `host` still runs; `host` is then called at the next tick.
            if cx.local.host_task_timer.count_tick_and_check_due_or_telemetry(telemetry_is_due)
                && host::spawn().is_ok()
            {
                cx.local.host_task_timer.restart();
            }
        }
        dsb();
    }

    #[task(binds = ADC, priority = 3, shared = [device, control_loop])]
    fn adc_overrun(mut cx: adc_overrun::Context) {
        let control_loop = cx.shared.control_loop;
        (cx.shared.device)
            .lock(|device| control_loop.stop_and_trip_all(device, SampleError::Overrun));
        dsb();
    }

    #[task(binds = USART2, priority = 4, shared = [&host_is_active], local = [receiver])]
    fn receive(cx: receive::Context) {
        if let Some(completed) = cx.local.receiver.receive_byte_and_queue_line() {
            cx.shared.host_is_active.store(true, Ordering::Relaxed);
            if completed == BlankOrToBeAnsweredLine::ToBeAnswered {
                let _ = host::spawn();
            }
        }
        dsb();
    }

    #[task(binds = DMA1_STREAM6, priority = 2, local = [transmitter])]
    fn transmit(cx: transmit::Context) {
        cx.local.transmitter.send_next();
        let _ = host::spawn();
        dsb();
    }

    #[task(priority = 2, shared = [device], local = [learner: Learner = Learner::new()])]
    async fn learn(mut cx: learn::Context) {
        const FINGER: FingerIndex<FINGERS> = FingerIndex::FIRST;
        let device = &mut cx.shared.device;
        // Not locked while the learner computes, which takes longer than a tick may be delayed.
        let Some(input) = device.lock(|device| device.take_learner_input(FINGER)) else {
            return;
        };
        let output = cx.local.learner.advance(&input);
        device.lock(|device| device.put_learner_output(FINGER, output));
    }

    #[task(priority = 1, shared = [device, &task_liveness], local = [console])]
    async fn host(mut cx: host::Context) {
        let device = &mut cx.shared.device;
        cx.local.console.answer_lines_and_send_telemetry(|finger, command| {
            // Locked for one finger at a time, so that the next tick begins in time.
            execute_in_turn(finger, |one| {
                device.lock(|device| device.execute_on_finger(one, &command))
            })
        });
        cx.shared.task_liveness.check_in(Task::Host);
    }
}
