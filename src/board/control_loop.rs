//! The control loop: from a finger's samples to its bridge, once a tick and finger.

use core::sync::atomic::{AtomicBool, Ordering};

use heapless::spsc::Producer;
use thermal_display::device::command::WithSourceFinger;
use thermal_display::device::events::UnsolicitedReport;
use thermal_display::device::safety::Fault;
use thermal_display::device::sense::{DigitalInputs, Samples};
use thermal_display::device::{DeviceInPlace, FingerIndex};

use super::{
    ChipMonitor, ComparatorSide, EmergencyStop, FINGERS, FingerPowerStage, FluxConverter,
    SampleError, Sampler, TriggerInput, TriggerOutput, TripCauseRecorder, WindowWatchdog,
    line_losses, save_dose_if_changed, stack_is_overrun,
};

/// Executes the control ticks of all fingers: samples the sensors, computes each finger's outputs,
/// and drives the bridges. Owns the hardware that this needs.
pub struct ControlLoop {
    pub sampler: Sampler,
    pub flux_converter: FluxConverter,
    pub stages: [FingerPowerStage; FINGERS],
    pub comparator_side: ComparatorSide,
    pub emergency_stop: EmergencyStop,
    pub trigger_input: TriggerInput,
    pub trigger_output: TriggerOutput,
    pub trip_cause_recorder: TripCauseRecorder,
    pub telemetry: Producer<'static, WithSourceFinger<UnsolicitedReport>>,
    pub window_watchdog: WindowWatchdog,
    pub chip_monitor: ChipMonitor,
}

impl ControlLoop {
    /// Runs one control tick of the finger whose samples are complete: computes the outputs, drives
    /// the finger's bridge, saves its thermal dose, and queues its telemetry if that is due. If the
    /// telemetry queue is full, this telemetry is lost. Also feeds the window watchdog and keeps
    /// the stored trip cause up to date. Called once a millisecond for each finger.
    ///
    /// `host_is_active` is true if the host has sent a line since the control tick before. It is
    /// read and cleared; a true value restarts, for all fingers, the 2 s after which
    /// [`Fault::HostSilent`] trips a finger whose display follows a set-point while its telemetry
    /// streams.
    ///
    /// `start_learner` is called if the learner of the finger has an input, of its tick before.
    ///
    /// Returns whether telemetry was due, so that the caller starts the host task, which sends it.
    ///
    /// # Errors
    /// [`SampleError`] if there are no valid samples; the control loop has then
    /// [stopped](Self::stop_and_trip_all).
    pub fn run_finger_tick(
        &mut self,
        device: &mut DeviceInPlace<FINGERS>,
        host_is_active: &AtomicBool,
        start_learner: impl FnOnce(),
    ) -> Result<bool, SampleError> {
        let (finger, scans) = match self.sampler.take_block_and_select_next_finger() {
            Ok(block) => block,
            Err(error) => {
                self.stop_and_trip_all(device, error);
                return Err(error);
            }
        };
        self.window_watchdog.feed();
        // All that a sensor needs in one place, so that a tick without one asks once.
        if device.finger_has_flux_sensor(finger)
            && device.note_flux_code(finger, self.flux_converter.take_code_and_start_next())
        {
            start_learner();
        }
        let stage = &mut self.stages[finger.index()];
        let inputs = DigitalInputs {
            bridge_fault: stage.poll_fault_line_low(),
            emergency_stop: self.emergency_stop.is_pressed(),
            comparator_side_differs: self.comparator_side.differs_from_selected(),
        };
        let needs_scatter = device.finger_needs_scatter(finger);
        let samples = Samples::from_scans(scans, inputs, needs_scatter);
        if finger == FingerIndex::FIRST
            && let Some(edge) = self.trigger_input.take_edge()
        {
            device.note_trigger_edge(edge);
        }
        // A line that comes between load and store counts in this tick, as the one before it.
        if host_is_active.load(Ordering::Relaxed) {
            host_is_active.store(false, Ordering::Relaxed);
            device.note_host_activity();
        }
        if stack_is_overrun() {
            device.trip_all(Fault::Stack);
        }
        if let Some(fault) = self.chip_monitor.present_fault() {
            device.trip_all(fault);
        }
        if !self.sampler.finger_was_selected() {
            device.trip_all(Fault::SelectLines);
        }
        let outputs = device.step_finger(finger, &samples);
        // Scan all fingers only when one has tripped or a cause is stored.
        if !self.chip_monitor.has_fault_at_start()
            && (self.trip_cause_recorder.has_stored_cause() || device.is_finger_tripped(finger))
        {
            self.trip_cause_recorder.store_or_erase(device.earliest_trip_cause());
        }
        save_dose_if_changed(finger, device.finger_thermal_dose(finger));
        self.comparator_side.select(outputs.comparator_test);
        stage.apply_drive_and_comparator_test(&outputs);
        self.trigger_output.set(finger, outputs.trigger_output);
        let mut is_due = false;
        if device.finger_has_event(finger) {
            is_due = true;
            self.queue_events(device, finger);
        }
        let telemetry = device.finger_telemetry_if_due(finger);
        is_due |= telemetry.is_some();
        if let Some(telemetry) = telemetry {
            // A full queue means that the link to the host is too slow; this line of telemetry is
            // then dropped.
            if self.telemetry.enqueue(telemetry.into_report()).is_err() {
                line_losses::DROPPED_TELEMETRY.count();
            }
        }
        // The other fingers only if this one has tripped.
        if device.is_finger_tripped(finger)
            && finger == FingerIndex::FIRST
            && FingerIndex::all().all(|one| device.is_finger_tripped(one))
        {
            self.chip_monitor.restart_when_clock_has_come();
        }
        Ok(is_due)
    }

    /// Queues the events of a finger for the host, as far as there is room; the others stay in the station.
    #[inline(never)]
    fn queue_events(&mut self, device: &mut DeviceInPlace<FINGERS>, finger: FingerIndex<FINGERS>) {
        // Ends, because each round takes an event that nothing replaces meanwhile.
        while self.telemetry.ready()
            && let Some(event) = device.take_finger_event(finger)
        {
            let _ = self.telemetry.enqueue(event);
        }
    }

    /// Turns all bridges off, stops sampling until the next reset, trips all fingers by the fault
    /// of `error`, and stores the earliest trip cause of all fingers for the next start. The
    /// watchdogs then reset the device, because no tick runs any more.
    pub fn stop_and_trip_all(&mut self, device: &mut DeviceInPlace<FINGERS>, error: SampleError) {
        self.stages.iter_mut().for_each(FingerPowerStage::off);
        self.sampler.stop();
        device.trip_all(error.fault());
        self.trip_cause_recorder.store_or_erase(device.earliest_trip_cause());
        defmt::error!("sampling stopped: {}", error);
    }
}
