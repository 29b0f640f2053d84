//! Timers 1 to 8, 10 and 11 (RM0390 chapters 16 to 19): edge-aligned up-counting, preload, update events, output compare
//! flags, trigger output, PWM levels, and the main output enable with break of the advanced timer.
//!
//! The counter is not ticked: its value follows from the time of its last restart, and [`Tim::sync`] brings flags
//! and preloaded registers up to date. TIM3 and TIM4 may be started by TIM2. An input is captured without filter and prescaler. Encoder, slave, centre-aligned and
//! down-counting modes are refused, and so is capture with a filter, or from another channel's input.
mod registers;

/// Properties in which the timers differ.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Kind {
    pub counter_max: u32,
    pub channels: usize,
    pub advanced: bool,
}

impl Kind {
    const fn new(counter_max: u32, channels: usize, advanced: bool) -> Self {
        Self { counter_max, channels, advanced }
    }
}

/// TIM1 and TIM8.
pub(crate) const ADVANCED: Kind = Kind::new(0xffff, 4, true);
/// TIM2 and TIM5.
pub(crate) const WIDE: Kind = Kind::new(u32::MAX, 4, false);
/// TIM3 and TIM4.
pub(crate) const GENERAL: Kind = Kind::new(0xffff, 4, false);
/// TIM10 and TIM11.
pub(crate) const SINGLE: Kind = Kind::new(0xffff, 1, false);
/// TIM6 and TIM7.
pub(crate) const BASIC: Kind = Kind::new(0xffff, 0, false);

const UIF: u32 = 1;
const BIF: u32 = 1 << 7;
const MOE: u32 = 1 << 15;
const AOE: u32 = 1 << 14;
const BKP: u32 = 1 << 13;
const BKE: u32 = 1 << 12;
const OSSR: u32 = 1 << 11;
const OSSI: u32 = 1 << 10;
const LOCK: u32 = 3 << 8;

/// SMCR of TIM3 and TIM4: trigger mode, started by ITR1, which is TIM2's trigger output (17.4.3).
const STARTED_BY_TIM2: u32 = 0x16;

/// Output of a channel to its pin (RM0390 16.4.9, output control bits).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Output {
    /// The timer does not drive the pin.
    Released,
    /// High for `high` of every `period` counter ticks.
    High { high: u32, period: u32 },
}

#[derive(Default)]
pub(crate) struct Tim {
    kind: Kind,
    /// CPU cycles per timer clock.
    divider: u64,
    cr1: u32,
    cr2: u32,
    smcr: u32,
    dier: u32,
    sr: u32,
    ccmr: [u32; 2],
    ccer: u32,
    psc: u32,
    arr: u32,
    rcr: u32,
    ccr: [u32; 4],
    bdtr: u32,
    /// LOCK has been frozen by the first write of BDTR since the reset.
    bdtr_written: bool,
    /// A debugger has halted the core and DBGMCU stops this timer: the count stands still.
    halted: bool,
    /// Active (shadow) registers.
    psc_now: u32,
    arr_now: u32,
    /// Last count of the running period: the auto-reload value, or the counter's maximum if the count was already beyond that
    /// value when it was written.
    period_end: u32,
    ccr_now: [u32; 4],
    /// Level of each channel's input.
    inputs: [bool; 4],
    repeats_left: u32,
    /// Cycle at which the counter was 0; meaningful while counting.
    zero_at: u64,
    /// Counter while stopped.
    stopped_at: u32,
    /// Cycle up to which the flags are up to date.
    synced_to: u64,
    /// Set by each update event that is a trigger output; the chip clears it.
    pub trigger: bool,
    /// A peripheral uses the trigger output, so update events must not be skipped.
    trigger_is_used: bool,
    /// Cycle of the next event that software or another peripheral can observe.
    pub due: u64,
}

impl Tim {
    pub fn new(kind: Kind, divider: u64) -> Self {
        Self {
            kind,
            divider,
            arr: kind.counter_max,
            arr_now: kind.counter_max,
            period_end: kind.counter_max,
            due: u64::MAX,
            ..Self::default()
        }
    }

    /// Back to the reset values; the clock stays.
    pub fn reset(&mut self) {
        *self =
            Self { trigger_is_used: self.trigger_is_used, ..Self::new(self.kind, self.divider) };
    }

    /// Sets whether a peripheral uses the trigger output.
    pub fn use_trigger(&mut self, used: bool, now: u64) {
        if used != self.trigger_is_used {
            self.sync(now);
            self.trigger = false;
            self.trigger_is_used = used;
            self.schedule();
        }
    }

    fn is_counting(&self) -> bool {
        // 17.3.2: with auto-reload 0 the counter is blocked
        self.cr1 & 1 != 0 && self.arr_now != 0 && !self.halted
    }

    /// Stops the counter while a debugger halts the core, or lets it continue from the same count.
    pub fn set_halted(&mut self, halted: bool, now: u64) {
        if halted != self.halted {
            self.sync(now);
            let count = self.count(now);
            self.halted = halted;
            self.set_count(count, now);
            self.schedule();
        }
    }

