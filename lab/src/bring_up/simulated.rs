//! A board that is simulated in this program, with its bench.

use std::time::Duration;

use thermal_client::commissioning::SurroundingsRequest;
use thermal_client::link::{Link, LinkError, ReceivedLine};
use thermal_sim::board::BoardBench;
use thermal_sim::commissioning::{SimulatedSurroundings, SurroundingsAction};
use thermal_sim::engine::Engine;
use thermal_sim::simulated_link::SimulatedLink;

use crate::link::AskSurroundings;

/// The line to a simulated board, and to its surroundings.
#[derive(Debug)]
pub struct SimulatedBoard<'a, E> {
    link: SimulatedLink<'a, E>,
    surroundings: SimulatedSurroundings,
}

impl<'a, E: Engine> SimulatedBoard<'a, E> {
    /// A board on its bench, in whose world the engine runs.
    pub fn new(engine: &'a mut E, bench: BoardBench) -> Self {
        Self {
            link: SimulatedLink::new(engine),
            surroundings: SimulatedSurroundings::of_board(bench),
        }
    }
}

impl<E: Engine> Link for SimulatedBoard<'_, E> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        self.link.send(bytes)
    }

    fn receive(&mut self, timeout: Duration) -> Result<Option<ReceivedLine>, LinkError> {
        self.link.receive(timeout)
    }

    fn now(&self) -> Duration {
        self.link.now()
    }
}

impl<E: Engine> AskSurroundings for SimulatedBoard<'_, E> {
    fn ask_surroundings(&mut self, request: &SurroundingsRequest) -> Result<String, String> {
        let world = self.link.world();
        match self.surroundings.execute(&request.to_string(), world)? {
            SurroundingsAction::Answer(answer) => {
                Ok(answer.strip_prefix("ok").unwrap_or(&answer).trim().into())
            }
            SurroundingsAction::Wait { .. } => Err("time passes by the device's own line".into()),
        }
    }
}
