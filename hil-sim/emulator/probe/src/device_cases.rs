//! Cases of the peripherals.
use crate::{log, read, set, write};
use core::sync::atomic::{AtomicU8, AtomicU16};

pub const RCC: usize = 0x4002_3800;
const FLASH_ACR: usize = 0x4002_3c00;
const PWR: usize = 0x4000_7000;
pub const GPIOA: usize = 0x4002_0000;
const GPIOC: usize = 0x4002_0800;
const SYSCFG: usize = 0x4001_3800;
const EXTI: usize = 0x4001_3c00;
const TIM1: usize = 0x4001_0000;
const TIM2: usize = 0x4000_0000;
const TIM3: usize = 0x4000_0400;
const ADC1: usize = 0x4001_2000;
const USART2: usize = 0x4000_4400;
const DMA1: usize = 0x4002_6000;
const DMA2: usize = 0x4002_6400;
const IWDG: usize = 0x4000_3000;
const SYST_CSR: usize = 0xe000_e010;
const ISER1: usize = 0xe000_e104;

/// Circular buffer of the converter.
#[unsafe(no_mangle)]
static SAMPLES: [AtomicU16; 224] = [const { AtomicU16::new(0) }; 224];
static TEXT: [AtomicU8; 64] = [const { AtomicU8::new(b'.') }; 64];

pub fn unmodelled_register() {
    set(RCC + 0x44, 1 << 12);
    read(0x4001_3000);
}

pub fn clock_off() {
    write(TIM2 + 0x2c, 99);
}

pub fn clock_off_read() {
    read(USART2);
}

pub fn external_memory() {
    log(read(0x1fff_7a20) >> 16); // flash size in KiB
    read(0xa000_1000);
}

/// The store of the unmodelled mode and the sleep are in one basic block.
pub fn encoder_mode_then_sleep() {
    set(RCC + 0x40, 1 << 1);
    // SAFETY: a store to a register of TIM3.
    unsafe { core::arch::asm!("str {v}, [{a}]", "wfi", v = in(reg) 3, a = in(reg) TIM3 + 8) };
}

pub fn encoder_mode() {
    set(RCC + 0x40, 1 << 1);
    write(TIM3 + 0x08, 3);
}

pub fn clock_180_mhz(wait_states: u32) {
    write(FLASH_ACR, 0x700 | wait_states);
    set(RCC, 1 << 18 | 1 << 16);
    while read(RCC) >> 17 & 1 == 0 {}
    write(RCC + 4, 4 << 24 | 1 << 22 | 180 << 6 | 4);
    set(RCC, 1 << 24);
    set(RCC + 0x40, 1 << 28);
    set(PWR, 1 << 16);
    while read(PWR + 4) >> 16 & 1 == 0 {}
    set(PWR, 1 << 17);
    while read(PWR + 4) >> 17 & 1 == 0 {}
    while read(RCC) >> 25 & 1 == 0 {}
    write(RCC + 8, 5 << 10 | 4 << 13);
    write(RCC + 8, 5 << 10 | 4 << 13 | 2);
    while read(RCC + 8) >> 2 & 3 != 2 {}
}

pub fn too_few_wait_states() {
    clock_180_mhz(4);
}

/// Starts the independent watchdog: 80 * 4 / 32 kHz = 10 ms.
pub fn start_watchdog() {
    write(IWDG, 0x5555);
    write(IWDG + 4, 0);
    write(IWDG + 8, 79);
    write(IWDG, 0xcccc);
}

/// Feeds the independent watchdog three times, then no more. PA5 changes with each feed.
pub fn watchdog() {
    let flags = read(RCC + 0x74) >> 24;
    log(flags);
    if flags & 0x20 != 0 {
        write(RCC + 0x74, 1 << 24);
        log(read(RCC + 0x74) >> 24);
        return;
    }
    start_watchdog();
    set(RCC + 0x30, 1);
    write(GPIOA, read(GPIOA) | 1 << 10);
    for feed in 0..3 {
        cortex_m::asm::delay(30_000); // about 6 ms at 16 MHz
        write(GPIOA + 0x14, (feed + 1) << 5);
        write(IWDG, 0xaaaa);
    }
    crate::sleep_forever()
}

fn usart2_at_1_mbaud() {
    set(RCC + 0x30, 1 | 1 << 21 | 1 << 22);
    set(RCC + 0x40, 1 << 17);
    write(GPIOA, read(GPIOA) & !0xf0 | 0xa0);
    set(GPIOA + 0x20, 0x7700);
    write(USART2 + 0x08, 45); // PCLK1 of 45 MHz
    write(USART2 + 0x14, 1 << 7);
    write(USART2 + 0x0c, 1 << 13 | 1 << 5 | 1 << 3 | 1 << 2);
    write(ISER1, 1 << 6);
}

pub fn usart2() {
    log(0x5a00_0000 | read(USART2) & 0xff00_002f);
    log(read(USART2 + 4));
}

/// USART2 at 1 Mbit/s; the test sets the host's rate.
pub fn baud_mismatch() {
    clock_180_mhz(5);
    usart2_at_1_mbaud();
}

