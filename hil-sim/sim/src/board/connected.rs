//! What hands have connected to a board.

use thermal_client::commissioning::{BenchRequest, Button, Part, Removal};
use thermal_plant::bridge::Output;
use thermal_plant::sensors::{Circuit, THERMISTORS};
use thermal_plant::{ConfigError, Defects};

use super::{Board, meter};
use crate::World;
use crate::commissioning::CommissioningSetup;

/// A board on the bench, at first with nothing connected and nothing pressed.
#[derive(Clone, Debug)]
pub struct BoardBench {
    pub(super) board: Board,
    pub(super) connected: Connected,
}

/// Parts that are connected, and buttons that are pressed.
#[derive(Clone, Debug)]
pub(super) struct Connected {
    pub supply: bool,
    load_cell: bool,
    weight_n: f64,
    thermistors: [Circuit; THERMISTORS],
    pub output: Output,
    pub stop: bool,
}

impl BoardBench {
    /// A bare board.
    pub const fn new(board: Board) -> Self {
        Self {
            board,
            connected: Connected {
                supply: false,
                load_cell: false,
                weight_n: 0.0,
                thermistors: [Circuit::Open; THERMISTORS],
                output: Output::Open,
                stop: false,
            },
        }
    }

    /// The board on its bench, where it is commissioned too.
    pub fn setup(&self) -> CommissioningSetup {
        self.board.setup()
    }

    /// The world of the bare board, before its program starts.
    ///
    /// # Errors
    /// The plant does not accept a value.
    pub fn world(&self) -> Result<World, ConfigError> {
        let mut world = self.board.setup().on_the_bench()?.with_chip(self.board.chip);
        self.apply(&mut world);
        Ok(world)
    }

    /// Applies the state of the board to a world.
    pub fn apply(&self, world: &mut World) {
        world.set_plant_defects(self.defects());
    }

    fn defects(&self) -> Defects {
        let (board, connected) = (&self.board, &self.connected);
        let mut defects = board.defects;
        for (thermistor, circuit) in
            defects.sensors.thermistors.iter_mut().zip(connected.thermistors)
        {
            thermistor.circuit = circuit;
        }
        let weight_n = connected.weight_n;
        defects.sensors.force.open |= !connected.load_cell;
        defects.sensors.force.offset_n +=
            if board.force_is_reversed { -weight_n } else { weight_n };
        defects.bridge.output = connected.output;
        let has_supply = connected.supply && (!connected.stop || board.stop_is_bypassed);
        defects.bridge.supply_v = Some(if has_supply { board.wiring.supply_v } else { 0.0 });
        defects.supply.emergency_stop = connected.stop && !board.stop_is_bypassed;
        defects.supply.stop_sense_open |= connected.stop;
        defects
    }

    /// Carries out a line; returns what is behind `ok` in its answer.
    ///
    /// # Errors
    /// The plant does not accept a value.
    pub fn execute(
        &mut self,
        request: &BenchRequest,
        world: &mut World,
    ) -> Result<String, ConfigError> {
        let connected = &mut self.connected;
        match *request {
            BenchRequest::Meter(point) => {
                let value = meter::value(self, point, world);
                return Ok(format!(" {value} {}", point.unit()));
            }
            BenchRequest::Fit(part) => match part {
                // The emulated probe gives its clock whenever the chip runs.
                Part::Usb => {}
                Part::Supply => connected.supply = true,
                Part::LoadCell => connected.load_cell = true,
                Part::Resistor(sensor, ohm) => {
                    connected.thermistors[sensor as usize] = Circuit::Resistor(ohm);
                }
                Part::Thermistors => {
                    connected.thermistors = [Circuit::Closed; THERMISTORS];
                    world.move_to(self.board.setup().on_the_bench()?);
                }
                Part::Load(ohm) => {
                    connected.output = Output::Resistor(ohm);
                    world.forget_pulse();
                }
                Part::Tile => connected.output = Output::Tile,
                Part::Weight(newton) => connected.weight_n = newton,
            },
            BenchRequest::Remove(removal) => match removal {
                Removal::Resistor(sensor) => {
                    connected.thermistors[sensor as usize] = Circuit::Open;
                }
                Removal::Load => connected.output = Output::Open,
                Removal::Weight => connected.weight_n = 0.0,
            },
            BenchRequest::Press(Button::Stop) => connected.stop = true,
            BenchRequest::Release(Button::Stop) => connected.stop = false,
            // The microcontroller itself is not reset: what is measured meanwhile does not depend on its program.
            BenchRequest::Press(Button::Reset) => {
                if !self.board.reset_is_unconnected {
                    world.set_latch();
                }
            }
            BenchRequest::Release(Button::Reset) => {}
        }
        self.apply(world);
        Ok(String::new())
    }
}
