//! Nested vectored interrupt controller: pending, enabled and active exceptions and their priorities
//! (ARMv7-M Architecture Reference Manual B1.5, B3.4). Exceptions are numbered as in IPSR; 16 is interrupt 0.
use super::stop::{Answer, Refusal, only};

/// Exceptions of the STM32F446: 16 of the core, 97 interrupts (RM0390 vector table).
pub(crate) const EXCEPTIONS: usize = 16 + 97;
/// Priority below every exception: nothing is active and nothing is masked.
pub(crate) const THREAD_PRIORITY: i32 = 256;

/// Priority of the non-maskable interrupt.
pub(crate) const NMI_PRIORITY: i32 = -2;

/// Exception numbers of the core.
pub(crate) mod exception {
    pub const NMI: usize = 2;
    pub const HARD_FAULT: usize = 3;
    pub const MEM_MANAGE: usize = 4;
    pub const BUS_FAULT: usize = 5;
    pub const USAGE_FAULT: usize = 6;
    pub const SVCALL: usize = 11;
    pub const PENDSV: usize = 14;
    pub const SYSTICK: usize = 15;
}

const INTERRUPT_NAMES: [&str; 97] = [
    "WWDG",
    "PVD",
    "TAMP_STAMP",
    "RTC_WKUP",
    "FLASH",
    "RCC",
    "EXTI0",
    "EXTI1",
    "EXTI2",
    "EXTI3",
    "EXTI4",
    "DMA1_STREAM0",
    "DMA1_STREAM1",
    "DMA1_STREAM2",
    "DMA1_STREAM3",
    "DMA1_STREAM4",
    "DMA1_STREAM5",
    "DMA1_STREAM6",
    "ADC",
    "CAN1_TX",
    "CAN1_RX0",
    "CAN1_RX1",
    "CAN1_SCE",
    "EXTI9_5",
    "TIM1_BRK_TIM9",
    "TIM1_UP_TIM10",
    "TIM1_TRG_COM_TIM11",
    "TIM1_CC",
    "TIM2",
    "TIM3",
    "TIM4",
    "I2C1_EV",
    "I2C1_ER",
    "I2C2_EV",
    "I2C2_ER",
    "SPI1",
    "SPI2",
    "USART1",
    "USART2",
    "USART3",
    "EXTI15_10",
    "RTC_ALARM",
    "OTG_FS_WKUP",
    "TIM8_BRK_TIM12",
    "TIM8_UP_TIM13",
    "TIM8_TRG_COM_TIM14",
    "TIM8_CC",
    "DMA1_STREAM7",
    "FMC",
    "SDIO",
    "TIM5",
    "SPI3",
    "UART4",
    "UART5",
    "TIM6_DAC",
    "TIM7",
    "DMA2_STREAM0",
    "DMA2_STREAM1",
    "DMA2_STREAM2",
    "DMA2_STREAM3",
    "DMA2_STREAM4",
    "61",
    "62",
    "CAN2_TX",
    "CAN2_RX0",
    "CAN2_RX1",
    "CAN2_SCE",
    "OTG_FS",
    "DMA2_STREAM5",
    "DMA2_STREAM6",
    "DMA2_STREAM7",
    "USART6",
    "I2C3_EV",
    "I2C3_ER",
    "OTG_HS_EP1_OUT",
    "OTG_HS_EP1_IN",
    "OTG_HS_WKUP",
    "OTG_HS",
    "DCMI",
    "79",
    "80",
    "FPU",
    "82",
    "83",
    "SPI4",
    "85",
    "86",
    "SAI1",
    "88",
    "89",
    "90",
    "SAI2",
    "QUADSPI",
    "HDMI_CEC",
    "SPDIF_RX",
    "FMPI2C1",
    "FMPI2C1_ER",
];

/// Name of an exception as the reference manual's vector table has it.
pub(crate) fn name(exception: usize) -> &'static str {
    match exception {
        0 => "Thread",
        1 => "Reset",
        2 => "NMI",
        3 => "HardFault",
        4 => "MemManage",
        5 => "BusFault",
        6 => "UsageFault",
        11 => "SVCall",
        12 => "DebugMonitor",
        14 => "PendSV",
        15 => "SysTick",
        n => n.checked_sub(16).and_then(|irq| INTERRUPT_NAMES.get(irq)).copied().unwrap_or("?"),
    }
}

/// State of the controller.
pub(crate) struct Nvic {
    pending: u128,
    enabled: u128,
    active: u128,
    lines: u128,
    priority: [u8; EXCEPTIONS],
    pended_at: [u64; EXCEPTIONS],
    best: Option<(usize, i32)>,
    active_priority: i32,
    /// AIRCR.PRIGROUP: the priority bits up to this one do not decide about preemption.
    group: u8,
}

