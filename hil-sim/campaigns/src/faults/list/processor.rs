//! Faults of the microcontroller: core, clock, memory, peripherals, supply.

use thermal_device::safety::Fault;
use thermal_sim::processor::CoreRegister;
use thermal_sim::processor::MachineFault as Fails;

use super::electrics::LEG_REASONS;
use crate::faults::fault_case::{harmless, restarts, trips};
use crate::faults::{FaultCase, FaultScene, InjectedFault, Symptom};

const fn processor(fault: Fails) -> InjectedFault {
    InjectedFault::Processor(fault)
}

const fn flipped(address: u32, bit: u8) -> InjectedFault {
    processor(Fails::RegisterBit { address, bit })
}

const fn core(register: CoreRegister, bit: u8) -> InjectedFault {
    processor(Fails::CoreBit { register, bit })
}

const NOW: &[Symptom] = &[Symptom::Injection];
/// The bridge gets a wrong duty cycle.
const DUTY: &[Symptom] = &[
    Symptom::CurrentOff,
    Symptom::OverCurrent,
    Symptom::WrongWay,
    Symptom::SelfTest(0.504),
];
/// The duty cycle is scaled, which the 1 A of the self-test does not show.
const SHARE: &[Symptom] = &[Symptom::CurrentOff, Symptom::OverCurrent, Symptom::WrongWay];
/// The program counter or stack is lost; which monitor detects it first depends on the address.
const LOST: &[Fault] = &[
    Fault::HardFault,
    Fault::Panic,
    Fault::TickLost,
    Fault::Watchdog,
    Fault::Stack,
    Fault::Sampling,
];

/// Ticks at a wrong rate; the window watchdog is first if a tick is later than 47 ms.
const RATE: &[Fault] = &[Fault::Sampling, Fault::TickLost];
const CLOCK: &[Fault] = &[Fault::Clock, Fault::TickLost];
/// 4 of 5625 counts: a quarter of a tick is lost after 352 ticks.
const SLOW_RATE: &[Symptom] = &[Symptom::After(0.352)];
/// Longest timeout of the independent watchdog.
const WATCHDOG_TIMEOUT: &[Symptom] = &[Symptom::After(0.188)];
/// SysTick wraps every 2^24 periods of 180 MHz: 93.2 ms.
const SYSTICK_WRAP: &[Symptom] = &[Symptom::After(0.0933)];

const TIM1: u32 = 0x4001_0000;
const ADC1: u32 = 0x4001_2000;
const TIM2: u32 = 0x4000_0000;
const TIM2_ARR: u32 = TIM2 + 0x2c;
const SYST_CSR: u32 = 0xe000_e010;
const RCC_CFGR: u32 = 0x4002_3808;
const RCC_DCKCFGR: u32 = 0x4002_388c;
const GPIOB_ODR: u32 = 0x4002_0414;
const DMA2_S0CR: u32 = 0x4002_6410;
const NVIC_ISER0: u32 = 0xe000_e100;
const NVIC_ISER1: u32 = 0xe000_e104;
/// First word of the stack guard.
const STACK_GUARD: u32 = 0x2000_0000;

