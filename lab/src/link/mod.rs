//! Lines to a device: serial port, TCP, and a device that another program simulates and serves. That of a device simulated in
//! this program is [`SimulatedLink`].

mod lazy;
mod own_port;
mod paced;
mod ports;
mod served;
mod stream;
mod surroundings;

pub use lazy::LazyLink;
pub use own_port::OwnPort;
pub use paced::PacedLink;
pub use ports::{PortInfo, UsbId, ports};
pub use served::ServedLink;
pub use stream::{StreamLink, serial, tcp};
pub use surroundings::AskSurroundings;
pub use thermal_client::link::{Interruptible, Link, LinkError, ReceivedLine};
pub use thermal_sim::simulated_link::SimulatedLink;
