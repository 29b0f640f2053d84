//! The power stages: TIM1, TIM8, TIM10 and TIM11, which generate the PWM signals of five bridges,
//! and the fault lines.

use core::convert::Infallible;

use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use stm32f4xx_hal::gpio::{
    ErasedPin, Input, Output, PA8, PA9, PA10, PA11, PB8, PB9, PC6, PC7, PC8, PC9, Pin,
};
use stm32f4xx_hal::pac::tim1::bdtr::BKP;
use stm32f4xx_hal::pac::{TIM1, TIM8, TIM10, TIM11};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::timer::{ErasedChannel, Timer};
use thermal_display::device::PWM_PERIOD_STEPS_OF_FIVE_FINGERS;
use thermal_display::device::drive::{BoardOutputs, ComparatorTest, Drive};

use super::super::pwm_settings;
use super::FINGERS;
use thermal_display::bridge::Bridge;

/// Polarity of the break inputs, at which they are inactive.
const BREAK_LEVEL: BKP = BKP::ActiveHigh;

/// One finger's bridge, with its fault line and the test line of its comparator.
///
/// Turning the bridge off takes effect at once; a new duty takes effect at the next PWM period,
/// because the compare registers are preloaded.
pub struct FingerPowerStage {
    bridge: Bridge<BridgeInputPwmChannel, BridgeInputPwmChannel, ErasedPin<Output>>,
    fault: ErasedPin<Input>,
    test: ErasedPin<Output>,
    on: bool,
}

/// Timers and pins of all bridges. `first` to `fifth` are the PWM pins IN1 and IN2 of fingers 0 to
/// 4, and `lines` their other pins.
pub struct BridgePeripherals {
    pub timers: (TIM1, TIM8, TIM10, TIM11),
    pub first: (PA8<Input>, PA9<Input>),
    pub second: (PA10<Input>, PA11<Input>),
    pub third: (PC6<Input>, PC7<Input>),
    pub fourth: (PC8<Input>, PC9<Input>),
    pub fifth: (PB8<Input>, PB9<Input>),
    pub lines: [BridgeAndComparatorPins; FINGERS],
}

/// The pins of one finger's bridge and comparator, except for the bridge's PWM inputs: the bridge's
/// enable line, the fault line, which bridge and comparator pull low, and the comparator's test
/// line.
pub struct BridgeAndComparatorPins {
    enable: ErasedPin<Output>,
    fault: ErasedPin<Input>,
    test: ErasedPin<Output>,
}

impl BridgeAndComparatorPins {
    /// Sets up the pins of one finger: enable line of the bridge and test line of the comparator as
    /// outputs, fault line as input.
    pub fn new<
        const ENABLE_PORT: char,
        const ENABLE_PIN: u8,
        const FAULT_LINE_PORT: char,
        const FAULT_LINE_PIN: u8,
        const COMPARATOR_TEST_PORT: char,
        const COMPARATOR_TEST_PIN: u8,
    >(
        enable: Pin<ENABLE_PORT, ENABLE_PIN>,
        fault: Pin<FAULT_LINE_PORT, FAULT_LINE_PIN>,
        test: Pin<COMPARATOR_TEST_PORT, COMPARATOR_TEST_PIN>,
    ) -> Self {
        Self {
            enable: enable.into_push_pull_output().erase(),
            // The weak internal pull-down loses against the external pull-up; a broken wire
            // therefore reads as a fault.
            fault: fault.into_pull_down_input().erase(),
            test: test.into_push_pull_output().erase(),
        }
    }
}

impl BridgePeripherals {
    /// Sets up the timers for PWM and returns the power stages of all fingers, in the order of the
    /// fingers, with all bridges off.
    pub fn into_power_stages(self, rcc: &mut Rcc) -> [FingerPowerStage; FINGERS] {
        let (tim1, tim8, tim10, tim11) = self.timers;
        let frequency = pwm_settings::frequency_of_period(PWM_PERIOD_STEPS_OF_FIVE_FINGERS);
        let (first_timer, second_timer) = (Timer::new(tim1, rcc), Timer::new(tim8, rcc));
        // SAFETY: the channels of `pwm_hz` write only the compare and enable registers; the break
        // and dead-time registers are written here, below and by `disable_bridges` only.
        let (tim1, tim8) = unsafe { (TIM1::steal(), TIM8::steal()) };
        // A failure of the 8 MHz clock acts as a break, which disables the PWM outputs without any
        // code (RM0390, 17.3.12). No pin is connected to the break inputs.
        for timer in [&*tim1, &*tim8] {
            pwm_settings::set_and_lock(timer, BREAK_LEVEL);
        }
        let (_, (a0, b0, a1, b1)) = first_timer.pwm_hz(frequency);
        let (_, (a2, b2, a3, b3)) = second_timer.pwm_hz(frequency);
        let (_, (a4, ..)) = tim10.pwm_hz(frequency, rcc);
        let (_, (b4, ..)) = tim11.pwm_hz(frequency, rcc);
        let (first, second, third, fourth, fifth) =
            (self.first, self.second, self.third, self.fourth, self.fifth);
        let [first_lines, second_lines, third_lines, fourth_lines, fifth_lines] = self.lines;
        let stages = [
            FingerPowerStage::new(
                BridgeInputPwmChannel::Tim1(a0.with(first.0).erase()),
                BridgeInputPwmChannel::Tim1(b0.with(first.1).erase()),
                first_lines,
            ),
            FingerPowerStage::new(
                BridgeInputPwmChannel::Tim1(a1.with(second.0).erase()),
                BridgeInputPwmChannel::Tim1(b1.with(second.1).erase()),
                second_lines,
            ),
            FingerPowerStage::new(
                BridgeInputPwmChannel::Tim8(a2.with(third.0).erase()),
                BridgeInputPwmChannel::Tim8(b2.with(third.1).erase()),
                third_lines,
            ),
            FingerPowerStage::new(
                BridgeInputPwmChannel::Tim8(a3.with(fourth.0).erase()),
                BridgeInputPwmChannel::Tim8(b3.with(fourth.1).erase()),
                fourth_lines,
            ),
            FingerPowerStage::new(
                BridgeInputPwmChannel::Tim10(a4.with(fifth.0).erase()),
                BridgeInputPwmChannel::Tim11(b4.with(fifth.1).erase()),
                fifth_lines,
            ),
        ];
        for timer in [&*tim1, &*tim8] {
            timer.bdtr().modify(|_, w| w.moe().enabled());
        }
        stages
    }
}

