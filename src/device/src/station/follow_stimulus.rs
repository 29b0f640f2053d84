//! Holds and courses of one station: their commands, what starts and ends them, and their reference.

use contact_model::fixed_point::Celsius;

use super::{Event, State, Station};
use crate::TriggerEdge;
use crate::command::Refused;
use crate::estimate::PlateEstimateBeforeReading;
use crate::events::DeviceEventKind;
use crate::reference::Reference;
use crate::safety::Setpoint;
use crate::safety::limits::{
    SETPOINT_MAX, SETPOINT_MIN, UNTUNED_RATE_MAX_K_S, UNTUNED_SETPOINT_MAX, UNTUNED_SETPOINT_MIN,
};
use crate::stimulus::{
    Approach, Course, CourseChunk, CourseEnd, CourseStart, FOLLOWING_ERROR_REPORTED, Hold,
    PlayOrder, Player, Stimulus, StimulusTemperatures, TemperatureKind,
};

impl Station {
    /// Refuses what follows a set-point of the host, unless the display is driven and the self-test is over.
    fn require_driven(&self, command: &'static str) -> Result<(), Refused> {
        match self.state {
            State::Tripped(fault) => Err(Refused::Tripped(fault)),
            State::Off | State::SelfTest(_) | State::Ready => {
                Err(Refused::NeedsDrivenDisplay(command))
            }
            _ => Ok(()),
        }
    }

    /// Refuses set-points, °C, or a rate, K/s, that a tile which was never identified cannot be given.
    fn require_within_limits_of_untuned_tile<const N: usize>(
        &self,
        setpoints: [Celsius; N],
        rate_k_s: Celsius,
    ) -> Result<(), Refused> {
        if !self.reference_limits.are_of_untuned_tile() {
            return Ok(());
        }
        for celsius in setpoints {
            if !(UNTUNED_SETPOINT_MIN..=UNTUNED_SETPOINT_MAX).contains(&celsius) {
                return Err(Refused::UntunedRange(celsius));
            }
        }
        if rate_k_s > UNTUNED_RATE_MAX_K_S {
            return Err(Refused::UntunedRate(rate_k_s));
        }
        Ok(())
    }

    #[inline(never)]
    pub(super) fn execute_hold(
        &mut self,
        target: Setpoint,
        rate_k_s: Celsius,
    ) -> Result<(), Refused> {
        self.require_driven("hold")?;
        self.require_within_limits_of_untuned_tile([target.celsius()], rate_k_s)?;
        let follows_stimulus =
            self.stimulus_has_reference && matches!(self.state, State::Stimulus(_));
        let start = match self.last.reference {
            // A display that keeps up with its set-point goes on from there, because a slow thermistor lags behind it.
            Some(last) if follows_stimulus && !last.limited => last.setpoint.celsius(),
            _ => (self.last.readings.display).unwrap_or_else(|_| target.celsius()),
        };
        self.stimulate(&Stimulus::Hold(Hold::new(start, target, rate_k_s)));
        Ok(())
    }

    fn stimulate(&mut self, stimulus: &Stimulus) {
        self.stimulus_has_reference &= matches!(self.state, State::Stimulus(_));
        self.apply_known_event(Event::Stimulate(stimulus));
        self.identified.outcome = None;
    }

    #[inline(never)]
    pub(super) fn execute_load_course(
        &mut self,
        chunk: Option<CourseChunk<'_>>,
    ) -> Result<(), Refused> {
        match (chunk, &self.state) {
            // Also if a fault has tripped the station since the first chunk, because loading drives nothing.
            (Some(chunk), _) => self.courses.load_chunk(&chunk),
            (None, State::Tripped(fault)) => return Err(Refused::Tripped(*fault)),
            (None, _) => {}
        }
        Ok(())
    }

    #[inline(never)]
    pub(super) fn execute_play(&mut self, order: &PlayOrder) -> Result<(), Refused> {
        self.require_driven("play")?;
        let course = self.courses.loaded().ok_or(Refused::NoCourse)?;
        let base = self.base_of(course);
        let (smallest, largest) = course.extremes();
        let extremes = [smallest.saturating_add(base), largest.saturating_add(base)];
        for celsius in extremes {
            if !(SETPOINT_MIN..=SETPOINT_MAX).contains(&celsius) {
                return Err(Refused::CourseOutOfRange(celsius));
            }
        }
        self.require_within_limits_of_untuned_tile(extremes, course.fastest_k_s())?;
        let dose = course.dose(base).repeated_on_top_of(order.play_count, self.detectors.dose());
        if dose.reaches_limit() {
            return Err(Refused::CourseDose(dose));
        }
        let first = course.first_temperature().saturating_add(base);
        self.courses.play_loaded();
        self.stimulate(&Stimulus::Wait(*order, Approach::to(first)));
        Ok(())
    }

