//! The simulated surroundings of a device that is commissioned: baths, coolant and reference thermometer.

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use rand_distr::{Distribution, StandardNormal};
use thermal_client::client::Client;
use thermal_client::commissioning::{
    CommissioningEvent, PhantomPlace, Surroundings, SurroundingsError, SurroundingsRequest,
};
use thermal_device::safety::ThermistorId;
use thermal_plant::ConfigError;

use super::{CommissioningSetup, SimulatedPhantom};
use crate::World;
use crate::board::BoardBench;
use crate::engine::Engine;
use crate::simulated_link::SimulatedLink;

/// Resolution of the reference thermometer, K.
const RESOLUTION_K: f64 = 1e-3;

/// Force of the phantom with its weight, N.
const PHANTOM_N: f64 = 2.0;

/// Moves a device from bath to bath, and reads the reference thermometer with its offset and noise.
#[derive(Clone, Debug)]
pub struct SimulatedSurroundings {
    setup: CommissioningSetup,
    random: Xoshiro256PlusPlus,
    /// Temperature of the bath of skin or room, deg C.
    bath_c: f64,
    /// The phantom of the heat-flux sensor.
    phantom: SimulatedPhantom,
    /// The board that is brought up, if one is.
    board: Option<BoardBench>,
}

impl SimulatedSurroundings {
    /// Surroundings of a device in its [place of use](CommissioningSetup::in_use).
    pub fn new(setup: &CommissioningSetup) -> Self {
        Self {
            setup: setup.clone(),
            random: Xoshiro256PlusPlus::seed_from_u64(setup.operator_seed()),
            bath_c: setup.room_c(),
            phantom: SimulatedPhantom::gel(setup.operator_seed(), setup.room_c()),
            board: None,
        }
    }

    /// Surroundings of a board that is brought up.
    pub fn of_board(board: BoardBench) -> Self {
        Self { board: Some(board.clone()), ..Self::new(&board.setup()) }
    }

    /// The same with another phantom.
    #[must_use]
    pub fn with_phantom(self, phantom: SimulatedPhantom) -> Self {
        Self { phantom, ..self }
    }

    /// Moves the phantom; with it beside the display begins a place of its own.
    ///
    /// # Errors
    /// The plant does not accept it.
    pub fn move_phantom(
        &mut self,
        world: &mut World,
        place: PhantomPlace,
    ) -> Result<(), ConfigError> {
        match place {
            PhantomPlace::Beside => world.move_to(self.setup.with_phantom(&self.phantom)?),
            PhantomPlace::OnDisplay => world.set_force_and_faults(PHANTOM_N, std::iter::empty()),
            PhantomPlace::Away => world.move_to(self.setup.in_use()?),
        }
        if let Some(board) = &self.board {
            board.apply(world);
        }
        Ok(())
    }

    /// What the reference thermometer shows at a thermistor, deg C; at those of skin and room it is in their bath.
    pub fn reference_c(&mut self, world: &World, thermistor: ThermistorId) -> f64 {
        let true_c = match thermistor {
            ThermistorId::Display | ThermistorId::Check => world.plant().display_c(),
            ThermistorId::Sink => world.plant().sink_c(),
            ThermistorId::Skin | ThermistorId::Room => self.bath_c,
        };
        let thermometer = self.setup.params().host;
        let normal: f64 = StandardNormal.sample(&mut self.random);
        let shown_c =
            true_c + thermometer.reference_offset_k + thermometer.reference_noise_k * normal;
        (shown_c / RESOLUTION_K).round() * RESOLUTION_K
    }

    /// Puts the thermistor of skin or room into a bath, deg C, or the sink on a coolant; the display has none.
    ///
    /// # Errors
    /// The plant does not accept the temperature.
    pub fn put_into_bath(
        &mut self,
        world: &mut World,
        thermistor: ThermistorId,
        bath_c: f64,
    ) -> Result<(), ConfigError> {
        world.move_to(match thermistor {
            ThermistorId::Skin => self.setup.skin_in_bath(bath_c)?,
            ThermistorId::Room => self.setup.room_in_bath(bath_c)?,
            ThermistorId::Sink | ThermistorId::Display | ThermistorId::Check => {
                self.setup.sink_on_coolant(bath_c)?
            }
        });
        if let Some(board) = &self.board {
            board.apply(world);
        }
        self.bath_c = bath_c;
        Ok(())
    }
}

