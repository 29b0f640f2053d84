//! The peripherals together, as the bus reaches them, without the CPU.
use super::{ADC1, Chip};
use crate::ram::{Memory, NoMemory};
use crate::stop::Refusal;
use crate::{Wiring, names};
use thermal_sim::processor::{ChipState, ResetCause};

/// A circuit that drives all pins of ports B and C alike, and each analog input to the code of its number.
#[derive(Default)]
pub(super) struct Outside {
    port_b: Option<bool>,
    port_c: Option<bool>,
}

impl Wiring for Outside {
    fn adc(&mut self, channel: u8, _now: u64) -> u16 {
        channel.into()
    }
    fn pin(&self, port: u8, _bit: u8) -> Option<bool> {
        match port {
            1 => self.port_b,
            2 => self.port_c,
            _ => None,
        }
    }
    fn uart_tx(&mut self, _byte: u8, _at: u64, _baud: u32) {}
}

/// A memory that no DMA stream uses.
struct Absent;

impl Memory for Absent {
    fn load(&mut self, _address: u32, _bytes: u8) -> Result<u32, NoMemory> {
        Err(NoMemory)
    }
    fn store(&mut self, _address: u32, _bytes: u8, _value: u32) -> Result<(), NoMemory> {
        Err(NoMemory)
    }
}

/// Records what DMA streams store.
#[derive(Default)]
struct Stored(Vec<u32>);

impl Memory for Stored {
    fn load(&mut self, _address: u32, _bytes: u8) -> Result<u32, NoMemory> {
        Err(NoMemory)
    }
    fn store(&mut self, _address: u32, _bytes: u8, value: u32) -> Result<(), NoMemory> {
        self.0.push(value);
        Ok(())
    }
}

/// A chip as delivered, on which registers are tried.
pub(super) struct Bench {
    pub chip: Chip<Outside>,
    pub now: u64,
}

impl Bench {
    pub fn new() -> Self {
        let delivered = ChipState { brown_out_code: 3, ..ChipState::default() };
        let mut bench =
            Self { chip: Chip::new(Outside::default(), vec![0xff; 0x1_0000], &delivered), now: 0 };
        bench.reset();
        bench
    }

    /// The chip after a power-on, but for enabled clocks of all modelled peripherals and an unlocked watchdog.
    pub fn reset(&mut self) {
        self.chip.system_reset(ResetCause::PowerOn, self.now);
        for (register, clocks) in
            [(0x4002_3830, 0x0060_10ff), (0x4002_3840, 0x3002_083f), (0x4002_3844, 0x0006_4303)]
        {
            let old = self.read(register).expect("an enable register");
            self.write(register, old | clocks).expect("modelled peripherals");
        }
        self.write(0x4000_3000, 0x5555).expect("key of the IWDG");
    }

    pub fn read(&mut self, address: u32) -> Result<u32, Refusal> {
        self.chip.read(address, self.now, 0)
    }

    pub fn write(&mut self, address: u32, value: u32) -> Result<(), Refusal> {
        self.chip.write(address, 4, value, self.now)
    }

    /// Stores of words that the machine accepts.
    fn set_up(&mut self, stores: &[(u32, u32)]) {
        for (address, value) in stores {
            let register = names::register(*address);
            assert_eq!(self.write(*address, *value), Ok(()), "{register}");
        }
    }
}

const GPIOA: u32 = 0x4002_0000;
const GPIOC: u32 = 0x4002_0800;
const EXTI: u32 = 0x4001_3c00;
const TIM1: u32 = 0x4001_0000;
const TIM2: u32 = 0x4000_0000;
const TIM3: u32 = 0x4000_0400;
const ADC: u32 = 0x4001_2000;
const ADC2: u32 = 0x4001_2100;
const ADC_COMMON: u32 = 0x4001_2300;
const APB2RSTR: u32 = 0x4002_3824;
const APB2ENR: u32 = 0x4002_3844;
const USART2: u32 = 0x4000_4400;

/// Instructions, in half-words.
const NOP: (u32, u32) = (0xbf00, 0);
const DSB: (u32, u32) = (0xf3bf, 0x8f4f);
const STR: (u32, u32) = (0x6008, 0);

