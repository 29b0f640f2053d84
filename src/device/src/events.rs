//! Events of a finger's station: what the host is told at once, and what the trigger output marks.

use thermal_settings::vocabulary;

use crate::command::WithSourceFinger;
use crate::telemetry::Telemetry;

/// Length of a pulse at the trigger output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriggerPulse {
    /// Length, ms, above 0.
    pub ms: u8,
}

impl Default for TriggerPulse {
    /// Recorders that sample at 250 Hz or more see it.
    fn default() -> Self {
        Self { ms: 10 }
    }
}

/// Events that are kept until they are fetched; a tick has at most four.
const EVENTS_KEPT_MAX: usize = 8;
// The counts of the ring wrap at 256.
const _: () = assert!(256 % EVENTS_KEPT_MAX == 0);

vocabulary! {
    /// What happened.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum DeviceEventKind: "event" {
        /// A finger has landed.
        Land = "land",
        /// The finger has lifted.
        Lift = "lift",
        /// A course has started.
        CourseStarted = "start",
        /// A course has ended by itself, after its last repetition.
        CourseEnded = "end",
        /// An edge at the trigger input.
        Trigger = "trigger",
        /// What is known of the finger by its heat flux has changed.
        FingerKnowledge = "flux",
    }
}

/// A set of kinds of events.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EventKinds(u8);

impl EventKinds {
    /// None.
    pub const NONE: Self = Self(0);

    /// The set with this kind, too.
    #[must_use]
    pub const fn with(self, kind: DeviceEventKind) -> Self {
        Self(self.0 | 1 << kind as u8)
    }

    /// Whether the kind is in the set.
    pub const fn contains(self, kind: DeviceEventKind) -> bool {
        self.0 & 1 << kind as u8 != 0
    }
}

/// An event with its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceEvent {
    /// Number of the tick: ticks of 1 ms since reset.
    pub tick: u32,
    /// Time since the start of the first of that tick's scans, µs, 0 to 999; 0 for all but the edge at the trigger input.
    pub microseconds: u16,
    /// What happened.
    pub kind: DeviceEventKind,
}

/// What a device sends to the host without being asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UnsolicitedReport {
    /// Telemetry of a tick.
    Telemetry(Telemetry),
    /// An event.
    Event(DeviceEvent),
}

impl WithSourceFinger<Telemetry> {
    /// The telemetry as one of the reports.
    pub fn into_report(self) -> WithSourceFinger<UnsolicitedReport> {
        self.map_content(UnsolicitedReport::Telemetry)
    }
}

/// Events that were not fetched yet, and the pulse at the trigger output.
#[derive(Clone, Debug, Default)]
pub struct EventReporter {
    /// Whether the host wants events; off until it says so.
    reports: bool,
    /// Events that give a pulse at the trigger output.
    pub marked: EventKinds,
    /// Length of such a pulse.
    pub pulse: TriggerPulse,
    pulse_ticks_left: u8,
    /// A ring; a queue with a loop or a `memmove` would be code of the control path to argue for.
    kept: [Option<DeviceEvent>; EVENTS_KEPT_MAX],
    /// Number of events fetched so far; the oldest one is at this place of the ring.
    first: u8,
    /// Number of events kept so far; the next one goes to this place of the ring.
    end: u8,
}

impl EventReporter {
    /// Switches the reports on or off. Switched off, the events that were not fetched are dropped.
    pub fn switch_reports(&mut self, on: bool) {
        self.reports = on;
        if !on {
            self.kept = [None; EVENTS_KEPT_MAX];
            self.first = self.end;
        }
    }

    /// Takes note of an event. It is dropped if nobody has fetched the ones before.
    #[inline(never)]
    pub fn note(&mut self, kind: DeviceEventKind, tick: u32, microseconds: u16) {
        if self.marked.contains(kind) {
            self.pulse_ticks_left = self.pulse.ms;
        }
        let place = &mut self.kept[usize::from(self.end) % EVENTS_KEPT_MAX];
        if self.reports && place.is_none() {
            *place = Some(DeviceEvent { tick, microseconds, kind });
            self.end = self.end.wrapping_add(1);
        }
    }

    /// The oldest event that was not fetched.
    pub fn take(&mut self) -> Option<DeviceEvent> {
        let oldest = self.kept[usize::from(self.first) % EVENTS_KEPT_MAX].take()?;
        self.first = self.first.wrapping_add(1);
        Some(oldest)
    }

    /// Whether an event was not fetched yet.
    pub const fn has_event(&self) -> bool {
        self.first != self.end
    }

    /// Whether the trigger output is high until the next tick; to be called once a tick.
    pub const fn next_trigger_output(&mut self) -> bool {
        self.pulse_ticks_left > 0 && self.count_pulse_tick()
    }

    #[cold]
    #[inline(never)]
    const fn count_pulse_tick(&mut self) -> bool {
        self.pulse_ticks_left -= 1;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_are_kept_in_order_only_while_they_are_reported() {
        let mut reporter = EventReporter::default();
        reporter.note(DeviceEventKind::Land, 1, 0);
        assert_eq!(reporter.take(), None);
        reporter.switch_reports(true);
        for tick in 0..20 {
            reporter.note(DeviceEventKind::Trigger, tick, 7);
        }
        for tick in 0..8 {
            let event = DeviceEvent { tick, microseconds: 7, kind: DeviceEventKind::Trigger };
            assert_eq!(reporter.take(), Some(event));
        }
        assert_eq!(reporter.take(), None);
    }

    #[test]
    fn events_that_were_not_fetched_are_dropped_when_reports_are_switched_off() {
        let mut reporter = EventReporter::default();
        reporter.switch_reports(true);
        for tick in 0..3 {
            reporter.note(DeviceEventKind::Land, tick, 0);
        }
        assert!(reporter.take().is_some() && reporter.has_event());
        reporter.switch_reports(false);
        assert!(!reporter.has_event());
        reporter.switch_reports(true);
        assert_eq!(reporter.take(), None);
        reporter.note(DeviceEventKind::Lift, 9, 0);
        let kind = reporter.take().map(|event| event.kind);
        assert_eq!(kind, Some(DeviceEventKind::Lift));
        assert!(!reporter.has_event());
    }

    #[test]
    fn a_marked_event_gives_a_pulse_of_the_chosen_length_and_another_one_none() {
        let mut reporter = EventReporter {
            marked: EventKinds::NONE.with(DeviceEventKind::CourseEnded),
            ..EventReporter::default()
        };
        for (kind, pulse, ticks) in [
            (DeviceEventKind::CourseStarted, TriggerPulse::default(), 0),
            (DeviceEventKind::CourseEnded, TriggerPulse::default(), 10),
            (DeviceEventKind::CourseEnded, TriggerPulse { ms: 1 }, 1),
            (DeviceEventKind::CourseEnded, TriggerPulse { ms: 200 }, 200),
        ] {
            reporter.pulse = pulse;
            reporter.note(kind, 5, 0);
            let high = (0..300).filter(|_| reporter.next_trigger_output()).count();
            assert_eq!(high, ticks, "{kind:?}");
        }
    }
}
