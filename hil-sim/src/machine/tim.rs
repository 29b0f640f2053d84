//! Timers 1 to 7 (RM0390 chapters 16, 17, 19): edge-aligned up-counting, preload, update events, output compare
//! flags, trigger output, PWM levels, and the main output enable with break of the advanced timer.
//!
//! The counter is not ticked: its value follows from the time of its last restart, and [`Tim::sync`] brings flags
//! and preloaded registers up to date. Capture, encoder, slave, centre-aligned and down-counting modes are refused.
/// What distinguishes one timer from another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kind {
    pub counter_max: u32,
    pub channels: usize,
    pub advanced: bool,
}

/// TIM1.
pub(crate) const ADVANCED: Kind = Kind {
    counter_max: 0xffff,
    channels: 4,
    advanced: true,
};
/// TIM2 and TIM5.
pub(crate) const WIDE: Kind = Kind {
    counter_max: u32::MAX,
    channels: 4,
    advanced: false,
};
/// TIM3 and TIM4.
pub(crate) const GENERAL: Kind = Kind {
    counter_max: 0xffff,
    channels: 4,
    advanced: false,
};
/// TIM6 and TIM7.
pub(crate) const BASIC: Kind = Kind {
    counter_max: 0xffff,
    channels: 0,
    advanced: false,
};

pub(super) const UIF: u32 = 1;
pub(super) const BIF: u32 = 1 << 7;
pub(super) const MOE: u32 = 1 << 15;
pub(super) const AOE: u32 = 1 << 14;
pub(super) const BKP: u32 = 1 << 13;
pub(super) const BKE: u32 = 1 << 12;
pub(super) const OSSR: u32 = 1 << 11;
pub(super) const OSSI: u32 = 1 << 10;

/// What a channel's output does to its pin (RM0390 16.4.9, output control bits).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Output {
    /// The timer does not drive the pin.
    Released,
    /// High for `high` of every `period` counter ticks.
    High { high: u32, period: u32 },
}

pub(crate) struct Tim {
    pub(super) kind: Kind,
    /// CPU cycles per timer clock.
    pub(super) divider: u64,
    pub(super) cr1: u32,
    pub(super) cr2: u32,
    pub(super) dier: u32,
    pub(super) sr: u32,
    pub(super) ccmr: [u32; 2],
    pub(super) ccer: u32,
    pub(super) psc: u32,
    pub(super) arr: u32,
    pub(super) rcr: u32,
    pub(super) ccr: [u32; 4],
    pub(super) bdtr: u32,
    pub(super) lock: u32,
    /// Active (shadow) registers.
    pub(super) psc_now: u32,
    pub(super) arr_now: u32,
    pub(super) ccr_now: [u32; 4],
    pub(super) repeats_left: u32,
    /// Cycle at which the counter was 0; meaningful while counting.
    pub(super) zero_at: u64,
    /// Counter while stopped.
    pub(super) stopped_at: u32,
    /// Flags are up to date to here.
    pub(super) seen: u64,
    /// Set by each update event that is a trigger output; taken by the owner.
    pub trigger: bool,
    /// Someone listens to the trigger output, so update events must not be skipped.
    pub(super) trigger_used: bool,
    /// Next cycle at which something visible happens.
    pub due: u64,
}

impl Tim {
    pub fn new(kind: Kind, divider: u64) -> Self {
        Self {
            kind,
            divider,
            cr1: 0,
            cr2: 0,
            dier: 0,
            sr: 0,
            ccmr: [0; 2],
            ccer: 0,
            psc: 0,
            arr: kind.counter_max,
            rcr: 0,
            ccr: [0; 4],
            bdtr: 0,
            lock: 0,
            psc_now: 0,
            arr_now: kind.counter_max,
            ccr_now: [0; 4],
            repeats_left: 0,
            zero_at: 0,
            stopped_at: 0,
            seen: 0,
            trigger: false,
            trigger_used: false,
            due: u64::MAX,
        }
    }