/// The simulated operator: acts on the world of the device at the other end of the line.
pub struct SimulatedOperator<'a> {
    /// Baths and reference thermometer.
    pub surroundings: SimulatedSurroundings,
    /// Called for each event.
    pub watch: &'a mut dyn FnMut(&CommissioningEvent),
}

impl<'a, E: Engine> Surroundings<SimulatedLink<'a, E>> for SimulatedOperator<'_> {
    fn reference_c(
        &mut self,
        client: &mut Client<SimulatedLink<'a, E>>,
        thermistor: ThermistorId,
    ) -> Result<f64, SurroundingsError> {
        let world = client.link().world();
        Ok(self.surroundings.reference_c(world, thermistor))
    }

    fn put_into_bath(
        &mut self,
        client: &mut Client<SimulatedLink<'a, E>>,
        thermistor: ThermistorId,
        bath_c: f64,
    ) -> Result<(), SurroundingsError> {
        let world = client.link().world();
        self.surroundings
            .put_into_bath(world, thermistor, bath_c)
            .map_err(|error| SurroundingsError::Failed(error.to_string()))
    }

    fn move_phantom(
        &mut self,
        client: &mut Client<SimulatedLink<'a, E>>,
        place: PhantomPlace,
    ) -> Result<(), SurroundingsError> {
        let world = client.link().world();
        self.surroundings
            .move_phantom(world, place)
            .map_err(|error| SurroundingsError::Failed(error.to_string()))
    }

    fn reads_again(&mut self, _why: &str) -> bool {
        false
    }

    fn notice(&mut self, event: &CommissioningEvent) {
        (self.watch)(event);
    }
}

/// What the owner of a simulated device does about a line to its surroundings.
#[derive(Clone, Debug, PartialEq)]
pub enum SurroundingsAction {
    /// Answers with this line.
    Answer(String),
    /// Receives bytes from the host until it has `sent` of them in all, lets the device run, and answers with the time since
    /// power-up, ms, and the number of bytes that the device has sent to the host.
    Wait {
        /// Time, ms.
        ms: u64,
        /// Bytes.
        sent: u64,
    },
}

impl SimulatedSurroundings {
    /// Carries out a line to the surroundings ([`SurroundingsRequest`]) in the device's world, except for waiting.
    ///
    /// # Errors
    /// The line is wrong, or the plant does not accept it; the error says why, and what is allowed.
    pub fn execute(&mut self, line: &str, world: &mut World) -> Result<SurroundingsAction, String> {
        let answer = match line.parse()? {
            SurroundingsRequest::Reference(thermistor) => {
                format!("ok {:.3}", self.reference_c(world, thermistor))
            }
            SurroundingsRequest::Bath(thermistor, bath_c) => {
                self.put_into_bath(world, thermistor, bath_c).map_err(|error| error.to_string())?;
                "ok".into()
            }
            SurroundingsRequest::Phantom(place) => {
                self.move_phantom(world, place).map_err(|error| error.to_string())?;
                "ok".into()
            }
            SurroundingsRequest::Force(force_n) => {
                world.set_force_and_faults(force_n, std::iter::empty());
                "ok".into()
            }
            SurroundingsRequest::Bench(request) => {
                let board = self.board.as_mut();
                let board = board.ok_or("no board is on the bench; serve one with --board")?;
                let answer = board.execute(&request, world);
                format!("ok{}", answer.map_err(|error| error.to_string())?)
            }
            SurroundingsRequest::Wait { ms, sent } => {
                return Ok(SurroundingsAction::Wait { ms, sent });
            }
        };
        Ok(SurroundingsAction::Answer(answer))
    }
}