/// ES0298, 2.2.7. With PCLK1 at HCLK, the clock of a peripheral on APB1 takes two cycles, on AHB1 as well.
#[test]
fn a_strict_chip_refuses_an_access_right_behind_the_enabling_of_a_clock() {
    let answer = |strict, enable: (u32, u32), register, between: &[(u32, u32)]| {
        let state = ChipState { strict, ..ChipState::default() };
        let mut chip = Chip::new(Outside::default(), vec![0xff; 0x1_0000], &state);
        chip.system_reset(ResetCause::PowerOn, 0);
        let old = chip.read(enable.0, 0, 0).expect("an enable register");
        chip.write(enable.0, 4, old | enable.1, 0).expect("a peripheral");
        for instruction in between.iter().chain([&STR]) {
            chip.note_instruction(*instruction);
        }
        chip.write(register, 4, 0, 0)
    };
    let wwdg = ((0x4002_3840, 1 << 11), 0x4000_2c04);
    let gpioa = ((0x4002_3830, 1), GPIOA + 0x14);
    for (enable, register) in [wwdg, gpioa] {
        for between in [&[][..], &[NOP]] {
            let refused = answer(true, enable, register, between);
            assert!(matches!(refused, Err(Refusal::Misuse(_))), "{register:#x}: {refused:?}");
            assert_eq!(answer(false, enable, register, between), Ok(()));
        }
        for between in [&[DSB][..], &[NOP, NOP]] {
            assert_eq!(answer(true, enable, register, between), Ok(()), "{register:#x}");
        }
        assert_eq!(answer(true, enable, APB2RSTR, &[]), Ok(()), "another device");
    }
}

/// Arm's errata notice of the Cortex-M4, 838869.
#[test]
fn a_strict_chip_refuses_the_return_of_a_handler_right_behind_a_store() {
    let misused = |strict, between: &[(u32, u32)]| {
        let state = ChipState { strict, ..ChipState::default() };
        let mut chip = Chip::new(Outside::default(), vec![0xff; 0x1_0000], &state);
        chip.write(EXTI, 4, 0, 0).expect("a register without a clock of its own");
        between.iter().for_each(|instruction| chip.note_instruction(*instruction));
        chip.note_exception_return();
        chip.misuse.map(|(register, _)| register)
    };
    for between in [&[][..], &[NOP; 12]] {
        assert_eq!(misused(true, between), Some(EXTI));
        assert_eq!(misused(false, between), None);
    }
    for between in [&[DSB][..], &[NOP, DSB], &[NOP; 13]] {
        assert_eq!(misused(true, between), None);
    }
}

/// RM0390 10.2: a line pends at an edge, and a pin that is high already has none.
#[test]
fn an_edge_that_was_before_its_selection_does_not_pend() {
    for level in [false, true] {
        let mut bench = Bench::new();
        bench.chip.wiring.port_c = Some(level);
        bench.chip.sample_inputs(0);
        // PC13, both edges, in the two orders
        let selects = [(EXTI + 8, 1 << 13), (EXTI + 0xc, 1 << 13)];
        let unmasks = [(EXTI, 1 << 13)];
        bench.set_up(&[(0x4001_3814, 2 << 4)]);
        for stores in [[&selects[..], &unmasks], [&unmasks, &selects]] {
            bench.set_up(&stores.concat());
            bench.chip.sample_inputs(1);
            assert_eq!(bench.read(EXTI + 0x14), Ok(0), "high: {level}");
            bench.set_up(&[(EXTI, 0), (EXTI + 8, 0), (EXTI + 0xc, 0)]);
        }
        bench.set_up(&[selects[0], selects[1], unmasks[0]]);
        bench.chip.wiring.port_c = Some(!level);
        bench.chip.sample_inputs(2);
        assert_eq!(bench.read(EXTI + 0x14), Ok(1 << 13), "high: {level}");
    }
}

/// RM0390 17.3.14 and 17.3.5, DS10693 table 11: TIM2's update event starts TIM3, whose first input is PB4.
#[test]
fn tim3_counts_from_tim2s_update_and_captures_pb4() {
    const GPIOB: u32 = 0x4002_0400;
    let mut bench = Bench::new();
    bench.chip.wiring.port_b = Some(false);
    // PB4 as alternate function 2; TIM3 counts to 1000, started by ITR1; TIM2 gives its update event as trigger output.
    bench.set_up(&[
        (GPIOB, 2 << 8),
        (GPIOB + 0x20, 2 << 16),
        (TIM3 + 0x2c, 999),
        (TIM3 + 0x18, 1),
        (TIM3 + 0x20, 1),
        (TIM3 + 0x08, 0x16),
        (TIM2 + 0x2c, 99),
        (TIM2 + 0x04, 0x20),
        (TIM2, 1),
    ]);
    for (now, level) in [(150, false), (350, true)] {
        bench.now = now;
        bench.chip.service(now, &mut Absent);
        bench.chip.wiring.port_b = Some(level);
        bench.chip.sample_inputs(now);
    }
    assert_eq!(bench.read(TIM3 + 0x10).map(|flags| flags >> 1 & 1), Ok(1));
    assert_eq!(bench.read(TIM3 + 0x34), Ok(250), "TIM3 started at 100");
}

