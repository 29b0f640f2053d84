//! The release image in the emulated microcontroller, wired as the NUCLEO-F446RE board is.

use anyhow::Context;
use thermal_plant::bridge::BridgeOutputs;
use thermal_plant::sensors::Channel;
use thermal_sim::engine::{BAUD, Cost, DeviceReset, Engine};
use thermal_sim::metrics::Figures;
use thermal_sim::processor::{MachineFault, NotInjected};
use thermal_sim::run::Outcome;
use thermal_sim::scene::Scene;
use thermal_sim::{RamLayout, SceneRunner, World, run_scene_on};

use super::meter::{Meter, TICK};
use super::{
    EMERGENCY_STOP, FIRST_BRIDGE, TEST_SIDE, TRIGGER_INPUT, TRIGGER_OUTPUT, inject, refused,
};
use crate::{Firmware, Machine, RAM_BASE, RAM_SIZE, Stop, Wiring};

/// ADC1 inputs, in the order of [`Channel::ALL`]: PA0, PA1, PA4, PB0, PC1, PC0, PC2, PC4.
pub const ADC_INPUTS: [u8; Channel::ALL.len()] = [0, 1, 4, 8, 11, 10, 12, 14];
/// Input of the converters at PC5, the heat-flux sensor.
const FLUX_INPUT: u8 = 15;
/// From the first conversion to the first boundary, and between boundaries, picoseconds.
const FIRST_BOUNDARY_PS: u64 = 230_000_000;
const HALF_MS_PS: u64 = 500_000_000;
const MICROSECOND_PS: u64 = 1_000_000;
/// Longest time from power-up to the first conversion.
const BOOT_S: u64 = 1;
/// Cycles of one search step for the first conversion.
const SEARCH_CYCLES: u64 = 200;

/// Why the image did not start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The emulated machine stopped.
    #[error(transparent)]
    Stop(#[from] Stop),
    /// The image runs, but starts no conversion.
    #[error("the image started no conversion within {BOOT_S} s of power-up")]
    NoConversion,
}

/// The emulated microcontroller on the plant.
pub struct OneFingerBoard {
    machine: Machine<Pins>,
    /// Time of the first boundary, ps since power-up.
    first_boundary_ps: u64,
    halves: u64,
    meter: Meter,
}

/// Runs to the end of the first conversion, which it returns in cycles since power-up.
///
/// # Errors
/// The image cannot run, or does not start its converter.
pub fn power_up<W: Wiring>(
    machine: &mut Machine<W>,
    first_conversion: impl Fn(&W) -> Option<u64>,
) -> Result<u64, StartError> {
    loop {
        if let Some(at) = first_conversion(machine.wiring()) {
            return Ok(at);
        }
        let now = machine.now();
        if now > BOOT_S * u64::from(machine.clocks().hclk_hz) {
            return Err(StartError::NoConversion);
        }
        machine.run_until(now + SEARCH_CYCLES)?;
    }
}

/// Resets after power-up; times count from the first boundary.
pub fn resets<W: Wiring>(machine: &Machine<W>, first_boundary_ps: u64) -> Vec<DeviceReset> {
    let after_power_up = machine.resets().iter().skip(1);
    after_power_up
        .map(|reset| DeviceReset {
            t_s: (reset.at_ps as f64 - first_boundary_ps as f64) * 1e-12,
            cause: reset.cause,
        })
        .collect()
}

impl OneFingerBoard {
    /// Powers the device up and runs it to the first boundary after its first conversion.
    ///
    /// # Errors
    /// The image cannot run, or does not start its converter.
    pub fn new(firmware: &Firmware, world: World) -> Result<Self, StartError> {
        let chip = world.chip();
        let mut machine = Machine::with_chip(firmware, Pins::new(world), &chip)?;
        machine.set_host_baud(BAUD as u32);
        let started = power_up(&mut machine, |pins| pins.first_conversion)?;
        let first_boundary_ps = machine.ps_at(started) + FIRST_BOUNDARY_PS;
        machine.run_until_ps(first_boundary_ps)?;
        let meter = Meter::new(&mut machine);
        Ok(Self { machine, first_boundary_ps, halves: 0, meter })
    }

    /// Records the execution path of the control tick from now on.
    pub fn watch_tick(&mut self) {
        self.machine.watch(TICK);
    }

    /// Times of the rising edges at the trigger output, s since the first boundary.
    pub fn trigger_output_rises_s(&self) -> Vec<f64> {
        let rises = self.machine.wiring().trigger_output_rises.iter();
        let first_ps = self.first_boundary_ps as f64;
        rises.map(|at| (self.machine.ps_at(*at) as f64 - first_ps) * 1e-12).collect()
    }

    /// Time of the last boundary, ps since power-up.
    const fn boundary_ps(&self) -> u64 {
        self.first_boundary_ps + self.halves * HALF_MS_PS
    }

    /// The machine, read-only.
    pub fn machine(&self) -> &Machine<impl Wiring + use<>> {
        &self.machine
    }
}