impl Nvic {
    pub fn new() -> Self {
        Self {
            pending: 0,
            enabled: 0xffff, // faults are gated by SHCSR where they are raised, the rest cannot be disabled
            active: 0,
            lines: 0,
            priority: [0; EXCEPTIONS],
            pended_at: [0; EXCEPTIONS],
            best: None,
            active_priority: THREAD_PRIORITY,
            group: 0,
        }
    }

    /// AIRCR.PRIGROUP.
    pub const fn group(&self) -> u8 {
        self.group
    }

    pub fn set_group(&mut self, group: u8) {
        self.group = group & 7;
        self.refresh_active();
    }

    /// A configurable priority without its subpriority (B1.5.4).
    const fn without_subpriority(&self, priority: i32) -> i32 {
        if priority < 0 {
            return priority;
        }
        priority & !((2 << self.group) - 1)
    }

    /// Priority of an exception as a number; lower is more urgent.
    pub fn priority_of(&self, exception: usize) -> i32 {
        match exception {
            1 => -3,
            exception::NMI => NMI_PRIORITY,
            exception::HARD_FAULT => -1,
            n => self.priority.get(n).map_or(THREAD_PRIORITY, |p| i32::from(*p)),
        }
    }

    /// Most urgent enabled pending exception; the lowest number wins among equals (B1.5.4).
    #[inline]
    pub fn best(&self) -> Option<(usize, i32)> {
        self.best
    }

    /// Whether a pending exception is more urgent than the active ones; the mask registers may still block it.
    #[inline]
    pub fn may_preempt(&self) -> bool {
        self.best.is_some_and(|(_, priority)| priority < self.active_priority)
    }

    /// Most urgent priority among the active exceptions.
    #[inline]
    pub fn active_priority(&self) -> i32 {
        self.active_priority
    }

    /// Execution priority with the mask registers applied (B1.5.4).
    pub fn execution_priority(&self, primask: u32, basepri: u32, faultmask: u32) -> i32 {
        let mut priority = self.active_priority;
        if basepri & 0xf0 != 0 {
            priority = priority.min(self.without_subpriority((basepri & 0xf0) as i32));
        }
        if primask & 1 != 0 {
            priority = priority.min(0);
        }
        if faultmask & 1 != 0 {
            priority = priority.min(-1);
        }
        priority
    }

    fn refresh_best(&mut self) {
        let mut left = self.pending & self.enabled;
        self.best = None;
        while left != 0 {
            let n = left.trailing_zeros() as usize;
            left &= left - 1;
            let priority = self.priority_of(n);
            if self.best.is_none_or(|(_, p)| priority < p) {
                self.best = Some((n, priority));
            }
        }
    }

    fn refresh_active(&mut self) {
        let mut left = self.active;
        self.active_priority = THREAD_PRIORITY;
        while left != 0 {
            let n = left.trailing_zeros() as usize;
            left &= left - 1;
            let priority = self.without_subpriority(self.priority_of(n));
            self.active_priority = self.active_priority.min(priority);
        }
    }

    /// Makes an exception pending at `now`.
    pub fn pend(&mut self, exception: usize, now: u64) {
        if self.pending >> exception & 1 == 0 {
            self.pending |= 1 << exception;
            self.pended_at[exception] = now;
            self.refresh_best();
        }
    }

    pub fn unpend(&mut self, exception: usize) {
        self.pending &= !(1 << exception) | self.lines;
        self.refresh_best();
    }

    pub fn is_pending(&self, exception: usize) -> bool {
        self.pending >> exception & 1 != 0
    }

    pub fn is_active(&self, exception: usize) -> bool {
        self.active >> exception & 1 != 0
    }

    /// Level of a peripheral's interrupt request; a rising level pends.
    #[inline]
    pub fn set_line(&mut self, irq: usize, level: bool, now: u64) {
        self.set_exception_line(16 + irq, level, now);
    }

    /// Level of the request for an exception, such as the NMI; a rising level pends.
    #[inline]
    pub fn set_exception_line(&mut self, exception: usize, level: bool, now: u64) {
        let bit = 1 << exception;
        if level != (self.lines & bit != 0) {
            self.lines ^= bit;
            if level {
                self.pend(exception, now);
            }
        }
    }

    /// Exception entry: pending becomes active. Returns when it was pended.
    pub fn enter(&mut self, exception: usize) -> u64 {
        self.pending &= !(1 << exception);
        self.active |= 1 << exception;
        self.refresh_best();
        self.refresh_active();
        self.pended_at[exception]
    }