    /// Whether the counter stands still while the core is halted.
    pub const fn is_halted(&self) -> bool {
        self.halted
    }

    /// Level of protection of the settings (LOCK).
    const fn lock(&self) -> u32 {
        self.bdtr >> 8 & 3
    }

    fn tick(&self) -> u64 {
        self.divider * (u64::from(self.psc_now) + 1)
    }

    /// CPU cycles from one overflow to the next.
    fn period(&self) -> u64 {
        self.tick() * (u64::from(self.arr_now) + 1)
    }

    /// Cycle at which the running period ends.
    fn overflow(&self) -> u64 {
        let counts = u64::from(self.period_end) + 1;
        self.zero_at.wrapping_add(self.tick() * counts)
    }

    /// Changes the timer clock at `now`; the count is kept.
    pub fn set_divider(&mut self, divider: u64, now: u64) {
        if divider != self.divider {
            self.sync(now);
            let count = self.count(now);
            self.divider = divider;
            self.set_count(count, now);
            self.schedule();
        }
    }

    fn count(&self, now: u64) -> u32 {
        if self.is_counting() {
            (now.wrapping_sub(self.zero_at) / self.tick()) as u32
        } else {
            self.stopped_at
        }
    }

    fn set_count(&mut self, count: u32, now: u64) {
        self.stopped_at = count;
        self.zero_at = now.wrapping_sub(u64::from(count) * self.tick());
        self.period_end = if count > self.arr_now { self.kind.counter_max } else { self.arr_now };
        self.synced_to = now;
    }

    /// Brings counter, flags and shadow registers up to `now`.
    pub fn sync(&mut self, now: u64) {
        while self.is_counting() {
            let overflow = self.overflow();
            self.compare_flags(now.min(overflow - 1));
            if now < overflow {
                break;
            }
            self.zero_at = overflow;
            self.period_end = self.arr_now;
            self.synced_to = overflow - 1;
            if self.repeats_left > 0 {
                self.repeats_left -= 1;
            } else {
                self.update(true);
                if self.cr1 & 8 != 0 {
                    self.cr1 &= !1; // one-pulse mode
                    self.stopped_at = 0;
                } else if !self.is_preloading() && !self.trigger_is_used {
                    self.skip_whole_periods(now);
                }
            }
        }
        self.synced_to = self.synced_to.max(now);
        self.schedule();
    }

    /// Skips to the last whole period before `now`, where periods differ in their flags only.
    fn skip_whole_periods(&mut self, now: u64) {
        let all = self.period() * u64::from(self.rcr + 1);
        let whole = (now - self.zero_at) / all;
        if whole > 0 {
            self.compare_flags(self.zero_at + self.period() - 1);
            self.zero_at += whole * all;
            self.synced_to = self.zero_at - 1;
        }
    }

    /// Sets CCxIF for every match in `(synced_to, to]` (17.3.8), `to` within the running period.
    fn compare_flags(&mut self, to: u64) {
        for channel in 0..self.kind.channels {
            let compare = self.ccr_now[channel];
            if compare <= self.period_end && !self.is_capturing(channel) {
                let matches = self.zero_at.wrapping_add(u64::from(compare) * self.tick());
                if matches > self.synced_to && matches <= to {
                    self.sr |= 2 << channel;
                }
            }
        }
        self.synced_to = self.synced_to.max(to);
    }

    fn is_preloading(&self) -> bool {
        self.psc != self.psc_now || self.arr != self.arr_now || self.ccr != self.ccr_now
    }

    /// Update event: shadow registers take the preload values.
    fn update(&mut self, overflow: bool) {
        if self.cr1 & 2 != 0 {
            return; // UDIS
        }
        self.psc_now = self.psc;
        self.arr_now = self.arr;
        self.period_end = self.arr_now;
        self.ccr_now = self.ccr;
        self.repeats_left = self.rcr;
        if overflow || self.cr1 & 4 == 0 {
            self.sr |= UIF;
        }
        if self.bdtr & (AOE | MOE) == AOE {
            self.bdtr |= MOE;
        }
        self.trigger |= self.cr2 >> 4 & 7 == 2;
    }

    fn schedule(&mut self) {
        self.due = u64::MAX;
        if !self.is_counting() {
            return;
        }
        let wants_update = self.dier & UIF != 0 && self.sr & UIF == 0
            || self.trigger_is_used && self.cr2 >> 4 & 7 == 2
            || self.cr1 & 8 != 0
            || self.bdtr & (AOE | MOE) == AOE
            || self.is_preloading();
        if wants_update {
            self.due = self.overflow().wrapping_add(self.period() * u64::from(self.repeats_left));
        }
        for channel in 0..self.kind.channels {
            let flag = 2 << channel;
            let matches = self.ccr_now[channel] <= self.arr_now && !self.is_capturing(channel);
            if self.dier & flag != 0 && self.sr & flag == 0 && matches {
                let at = self.zero_at.wrapping_add(u64::from(self.ccr_now[channel]) * self.tick());
                let next = self.overflow() + (at - self.zero_at);
                self.due = self.due.min(if at > self.synced_to { at } else { next });
            }
        }
    }

