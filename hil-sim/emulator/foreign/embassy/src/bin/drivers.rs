//! Drivers at 180 MHz: USART2 by DMA up to an idle line, PWM of TIM1, the converter, and edges of PC0.
#![no_std]
#![no_main]

use embassy_executor::Spawner;
use embassy_stm32::adc::{Adc, SampleTime};
use embassy_stm32::exti::{self, ExtiInput};
use embassy_stm32::gpio::{Level, Output, OutputType, Pull, Speed};
use embassy_stm32::mode::Async;
use embassy_stm32::rcc::{
    APBPrescaler, Hse, HseMode, LsConfig, Pll, PllMul, PllPDiv, PllPreDiv, PllSource, Sysclk,
};
use embassy_stm32::time::Hertz;
use embassy_stm32::timer::simple_pwm::{PwmPin, SimplePwm};
use embassy_stm32::usart::{self, Uart};
use embassy_stm32::{Config, bind_interrupts, dma, interrupt, peripherals};
use panic_halt as _;

bind_interrupts!(struct Handlers {
    USART2 => usart::InterruptHandler<peripherals::USART2>;
    DMA1_STREAM5 => dma::InterruptHandler<peripherals::DMA1_CH5>;
    DMA1_STREAM6 => dma::InterruptHandler<peripherals::DMA1_CH6>;
    EXTI0 => exti::InterruptHandler<interrupt::typelevel::EXTI0>;
});

/// The clocks of the firmware: 180 MHz from the 8 MHz of the board's debug probe.
fn clocks() -> Config {
    let mut config = Config::default();
    let rcc = &mut config.rcc;
    rcc.ls = LsConfig::off();
    rcc.hse = Some(Hse { freq: Hertz(8_000_000), mode: HseMode::Bypass });
    rcc.pll_src = PllSource::HSE;
    rcc.pll = Some(Pll {
        prediv: PllPreDiv::DIV4,
        mul: PllMul::MUL180,
        divp: Some(PllPDiv::DIV2),
        divq: None,
        divr: None,
    });
    rcc.sys = Sysclk::PLL1_P;
    rcc.apb1_pre = APBPrescaler::DIV4;
    rcc.apb2_pre = APBPrescaler::DIV2;
    config
}

#[embassy_executor::task]
async fn light_while_high(mut button: ExtiInput<'static, Async>, mut light: Output<'static>) {
    loop {
        button.wait_for_rising_edge().await;
        light.set_high();
        button.wait_for_falling_edge().await;
        light.set_low();
    }
}

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let mut p = embassy_stm32::init(clocks());

    let leg = PwmPin::new(p.PA8, OutputType::PushPull);
    let mut pwm =
        SimplePwm::new(p.TIM1, Some(leg), None, None, None, Hertz(20_000), Default::default());
    pwm.ch1().set_duty_cycle_percent(25);
    pwm.ch1().enable();

    let button = ExtiInput::new(p.PC0, p.EXTI0, Pull::Down, Handlers);
    let light = Output::new(p.PA5, Level::Low, Speed::Low);
    spawner.spawn(light_while_high(button, light).unwrap());

    let mut adc = Adc::new(p.ADC1);
    let codes = [
        adc.blocking_read(&mut p.PA1, SampleTime::CYCLES84),
        adc.blocking_read(&mut p.PA4, SampleTime::CYCLES84),
    ];

    let mut uart = Uart::new(
        p.USART2,
        p.PA3,
        p.PA2,
        p.DMA1_CH6,
        p.DMA1_CH5,
        Handlers,
        usart::Config::default(),
    )
    .unwrap();
    for code in codes {
        uart.write(&code.to_be_bytes()).await.unwrap();
    }
    let mut text = [0; 64];
    loop {
        let bytes = uart.read_until_idle(&mut text).await.unwrap();
        text[..bytes].reverse();
        uart.write(&text[..bytes]).await.unwrap();
    }
}