    /// Whether `exception`, which is being entered, gives way to a more urgent one.
    pub fn late_arrival(&self, exception: usize) -> Option<usize> {
        let level = self.without_subpriority(self.priority_of(exception));
        self.best.filter(|(_, priority)| *priority < level).map(|(n, _)| n)
    }

    /// Number of active exceptions.
    pub const fn active_count(&self) -> u32 {
        self.active.count_ones()
    }

    /// Exception return: an interrupt whose request line is still up pends again (B3.4.1).
    pub fn leave(&mut self, exception: usize, now: u64) {
        self.active &= !(1 << exception);
        if self.lines >> exception & 1 != 0 {
            self.pend(exception, now);
        }
        self.refresh_active();
    }

    /// ICSR as read (B3.2.4); `current` is IPSR.
    pub fn icsr(&self, current: u32) -> u32 {
        let pending = |n: usize| u32::from(self.is_pending(n));
        let vectpending = self.best.map_or(0, |(n, _)| n as u32);
        let isr_pending = u32::from(self.pending >> 16 != 0);
        let others_active = self.active & !(1u128 << current.min(127)) != 0;
        current
            | u32::from(!others_active) << 11
            | vectpending << 12
            | isr_pending << 22
            | pending(exception::SYSTICK) << 26
            | pending(exception::PENDSV) << 28
            | pending(exception::NMI) << 31
    }

    /// ICSR as written.
    pub fn set_icsr(&mut self, value: u32, now: u64) {
        for (bit, n) in [(31, exception::NMI), (28, exception::PENDSV), (26, exception::SYSTICK)] {
            if value >> bit & 1 != 0 {
                self.pend(n, now);
            }
        }
        for (bit, n) in [(27, exception::PENDSV), (25, exception::SYSTICK)] {
            if value >> bit & 1 != 0 {
                self.unpend(n);
            }
        }
    }

    /// One byte of SHPR1..3: `n` is the exception; the bytes of exceptions that do not exist are reserved.
    pub fn set_system_priority(&mut self, n: usize, value: u8) {
        if matches!(n, 4..=6 | 11 | 12 | 14 | 15) {
            self.set_priority(n, value);
        }
    }

    fn set_priority(&mut self, n: usize, value: u8) {
        if let Some(priority) = self.priority.get_mut(n) {
            *priority = value & 0xf0; // the STM32F4 implements four bits
        }
        self.refresh_best();
        self.refresh_active();
    }

    /// Four priority bytes from exception `n` on.
    pub fn priority_word(&self, n: usize) -> u32 {
        (0..4).map(|i| u32::from(self.priority.get(n + i).copied().unwrap_or(0)) << (8 * i)).sum()
    }

    /// Registers at 0xE000E100..0xE000E4FF.
    pub fn read(&self, offset: u32) -> Answer<u32> {
        let word = |set: u128| (set >> (16 + 32 * (offset >> 2 & 7))) as u32;
        match offset {
            0x100..0x120 | 0x180..0x1a0 if offset & 0x1f < 16 => Ok(word(self.enabled)),
            0x200..0x220 | 0x280..0x2a0 if offset & 0x1f < 16 => Ok(word(self.pending)),
            0x300..0x320 if offset & 0x1f < 16 => Ok(word(self.active)),
            0x400..0x464 => Ok(self.priority_word((offset - 0x400 + 16) as usize)),
            _ => Err(Refusal::Offset),
        }
    }

    /// Writes to the same registers; priorities also by bytes.
    pub fn write(&mut self, offset: u32, bytes: u8, value: u32, now: u64) -> Answer<()> {
        if (0x400..0x464).contains(&offset) {
            for i in 0..u32::from(bytes) {
                self.set_priority((offset - 0x400 + 16 + i) as usize, (value >> (8 * i)) as u8);
            }
            return Ok(());
        }
        if bytes != 4 {
            return Err(Refusal::Width);
        }
        if !(0x100..0x300).contains(&offset) || offset & 0x7f >= 16 {
            return Err(Refusal::Offset);
        }
        let word = offset >> 2 & 7;
        only(value, if word == 3 { 1 } else { u32::MAX }, "an interrupt above 96")?;
        let set = u128::from(value) << (16 + 32 * word);
        match offset & 0x380 {
            0x100 => self.enabled |= set,
            0x180 => self.enabled &= !set,
            0x200 => {
                for n in (16..EXCEPTIONS).filter(|n| set >> n & 1 != 0) {
                    self.pend(n, now);
                }
            }
            _ => self.pending &= !set | self.lines,
        }
        self.refresh_best();
        Ok(())
    }
}