/// The load of the product's image without its arithmetic: 16 kHz scans of seven channels by DMA, PWM at 100 kHz,
/// a steady stream of bytes by DMA, received bytes by interrupt, a 1 kHz tick, and sleep.
pub fn product_load() {
    clock_180_mhz(5);
    usart2_at_1_mbaud();
    set(RCC + 0x44, 1 | 1 << 8);
    set(RCC + 0x40, 1);
    pwm();
    adc_scan();
    text_stream();
    write(SYST_CSR + 4, 179_999);
    write(SYST_CSR + 8, 0);
    write(SYST_CSR, 7);
    log(1);
}

pub fn pwm() {
    write(GPIOA, read(GPIOA) & !0xf_3000 | 0xa_2000); // PA8 and PA9, and PA6 as the break input
    set(GPIOA + 0x24, 0x11);
    set(GPIOA + 0x20, 1 << 24);
    write(TIM1 + 0x2c, 1799);
    write(TIM1 + 0x34, 450);
    write(TIM1 + 0x38, 0);
    write(TIM1 + 0x18, 0x6868); // PWM mode 1 with preload
    write(TIM1 + 0x20, 0x11);
    write(TIM1 + 0x14, 1);
    write(TIM1 + 0x44, 1 << 15 | 1 << 13 | 1 << 12); // outputs on, break when high
    write(TIM1, 0x81);
}

fn adc_scan() {
    write(DMA2 + 0x18, (ADC1 + 0x4c) as u32);
    write(DMA2 + 0x1c, SAMPLES.as_ptr() as u32);
    write(DMA2 + 0x14, SAMPLES.len() as u32);
    write(DMA2 + 0x10, 1 << 13 | 1 << 11 | 1 << 10 | 1 << 8 | 1);
    write(ADC1 + 0x304, 1 << 16);
    write(ADC1 + 0x04, 1 << 8);
    write(ADC1 + 0x10, 0o3_333_333_333);
    write(ADC1 + 0x2c, 6 << 20);
    write(ADC1 + 0x34, 5 << 25 | 4 << 20 | 3 << 15 | 2 << 10 | 1 << 5);
    write(ADC1 + 0x30, 6);
    write(ADC1 + 0x08, 1 << 28 | 6 << 24 | 1 << 9 | 1 << 8 | 1);
    write(TIM2 + 0x2c, 5624); // 90 MHz / 5625 = 16 kHz
    write(TIM2 + 0x04, 2 << 4);
    write(TIM2, 1);
}

fn text_stream() {
    write(DMA1 + 0xa8, (USART2 + 4) as u32);
    write(DMA1 + 0xac, TEXT.as_ptr() as u32);
    write(DMA1 + 0xa4, TEXT.len() as u32);
    write(DMA1 + 0xa0, 4 << 25 | 1 << 10 | 1 << 8 | 1 << 6 | 1);
}

/// Stores bytes and half-words to registers of port C.
pub fn narrow_stores() {
    write(GPIOC + 4, 0x1234);
    // SAFETY: the addresses are those of OTYPER and BSRR of port C.
    unsafe {
        ((GPIOC + 5) as *mut u8).write_volatile(0xab);
        log(read(GPIOC + 4));
        ((GPIOC + 4) as *mut u16).write_volatile(0x5678);
        ((GPIOC + 0x19) as *mut u8).write_volatile(0x80);
    }
    log(read(GPIOC + 4));
    log(read(GPIOC + 0x14));
}

pub fn half_word_of_a_word_register() {
    set(RCC + 0x40, 1);
    // SAFETY: the auto-reload register of TIM2.
    unsafe { ((TIM2 + 0x2c) as *mut u16).write_volatile(99) };
}

/// Sends one byte by DMA, then enables the stream again without clearing its flags.
pub fn stream_enabled_with_flags() {
    usart2_at_1_mbaud();
    write(DMA1 + 0xa8, (USART2 + 4) as u32);
    write(DMA1 + 0xac, TEXT.as_ptr() as u32);
    write(DMA1 + 0xa4, 1);
    let config = 4 << 25 | 1 << 10 | 1 << 6;
    write(DMA1 + 0xa0, config | 1);
    while read(DMA1 + 0xa0) & 1 != 0 {}
    log(read(DMA1 + 4) >> 16 & 0x3d);
    write(DMA1 + 0xa0, config | 1);
}

/// TIM2 starts the converter while the CPU sleeps, 2 us after the converter was switched on.
pub fn trigger_before_the_converter_is_stable() {
    set(RCC + 0x44, 1 << 8);
    set(RCC + 0x40, 1);
    write(TIM2 + 0x2c, 31); // of 16 MHz
    write(TIM2 + 0x04, 2 << 4);
    write(ADC1 + 0x08, 1 << 28 | 6 << 24 | 1);
    write(TIM2, 1);
}

/// PC6 is high before its rising edge is selected.
pub fn edge_before_its_selection() {
    set(RCC + 0x44, 1 << 14);
    write(SYSCFG + 0x0c, 2 << 8);
    write(EXTI + 0x08, 1 << 6);
    write(EXTI, 1 << 6);
    log(read(EXTI + 0x14));
    write(EXTI + 0x10, 1 << 6);
    log(read(EXTI + 0x14));
}