/// RM0390 7.4, 6.3, 3.8.
#[test]
fn bytes_and_half_words_of_ports_rcc_and_flash_leave_the_rest_of_a_register() {
    const RCC_AHB1ENR: u32 = 0x4002_3830;
    const FLASH_ACR: u32 = 0x4002_3c00;
    let mut bench = Bench::new();
    bench.set_up(&[(GPIOC, 0x1234_5678), (FLASH_ACR, 0x0705)]);
    let clocks = bench.read(RCC_AHB1ENR).expect("a register");
    for (address, bytes, value, register, after) in [
        (GPIOC + 1, 1, 0xaa, GPIOC, 0x1234_aa78),
        (GPIOC + 2, 2, 0x5555, GPIOC, 0x5555_aa78),
        (GPIOC, 2, 0x0001, GPIOC, 0x5555_0001),
        // BSRR, whose other half does nothing; ODR
        (GPIOC + 0x18, 1, 0x81, GPIOC + 0x14, 0x0081),
        (GPIOC + 0x1b, 1, 0xff, GPIOC + 0x14, 0x0081),
        (GPIOC + 0x1a, 2, 0x0001, GPIOC + 0x14, 0x0080),
        (FLASH_ACR, 1, 0x04, FLASH_ACR, 0x0704),
        (FLASH_ACR + 1, 1, 0x03, FLASH_ACR, 0x0304),
        (RCC_AHB1ENR, 1, 0x04, RCC_AHB1ENR, clocks & !0xff | 0x04),
    ] {
        let stored = bench.chip.write(address, bytes, value, 0);
        assert_eq!(stored, Ok(()), "{}", names::register(address));
        let place = format!("{value:#x} in {bytes} bytes at {address:#x}");
        assert_eq!(bench.read(register), Ok(after), "{place}");
    }
}

/// RM0390 2.1 and the first lines of each chapter's registers.
#[test]
fn the_other_buses_take_half_words_of_short_registers_only() {
    let mut bench = Bench::new();
    bench.set_up(&[(TIM2 + 0x2c, 0x0012_3456), (TIM3 + 0x2c, 99)]);
    let cases = [
        (TIM3 + 0x2c, 2, 1000, Ok(())),
        (USART2 + 8, 2, 45, Ok(())),
        (USART2 + 4, 1, 0x41, Ok(())),
        (0x4000_3008, 2, 0x123, Ok(())),   // IWDG_RLR
        (0x4000_2c04, 2, 0x55, Ok(())),    // WWDG_CFR
        (0x4001_3808, 2, 0x1234, Ok(())),  // SYSCFG_EXTICR1
        (TIM2 + 0x2c, 2, 1000, Err(())),   // 32 bits
        (TIM3 + 0x2c, 1, 10, Err(())),     // a byte
        (TIM3 + 0x2e, 2, 10, Err(())),     // the upper half
        (USART2 + 0x0c, 1, 4, Err(())),    // a byte, but not to DR
        (0x4000_7000, 2, 0xc000, Err(())), // PWR_CR has an upper half
        (ADC + 8, 2, 1, Err(())),          // words only
        (EXTI, 2, 1, Err(())),             // words only
        (0x4002_6014, 2, 1, Err(())),      // DMA, words only
        (0x4002_3c04, 1, 0x23, Err(())),   // FLASH_KEYR, words only
    ];
    for (address, bytes, value, expected) in cases {
        let answer = bench.chip.write(address, bytes, value, 0);
        let expected = expected.map_err(|()| Refusal::Width);
        assert_eq!(answer, expected, "{} {bytes}", names::register(address));
    }
    assert_eq!(bench.read(TIM3 + 0x2c), Ok(1000));
    assert_eq!(bench.read(TIM2 + 0x2c), Ok(0x0012_3456));
}