    /// What is added to the temperatures of a course now, °C.
    fn base_of(&self, course: &Course) -> Celsius {
        let before_contact = self.estimator.finger.temperatures_before_contact();
        match (course.temperature_kind(), before_contact) {
            (TemperatureKind::AboveSkin, Some(before_contact)) => before_contact.skin,
            // No estimate of the skin: the station has no valid readings, and the bridge is off.
            (TemperatureKind::AboveSkin, None) => self.last.readings.skin.ok().unwrap_or_default(),
            (TemperatureKind::Absolute, _) => Celsius::ZERO,
        }
    }

    /// Takes note of an edge at the trigger input, before the tick that reports it; a course that waits for it begins.
    #[inline(never)]
    pub fn note_trigger_edge(&mut self, edge: TriggerEdge) {
        let coming_tick = self.tick.wrapping_add(1);
        let tick = coming_tick.wrapping_sub(edge.ticks_ago.into());
        (self.events).note(DeviceEventKind::Trigger, tick, edge.us);
        if let State::Stimulus(Stimulus::Wait(order, _)) = &mut self.state
            && order.start == CourseStart::Trigger
        {
            order.start = CourseStart::Now;
        }
    }

    fn waits_for(&self, start: CourseStart) -> bool {
        matches!(&self.state, State::Stimulus(Stimulus::Wait(order, _)) if order.start == start)
    }

    /// Begins the course that waits, if one does, with `elapsed` ticks of it behind the next reference; `tick` is the one
    /// to which its time 0 belongs.
    fn begin_course(&mut self, elapsed: u32, tick: u32) {
        if let State::Stimulus(Stimulus::Wait(order, _)) = self.state {
            let course = self.courses.playing();
            let player = Player::new(course.points(), self.base_of(course), &order, elapsed);
            self.state = State::Stimulus(Stimulus::Play(player));
            self.events.note(DeviceEventKind::CourseStarted, tick, 0);
        }
    }

    /// Takes note of a finger that has landed, `landed_ticks` ago, or lifted.
    #[inline(never)]
    pub(super) fn note_touch_change(&mut self, touching: bool, landed_ticks: u32) {
        if !touching {
            self.events.note(DeviceEventKind::Lift, self.tick, 0);
            return;
        }
        let landed = self.tick.wrapping_sub(landed_ticks);
        self.events.note(DeviceEventKind::Land, landed, 0);
        if self.waits_for(CourseStart::Landing) {
            self.begin_course(landed_ticks, landed);
        }
    }

    /// Reference of the state stimulus. A course that ends moves on to what follows it.
    #[inline(never)]
    pub(super) fn reference_of_stimulus(
        &mut self,
        estimate: &PlateEstimateBeforeReading,
    ) -> Option<Reference> {
        if self.waits_for(CourseStart::Now) {
            self.begin_course(0, self.tick);
        }
        self.stimulus_has_reference = true;
        let course = self.courses.playing();
        let base = self.base_of(course);
        let State::Stimulus(stimulus) = &mut self.state else {
            return None;
        };
        let surface = estimate.previous_surface;
        let (temperatures, ended) = match stimulus {
            Stimulus::Hold(hold) => (hold.next_temperatures(surface), None),
            Stimulus::Wait(_, approach) => {
                let now = course.first_temperature().saturating_add(base);
                let target = approach.next_target(surface, now);
                (StimulusTemperatures { now, target }, None)
            }
            Stimulus::Play(player) => player.next_temperatures(course.points()),
        };
        if ended.is_some() {
            self.events.note(DeviceEventKind::CourseEnded, self.tick, 0);
        }
        match ended {
            None => {}
            Some(CourseEnd::Hold) => *stimulus = Stimulus::Hold(Hold::at(temperatures.now)),
            Some(CourseEnd::Neutral) => {
                self.apply_event(Event::EndNeutral);
            }
        }
        let StimulusTemperatures { now, target } = temperatures;
        let mut reference = Reference::limited_to_safe_range(now, target);
        reference.limited |= now.abs_diff(surface) > FOLLOWING_ERROR_REPORTED;
        Some(reference)
    }
}
