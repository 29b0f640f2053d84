//! The power stage: TIM1, which generates the PWM signals of the bridge, the fault line and the
//! LED.

use stm32f4xx_hal::gpio::{Alternate, Input, Output, PA5, PA6, PA8, PA9, PB10, PC3, Pin};
use stm32f4xx_hal::pac::TIM1;
use stm32f4xx_hal::pac::tim1::bdtr::BKP;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::timer::{C1, C2, PwmChannel, Timer};
use thermal_display::device::PWM_PERIOD_STEPS_OF_ONE_FINGER;
use thermal_display::device::drive::{BoardOutputs, ComparatorTest, Drive};

use thermal_display::bridge::Bridge;

use super::super::pwm_settings;

/// Level of the fault line that stops the PWM.
const BREAK_LEVEL: BKP = BKP::ActiveLow;

type FaultLinePin = Pin<'A', 6, Alternate<1>>;

/// The bridge of the finger, with its fault line, the test line of its comparator, and the LED that
/// is lit while the bridge may drive.
///
/// Turning the bridge off takes effect at once; a new duty takes effect at the next PWM period,
/// because the compare registers are preloaded. If a PWM period ends between the writes to the
/// compare registers of IN1 and IN2, the next period combines an old and a new value. The bridge's
/// voltage is then wrong for one period of 10 us, which the LC filter suppresses.
pub struct FingerPowerStage {
    bridge: Bridge<PwmChannel<TIM1, C1>, PwmChannel<TIM1, C2>, PB10<Output>>,
    timer: TIM1,
    fault: FaultLinePin,
    test: PC3<Output>,
    led: PA5<Output>,
    on: bool,
}

impl FingerPowerStage {
    /// Sets up TIM1, for PWM with the fault line as its break input, and the pins, with the bridge
    /// off.
    pub fn new(
        timer: TIM1,
        (in1, in2): (PA8<Input>, PA9<Input>),
        enable: PB10<Input>,
        fault: PA6<Input>,
        test: PC3<Input>,
        led: PA5<Input>,
        rcc: &mut Rcc,
    ) -> Self {
        // The weak internal pull-down loses against the external pull-up; a broken wire therefore
        // reads as a fault.
        let fault = fault.into_pull_down_input().into_alternate();
        let running = Timer::new(timer, rcc);
        // SAFETY: the channels of `pwm_hz` write only the compare and enable registers; only this
        // driver writes the break and dead-time register and the status register.
        let timer = unsafe { TIM1::steal() };
        pwm_settings::set_and_lock(&timer, BREAK_LEVEL);
        let frequency = pwm_settings::frequency_of_period(PWM_PERIOD_STEPS_OF_ONE_FINGER);
        let (_, (in1_channel, in2_channel, ..)) = running.pwm_hz(frequency);
        let mut in1 = in1_channel.with(in1);
        let mut in2 = in2_channel.with(in2);
        // Enabling the break input may have set its flag.
        timer.sr().write(|w| w.bif().clear());
        in1.enable();
        in2.enable();
        Self {
            bridge: Bridge::new(in1, in2, enable.into_push_pull_output()),
            timer,
            fault,
            test: test.into_push_pull_output(),
            led: led.into_push_pull_output(),
            on: false,
        }
    }

    /// Whether the PWM timer still has the locked settings that switch its outputs off after a fault.
    pub fn pwm_settings_are_locked() -> bool {
        // SAFETY: a load without side effects.
        pwm_settings::are_set_and_locked(unsafe { &*TIM1::ptr() }, BREAK_LEVEL)
    }

    /// Level of the lock of the PWM timer's settings, 0 (off) to 3.
    pub fn pwm_lock_level() -> u8 {
        // SAFETY: a load without side effects.
        pwm_settings::lock_level(unsafe { &*TIM1::ptr() })
    }

    /// Whether the fault line is low, or was low for a moment since the last call: the bridge or
    /// the comparator reports a fault, or the line is broken. The break flag of TIM1 stores pulses
    /// that are shorter than a tick.
    pub fn poll_fault_line_low(&mut self) -> bool {
        let pulsed = self.timer.sr().read().bif().bit_is_set();
        if pulsed {
            self.timer.sr().write(|w| w.bif().clear());
        }
        pulsed || self.fault.is_low()
    }

    /// Applies the outputs of a control tick: turns the bridge off or drives it with the demanded
    /// duty, and sets the level of the comparator's test line. While that line is high, the
    /// comparator's input is at a level outside of its window, so it cuts the bridge's supply, which
    /// the self-test checks.
    ///
    /// The PWM outputs of TIM1 are enabled only when the bridge changes from off to on. A break, by
    /// a low fault line or a failure of the 8 MHz clock, disables the PWM outputs; they stay
    /// disabled until the station has detected the fault and has switched the bridge off itself.
    pub fn apply_drive_and_comparator_test(&mut self, outputs: &BoardOutputs) {
        self.test.set_state((outputs.comparator_test != ComparatorTest::None).into());
        match outputs.drive {
            Drive::Off => self.off(),
            Drive::On(duty) => {
                self.bridge.drive(duty);
                if !self.on {
                    self.timer.bdtr().modify(|_, w| w.moe().enabled());
                    self.led.set_high();
                    self.on = true;
                    defmt::info!("bridge on");
                }
            }
        }
    }

    /// Makes both outputs of the bridge high-impedance at once, without waiting for the next PWM
    /// period, and switches the LED off.
    pub fn off(&mut self) {
        self.timer.bdtr().modify(|_, w| w.moe().disabled_idle());
        self.bridge.make_outputs_high_impedance();
        if self.on {
            self.led.set_low();
            self.on = false;
            defmt::info!("bridge off");
        }
    }
}
