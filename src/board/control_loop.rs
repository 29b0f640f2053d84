//! The control loop: from a finger's samples to its bridge, once a tick and finger.

use core::sync::atomic::{AtomicBool, Ordering};

use heapless::spsc::Producer;
use thermal_display::device::command::Addressed;
use thermal_display::device::safety::Fault;
use thermal_display::device::sense::Samples;
use thermal_display::device::{Device, Telemetry};

use super::{
    FINGERS, FaultRecord, PowerStage, SampleError, Sampler, WindowWatchdog, save_dose,
    stack_is_overrun,
};

/// Samples the sensors and drives the bridges of all fingers.
pub struct ControlLoop {
    pub sampler: Sampler,
    pub stages: [PowerStage; FINGERS],
    pub fault_record: FaultRecord,
    pub telemetry: Producer<'static, Addressed<Telemetry>>,
    pub window_watchdog: WindowWatchdog,
    /// The 8 MHz clock of the debug probe runs. Without it the control tick has no accurate period.
    pub has_clock: bool,
}

impl ControlLoop {
    /// Runs one tick of the finger whose samples are complete, drives its bridge, and queues its
    /// telemetry if it is due; a full queue drops it. `host_is_active` tells that something was
    /// received from the host since the last tick; it is read and cleared. Returns whether telemetry
    /// was due, so that the caller starts the task that sends it.
    ///
    /// # Errors
    /// [`SampleError`] if there are no valid samples; the control loop has then
    /// [stopped](Self::stop).
    pub fn tick(
        &mut self,
        device: &mut Device<FINGERS>,
        host_is_active: &AtomicBool,
    ) -> Result<bool, SampleError> {
        let (finger, scans) = match self.sampler.take() {
            Ok(block) => block,
            Err(error) => {
                self.stop(device, error);
                return Err(error);
            }
        };
        self.window_watchdog.feed();
        let stage = &mut self.stages[finger.index()];
        let samples = Samples::from_scans(scans, stage.fault());
        if host_is_active.swap(false, Ordering::Relaxed) {
            device.note_host_activity();
        }
        if stack_is_overrun() {
            device.trip_all(Fault::Stack);
        }
        if !self.has_clock {
            device.trip_all(Fault::Clock);
        }
        let outputs = device.step(finger, &samples);
        // Scan all fingers only when one has tripped or a cause is stored.
        if self.fault_record.is_stored() || device.is_tripped(finger) {
            self.fault_record.update(device.earliest_cause());
        }
        save_dose(finger, device.dose(finger));
        stage.apply(&outputs);
        let telemetry = device.telemetry(finger);
        let is_due = telemetry.is_some();
        if let Some(telemetry) = telemetry {
            // A full queue means that the link to the host is too slow; this line of telemetry is
            // then dropped.
            let _ = self.telemetry.enqueue(telemetry);
        }
        Ok(is_due)
    }

    /// Turns all bridges off, stops sampling for good and trips all fingers. The watchdogs then
    /// reset the device.
    pub fn stop(&mut self, device: &mut Device<FINGERS>, error: SampleError) {
        self.stages.iter_mut().for_each(PowerStage::off);
        self.sampler.stop();
        device.trip_all(error.fault());
        self.fault_record.update(device.earliest_cause());
        defmt::error!("sampling stopped: {}", error);
    }
}