/// Faults of the processor.
pub const FAULT_CASES: &[FaultCase] = &[
    trips(processor(Fails::HungCore), NOW, &[Fault::TickLost]).at(&[FaultScene::Slew]),
    trips(processor(Fails::HseStopped), NOW, &[Fault::Clock]).at(&[FaultScene::Slew]),
    trips(
        processor(Fails::AdcStopped),
        NOW,
        &[Fault::TickLost, Fault::Sampling],
    )
    .at(&[FaultScene::Slew]),
    trips(
        processor(Fails::DmaStopped {
            controller: 2,
            stream: 0,
        }),
        NOW,
        &[Fault::Sampling, Fault::TickLost],
    )
    .at(&[FaultScene::Slew]),
    // In `Off`, the host arms the restarted device soon after.
    restarts(processor(Fails::BrownOut))
        .at(&[FaultScene::Slew])
        .never_at(&[FaultScene::Off]),
    restarts(processor(Fails::PowerCycle { seed: 1 }))
        .at(&[FaultScene::Slew])
        .never_at(&[FaultScene::Off]),
    restarts(processor(Fails::ResetPin))
        .at(&[FaultScene::Slew])
        .never_at(&[FaultScene::Off]),
    trips(processor(Fails::SoftwareReset), NOW, &[Fault::UnaskedReset]).at(&[FaultScene::Slew]),
    trips(processor(Fails::StackOverflow), NOW, LOST).at(&[FaultScene::Slew]),
    trips(
        processor(Fails::RamBit {
            address: STACK_GUARD,
            bit: 0,
        }),
        NOW,
        &[Fault::Stack],
    ),
    trips(core(CoreRegister::Pc, 20), NOW, LOST).at(&[FaultScene::Slew]),
    trips(core(CoreRegister::Sp, 28), NOW, LOST),
    harmless(core(CoreRegister::S(0), 30)),
    // Main output off; output of leg A off; period; prescaler; enable line; comparison of leg A.
    // The first current sets main output and enable line again.
    trips(flipped(TIM1 + 0x44, 15), DUTY, LEG_REASONS)
        .at(&[FaultScene::Slew])
        .never_at(&[FaultScene::Off]),
    trips(flipped(TIM1 + 0x20, 0), DUTY, LEG_REASONS).at(&[FaultScene::Slew]),
    trips(flipped(TIM1 + 0x2c, 10), SHARE, LEG_REASONS).at(&[FaultScene::Slew]),
    harmless(flipped(TIM1 + 0x28, 0)),
    trips(flipped(GPIOB_ODR, 10), DUTY, LEG_REASONS)
        .at(&[FaultScene::Slew])
        .never_at(&[FaultScene::Off]),
    harmless(flipped(TIM1 + 0x34, 10)),
    // Scans that are no longer started, converted, stored or taken.
    trips(flipped(TIM2, 0), NOW, &[Fault::TickLost, Fault::Sampling]),
    trips(
        flipped(ADC1 + 0x08, 0),
        NOW,
        &[Fault::TickLost, Fault::Sampling],
    ),
    trips(
        flipped(DMA2_S0CR, 0),
        NOW,
        &[Fault::TickLost, Fault::Sampling],
    ),
    trips(
        flipped(NVIC_ISER1, 24),
        NOW,
        &[Fault::TickLost, Fault::Sampling],
    ),
    // The task of the serial line is no longer called.
    trips(flipped(NVIC_ISER0, 6), WATCHDOG_TIMEOUT, &[Fault::Watchdog]),
    // Scans at another rate: 0.6 % slower and faster, 9 %, 3.7 times faster, 6.8, 24 and 48 times slower; half of it and less.
    trips(flipped(TIM2_ARR, 5), NOW, RATE),
    trips(flipped(TIM2_ARR, 2), SLOW_RATE, RATE),
    trips(flipped(TIM2_ARR, 9), NOW, RATE).at(&[FaultScene::Warm]),
    trips(flipped(TIM2_ARR, 12), NOW, RATE),
    trips(flipped(TIM2_ARR, 15), NOW, RATE).at(&[FaultScene::Warm]),
    trips(flipped(TIM2_ARR, 17), NOW, RATE),
    trips(flipped(TIM2_ARR, 18), NOW, RATE),
    trips(flipped(TIM2 + 0x28, 0), NOW, RATE).at(&[FaultScene::Warm]),
    trips(flipped(TIM2 + 0x28, 4), NOW, RATE),
    trips(flipped(TIM2 + 0x28, 15), NOW, RATE),
    // The reference of the rate monitor (SysTick): stopped, at an eighth, with a shorter period.
    trips(flipped(SYST_CSR, 0), NOW, RATE),
    trips(flipped(SYST_CSR, 2), NOW, RATE),
    trips(flipped(SYST_CSR + 4, 20), SYSTICK_WRAP, RATE),
    // Clocks of both, and of all else: half, the internal oscillator, timers at a quarter and at twice their rate.
    trips(flipped(RCC_CFGR, 7), NOW, CLOCK).at(&[FaultScene::Warm]),
    trips(flipped(RCC_CFGR, 1), NOW, CLOCK),
    trips(flipped(RCC_CFGR, 11), NOW, CLOCK).at(&[FaultScene::Warm]),
    trips(flipped(RCC_DCKCFGR, 24), NOW, RATE).at(&[FaultScene::Warm]),
];