    /// Back to the reset values; the clock stays.
    pub fn reset(&mut self) {
        *self = Self {
            trigger_used: self.trigger_used,
            ..Self::new(self.kind, self.divider)
        };
    }

    /// Whether someone acts on the trigger output.
    pub fn listen(&mut self, used: bool, now: u64) {
        if used != self.trigger_used {
            self.sync(now);
            self.trigger = false;
            self.trigger_used = used;
            self.schedule();
        }
    }

    pub(super) fn is_counting(&self) -> bool {
        // 17.3.2: with auto-reload 0 the counter is blocked
        self.cr1 & 1 != 0 && self.arr_now != 0
    }

    fn tick(&self) -> u64 {
        self.divider * (u64::from(self.psc_now) + 1)
    }

    /// CPU cycles from one overflow to the next.
    pub fn period(&self) -> u64 {
        self.tick() * (u64::from(self.arr_now) + 1)
    }

    /// The timer clock changes at `now`; the count goes on from its value.
    pub fn set_divider(&mut self, divider: u64, now: u64) {
        if divider != self.divider {
            self.sync(now);
            let count = self.count(now);
            self.divider = divider;
            self.set_count(count, now);
            self.schedule();
        }
    }

    pub(super) fn count(&self, now: u64) -> u32 {
        if self.is_counting() {
            (now.wrapping_sub(self.zero_at) / self.tick()) as u32
        } else {
            self.stopped_at
        }
    }

    pub(super) fn set_count(&mut self, count: u32, now: u64) {
        self.stopped_at = count;
        self.zero_at = now.wrapping_sub(u64::from(count) * self.tick());
        self.seen = now;
    }

    /// Brings counter, flags and shadow registers up to `now`.
    pub fn sync(&mut self, now: u64) {
        while self.is_counting() {
            let overflow = self.zero_at.wrapping_add(self.period());
            self.compare_flags(now.min(overflow - 1));
            if now < overflow {
                break;
            }
            self.zero_at = overflow;
            self.seen = overflow - 1;
            if self.repeats_left > 0 {
                self.repeats_left -= 1;
            } else {
                self.update(true);
                if self.cr1 & 8 != 0 {
                    self.cr1 &= !1; // one-pulse mode
                    self.stopped_at = 0;
                } else if !self.is_preloading() && !self.trigger_used {
                    self.skip_whole_periods(now);
                }
            }
        }
        self.seen = self.seen.max(now);
        self.schedule();
    }

    /// Nothing but the flags changes from period to period: goes to the last one.
    fn skip_whole_periods(&mut self, now: u64) {
        let all = self.period() * u64::from(self.rcr + 1);
        let whole = (now - self.zero_at) / all;
        if whole > 0 {
            self.compare_flags(self.zero_at + self.period() - 1);
            self.zero_at += whole * all;
            self.seen = self.zero_at - 1;
        }
    }

    /// Sets CCxIF for every match in `(seen, to]` (17.3.8), `to` within the running period.
    fn compare_flags(&mut self, to: u64) {
        for channel in 0..self.kind.channels {
            let compare = self.ccr_now[channel];
            if compare <= self.arr_now {
                let matches = self.zero_at.wrapping_add(u64::from(compare) * self.tick());
                if matches > self.seen && matches <= to {
                    self.sr |= 2 << channel;
                }
            }
        }
        self.seen = self.seen.max(to);
    }

    fn is_preloading(&self) -> bool {
        self.psc != self.psc_now || self.arr != self.arr_now || self.ccr != self.ccr_now
    }

