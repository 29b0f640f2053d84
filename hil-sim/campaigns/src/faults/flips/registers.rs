//! Registers of the peripherals that the image uses, with their implemented bits (RM0390, ARMv7-M).
//!
//! Left out: write-only registers, results (DR, IDR, counters of DMA streams), and registers locked by a key.

/// Word address and mask.
type Register = (u32, u32);

const HALF: u32 = 0xffff;

/// Registers of TIM1 (bridge), TIM2 (sampling), ADC1, DMA, ports A to C, USART2, clocks, watchdog, core.
pub(super) const REGISTERS: &[Register] = &[
    // TIM1: CR1, CR2, DIER, SR, CCMR1, CCER, CNT, PSC, ARR, RCR, CCR1, CCR2, BDTR
    (0x4001_0000, 0x3ff),
    (0x4001_0004, 0x7ffd),
    (0x4001_000c, 0x7fff),
    (0x4001_0010, 0x1eff),
    (0x4001_0018, HALF),
    (0x4001_0020, 0x3fff),
    (0x4001_0024, HALF),
    (0x4001_0028, HALF),
    (0x4001_002c, HALF),
    (0x4001_0030, 0xff),
    (0x4001_0034, HALF),
    (0x4001_0038, HALF),
    (0x4001_0044, HALF),
    // TIM2: CR1, CR2, DIER, CNT, PSC, ARR
    (0x4000_0000, 0x3ff),
    (0x4000_0004, 0xf8),
    (0x4000_000c, 0x5f5f),
    (0x4000_0024, u32::MAX),
    (0x4000_0028, HALF),
    (0x4000_002c, u32::MAX),
    // ADC1: SR, CR1, CR2, SMPR1, SMPR2, SQR1, SQR2, SQR3, common CCR
    (0x4001_2000, 0x3f),
    (0x4001_2004, 0x07c0_ffff),
    (0x4001_2008, 0x7f7f_0f03),
    (0x4001_200c, 0x07ff_ffff),
    (0x4001_2010, 0x3fff_ffff),
    (0x4001_202c, 0x00ff_ffff),
    (0x4001_2030, 0x3fff_ffff),
    (0x4001_2034, 0x3fff_ffff),
    (0x4001_2304, 0x00c3_ef1f),
    // DMA2 stream 0 (converter): CR, PAR, M0AR, M1AR, FCR; DMA1 stream 6 (host): CR, FCR
    (0x4002_6410, 0x0fef_ffff),
    (0x4002_6418, u32::MAX),
    (0x4002_641c, u32::MAX),
    (0x4002_6420, u32::MAX),
    (0x4002_6424, 0xbf),
    (0x4002_60a0, 0x0fef_ffff),
    (0x4002_60b4, 0xbf),
    // Ports A to C: MODER, OTYPER, OSPEEDR, PUPDR, ODR, AFRL, AFRH
    (0x4002_0000, u32::MAX),
    (0x4002_0004, HALF),
    (0x4002_0008, u32::MAX),
    (0x4002_000c, u32::MAX),
    (0x4002_0014, HALF),
    (0x4002_0020, u32::MAX),
    (0x4002_0024, u32::MAX),
    (0x4002_0400, u32::MAX),
    (0x4002_0404, HALF),
    (0x4002_0408, u32::MAX),
    (0x4002_040c, u32::MAX),
    (0x4002_0414, HALF),
    (0x4002_0424, u32::MAX),
    (0x4002_0800, u32::MAX),
    (0x4002_0804, HALF),
    (0x4002_0808, u32::MAX),
    (0x4002_080c, u32::MAX),
    (0x4002_0814, HALF),
    // USART2: SR, BRR, CR1, CR2, CR3
    (0x4000_4400, 0x3ff),
    (0x4000_4408, HALF),
    (0x4000_440c, 0xbfff),
    (0x4000_4410, 0x7f6f),
    (0x4000_4414, 0xfff),
    // RCC: CR, PLLCFGR, CFGR, CIR, AHB1ENR, APB1ENR, APB2ENR; AHB1RSTR, APB1RSTR, APB2RSTR
    (0x4002_3800, 0x0f0d_00f9),
    (0x4002_3804, 0x7f43_7fff),
    (0x4002_3808, 0xffff_fcf3),
    (0x4002_380c, 0x7f00),
    (0x4002_3830, 0x6064_10ff),
    (0x4002_3840, 0x3fff_c9ff),
    (0x4002_3844, 0x00c7_7f33),
    (0x4002_3810, 0x2060_10ff),
    (0x4002_3820, 0x3fff_c9ff),
    (0x4002_3824, 0x00c7_7933),
    // WWDG: CR, CFR; FLASH: ACR
    (0x4000_2c00, 0xff),
    (0x4000_2c04, 0x3ff),
    (0x4002_3c00, 0x70f),
    // SysTick: CSR, RVR, CVR
    (0xe000_e010, 0x7),
    (0xe000_e014, 0x00ff_ffff),
    (0xe000_e018, 0x00ff_ffff),
    // NVIC: enabled and pending, 0 to 95; priorities (four bits each) of DMA1 stream 6, USART2, DMA2 stream 0
    (0xe000_e100, u32::MAX),
    (0xe000_e104, u32::MAX),
    (0xe000_e108, u32::MAX),
    (0xe000_e200, u32::MAX),
    (0xe000_e204, u32::MAX),
    (0xe000_e208, u32::MAX),
    (0xe000_e410, 0xf0f0_f0f0),
    (0xe000_e424, 0xf0f0_f0f0),
    (0xe000_e438, 0xf0f0_f0f0),
    // System control: VTOR, SHPR1 to SHPR3, SHCSR, CPACR
    (0xe000_ed08, 0xffff_ff80),
    (0xe000_ed18, 0x00f0_f0f0),
    (0xe000_ed1c, 0xf000_0000),
    (0xe000_ed20, 0xf0f0_0000),
    (0xe000_ed24, 0x0007_fd8b),
    (0xe000_ed88, 0x00f0_0000),
];
