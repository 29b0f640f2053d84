//! Names of registers for messages: address to `PERIPHERAL_REGISTER` (RM0390 memory map and register maps).

/// Names of registers by runs of consecutive words: offset of the first, and names.
type Registers = &'static [(u32, &'static [&'static str])];
/// First address, name and registers of a peripheral.
type Entry = (u32, &'static str, Registers);

const TIM: Registers = &[(
    0x00,
    &[
        "CR1", "CR2", "SMCR", "DIER", "SR", "EGR", "CCMR1", "CCMR2", "CCER", "CNT", "PSC", "ARR",
        "RCR", "CCR1", "CCR2", "CCR3", "CCR4", "BDTR", "DCR", "DMAR", "OR",
    ],
)];
const USART: Registers = &[(0x00, &["SR", "DR", "BRR", "CR1", "CR2", "CR3", "GTPR"])];
const ADC: Registers = &[
    (
        0x00,
        &[
            "SR", "CR1", "CR2", "SMPR1", "SMPR2", "JOFR1", "JOFR2", "JOFR3", "JOFR4", "HTR", "LTR",
            "SQR1", "SQR2", "SQR3", "JSQR", "JDR1",
        ],
    ),
    (0x4c, &["DR"]),
    (0x300, &["CSR", "CCR", "CDR"]),
];
const GPIO: Registers = &[(
    0x00,
    &[
        "MODER", "OTYPER", "OSPEEDR", "PUPDR", "IDR", "ODR", "BSRR", "LCKR", "AFRL", "AFRH",
    ],
)];
const RCC: Registers = &[
    (
        0x00,
        &[
            "CR", "PLLCFGR", "CFGR", "CIR", "AHB1RSTR", "AHB2RSTR", "AHB3RSTR",
        ],
    ),
    (0x20, &["APB1RSTR", "APB2RSTR"]),
    (0x30, &["AHB1ENR", "AHB2ENR", "AHB3ENR"]),
    (0x40, &["APB1ENR", "APB2ENR"]),
    (0x50, &["AHB1LPENR", "AHB2LPENR", "AHB3LPENR"]),
    (0x60, &["APB1LPENR", "APB2LPENR"]),
    (0x70, &["BDCR", "CSR"]),
    (
        0x80,
        &[
            "SSCGR",
            "PLLI2SCFGR",
            "PLLSAICFGR",
            "DCKCFGR",
            "CKGATENR",
            "DCKCFGR2",
        ],
    ),
];
const FLASH: Registers = &[(0x00, &["ACR", "KEYR", "OPTKEYR", "SR", "CR", "OPTCR"])];
const PWR: Registers = &[(0x00, &["CR", "CSR"])];
const EXTI: Registers = &[(0x00, &["IMR", "EMR", "RTSR", "FTSR", "SWIER", "PR"])];
const SYSCFG: Registers = &[
    (
        0x00,
        &["MEMRMP", "PMC", "EXTICR1", "EXTICR2", "EXTICR3", "EXTICR4"],
    ),
    (0x20, &["CMPCR"]),
    (0x2c, &["CFGR"]),
];
const IWDG: Registers = &[(0x00, &["KR", "PR", "RLR", "SR"])];
const WWDG: Registers = &[(0x00, &["CR", "CFR", "SR"])];
const NONE: Registers = &[];

/// First address, name and registers of every peripheral of the STM32F446, ascending. The next entry's address
/// bounds a peripheral; an empty name marks a reserved range.
const MAP: &[Entry] = &[
    (0x1fff_0000, "SYSTEM_MEMORY", NONE),
    (0x1fff_7800, "OTP", NONE),
    (0x1fff_7a10, "SIGNATURE", NONE),
    (0x1fff_7a30, "", NONE),
    (0x1fff_c000, "OPTION_BYTES", NONE),
    (0x1fff_c010, "", NONE),
    (0x2200_0000, "SRAM_BIT_BAND", NONE),
    (0x2240_0000, "", NONE),
    (0x4000_0000, "TIM2", TIM),
    (0x4000_0400, "TIM3", TIM),
    (0x4000_0800, "TIM4", TIM),
    (0x4000_0c00, "TIM5", TIM),
    (0x4000_1000, "TIM6", TIM),
    (0x4000_1400, "TIM7", TIM),
    (0x4000_1800, "TIM12", TIM),
    (0x4000_1c00, "TIM13", TIM),
    (0x4000_2000, "TIM14", TIM),
    (0x4000_2400, "", NONE),
    (0x4000_2800, "RTC", NONE),
    (0x4000_2c00, "WWDG", WWDG),
    (0x4000_3000, "IWDG", IWDG),
    (0x4000_3400, "", NONE),
    (0x4000_3800, "SPI2", NONE),
    (0x4000_3c00, "SPI3", NONE),
    (0x4000_4000, "SPDIFRX", NONE),
    (0x4000_4400, "USART2", USART),
    (0x4000_4800, "USART3", USART),
    (0x4000_4c00, "UART4", USART),
    (0x4000_5000, "UART5", USART),
    (0x4000_5400, "I2C1", NONE),
    (0x4000_5800, "I2C2", NONE),
    (0x4000_5c00, "I2C3", NONE),
    (0x4000_6000, "FMPI2C1", NONE),
    (0x4000_6400, "CAN1", NONE),
    (0x4000_6800, "CAN2", NONE),
    (0x4000_6c00, "HDMI_CEC", NONE),
    (0x4000_7000, "PWR", PWR),
    (0x4000_7400, "DAC", NONE),
    (0x4000_7800, "", NONE),
    (0x4001_0000, "TIM1", TIM),
    (0x4001_0400, "TIM8", TIM),
    (0x4001_0800, "", NONE),
    (0x4001_1000, "USART1", USART),
    (0x4001_1400, "USART6", USART),
    (0x4001_1800, "", NONE),
    (0x4001_2000, "ADC1", ADC),
    (0x4001_2100, "ADC2", ADC),
    (0x4001_2200, "ADC3", ADC),
    (0x4001_2300, "ADC_COMMON", &[(0x00, &["CSR", "CCR", "CDR"])]),
    (0x4001_2400, "", NONE),
    (0x4001_2c00, "SDIO", NONE),
    (0x4001_3000, "SPI1", NONE),
    (0x4001_3400, "SPI4", NONE),
    (0x4001_3800, "SYSCFG", SYSCFG),
    (0x4001_3c00, "EXTI", EXTI),
    (0x4001_4000, "TIM9", TIM),
    (0x4001_4400, "TIM10", TIM),
    (0x4001_4800, "TIM11", TIM),
    (0x4001_4c00, "", NONE),
    (0x4001_5800, "SAI1", NONE),
    (0x4001_5c00, "SAI2", NONE),
    (0x4001_6000, "", NONE),
    (0x4002_0000, "GPIOA", GPIO),
    (0x4002_0400, "GPIOB", GPIO),
    (0x4002_0800, "GPIOC", GPIO),
    (0x4002_0c00, "GPIOD", GPIO),
    (0x4002_1000, "GPIOE", GPIO),
    (0x4002_1400, "GPIOF", GPIO),
    (0x4002_1800, "GPIOG", GPIO),
    (0x4002_1c00, "GPIOH", GPIO),
    (0x4002_2000, "", NONE),
    (0x4002_3000, "CRC", NONE),
    (0x4002_3400, "", NONE),
    (0x4002_3800, "RCC", RCC),
    (0x4002_3c00, "FLASH", FLASH),
    (0x4002_4000, "BKPSRAM", NONE),
    (0x4002_5000, "", NONE),
    (0x4002_6000, "DMA1", NONE),
    (0x4002_6400, "DMA2", NONE),
    (0x4002_6800, "", NONE),
    (0x4004_0000, "OTG_HS", NONE),
    (0x4008_0000, "", NONE),
    (0x5000_0000, "OTG_FS", NONE),
    (0x5004_0000, "", NONE),
    (0x5005_0000, "DCMI", NONE),
    (0x5005_0400, "", NONE),
    (0xa000_0000, "FMC", NONE),
    (0xa000_1000, "QUADSPI", NONE),
    (0xa000_2000, "", NONE),
    (0xe000_0000, "ITM", NONE),
    (
        0xe000_1000,
        "DWT",
        &[
            (0x00, &["CTRL", "CYCCNT"]),
            (0x20, &["COMP0"]),
            (0xfb0, &["LAR"]),
        ],
    ),
    (0xe000_2000, "FPB", NONE),
    (0xe000_3000, "", NONE),
    (
        0xe000_e000,
        "SCS",
        &[
            (0x04, &["ICTR", "ACTLR"]),
            (0x10, &["SYST_CSR", "SYST_RVR", "SYST_CVR", "SYST_CALIB"]),
            (0xd00, &["CPUID", "ICSR", "VTOR", "AIRCR", "SCR", "CCR"]),
            (0xd24, &["SHCSR", "CFSR", "HFSR"]),
            (0xd88, &["CPACR"]),
            (0xd94, &["MPU_CTRL", "MPU_RNR", "MPU_RBAR", "MPU_RASR"]),
            (0xdf0, &["DHCSR"]),
            (0xdfc, &["DEMCR"]),
            (0xf00, &["STIR"]),
            (0xf34, &["FPCCR", "FPCAR", "FPDSCR"]),
        ],
    ),
    (0xe000_f000, "", NONE),
    (0xe004_0000, "TPIU", NONE),
    (0xe004_1000, "ETM", NONE),
    (
        0xe004_2000,
        "DBGMCU",
        &[(0x00, &["IDCODE", "CR", "APB1_FZ", "APB2_FZ"])],
    ),
    (0xe004_3000, "", NONE),
];
const DMA_GLOBAL: [&str; 4] = ["LISR", "HISR", "LIFCR", "HIFCR"];
const DMA_STREAM: [&str; 6] = ["CR", "NDTR", "PAR", "M0AR", "M1AR", "FCR"];

fn entry(address: u32) -> Option<Entry> {
    let after = MAP.partition_point(|(base, ..)| *base <= address);
    MAP.get(after.checked_sub(1)?).copied()
}

/// Name of the peripheral at an address; `None` in reserved ranges, where silicon answers with a bus error.
pub(crate) fn peripheral(address: u32) -> Option<&'static str> {
    entry(address).map(|e| e.1).filter(|name| !name.is_empty())
}

/// Name of the register at an address.
pub(crate) fn register(address: u32) -> String {
    let Some((base, name, registers)) = entry(address).filter(|e| !e.1.is_empty()) else {
        return format!("{address:#010x}");
    };
    let offset = (address - base) & !3;
    if name.starts_with("DMA") {
        let stream = (offset.wrapping_sub(0x10) / 0x18) as usize;
        return match DMA_GLOBAL.get(offset as usize / 4) {
            Some(register) => format!("{name}_{register}"),
            None if stream < 8 => format!(
                "{name}_S{stream}{}",
                DMA_STREAM[(offset as usize - 0x10) % 0x18 / 4]
            ),
            None => format!("{name}+{offset:#x}"),
        };
    }
    let in_run = |(first, names): &(u32, &'static [&'static str])| {
        let index = offset.checked_sub(*first)? / 4;
        names.get(index as usize).copied()
    };
    match registers.iter().find_map(in_run) {
        Some(register) => format!("{name}_{register}"),
        None => format!("{name}+{offset:#x}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_ascends_and_names_registers() {
        assert!(MAP.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert_eq!(register(0x4001_2304), "ADC_COMMON_CCR");
        assert_eq!(register(0x4002_64b8), "DMA2_S7CR");
        assert_eq!(register(0x4001_300c), "SPI1+0xc");
        assert_eq!(peripheral(0x4002_2800), None);
    }
}
