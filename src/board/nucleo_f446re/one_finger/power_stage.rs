//! The power stage: TIM1, which generates the PWM signals of the bridge, the fault line and the
//! LED.

use stm32f4xx_hal::gpio::{Alternate, Input, Output, PA5, PA6, PA8, PA9, PB10, PC3, Pin};
use stm32f4xx_hal::pac::TIM1;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::timer::{C1, C2, PwmChannel};
use thermal_display::device::drive::{BoardOutputs, Drive};

use thermal_display::bridge::Bridge;

/// PWM frequency of the bridge, kHz. Scans are exactly six PWM periods apart, so every conversion
/// samples the PWM ripple at the same phase, and no beat frequency enters the control bandwidth. A
/// period has 1875 steps of 5.6 ns.
const PWM_KHZ: u32 = 96;

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
        let (_, (in1_channel, in2_channel, ..)) = timer.pwm_hz(PWM_KHZ.kHz(), rcc);
        let mut in1 = in1_channel.with(in1);
        let mut in2 = in2_channel.with(in2);
        // SAFETY: `pwm_hz` has consumed the handle of the timer. Its channels write only the
        // compare and enable registers; only this driver writes the break and dead-time register
        // and the status register.
        let timer = unsafe { TIM1::steal() };
        // `pwm_hz` selects automatic output enable, which would turn the bridge on again after a
        // fault; here the output enable is manual. Disabled outputs are driven to their idle level,
        // low. The lock prevents faulty code from changing these settings or the PWM mode before
        // the next reset (RM0390, 17.4.18).
        timer.bdtr().write(|w| {
            w.bke().enabled();
            w.bkp().active_low();
            w.ossi().idle_level();
            w.aoe().manual();
            w.moe().disabled_idle();
            w.lock().level3()
        });
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
    /// comparator cuts the bridge's supply, which the self-test checks.
    ///
    /// The PWM outputs of TIM1 are enabled only when the bridge changes from off to on. A break, by
    /// a low fault line or a failure of the 8 MHz clock, disables the PWM outputs; they stay
    /// disabled until the station has detected the fault and has switched the bridge off itself.
    pub fn apply_drive_and_comparator_test(&mut self, outputs: &BoardOutputs) {
        self.test.set_state(outputs.comparator_test.into());
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