/// RM0390 7.3.9.
#[test]
fn the_input_register_shows_what_peripherals_drive() {
    let mut bench = Bench::new();
    // TIM1 CH1 on PA8, inverted CH2 on PA9: high for 30 of 100 ticks, main output on; USART2 at 16 cycles a bit on PA2
    bench.set_up(&[
        (GPIOA, 0xa80a_0020),
        (GPIOA + 0x20, 0x0700),
        (GPIOA + 0x24, 0x11),
        (TIM1 + 0x2c, 99),
        (TIM1 + 0x34, 30),
        (TIM1 + 0x38, 30),
        (TIM1 + 0x18, 0x6060),
        (TIM1 + 0x20, 0x31),
        (TIM1 + 0x44, 1 << 15),
        (TIM1, 1),
        (USART2 + 8, 16),
        (USART2 + 0xc, 1 << 13 | 1 << 3),
    ]);
    let mut pins = |now: u64| {
        bench.now = now;
        bench.read(GPIOA + 0x10).expect("IDR") & 0x0304
    };
    // the transmitter's first frame is idle
    for (now, expected) in [(0, 0x104), (29, 0x104), (30, 0x204), (99, 0x204), (129, 0x104)] {
        assert_eq!(pins(now), expected, "{now}");
    }
    let begin = 1000;
    bench.now = begin;
    while bench.chip.usart.tx_due != u64::MAX {
        bench.chip.usart.transmitted();
    }
    bench.set_up(&[(USART2 + 4, 0x41)]);
    let level = |bench: &mut Bench, now| {
        bench.now = now;
        bench.read(GPIOA + 0x10).expect("IDR") >> 2 & 1
    };
    // start bit, eight data bits from the lowest on, stop bit
    let bits: Vec<u32> = (0..10).map(|bit| level(&mut bench, begin + 16 * bit + 8)).collect();
    assert_eq!(bits, [0, 1, 0, 0, 0, 0, 0, 1, 0, 1]);
    bench.set_up(&[(USART2 + 0xc, 0)]);
    assert_eq!(level(&mut bench, 2000), 0, "a floating pin");
}

/// RM0390 17.4.2: with MMS = 001 the counter's enable is the trigger output.
#[test]
fn the_enable_of_a_counter_starts_the_converter_if_it_is_the_trigger() {
    for (mode, starts) in [(0, false), (1, true), (2, false)] {
        let mut bench = Bench::new();
        bench.set_up(&[(ADC + 8, 1 << 28 | 6 << 24 | 1), (TIM2 + 4, mode << 4)]);
        bench.now = 100;
        bench.set_up(&[(TIM2, 1)]);
        assert_eq!(bench.chip.adcs[ADC1].due != u64::MAX, starts, "MMS = {mode}");
    }
}

/// DS10693, t_STAB. HCLK is 16 MHz.
#[test]
fn a_trigger_before_the_converter_is_stable_is_misuse() {
    for (after, allowed) in [(47, false), (48, true)] {
        let mut bench = Bench::new();
        bench.set_up(&[(ADC + 8, 1 << 28 | 6 << 24 | 1), (TIM2 + 4, 1 << 4)]);
        bench.now = after;
        bench.set_up(&[(TIM2, 1)]);
        assert_eq!(bench.chip.misuse.is_none(), allowed, "{after} cycles");
    }
}

/// One conversion of input 15 by ADC2, with the longest sample time, starts at cycle 100 by software.
fn start_adc2(bench: &mut Bench) {
    bench.set_up(&[(ADC2 + 0xc, 7 << 15), (ADC2 + 0x34, 15), (ADC2 + 8, 1)]);
    bench.now = 100;
    bench.set_up(&[(ADC2 + 8, 1 << 30 | 1)]);
}

/// RM0390 13.5, 13.8.1, 13.13.1. ADCCLK is HCLK/4.
#[test]
fn adc2_converts_once_in_492_clocks_beside_the_stream_of_adc1() {
    let mut bench = Bench::new();
    let mut stored = Stored::default();
    // DMA2 stream 0: half-words from ADC1's data register, circular. ADC1 converts input 4 without end, 15 clocks each.
    bench.set_up(&[
        (0x4002_6414, 4),
        (0x4002_6418, ADC + 0x4c),
        (0x4002_641c, 0x2000_0000),
        (0x4002_6410, 0x2d01),
        (ADC_COMMON + 4, 1 << 16),
        (ADC + 0x34, 4),
        (ADC + 8, 0x303),
    ]);
    start_adc2(&mut bench);
    bench.set_up(&[(ADC + 8, 1 << 30 | 0x303)]);
    let end = 100 + 4 * (480 + 12);
    for (now, status) in [(end - 1, 0x10), (end, 0x12)] {
        bench.now = now;
        bench.chip.service(now, &mut stored);
        assert_eq!(bench.read(ADC2), Ok(status), "{now}");
    }
    assert_eq!(bench.read(ADC_COMMON), Ok(0x1210), "EOC of ADC2 only");
    assert_eq!(bench.read(ADC2 + 0x4c), Ok(15));
    assert_eq!(bench.read(ADC2), Ok(0x10), "reading the code clears EOC");
    assert_eq!(bench.read(ADC), Ok(0x10), "no overrun");
    assert_eq!(stored.0, [4; 492 / 15]);
    bench.chip.service(end + 10_000, &mut stored);
    assert_eq!(bench.read(ADC2), Ok(0x10), "no other conversion");
}

