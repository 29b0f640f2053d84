//! PWM outputs and break input of the power stage, seen by the chip's own pins. Nothing may be connected to them.

#[embedded_test::tests]
mod tests {
    use fixed::types::I1F15;
    use stm32f4xx_hal::pac::{GPIOA, TIM1};
    use thermal_display::device::drive::{BoardOutputs, ComparatorTest, Drive, Duty};

    use crate::board::{Board, FingerPowerStage};
    use crate::running_board::{feed, set_up};
    use crate::{cycles, report};

    /// Pins of port A: the inputs of the bridge, and its fault line.
    const IN1: u32 = 1 << 8;
    const IN2: u32 = 1 << 9;
    const FAULT_LINE: usize = 6;

    fn pins() -> GPIOA {
        // SAFETY: only levels are read, and a pull that only these tests change.
        unsafe { GPIOA::steal() }
    }

    fn timer() -> TIM1 {
        // SAFETY: the tests read, or write what the lock must refuse.
        unsafe { TIM1::steal() }
    }

    /// The pull of the fault line replaces the driver's pull-up of the circuit: low is a fault.
    fn pull_fault_line(up: bool) {
        pins().pupdr().modify(|_, w| match up {
            true => w.pupdr(FAULT_LINE as u8).pull_up(),
            false => w.pupdr(FAULT_LINE as u8).pull_down(),
        });
        cortex_m::asm::delay(20 * 180);
    }

    fn drive(board: &mut Board, drive: Drive) {
        let [stage] = &mut board.control_loop.stages;
        stage.apply_drive_and_comparator_test(&BoardOutputs {
            drive,
            comparator_test: ComparatorTest::None,
            trigger_output: false,
        });
    }

    /// Shares of the time in which IN1 and IN2 are high.
    fn high_shares(board: &mut Board) -> [f32; 2] {
        const READS: u32 = 100_000;
        feed(board);
        let pins = pins();
        let mut high = [0u32; 2];
        for _ in 0..READS {
            let levels = pins.idr().read().bits();
            high[0] += u32::from(levels & IN1 != 0);
            high[1] += u32::from(levels & IN2 != 0);
        }
        high.map(|reads| reads as f32 / READS as f32)
    }

    #[test]
    fn both_outputs_have_the_demanded_duty_at_their_pins() {
        let mut board = set_up();
        pull_fault_line(true);
        let mut worst = 0f32;
        for fraction in ["0.5", "-0.25", "0.9", "0"] {
            let fraction: I1F15 = fraction.parse().expect("a number");
            drive(&mut board, Drive::On(Duty::saturating(fraction)));
            // The duty takes effect at the next period.
            cortex_m::asm::delay(2 * 1856);
            let duty: f32 = fraction.to_num();
            let expected = [1.0 + duty.min(0.0), 1.0 - duty.max(0.0)];
            for (high, expected) in high_shares(&mut board).into_iter().zip(expected) {
                worst = worst.max((high - expected).abs());
            }
        }
        report::figure("pwm_duty_error_max", format_args!("{:.2}", 100.0 * worst), "%");
        assert!(worst < 0.01, "{worst}");
        drive(&mut board, Drive::Off);
        assert_eq!(high_shares(&mut board), [0.0; 2], "off");
    }

    #[test]
    fn a_low_fault_line_stops_the_pwm_without_the_program() {
        let mut board = set_up();
        let pull = pins().pupdr().read().pupdr6();
        assert!(pull.is_pull_down(), "a broken wire is a fault");
        pull_fault_line(true);
        board.control_loop.stages[0].poll_fault_line_low();
        drive(&mut board, Drive::On(Duty::saturating(I1F15::lit("0.5"))));
        assert!(timer().bdtr().read().moe().bit_is_set(), "PWM is on");
        pins().pupdr().modify(|_, w| w.pupdr(FAULT_LINE as u8).pull_down());
        let ((), waited) = cycles::measure(|| while timer().bdtr().read().moe().bit_is_set() {});
        report::figure("break_delay", waited, "cycles");
        assert_eq!(high_shares(&mut board), [0.0; 2], "idle level");
        assert!(board.control_loop.stages[0].poll_fault_line_low(), "and the firmware sees it");
        pull_fault_line(true);
        assert!(timer().bdtr().read().moe().bit_is_clear(), "it stays off");
        // The pull of 40 kOhm discharges a pin within some microseconds.
        assert!(waited < 20 * 180, "{waited} cycles");
    }

    #[test]
    fn the_lock_keeps_break_and_pwm_mode() {
        let _board = set_up();
        assert!(FingerPowerStage::pwm_settings_are_locked());
        let mode = timer().ccmr1_output().read().bits();
        timer().bdtr().modify(|_, w| {
            w.bke().disabled();
            w.lock().off()
        });
        timer().ccmr1_output().modify(|_, w| w.oc1m().force_active());
        assert!(FingerPowerStage::pwm_settings_are_locked());
        assert_eq!(timer().ccmr1_output().read().bits(), mode);
    }
}