    /// Sets the level of the break input, active at the polarity that BKP selects (16.3.12). `true`: outputs or flags changed.
    pub fn set_break(&mut self, level: bool) -> bool {
        let active = self.watches_break() && level == (self.bdtr & BKP != 0);
        let changes = active && (self.bdtr & MOE != 0 || self.sr & BIF == 0);
        if active {
            self.bdtr &= !MOE;
            self.sr |= BIF;
        }
        changes
    }

    /// Handles a failure reported by the clock security system: a break if breaks are enabled (16.3.12). `true`: they are.
    pub fn clock_failed(&mut self) -> bool {
        let breaks = self.watches_break();
        if breaks {
            self.bdtr &= !MOE;
            self.sr |= BIF;
        }
        breaks
    }

    /// Whether the break input is enabled.
    pub fn watches_break(&self) -> bool {
        self.bdtr & BKE != 0
    }

    /// Whether TIM2's trigger output starts the counter.
    pub const fn is_started_by_tim2(&self) -> bool {
        self.smcr == STARTED_BY_TIM2
    }

    /// Starts the counter, as the trigger input does in trigger mode (17.3.14).
    pub fn start(&mut self, now: u64) {
        if self.cr1 & 1 == 0 {
            let count = self.count(now);
            self.cr1 |= 1;
            self.set_count(count, now);
            self.schedule();
        }
    }

    /// Whether a channel is an input (CCxS, 17.4.7).
    fn is_capturing(&self, channel: usize) -> bool {
        self.ccmr[channel / 2] >> (8 * (channel % 2)) & 3 != 0
    }

    /// Sets the level of a channel's input. The selected edge stores the count, and sets CCxIF, or CCxOF as well if CCxIF is
    /// still set (17.3.5). `true`: it was such an edge.
    pub fn set_input(&mut self, channel: usize, level: bool, now: u64) -> bool {
        if std::mem::replace(&mut self.inputs[channel], level) == level {
            return false;
        }
        let selection = self.ccer >> (4 * channel) & 3;
        let selected = selection == if level { 1 } else { 3 };
        if !selected || !self.is_capturing(channel) {
            return false;
        }
        self.sync(now);
        let flag = 2 << channel;
        if self.sr & flag != 0 {
            self.sr |= flag << 8;
        }
        self.sr |= flag;
        self.ccr[channel] = self.count(now);
        self.ccr_now[channel] = self.ccr[channel];
        true
    }

    /// Interrupt requests: break, update, trigger, compare.
    pub fn requests(&self) -> [bool; 4] {
        let raised = self.sr & self.dier;
        [raised & BIF != 0, raised & UIF != 0, raised & 0x40 != 0, raised & 0x1e != 0]
    }

    /// Output of a channel, 0 is CH1 (16.4.9).
    pub fn output(&self, channel: usize) -> Output {
        let inverted = self.ccer >> (4 * channel + 1) & 1 != 0;
        let constant_if = |driven: bool, high: bool| match driven {
            true => Output::High { high: u32::from(high), period: 1 },
            false => Output::Released,
        };
        if self.is_capturing(channel) {
            return Output::Released;
        }
        let enabled = self.ccer >> (4 * channel) & 1 != 0;
        // A halted timer with complementary outputs disables its outputs as if MOE were 0 (RM0090 38.16.2).
        if self.kind.advanced && (self.bdtr & MOE == 0 || self.halted) {
            let idle = self.cr2 >> (8 + 2 * channel) & 1 != 0;
            return constant_if(self.bdtr & OSSI != 0 && enabled, idle);
        }
        if !enabled {
            return constant_if(self.kind.advanced && self.bdtr & OSSR != 0, inverted);
        }
        let period = self.arr_now.saturating_add(1);
        let below = self.ccr_now[channel].min(period);
        let mode = self.ccmr[channel / 2] >> (8 * (channel % 2) + 4) & 7;
        let high = match mode {
            6 => below,
            7 => period - below,
            5 => period,
            _ => 0, // forced inactive; frozen at the reset level
        };
        Output::High { high: if inverted { period - high } else { high }, period }
    }

    /// Level of a driven channel at the count of `now`; PWM mode 2 is high from the match on (16.3.10).
    pub fn is_high(&self, channel: usize, now: u64) -> bool {
        let Output::High { high, period } = self.output(channel) else {
            return false;
        };
        if period == 1 {
            return high == 1;
        }
        let inverted = self.ccer >> (4 * channel + 1) & 1 != 0;
        let mode_2 = self.ccmr[channel / 2] >> (8 * (channel % 2) + 4) & 7 == 7;
        let count = self.count(now);
        if inverted != mode_2 { count >= period - high } else { count < high }
    }
}

#[cfg(test)]
mod tests;
