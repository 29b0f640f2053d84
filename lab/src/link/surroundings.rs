//! Lines to the surroundings of a simulated device.

use thermal_client::commissioning::SurroundingsRequest;
use thermal_client::link::Interruptible;

/// Sends lines to the surroundings of the device at the other end of a link.
pub trait AskSurroundings {
    /// Sends a line; returns the answer after `ok`.
    ///
    /// # Errors
    /// The surroundings refuse the line, or cannot be reached.
    fn ask_surroundings(&mut self, request: &SurroundingsRequest) -> Result<String, String>;
}

impl<L: AskSurroundings> AskSurroundings for Interruptible<L> {
    fn ask_surroundings(&mut self, request: &SurroundingsRequest) -> Result<String, String> {
        self.inner().ask_surroundings(request)
    }
}