impl FingerPowerStage {
    fn new(
        mut in1: BridgeInputPwmChannel,
        mut in2: BridgeInputPwmChannel,
        BridgeAndComparatorPins { enable, fault, test }: BridgeAndComparatorPins,
    ) -> Self {
        in1.enable();
        in2.enable();
        Self { bridge: Bridge::new(in1, in2, enable), fault, test, on: false }
    }

    /// Whether TIM1 and TIM8 still have the locked settings that switch their outputs off when the
    /// clock fails. TIM10 and TIM11 have no such settings: what switches the fifth bridge off is its
    /// enable line.
    pub fn pwm_settings_are_locked() -> bool {
        // SAFETY: loads without side effects.
        let (tim1, tim8) = unsafe { (&*TIM1::ptr(), &*TIM8::ptr()) };
        pwm_settings::are_set_and_locked(tim1, BREAK_LEVEL)
            & pwm_settings::are_set_and_locked(tim8, BREAK_LEVEL)
    }

    /// Level of the lock of the settings of TIM1 and TIM8, 0 (off) to 3: the lower one.
    pub fn pwm_lock_level() -> u8 {
        // SAFETY: loads without side effects.
        let (tim1, tim8) = unsafe { (&*TIM1::ptr(), &*TIM8::ptr()) };
        pwm_settings::lock_level(tim1).min(pwm_settings::lock_level(tim8))
    }

    /// Whether the fault line is low at this moment: the bridge or the comparator reports a fault,
    /// or the line is broken.
    pub fn poll_fault_line_low(&mut self) -> bool {
        self.fault.is_low()
    }

    /// Applies the outputs of a control tick: turns the bridge off or drives it with the demanded
    /// duty, and sets the level of the comparator's test line. While that line is high, the
    /// comparator's input is at a level outside of its window, so it cuts the bridge's supply, which
    /// the self-test checks.
    pub fn apply_drive_and_comparator_test(&mut self, outputs: &BoardOutputs) {
        self.test.set_state((outputs.comparator_test != ComparatorTest::None).into());
        match outputs.drive {
            Drive::Off => self.off(),
            Drive::On(duty) => {
                self.bridge.drive(duty);
                if !self.on {
                    self.on = true;
                    defmt::info!("bridge on");
                }
            }
        }
    }

    /// Makes both outputs of the bridge high-impedance at once, without waiting for the next PWM
    /// period.
    pub fn off(&mut self) {
        self.bridge.make_outputs_high_impedance();
        if self.on {
            self.on = false;
            defmt::info!("bridge off");
        }
    }
}

/// The PWM channel of one input of a bridge, IN1 or IN2. It may belong to any of the four timers.
enum BridgeInputPwmChannel {
    Tim1(ErasedChannel<TIM1>),
    Tim8(ErasedChannel<TIM8>),
    Tim10(ErasedChannel<TIM10>),
    Tim11(ErasedChannel<TIM11>),
}

impl BridgeInputPwmChannel {
    fn enable(&mut self) {
        match self {
            Self::Tim1(channel) => channel.enable(),
            Self::Tim8(channel) => channel.enable(),
            Self::Tim10(channel) => channel.enable(),
            Self::Tim11(channel) => channel.enable(),
        }
    }
}

impl ErrorType for BridgeInputPwmChannel {
    type Error = Infallible;
}

impl SetDutyCycle for BridgeInputPwmChannel {
    fn max_duty_cycle(&self) -> u16 {
        match self {
            Self::Tim1(channel) => channel.max_duty_cycle(),
            Self::Tim8(channel) => channel.max_duty_cycle(),
            Self::Tim10(channel) => channel.max_duty_cycle(),
            Self::Tim11(channel) => channel.max_duty_cycle(),
        }
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        match self {
            Self::Tim1(channel) => channel.set_duty_cycle(duty),
            Self::Tim8(channel) => channel.set_duty_cycle(duty),
            Self::Tim10(channel) => channel.set_duty_cycle(duty),
            Self::Tim11(channel) => channel.set_duty_cycle(duty),
        }
    }
}
