//! What a control tick costs on the chip, how regularly ticks come, and for how long a line of the host delays one.

#[embedded_test::tests]
mod tests {
    use thermal_display::device::StateName;

    use crate::cycles::Costs;
    use crate::report;
    use crate::running_board::{run_tick, set_up};
    use crate::toy_display::{ToyDisplay, send};

    const CYCLES_PER_MS: u32 = 180_000;

    /// The whole tick with conversions, DMA and outputs. Nothing is connected, so the device is tripped or off.
    #[test]
    fn samples_come_every_millisecond_and_a_tick_takes_them_in_time() {
        /// Polling finds a tick some cycles late.
        const JITTER_MAX: u32 = 200;
        const TICKS: u32 = 500;
        let mut board = set_up();
        // Otherwise every tick would trip the device by `watchdogs-frozen`.
        report::let_watchdogs_run_while_halted();
        board.trigger.start();
        let (first, _) = run_tick(&mut board).expect("valid samples");
        let (mut costs, mut last, mut jitter) = (Costs::default(), first, 0);
        for _ in 0..TICKS {
            let (begun, cost) = run_tick(&mut board).expect("valid samples");
            jitter = jitter.max(begun.wrapping_sub(last).abs_diff(CYCLES_PER_MS));
            (last, _) = (begun, costs.add(cost));
        }
        board.control_loop.sampler.stop();
        report::figure("board_tick_mean", costs.mean(), "cycles");
        report::figure("board_tick_max", costs.max, "cycles");
        report::figure("tick_jitter_max", jitter, "cycles");
        assert!(jitter <= JITTER_MAX, "{jitter}");
        assert!(last.wrapping_sub(first).abs_diff(TICKS * CYCLES_PER_MS) <= JITTER_MAX);
        assert!(costs.max < CYCLES_PER_MS / 2);
    }

    /// From samples to outputs, on a computed display: a finger lands on "granite" with 2 N.
    #[test]
    fn a_tick_under_a_finger_ends_in_a_tenth_of_its_period() {
        const TICKS_MAX: u32 = 3000;
        let mut board = set_up();
        let mut display = ToyDisplay::new();
        for line in ["stream 1", "material granite", "arm"] {
            send(&mut board, line);
        }
        display.step_until(&mut board, StateName::Armed);
        send(&mut board, "start");
        display.step_until(&mut board, StateName::Preset);
        display.force_n = 2.0;
        display.step_until(&mut board, StateName::Contact);
        let mut costs = Costs::default();
        for _ in 0..TICKS_MAX {
            let (telemetry, cost) = display.step(&mut board);
            assert_eq!(telemetry.state.name(), StateName::Contact.name());
            costs.add(cost);
        }
        report::figure("tick_mean", costs.mean(), "cycles");
        report::figure("tick_max", costs.max, "cycles");
        assert!(costs.max < CYCLES_PER_MS / 10);
    }

    /// While a command is executed, no tick may begin: on a device for five fingers a tick may begin at most 11 us late.
    #[test]
    fn no_command_locks_the_device_for_more_than_11_us() {
        const LOCK_MAX_CYCLES: u32 = 11 * 180;
        let mut board = set_up();
        let mut longest = ("", 0);
        let lines = [
            "stream 1",
            "law pi",
            "law model",
            "finger mean",
            "material granite",
            "material custom 0.17 700 2000 5.0 0.12",
            "object slab 3mm insulated",
            "object half-space",
            "raw",
            "state",
            "self-test",
            "set tile 2.7 0.1 0.05 0.1 0.01",
            "set correction display 0.1 0.001 0.0001",
        ];
        for line in lines {
            let cycles = send(&mut board, line);
            if cycles > longest.1 {
                longest = (line, cycles);
            }
        }
        report::figure("lock_max", longest.1, "cycles");
        report::line(format_args!("longest lock: `{}`", longest.0));
        assert!(longest.1 <= LOCK_MAX_CYCLES, "{longest:?}");
    }
}
