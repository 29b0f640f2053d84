//! The power stages: TIM1, TIM8, TIM10 and TIM11 in front of five bridges, and their fault lines.

use core::convert::Infallible;

use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use stm32f4xx_hal::gpio::{
    ErasedPin, Input, Output, PA8, PA9, PA10, PA11, PB8, PB9, PC6, PC7, PC8, PC9,
};
use stm32f4xx_hal::pac::{TIM1, TIM8, TIM10, TIM11};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::timer::ErasedChannel;
use thermal_display::device::drive::{Drive, Outputs};

use super::FINGERS;
use thermal_display::bridge::Bridge;

/// PWM frequency in kHz, as for one finger: the filters and what dead time takes are made for it. 1875 steps.
const PWM_KHZ: u32 = 96;

/// One bridge and its fault line.
///
/// Off takes effect within the instruction that writes the enable line; a new duty at the next PWM period, since the
/// compare registers are preloaded.
pub struct PowerStage {
    bridge: Bridge<Leg, Leg, ErasedPin<Output>>,
    fault: ErasedPin<Input>,
    test: ErasedPin<Output>,
    on: bool,
}

/// Everything that the bridges hang on, in the order of the fingers.
pub struct Wires {
    pub timers: (TIM1, TIM8, TIM10, TIM11),
    pub first: (PA8<Input>, PA9<Input>),
    pub second: (PA10<Input>, PA11<Input>),
    pub third: (PC6<Input>, PC7<Input>),
    pub fourth: (PC8<Input>, PC9<Input>),
    pub fifth: (PB8<Input>, PB9<Input>),
    pub lines: [Lines; FINGERS],
}

/// What goes between processor and one bridge beside its legs.
pub struct Lines {
    /// Low: both legs are high-impedance.
    pub enable: ErasedPin<Output>,
    /// Pulled down weakly against the external pull-up: a wire that is off reads as a fault.
    pub fault: ErasedPin<Input>,
    /// Test of the comparator.
    pub test: ErasedPin<Output>,
}

impl Wires {
    /// Sets the bridges up; they are off.
    pub fn into_stages(self, rcc: &mut Rcc) -> [PowerStage; FINGERS] {
        let (tim1, tim8, tim10, tim11) = self.timers;
        let (_, (a0, b0, a1, b1)) = tim1.pwm_hz(PWM_KHZ.kHz(), rcc);
        let (_, (a2, b2, a3, b3)) = tim8.pwm_hz(PWM_KHZ.kHz(), rcc);
        let (_, (a4, ..)) = tim10.pwm_hz(PWM_KHZ.kHz(), rcc);
        let (_, (b4, ..)) = tim11.pwm_hz(PWM_KHZ.kHz(), rcc);
        let (first, second, third, fourth, fifth) =
            (self.first, self.second, self.third, self.fourth, self.fifth);
        let [
            first_lines,
            second_lines,
            third_lines,
            fourth_lines,
            fifth_lines,
        ] = self.lines;
        let stages = [
            PowerStage::new(
                Leg::Tim1(a0.with(first.0).erase()),
                Leg::Tim1(b0.with(first.1).erase()),
                first_lines,
            ),
            PowerStage::new(
                Leg::Tim1(a1.with(second.0).erase()),
                Leg::Tim1(b1.with(second.1).erase()),
                second_lines,
            ),
            PowerStage::new(
                Leg::Tim8(a2.with(third.0).erase()),
                Leg::Tim8(b2.with(third.1).erase()),
                third_lines,
            ),
            PowerStage::new(
                Leg::Tim8(a3.with(fourth.0).erase()),
                Leg::Tim8(b3.with(fourth.1).erase()),
                fourth_lines,
            ),
            PowerStage::new(
                Leg::Tim10(a4.with(fifth.0).erase()),
                Leg::Tim11(b4.with(fifth.1).erase()),
                fifth_lines,
            ),
        ];
        release_outputs();
        stages
    }
}

/// Lets TIM1 and TIM8 drive their pins, until the clock fails: no pin is a break input, which the polarity makes
/// inactive, but a failing clock is a break too (RM0390, 17.3.12). The lock keeps a program gone astray from
/// changing any of it, and the PWM mode, before the next reset.
fn release_outputs() {
    // SAFETY: the handles went into `pwm_hz`. The channels write the compare and enable registers only; break and
    // dead-time registers are written here, and once more when the program ends.
    let (tim1, tim8) = unsafe { (TIM1::steal(), TIM8::steal()) };
    for timer in [&*tim1, &*tim8] {
        timer.bdtr().write(|w| {
            w.bke().enabled();
            w.bkp().active_high();
            w.ossi().idle_level();
            w.aoe().manual();
            w.moe().enabled();
            w.lock().level3()
        });
    }
}

impl PowerStage {
    fn new(
        mut in1: Leg,
        mut in2: Leg,
        Lines {
            enable,
            fault,
            test,
        }: Lines,
    ) -> Self {
        in1.enable();
        in2.enable();
        Self {
            bridge: Bridge::new(in1, in2, enable),
            fault,
            test,
            on: false,
        }
    }

    /// Whether the bridge or the comparator pulls the fault line; pulled down weakly against the external pull-up, a
    /// wire that is off reads as a fault.
    pub fn fault(&mut self) -> bool {
        self.fault.is_low()
    }

    /// Tells bridge and comparator what to do from now on.
    pub fn apply(&mut self, outputs: &Outputs) {
        self.test.set_state(outputs.comparator_test.into());
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

    /// Both bridge outputs high-impedance, at once.
    pub fn off(&mut self) {
        self.bridge.off();
        if self.on {
            self.on = false;
            defmt::info!("bridge off");
        }
    }
}

/// A PWM channel in front of one leg.
enum Leg {
    Tim1(ErasedChannel<TIM1>),
    Tim8(ErasedChannel<TIM8>),
    Tim10(ErasedChannel<TIM10>),
    Tim11(ErasedChannel<TIM11>),
}

impl Leg {
    fn enable(&mut self) {
        match self {
            Self::Tim1(channel) => channel.enable(),
            Self::Tim8(channel) => channel.enable(),
            Self::Tim10(channel) => channel.enable(),
            Self::Tim11(channel) => channel.enable(),
        }
    }
}

impl ErrorType for Leg {
    type Error = Infallible;
}

impl SetDutyCycle for Leg {
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