    /// Update event: shadow registers take the preload values.
    pub(super) fn update(&mut self, overflow: bool) {
        if self.cr1 & 2 != 0 {
            return; // UDIS
        }
        self.psc_now = self.psc;
        self.arr_now = self.arr;
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

    pub(super) fn schedule(&mut self) {
        self.due = u64::MAX;
        if !self.is_counting() {
            return;
        }
        let wants_update = self.dier & UIF != 0 && self.sr & UIF == 0
            || self.trigger_used && self.cr2 >> 4 & 7 == 2
            || self.cr1 & 8 != 0
            || self.bdtr & (AOE | MOE) == AOE
            || self.is_preloading();
        if wants_update {
            self.due = self
                .zero_at
                .wrapping_add(self.period() * (u64::from(self.repeats_left) + 1));
        }
        for channel in 0..self.kind.channels {
            let flag = 2 << channel;
            if self.dier & flag != 0 && self.sr & flag == 0 && self.ccr_now[channel] <= self.arr_now {
                let at = self
                    .zero_at
                    .wrapping_add(u64::from(self.ccr_now[channel]) * self.tick());
                self.due = self.due.min(if at > self.seen { at } else { at + self.period() });
            }
        }
    }

    /// Level of the break input; active at the polarity BKP selects (16.3.12). `true`: something changed.
    pub fn set_break(&mut self, level: bool) -> bool {
        let active = self.watches_break() && level == (self.bdtr & BKP != 0);
        let changes = active && (self.bdtr & MOE != 0 || self.sr & BIF == 0);
        if active {
            self.bdtr &= !MOE;
            self.sr |= BIF;
        }
        changes
    }

    /// The break input is enabled.
    pub fn watches_break(&self) -> bool {
        self.bdtr & BKE != 0
    }

    /// Interrupt requests: break, update, trigger, compare.
    pub fn requests(&self) -> [bool; 4] {
        let raised = self.sr & self.dier;
        [
            raised & BIF != 0,
            raised & UIF != 0,
            raised & 0x40 != 0,
            raised & 0x1e != 0,
        ]
    }

    /// What channel `channel` (0 is CH1) drives (16.4.9).
    pub fn output(&self, channel: usize) -> Output {
        let inverted = self.ccer >> (4 * channel + 1) & 1 != 0;
        let constant = |high: bool| Output::High {
            high: u32::from(high),
            period: 1,
        };
        if self.kind.advanced && self.bdtr & MOE == 0 {
            let idle = self.cr2 >> (8 + 2 * channel) & 1 != 0;
            let enabled = self.ccer >> (4 * channel) & 1 != 0;
            return if self.bdtr & OSSI != 0 && enabled {
                constant(idle)
            } else {
                Output::Released
            };
        }
        if self.ccer >> (4 * channel) & 1 == 0 {
            let held = self.kind.advanced && self.bdtr & OSSR != 0;
            return if held {
                constant(inverted)
            } else {
                Output::Released
            };
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
        Output::High {
            high: if inverted { period - high } else { high },
            period,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// TIM1 as the bridge's PWM: 180 MHz / 1800 = 100 kHz, preload, CH1 in PWM mode 1.
    fn pwm(bdtr: u32) -> Tim {
        let mut tim = Tim::new(ADVANCED, 1);
        for (offset, value) in [
            (0x2c, 1799),
            (0x34, 450),
            (0x18, 0x6868),
            (0x20, 0x11),
            (0x14, 1),
            (0x44, bdtr),
            (0x00, 0x81),
        ] {
            tim.write(offset, value, 0).unwrap();
        }
        tim
    }

    #[test]
    fn update_rate_is_clock_over_prescaler_and_reload() {
        let mut tim = Tim::new(WIDE, 2);
        tim.write(0x28, 8, 0).unwrap();
        tim.write(0x2c, 624, 0).unwrap();
        tim.write(0x14, 1, 0).unwrap();
        tim.write(0x10, 0, 0).unwrap();
        tim.write(0x0c, 1, 0).unwrap();
        tim.write(0x00, 1, 100).unwrap();
        assert_eq!(tim.due, 100 + 2 * 9 * 625);
        assert_eq!(tim.read(0x24, 100 + 2 * 9 * 10).unwrap(), 10);
        tim.sync(tim.due);
        assert_eq!(tim.requests(), [false, true, false, false]);
        assert_eq!(tim.read(0x24, 100 + 2 * 9 * 625).unwrap(), 0);
    }

    #[test]
    fn preloaded_compare_values_wait_for_the_update() {
        let mut tim = pwm(MOE);
        assert_eq!(
            tim.output(0),
            Output::High {
                high: 450,
                period: 1800
            }
        );
        tim.write(0x34, 900, 1000).unwrap();
        assert_eq!(
            tim.output(0),
            Output::High {
                high: 450,
                period: 1800
            }
        );
        assert_eq!(tim.due, 1800);
        tim.sync(1800);
        assert_eq!(
            tim.output(0),
            Output::High {
                high: 900,
                period: 1800
            }
        );
        assert_eq!(tim.due, u64::MAX, "nobody waits for the next update");
        tim.write(0x34, 5000, 1900).unwrap();
        tim.sync(3600);
        assert_eq!(
            tim.output(0),
            Output::High {
                high: 1800,
                period: 1800
            },
            "above ARR: always high"
        );
    }

    #[test]
    fn outputs_follow_the_output_control_bits() {
        assert_eq!(pwm(0).output(0), Output::Released, "MOE = 0, OSSI = 0");
        assert_eq!(
            pwm(OSSI).output(0),
            Output::High { high: 0, period: 1 },
            "idle level"
        );
        assert_eq!(pwm(MOE).output(2), Output::Released, "CC3E = 0, OSSR = 0");
        assert_eq!(
            pwm(MOE | OSSR).output(2),
            Output::High { high: 0, period: 1 },
            "inactive level"
        );
    }

    #[test]
    fn break_switches_the_outputs_off_and_holds_them() {
        let mut tim = pwm(MOE | BKE);
        assert!(!tim.set_break(true), "active low");
        assert!(tim.set_break(false));
        assert_eq!(tim.output(0), Output::Released);
        tim.write(0x44, MOE | BKE, 100).unwrap();
        assert!(
            tim.set_break(false),
            "MOE does not hold while the input is active"
        );
        assert_eq!(tim.output(0), Output::Released);
        tim.write(0x10, 0, 200).unwrap();
        tim.write(0x44, MOE | BKE, 200).unwrap();
        assert!(!tim.set_break(true));
        assert_eq!(
            tim.output(0),
            Output::High {
                high: 450,
                period: 1800
            }
        );
    }

    #[test]
    fn lock_level_1_keeps_the_break_configuration() {
        let mut tim = pwm(MOE | BKE | 1 << 8);
        tim.write(0x44, MOE | OSSR, 0).unwrap();
        assert_eq!(tim.read(0x44, 0).unwrap(), MOE | OSSR | BKE | 1 << 8);
    }

    #[test]
    fn compare_flags_rise_at_the_match() {
        let mut tim = pwm(MOE);
        assert_eq!(tim.read(0x10, 449).unwrap() & 2, 0);
        assert_eq!(tim.read(0x10, 450).unwrap() & 2, 2);
        tim.write(0x10, 0, 500).unwrap();
        assert_eq!(
            tim.read(0x10, 1800 * 100 + 300).unwrap() & 3,
            3,
            "a hundred periods later"
        );
    }

    #[test]
    fn one_pulse_mode_stops_at_the_update() {
        let mut tim = Tim::new(BASIC, 2);
        tim.write(0x2c, 99, 0).unwrap();
        tim.write(0x00, 9, 0).unwrap();
        assert_eq!(tim.read(0x00, 199).unwrap() & 1, 1);
        assert_eq!(
            (tim.read(0x00, 200).unwrap() & 1, tim.read(0x10, 200).unwrap()),
            (0, 1)
        );
    }

    #[test]
    fn other_modes_are_refused() {
        let mut tim = Tim::new(GENERAL, 2);
        assert!(tim.write(0x08, 3, 0).is_err(), "encoder");
        assert!(tim.write(0x18, 1, 0).is_err(), "input capture");
        assert!(tim.write(0x00, 0x20, 0).is_err(), "centre-aligned");
    }
}
