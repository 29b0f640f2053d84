//! The power stage: TIM1 in front of the bridge, the fault line and the lamp.

use stm32f4xx_hal::gpio::{Alternate, Input, Output, PA5, PA6, PA8, PA9, PB10, PC3, Pin};
use stm32f4xx_hal::pac::TIM1;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::timer::{C1, C2, PwmChannel};
use thermal_display::device::drive::{Drive, Outputs};

use thermal_display::bridge::Bridge;

/// PWM frequency in kHz: exactly six periods a scan, so that every conversion sees the same phase of the
/// ripple and no beat reaches the control band; 1875 steps of 5.6 ns.
const PWM_KHZ: u32 = 96;

type Fault = Pin<'A', 6, Alternate<1>>;

/// Bridge, fault line and lamp.
///
/// Off takes effect within the instruction that writes it; a new duty at the next PWM period, since the
/// compare registers are preloaded. If a period ends between the writes of the two registers, it has one
/// old and one new share: for 10 us a voltage between or beside both, which the LC filter does not pass.
pub struct PowerStage {
    bridge: Bridge<PwmChannel<TIM1, C1>, PwmChannel<TIM1, C2>, PB10<Output>>,
    timer: TIM1,
    fault: Fault,
    test: PC3<Output>,
    lamp: PA5<Output>,
    on: bool,
}

impl PowerStage {
    /// Takes the pins of the bridge, which is off.
    pub fn new(
        timer: TIM1,
        (in1, in2): (PA8<Input>, PA9<Input>),
        enable: PB10<Output>,
        fault: PA6<Input>,
        test: PC3<Output>,
        lamp: PA5<Output>,
        rcc: &mut Rcc,
    ) -> Self {
        // Pulled down weakly against the external pull-up: a wire that is off reads as a fault.
        let fault = fault.into_pull_down_input().into_alternate();
        let (_, (in1_channel, in2_channel, ..)) = timer.pwm_hz(PWM_KHZ.kHz(), rcc);
        let mut in1 = in1_channel.with(in1);
        let mut in2 = in2_channel.with(in2);
        // SAFETY: the timer's own handle went into `pwm_hz`. The channels write the compare and enable
        // registers only; break and dead-time register and status register are written here alone.
        let timer = unsafe { TIM1::steal() };
        // The library starts the timer with automatic output enable, which would turn the bridge on again
        // by itself after a fault: manual only. While the outputs are disabled they are driven to
        // their idle level, low. The lock keeps a program gone astray from changing any of it, and
        // the PWM mode, before the next reset (RM0390, 17.4.18).
        timer.bdtr().write(|w| {
            w.bke().enabled();
            w.bkp().active_low();
            w.ossi().idle_level();
            w.aoe().manual();
            w.moe().disabled_idle();
            w.lock().level3()
        });
        // Switching the break on may have set its flag.
        timer.sr().write(|w| w.bif().clear());
        in1.enable();
        in2.enable();
        Self {
            bridge: Bridge::new(in1, in2, enable),
            timer,
            fault,
            test,
            lamp,
            on: false,
        }
    }

    /// Whether the bridge or the comparator pulls the fault line, or has pulled it since the last call:
    /// the break flag keeps a pulse that is shorter than a tick.
    pub fn fault(&mut self) -> bool {
        let pulsed = self.timer.sr().read().bif().bit_is_set();
        if pulsed {
            self.timer.sr().write(|w| w.bif().clear());
        }
        pulsed || self.fault.is_low()
    }

    /// Tells bridge and comparator what to do from now on.
    ///
    /// The outputs are enabled on the way from off to on only. After a break they therefore stay off until
    /// the station has seen the fault and has itself gone through off.
    pub fn apply(&mut self, outputs: &Outputs) {
        self.test.set_state(outputs.comparator_test.into());
        match outputs.drive {
            Drive::Off => self.off(),
            Drive::On(duty) => {
                self.bridge.drive(duty);
                if !self.on {
                    self.timer.bdtr().modify(|_, w| w.moe().enabled());
                    self.lamp.set_high();
                    self.on = true;
                    defmt::info!("bridge on");
                }
            }
        }
    }

    /// Both bridge outputs high-impedance, at once.
    pub fn off(&mut self) {
        self.timer.bdtr().modify(|_, w| w.moe().disabled_idle());
        self.bridge.off();
        if self.on {
            self.lamp.set_low();
            self.on = false;
            defmt::info!("bridge off");
        }
    }
}