/// RM0390 13.11 and table 38: position 18.
#[test]
fn converters_share_an_interrupt() {
    const NVIC_ISPR0: u32 = 0xe000_e200;
    for enabled in [false, true] {
        let mut bench = Bench::new();
        bench.set_up(&[(ADC2 + 4, u32::from(enabled) << 5)]);
        start_adc2(&mut bench);
        bench.chip.service(2000, &mut Absent);
        let pending = bench.read(NVIC_ISPR0).expect("a register") >> 18 & 1;
        assert_eq!(pending != 0, enabled);
    }
}

/// RM0390 6.3.10, 6.3.14.
#[test]
fn converters_have_one_reset_and_two_clocks() {
    let mut bench = Bench::new();
    start_adc2(&mut bench);
    bench.set_up(&[(ADC + 8, 1), (APB2RSTR, 1 << 8), (APB2RSTR, 0)]);
    bench.chip.service(2000, &mut Absent);
    for register in [ADC, ADC + 8, ADC2, ADC2 + 8, ADC2 + 0xc] {
        assert_eq!(bench.read(register), Ok(0), "{}", names::register(register));
    }
    bench.set_up(&[(APB2ENR, 1 << 8)]);
    let clock_off = Refusal::ClockOff("RCC_APB2ENR", 9);
    assert_eq!(bench.read(ADC2), Err(clock_off));
    assert_eq!(bench.write(ADC2 + 8, 1), Err(clock_off));
    assert_eq!(bench.read(ADC), Ok(0));
}

#[test]
fn a_stopped_adc2_converts_again_after_a_reset_and_adc1_all_the_time() {
    let mut bench = Bench::new();
    bench.chip.stop_adc(super::ADC2, 0);
    bench.set_up(&[(ADC + 8, 1)]);
    start_adc2(&mut bench);
    bench.set_up(&[(ADC + 8, 1 << 30 | 1)]);
    bench.now = 10_000;
    bench.chip.service(bench.now, &mut Absent);
    assert_eq!(bench.read(ADC2), Ok(0x10), "started, not ended");
    assert_eq!(bench.read(ADC), Ok(0x12));
    bench.set_up(&[(APB2RSTR, 1 << 8), (APB2RSTR, 0), (ADC2 + 8, 1)]);
    bench.now += 100;
    bench.set_up(&[(ADC2 + 8, 1 << 30 | 1)]);
    bench.chip.service(bench.now + 10_000, &mut Absent);
    assert_eq!(bench.read(ADC2), Ok(0x12));
}

/// DS10693, t_STAB. HCLK is 16 MHz.
#[test]
fn adc2_too_takes_3_us_to_be_stable() {
    for (after, allowed) in [(47, false), (48, true)] {
        let mut bench = Bench::new();
        bench.set_up(&[(ADC2 + 8, 1)]);
        bench.now = after;
        let started = bench.write(ADC2 + 8, 1 << 30 | 1);
        assert_eq!(started.is_ok(), allowed, "{after} cycles");
    }
}

#[test]
fn what_adc2_has_no_model_for_ends_the_run() {
    // DMA, DDS, rising edge of a trigger, EXTSEL
    for bit in [8, 9, 28, 25] {
        let mut bench = Bench::new();
        let written = bench.write(ADC2 + 8, 1 << bit);
        assert!(matches!(written, Err(Refusal::NotModelled(_))), "{bit}");
    }
    for channel in [16, 17, 18] {
        let mut bench = Bench::new();
        bench.set_up(&[(ADC_COMMON + 4, 1 << 23), (ADC2 + 0x34, channel), (ADC2 + 8, 1)]);
        bench.now = 100;
        let started = bench.write(ADC2 + 8, 1 << 30 | 1);
        assert!(matches!(started, Err(Refusal::NotModelled(_))), "{channel}");
    }
}
