//! Three executors, each of which preempts the one below: tasks of the thread (PA5), of an interrupt (PB0), and of an interrupt
//! of higher priority (PC1). Busy times are spent with the CPU, so that an edge in one can only come from another executor.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use embassy_executor::{Executor, InterruptExecutor};
use embassy_stm32::gpio::{Level, Output, Speed};
use embassy_stm32::interrupt::{InterruptExt, Priority};
use embassy_stm32::rcc::LsConfig;
use embassy_stm32::{Config, interrupt};
use embassy_time::{Duration, Ticker, Timer, block_for};
use panic_halt as _;
use static_cell::StaticCell;

static HIGH: InterruptExecutor = InterruptExecutor::new();
static MIDDLE: InterruptExecutor = InterruptExecutor::new();
static THREAD: StaticCell<Executor> = StaticCell::new();

// Peripherals that this program does not use lend their interrupts.
#[interrupt]
unsafe fn UART4() {
    // SAFETY: called here only, and after the start.
    unsafe { HIGH.on_interrupt() }
}

#[interrupt]
unsafe fn UART5() {
    // SAFETY: as above.
    unsafe { MIDDLE.on_interrupt() }
}

#[embassy_executor::task]
async fn toggle_each_ms(mut pin: Output<'static>) {
    let mut ticker = Ticker::every(Duration::from_millis(1));
    loop {
        ticker.next().await;
        pin.toggle();
    }
}

#[embassy_executor::task]
async fn busy_2_of_5_ms(mut pin: Output<'static>) {
    let mut ticker = Ticker::every(Duration::from_millis(5));
    loop {
        ticker.next().await;
        pin.set_high();
        block_for(Duration::from_micros(2_100));
        pin.set_low();
    }
}

#[embassy_executor::task]
async fn busy_20_of_30_ms(mut pin: Output<'static>) {
    loop {
        pin.set_high();
        block_for(Duration::from_millis(20));
        pin.set_low();
        Timer::after_millis(10).await;
    }
}

#[entry]
fn main() -> ! {
    let mut config = Config::default();
    config.rcc.ls = LsConfig::off();
    let p = embassy_stm32::init(config);
    let thread = Output::new(p.PA5, Level::Low, Speed::Low);
    let middle = Output::new(p.PB0, Level::Low, Speed::Low);
    let high = Output::new(p.PC1, Level::Low, Speed::Low);
    interrupt::UART4.set_priority(Priority::P6);
    HIGH.start(interrupt::UART4).spawn(toggle_each_ms(high).unwrap());
    interrupt::UART5.set_priority(Priority::P7);
    MIDDLE.start(interrupt::UART5).spawn(busy_2_of_5_ms(middle).unwrap());
    THREAD.init(Executor::new()).run(|spawner| spawner.spawn(busy_20_of_30_ms(thread).unwrap()))
}