impl Engine for OneFingerBoard {
    type Stop = Stop;

    const NAME: &'static str = "image";

    fn world(&mut self) -> &mut World {
        &mut self.machine.wiring_mut().world
    }

    fn legs(&mut self) -> BridgeOutputs {
        FIRST_BRIDGE.legs(&mut self.machine)
    }

    fn run_half_ms(&mut self) -> Result<(), Stop> {
        self.halves += 1;
        self.machine.run_until_ps(self.boundary_ps())?;
        self.machine.wiring_mut().trigger = false;
        let test = FIRST_BRIDGE.comparator_test(&self.machine);
        self.world().comparator_test(test);
        Ok(())
    }

    fn send(&mut self, bytes: &[u8]) {
        self.machine.uart_send(bytes);
    }

    fn receive(&mut self, into: &mut Vec<u8>) {
        into.append(&mut self.machine.wiring_mut().received);
    }

    fn inject(&mut self, fault: &MachineFault, after_us: u32) -> Result<(), NotInjected> {
        if after_us > 0 {
            let at_ps = self.boundary_ps() + u64::from(after_us) * MICROSECOND_PS;
            let reached = self.machine.run_until_ps(at_ps);
            reached.map_err(|stop| refused(fault, &stop))?;
        }
        inject(&mut self.machine, fault)
    }

    fn trigger(&mut self, after_us: u32) -> Result<(), Stop> {
        // Half a microsecond later, so that the count of microseconds at the edge is not in doubt.
        let low_ps = self.boundary_ps() + u64::from(after_us) * MICROSECOND_PS;
        if self.machine.wiring().trigger {
            self.machine.run_until_ps(low_ps)?;
            self.machine.wiring_mut().trigger = false;
        }
        self.machine.run_until_ps(low_ps + MICROSECOND_PS / 2)?;
        self.machine.wiring_mut().trigger = true;
        Ok(())
    }

    fn resets(&self) -> Vec<DeviceReset> {
        resets(&self.machine, self.first_boundary_ps)
    }

    fn reset_cost(&mut self) {
        self.meter = Meter::new(&mut self.machine);
    }

    fn cost(&self) -> Option<Cost> {
        self.meter.cost(&self.machine)
    }
}

/// The image on the board; each scene is run from power-up.
impl SceneRunner for Firmware {
    fn name(&self) -> &'static str {
        OneFingerBoard::NAME
    }

    fn run(&self, scene: &Scene) -> anyhow::Result<(Outcome, Figures)> {
        run_scene_on(scene, |world| Ok(OneFingerBoard::new(self, world)?))
    }

    fn has_processor(&self) -> bool {
        true
    }

    fn ram_layout(&self) -> anyhow::Result<RamLayout> {
        let symbol = |name| {
            let at = self.symbol(name);
            at.with_context(|| {
                format!("the image has no symbol {name}, so its static data cannot be found")
            })
        };
        Ok(RamLayout {
            ram: RAM_BASE..RAM_BASE + RAM_SIZE,
            statics: symbol("__sdata")?..symbol("__sheap")?,
            stack_top: self.initial_sp(),
        })
    }
}

/// The circuit at the pins of the microcontroller.
struct Pins {
    world: World,
    first_conversion: Option<u64>,
    /// Level at the trigger input.
    trigger: bool,
    /// Cycles since power-up of the rising edges at the trigger output.
    trigger_output_rises: Vec<u64>,
    received: Vec<u8>,
}

impl Pins {
    const fn new(world: World) -> Self {
        Self {
            world,
            first_conversion: None,
            trigger: false,
            trigger_output_rises: Vec::new(),
            received: Vec::new(),
        }
    }
}

impl Wiring for Pins {
    fn adc(&mut self, channel: u8, now: u64) -> u16 {
        self.first_conversion.get_or_insert(now);
        if channel == FLUX_INPUT {
            return self.world.flux_code();
        }
        let input = ADC_INPUTS.iter().position(|input| *input == channel);
        // An unconnected input floats; it reads as the middle of the range.
        input.map_or(0x800, |index| self.world.convert(Channel::ALL[index]))
    }

    fn pin(&self, port: u8, bit: u8) -> Option<bool> {
        match (port, bit) {
            pin if pin == FIRST_BRIDGE.fault => Some(!self.world.bridge_fault()),
            EMERGENCY_STOP => Some(!self.world.emergency_stop()),
            TEST_SIDE => self.world.side_stuck(),
            TRIGGER_INPUT => Some(self.trigger),
            _ => None,
        }
    }

    fn output(&mut self, port: u8, bit: u8, level: Option<bool>, at: u64) {
        if (port, bit) == TRIGGER_OUTPUT && level == Some(true) {
            self.trigger_output_rises.push(at);
        }
    }

    fn uart_tx(&mut self, byte: u8, _at: u64, _baud: u32) {
        self.received.push(byte);
    }
}
